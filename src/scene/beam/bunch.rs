//! Every span of rays that are near to one another.

use glam::DVec3;
use pulp::Arch;

use super::block::{BLOCK, Block};
use super::packet::Packet;
use super::sight::Sight;
use super::survey::{List, Survey};
use crate::fan::Fan;
use crate::ray::{Ray, Span};
use crate::scene::{Scene, Tracer};

/// Rays of a fan at places in a rectangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bunch<'a> {
    pub(crate) fan: &'a Fan,
    pub(crate) corners: [[f64; 2]; 2],
    pub(crate) places: Places<'a>,
}

/// Where in a fan rays are: how far to the right, and how far up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places<'a> {
    pub(crate) right: &'a [f64],
    pub(crate) up: &'a [f64],
}

impl<'a> Places<'a> {
    fn len(&self) -> usize {
        self.right.len()
    }

    /// Block by block, with the number of the first of each.
    fn blocks(self) -> impl Iterator<Item = (usize, Self)> + use<'a> {
        let blocks = self.right.chunks(BLOCK).zip(self.up.chunks(BLOCK));
        (0..).step_by(BLOCK).zip(blocks.map(|(right, up)| Self { right, up }))
    }

    /// One ray of a fan.
    fn ray(&self, fan: &Fan, i: usize) -> Ray {
        fan.ray(self.right[i], self.up[i])
    }
}

/// Scratch memory for bunches of rays through a scene; one for each thread.
#[derive(Debug)]
pub(crate) struct BunchTracer<'a> {
    scene: &'a Scene,
    survey: Survey<'a>,
    block: Box<Block>,
    packet: Packet,
    tracer: Tracer<'a>,
}

impl<'a> BunchTracer<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        Self::on(Arch::new(), scene)
    }

    /// On a machine with some vectors.
    pub(super) fn on(arch: Arch, scene: &'a Scene) -> Self {
        Self {
            scene,
            survey: Survey::new(scene),
            block: Box::new(Block::EMPTY),
            packet: Packet::new(arch),
            tracer: scene.tracer(),
        }
    }

    /// Calls `visit` with the number of each ray that may meet the solid and a tracer that
    /// has just found what [`Tracer::spans`] says of it.
    pub(crate) fn spans(
        &mut self,
        bunch: &Bunch<'_>,
        mut visit: impl FnMut(usize, &Ray, &Tracer<'a>),
    ) {
        let Some((sight, all)) = self.look_at(bunch) else {
            return;
        };
        for (first, places) in bunch.places.blocks() {
            let mut open = self.make_lines(bunch.fan, &places);
            self.packet.meet(self.scene, &self.block, open);
            while let Some(i) = next(&mut open) {
                let ray = places.ray(bunch.fan, i);
                self.walk(i, sight.depth);
                visit(first + i, &ray, &self.tracer);
            }
        }
        self.survey.leave(&all);
    }

    /// Calls `visit` with the number of each ray that may meet the solid and its chords.
    pub(crate) fn chords(
        &mut self,
        bunch: &Bunch<'_>,
        mut visit: impl FnMut(usize, Chords),
    ) {
        let Some((sight, all)) = self.look_at(bunch) else {
            return;
        };
        let slowest = slowest(bunch);
        let thin = self.scene.longest_thin(sight.reach) / (slowest * slowest);
        for (first, places) in bunch.places.blocks() {
            let wanted = self.make_lines(bunch.fan, &places);
            let (packet, depth) = (&mut self.packet, sight.depth);
            let mut doubt =
                packet.find_chords(self.scene, &self.block, wanted, depth, thin);
            let mut sure = wanted & !doubt;
            while let Some(i) = next(&mut sure) {
                visit(first + i, packet.chords(i));
            }
            if doubt != 0 {
                self.packet.meet(self.scene, &self.block, doubt);
            }
            while let Some(i) = next(&mut doubt) {
                let ray = places.ray(bunch.fan, i);
                self.walk(i, sight.depth);
                visit(first + i, Chords::found(&self.tracer, &ray));
            }
        }
        self.survey.leave(&all);
    }

    /// Finds the leaves that matter to a bunch; nothing if it does not meet the solid. To be
    /// followed by leaving what has been looked at.
    fn look_at<'b>(&mut self, bunch: &Bunch<'b>) -> Option<(Sight<'b>, List)> {
        if !self.scene.stage.is_bounded {
            return None;
        }
        let sight = Sight::new(bunch.fan, bunch.corners, self.scene);
        let region = sight.region(bunch.corners, sight.depth);
        let all = self.survey.all(&region);
        let Some(list) = self.survey.enter(&region, &all) else {
            self.survey.leave(&all);
            return None;
        };
        let (known, leaves) = self.survey.found(&list);
        self.packet.choose(self.scene, known, leaves, region.along());
        Some((sight, all))
    }

    /// Makes a block of rays; says which may meet the solid.
    fn make_lines(&mut self, fan: &Fan, places: &Places<'_>) -> u64 {
        self.block.set_places(places);
        let (arch, stage) = (self.packet.arch, &self.scene.stage);
        self.block.make_lines(arch, fan, places.len(), stage)
    }

    /// Has the tracer know the spans of a ray of the block, which are between two depths.
    fn walk(&mut self, i: usize, depth: [f64; 2]) {
        let Self { scene, survey, block, packet, tracer } = self;
        if !packet.spans_by_walk(block, i, depth, tracer) {
            let line = block.line(i);
            tracer.spans_among(&mut survey.known.counts, &line, depth, |events| {
                packet.add_events(scene, &line, i, events);
            });
        }
    }
}

/// The chords of one ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Chords {
    /// The sum of their lengths, in steps of the ray.
    pub(crate) length: f64,
    /// How many there are.
    pub(crate) spans: u64,
    /// How many of them, and of the gaps between them, are shorter than rounding.
    pub(crate) uncertain: u64,
}

impl Chords {
    /// Those of a ray whose spans a tracer has just found.
    pub(crate) fn found(tracer: &Tracer<'_>, ray: &Ray) -> Self {
        let spans = tracer.spans_found();
        Self {
            length: spans.iter().map(Span::length).sum(),
            spans: spans.len() as u64,
            uncertain: tracer.uncertain(ray),
        }
    }
}

/// The number of the lowest bit, which is taken away.
fn next(bits: &mut u64) -> Option<usize> {
    let lowest = (*bits != 0).then(|| bits.trailing_zeros() as usize);
    *bits &= bits.wrapping_sub(1);
    lowest
}

/// A length that no direction of the rays of a bunch is shorter than.
fn slowest(bunch: &Bunch<'_>) -> f64 {
    let dir = &bunch.fan.dir;
    // Directions differ across, if at all, by what does not make them shorter along.
    let along = dir.right.cross(dir.up).normalize_or_zero();
    if along == DVec3::ZERO { dir.middle.length() } else { dir.middle.dot(along).abs() }
}
