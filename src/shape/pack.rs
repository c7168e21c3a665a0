//! Eight triangles side by side, for what a line certainly passes by.

use glam::{DVec2, DVec3};

use crate::bvh::{Probe, Unit};
use crate::eight::{EIGHT, Eight, Numbers, WithEight};
use crate::mesh::Mesh;

/// Up to eight faces of a mesh and their corners, in the units of a tree and in single
/// precision: 448 bytes, whole lines of a cache.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct Pack {
    /// By corner and axis.
    corners: [[[f32; EIGHT]; 3]; 3],
    /// [`NONE`] behind the last face.
    faces: [u32; EIGHT],
    /// The numbers of the corners among [`Points`].
    points: [[u32; 3]; EIGHT],
}

/// No face has this number.
const NONE: u32 = u32::MAX;

impl Pack {
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    pub(super) fn new(
        mesh: &Mesh,
        unit: &Unit,
        faces: &[u32],
        points: &mut Points<'_>,
    ) -> Self {
        let mut pack = Self {
            corners: [[[0.0; EIGHT]; 3]; 3],
            faces: [NONE; EIGHT],
            points: [[0; 3]; EIGHT],
        };
        for (i, &face) in faces.iter().enumerate() {
            pack.faces[i] = face;
            pack.points[i] =
                mesh.faces()[face as usize].map(|point| points.number(point));
            let corners = mesh.corners(face as usize).map(|p| unit.point(p));
            for (numbers, corner) in pack.corners.iter_mut().zip(corners) {
                for (axis, x) in numbers.iter_mut().zip(corner.to_array()) {
                    axis[i] = x as f32;
                }
            }
        }
        pack
    }

    pub(super) fn faces(&self) -> impl Iterator<Item = u32> {
        self.faces.into_iter().take_while(|&face| face != NONE)
    }

    /// How many faces there are.
    #[inline(always)]
    fn count(&self) -> u32 {
        let mut count = 0;
        for face in self.faces {
            count += u32::from(face != NONE);
        }
        count
    }

    /// A face by the number of its bit, if there are so many.
    #[inline(always)]
    pub(crate) fn face(&self, bit: u32) -> Option<u32> {
        Some(self.faces[bit as usize]).filter(|&face| face != NONE)
    }

    /// A face and its corners, by the number of its bit.
    #[inline(always)]
    pub(super) fn exact(&self, bit: u32, points: &[DVec3]) -> Option<(u32, [DVec3; 3])> {
        Some((self.face(bit)?, self.corners(bit, points)))
    }

    /// The corners of a face, by the number of its bit.
    #[inline(always)]
    pub(super) fn corners(&self, bit: u32, points: &[DVec3]) -> [DVec3; 3] {
        let [a, b, c] = self.points[bit as usize];
        [points[a as usize], points[b as usize], points[c as usize]]
    }

    /// A bit for each face that is not certainly passed by.
    ///
    /// A face is passed by if the line is on the left of one edge and on the right of another:
    /// if the triangles that it makes with them have areas of different signs. With coordinates
    /// off by at most δ, as [`Sight`] has it, and at most X and Y seen along the line, an area
    /// `x y' − y x'` is off by 2 δ (X + Y) + 2 δ², and by 4 e X Y for its own rounding,
    /// e = 2⁻²⁴. That is at most 12 e (X + Y), as coordinates are at most 6, and δ > 32 e.
    #[inline(always)]
    pub(super) fn near<S: Eight>(&self, simd: S, sight: &Sight) -> u32 {
        let [a, b, c] = &self.corners;
        let [ax, ay] = sight.beside(simd, a);
        let [bx, by] = sight.beside(simd, b);
        let [cx, cy] = sight.beside(simd, c);
        let bc = bx * cy - by * cx;
        let ca = cx * ay - cy * ax;
        let ab = ax * by - ay * bx;
        let x = ax.abs().max(bx.abs()).max(cx.abs());
        let y = ay.abs().max(by.abs()).max(cy.abs());
        let [room, least] = sight.room;
        let error = (x + y) * Numbers::same(simd, room) + Numbers::same(simd, least);
        let zero = Numbers::same(simd, 0.0);
        let is_left = error.less(bc.max(ca).max(ab));
        let is_right = bc.min(ca).min(ab).less(zero - error);
        !(is_left & is_right) & 0xff
    }
}

/// The points of a mesh in the order in which packs want them, so that those of a pack are
/// near each other in memory.
pub(super) struct Points<'a> {
    mesh: &'a Mesh,
    /// By the number in the mesh.
    numbers: Vec<u32>,
    list: Vec<DVec3>,
}

impl<'a> Points<'a> {
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        let count = mesh.points().len();
        Self { mesh, numbers: vec![NONE; count], list: Vec::with_capacity(count) }
    }

    /// The number of a point in the list, to which it is added if it is not there.
    fn number(&mut self, point: u32) -> u32 {
        let number = &mut self.numbers[point as usize];
        if *number == NONE {
            *number = u32::try_from(self.list.len()).expect("points have such numbers");
            self.list.push(self.mesh.points()[point as usize]);
        }
        *number
    }

    pub(super) fn into_list(mut self) -> Vec<DVec3> {
        self.list.shrink_to_fit();
        self.list
    }
}

/// Some linear functions of places in the units of a tree, and how far off they may be
/// found in single precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear {
    weights: [f32; 3],
    constant: f32,
    /// The error, and no less in single precision.
    error: f64,
    room: f32,
}

impl Linear {
    /// The function `weights · (p − origin) + constant` of points of a mesh, which is off by
    /// `error` already.
    ///
    /// With weights whose absolute values add up to W, a constant C and places of at most 1
    /// there are at most 8 roundings by e = 2⁻²⁴ of no more than W + C each.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    pub(super) fn new(
        unit: &Unit,
        weights: DVec3,
        origin: DVec3,
        constant: f64,
        error: f64,
    ) -> Self {
        let (weights, away) = unit.linear(weights, origin);
        let constant = away + constant;
        let size = weights.abs().element_sum() + constant.abs();
        let error = error + size * (16.0 / 16_777_216.0);
        Self {
            weights: weights.to_array().map(|w| w as f32),
            constant: constant as f32,
            error,
            room: (error as f32).next_up(),
        }
    }

    #[inline(always)]
    fn of<S: Eight>(&self, simd: S, corner: &[[f32; EIGHT]; 3]) -> Numbers<S> {
        let [x, y, z] = self.weights.map(|weight| Numbers::same(simd, weight));
        let [a, b, c] = corner;
        Numbers::load(simd, a) * x
            + Numbers::load(simd, b) * y
            + Numbers::load(simd, c) * z
            + Numbers::same(simd, self.constant)
    }
}

/// How triangles are seen in a plane, where rays are points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    across: [Linear; 2],
    depth: Linear,
    is_parallel: bool,
    /// What the error of a place is: this, and this for each unit of its coordinates.
    room: [f32; 2],
}

impl View {
    /// With functions for how far to the right and how far up a point is seen, and its depth.
    /// For rays that run apart the first two are times the depth, which is nowhere less than
    /// `nearest`.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    pub(crate) fn new(across: [Linear; 2], depth: Linear, nearest: Option<f64>) -> Self {
        /// More than what dividing rounds.
        const SINGLE: f64 = 4.0 / 16_777_216.0;
        let error = across[0].error.max(across[1].error);
        let room = match nearest {
            None => [error, 0.0],
            Some(nearest) => {
                let depth_left = (nearest - depth.error).max(0.0);
                [error / depth_left, depth.error / depth_left + SINGLE]
            }
        };
        let room = room.map(|room| (1.001 * room) as f32);
        Self { across, depth, is_parallel: nearest.is_none(), room }
    }

    /// Whether places have room in single precision: the functions are neither too large for
    /// it, nor so small that it rounds them to fewer digits.
    pub(crate) fn has_room(&self) -> bool {
        const LEAST: f32 = 1e-30;
        const MOST: f32 = 1e30;
        let all = [self.across[0], self.across[1], self.depth];
        all.iter().all(|Linear { weights: [x, y, z], constant, error, .. }| {
            let size = x.abs() + y.abs() + z.abs() + constant.abs();
            (LEAST..MOST).contains(&size) && *error < f64::from(MOST)
        })
    }

    /// More than the error of a depth.
    pub(crate) fn depth_room(&self) -> f64 {
        4.0 * self.depth.error
    }

    /// What no place on a ray is in front of, if it is found to be at some depth.
    pub(crate) fn in_front_of(&self, depth: f32) -> f64 {
        f64::from(depth) - self.depth.error
    }
}

/// Eight triangles as they are seen.
pub(crate) struct Seen<S: Eight> {
    /// By corner: how far to the right, and how far up.
    pub(crate) corners: [[Numbers<S>; 2]; 3],
    /// The depth of the nearest corner.
    pub(crate) near: Numbers<S>,
    /// The largest coordinates.
    pub(crate) far: Numbers<S>,
    /// At most how far beside where it should be a corner is seen on either axis.
    pub(crate) off: Numbers<S>,
}

impl Pack {
    #[inline(always)]
    pub(crate) fn seen<S: Eight>(&self, simd: S, view: &View) -> Seen<S> {
        let [a, b, c] = &self.corners;
        let depths =
            [view.depth.of(simd, a), view.depth.of(simd, b), view.depth.of(simd, c)];
        let a = view.place(simd, a, depths[0]);
        let b = view.place(simd, b, depths[1]);
        let c = view.place(simd, c, depths[2]);
        let far_x = a[0].abs().max(b[0].abs()).max(c[0].abs());
        let far_y = a[1].abs().max(b[1].abs()).max(c[1].abs());
        let far = far_x.max(far_y);
        let [off, for_each] = view.room.map(|number| Numbers::same(simd, number));
        Seen {
            corners: [a, b, c],
            near: depths[0].min(depths[1]).min(depths[2]),
            far,
            off: off + far * for_each,
        }
    }
}

impl View {
    #[inline(always)]
    fn place<S: Eight>(
        &self,
        simd: S,
        corner: &[[f32; EIGHT]; 3],
        depth: Numbers<S>,
    ) -> [Numbers<S>; 2] {
        let [right, up] = &self.across;
        let (x, y) = (right.of(simd, corner), up.of(simd, corner));
        if self.is_parallel { [x, y] } else { [x / depth, y / depth] }
    }
}

/// Faces of a pack that are not all on the wrong side of some planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    pub(crate) pack: u32,
    /// A bit for each face.
    pub(crate) faces: u32,
    /// Between which values of a function they all are.
    pub(crate) range: [f64; 2],
}

/// Sorts out the faces of packs that are on the positive side of a plane.
pub(super) struct Keep<'a> {
    pub(super) packs: &'a [Pack],
    pub(super) numbers: &'a [u32],
    pub(super) planes: &'a [Linear; 4],
    pub(super) depth: &'a Linear,
    pub(super) kept: &'a mut Vec<Kept>,
}

impl WithEight for Keep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_eight<S: Eight>(self, simd: S) {
        let Self { packs, numbers, planes, depth, kept } = self;
        for &number in numbers {
            let pack = &packs[number as usize];
            let [a, b, c] = &pack.corners;
            let mut out = 0;
            for plane in planes {
                let least =
                    plane.of(simd, a).min(plane.of(simd, b)).min(plane.of(simd, c));
                out |= Numbers::same(simd, plane.room).less(least);
            }
            let mut faces = !out & ((1_u32 << pack.count()) - 1);
            if faces == 0 {
                continue;
            }
            let [p, q, r] = [depth.of(simd, a), depth.of(simd, b), depth.of(simd, c)];
            let (least, most) = (p.min(q).min(r).store(), p.max(q).max(r).store());
            let mut range = [f32::INFINITY, f32::NEG_INFINITY];
            let all = faces;
            while faces != 0 {
                let i = faces.trailing_zeros() as usize;
                range = [range[0].min(least[i]), range[1].max(most[i])];
                faces &= faces - 1;
            }
            let range =
                [f64::from(range[0]) - depth.error, f64::from(range[1]) + depth.error];
            kept.push(Kept { pack: number, faces: all, range });
        }
    }
}

/// A line in the units of a tree, along which triangles are looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    /// Those across the line, and the one along it.
    axes: [usize; 3],
    shift: [f32; 2],
    origin: [f32; 2],
    /// What the error of an area is: this for each unit of coordinates, and this.
    room: [f32; 2],
}

impl Sight {
    /// The line of a probe, which moves by `shift` on the first two axes for each step on the
    /// third.
    ///
    /// With `e = 2⁻²⁴`, corners of at most 1, an origin of at most 1.8 and shifts of at most
    /// 1, coordinates across are off by 15.2 e, and by twice what rounding in double precision
    /// has done: the sum of what each operation of [`Sight::beside`] adds.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    #[inline(always)]
    pub(super) fn new(probe: &Probe, axes: [usize; 3], shift: DVec2) -> Self {
        let origin: DVec3 = probe.origin;
        let [x, y, z] = axes;
        let off = 2.0 * probe.pad;
        Self {
            axes,
            shift: [shift.x as f32, shift.y as f32],
            origin: [
                (origin[x] - shift.x * origin[z]) as f32,
                (origin[y] - shift.y * origin[z]) as f32,
            ],
            room: [(3.0 * off) as f32, (4.0 * off * off) as f32],
        }
    }

    /// Where corners are, seen along the line.
    #[inline(always)]
    fn beside<S: Eight>(&self, simd: S, corner: &[[f32; EIGHT]; 3]) -> [Numbers<S>; 2] {
        let [x, y, z] = self.axes;
        let along = Numbers::load(simd, &corner[z]);
        [
            Numbers::load(simd, &corner[x])
                - along * Numbers::same(simd, self.shift[0])
                - Numbers::same(simd, self.origin[0]),
            Numbers::load(simd, &corner[y])
                - along * Numbers::same(simd, self.shift[1])
                - Numbers::same(simd, self.origin[1]),
        ]
    }
}
