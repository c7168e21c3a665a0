//! Arcs of a circle, and what they leave of it.

use std::f64::consts::TAU;

use glam::DVec2;

/// Where an arc ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// For order only: arcs are a little shorter than they are.
    angle: f64,
    /// The direction, of length 1, as exact as it can be had.
    pub(super) direction: DVec2,
}

/// An open arc, counter-clockwise: the start from 0 to 2π, and the end less than 2π beyond it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    start: End,
    end: End,
}

/// Where a function of a direction on a circle is positive.
#[derive(Clone, Copy, Debug)]
pub(super) enum Positive {
    Nowhere,
    Everywhere,
    On(Arc),
}

/// Where v · d + c > slack, for directions d of length 1; the ends of arcs are where v · d + c = 0.
///
/// Directions of ends are found without angles, so that those along the axes are exact.
pub(super) fn positive(v: DVec2, c: f64, slack: f64) -> Positive {
    /// What rounding of angles up to 2π can be.
    const ANGLE: f64 = 16.0 * f64::EPSILON;
    let length = v.length();
    if c - slack >= length {
        return Positive::Everywhere;
    }
    if c - slack <= -length {
        return Positive::Nowhere;
    }
    let half = ((slack - c) / length).clamp(-1.0, 1.0).acos() - ANGLE;
    if half <= 0.0 {
        return Positive::Nowhere;
    }
    let axis = v / length;
    let cos = (-c / length).clamp(-1.0, 1.0);
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    let [start, end] = [-sin, sin].map(|sin| axis.rotate(DVec2::new(cos, sin)));
    let angle = (v.y.atan2(v.x) - half).rem_euclid(TAU);
    Positive::On(Arc {
        start: End { angle, direction: start },
        end: End { angle: angle + 2.0 * half, direction: end },
    })
}

/// What some arcs leave of a circle, from end to start; the whole circle, which has no ends, is
/// left by none.
pub(super) fn gaps(mut arcs: Vec<Arc>) -> Vec<Gap> {
    arcs.sort_by(|a, b| a.start.angle.total_cmp(&b.start.angle));
    let by_end = |a: &&Arc, b: &&Arc| a.end.angle.total_cmp(&b.end.angle);
    let Some(last) = arcs.iter().max_by(by_end) else { return Vec::new() };
    // One turn earlier is where it ends as well.
    let mut reached = End { angle: last.end.angle - TAU, ..last.end };
    let mut gaps = Vec::new();
    for Arc { start, end } in arcs {
        if start.angle > reached.angle {
            gaps.push(Gap { from: reached, to: start });
        }
        if end.angle > reached.angle {
            reached = end;
        }
    }
    gaps
}

/// An arc that others leave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    pub(super) from: End,
    pub(super) to: End,
}

impl Gap {
    /// Its length in radians, too large by what arcs are too short.
    pub(super) fn angle(&self) -> f64 {
        self.to.angle - self.from.angle
    }
}
