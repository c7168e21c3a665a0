//! The points of lattices, put into bunches of neighbours.

use glam::DVec2;
use pulp::{Arch, Simd, WithSimd};

use super::beam::{Beam, Samples};
use crate::lanes::{Lanes, Vector, small};
use crate::sampling::{Fibonacci, MOST_LANES, Points};
use crate::scene::{Bunch, Places};

/// The points of all lattices in one column of a grid, row by row.
#[derive(Debug)]
pub(super) struct Column {
    arch: Arch,
    /// Points as they are found, lattice by lattice, and some that are not in the column.
    found: Found,
    /// Where the rows begin, and the last one ends.
    rows: Vec<usize>,
    right: Vec<f64>,
    up: Vec<f64>,
    replicates: Vec<u8>,
}

/// Points of lattices, coordinate by coordinate, and in which row of the column they are, as
/// [`small`] reads it.
#[derive(Debug, Default)]
struct Found {
    row: Vec<f64>,
    right: Vec<f64>,
    up: Vec<f64>,
    /// How many there are; what comes after these does not matter.
    count: usize,
}

impl Column {
    pub(super) fn new() -> Self {
        Self::on(Arch::new())
    }

    /// On a machine with some vectors.
    fn on(arch: Arch) -> Self {
        Self {
            arch,
            found: Found::default(),
            rows: Vec::new(),
            right: Vec::new(),
            up: Vec::new(),
            replicates: Vec::new(),
        }
    }

    /// Finds the points of a column.
    pub(super) fn fill(
        &mut self,
        lattice: Fibonacci,
        shifts: &[DVec2],
        grid: [u64; 2],
        number: u64,
    ) {
        let Self { arch, found, rows, right, up, replicates } = self;
        let [from, to] = [number, number + 1].map(|i| i as f64 / grid[0] as f64);
        // As many of each lattice, and what makes lots of them full.
        let (_, most) = lattice.between(from, to, DVec2::ZERO);
        found.count = 0;
        found.reserve(shifts.len() * (usize_of(most) + MOST_LANES));
        // Where the points of each lattice end.
        let mut ends = Vec::with_capacity(shifts.len());
        for &shift in shifts {
            let (first, count) = lattice.between(from, to, shift);
            let count = usize_of(count);
            arch.dispatch(Find { found, lattice, first, count, shift, grid, number });
            ends.push(found.count);
        }
        // The last row is of points that are not in the column.
        rows.clear();
        rows.resize(usize_of(grid[1]) + 2, 0);
        for &row in &found.row[..found.count] {
            rows[small(row) + 1] += 1;
        }
        for row in 1..rows.len() {
            rows[row] += rows[row - 1];
        }
        // Points are put in the order of their rows, those of a row as they were found.
        let mut next = rows.clone();
        let count = found.count;
        right.resize(count, 0.0);
        up.resize(count, 0.0);
        replicates.resize(count, 0);
        let (right, up) = (&mut right[..count], &mut up[..count]);
        let replicates = &mut replicates[..count];
        let mut start = 0;
        for (replicate, end) in (0..).zip(ends) {
            let places = found.right[start..end].iter().zip(&found.up[start..end]);
            for (&row, (&x, &y)) in found.row[start..end].iter().zip(places) {
                let next = &mut next[small(row)];
                (right[*next], up[*next], replicates[*next]) = (x, y, replicate);
                *next += 1;
            }
            start = end;
        }
        rows.pop();
    }

    /// How many points there are in the column.
    pub(super) fn len(&self) -> usize {
        self.rows.last().map_or(0, |&end| end)
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
                let range = range[0]..range[1];
                let places = Places {
                    right: &self.right[range.clone()],
                    up: &self.up[range.clone()],
                };
                Samples {
                    stratum: 0,
                    beam,
                    bunch: Bunch { fan: &beam.fan, corners, places },
                    replicates: &self.replicates[range],
                }
            },
        )
    }
}

impl Found {
    /// Makes room for some.
    fn reserve(&mut self, count: usize) {
        for numbers in [&mut self.row, &mut self.right, &mut self.up] {
            if numbers.len() < count {
                numbers.resize(count, 0.0);
            }
        }
    }
}

/// Adds points of a lattice to those found, for which there is room.
struct Find<'a> {
    found: &'a mut Found,
    lattice: Fibonacci,
    first: u64,
    count: usize,
    shift: DVec2,
    grid: [u64; 2],
    /// Which column is wanted.
    number: u64,
}

impl WithSimd for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { found, lattice, first, count, shift, grid, number } = self;
        let [columns, rows] = grid.map(|count| count as f64);
        let lots = count.div_ceil(S::F64_LANES);
        let (row, _) = S::as_mut_simd_f64s(&mut found.row[found.count..]);
        let (right, _) = S::as_mut_simd_f64s(&mut found.right[found.count..]);
        let (up, _) = S::as_mut_simd_f64s(&mut found.up[found.count..]);
        let mut points = Points::new(simd, &lattice, first, shift);
        let like = Vector(simd, simd.splat_f64s(0.0));
        let (half, number) = (like.same(0.5), number as f64);
        // What rounding takes over the far edge is of the last column.
        let beyond = if number + 1.0 < columns { number + 1.0 } else { f64::INFINITY };
        let (number, beyond) = (like.same(number), like.same(beyond));
        let (columns, nowhere) = (like.same(columns), like.same(rows));
        let last_row = like.same(rows - 1.0);
        for ((row, right), up) in row[..lots].iter_mut().zip(right).zip(up) {
            let [x, y] = points.next();
            let column = x * columns;
            let is_here = !column.less(number) & column.less(beyond);
            let here = (y * nowhere).min(last_row);
            *row = Vector::select(is_here, here, nowhere).small().1;
            *right = (x - half).1;
            *up = (y - half).1;
        }
        found.count += count;
    }
}

pub(super) fn usize_of(count: u64) -> usize {
    usize::try_from(count).expect("partial sums of one round fit the memory")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::whole;

    /// All points are in one column each, in the row that they belong to, and it does not
    /// matter how many are found at once.
    #[test]
    fn columns_have_all_points() {
        let lattice = Fibonacci::at_least(233);
        let shifts = [DVec2::new(0.1, 0.9), DVec2::new(0.731, 0.25), DVec2::ZERO];
        let grid @ [columns, rows] = [7, 3];
        let mut counts = [0; 3];
        for number in 0..columns {
            let [mut column, mut alone] = [Arch::new(), Arch::Scalar].map(Column::on);
            // Twice, for memory is used again.
            column.fill(lattice, &shifts, grid, (number + 1) % columns);
            for column in [&mut column, &mut alone] {
                column.fill(lattice, &shifts, grid, number);
            }
            let count = column.len();
            assert_eq!(column.rows, alone.rows);
            assert_eq!(column.right[..count], alone.right[..count]);
            assert_eq!(column.up[..count], alone.up[..count]);
            assert_eq!(column.replicates[..count], alone.replicates[..count]);
            for row in 0..rows {
                for i in column.rows[usize_of(row)]..column.rows[usize_of(row + 1)] {
                    let [x, y] = [column.right[i] + 0.5, column.up[i] + 0.5];
                    assert_eq!(whole(x * columns as f64), number);
                    assert_eq!(whole(y * rows as f64), row);
                    counts[usize::from(column.replicates[i])] += 1;
                }
            }
        }
        assert_eq!(counts, [lattice.len(); 3]);
    }
}
