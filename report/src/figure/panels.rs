//! Lays out small charts in a grid.

use plotters::prelude::*;

use super::paper::{Area, Paper};

/// Maximum number of panels drawn in a figure.
pub(super) const MAX_PANELS: usize = 24;

/// A grid of panels.
pub(super) struct Grid {
    columns: usize,
    rows: usize,
    height: i32,
}

impl Grid {
    /// A grid for this many panels, of which at most [`MAX_PANELS`] are drawn.
    pub(super) fn of(panels: usize, paper: &Paper) -> Self {
        let panels = panels.clamp(1, MAX_PANELS);
        let columns = match panels {
            _ if paper.is_narrow() => 1,
            1 => 1,
            2 | 4 => 2,
            _ => 3,
        };
        Self {
            columns,
            rows: panels.div_ceil(columns),
            height: match panels {
                1 if !paper.is_narrow() => 280,
                // With many panels, each gives only an overview.
                10.. => 170,
                _ => 210,
            },
        }
    }

    /// Its height in pixels of the layout.
    pub(super) fn height(&self) -> i32 {
        self.height * self.rows as i32
    }

    /// Pixel columns between the axes of a panel.
    pub(super) fn pixel_columns(&self, paper: &Paper) -> i32 {
        paper.width() / self.columns as i32 - 60
    }

    /// Number of labels that fit on the axes of a panel.
    pub(super) fn labels(&self) -> [usize; 2] {
        if self.columns == 1 { [6, 5] } else { [4, 5] }
    }

    /// The panels' areas, row by row.
    pub(super) fn areas<DB: DrawingBackend>(&self, area: &Area<DB>) -> Vec<Area<DB>> {
        area.split_evenly((self.rows, self.columns))
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::Layout;
    use super::*;

    #[test]
    fn grid_has_a_cell_for_every_panel() {
        let check = |layout: Layout, panels: usize, expected: (usize, usize)| {
            let grid = Grid::of(panels, &Paper { layout, title: None });
            assert_eq!((grid.rows, grid.columns), expected, "{panels} panels");
        };
        check(Layout::Wide, 0, (1, 1));
        check(Layout::Wide, 4, (2, 2));
        check(Layout::Wide, 5, (2, 3));
        check(Layout::Wide, 500, (8, 3));
        check(Layout::Narrow, 5, (5, 1));
    }
}
