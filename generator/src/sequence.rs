//! [`Sequence`]: how the random numbers of randomized parameters are spread over many worlds.

use std::sync::OnceLock;

use crate::stream::{Stream, unit};

/// Maximum number of dimensions of the Sobol sequence; parameters beyond them are drawn independently.
pub(crate) const MAX_DIMENSIONS: usize = 100;

/// How the worlds of a variant cover the ranges of randomized parameters.
///
/// Applies to randomized parameters that take at most three random numbers; colours take one per channel. Parameters use
/// dimensions in the task's order of declaration, so a new parameter shifts the dimensions of those declared after it. Choices,
/// mixtures, Dirichlet shares and draws inside groups stay independent, as do parameters beyond 100 dimensions and worlds that
/// are sampled again because of a requirement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sequence {
    /// Each world draws independently.
    #[default]
    Independent,
    /// World `index` is point number `index` of the Sobol sequence, scrambled by the seed: any 2^k worlds starting at a
    /// multiple of 2^k spread evenly in each parameter, and in most pairs of parameters.
    Sobol,
    /// A Latin hypercube over the worlds `first..first + count`: each parameter has exactly one world in each of
    /// `count` strata of equal probability.
    LatinHypercube {
        /// The first world.
        first: u64,
        /// Number of worlds, above 0.
        count: u64,
    },
}

impl Sequence {
    /// A world's number in 0..1 along a dimension; `None` if it must be drawn independently.
    pub(crate) fn unit(self, stream: &Stream, dimension: usize, index: u64) -> Option<f64> {
        match self {
            Self::Independent => None,
            Self::Sobol if dimension >= MAX_DIMENSIONS => None,
            Self::Sobol => {
                let seed = stream.constant(dimension as u64);
                Some(unit(scramble(sobol(dimension, index), seed)))
            }
            Self::LatinHypercube { first, count } => {
                let number = index.checked_sub(first).filter(|number| *number < count)?;
                let stratum = permute(number, count, stream.constant(dimension as u64));
                let inside = stream.at(index, u64::MAX - dimension as u64, 0).unit();
                Some((stratum as f64 + inside) / count as f64)
            }
        }
    }
}

/// Point `index` of the Sobol sequence along a dimension, as 64 bits, with the direction numbers of Joe and Kuo (2008).
fn sobol(dimension: usize, index: u64) -> u64 {
    static DIRECTIONS: OnceLock<Vec<Vec<u64>>> = OnceLock::new();
    let directions = DIRECTIONS.get_or_init(|| {
        sobol::Sobol::<f64>::init_direction_vals(MAX_DIMENSIONS, 64, &sobol::params::JoeKuoD6::minimal())
    });
    let mut point = 0;
    let mut gray = index ^ (index >> 1);
    while gray != 0 {
        point ^= directions[dimension][gray.trailing_zeros() as usize];
        gray &= gray - 1;
    }
    point
}

/// Owen scrambling by hashing from the highest bit down, which preserves digital nets.
///
/// Source: Laine and Karras 2011, in the form of Burley 2020, widened to 64 bits.
fn scramble(point: u64, seed: u64) -> u64 {
    let mut x = point.reverse_bits();
    x = x.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c_6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52_b82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638_c7af_e638);
    x ^= x.wrapping_mul(0x8d22_f6e6_8d22_f6e6);
    x.reverse_bits()
}

/// The image of a number under a keyed permutation of `0..count`: a Feistel network with cycle walking.
fn permute(number: u64, count: u64, seed: u64) -> u64 {
    let bits = (64 - count.saturating_sub(1).leading_zeros())
        .max(2)
        .next_multiple_of(2);
    let half = bits / 2;
    let mask = (1_u64 << half) - 1;
    let mut x = number;
    loop {
        let (mut left, mut right) = (x >> half, x & mask);
        for round in 0..6_u64 {
            let mut mixed = (right ^ seed).wrapping_add(round).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            mixed ^= mixed >> 29;
            mixed = mixed.wrapping_mul(0xBF58_476D_1CE4_E5B9);
            (left, right) = (right, left ^ ((mixed >> 32) & mask));
        }
        x = left << half | right;
        if x < count {
            return x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first points of `scipy.stats.qmc.Sobol(d=4, scramble=False)` (scipy 1.17).
    #[test]
    fn sobol_points_agree_with_scipy() {
        let points: Vec<[f64; 4]> = (0..6)
            .map(|index| std::array::from_fn(|dimension| sobol(dimension, index) as f64 / 2_f64.powi(64)))
            .collect();
        assert_eq!(
            points,
            [
                [0.0, 0.0, 0.0, 0.0],
                [0.5, 0.5, 0.5, 0.5],
                [0.75, 0.25, 0.25, 0.25],
                [0.25, 0.75, 0.75, 0.75],
                [0.375, 0.375, 0.625, 0.875],
                [0.875, 0.875, 0.125, 0.375],
            ]
        );
    }

    #[test]
    fn scrambled_points_keep_one_per_stratum() {
        let stream = Stream::new("t", 7, "coverage");
        for dimension in [0, 1, 17, 99] {
            let mut shares: Vec<u64> = (256..512)
                .map(|index| (Sequence::Sobol.unit(&stream, dimension, index).unwrap() * 256.0) as u64)
                .collect();
            shares.sort_unstable();
            assert_eq!(shares, (0..256).collect::<Vec<_>>());
        }
    }

    #[test]
    fn latin_hypercube_has_one_world_per_stratum() {
        for count in [1, 2, 3, 100, 1000] {
            let stream = Stream::new("t", 7, "coverage");
            let cube = Sequence::LatinHypercube { first: 50, count };
            let mut shares: Vec<u64> = (50..50 + count)
                .map(|index| (cube.unit(&stream, 3, index).unwrap() * count as f64) as u64)
                .collect();
            assert!(count < 10 || !shares.is_sorted(), "the order is shuffled");
            shares.sort_unstable();
            assert_eq!(shares, (0..count).collect::<Vec<_>>());
            assert_eq!(cube.unit(&stream, 3, 49), None);
        }
    }
}
