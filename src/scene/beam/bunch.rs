//! Every span of rays that are near to one another.

use super::block::{BLOCK, Block};
use super::packet::Packet;
use super::sight::Sight;
use super::survey::Survey;
use crate::fan::Fan;
use crate::ray::Ray;
use crate::scene::{Scene, Tracer};

/// Rays of a fan at places in a rectangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bunch<'a> {
    pub(crate) fan: &'a Fan,
    pub(crate) corners: [[f64; 2]; 2],
    pub(crate) places: &'a [[f64; 2]],
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
        Self {
            scene,
            survey: Survey::new(scene),
            block: Box::new(Block::EMPTY),
            packet: Packet::new(),
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
        let Bunch { fan, corners, places } = *bunch;
        if !self.scene.bounds.is_bounded() {
            return;
        }
        let sight = Sight::new(fan, corners, self.scene);
        let region = sight.region(corners, sight.depth);
        let all = self.survey.all(&region);
        if let Some(list) = self.survey.enter(&region, &all) {
            let (known, leaves) = self.survey.found(&list);
            self.packet.choose(self.scene, known, leaves, region.along());
            for (first, places) in (0..).step_by(BLOCK).zip(places.chunks(BLOCK)) {
                self.trace(fan, places, |i, ray, tracer| visit(first + i, ray, tracer));
            }
        }
        self.survey.leave(&all);
    }

    /// The same for the rays of one block.
    fn trace(
        &mut self,
        fan: &Fan,
        places: &[[f64; 2]],
        mut visit: impl FnMut(usize, &Ray, &Tracer<'a>),
    ) {
        let Self { scene, block, packet, tracer, survey } = self;
        for (i, &[right, up]) in places.iter().enumerate() {
            block.set_ray(i, &fan.ray(right, up));
        }
        let wanted = u64::MAX >> (BLOCK - places.len());
        let mut open = wanted & block.make_lines(packet.arch, &scene.bounds);
        packet.meet(scene, block, open);
        while open != 0 {
            let i = open.trailing_zeros() as usize;
            open &= open - 1;
            let [right, up] = places[i];
            let ray = fan.ray(right, up);
            if !packet.spans_by_walk(block, i, tracer) {
                let line = block.line(i);
                tracer.spans_among(&mut survey.known.counts, &line, |events| {
                    packet.add_events(scene, &line, i, events);
                });
            }
            visit(i, &ray, tracer);
        }
    }
}
