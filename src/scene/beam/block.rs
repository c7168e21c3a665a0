//! The rays of a tile, side by side, and where they are inside of leaves.

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};

use super::bunch::Places;
use crate::fan::Fan;
use crate::lanes::{Lanes, Vec3, Vector};
use crate::shape::{Heading, Line, Lines, Rays, Shape, Stage, Stretch};

/// How many rays a block has: 8 × 8.
pub(super) const BLOCK: usize = 64;

/// One number for each ray of a block.
pub(super) type Numbers = [f64; BLOCK];

/// Rays and their lines, coordinate by coordinate.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Where in the fan the rays are.
    right: Numbers,
    up: Numbers,
    origin: [Numbers; 3],
    /// If lines have different ones.
    dir: [Numbers; 3],
    /// The direction of the lines, if all have the same.
    common_dir: Option<DVec3>,
    rest: [Numbers; 3],
    pub(super) offset: Numbers,
    scale: Numbers,
}

/// Where the rays of a block are inside a leaf, once; empty where `enter` is infinite.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    pub(super) leaf: u32,
    /// What entering the leaf adds to the state of the solid.
    pub(super) weight: u64,
    /// Whether the leaf has no other slot.
    pub(super) is_alone: bool,
    pub(super) enter: Numbers,
    pub(super) exit: Numbers,
    pub(super) enter_face: Numbers,
    pub(super) exit_face: Numbers,
}

impl Slot {
    /// Whether entering the leaf leaves a solid that is all of some literals.
    pub(super) fn is_cut(&self) -> bool {
        self.weight == 1
    }

    pub(super) const EMPTY: Self = Self {
        leaf: 0,
        weight: 0,
        is_alone: true,
        enter: [f64::INFINITY; BLOCK],
        exit: [f64::INFINITY; BLOCK],
        enter_face: [0.0; BLOCK],
        exit_face: [0.0; BLOCK],
    };
}

impl Block {
    pub(super) const EMPTY: Self = Self {
        right: [0.0; BLOCK],
        up: [0.0; BLOCK],
        origin: [[0.0; BLOCK]; 3],
        dir: [[0.0; BLOCK]; 3],
        common_dir: None,
        rest: [[0.0; BLOCK]; 3],
        offset: [0.0; BLOCK],
        scale: [0.0; BLOCK],
    };

    /// Says where in the fan a ray is.
    pub(super) fn set_place(&mut self, i: usize, [right, up]: [f64; 2]) {
        (self.right[i], self.up[i]) = (right, up);
    }

    /// Says where the first rays are.
    pub(super) fn set_places(&mut self, places: &Places<'_>) {
        let Places { right, up } = places;
        self.right[..right.len()].copy_from_slice(right);
        self.up[..up.len()].copy_from_slice(up);
    }

    /// Makes lines of the first rays of a fan; says which of them are valid and meet the
    /// bounds, which are bounded.
    pub(super) fn make_lines(
        &mut self,
        arch: Arch,
        fan: &Fan,
        count: usize,
        stage: &Stage,
    ) -> u64 {
        let met = arch.dispatch(MakeLines { block: self, fan, count, stage });
        met & u64::MAX >> (BLOCK - count)
    }

    /// One of the lines.
    pub(super) fn line(&self, i: usize) -> Line {
        let at = |numbers: &[Numbers; 3]| Vec3 {
            x: numbers[0][i],
            y: numbers[1][i],
            z: numbers[2][i],
        };
        let dir = self.common_dir.map_or_else(|| at(&self.dir), Vec3::from);
        let rays = Rays { origin: at(&self.origin), rest: at(&self.rest), dir };
        Line::from(Lines { rays, offset: self.offset[i], scale: self.scale[i] })
    }

    /// Whether all rays run the same way.
    pub(super) fn is_parallel(&self) -> bool {
        self.common_dir.is_some()
    }

    /// The direction of the lines, if all have the same.
    pub(super) fn common_dir(&self) -> Option<DVec3> {
        self.common_dir
    }

    /// A place on one of the lines as a place on its ray.
    pub(super) fn on_ray(&self, i: usize, t: f64) -> f64 {
        (self.offset[i] + t) * self.scale[i]
    }

    /// Where the rays are inside a leaf, as far as some of its faces say; in how many slots.
    /// Rays that are not wanted may be left out.
    pub(super) fn stretches(
        &self,
        arch: Arch,
        shape: &Shape,
        faces: u32,
        wanted: u64,
        slots: [&mut Slot; 2],
    ) {
        arch.dispatch(Stretches { block: self, shape, faces, wanted, slots });
    }
}

/// How many slots [`Block::stretches`] fills.
pub(super) fn slots_of(shape: &Shape, faces: u32) -> usize {
    match shape {
        Shape::Sides(leaf) => leaf.slots(faces),
        Shape::Polyhedron(_) => 0,
    }
}

struct MakeLines<'a> {
    block: &'a mut Block,
    fan: &'a Fan,
    count: usize,
    stage: &'a Stage,
}

impl WithSimd for MakeLines<'_> {
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        let Self { block, fan, count, stage } = self;
        let common = fan.common_dir();
        // What depends on a direction alone is found once where all have the same.
        let dir = common.unwrap_or(fan.dir.middle);
        let mut heading = Heading::new(Vec3::same(zero(simd), dir), stage);
        let mut met = 0;
        for i in 0..count.div_ceil(S::F64_LANES) {
            let (right, up) = (load(simd, &block.right, i), load(simd, &block.up, i));
            if common.is_none() {
                heading = Heading::new(fan.dir.at_places(right, up), stage);
                store3(&mut block.dir, i, heading.dir);
            }
            let origin = fan.origin.at_places(right, up);
            let (lines, valid) = Lines::new(origin, &heading, stage);
            let Lines { rays: Rays { origin, rest, .. }, offset, scale } = lines;
            store3(&mut block.origin, i, origin);
            store3(&mut block.rest, i, rest);
            store(&mut block.offset, i, offset);
            store(&mut block.scale, i, scale);
            met |= valid.bits() << (i * S::F64_LANES);
        }
        block.common_dir = common.map(|dir| Heading::new(dir.into(), stage).dir.into());
        met
    }
}

struct Stretches<'a> {
    block: &'a Block,
    shape: &'a Shape,
    faces: u32,
    wanted: u64,
    slots: [&'a mut Slot; 2],
}

impl WithSimd for Stretches<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self.block.common_dir {
            Some(dir) => self.find(simd, Some(Vec3::same(zero(simd), dir))),
            None => self.find(simd, None),
        }
    }
}

impl Stretches<'_> {
    #[inline(always)]
    fn find<S: Simd>(self, simd: S, common: Option<Vec3<Vector<S>>>) {
        let Self { block, shape, faces, wanted, slots: [first, second] } = self;
        let twice = slots_of(shape, faces) == 2;
        let dir = match common {
            Some(dir) => dir,
            None => load3(simd, &block.dir, 0),
        };
        let leaf = match shape {
            Shape::Sides(leaf) => leaf,
            Shape::Polyhedron(_) => return,
        };
        // What depends on a direction alone is found once where all have the same.
        let mut courses = leaf.courses(dir);
        for i in 0..BLOCK / S::F64_LANES {
            if is_wanted::<S>(wanted, i) {
                let rays = block.rays(simd, i, common);
                if common.is_none() {
                    courses = leaf.courses(rays.dir);
                }
                let [one, other] = leaf.stretches(faces, &rays, &courses);
                first.put(i, one);
                if twice {
                    second.put(i, other);
                }
            }
        }
    }
}

/// Whether any ray of packet `i` is wanted.
#[inline(always)]
pub(super) fn is_wanted<S: Simd>(wanted: u64, i: usize) -> bool {
    wanted >> (i * S::F64_LANES) & (u64::MAX >> (64 - S::F64_LANES)) != 0
}

impl Block {
    /// The lines of packet `i`, and their direction if all have the same.
    #[inline(always)]
    pub(super) fn rays<S: Simd>(
        &self,
        simd: S,
        i: usize,
        common: Option<Vec3<Vector<S>>>,
    ) -> Rays<Vector<S>> {
        Rays {
            origin: load3(simd, &self.origin, i),
            rest: load3(simd, &self.rest, i),
            dir: match common {
                Some(dir) => dir,
                None => load3(simd, &self.dir, i),
            },
        }
    }
}

impl Block {
    /// Where the lines of packet `i` begin along an axis: origin and rest.
    #[inline(always)]
    pub(super) fn coordinates<S: Simd>(
        &self,
        simd: S,
        i: usize,
        axis: usize,
    ) -> (Vector<S>, Vector<S>) {
        (load(simd, &self.origin[axis], i), load(simd, &self.rest[axis], i))
    }

    /// Places on the lines of packet `i` as places on their rays.
    #[inline(always)]
    pub(super) fn places_on_rays<S: Simd>(
        &self,
        simd: S,
        i: usize,
        t: Vector<S>,
    ) -> Vector<S> {
        (load(simd, &self.offset, i) + t) * load(simd, &self.scale, i)
    }
}

impl Slot {
    #[inline(always)]
    fn put<S: Simd>(&mut self, i: usize, stretch: Stretch<Vector<S>>) {
        let Stretch { enter, exit, enter_face, exit_face } = stretch;
        let never = enter.same(f64::INFINITY);
        let is_one = enter.less(exit);
        store(&mut self.enter, i, Vector::select(is_one, enter, never));
        store(&mut self.exit, i, Vector::select(is_one, exit, never));
        store(&mut self.enter_face, i, enter_face);
        store(&mut self.exit_face, i, exit_face);
    }
}

/// The lines of packet `i`.
#[inline(always)]
pub(super) fn rays_of<S: Simd>(block: &Block, simd: S, i: usize) -> Rays<Vector<S>> {
    match block.common_dir {
        Some(dir) => block.rays(simd, i, Some(Vec3::same(zero(simd), dir))),
        None => block.rays(simd, i, None),
    }
}

/// The numbers of the bits that are set.
pub(super) fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = set.trailing_zeros() as usize;
        let is_there = set != 0;
        set &= set.wrapping_sub(1);
        is_there.then_some(bit)
    })
}

/// Zero for all rays of a packet.
#[inline(always)]
pub(super) fn zero<S: Simd>(simd: S) -> Vector<S> {
    Vector(simd, simd.splat_f64s(0.0))
}

/// The numbers of packet `i`.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, numbers: &Numbers, i: usize) -> Vector<S> {
    let (vectors, _) = S::as_simd_f64s(numbers);
    Vector(simd, vectors[i])
}

#[inline(always)]
pub(super) fn load3<S: Simd>(
    simd: S,
    numbers: &[Numbers; 3],
    i: usize,
) -> Vec3<Vector<S>> {
    let [x, y, z] = numbers;
    Vec3 { x: load(simd, x, i), y: load(simd, y, i), z: load(simd, z, i) }
}

#[inline(always)]
pub(super) fn store<S: Simd>(numbers: &mut Numbers, i: usize, vector: Vector<S>) {
    let (vectors, _) = S::as_mut_simd_f64s(numbers);
    vectors[i] = vector.1;
}

#[inline(always)]
pub(super) fn store3<S: Simd>(
    numbers: &mut [Numbers; 3],
    i: usize,
    vectors: Vec3<Vector<S>>,
) {
    let [x, y, z] = numbers;
    store(x, i, vectors.x);
    store(y, i, vectors.y);
    store(z, i, vectors.z);
}
