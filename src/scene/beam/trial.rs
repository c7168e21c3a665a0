//! The rays of a block against triangles of a mesh, each against its own, side by side.

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};

use super::block::{
    BLOCK, Block, Numbers, bits, is_wanted, load, load3, rays_of, store, store3,
};
use crate::lanes::{Lanes, Vec3, Vector};
use crate::shape::{Polyhedron, Sheared, ToLocal};

/// The lines of a block as a mesh sees them, and what has been asked of them.
#[derive(Clone, Debug)]
pub(super) struct Trials {
    /// The axes of the mesh as lines see them: the last is that along which they are steepest.
    axes: [usize; 3],
    /// Which lines are steepest along that one.
    sure: u64,
    scale: Numbers,
    origin: [Numbers; 3],
    /// How far a line goes on each axis; then the shift and the speed.
    dir: [Numbers; 3],
    step: Numbers,
    corners: [[Numbers; 3]; 3],
    pub(super) t: Numbers,
    pub(super) answer: Numbers,
}

impl Trials {
    /// The line passes by the triangle.
    pub(super) const MISSED: f64 = 0.0;
    /// It goes into the mesh there.
    pub(super) const ENTERED: f64 = 1.0;
    /// It comes out.
    pub(super) const LEFT: f64 = 2.0;
    /// It is to be looked at alone.
    pub(super) const DOUBT: f64 = 3.0;

    pub(super) const EMPTY: Self = Self {
        axes: [0, 1, 2],
        sure: 0,
        scale: [0.0; BLOCK],
        origin: [[0.0; BLOCK]; 3],
        dir: [[0.0; BLOCK]; 3],
        step: [0.0; BLOCK],
        corners: [[[0.0; BLOCK]; 3]; 3],
        t: [0.0; BLOCK],
        answer: [0.0; BLOCK],
    };

    /// Takes some lines of a block into the frame of a mesh; says which of them can be asked.
    pub(super) fn take(
        &mut self,
        arch: Arch,
        block: &Block,
        mesh: &Polyhedron,
        wanted: u64,
    ) -> u64 {
        let to_local = &mesh.to_local;
        arch.dispatch(Bring { trials: self, block, to_local, wanted });
        self.sure &= wanted;
        let steepest = |trials: &Self, ray: usize| {
            let [x, y, z] = trials.dir.each_ref().map(|numbers| numbers[ray]);
            DVec3::new(x, y, z).abs().max_position()
        };
        if self.sure != 0 {
            let z = steepest(self, self.sure.trailing_zeros() as usize);
            self.axes = [(z + 1) % 3, (z + 2) % 3, z];
            if !block.is_parallel() {
                for ray in bits(self.sure) {
                    self.sure &= !(u64::from(steepest(self, ray) != z) << ray);
                }
            }
            arch.dispatch(Shear { trials: self, scale: mesh.scale(), wanted });
        }
        self.sure
    }

    /// Gives a line the triangle that it is asked about.
    #[inline]
    pub(super) fn put(&mut self, ray: usize, corners: &[DVec3; 3]) {
        let ray = ray % BLOCK;
        for ([x, y, z], corner) in self.corners.iter_mut().zip(corners) {
            (x[ray], y[ray], z[ray]) = (corner.x, corner.y, corner.z);
        }
    }

    /// Asks some lines, and perhaps some more.
    pub(super) fn ask(&mut self, arch: Arch, wanted: u64) {
        arch.dispatch(Ask { trials: self, wanted });
    }
}

struct Bring<'a> {
    trials: &'a mut Trials,
    block: &'a Block,
    to_local: &'a ToLocal,
    wanted: u64,
}

impl WithSimd for Bring<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { trials, block, to_local, wanted } = self;
        let mut sure = [0.0; BLOCK];
        for i in 0..BLOCK / S::F64_LANES {
            if !is_wanted::<S>(wanted, i) {
                continue;
            }
            let rays = rays_of(block, simd, i);
            let from = Vec3::same(rays.dir.x, to_local.origin);
            let origin = ((rays.origin - from) + rays.rest).mapped(&to_local.linear);
            let dir = rays.dir.mapped(&to_local.linear);
            let zero = dir.x.same(0.0);
            let is_sure = origin.is_finite() & dir.is_finite() & zero.less(dir.largest());
            store3(&mut trials.origin, i, origin);
            store3(&mut trials.dir, i, dir);
            store(&mut sure, i, Vector::select(is_sure, dir.x.same(1.0), zero));
        }
        trials.sure =
            sure.iter().rev().fold(0, |bits, &is| bits << 1 | u64::from(is > 0.0));
    }
}

struct Shear<'a> {
    trials: &'a mut Trials,
    scale: f64,
    wanted: u64,
}

impl WithSimd for Shear<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { trials, scale, wanted } = self;
        for i in 0..BLOCK / S::F64_LANES {
            if is_wanted::<S>(wanted, i) {
                let origin = load3(simd, &trials.origin, i);
                let dir = load3(simd, &trials.dir, i);
                let sheared = Sheared::new(scale, origin, dir, trials.axes);
                let Sheared { scale, origin, shift: [x, y], speed, step } = sheared;
                store(&mut trials.scale, i, scale);
                store3(&mut trials.origin, i, origin);
                store3(&mut trials.dir, i, Vec3 { x, y, z: speed });
                store(&mut trials.step, i, step);
            }
        }
    }
}

struct Ask<'a> {
    trials: &'a mut Trials,
    wanted: u64,
}

impl WithSimd for Ask<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { trials, wanted } = self;
        for i in 0..BLOCK / S::F64_LANES {
            if is_wanted::<S>(wanted, i) {
                let Vec3 { x, y, z } = load3(simd, &trials.dir, i);
                let sheared = Sheared {
                    scale: load(simd, &trials.scale, i),
                    origin: load3(simd, &trials.origin, i),
                    shift: [x, y],
                    speed: z,
                    step: load(simd, &trials.step, i),
                };
                let [a, b, c] = &trials.corners;
                let a = turned(simd, a, trials.axes, i);
                let b = turned(simd, b, trials.axes, i);
                let c = turned(simd, c, trials.axes, i);
                let passed = sheared.crossing([a, b, c]);
                let [missed, entered, left, doubt] =
                    [Trials::MISSED, Trials::ENTERED, Trials::LEFT, Trials::DOUBT];
                let way = Vector::select(passed.is_exit, z.same(left), z.same(entered));
                let answer = Vector::select(passed.is_met, way, z.same(missed));
                let answer = Vector::select(passed.doubt, z.same(doubt), answer);
                store(&mut trials.t, i, passed.t);
                store(&mut trials.answer, i, answer);
            }
        }
    }
}

/// The points of packet `i`, their axes in another order.
#[inline(always)]
fn turned<S: Simd>(
    simd: S,
    points: &[Numbers; 3],
    [x, y, z]: [usize; 3],
    i: usize,
) -> Vec3<Vector<S>> {
    Vec3 {
        x: load(simd, &points[x], i),
        y: load(simd, &points[y], i),
        z: load(simd, &points[z], i),
    }
}
