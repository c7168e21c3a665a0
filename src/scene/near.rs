//! Which of many boxes overlap, in six dimensions.
//!
//! Six, because surfaces are near each other if their leaves are, which takes three, and if
//! they lie alike, which takes three more.

use std::ops::Range;

/// How many numbers say where something is.
const AXES: usize = 6;

/// From where to where something is on each axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) low: [f64; AXES],
    pub(super) high: [f64; AXES],
}

/// Cells, to be asked which of them overlap.
pub(super) struct Cells {
    cells: Vec<Cell>,
    /// Their numbers in the order of the tree.
    items: Vec<usize>,
    /// The root first.
    nodes: Vec<Node>,
}

/// A node of the tree of cells: an end if it has no children.
struct Node {
    around: Cell,
    range: Range<usize>,
    children: Option<[usize; 2]>,
}

/// Ends are not split any further at this number of cells.
const FEW: usize = 8;

impl Cells {
    pub(super) fn new(cells: Vec<Cell>) -> Self {
        let mut items: Vec<usize> = (0..cells.len()).collect();
        let nodes = tree(&cells, &mut items);
        Self { cells, items, nodes }
    }

    /// Calls `visit` with the numbers of every two cells that overlap, the smaller first.
    pub(super) fn overlaps(&self, mut visit: impl FnMut(usize, usize)) {
        let mut open = Vec::new();
        for i in 0..self.cells.len() {
            self.meeting(i, &mut open, |k| {
                if i < k {
                    visit(i, k);
                }
                true
            });
        }
    }

    /// Whether each cell overlaps another.
    pub(super) fn have_company(&self) -> Vec<bool> {
        let mut open = Vec::new();
        let mut has_company = |i| {
            let mut found = false;
            self.meeting(i, &mut open, |k| {
                found = k != i;
                !found
            });
            found
        };
        (0..self.cells.len()).map(&mut has_company).collect()
    }

    /// Calls `visit` with the cells that overlap one, itself among them, as long as it says
    /// to go on.
    fn meeting(
        &self,
        i: usize,
        open: &mut Vec<usize>,
        mut visit: impl FnMut(usize) -> bool,
    ) {
        let cell = &self.cells[i];
        open.clear();
        open.push(0);
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            if !cell.meets(&node.around) {
                continue;
            }
            match node.children {
                Some(children) => open.extend(children),
                None => {
                    let here = &self.items[node.range.clone()];
                    if !here.iter().all(|&k| !cell.meets(&self.cells[k]) || visit(k)) {
                        return;
                    }
                }
            }
        }
    }
}

/// A tree over the cells, the root first; reorders their numbers.
fn tree(cells: &[Cell], items: &mut [usize]) -> Vec<Node> {
    let node = |items: &[usize], range: Range<usize>| Node {
        around: Cell::around(items[range.clone()].iter().map(|&i| &cells[i])),
        range,
        children: None,
    };
    let mut nodes = vec![node(items, 0..items.len())];
    let mut open = vec![0];
    while let Some(at) = open.pop() {
        let range = nodes[at].range.clone();
        if range.len() <= FEW {
            continue;
        }
        let part = &mut items[range.clone()];
        let Some(axis) = widest(cells, part) else { continue };
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |&a, &b| {
            cells[a].middle(axis).total_cmp(&cells[b].middle(axis))
        });
        let middle = range.start + half;
        let first = nodes.len();
        for half in [range.start..middle, middle..range.end] {
            nodes.push(node(items, half));
        }
        nodes[at].children = Some([first, first + 1]);
        open.extend([first, first + 1]);
    }
    nodes
}

/// The axis on which the middles of the cells are spread the most, in widths of a cell; none
/// if they are all in one place.
fn widest(cells: &[Cell], items: &[usize]) -> Option<usize> {
    let spread = |axis: usize| {
        let (mut low, mut high, mut width) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for cell in items.iter().map(|&i| &cells[i]) {
            low = low.min(cell.middle(axis));
            high = high.max(cell.middle(axis));
            width += cell.high[axis] - cell.low[axis];
        }
        (high - low) / (width / items.len() as f64 + f64::MIN_POSITIVE)
    };
    let spreads = std::array::from_fn::<f64, AXES, _>(spread);
    let axis = (0..AXES).max_by(|&a, &b| spreads[a].total_cmp(&spreads[b]))?;
    (spreads[axis] > 0.0).then_some(axis)
}

impl Cell {
    fn meets(&self, other: &Self) -> bool {
        (0..AXES).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    fn middle(&self, axis: usize) -> f64 {
        0.5 * self.low[axis] + 0.5 * self.high[axis]
    }

    fn around<'a>(cells: impl Iterator<Item = &'a Self>) -> Self {
        let empty = Self { low: [f64::INFINITY; AXES], high: [f64::NEG_INFINITY; AXES] };
        cells.fold(empty, |mut around, cell| {
            for k in 0..AXES {
                around.low[k] = around.low[k].min(cell.low[k]);
                around.high[k] = around.high[k].max(cell.high[k]);
            }
            around
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_two_that_overlap_are_found_once() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        for (count, width) in [(0, 0.1), (1, 0.1), (500, 0.2), (500, 0.0), (40, 2.0)] {
            let cells: Vec<Cell> = (0..count)
                .map(|i| {
                    let low = [(); AXES].map(|()| number());
                    // Some lie in one place.
                    let low = if i % 3 == 0 { [0.5; AXES] } else { low };
                    Cell { low, high: low.map(|x| x + width) }
                })
                .collect();
            let mut found = Vec::new();
            let tree = Cells::new(cells.clone());
            tree.overlaps(|i, k| found.push((i, k)));
            found.sort_unstable();
            let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |k| (i, k)));
            let all: Vec<_> = pairs.filter(|&(i, k)| cells[i].meets(&cells[k])).collect();
            assert_eq!(found, all);
            let is_met = |i| all.iter().any(|&(a, b)| a == i || b == i);
            assert_eq!(tree.have_company(), (0..count).map(is_met).collect::<Vec<_>>());
        }
    }
}
