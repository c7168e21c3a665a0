//! The rays of a block and the faces of a mesh.
//!
//! The faces that a block may meet are looked up once. Each is seen in the plane in which the
//! rays of a fan are points, where it is a triangle, and of each ray it is decided whether it
//! certainly passes by (edge functions: J. Pineda, "A Parallel Algorithm for Polygon
//! Rasterization", SIGGRAPH 1988). What is left is crossed by single rays, front first, as
//! [`Polyhedron`] does for any line, so that the numbers are the same.

use glam::{DMat3, DVec2, DVec3};

use pulp::Arch;

use super::block::{BLOCK, Block, Slot, bits};
use super::trial::Trials;
use crate::eight::{EIGHT, Eight, Numbers, WithEight, with_eight};
use crate::fan::Fan;
use crate::ray::Sense;
use crate::shape::{Event, Kept, Line, Linear, Polyhedron, inverse};

/// Places and maps are off by less than this part of the largest coordinate at hand, 2⁻⁴⁰,
/// which is 8192 u: more than all roundings of lines, maps and shears together.
const OFF: f64 = 1.0 / 1_099_511_627_776.0;

/// The rays of a block as points of a plane.
pub(super) struct Points {
    /// Right and up, from −1 to 1 for the rays of the block.
    places: [[[f32; EIGHT]; BLOCK / EIGHT]; 2],
    center: DVec2,
    half: DVec2,
    per_half: DVec2,
}

impl Points {
    /// From where in the fan some of the rays are; there is one at least.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    pub(super) fn new(rays: u64, at: impl Fn(usize) -> [f64; 2]) -> Self {
        let mut places = [DVec2::ZERO; BLOCK];
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (ray, place) in places.iter_mut().enumerate() {
            if rays >> ray & 1 == 1 {
                *place = DVec2::from_array(at(ray));
                (low, high) = (low.min(*place), high.max(*place));
            }
        }
        let center = 0.5 * (low + high);
        // One ray alone is a point; a part of a millionth is enough to divide by.
        let half = (0.5 * (high - low)).max(1e-6 * (center.abs() + 1e-6));
        let zeros = [[[0.0; EIGHT]; BLOCK / EIGHT]; 2];
        let mut points = Self { places: zeros, center, half, per_half: 1.0 / half };
        for (ray, place) in places.iter().enumerate() {
            let place = (*place - center) / half;
            points.places[0][ray / EIGHT][ray % EIGHT] = place.x as f32;
            points.places[1][ray / EIGHT][ray % EIGHT] = place.y as f32;
        }
        points
    }
}

/// A face that some rays of a block may cross.
#[derive(Clone, Copy, Debug)]
struct Seen {
    face: u32,
    /// No crossing is in front of this place on a ray.
    near: f64,
    rays: u64,
}

/// The faces of one mesh that the rays of a block may cross.
#[derive(Debug, Default)]
pub(super) struct Facing {
    packs: Vec<u32>,
    /// Packs with faces that the block may meet, front first, and how many have been seen.
    kept: Vec<Kept>,
    done: usize,
    seen: Vec<Seen>,
    /// Faces that have been shown to rays, and their corners.
    shown: Vec<(u32, [DVec3; 3])>,
    /// For each ray how near its faces may be and where they are in that list, front first.
    of_rays: Vec<Vec<(f64, usize)>>,
    /// For each ray how many of those it is known to pass by.
    missed: Vec<usize>,
    /// For each ray the crossings that were found.
    crossed: Vec<Vec<(f64, u32, Sense)>>,
}

/// What is asked for.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub(super) arch: Arch,
    pub(super) mesh: &'a Polyhedron,
    pub(super) block: &'a Block,
    pub(super) open: u64,
}

/// How a mesh is seen by a fan.
pub(super) struct Sighting<'a> {
    mesh: &'a Polyhedron,
    /// Takes a point of the mesh, seen from the middle of the fan's origins, to the place on the
    /// ray through it and, for rays that run apart times this place, to the ray's place in the fan.
    to_fan: DMat3,
    origin: DVec3,
    /// The same for a point in the units of the mesh's tree, and what it makes of the middle.
    unit_to_fan: DMat3,
    middle: DVec3,
    is_parallel: bool,
    /// Between which places on the rays the mesh is.
    depth: [f64; 2],
    /// What a step by the rounding of places does to each number that `to_fan` makes.
    off: DVec3,
}

impl<'a> Sighting<'a> {
    /// Nothing if there is no map, or rays start within the mesh's box or behind it and run
    /// apart. No coordinate of a ray is larger than `reach`.
    pub(super) fn new(
        mesh: &'a Polyhedron,
        fan: &Fan,
        points: &Points,
        reach: f64,
    ) -> Option<Self> {
        let to_local = &mesh.to_local;
        let is_parallel = fan.is_parallel();
        let steps = if is_parallel { &fan.origin } else { &fan.dir };
        let from_fan = DMat3::from_cols(
            to_local.direction(fan.dir.middle),
            to_local.direction(steps.right),
            to_local.direction(steps.up),
        );
        let to_fan = inverse(&from_fan)?;
        let origin = to_local.point(fan.origin.middle);
        let bounds = mesh.local_bounds();
        let largest = |v: DVec3| v.abs().max_element();
        let far = (to_local.linear.abs()
            * DVec3::splat(reach + largest(to_local.origin)))
        .max_element()
            + largest(bounds.min).max(largest(bounds.max));
        let off = to_fan.abs() * DVec3::splat(OFF * far);
        let depths = bounds.corners().map(|corner| (to_fan * (corner - origin)).x);
        let near = depths.into_iter().fold(f64::INFINITY, f64::min) - off.x;
        let far = depths.into_iter().fold(f64::NEG_INFINITY, f64::max) + off.x;
        // How far the inverse is from being one, in the units of its rows and columns.
        let residual = (to_fan * from_fan - DMat3::IDENTITY).abs();
        let widest = points.center.abs() + points.half;
        let widest = if is_parallel { widest } else { far.abs() * widest };
        let off = off + residual * DVec3::new(far.abs() + near.abs(), widest.x, widest.y);
        // Corners are looked at in single precision, and are at most 1 in these units.
        let (unit_to_fan, middle) = mesh.seen_in_units(to_fan, origin);
        let off = off + unit_to_fan.abs() * DVec3::splat(1.0 / 16_777_216.0);
        let is_seen = is_parallel || near > 1e-3 * far;
        let depth = [near, far];
        let sighting =
            Self { mesh, to_fan, origin, unit_to_fan, middle, is_parallel, depth, off };
        (is_seen && off.is_finite()).then_some(sighting)
    }

    /// Between which places on the rays the mesh is.
    pub(super) fn depth(&self) -> [f64; 2] {
        self.depth
    }

    /// Where a point, in the units of the tree, is seen by a block, and where on the ray.
    #[inline]
    fn seen(&self, point: DVec3, points: &Points) -> (DVec2, f64) {
        let seen = self.unit_to_fan * point + self.middle;
        let place = DVec2::new(seen.y, seen.z);
        let place = if self.is_parallel { place } else { place / seen.x };
        ((place - points.center) * points.per_half, seen.x)
    }

    /// The planes beyond which there are no rays of a block.
    fn sides(&self, points: &Points) -> [Linear; 4] {
        let rows = self.to_fan.transpose();
        let sides = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        sides.map(|(axis, sign)| {
            let row = [rows.y_axis, rows.z_axis][axis];
            let off = [self.off.y, self.off.z][axis];
            let border = points.center[axis] + sign * 1.000_001 * points.half[axis];
            if self.is_parallel {
                self.mesh.linear(sign * row, self.origin, -sign * border, off)
            } else {
                let weights = sign * (row - border * rows.x_axis);
                let off = off + border.abs() * self.off.x;
                self.mesh.linear(weights, self.origin, 0.0, off)
            }
        })
    }

    /// The place on a ray.
    fn depths(&self) -> Linear {
        let row = self.to_fan.transpose().x_axis;
        self.mesh.linear(row, self.origin, 0.0, 4.0 * self.off.x)
    }

    /// At most how far off a place is seen, in units of a block, for a point no farther than
    /// its rays; times `1 + x` for one that is `x` of those units away.
    fn off(&self, points: &Points) -> f64 {
        let DVec3 { x, y, z } = self.off;
        let across = DVec2::new(y, z);
        let off = if self.is_parallel {
            across
        } else {
            (across + (points.center.abs() + points.half) * x) / self.depth[0]
        };
        (off / points.half).max_element()
    }
}

impl Facing {
    /// Looks up the faces in a region around the rays up to some depth, in the mesh's frame
    /// `(center, along, breadth)`.
    pub(super) fn look(
        &mut self,
        sighting: &Sighting<'_>,
        points: &Points,
        beam: (DVec3, DVec3, DVec3),
        far: f64,
    ) {
        let Self { packs, kept, done, shown, of_rays, missed, .. } = self;
        packs.clear();
        sighting.mesh.packs_in(beam, packs);
        *done = 0;
        kept.clear();
        shown.clear();
        sighting.mesh.keep(packs, &sighting.sides(points), &sighting.depths(), kept);
        kept.retain(|kept| kept.range[0] < far);
        kept.sort_unstable_by(|a, b| {
            a.range[0].total_cmp(&b.range[0]).then(a.pack.cmp(&b.pack))
        });
        of_rays.resize_with(BLOCK, Vec::new);
        of_rays.iter_mut().for_each(Vec::clear);
        missed.clear();
        missed.resize(BLOCK, 0);
    }

    /// Shows the next faces to some rays: those in front of which there is nothing more, up
    /// to a depth at which there is none. Says whether there were any.
    pub(super) fn go_on(
        &mut self,
        sighting: &Sighting<'_>,
        points: &Points,
        rays: u64,
    ) -> bool {
        let Self { kept, done, seen, shown, of_rays, .. } = self;
        let Some(&first) = kept.get(*done) else { return false };
        let mut far = first.range[1];
        let off = sighting.off(points);
        seen.clear();
        while let Some(&Kept { pack, mut faces, range }) = kept.get(*done) {
            if range[0] > far {
                break;
            }
            far = far.max(range[1]);
            *done += 1;
            while faces != 0 {
                let bit = faces.trailing_zeros();
                faces &= faces - 1;
                if let Some((face, corners)) = sighting.mesh.face_of_pack(pack, bit)
                    && let Some(outline) = Outline::new(sighting, points, corners, off)
                {
                    let near = outline.near;
                    let rays = rays & with_eight(Covered { outline: &outline, points });
                    if rays != 0 {
                        seen.push(Seen { face, near, rays });
                    }
                }
            }
        }
        seen.sort_unstable_by(|a, b| a.near.total_cmp(&b.near).then(a.face.cmp(&b.face)));
        // All at once: what is not at hand is waited for together.
        let first = shown.len();
        shown.extend(seen.iter().map(|seen| sighting.mesh.face(seen.face)));
        for (&Seen { near, mut rays, .. }, i) in seen.iter().zip(first..) {
            while rays != 0 {
                of_rays[rays.trailing_zeros() as usize].push((near, i));
                rays &= rays - 1;
            }
        }
        true
    }

    /// Where faces begin that have not been shown yet.
    fn horizon(&self) -> f64 {
        self.kept.get(self.done).map_or(f64::INFINITY, |kept| kept.range[0])
    }

    /// Finds where rays first come into the mesh, as far as its faces have been shown, if
    /// that is after a depth and the mesh is all that matters; `found` is called with the ray,
    /// the place on its line, the place on the ray and the face. Says of which rays it is
    /// not sure.
    pub(super) fn enter(
        &mut self,
        asked: &Asked<'_>,
        trials: &mut Trials,
        low: f64,
        mut found: impl FnMut(usize, f64, u32),
    ) -> u64 {
        let horizon = self.horizon();
        let Self { shown, of_rays, missed, .. } = self;
        let mut rays = 0;
        for ray in bits(asked.open) {
            rays |= u64::from(missed[ray] < of_rays[ray].len()) << ray;
        }
        if rays == 0 {
            return 0;
        }
        let sure = trials.take(asked.arch, asked.block, asked.mesh, rays);
        let mut doubt = rays & !sure;
        rays = sure;
        while rays != 0 {
            for ray in bits(rays) {
                let (_, number) = of_rays[ray][missed[ray]];
                trials.put(ray, shown[number].1);
            }
            trials.ask(asked.arch, rays);
            for ray in bits(rays) {
                let (t, answer) = (trials.t[ray], trials.answer[ray]);
                let (faces, at) = (&of_rays[ray], missed[ray]);
                if answer <= Trials::MISSED {
                    missed[ray] += 1;
                    rays &= !(u64::from(missed[ray] >= faces.len()) << ray);
                    continue;
                }
                rays &= !(1 << ray);
                let next = faces.get(at + 1).map_or(horizon, |&(near, _)| near);
                let place = asked.block.on_ray(ray, t);
                // All that follows is farther along the ray.
                if answer <= Trials::ENTERED && low <= place && place < next {
                    found(ray, place, shown[faces[at].1].0);
                } else {
                    doubt |= 1 << ray;
                }
            }
        }
        doubt
    }

    /// Finds all crossings of rays with faces that have been shown. Says at most how often
    /// any of them is inside of the mesh, and of which rays that is not sure: those that do not
    /// come in and out by turns, and in different places.
    pub(super) fn cross(
        &mut self,
        asked: &Asked<'_>,
        trials: &mut Trials,
    ) -> (usize, u64) {
        let Self { shown, of_rays, missed, crossed, .. } = self;
        crossed.resize_with(BLOCK, Vec::new);
        crossed.iter_mut().for_each(Vec::clear);
        let mut rays = 0;
        for ray in bits(asked.open) {
            rays |= u64::from(!of_rays[ray].is_empty()) << ray;
        }
        if rays == 0 {
            return (0, 0);
        }
        let sure = trials.take(asked.arch, asked.block, asked.mesh, rays);
        let mut doubt = rays & !sure;
        rays = sure;
        let all = rays;
        while rays != 0 {
            for ray in bits(rays) {
                let (_, number) = of_rays[ray][missed[ray]];
                trials.put(ray, shown[number].1);
            }
            trials.ask(asked.arch, rays);
            for ray in bits(rays) {
                let (t, answer) = (trials.t[ray], trials.answer[ray]);
                if answer > Trials::MISSED {
                    let (face, _) = shown[of_rays[ray][missed[ray]].1];
                    let is_in = answer <= Trials::ENTERED;
                    let sense = if is_in { Sense::Enter } else { Sense::Exit };
                    let crossed = &mut crossed[ray];
                    let place = crossed.partition_point(|&(other, ..)| other < t);
                    crossed.insert(place, (t, face, sense));
                    doubt |= u64::from(answer >= Trials::DOUBT) << ray;
                }
                missed[ray] += 1;
                rays &= !(u64::from(missed[ray] >= of_rays[ray].len()) << ray);
            }
        }
        let mut most = 0;
        for ray in bits(all & !doubt) {
            let crossed = &crossed[ray];
            let is_apart = crossed.windows(2).all(|two| two[0].0 < two[1].0);
            let takes_turns = crossed
                .iter()
                .enumerate()
                .all(|(i, &(.., sense))| (sense == Sense::Enter) == (i % 2 == 0));
            if is_apart && takes_turns {
                most = most.max(crossed.len().div_ceil(2));
            } else {
                doubt |= 1 << ray;
            }
        }
        (most, doubt)
    }

    /// Puts into slots where rays are inside of the mesh, as [`Facing::cross`] has found. A
    /// ray that is in it after the last crossing comes out at infinity.
    pub(super) fn fill(&self, slots: &mut [Slot], rays: u64) {
        for (i, slot) in slots.iter_mut().enumerate() {
            slot.enter = [f64::INFINITY; BLOCK];
            slot.exit = [f64::INFINITY; BLOCK];
            for ray in bits(rays) {
                let crossed = &self.crossed[ray];
                if let Some(&(t, face, _)) = crossed.get(2 * i) {
                    (slot.enter[ray], slot.enter_face[ray]) = (t, f64::from(face));
                    let never = (f64::INFINITY, 0, Sense::Exit);
                    let &(t, face, _) = crossed.get(2 * i + 1).unwrap_or(&never);
                    (slot.exit[ray], slot.exit_face[ray]) = (t, f64::from(face));
                }
            }
        }
    }

    /// All crossings of a ray with faces that have been shown. Where the ray is in the mesh
    /// after them it comes out at infinity, so that it goes in as often as out.
    pub(super) fn crossings(
        &self,
        mesh: &Polyhedron,
        leaf: u32,
        ray: usize,
        line: &Line,
        events: &mut Vec<Event>,
    ) {
        let Some(mut crosser) = self.crosser(mesh, ray, line) else { return };
        let mut winding = 0;
        for &(_, i) in &self.of_rays[ray] {
            let (face, corners) = self.shown[i];
            if let Some((t, sense)) = crosser(corners) {
                winding += if sense == Sense::Enter { 1 } else { -1 };
                events.push(Event { t, leaf, face, sense });
            }
        }
        let sense = if winding > 0 { Sense::Exit } else { Sense::Enter };
        for _ in 0..i32::abs(winding) {
            events.push(Event { t: f64::INFINITY, leaf, face: 0, sense });
        }
    }

    fn crosser<'b>(
        &self,
        mesh: &'b Polyhedron,
        ray: usize,
        line: &Line,
    ) -> Option<impl FnMut([DVec3; 3]) -> Option<(f64, Sense)> + use<'b>> {
        if self.of_rays[ray].is_empty() {
            return None;
        }
        mesh.crosser(line)
    }

    /// The first crossing of a ray whose place is in a range, if the mesh is all that
    /// matters.
    pub(super) fn first(
        &self,
        mesh: &Polyhedron,
        leaf: u32,
        ray: usize,
        line: &Line,
        [low, high]: [f64; 2],
        events: &mut Vec<Event>,
    ) -> First {
        let horizon = self.horizon();
        let Some(mut crosser) = self.crosser(mesh, ray, line) else {
            return First::Nothing;
        };
        let faces = &self.of_rays[ray];
        events.clear();
        let (mut passed, mut winding) = (0, 0);
        for (i, &(_, number)) in faces.iter().enumerate() {
            let (face, corners) = self.shown[number];
            if let Some((t, sense)) = crosser(corners) {
                let place = events.partition_point(|event| event.t < t);
                events.insert(place, Event { t, leaf, face, sense });
            }
            let next = faces.get(i + 1).map_or(horizon, |&(near, _)| near);
            let Some(last) = events.last() else { continue };
            if line.on_ray(last.t) >= next {
                continue;
            }
            // What follows is farther along the ray than all of these.
            while let Some(event) = events.get(passed) {
                let after = events.get(passed + 1);
                if after.is_some_and(|after| after.t <= event.t) {
                    return First::Unsure;
                }
                let was_inside = winding > 0;
                winding += if event.sense == Sense::Enter { 1 } else { -1 };
                passed += 1;
                if was_inside == (winding > 0) {
                    continue;
                }
                let place = line.on_ray(event.t);
                if place >= high {
                    return First::Nothing;
                }
                if place >= low {
                    if after.is_some_and(|after| line.on_ray(after.t) <= place) {
                        return First::Unsure;
                    }
                    return First::Crossed(*event, place, winding > 0);
                }
            }
        }
        First::Nothing
    }
}

/// What a ray that can meet only one mesh meets first.
#[derive(Clone, Copy, Debug)]
pub(super) enum First {
    /// Nothing that has been shown.
    Nothing,
    /// This, at this place on the ray, and whether it is in the mesh after that.
    Crossed(Event, f64, bool),
    /// There are crossings in one place, or in one place of the ray.
    Unsure,
}

/// A face as it is seen: for each edge the lines beyond which it is certain on which side of
/// the edge a ray is.
struct Outline {
    /// Multiples of right and up.
    weights: [[f32; 2]; 3],
    /// A sum below the first or above the second is certain.
    bounds: [[f32; 2]; 3],
    near: f64,
}

impl Outline {
    /// Nothing if the face is beside all rays.
    ///
    /// An edge function of corners that are off by δ each and at most S from the ray is off by
    /// 2 δ S + 2 δ²; divided by the sum of its two weights it is a distance. Where the edge
    /// passes by the block it does not matter how far away.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    fn new(
        sighting: &Sighting<'_>,
        points: &Points,
        corners: [DVec3; 3],
        off: f64,
    ) -> Option<Self> {
        /// More than the rounding of an edge function in single precision, with weights of at
        /// most 1 and a constant of at most 4.
        const SINGLE: f64 = 64.0 / 16_777_216.0;
        let [a, b, c] = corners;
        let (a, a_z) = sighting.seen(a, points);
        let (b, b_z) = sighting.seen(b, points);
        let (c, c_z) = sighting.seen(c, points);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let far = low.abs().max(high.abs());
        let reach = 2.0 + far.x + far.y;
        let room = 1.0 + SINGLE + off * reach;
        if low.x > room || low.y > room || high.x < -room || high.y < -room {
            return None;
        }
        let near = a_z.min(b_z).min(c_z) - 4.0 * sighting.off.x;
        let mut outline = Self { weights: [[0.0; 2]; 3], bounds: [[-1.0, 1.0]; 3], near };
        for (i, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let weights = DVec2::new(from.y - to.y, to.x - from.x);
            let length = weights.x.abs() + weights.y.abs();
            let error = SINGLE + 4.0 * off * reach * reach / length;
            let constant = from.perp_dot(to) / length;
            // Else it is certain of no ray.
            if error < 1.0 && constant.is_finite() {
                let constant = constant.clamp(-4.0, 4.0);
                outline.weights[i] =
                    [(weights.x / length) as f32, (weights.y / length) as f32];
                outline.bounds[i] =
                    [(-constant - error) as f32, (error - constant) as f32];
            }
        }
        Some(outline)
    }
}

struct Covered<'a> {
    outline: &'a Outline,
    points: &'a Points,
}

impl WithEight for Covered<'_> {
    type Output = u64;

    /// A bit for each ray that does not certainly pass by.
    #[inline(always)]
    fn with_eight<S: Eight>(self, simd: S) -> u64 {
        let Self { outline, points } = self;
        let mut rays = 0;
        for row in 0..BLOCK / EIGHT {
            let x = Numbers::load(simd, &points.places[0][row]);
            let y = Numbers::load(simd, &points.places[1][row]);
            let (mut left, mut right) = (0, 0);
            for edge in 0..3 {
                let [p, q] = outline.weights[edge];
                let [low, high] = outline.bounds[edge];
                let sum = x * Numbers::same(simd, p) + y * Numbers::same(simd, q);
                left |= Numbers::same(simd, high).less(sum);
                right |= sum.less(Numbers::same(simd, low));
            }
            rays |= u64::from(!(left & right) & 0xff) << (row * EIGHT);
        }
        rays
    }
}
