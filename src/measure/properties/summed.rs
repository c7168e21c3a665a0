//! Numbers from independent estimates of integrals.

use glam::{DMat3, DVec3};

use super::integrals::Integrals;
use super::principal::principal;
use super::quantity::Quantity;
use super::run::{Missed, Replicate, Run};
use super::{Body, Principal};
use crate::aabb::Aabb;
use crate::measure::beam::Beam;
use crate::measure::lattice::Sampling;
use crate::measure::shares::ROOM;
use crate::measure::spread::{ENOUGH_HITS, most_hits, root_of_squares, student};

/// Independent estimates of integrals, and how much each run counts.
pub(super) struct Summed {
    runs: Vec<(f64, Vec<Integrals>)>,
    /// The mean of all.
    mean: Integrals,
    /// From where coordinates count.
    center: DVec3,
    /// How much volume and area may be missing at most.
    missed: Missed,
    /// How far what is missing is at most from anything.
    reach: f64,
    /// What the volume is at most where too few rays met all of it.
    bound: f64,
    pub(super) is_nothing: bool,
    /// Whether enough rays have met what the integrals are of.
    is_met: bool,
    /// Whether that is all, but for little.
    pub(super) is_resolved: bool,
}

impl Summed {
    /// Each run counts for as much as it has rays in its last round: how far its numbers are
    /// apart must not decide that, or runs that are wrong and agree by chance would win.
    pub(super) fn of(runs: &[Run], sampling: &Sampling) -> Self {
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
        let mut missed = Missed::NOTHING;
        for run in runs.iter().filter(|run| size(run) > 0) {
            missed.add(size(run) as f64 / all as f64, run.missed);
        }
        let is_divided = runs.iter().all(|run| run.missed != Missed::NOTHING);
        let mut summed = Self {
            mean,
            center: bounds.center(),
            missed,
            reach: bounds.size().length(),
            bound: 0.0,
            is_nothing,
            is_met: is_nothing
                || (all > 0 && replicates().all(|r| r.hits >= ENOUGH_HITS)),
            is_resolved: false,
            runs: weighed,
        };
        summed.bound = if summed.is_met || is_divided {
            mean.volume() + summed.half_width(Integrals::volume) + missed.volume
        } else {
            most(&bounds, all, replicates().map(|r| r.hits).sum())
        };
        summed.is_resolved = summed.is_met && summed.room(missed, sampling) <= ROOM;
        summed
    }

    /// How much of what is allowed it takes up at most if so much volume and area is missing.
    pub(super) fn room(&self, missed: Missed, sampling: &Sampling) -> f64 {
        if missed == Missed::NOTHING {
            return 0.0;
        }
        let Missed { volume, area } = missed;
        let of_volume = volume / sampling.allowed(self.mean.volume());
        let of_area = area / (sampling.rel_tol * self.mean.area());
        let room = self.body_room(volume);
        let of_body = self.targets(sampling.rel_tol).map_or(f64::INFINITY, |targets| {
            (room[0] / targets[0]).max(room[1] / targets[1])
        });
        let all = of_volume.max(of_area).max(of_body);
        // Zero over zero.
        if all.is_nan() { f64::INFINITY } else { all }
    }

    /// By how much the centroid and the inertia may be off if some volume is missing.
    fn body_room(&self, missed: f64) -> [f64; 2] {
        let first = missed * self.reach;
        [if missed > 0.0 { first / self.mean.volume() } else { 0.0 }, first * self.reach]
    }

    /// How near the centroid and the inertia are to be, if there are any.
    fn targets(&self, tol: f64) -> Option<[f64; 2]> {
        let volume = self.mean.volume();
        if volume <= 0.0 {
            return None;
        }
        let second = trace(&self.mean.second_about(self.mean.first() / volume));
        Some([tol * (second / volume).sqrt(), tol * (2.0 / 3.0 * second)])
    }

    /// The same numbers with the spread of some lattices that found a part of them.
    pub(super) fn with_runs_of(&self, rows: &[Replicate]) -> Self {
        let rows = rows.iter().map(|row| Integrals(row.integrals)).collect();
        Self {
            runs: vec![(1.0, rows)],
            missed: Missed::NOTHING,
            is_resolved: true,
            ..*self
        }
    }

    /// How many times as wide as it was to be the widest interval is of what is known.
    pub(super) fn distance(&self, sampling: &Sampling) -> f64 {
        let known = Self { runs: self.runs.clone(), is_resolved: true, ..*self };
        let (volume, area) = (known.volume(sampling), known.area(sampling));
        super::widest(super::quantities(
            volume,
            area,
            known.body(sampling.rel_tol).as_ref(),
        ))
    }

    /// The same of something denser.
    pub(super) fn times(mut self, density: f64) -> Self {
        self.runs.iter_mut().for_each(|(weight, _)| *weight *= density);
        self.mean = self.mean.scaled(density, density);
        self.bound *= density;
        let mut missed = Missed::NOTHING;
        missed.add(density, self.missed);
        self.missed = missed;
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
        self.reach = (self.reach + moved.length()).max(other.reach + moved.length());
        self.missed.add(1.0, other.missed);
        self.is_met &= other.is_met;
        self.is_resolved &= other.is_resolved;
        self
    }

    /// The half width of the interval of something that depends linearly on the integrals.
    ///
    /// Runs are independent, so their variances add up. The quantile is that of each run:
    /// that of the sum would be smaller, for it has more degrees of freedom.
    fn half_width(&self, of: impl Fn(&Integrals) -> f64) -> f64 {
        let half_width = |(weight, rows): &(f64, Vec<Integrals>)| {
            let numbers: Vec<f64> = rows.iter().map(&of).collect();
            weight * student(&numbers).1
        };
        let half_widths: Vec<f64> = self.runs.iter().map(half_width).collect();
        root_of_squares(half_widths.into_iter(), (1.0, 1.0))
    }

    /// A number that depends linearly on the integrals, as near to it as `target`, and by how
    /// much it may be off for what is missing.
    fn quantity(
        &self,
        value: f64,
        target: f64,
        room: f64,
        of: impl Fn(&Integrals) -> f64,
    ) -> Quantity {
        let half_width = self.half_width(of) + room;
        let interval = [value - half_width, value + half_width];
        Quantity { value, interval, target }
    }

    pub(super) fn volume(&self, sampling: &Sampling) -> Quantity {
        let volume = self.mean.volume();
        if self.is_nothing {
            Quantity::exact(0.0)
        } else if self.is_resolved {
            let allowed = sampling.allowed(volume);
            let found = self.quantity(volume, allowed, 0.0, Integrals::volume);
            found.and_more(self.missed.volume).not_negative()
        } else {
            let interval = [self.least(Integrals::volume), self.bound];
            Quantity { value: volume, interval, target: 0.0 }
        }
    }

    pub(super) fn area(&self, sampling: &Sampling) -> Quantity {
        let area = self.mean.area();
        if self.is_nothing {
            Quantity::exact(0.0)
        } else if self.is_resolved {
            let target = sampling.rel_tol * area;
            let found = self.quantity(area, target, 0.0, Integrals::area);
            found.and_more(self.missed.area).not_negative()
        } else {
            let interval = [self.least(Integrals::area), f64::INFINITY];
            Quantity { value: area, interval, target: 0.0 }
        }
    }

    /// What the volume or the area is at least where it is not resolved: what is known of it, if
    /// anything is.
    fn least(&self, of: impl Fn(&Integrals) -> f64) -> f64 {
        if !self.is_met {
            return 0.0;
        }
        (of(&self.mean) - self.half_width(of)).max(0.0)
    }

    /// Ratios and products of integrals to first order: their derivatives are linear.
    pub(super) fn body(&self, tol: f64) -> Option<Body> {
        let volume = self.mean.volume();
        if !self.is_resolved || self.is_nothing || volume <= 0.0 {
            return None;
        }
        let at = self.mean.first() / volume;
        let second = self.mean.second_about(at);
        let inertia = |m: &DMat3| DMat3::from_diagonal(DVec3::splat(trace(m))) - *m;
        let [near, alike] = self.targets(tol)?;
        let [room, room_of_inertia] = self.body_room(self.missed.volume);
        let centroid = [0, 1, 2].map(|k| {
            let of = |row: &Integrals| (row.first()[k] - at[k] * row.volume()) / volume;
            self.quantity(self.center[k] + at[k], near, room, of)
        });
        let entry = |i: usize, j: usize| {
            let of = |row: &Integrals| inertia(&row.second_about(at)).col(j)[i];
            self.quantity(inertia(&second).col(j)[i], alike, room_of_inertia, of)
        };
        let found = principal(&inertia(&second));
        let along = |a: DVec3, b: DVec3| {
            move |row: &Integrals| a.dot(inertia(&row.second_about(at)) * b)
        };
        let principal = [0, 1, 2].map(|k| {
            let (moment, axis) = found[k];
            let turned = [(k + 1) % 3, (k + 2) % 3].map(|j| {
                let (other, across) = found[j];
                let half_width = self.half_width(along(axis, across)) + room_of_inertia;
                half_width / (moment - other).abs()
            });
            // Zero over zero is no number, and says nothing.
            let angle = turned[0].hypot(turned[1]).atan();
            Principal {
                moment: self.quantity(moment, alike, room_of_inertia, along(axis, axis)),
                axis,
                angle: if angle.is_nan() { std::f64::consts::FRAC_PI_2 } else { angle },
            }
        });
        let inertia = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        Some(Body { centroid, inertia, principal })
    }
}

fn trace(m: &DMat3) -> f64 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
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
