//! How far a surface is from another, by rays.

use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;

use super::lattice::in_order;
use crate::progress::Watch;
use crate::ray::{Crossing, Ray};
use crate::sampling::{hash, unit};
use crate::scene::{Scene, Tracer};

/// How far points of one surface are from another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Apart {
    /// The largest distance that was found: from any of the points, along the shortest of the
    /// rays that were tried. The surface may be farther away between the points.
    pub largest: f64,
    /// Where that was: the point, and where the ray met the other surface; `None` without
    /// points.
    pub ends: Option<[DVec3; 2]>,
    /// How many points of the surface there were.
    pub points: u64,
    /// From how many of them no ray met the other surface.
    pub lost: u64,
    /// How many points more are on walls and gaps that are too thin to be looked at.
    pub thin: u64,
    /// How many lines were tried to find points.
    pub lines: u64,
}

/// Which points of a surface are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// How many lines are tried to find them.
    pub lines: u64,
    /// Which random numbers: equal seeds give equal lines.
    pub seed: u64,
    /// Where a line goes through a wall or a gap in a shorter length than this, it is as if there
    /// were none. Where surfaces are one but for rounding, there are walls and gaps
    /// that are as thin as that, deep in what is solid or empty.
    pub thinnest: f64,
}

/// How far the surface of `from` is from that of `to`, at points where random lines meet it:
/// they are as dense everywhere on the surface, by Crofton's formula.
///
/// From each point a ray goes along the normal, both ways. Only where that is farther than
/// what was found before it is worth while to look for a shorter way, by rays in other
/// directions: at an edge, the way along a normal can miss what is near. So distances are not shorter
/// than the true ones, and hardly longer.
///
/// Line i depends on the seed and i alone; `watch` can stop the work, with what was found.
///
/// ```
/// use solidray::{Scene, Solid, measure, unwatched};
///
/// let [small, large] = [3.0, 3.1].map(|radius| Scene::compile(&Solid::ball(radius)));
/// let search = measure::Search { lines: 1000, seed: 0, thinnest: 1e-9 };
/// let apart = measure::apart(&small?, &large?, &search, &unwatched);
/// assert!((apart.largest - 0.1).abs() < 1e-9);
/// # Ok::<(), solidray::CompileError>(())
/// ```
pub fn apart(from: &Scene, to: &Scene, search: &Search, watch: Watch<'_>) -> Apart {
    /// Lines that are worth a task.
    const TASK: u64 = 1 << 8;
    if !from.bounds().is_bounded() {
        return Apart::default();
    }
    let Search { lines, seed, thinnest } = *search;
    let is_stopped = AtomicBool::new(false);
    let scratch = || Between {
        scenes: [from, to],
        from: from.tracer(),
        to: to.tracer(),
        met: Vec::new(),
    };
    let found = in_order(lines.div_ceil(TASK), &scratch, |between, task| {
        let mut found = Apart::default();
        if is_stopped.load(Ordering::Relaxed) {
            return found;
        }
        for number in task * TASK..lines.min((task + 1) * TASK) {
            between.look(&line(from, seed, number), thinnest, &mut found);
        }
        if watch(found.lines).is_break() {
            is_stopped.store(true, Ordering::Relaxed);
        }
        found
    });
    found.into_iter().fold(Apart::default(), Apart::and)
}

impl Apart {
    /// The two of them together.
    fn and(self, other: Self) -> Self {
        let is_larger = self.ends.is_none() || other.largest > self.largest;
        let more = if is_larger { &other } else { &self };
        Self {
            largest: more.largest,
            ends: more.ends.or(self.ends),
            points: self.points + other.points,
            lost: self.lost + other.lost,
            thin: self.thin + other.thin,
            lines: self.lines + other.lines,
        }
    }
}

/// A line of the isotropic and uniform ones that meet the ball around the bounds.
fn line(scene: &Scene, seed: u64, number: u64) -> Ray {
    let [height, turn, area, around] =
        [0, 1, 2, 3].map(|part| unit(hash(seed, &[number, part])));
    let z = 2.0 * height - 1.0;
    let (sine, cosine) = (TAU * turn).sin_cos();
    let flat = (1.0 - z * z).max(0.0).sqrt();
    let dir = DVec3::new(flat * cosine, flat * sine, z).normalize_or(DVec3::Z);
    let (x, y) = dir.any_orthonormal_pair();
    let (sine, cosine) = (TAU * around).sin_cos();
    let bounds = scene.bounds();
    let radius = 0.5 * bounds.size().length() * area.sqrt();
    Ray::new(bounds.center() + radius * (cosine * x + sine * y), dir)
}

/// Where a ray from a point meets the other surface.
#[derive(Clone, Copy)]
struct Way {
    dir: DVec3,
    crossing: Crossing,
}

impl Way {
    fn length(&self) -> f64 {
        self.crossing.t.abs()
    }
}

/// Whether there is a way that is no longer than this.
fn is_short(way: Option<Way>, enough: f64) -> bool {
    way.is_some_and(|way| way.length() <= enough)
}

/// Scratch memory of one thread.
struct Between<'a> {
    scenes: [&'a Scene; 2],
    from: Tracer<'a>,
    to: Tracer<'a>,
    /// Where a line meets the first surface.
    met: Vec<Crossing>,
}

impl Between<'_> {
    /// Adds what is found where a line, whose direction has length one, meets the first surface.
    fn look(&mut self, line: &Ray, thinnest: f64, found: &mut Apart) {
        found.lines += 1;
        self.met.clear();
        for crossing in self.from.spans(line).iter().flat_map(|s| [s.enter, s.exit]) {
            match self.met.last() {
                Some(last) if crossing.t - last.t < thinnest => {
                    self.met.pop();
                    found.thin += 2;
                }
                _ => self.met.push(crossing),
            }
        }
        for number in 0..self.met.len() {
            let crossing = self.met[number];
            let (point, normal) =
                (line.at(crossing.t), self.scenes[0].normal_at(line, &crossing));
            found.points += 1;
            let mut way = self.along(point, normal);
            if !is_short(way, found.largest) {
                self.shorten(&mut way, point, normal, found.largest);
            }
            match way {
                None => found.lost += 1,
                Some(way) if found.ends.is_none() || way.length() > found.largest => {
                    found.largest = way.length();
                    found.ends = Some([point, point + way.crossing.t * way.dir]);
                }
                Some(_) => {}
            }
        }
    }

    /// Where a line through a point meets the other surface first, on either side.
    fn along(&mut self, point: DVec3, dir: DVec3) -> Option<Way> {
        let spans = self.to.spans(&Ray::new(point, dir)).iter();
        let crossings = spans.flat_map(|span| [span.enter, span.exit]);
        let nearest = crossings.min_by(|a, b| a.t.abs().total_cmp(&b.t.abs()));
        nearest.map(|crossing| Way { dir, crossing })
    }

    /// Looks for a shorter way: askew to the normal first, then in all directions, each time among
    /// neighbours of the shortest as well, until one is short enough.
    fn shorten(
        &mut self,
        best: &mut Option<Way>,
        point: DVec3,
        normal: DVec3,
        enough: f64,
    ) {
        /// How many directions are all: a wedge of 20° around a point has a few of them.
        const ALL: u32 = 64;
        let (x, y) = normal.any_orthonormal_pair();
        for side in [x, y, x + y, x - y] {
            for dir in [normal + side, normal - side, side] {
                self.improve(best, point, dir);
            }
        }
        self.follow(best, point);
        if is_short(*best, enough) {
            return;
        }
        // A spiral over half of the sphere, by the golden angle; lines have two ends.
        for number in 0..ALL {
            let number = f64::from(number) + 0.5;
            let z = number / f64::from(ALL);
            let (sine, cosine) = (number * PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
            let side = (1.0 - z * z).sqrt();
            self.improve(best, point, DVec3::new(side * cosine, side * sine, z));
        }
        self.follow(best, point);
    }

    /// Looks among neighbours of the shortest way.
    fn follow(&mut self, best: &mut Option<Way>, point: DVec3) {
        /// By how much the last neighbours are turned: a way that is turned by so much is longer
        /// by half its square, one in a thousand.
        const LEAST: f64 = 0.05;
        /// What is not shorter by so much is not worth while to follow.
        const GAIN: f64 = 0.99;
        /// The most neighbourhoods.
        const STEPS: usize = 64;
        let mut angle = FRAC_PI_4;
        for _ in 0..STEPS {
            let Some(way) = best.filter(|_| angle > LEAST) else { break };
            // Square to the other surface it is shortest, if there is no edge.
            let ray = Ray::new(point, way.dir);
            let across = self.scenes[1].normal_at(&ray, &way.crossing);
            let (x, y) = way.dir.any_orthonormal_pair();
            let tilt = angle.tan();
            let sides = [x, y, -x, -y].map(|side| way.dir + tilt * side);
            self.improve(best, point, across);
            for dir in sides {
                self.improve(best, point, dir);
            }
            if best.is_some_and(|now| now.length() >= GAIN * way.length()) {
                angle *= 0.5;
            }
        }
    }

    fn improve(&mut self, best: &mut Option<Way>, point: DVec3, dir: DVec3) {
        let Some(way) = self.along(point, dir.normalize_or(DVec3::Z)) else { return };
        if best.is_none_or(|best| way.length() < best.length()) {
            *best = Some(way);
        }
    }
}
