//! Where slices change: the heights u at which the area of a slice may not be analytic.
//!
//! They are those of the points where a plane u = constant does not go across all that it
//! meets: where it touches a surface or an edge, the curve in which two surfaces meet, and of
//! corners and apexes (M. Goresky, R. `MacPherson`, "Stratified Morse Theory", Springer 1988,
//! part I). Each is a common zero of three quadratic polynomials. Those count at which the
//! solid does have that surface, edge or corner.

use std::time::Instant;

use super::body::{Body, Set, numbers};
use super::form::Form;
use super::slice::NEAR;
use super::system::{Zero, zeros};
use crate::aabb::Aabb;

/// All critical heights, and between which surfaces there are edges.
#[derive(Debug)]
pub(super) struct Critical {
    /// In order, none twice.
    pub(super) heights: Vec<f64>,
    /// Which surfaces meet each one at edges; it is among them if it matters at all.
    ///
    /// An edge has ends or it is closed and has a highest point: there it is found.
    pub(super) meets: Vec<Set>,
}

/// Points where surfaces only touch are found to fewer digits.
const NEAR_TOUCHING: f64 = 1e-5;

/// Heights of touching points that are closer to another one than this are the same.
const SAME_TOUCHING: f64 = 1e-6;

/// Heights that are closer than this are the same.
const SAME: f64 = 1e-13;

impl Critical {
    /// Those of points in a box for which `is_wanted` may say yes; none if it takes too long.
    pub(super) fn find(
        body: &Body<'_>,
        within: &Aabb,
        is_wanted: impl Fn(&Aabb) -> bool,
        deadline: Option<Instant>,
    ) -> Option<Self> {
        let forms = &body.forms;
        let mut meets = vec![0; forms.len()];
        let (mut crossing, mut touching) = (Vec::new(), Vec::new());
        let (mut counts, mut given_up) = (Vec::new(), false);
        for (system, on) in systems(forms) {
            if deadline.is_some_and(|deadline| Instant::now() > deadline) {
                return None;
            }
            let found = zeros([0, 1, 2].map(|i| &system[i]), within, &is_wanted);
            given_up |= found.given_up;
            for Zero { point, regular } in found.points {
                // Gradients vanish in the middle of a ball too.
                let is_on = |i: usize| forms[i].value(point).abs() <= NEAR_TOUCHING;
                let near = if regular { NEAR } else { NEAR_TOUCHING };
                let set = body.matter(point, on, near, &mut counts);
                if set & on == on && numbers(on).all(is_on) {
                    numbers(set).for_each(|i| meets[i] |= set);
                    let heights = if regular { &mut crossing } else { &mut touching };
                    heights.push(point.x);
                }
            }
        }
        if given_up {
            // Where three surfaces share a curve its ends may be unknown.
            let all = (0..forms.len()).fold(0, |set, i| set | 1 << i);
            meets.fill(all);
        }
        Some(Self { heights: merged(crossing, touching), meets })
    }
}

/// The equations of all kinds of critical points, and the surfaces on which these lie.
fn systems(forms: &[Form]) -> impl Iterator<Item = ([Form; 3], Set)> {
    let later = |i: usize| (i + 1..).zip(&forms[i + 1..]);
    let one = forms.iter().enumerate().flat_map(|(i, form)| {
        let [u, v, w] = [0, 1, 2].map(|axis| form.derivative(axis));
        [([*form, v, w], 1 << i), ([u, v, w], 1 << i)]
    });
    let two = (0..).zip(forms).flat_map(move |(i, a)| {
        later(i).map(move |(j, b)| ([*a, *b, Form::tangency(a, b)], 1 << i | 1 << j))
    });
    let three = (0..).zip(forms).flat_map(move |(i, a)| {
        later(i).flat_map(move |(j, b)| {
            later(j).map(move |(k, c)| ([*a, *b, *c], 1 << i | 1 << j | 1 << k))
        })
    });
    one.chain(two).chain(three)
}

/// All heights in order, each once.
fn merged(mut heights: Vec<f64>, mut touching: Vec<f64>) -> Vec<f64> {
    touching.sort_unstable_by(f64::total_cmp);
    touching.dedup_by(|b, a| *b - *a <= SAME_TOUCHING);
    touching.retain(|t| heights.iter().all(|h| (t - h).abs() > SAME_TOUCHING));
    heights.extend(touching);
    heights.sort_unstable_by(f64::total_cmp);
    heights.dedup_by(|b, a| *b - *a <= SAME);
    heights
}
