//! Open lines by their strokes.

use glam::DVec2;

use super::super::outline::{Join, stroke};

/// How a line is drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Stroke {
    pub(super) width: String,
    pub(super) cap: String,
    pub(super) join: String,
}

/// OpenSCAD's grid for strokes.
const GRID: f64 = 10_000.0;
/// The most pieces of a round join: more are less than a millionth of its radius away.
const MOST_PIECES: f64 = 2000.0;
/// The most lines whose joins are round.
const MOST_ROUND: usize = 10_000;

impl Stroke {
    /// What a line covers, as simple polygons. A width that is too small, or no number, is 1;
    /// what is neither flat nor round at its ends is square there.
    ///
    /// # Errors
    ///
    /// That the stroke has more corners than are worth the memory.
    pub(super) fn around(&self, line: &[DVec2]) -> Result<Vec<Vec<DVec2>>, String> {
        let width = super::shape::number(&self.width);
        let half = 0.5 * if width < 0.01 { 1.0 } else { width };
        let round = || {
            // How far its arcs may be from true ones: a quarter of a cell of the grid.
            let sagitta = (0.25 / (half * GRID)).min(0.25);
            let pieces = std::f64::consts::PI / (1.0 - sagitta).acos();
            Join::Round { pieces: pieces.min(MOST_PIECES) }
        };
        let cap = match self.cap.as_str() {
            "butt" => Join::Round { pieces: 1.0 },
            "round" => round(),
            _ => Join::Chamfer,
        };
        let join = match self.join.as_str() {
            "bevel" => Join::Chamfer,
            "round" => round(),
            _ => Join::Mitre { limit: 2.0 },
        };
        let mut line: Vec<DVec2> =
            line.iter().map(|p| (p * GRID).trunc() / GRID).collect();
        line.dedup();
        let is_round = matches!(join, Join::Round { .. });
        if is_round && line.len() > MOST_ROUND {
            return Err("a round stroke of so many lines".to_owned());
        }
        Ok(stroke(&line, half, join, cap))
    }
}
