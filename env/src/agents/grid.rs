//! A part of the arena as a grid of square cells.

/// Cells over a rectangle, row by row, surrounded by a rim of one cell that is never walked on, so that every other cell
/// has eight neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Grid {
    columns: usize,
    rows: usize,
    /// Its south-western corner in metres.
    corner: [f32; 2],
    /// Side of a cell in metres.
    side: f32,
}

impl Grid {
    /// A grid over a rectangle, with cells of this side in metres.
    pub(super) fn over(low: [f32; 2], high: [f32; 2], side: f32) -> Self {
        let [columns, rows] = [0, 1].map(|axis| (((high[axis] - low[axis]) / side).ceil() as usize).max(1));
        Self {
            columns,
            rows,
            corner: low,
            side,
        }
    }

    /// Number of cells, including the rim.
    pub(super) fn num_cells(&self) -> usize {
        self.stride() * (self.rows + 2)
    }

    /// Index offset from a cell to the one north of it.
    pub(super) fn stride(&self) -> usize {
        self.columns + 2
    }

    /// Side of a cell in metres.
    pub(super) fn side(&self) -> f32 {
        self.side
    }

    /// The cell at a position; the nearest cell for a position outside.
    pub(super) fn cell_at(&self, [x, y]: [f32; 2]) -> usize {
        self.cell([self.index(x, 0), self.index(y, 1)])
    }

    /// The cell of a column and a row, each from 0, not counting the rim.
    fn cell(&self, [column, row]: [usize; 2]) -> usize {
        (row + 1) * self.stride() + column + 1
    }

    fn index(&self, metres: f32, axis: usize) -> usize {
        let most = [self.columns, self.rows][axis] - 1;
        ((metres - self.corner[axis]) / self.side).clamp(0.0, most as f32) as usize
    }

    /// Centre of a cell in metres.
    pub(super) fn centre(&self, cell: usize) -> [f32; 2] {
        let (x, y) = (cell % self.stride() - 1, cell / self.stride() - 1);
        [
            self.corner[0] + (x as f32 + 0.5) * self.side,
            self.corner[1] + (y as f32 + 0.5) * self.side,
        ]
    }

    /// The cells whose centres may lie within a rectangle, row by row.
    pub(super) fn within(self, low: [f32; 2], high: [f32; 2]) -> impl Iterator<Item = usize> {
        let [low, high] = [low, high].map(|place| [0, 1].map(|axis| self.index(place[axis], axis)));
        (low[1]..=high[1]).flat_map(move |row| (low[0]..=high[0]).map(move |column| self.cell([column, row])))
    }

    /// The cells whose centres may lie within a square around a position, `reach` to each side.
    pub(super) fn near(self, at: [f32; 2], reach: f32) -> impl Iterator<Item = usize> {
        self.within(at.map(|metres| metres - reach), at.map(|metres| metres + reach))
    }

    /// The cells whose centres may lie in a polygon or within `margin` of it.
    pub(super) fn near_polygon(self, corners: &[[f64; 2]], margin: f32) -> impl Iterator<Item = usize> {
        let bound = |axis: usize, sign: f32| {
            let along = corners.iter().map(|corner| corner[axis] as f32 * sign);
            (along.fold(f32::NEG_INFINITY, f32::max) + margin) * sign
        };
        let [low, high] = [-1.0, 1.0].map(|sign| [bound(0, sign), bound(1, sign)]);
        self.within(low, high)
    }

    /// Index offsets of the eight cells around a cell that is not on the rim, and whether each is diagonal.
    pub(super) fn around(&self) -> [(isize, bool); 8] {
        let row = self.stride() as isize;
        [
            (-row - 1, true),
            (-row, false),
            (-row + 1, true),
            (-1, false),
            (1, false),
            (row - 1, true),
            (row, false),
            (row + 1, true),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cell_at_inverts_centre() {
        for size in [[50.0, 20.0], [0.3, 7.0], [300.0, 299.0], [0.0, 0.0]] {
            let half = size.map(|metres: f32| metres / 2.0);
            let grid = Grid::over(half.map(|metres| -metres), half, 0.5);
            for cell in grid.within(half.map(|metres| -metres), half) {
                assert_eq!(grid.cell_at(grid.centre(cell)), cell, "{size:?}");
            }
        }
    }
}
