//! The arena as a grid of square cells.

/// Maximum number of cells along one side of the grid.
const MAX_CELLS: usize = 256;

/// Minimum side of a cell in metres.
const MIN_SIDE: f32 = 0.5;

/// The same limits for a world with narrow corridors.
const MAX_FINE_CELLS: usize = 1024;
const MIN_FINE_SIDE: f32 = 0.1;

/// Cells over the arena, row by row, surrounded by a rim of one cell that is never walked on, so that every cell of the arena
/// has eight neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Grid {
    columns: usize,
    rows: usize,
    /// The arena's south-western corner in metres.
    corner: [f32; 2],
    /// Side of a cell in metres.
    side: f32,
}

impl Grid {
    /// Cells over an arena with these side lengths in metres.
    #[cfg(test)]
    pub(super) fn over(size: [f32; 2]) -> Self {
        Self::of_side(size, MIN_SIDE)
    }

    /// A grid over an arena with these side lengths in metres, and cells of side `wanted` if that is smaller than the default side.
    pub(super) fn fine(size: [f32; 2], wanted: f32) -> Self {
        let long = size[0].max(size[1]);
        let plain = (long / MAX_CELLS as f32).max(MIN_SIDE);
        Self::exact(
            size,
            plain.min(wanted.max(long / MAX_FINE_CELLS as f32).max(MIN_FINE_SIDE)),
        )
    }

    /// A grid with cells of at least this side in metres; larger if the arena would need too many cells.
    pub(super) fn of_side(size: [f32; 2], least: f32) -> Self {
        Self::exact(size, (size[0].max(size[1]) / MAX_CELLS as f32).max(least))
    }

    fn exact([width, depth]: [f32; 2], side: f32) -> Self {
        let [columns, rows] = [width, depth].map(|metres| ((metres / side).ceil() as usize).max(1));
        Self {
            columns,
            rows,
            corner: [-width / 2.0, -depth / 2.0],
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

    /// The cell at a position; the nearest cell for a position outside the arena.
    pub(super) fn cell_at(&self, [x, y]: [f32; 2]) -> usize {
        self.cell([self.index(x, 0), self.index(y, 1)])
    }

    /// The cell of a column and a row of the arena, each from 0.
    fn cell(&self, [column, row]: [usize; 2]) -> usize {
        (row + 1) * self.stride() + column + 1
    }

    fn index(&self, metres: f32, axis: usize) -> usize {
        let most = [self.columns, self.rows][axis] - 1;
        ((metres - self.corner[axis]) / self.side).clamp(0.0, most as f32) as usize
    }

    /// Centre of a cell of the arena in metres.
    pub(super) fn centre(&self, cell: usize) -> [f32; 2] {
        let (x, y) = (cell % self.stride() - 1, cell / self.stride() - 1);
        [
            self.corner[0] + (x as f32 + 0.5) * self.side,
            self.corner[1] + (y as f32 + 0.5) * self.side,
        ]
    }

    /// Whether a cell belongs to the rim.
    pub(super) fn is_rim(&self, cell: usize) -> bool {
        let (x, y) = (cell % self.stride(), cell / self.stride());
        x == 0 || y == 0 || x > self.columns || y > self.rows
    }

    /// The cells of the arena whose centres may lie within a rectangle, row by row.
    pub(super) fn within(self, low: [f32; 2], high: [f32; 2]) -> impl Iterator<Item = usize> {
        let [low, high] = [low, high].map(|place| [0, 1].map(|axis| self.index(place[axis], axis)));
        (low[1]..=high[1]).flat_map(move |row| (low[0]..=high[0]).map(move |column| self.cell([column, row])))
    }

    /// The cells of the arena whose centres may lie within a square around a position, `reach` to each side.
    pub(super) fn near(self, at: [f32; 2], reach: f32) -> impl Iterator<Item = usize> {
        self.within(at.map(|metres| metres - reach), at.map(|metres| metres + reach))
    }

    /// The cells of the arena whose centres may lie in a polygon or within `margin` of it.
    pub(super) fn near_polygon(self, corners: &[[f64; 2]], margin: f32) -> impl Iterator<Item = usize> {
        let bound = |axis: usize, sign: f32| {
            let along = corners.iter().map(|corner| corner[axis] as f32 * sign);
            (along.fold(f32::NEG_INFINITY, f32::max) + margin) * sign
        };
        let [low, high] = [-1.0, 1.0].map(|sign| [bound(0, sign), bound(1, sign)]);
        self.within(low, high)
    }

    /// Index offsets of the eight cells around a cell of the arena, and whether each is diagonal.
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

    /// All cells of the rim.
    pub(super) fn rim(&self) -> impl Iterator<Item = usize> {
        let (stride, rows) = (self.stride(), self.rows);
        let ends = (0..stride).chain((rows + 1) * stride..(rows + 2) * stride);
        ends.chain((1..=rows).flat_map(move |row| [row * stride, (row + 1) * stride - 1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cell_at_inverts_centre_and_all_other_cells_are_rim() {
        for size in [[50.0, 20.0], [0.3, 7.0], [300.0, 299.0], [0.0, 0.0]] {
            let grid = Grid::over(size);
            let mut rim: Vec<usize> = grid.rim().collect();
            rim.sort_unstable();
            let expected: Vec<usize> = (0..grid.num_cells()).filter(|cell| grid.is_rim(*cell)).collect();
            assert_eq!(rim, expected, "{size:?}");
            for cell in (0..grid.num_cells()).filter(|cell| !grid.is_rim(*cell)) {
                assert_eq!(grid.cell_at(grid.centre(cell)), cell, "{size:?}");
            }
        }
    }
}
