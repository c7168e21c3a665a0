//! Gauss's rule, for functions that end like a square root or a logarithm too.

use std::f64::consts::{FRAC_PI_2, PI};

/// Nodes between −1 and 1 and their weights.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    pub(super) nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// From −1 to 1.
    pub(super) x: f64,
    pub(super) weight: f64,
    /// Its part in the last moments.
    tail: Tail,
}

/// The moments of the function as it is folded with Legendre's polynomials of the highest
/// degrees that a rule can tell apart. Of even and of odd functions every other one is zero.
type Tail = [f64; 3];

impl Rule {
    /// Gauss's rule with this many nodes, folded so many times.
    ///
    /// The integral of f(x) is that of f(sin(πs/2)) π/2 cos(πs/2). Where f ends like a power
    /// of the distance to the end the integrand ends with twice that power and one: square
    /// roots become smooth, and the error falls exponentially with the number of nodes. What
    /// is not smooth a little beyond an end is farther from it too.
    ///
    /// The nodes are the zeros of Legendre's polynomial, by Newton's method (W. H. Press et
    /// al., Numerical Recipes, 3rd ed., Cambridge 2007, section 4.6.1).
    pub(super) fn new(count: u32, folds: u32) -> Self {
        /// From the usual first guess Newton's method needs five.
        const STEPS: usize = 8;
        let n = f64::from(count);
        let nodes = (0..count).map(|i| {
            let mut x = -(PI * (f64::from(i) + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..STEPS {
                let [value, before] = legendre(count, x);
                slope = n * (x * value - before) / (x * x - 1.0);
                x -= value / slope;
            }
            let weight = 2.0 / ((1.0 - x * x) * slope * slope);
            let mut tail = Tail::default();
            if folds > 0 {
                tail =
                    [1, 2, 3].map(|i| weight * legendre(count.saturating_sub(i), x)[0]);
            }
            let mut node = Node { x, weight, tail };
            for _ in 0..folds {
                let (sin, cos) = (FRAC_PI_2 * node.x).sin_cos();
                let slope = FRAC_PI_2 * cos;
                let tail = node.tail.map(|part| slope * part);
                node = Node { x: sin, weight: slope * node.weight, tail };
            }
            node
        });
        Self { nodes: nodes.collect() }
    }
}

/// What a rule leaves out, from the values at its nodes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rest(Tail);

impl Rest {
    pub(super) fn add(&mut self, node: &Node, value: f64) {
        self.0.iter_mut().zip(node.tail).for_each(|(sum, part)| *sum += part * value);
    }

    /// The largest of the last moments.
    pub(super) fn largest(&self) -> f64 {
        self.0.iter().fold(0.0, |largest, c| largest.max(c.abs()))
    }
}

/// The values at x of Legendre's polynomial of a degree and of the one before.
fn legendre(degree: u32, x: f64) -> [f64; 2] {
    (0..degree).map(f64::from).fold([1.0, 0.0], |[now, before], k| {
        [((2.0 * k + 1.0) * x * now - k * before) / (k + 1.0), now]
    })
}

/// How wrong a rule is when one of half as many nodes found something else, and this is left
/// of the function at the highest degree it can tell.
///
/// Where the error falls exponentially it is about the square of either. The power 3/2
/// and the factor are those of R. Piessens et al., QUADPACK, Springer 1983, section 3.4.1. Where
/// a function ends with a logarithm it falls like a power of the number of nodes only, with
/// folded rules at least the sixth.
///
/// Two rules that are wrong agree by chance once in a while, and there are thousands of them in
/// an integral over slices; so what is left is asked too.
pub(super) fn error(before: f64, now: f64, left: f64) -> f64 {
    const SIXTH_POWER: f64 = 1.0 / 64.0;
    let difference = (now - before).abs().max(left);
    let likely = now.abs() * (200.0 * difference / now.abs()).powf(1.5);
    // Of nothing there is no part.
    if now == 0.0 {
        difference
    } else {
        difference.min(likely.max(SIXTH_POWER * difference))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(rule: &Rule, f: impl Fn(f64) -> f64) -> f64 {
        rule.nodes.iter().map(|node| node.weight * f(node.x)).sum()
    }

    #[test]
    fn plain_rules_are_exact_for_polynomials() {
        for count in [1, 2, 5, 20, 40] {
            let rule = Rule::new(count, 0);
            for power in (0..2 * count).step_by(2) {
                let power = i32::try_from(power).unwrap();
                let exact = 2.0 / f64::from(power + 1);
                let error = integral(&rule, |x| x.powi(power)) - exact;
                assert!(error.abs() < 1e-14, "{count} nodes, power {power}: {error}");
            }
        }
    }

    #[test]
    fn folded_rules_take_square_roots_for_smooth() {
        let half_disc = |x: f64| ((1.0 - x) * (1.0 + x)).sqrt();
        assert!((integral(&Rule::new(10, 1), half_disc) - FRAC_PI_2).abs() < 1e-14);
        assert!((integral(&Rule::new(20, 2), half_disc) - FRAC_PI_2).abs() < 1e-13);
        assert!((integral(&Rule::new(20, 0), half_disc) - FRAC_PI_2).abs() > 1e-5);
    }
}
