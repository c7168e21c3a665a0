//! Rays by the batch: answered on as many threads as there are, printed in their order, and
//! never more of them in memory than a batch has.

use std::io::Write;

use anyhow::bail;
use solidray::{Ray, Scene, Span, Tracer};

use super::super::meter::Meter;

/// How many rays are kept before they are answered: enough for many threads, few enough that
/// their answers take little memory.
const BATCH: usize = 2048;

/// How many of them a thread takes at a time.
const CHUNK: usize = 64;

/// Prints the answer to the ray of a number.
type Print<'a> =
    dyn Fn(u64, &Ray, &[Span], &mut Vec<u8>) -> anyhow::Result<()> + Sync + 'a;

/// Rays that wait for their answers.
pub(super) struct Batch<'a> {
    scene: &'a Scene,
    print: &'a Print<'a>,
    meter: &'a Meter,
    out: &'a mut dyn Write,
    rays: Vec<Ray>,
    /// How many rays are answered.
    done: u64,
}

impl<'a> Batch<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        print: &'a Print<'a>,
        meter: &'a Meter,
        out: &'a mut dyn Write,
    ) -> Self {
        Self { scene, print, meter, out, rays: Vec::new(), done: 0 }
    }

    /// Takes one more ray, and answers all that wait if they are many.
    pub(super) fn push(&mut self, ray: Ray) -> anyhow::Result<()> {
        if !ray.is_valid() {
            bail!("the direction is zero");
        }
        self.rays.push(ray);
        if self.rays.len() < BATCH { Ok(()) } else { self.flush() }
    }

    /// Answers all rays that wait, where it is seen.
    pub(super) fn answer(&mut self) -> anyhow::Result<()> {
        self.flush()?;
        Ok(self.out.flush()?)
    }

    /// Answers all rays that wait.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        let (print, done) = (self.print, self.done);
        let answer = |tracer: &mut Tracer<'_>, chunk: usize, rays: &[Ray]| {
            let first = done + (chunk * CHUNK) as u64;
            let mut text = Vec::new();
            (first..).zip(rays).try_for_each(|(number, ray)| {
                print(number, ray, tracer.spans(ray), &mut text)
            })?;
            Ok(text)
        };
        for text in answers(self.scene, &self.rays, answer) {
            self.out.write_all(&text?)?;
        }
        self.done += self.rays.len() as u64;
        self.meter.tick(self.rays.len() as u64);
        self.rays.clear();
        Ok(())
    }
}

/// What `answer` says of each chunk of rays, in their order.
#[cfg(feature = "parallel")]
fn answers<'s>(
    scene: &'s Scene,
    rays: &[Ray],
    answer: impl Fn(&mut Tracer<'s>, usize, &[Ray]) -> anyhow::Result<Vec<u8>> + Sync,
) -> Vec<anyhow::Result<Vec<u8>>> {
    use rayon::prelude::*;

    rays.par_chunks(CHUNK)
        .enumerate()
        .map_init(|| scene.tracer(), |tracer, (i, rays)| answer(tracer, i, rays))
        .collect()
}

/// What `answer` says of each chunk of rays, in their order.
#[cfg(not(feature = "parallel"))]
fn answers<'s>(
    scene: &'s Scene,
    rays: &[Ray],
    answer: impl Fn(&mut Tracer<'s>, usize, &[Ray]) -> anyhow::Result<Vec<u8>>,
) -> Vec<anyhow::Result<Vec<u8>>> {
    let mut tracer = scene.tracer();
    rays.chunks(CHUNK).enumerate().map(|(i, rays)| answer(&mut tracer, i, rays)).collect()
}
