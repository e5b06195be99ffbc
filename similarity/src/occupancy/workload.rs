//! [`OccupancyWorkload`]: the inputs on which the speed of these distances is measured. Clocks are the caller's.

use super::bit_grid::BitGrid;
use super::earth_movers::grid_earth_movers_distance;
use super::grid::{Grid, GridShape};
use super::jaccard::grid_jaccard_distance;
use super::sinkhorn::grid_sinkhorn;
use super::sliced::grid_sliced_wasserstein;
use crate::{SinkhornSettings, earth_movers_distance};

/// Grids and points by a fixed chance, as many and as large as those that the Python tools are measured on.
///
/// Each job measures every pair of its inputs once and returns how many pairs that were, and the sum of their distances.
///
/// # Example
/// ```
/// use driftworld_similarity::OccupancyWorkload;
/// let (pairs, sum) = OccupancyWorkload::new().emd_25x25();
/// assert_eq!(pairs, 15);
/// assert!(sum > 0.0);
/// ```
#[derive(Clone, Debug)]
pub struct OccupancyWorkload {
    taken: Vec<BitGrid>,
    points: Vec<Vec<[f64; 2]>>,
    masses: Vec<Grid>,
}

impl OccupancyWorkload {
    /// 200 grids of 50 × 50 cells of which a tenth is taken, 40 sets of 20 points in a square, 6 grids of 25 × 25 random masses.
    #[expect(clippy::new_without_default, reason = "inputs by chance are no default of anything")]
    pub fn new() -> Self {
        let mut chance = Chance(0);
        let shape = |side| GridShape::new(side, side, 1, 1.0).expect("a small grid of cells of 1 m is sound");
        let (fine, coarse) = (shape(50), shape(25));
        let taken = (0..200).map(|_| BitGrid::new(fine, (0..2500).map(|_| chance.next() < 0.1).collect::<Vec<_>>()));
        let taken = taken.collect();
        let points = (0..40)
            .map(|_| (0..20).map(|_| [chance.next(), chance.next()]).collect())
            .collect();
        let masses = (0..6).map(|_| {
            let masses = (0..625).map(|_| chance.next()).collect();
            Grid::new(coarse, masses)
                .expect("numbers from 0 to 1 are masses")
                .normalised()
        });
        Self {
            taken,
            points,
            masses: masses.collect(),
        }
    }

    /// Jaccard of grids of 50 × 50: 19,900 pairs.
    pub fn jaccard_50x50(&self) -> (usize, f64) {
        pairs(&self.taken, |a, b| {
            grid_jaccard_distance(a, b).expect("the grids are of one shape")
        })
    }

    /// Exact earth mover's distance of 20 points and 20 points: 780 pairs.
    pub fn emd_20_points(&self) -> (usize, f64) {
        pairs(&self.points, |a, b| {
            earth_movers_distance(a, b).expect("the points are finite")
        })
    }

    /// Exact earth mover's distance of grids of 25 × 25: 15 pairs.
    pub fn emd_25x25(&self) -> (usize, f64) {
        pairs(&self.masses, |a, b| {
            grid_earth_movers_distance(a, b).expect("the masses are equal")
        })
    }

    /// Sinkhorn of the same grids with a regularisation of half a metre: 15 pairs.
    pub fn sinkhorn_25x25(&self) -> (usize, f64) {
        let settings = SinkhornSettings::new(0.5);
        pairs(&self.masses, |a, b| {
            grid_sinkhorn(a, b, &settings).expect("the masses are equal").cost
        })
    }

    /// Sliced Wasserstein distance of the same grids in 32 directions: 15 pairs.
    pub fn sliced_25x25(&self) -> (usize, f64) {
        pairs(&self.masses, |a, b| {
            grid_sliced_wasserstein(a, b, 32).expect("the masses are equal")
        })
    }
}

fn pairs<T>(items: &[T], measure: impl Fn(&T, &T) -> f64) -> (usize, f64) {
    let (mut number, mut sum) = (0, 0.0);
    for (index, a) in items.iter().enumerate() {
        for b in &items[..index] {
            number += 1;
            sum += measure(a, b);
        }
    }
    (number, sum)
}

/// `SplitMix64` (Steele, Lea and Flood 2014): enough for inputs that only need to be always the same.
struct Chance(u64);

impl Chance {
    /// A number in 0..1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_sound_inputs_is_measured() {
        let work = OccupancyWorkload::new();
        let share = work.taken.iter().map(BitGrid::count).sum::<usize>() as f64 / (200.0 * 2500.0);
        assert!((share - 0.1).abs() < 0.005, "{share}");
        let (number, sum) = work.jaccard_50x50();
        // Of two grids of which a tenth is taken a hundredth is taken in both, of nineteen that are taken in either.
        assert_eq!(number, 19_900);
        assert!((sum / 19_900.0 - 18.0 / 19.0).abs() < 0.005, "{sum}");
        assert_eq!(work.emd_20_points().0, 780);
        let ((number, exact), (_, sliced)) = (work.emd_25x25(), work.sliced_25x25());
        assert_eq!(number, 15);
        assert!(0.0 < sliced && sliced < exact);
    }
}
