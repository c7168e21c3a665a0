//! Many points.

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};

use super::block::{BLOCK, Block};
use super::cells::{ALONE, Cells, IN};
use super::grid::last_bits;
use crate::scene::{Scene, Tracer};

/// Scratch memory for many points in a scene; one for each thread.
pub(super) struct Chunks<'a> {
    arch: Arch,
    tracer: Tracer<'a>,
    cells: Option<&'a Cells>,
    scratch: Scratch,
}

/// What is known of points.
struct Scratch {
    block: Block,
    /// Points that are to be computed.
    open: Vec<Open>,
    /// Where in the order of plans the points of each end.
    ends: Vec<u32>,
    /// The numbers of the points in the order of their plans.
    order: Vec<u32>,
    /// Those that are near a surface.
    unsure: Vec<u32>,
}

/// A point, and its place in the order of plans.
#[derive(Clone, Copy, Debug, Default)]
struct Open {
    place: u32,
    point: u32,
}

impl<'a> Chunks<'a> {
    pub(super) fn new(scene: &'a Scene, cells: Option<&'a Cells>) -> Self {
        Self {
            arch: Arch::new(),
            tracer: scene.tracer(),
            cells,
            scratch: Scratch {
                block: Block::new(cells.map_or(0, |cells| cells.plans.slots())),
                open: Vec::new(),
                ends: Vec::new(),
                order: Vec::new(),
                unsure: Vec::new(),
            },
        }
    }

    /// What [`Tracer::contains`] says of points, at most 2³² of them.
    pub(super) fn answer(&mut self, points: &[DVec3], inside: &mut [bool]) {
        let Self { arch, tracer, cells, scratch } = self;
        let Some(cells) = *cells else {
            for (point, inside) in points.iter().zip(inside) {
                *inside = tracer.contains(*point);
            }
            return;
        };
        scratch.unsure.clear();
        if cells.is_one() {
            arch.dispatch(InOrder { cells, scratch, points, inside });
        } else {
            arch.dispatch(Sort { cells, scratch, points, inside });
        }
        for &i in &scratch.unsure {
            inside[i as usize] = tracer.contains(points[i as usize]);
        }
    }
}

/// Computes the one plan for points as they come.
struct InOrder<'a> {
    cells: &'a Cells,
    scratch: &'a mut Scratch,
    points: &'a [DVec3],
    inside: &'a mut [bool],
}

impl WithSimd for InOrder<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { cells, scratch: Scratch { block, unsure, .. }, points, inside } = self;
        let Cells { room, places, plans, equations, .. } = cells;
        let (inside_all, plan) = (places[0] == IN, places[0].checked_sub(ALONE));
        let blocks = points.chunks(BLOCK).zip(inside.chunks_mut(BLOCK));
        for (first, (points, inside)) in (0_u32..).step_by(BLOCK).zip(blocks) {
            let vectors = block.load(simd, points);
            let mut all_certain = block.is_within(simd, &room.bounds, vectors);
            let found = match plan {
                Some(plan) => {
                    let plan = plans.get(plan as usize);
                    block.compute(simd, plan, equations, 0..points.len())
                }
                None if inside_all => &[f64::NEG_INFINITY; _],
                None => &[f64::INFINITY; _],
            };
            for (value, inside) in found.iter().zip(inside) {
                *inside = *value < 0.0;
                all_certain &= value.abs() > 1.0;
            }
            if !all_certain {
                for ((i, point), value) in (first..).zip(points).zip(found) {
                    let is_certain = value.abs() > 1.0 && room.holds(*point);
                    if !is_certain {
                        unsure.push(i);
                    }
                }
            }
        }
    }
}

/// Sorts points by their plans, and computes those.
struct Sort<'a> {
    cells: &'a Cells,
    scratch: &'a mut Scratch,
    points: &'a [DVec3],
    inside: &'a mut [bool],
}

impl WithSimd for Sort<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { cells, scratch, points, inside } = self;
        let Cells { grid, places, plans, equations, .. } = cells;
        let Scratch { block, open, ends, order, unsure } = scratch;
        open.resize(points.len() + 1, Open::default());
        // Decided points count too, on places of their own.
        let plans_from = ALONE as usize;
        ends.clear();
        ends.resize(plans_from + plans.len(), 0);
        let (mut count, mut numbers) = (0, [0.0; _]);
        let blocks = points.chunks(BLOCK).zip(inside.chunks_mut(BLOCK));
        for (first, (points, inside)) in (0_u32..).step_by(BLOCK).zip(blocks) {
            let vectors = block.load(simd, points);
            grid.locate(simd, &block.points, &mut numbers, vectors);
            for ((point, number), inside) in (first..).zip(&numbers).zip(inside) {
                let place = places[last_bits(*number)];
                *inside = place == IN;
                open[count] = Open { place, point };
                ends[place as usize] += 1;
                count += usize::from(place >= ALONE);
            }
        }
        let open = &open[..count];
        let ends = &mut ends[plans_from..];
        let mut sum = 0;
        for end in ends.iter_mut() {
            sum += std::mem::replace(end, sum);
        }
        order.resize(order.len().max(count), 0);
        for Open { place, point } in open {
            let end = &mut ends[(place - ALONE) as usize];
            order[*end as usize] = *point;
            *end += 1;
        }
        // Points that ask one by one come first.
        let alone = ends[0] as usize;
        unsure.extend_from_slice(&order[..alone]);
        let mut plan = 1;
        for (block_number, numbers) in order[alone..count].chunks(BLOCK).enumerate() {
            let first = alone + block_number * BLOCK;
            block.gather(points, numbers);
            let mut start = 0;
            while start < numbers.len() {
                while ends[plan] as usize <= first + start {
                    plan += 1;
                }
                let end = (ends[plan] as usize - first).min(numbers.len());
                let found = block.compute(simd, plans.get(plan), equations, start..end);
                let numbers = &numbers[start..end];
                let mut all_certain = true;
                for (&point, &value) in numbers.iter().zip(found) {
                    inside[point as usize] = value < 0.0;
                    all_certain &= value.abs() > 1.0;
                }
                if !all_certain {
                    for (&point, &value) in numbers.iter().zip(found) {
                        let is_certain = value.abs() > 1.0;
                        if !is_certain {
                            unsure.push(point);
                        }
                    }
                }
                start = end;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::op::Op;
    use crate::solid::Solid;

    /// Machines without vectors say the same, and ask a line of the same points.
    #[test]
    fn vectors_answer_as_single_numbers_do() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut point = || DVec3::new(number(), number(), number());
        let leaves: Vec<Solid> = (0..40)
            .map(|i| {
                let leaf = match i % 3 {
                    0 => Solid::ball(0.1),
                    1 => Solid::cuboid(DVec3::new(0.1, 0.2, 0.3)),
                    _ => Solid::frustum(0.1, 0.05, 0.2).rotated(DVec3::X, 0.3),
                };
                leaf.translated((8.0 * point()).round() / 8.0)
            })
            .collect();
        for leaves in [&leaves[..4], &leaves] {
            let solid = Solid::boolean(Op::Difference, leaves.iter().cloned());
            let solid = solid + Solid::boolean(Op::Union, leaves.iter().cloned());
            let scene = Scene::compile(&solid).expect("the solid is right");
            let cells = Cells::new(&scene).expect("there is room");
            let points: Vec<DVec3> = (0..4001)
                .map(|i| {
                    let p = 1.2 * point() - 0.1;
                    if i % 3 == 0 { (16.0 * p).round() / 16.0 } else { p }
                })
                .collect();
            let [vectors, single] = [Arch::new(), Arch::Scalar].map(|arch| {
                let mut chunks = Chunks { arch, ..Chunks::new(&scene, Some(&cells)) };
                let mut inside = vec![false; points.len()];
                chunks.answer(&points, &mut inside);
                (inside, chunks.scratch.unsure)
            });
            assert!(vectors == single);
            assert!(single.0.contains(&true) && !single.1.is_empty());
        }
    }
}
