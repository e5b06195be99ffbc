//! [`StateGrid`] maps positions and headings to state numbers.

/// Number of headings that a state can have: every 45°, starting at +y.
pub const NUM_HEADINGS: usize = 8;

/// Degrees between two headings.
const TURN: f64 = 360.0 / NUM_HEADINGS as f64;

/// Cells around the origin, each with [`NUM_HEADINGS`] headings, and one end state for finished episodes.
///
/// State `(row · columns + column) · 8 + heading`; columns go east, rows north. The last state is the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateGrid {
    /// Side of a cell in metres.
    pub cell: f64,
    /// Number of columns, and number of rows.
    pub cells: [usize; 2],
}

impl StateGrid {
    /// The smallest grid that covers an area with these side lengths in metres, centred on the origin.
    pub(super) fn over(area: [f64; 2], cell: f64) -> Self {
        let cells = area.map(|side| (side / cell - 1e-9).ceil().max(1.0) as usize);
        Self { cell, cells }
    }

    /// The number of states, including the end; at most `usize::MAX`.
    pub fn states(&self) -> usize {
        let cells = self.cells[0].saturating_mul(self.cells[1]);
        cells.saturating_mul(NUM_HEADINGS).saturating_add(1)
    }

    /// The state of a finished episode.
    pub fn end(&self) -> usize {
        self.states() - 1
    }

    /// The centre of a state's cell in metres, and its heading in degrees. `None` for the end state and for states out of
    /// range.
    pub fn pose(&self, state: usize) -> Option<([f64; 2], f64)> {
        let (cell, heading) = (state / NUM_HEADINGS, state % NUM_HEADINGS);
        if state >= self.end() {
            return None;
        }
        let column_row = [cell % self.cells[0], cell / self.cells[0]];
        let middle = |axis: usize| (column_row[axis] as f64 + 0.5 - self.cells[axis] as f64 / 2.0) * self.cell;
        Some(([middle(0), middle(1)], heading as f64 * TURN))
    }

    /// The state for a position in metres and a heading in degrees; a position outside the grid belongs to the nearest cell.
    pub fn state_at(&self, position: [f64; 2], heading_deg: f64) -> usize {
        let [column, row] = [0, 1].map(|axis| {
            let cells = position[axis] / self.cell + self.cells[axis] as f64 / 2.0;
            (cells.floor().max(0.0) as usize).min(self.cells[axis] - 1)
        });
        let heading = (heading_deg / TURN).round().rem_euclid(NUM_HEADINGS as f64) as usize % NUM_HEADINGS;
        (row * self.cells[0] + column) * NUM_HEADINGS + heading
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_and_states_are_inverse() {
        let grid = StateGrid::over([7.0, 4.0], 2.0);
        assert_eq!((grid.cells, grid.states()), ([4, 2], 65));
        assert_eq!(grid.pose(0), Some(([-3.0, -1.0], 0.0)));
        assert_eq!(grid.pose(grid.end()), None);
        for state in 0..grid.end() {
            let (position, heading) = grid.pose(state).expect("a state has a pose");
            assert_eq!(grid.state_at(position, heading + 22.0), state);
        }
        assert_eq!(grid.state_at([100.0, 100.0], 359.0), grid.end() - NUM_HEADINGS);
    }
}
