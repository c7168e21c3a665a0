//! Real roots of polynomials of low degree.

/// The highest degree.
const DEGREE: usize = 4;

/// A polynomial; the coefficient of xⁱ is the i-th.
pub(super) type Polynomial = [f64; DEGREE + 1];

/// A value counts as zero where it is less than this part of the sum of its terms' absolute
/// values: coefficients that are sums of a dozen products are rounded by some 1e-15 of that.
/// Then roots that all but coincide are found whether they are there or not.
const ROUNDING: f64 = 1e-13;

/// The product of two polynomials of which the degrees add up to no more than [`DEGREE`].
pub(super) fn product(a: &[f64], b: &[f64]) -> Polynomial {
    let mut product = Polynomial::default();
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            if let Some(c) = product.get_mut(i + j) {
                *c += x * y;
            }
        }
    }
    product
}

/// Puts the roots between two numbers into a list, in order: between the extrema, which are
/// found first, as roots of the derivative. Extrema that are zero but for rounding are among
/// them.
pub(super) fn roots_between(p: &Polynomial, [from, to]: [f64; 2], roots: &mut Vec<f64>) {
    roots.clear();
    // Of p and its derivatives those with fewer roots come first.
    let mut chain = [*p; DEGREE];
    for k in 1..DEGREE {
        chain[k] = derivative(&chain[k - 1]);
    }
    let mut extrema = [0.0; DEGREE + 1];
    let mut count = 0;
    for (k, p) in chain.iter().enumerate().rev() {
        let mut found = [0.0; DEGREE + 1];
        let mut found_count = 0;
        let mut left = from;
        for right in extrema[..count].iter().copied().chain([to]) {
            if let Some(root) = root_between(p, left, right)
                && let Some(place) = found.get_mut(found_count)
            {
                *place = root;
                found_count += 1;
            }
            left = right;
        }
        if k == 0 {
            roots.extend_from_slice(&found[..found_count]);
            let flat = extrema[..count].iter().filter(|&&x| {
                let (value, size) = value(p, x);
                value.abs() <= ROUNDING * size
            });
            roots.extend(flat);
            roots.sort_unstable_by(f64::total_cmp);
        }
        (extrema, count) = (found, found_count);
    }
}

fn derivative(p: &Polynomial) -> Polynomial {
    let mut d = Polynomial::default();
    for i in 1..p.len() {
        d[i - 1] = i as f64 * p[i];
    }
    d
}

/// The value and the sum of the absolute values of the terms.
fn value(p: &Polynomial, x: f64) -> (f64, f64) {
    p.iter()
        .rev()
        .fold((0.0, 0.0), |(sum, size), c| (sum * x + c, size * x.abs() + c.abs()))
}

/// The root between two numbers between which the polynomial is monotonic, if its values
/// there differ in sign: by Newton's method, and by bisection where that goes astray.
fn root_between(p: &Polynomial, left: f64, right: f64) -> Option<f64> {
    let at = |x: f64| {
        p.iter().rev().fold((0.0, 0.0), |(f, slope), c| (f * x + c, slope * x + f))
    };
    let (mut left, mut right) = (left, right);
    let (f_left, f_right) = (at(left).0, at(right).0);
    if (f_left < 0.0) == (f_right < 0.0) {
        return None;
    }
    let mut x = left - f_left * (right - left) / (f_right - f_left);
    for _ in 0..100 {
        if !(x > left && x < right) {
            x = 0.5 * (left + right);
        }
        let (f, slope) = at(x);
        if (f < 0.0) == (f_left < 0.0) {
            left = x;
        } else {
            right = x;
        }
        let step = f / slope;
        let next = x - step;
        if step.abs() <= 2.0 * f64::EPSILON * x.abs() || right - left <= f64::EPSILON {
            return Some(if next > left && next < right { next } else { x });
        }
        x = next;
    }
    Some(x)
}
