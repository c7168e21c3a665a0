//! Leaves that do not overlap, as far as their boxes say.

use crate::aabb::Aabb;
use crate::rounded::Rounded;
use crate::shape::U;

/// A leaf with its volume, and a box around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxed {
    pub(super) volume: Rounded,
    pub(super) bounds: Aabb,
}

/// Boxes that overlap by less than this part of all the volume are side by side but for
/// rounding, for which they have room. 2¹⁶ roundings.
const NEGLIGIBLE: f64 = 65_536.0 * U;

/// More pairs of boxes than this are not looked at.
const MOST_PAIRS: usize = 1 << 26;

/// At most how much volume leaves have in common, if that is next to nothing.
pub(super) fn overlap(leaves: &[Boxed], total: f64) -> Option<f64> {
    let mut boxes: Vec<Aabb> = leaves.iter().map(|leaf| leaf.bounds).collect();
    boxes.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
    let (mut common, mut pairs) = (0.0, 0);
    for (i, first) in boxes.iter().enumerate() {
        for second in &boxes[i + 1..] {
            if second.min.x > first.max.x {
                break;
            }
            pairs += 1;
            let both = first.intersection(*second);
            if !both.is_empty() {
                common += both.size().element_product();
            }
        }
        if pairs > MOST_PAIRS || common > NEGLIGIBLE * total {
            return None;
        }
    }
    // With room for the rounding of products and sums.
    Some(1.001 * common)
}
