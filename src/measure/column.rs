//! The points of lattices, put into bunches of neighbours.

use glam::DVec2;

use super::beam::{Beam, Samples};
use crate::lanes::whole;
use crate::sampling::Fibonacci;
use crate::scene::Bunch;

/// The points of all lattices in one column of a grid, row by row.
#[derive(Debug, Default)]
pub(super) struct Column {
    found: Vec<(usize, u8, [f64; 2])>,
    /// Where the rows begin, and the last one ends.
    rows: Vec<usize>,
    pub(super) places: Vec<[f64; 2]>,
    replicates: Vec<u8>,
}

impl Column {
    /// Finds the points of a column.
    pub(super) fn fill(
        &mut self,
        lattice: Fibonacci,
        shifts: &[DVec2],
        [columns, rows]: [u64; 2],
        number: u64,
    ) {
        let last_row = (rows - 1) as f64;
        // What rounding takes over the far edge is of the last column.
        let beyond =
            if number + 1 < columns { (number + 1) as f64 } else { f64::INFINITY };
        self.found.clear();
        self.rows.clear();
        self.rows.resize(usize_of(rows) + 1, 0);
        let [from, to] = [number, number + 1].map(|i| i as f64 / columns as f64);
        for (replicate, &shift) in (0..).zip(shifts) {
            for p in lattice.between(from, to, shift) {
                let column = p.x * columns as f64;
                if column >= number as f64 && column < beyond {
                    let row = usize_of(whole((p.y * rows as f64).min(last_row)));
                    self.rows[row + 1] += 1;
                    self.found.push((row, replicate, [p.x - 0.5, p.y - 0.5]));
                }
            }
        }
        for row in 1..self.rows.len() {
            self.rows[row] += self.rows[row - 1];
        }
        // Points are put in the order of their rows, those of a row as they were found.
        let mut next = self.rows.clone();
        self.places.resize(self.found.len(), [0.0; 2]);
        self.replicates.resize(self.found.len(), 0);
        for &(row, replicate, place) in &self.found {
            let next = &mut next[row];
            self.places[*next] = place;
            self.replicates[*next] = replicate;
            *next += 1;
        }
    }

    /// The bunches of the column that was filled last.
    pub(super) fn bunches<'a>(
        &'a self,
        beam: &'a Beam,
        [columns, rows]: [u64; 2],
        number: u64,
    ) -> impl Iterator<Item = Samples<'a>> {
        let edge = |i: u64, count: u64| i as f64 / count as f64 - 0.5;
        let [left, right] = [number, number + 1].map(|i| edge(i, columns));
        (0..).zip(self.rows.windows(2)).filter(|(_, range)| range[0] < range[1]).map(
            move |(row, range)| {
                let corners = [[left, edge(row, rows)], [right, edge(row + 1, rows)]];
                let (fan, places) = (&beam.fan, &self.places[range[0]..range[1]]);
                Samples {
                    beam,
                    bunch: Bunch { fan, corners, places },
                    replicates: &self.replicates[range[0]..range[1]],
                }
            },
        )
    }
}

pub(super) fn usize_of(count: u64) -> usize {
    usize::try_from(count).expect("partial sums of one round fit the memory")
}
