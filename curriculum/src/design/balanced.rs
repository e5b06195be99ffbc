//! Orders of variants that are balanced over lifetimes: Latin squares in which each pair of neighbours occurs equally often.

use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, order};

use crate::CurriculumError;

/// The order of `count` variants in a lifetime.
///
/// Over `count` lifetimes, or twice as many if `count` is odd, each variant is in each position equally often and follows each
/// other variant equally often (Williams 1949, *Experimental designs balanced for the estimation of residual effects of
/// treatments*). The seed determines the order of the square's rows, and which variant each symbol stands for.
pub(super) fn balanced_order(count: usize, seed: u64, lifetime: u64) -> Result<Vec<usize>, CurriculumError> {
    let rows = if count.is_multiple_of(2) { count } else { 2 * count };
    // Once all rows have been used, the square is used again with different symbols.
    let (round, row) = (lifetime / rows as u64, (lifetime % rows as u64) as usize);
    let symbols = permutation(count, seed, 2 * round)?;
    let row = permutation(rows, seed, 2 * round + 1)?[row];
    Ok(square_row(count, row)
        .into_iter()
        .map(|symbol| symbols[symbol])
        .collect())
}

/// A row of the square: 0, n − 1, 1, n − 2, … shifted by the number of the row; for odd n, the same rows reversed follow.
fn square_row(count: usize, row: usize) -> Vec<usize> {
    let zigzag = (0..count).map(|index| {
        if index.is_multiple_of(2) {
            index / 2
        } else {
            count - index.div_ceil(2)
        }
    });
    let mut shifted: Vec<usize> = zigzag.map(|symbol| (symbol + row) % count).collect();
    if row >= count {
        shifted.reverse();
    }
    shifted
}

/// A random permutation, different for each `number`.
fn permutation(count: usize, seed: u64, number: u64) -> Result<Vec<usize>, CurriculumError> {
    // The names have equal length, so they sort like the numbers.
    let names = (0..count).map(|index| format!("{index:08}")).collect();
    let equal = DistanceMatrix::measure(names, |_, _| Ok::<_, CurriculumError>(0.0))?;
    // An odd factor keeps the numbers derived from neighbouring seeds apart.
    let seed = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(number);
    let options = OrderOptions {
        seed,
        ..OrderOptions::default()
    };
    Ok(order(&equal, Method::Random, &options)?.indices)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// The counts of the least and the most frequent of `num_possible` items.
    fn counts<T: Ord>(items: impl Iterator<Item = T>, num_possible: usize) -> (usize, usize) {
        let mut seen: BTreeMap<T, usize> = BTreeMap::new();
        for item in items {
            *seen.entry(item).or_default() += 1;
        }
        let least = if seen.len() < num_possible {
            0
        } else {
            *seen.values().min().unwrap()
        };
        (least, *seen.values().max().unwrap())
    }

    #[test]
    fn variants_take_each_position_and_follow_each_other_equally_often() {
        for (count, seed) in (1..9).flat_map(|count| [0, 1, 77].map(|seed| (count, seed))) {
            let rows = if count % 2 == 0 { count } else { 2 * count };
            for round in 0..3 {
                let orders: Vec<Vec<usize>> = (0..rows)
                    .map(|row| balanced_order(count, seed, (round * rows + row) as u64).unwrap())
                    .collect();
                let positions = orders.iter().flat_map(|order| order.iter().copied().enumerate());
                let (least, most) = counts(positions, count * count);
                assert_eq!(
                    (least, most),
                    (rows / count, rows / count),
                    "{count} variants, positions"
                );
                if count > 1 {
                    let pairs = orders
                        .iter()
                        .flat_map(|order| order.windows(2).map(|pair| (pair[0], pair[1])));
                    let (least, most) = counts(pairs, count * (count - 1));
                    assert_eq!((least, most), (rows / count, rows / count), "{count} variants, pairs");
                }
            }
        }
    }

    #[test]
    fn seeds_and_rounds_have_different_squares() {
        let of = |seed, lifetime| balanced_order(6, seed, lifetime).unwrap();
        let square = |seed, round: u64| (0..6).map(|row| of(seed, 6 * round + row)).collect::<Vec<_>>();
        assert_eq!(square(3, 0), square(3, 0));
        assert_ne!(square(3, 0), square(4, 0));
        assert_ne!(square(3, 0), square(3, 1));
    }
}
