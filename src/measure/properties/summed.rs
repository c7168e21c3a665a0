//! Numbers from independent estimates of integrals.

use glam::{DMat3, DVec3};

use super::integrals::Integrals;
use super::principal::principal;
use super::quantity::Quantity;
use super::run::Run;
use super::{Body, Principal};
use crate::aabb::Aabb;
use crate::measure::beam::Beam;
use crate::measure::lattice::Sampling;
use crate::measure::spread::{ENOUGH_HITS, most_hits, student};

/// Independent estimates of integrals, and how much each run counts.
pub(super) struct Summed {
    runs: Vec<(f64, Vec<Integrals>)>,
    /// The mean of all.
    mean: Integrals,
    /// From where coordinates count.
    center: DVec3,
    /// What the volume is at most where it is not resolved.
    bound: f64,
    pub(super) is_nothing: bool,
    pub(super) is_resolved: bool,
}

impl Summed {
    /// Each run counts for as much as it has rays in its last round: how far its numbers are
    /// apart must not decide that, or runs that are wrong and agree by chance would win.
    pub(super) fn of(runs: &[Run]) -> Self {
        let size = |run: &Run| run.lattice * run.replicates.len() as u64;
        let all: u64 = runs.iter().map(size).sum();
        let weighed = |run: &Run| {
            let rows = run.replicates.iter().map(|r| Integrals(r.integrals));
            (size(run) as f64 / all as f64, rows.collect())
        };
        let weighed: Vec<(f64, Vec<Integrals>)> =
            runs.iter().filter(|run| size(run) > 0).map(weighed).collect();
        let mut mean = Integrals::default();
        for (weight, rows) in &weighed {
            let weight = weight / rows.len() as f64;
            rows.iter().for_each(|row| mean.add(&row.scaled(weight, weight)));
        }
        let replicates = || runs.iter().flat_map(|run| &run.replicates);
        let (bounds, is_nothing) = (runs[0].bounds, runs[0].is_nothing());
        Self {
            mean,
            center: bounds.center(),
            bound: most(&bounds, all, replicates().map(|r| r.hits).sum()),
            is_nothing,
            is_resolved: is_nothing
                || (all > 0 && replicates().all(|r| r.hits >= ENOUGH_HITS)),
            runs: weighed,
        }
    }

    /// The same of something denser.
    pub(super) fn times(mut self, density: f64) -> Self {
        self.runs.iter_mut().for_each(|(weight, _)| *weight *= density);
        self.mean = self.mean.scaled(density, density);
        self.bound *= density;
        self
    }

    /// Together with something independent of it.
    pub(super) fn and(mut self, other: Self) -> Self {
        if other.is_nothing {
            return self;
        }
        if self.is_nothing {
            return other;
        }
        let moved = other.center - self.center;
        self.mean.add(&other.mean.seen_from(moved));
        for (weight, mut rows) in other.runs {
            rows.iter_mut().for_each(|row| *row = row.seen_from(moved));
            self.runs.push((weight, rows));
        }
        self.bound += other.bound;
        self.is_resolved &= other.is_resolved;
        self
    }

    /// The half width of the interval of something that depends linearly on the integrals.
    ///
    /// Runs are independent, so their variances add up. The quantile is that of each run:
    /// that of the sum would be smaller, for it has more degrees of freedom.
    fn half_width(&self, of: impl Fn(&Integrals) -> f64) -> f64 {
        let squares = self.runs.iter().map(|(weight, rows)| {
            let numbers: Vec<f64> = rows.iter().map(&of).collect();
            let (_, half_width) = student(&numbers);
            (weight * half_width) * (weight * half_width)
        });
        squares.sum::<f64>().sqrt()
    }

    /// A number that depends linearly on the integrals, as near to it as `allowed`.
    fn quantity(
        &self,
        value: f64,
        target: f64,
        of: impl Fn(&Integrals) -> f64,
    ) -> Quantity {
        let half_width = self.half_width(of);
        let interval = [value - half_width, value + half_width];
        Quantity { value, interval, target }
    }

    pub(super) fn volume(&self, sampling: &Sampling) -> Quantity {
        let volume = self.mean.volume();
        if self.is_nothing {
            Quantity::exact(0.0)
        } else if self.is_resolved {
            let found =
                self.quantity(volume, sampling.allowed(volume), Integrals::volume);
            found.not_negative()
        } else {
            Quantity { value: volume, interval: [0.0, self.bound], target: 0.0 }
        }
    }

    pub(super) fn area(&self, sampling: &Sampling) -> Quantity {
        let area = self.mean.area();
        if self.is_nothing {
            Quantity::exact(0.0)
        } else if self.is_resolved {
            let target = sampling.rel_tol * area;
            self.quantity(area, target, Integrals::area).not_negative()
        } else {
            Quantity { value: area, interval: [0.0, f64::INFINITY], target: 0.0 }
        }
    }

    /// Ratios and products of integrals to first order: their derivatives are linear.
    pub(super) fn body(&self, tol: f64) -> Option<Body> {
        let volume = self.mean.volume();
        if !self.is_resolved || self.is_nothing || volume <= 0.0 {
            return None;
        }
        let at = self.mean.first() / volume;
        let second = self.mean.second_about(at);
        let trace = |m: &DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
        let gyration = (trace(&second) / volume).sqrt();
        let inertia = |m: &DMat3| DMat3::from_diagonal(DVec3::splat(trace(m))) - *m;
        let mean = 2.0 / 3.0 * trace(&second);
        let centroid = [0, 1, 2].map(|k| {
            let of = |row: &Integrals| (row.first()[k] - at[k] * row.volume()) / volume;
            self.quantity(self.center[k] + at[k], tol * gyration, of)
        });
        let entry = |i: usize, j: usize| {
            let of = |row: &Integrals| inertia(&row.second_about(at)).col(j)[i];
            self.quantity(inertia(&second).col(j)[i], tol * mean, of)
        };
        let found = principal(&inertia(&second));
        let along = |a: DVec3, b: DVec3| {
            move |row: &Integrals| a.dot(inertia(&row.second_about(at)) * b)
        };
        let principal = [0, 1, 2].map(|k| {
            let (moment, axis) = found[k];
            let turned = [(k + 1) % 3, (k + 2) % 3].map(|j| {
                let (other, across) = found[j];
                self.half_width(along(axis, across)) / (moment - other).abs()
            });
            // Zero over zero is no number, and says nothing.
            let angle = turned[0].hypot(turned[1]).atan();
            Principal {
                moment: self.quantity(moment, tol * mean, along(axis, axis)),
                axis,
                angle: if angle.is_nan() { std::f64::consts::FRAC_PI_2 } else { angle },
            }
        });
        let inertia = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        Some(Body { centroid, inertia, principal })
    }
}

/// An upper bound for the volume where few rays meet the solid: what so many could have met if
/// chance was against them, each over its whole length. A third of the rays is of each beam.
fn most(bounds: &Aabb, rays: u64, hits: u64) -> f64 {
    let size = bounds.size();
    if rays == 0 || size.min_element() == 0.0 {
        return size.element_product();
    }
    let each = [0, 1, 2].map(|axis| {
        let beam = Beam::along(*bounds, axis);
        beam.depth() * beam.area() / rays as f64
    });
    let largest = each.into_iter().fold(0.0, f64::max) / 3.0;
    (largest * most_hits(hits)).min(size.element_product())
}
