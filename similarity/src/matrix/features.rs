//! Points for [`Embedding`]s from what has a measure that embeds: grids and colours. What is done with the points is in `embedding.rs`.

use driftworld_spec::Color;
use ndarray::Array2;

use super::Embedding;
use crate::{Grid, Oklab, SimilarityError};

impl Embedding {
    /// Grids as points whose Euclidean distance is Hellinger's distance between where their mass lies:
    /// √(½ Σ (√aᵢ − √bᵢ)²) with the masses as shares of the whole, in `0..=1`.
    ///
    /// A metric between grids of one total mass. How much mass there is makes no difference; a grid without any is as far from all others
    /// as one whose mass is spread infinitely thin, √½.
    ///
    /// # Errors
    /// [`SimilarityError::GridsDiffer`] when shapes do; as [`Embedding::new`], of which the limit of 4,096 numbers is one of 4,096 cells.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::{Embedding, Grid, GridShape};
    /// let shape = GridShape::new(2, 1, 1, 1.0)?;
    /// let grids = [Grid::new(shape, vec![2.0, 0.0])?, Grid::new(shape, vec![0.0, 1.0])?];
    /// let embedding = Embedding::of_grids(vec!["west".into(), "east".into()], &grids)?;
    /// assert!((embedding.distances().get(0, 1) - 1.0).abs() < 1e-12);
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn of_grids(labels: Vec<String>, grids: &[Grid]) -> Result<Self, SimilarityError> {
        let Some(first) = grids.first() else {
            return Self::new(labels, Array2::zeros((0, 0)));
        };
        let mut points = Array2::zeros((grids.len(), first.masses().len()));
        for (mut row, grid) in points.rows_mut().into_iter().zip(grids) {
            first.shape().check(grid.shape())?;
            let total = grid.total();
            for (place, mass) in row.iter_mut().zip(grid.masses()) {
                *place = if total > 0.0 { (mass / total / 2.0).sqrt() } else { 0.0 };
            }
        }
        Self::new(labels, points)
    }

    /// Colours as points whose Euclidean distance is that in Oklab, in `0..=1`.
    ///
    /// # Errors
    /// As [`Embedding::new`].
    pub fn of_colors(labels: Vec<String>, colors: &[Color]) -> Result<Self, SimilarityError> {
        let mut points = Array2::zeros((colors.len(), 3));
        for (mut row, color) in points.rows_mut().into_iter().zip(colors) {
            row.assign(&ndarray::arr1(&Oklab::from(*color).0));
        }
        Self::new(labels, points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GridShape, oklab_distance};
    use proptest::prelude::*;

    fn labels(count: usize) -> Vec<String> {
        (0..count).map(|index| index.to_string()).collect()
    }

    proptest! {
        #[test]
        fn points_are_as_far_apart_as_what_they_stand_for(
            masses in prop::collection::vec(prop::collection::vec(0.01..1.0_f64, 6), 2..6),
            colors in prop::collection::vec(prop::array::uniform3(0.0..=1.0_f64), 2..6),
        ) {
            let shape = GridShape::new(3, 2, 1, 1.0).unwrap();
            let grids: Vec<Grid> = masses.into_iter().map(|masses| Grid::new(shape, masses).unwrap()).collect();
            let found = Embedding::of_grids(labels(grids.len()), &grids).unwrap().distances();
            for (a, b) in (0..grids.len()).flat_map(|a| (0..grids.len()).map(move |b| (a, b))) {
                let pairs = grids[a].masses().iter().zip(grids[b].masses());
                let affinity: f64 = pairs.map(|(x, y)| (x / grids[a].total() * y / grids[b].total()).sqrt()).sum();
                prop_assert!((found.get(a, b) - (1.0 - affinity).max(0.0).sqrt()).abs() < 1e-7);
            }
            let colors: Vec<Color> = colors.into_iter().map(Color).collect();
            let found = Embedding::of_colors(labels(colors.len()), &colors).unwrap().distances();
            for (a, b) in (0..colors.len()).flat_map(|a| (0..colors.len()).map(move |b| (a, b))) {
                prop_assert!((found.get(a, b) - oklab_distance(colors[a], colors[b])).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn grids_of_other_shapes_are_refused() {
        let grid = |columns| Grid::new(GridShape::new(columns, 1, 1, 1.0).unwrap(), vec![1.0; columns]).unwrap();
        assert!(Embedding::of_grids(labels(2), &[grid(2), grid(3)]).is_err());
        assert!(Embedding::of_grids(labels(1), &[grid(4097)]).is_err());
        assert!(Embedding::of_grids(Vec::new(), &[]).is_ok());
    }
}
