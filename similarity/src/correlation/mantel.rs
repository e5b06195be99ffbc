//! The Mantel test: how often two unrelated measures of the same pairs would correlate as strongly as the given ones.

use rayon::prelude::*;
use serde::Serialize;

use super::relabelling::Relabellings;
use super::spearman::without_rounding;
use super::{Correlation, MIN_CORRELATED, pearson, ranks};
use crate::{DistanceMatrix, SimilarityError};

/// Maximum number of relabellings per test.
pub const MAX_RELABELLINGS: u64 = 1_000_000;

/// Maximum number of items per test.
pub const MAX_MANTEL_ITEMS: usize = 2_000;

/// Correlations closer than this count as equal: the order of additions changes them by less.
const MAX_ROUNDING: f64 = 1e-9;

/// A value measured for one ordered pair of a matrix's items.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PairValue {
    /// Index of the first item.
    pub from: usize,
    /// Index of the second item.
    pub to: usize,
    /// The measured value, in any unit.
    pub value: f64,
}

/// The result of a Mantel test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MantelTest {
    /// The correlation used.
    pub method: Correlation,
    /// The correlation of the lists, −1 to 1.
    pub correlation: f64,
    /// Share of relabellings with a correlation at least as far from 0.
    pub p_two_sided: f64,
    /// Share of relabellings with a correlation at least as low: for "the nearer, the more".
    pub p_less: f64,
    /// Share of relabellings with a correlation at least as high: for "the farther, the more".
    pub p_greater: f64,
    /// Number of relabellings.
    pub relabellings: u64,
    /// Whether these were all relabellings, so that the shares are exact; otherwise they were drawn at random.
    pub exact: bool,
    /// Number of items relabelled: those with at least one value.
    pub items: usize,
    /// Number of pairs with a value.
    pub pairs: usize,
}

/// Correlates distances with another measure of the same pairs, and tests how often chance alone gives as strong a correlation.
///
/// The correlation is computed over the pairs that have a value. Then the items of the matrix are relabelled, with all their
/// distances, and the correlation is computed again: a share of `p` of the relabellings correlates at least as strongly. Items
/// are relabelled and not pairs, because pairs that share an item are not independent. If there are at most `relabellings` of
/// them, all are used, and `p = k / all`; otherwise that many are drawn with `seed`, and `p = (k + 1) / (drawn + 1)`, which
/// counts the observed one among them. So `p` is never 0.
///
/// `pairs`: in any order, each at most once; the two directions are two pairs. **Pairs without a value are left out**: the gaps
/// stay in place while labels change, and only items with at least one value take part. The test is then about the measured
/// pairs; no test can tell whether the others are like them. Distances cannot be missing: a matrix has all of them, which keeps a
/// test with gaps valid. A relabelling under which all distances are equal has no correlation; it counts as at least as strong,
/// which makes the test conservative.
///
/// Time `O(relabellings · (pairs + items²))`, on all cores; the same result for the same seed on any number of cores.
///
/// Source: Mantel 1967; Legendre and Legendre 2012, § 10.5; the same correlations as `skbio.stats.distance.mantel` and the
/// same exact shares as an enumeration with scipy, see `tests/oracle/make_correlation.py`.
///
/// # Errors
/// As [`spearman`](crate::spearman) and [`pearson`](crate::pearson); [`SimilarityError::MantelPair`] for pairs that are
/// repeated or not in the matrix; [`SimilarityError::MantelCount`] for 0 or more than [`MAX_RELABELLINGS`] relabellings, and
/// for more than [`MAX_MANTEL_ITEMS`] items.
///
/// # Example
/// ```
/// use driftworld_similarity::{Correlation, DistanceMatrix, PairValue, SimilarityError, mantel};
/// let at = [0.0_f64, 1.0, 3.0, 7.0];
/// let names = ["a", "b", "c", "d"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs()))?;
/// let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
/// let doubled = pairs.map(|(from, to)| PairValue { from, to, value: 2.0 * matrix.get(from, to) });
/// let test = mantel(&matrix, &doubled, Correlation::Spearman, 999, 0)?;
/// assert!((test.correlation - 1.0).abs() < 1e-12);
/// assert!(test.exact, "four items have 24 relabellings");
/// assert_eq!(test.p_greater, 1.0 / 24.0, "only the true labels correlate so well");
/// # Ok::<(), SimilarityError>(())
/// ```
pub fn mantel(
    distances: &DistanceMatrix,
    pairs: &[PairValue],
    method: Correlation,
    relabellings: u64,
    seed: u64,
) -> Result<MantelTest, SimilarityError> {
    check(distances, pairs, relabellings)?;
    let values: Vec<f64> = pairs.iter().map(|pair| pair.value).collect();
    let observed: Vec<f64> = pairs.iter().map(|pair| distances.get(pair.from, pair.to)).collect();
    let correlation = method.of(&observed, &values)?;
    let table = Table::new(distances, pairs, method);
    let sample = Relabellings::new(table.items, relabellings, seed);
    let [far, low, high] = table.tally(sample, correlation);
    // All relabellings include the observed one; drawn ones do not, so it is added.
    let num_observed = u64::from(!sample.is_all());
    let share = |as_strong: u64| (as_strong + num_observed) as f64 / (sample.count + num_observed) as f64;
    Ok(MantelTest {
        method,
        correlation,
        p_two_sided: share(far),
        p_less: share(low),
        p_greater: share(high),
        relabellings: sample.count,
        exact: sample.is_all(),
        items: table.items,
        pairs: pairs.len(),
    })
}

fn check(distances: &DistanceMatrix, pairs: &[PairValue], relabellings: u64) -> Result<(), SimilarityError> {
    let count = |what, found, limit| Err(SimilarityError::MantelCount { what, found, limit });
    if !(1..=MAX_RELABELLINGS).contains(&relabellings) {
        return count("relabellings", relabellings, MAX_RELABELLINGS);
    }
    let mut seen = std::collections::BTreeSet::new();
    for &PairValue { from, to, .. } in pairs {
        let bad_pair = |found, expected| {
            Err(SimilarityError::MantelPair {
                from,
                to,
                found,
                expected,
            })
        };
        if from.max(to) >= distances.len() {
            return bad_pair("that the matrix does not have", "indices of its items");
        }
        if from == to {
            return bad_pair("of an item with itself", "two items");
        }
        if !seen.insert((from, to)) {
            return bad_pair("a second time", "each pair once");
        }
    }
    if pairs.len() < MIN_CORRELATED {
        return Err(SimilarityError::CorrelationTooFew {
            found: pairs.len(),
            needed: MIN_CORRELATED,
        });
    }
    let items: std::collections::BTreeSet<usize> = pairs.iter().flat_map(|pair| [pair.from, pair.to]).collect();
    if items.len() > MAX_MANTEL_ITEMS {
        return count("items with values", items.len() as u64, MAX_MANTEL_ITEMS as u64);
    }
    Ok(())
}

/// Whether a relabelling correlates at least as strongly as observed: two-sided, below, above.
fn as_strong(correlation: Option<f64>, found: f64) -> [u64; 3] {
    let here = correlation.unwrap_or_default();
    let as_strong = [
        here.abs() >= found.abs() - MAX_ROUNDING,
        here <= found + MAX_ROUNDING,
        here >= found - MAX_ROUNDING,
    ];
    as_strong.map(|as_strong| u64::from(correlation.is_none() || as_strong))
}

/// Data shared by all relabellings: items numbered from 0, their distances, and the values to compare with.
struct Table {
    items: usize,
    method: Correlation,
    /// `(items, items)`, row-major: the distance, or for Spearman's its rank index among the different distances.
    distances: Vec<f64>,
    /// Number of different distances, if `distances` holds rank indices.
    num_distinct: usize,
    pairs: Vec<(usize, usize)>,
    /// The values, or for Spearman's their ranks.
    values: Vec<f64>,
}

impl Table {
    /// Prepares the data; the pairs must have been checked.
    fn new(matrix: &DistanceMatrix, pairs: &[PairValue], method: Correlation) -> Self {
        let mut items: Vec<usize> = pairs.iter().flat_map(|pair| [pair.from, pair.to]).collect();
        items.sort_unstable();
        items.dedup();
        let index = |item: usize| items.partition_point(|other| *other < item);
        let mut distances: Vec<f64> = items
            .iter()
            .flat_map(|a| items.iter().map(|b| matrix.get(*a, *b)))
            .collect();
        let mut values: Vec<f64> = pairs.iter().map(|pair| pair.value).collect();
        let mut num_distinct = 0;
        if method == Correlation::Spearman {
            values = ranks(&values);
            num_distinct = dense_ranks(&mut distances);
        }
        Self {
            items: items.len(),
            method,
            distances,
            num_distinct,
            pairs: pairs.iter().map(|pair| (index(pair.from), index(pair.to))).collect(),
            values,
        }
    }

    /// Number of relabellings at least as strong as observed, for each of the three tests.
    fn tally(&self, sample: Relabellings, found: f64) -> [u64; 3] {
        (0..sample.count)
            .into_par_iter()
            .map_init(
                || vec![0; self.items],
                |labels, number| {
                    sample.write(number, labels);
                    as_strong(self.correlation(labels), found)
                },
            )
            .reduce(|| [0; 3], |a, b| [0, 1, 2].map(|k| a[k] + b[k]))
    }

    /// The correlation after relabelling; `None` if all distances are equal.
    fn correlation(&self, labels: &[usize]) -> Option<f64> {
        let relabelled = |(from, to): &(usize, usize)| self.distances[labels[*from] * self.items + labels[*to]];
        let mut here: Vec<f64> = self.pairs.iter().map(relabelled).collect();
        if self.method == Correlation::Spearman {
            ranks_from_dense(&mut here, self.num_distinct);
        }
        pearson::of_checked(&here, &self.values)
    }
}

/// Replaces every number by the count of different numbers below it; returns the count of different numbers. Numbers
/// are equal if [`ranks`] counts them as equal.
fn dense_ranks(numbers: &mut [f64]) -> usize {
    let merged = without_rounding(numbers);
    numbers.copy_from_slice(&merged);
    let mut different = numbers.to_vec();
    different.sort_by(f64::total_cmp);
    different.dedup_by(|a, b| a == b);
    for number in numbers.iter_mut() {
        *number = different.partition_point(|other| other < number) as f64;
    }
    different.len()
}

/// Replaces rank indices by ranks, like [`ranks`], but without sorting again for every relabelling.
fn ranks_from_dense(numbers: &mut [f64], num_distinct: usize) {
    let mut counts = vec![0_u32; num_distinct + 1];
    // Rank indices are whole numbers below `num_distinct`.
    for place in numbers.iter() {
        counts[*place as usize + 1] += 1;
    }
    for place in 0..num_distinct {
        counts[place + 1] += counts[place];
    }
    for number in numbers.iter_mut() {
        let place = *number as usize;
        *number = f64::from(counts[place] + counts[place + 1] + 1) / 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix(at: &[f64]) -> DistanceMatrix {
        let labels = (0..at.len()).map(|k| format!("item {k}")).collect();
        DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs())).unwrap()
    }

    fn pair((from, to, value): (usize, usize, f64)) -> PairValue {
        PairValue { from, to, value }
    }

    /// Positions on a line, and values for some of the ordered pairs.
    fn cases() -> impl Strategy<Value = (Vec<f64>, Vec<PairValue>)> {
        let at = prop::collection::vec((0_i32..30).prop_map(f64::from), 3..6);
        let value = prop::option::weighted(0.6, (-9_i32..9).prop_map(f64::from));
        (at, prop::collection::vec(value, 25)).prop_map(|(at, values)| {
            let n = at.len();
            let cells = (0..n * n)
                .map(|cell| (cell / n, cell % n))
                .filter(|(from, to)| from != to);
            let pairs = cells
                .zip(values)
                .filter_map(|((from, to), value)| Some(pair((from, to, value?))));
            (at, pairs.collect())
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

        #[test]
        fn shares_are_valid_and_independent_of_pair_order((at, pairs) in cases(), spearman in any::<bool>()) {
            let method = if spearman { Correlation::Spearman } else { Correlation::Pearson };
            let Ok(test) = mantel(&matrix(&at), &pairs, method, 120, 3) else { return Ok(()) };
            prop_assert!(test.exact);
            for share in [test.p_two_sided, test.p_less, test.p_greater] {
                prop_assert!((1.0 / test.relabellings as f64..=1.0).contains(&share), "{:?}", test);
            }
            // Each relabelling is at least as low, or at least as high, and the true one is both.
            prop_assert!(test.p_less + test.p_greater >= 1.0);
            let mut reversed = pairs.clone();
            reversed.reverse();
            let repeated = mantel(&matrix(&at), &reversed, method, 120, 3).unwrap();
            prop_assert_eq!((repeated.p_two_sided, repeated.p_less), (test.p_two_sided, test.p_less));
            let negated: Vec<_> = pairs.iter().map(|pair| PairValue { value: -pair.value, ..*pair }).collect();
            let other = mantel(&matrix(&at), &negated, method, 120, 3).unwrap();
            prop_assert_eq!((other.p_greater, other.p_two_sided), (test.p_less, test.p_two_sided));
        }

        #[test]
        fn drawn_shares_approximate_exact_ones((at, pairs) in cases(), seed in 0_u64..9) {
            let Ok(exact) = mantel(&matrix(&at), &pairs, Correlation::Spearman, 120, seed) else { return Ok(()) };
            // Fewer than all, so that they are drawn; 5 items have 120.
            prop_assume!(exact.relabellings == 120);
            let drawn = mantel(&matrix(&at), &pairs, Correlation::Spearman, 119, seed).unwrap();
            prop_assert!(!drawn.exact);
            // Five standard errors of a share of 119.
            prop_assert!((drawn.p_less - exact.p_less).abs() < 5.0 * 0.5 / 119_f64.sqrt());
        }
    }

    #[test]
    fn same_seed_gives_the_same_shares_on_any_number_of_threads() {
        let at: Vec<f64> = (0..12).map(|k| f64::from(k * k % 17)).collect();
        let pairs: Vec<_> = (0..11)
            .map(|k| pair((k, k + 1, f64::from((k * 7 % 5) as u8))))
            .collect();
        let test = |threads, seed| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| mantel(&matrix(&at), &pairs, Correlation::Spearman, 500, seed).unwrap())
        };
        assert_eq!(test(1, 7), test(4, 7));
        assert_eq!((test(1, 7).items, test(1, 7).pairs), (12, 11));
        assert_ne!(test(1, 7), test(1, 8));
    }

    #[test]
    fn constant_distances_are_refused_and_equal_correlations_count_against_the_result() {
        // Of the four items, the first three are in one place: the first three pairs have distances of 0.
        let pairs = [(0, 1, 1.0), (1, 2, 2.0), (0, 2, 3.0), (0, 3, 4.0)].map(pair);
        let test = mantel(&matrix(&[0.0, 0.0, 0.0, 5.0]), &pairs[..3], Correlation::Pearson, 24, 0);
        assert_eq!(test.unwrap_err().code(), "similarity/correlation-constant");
        let test = mantel(&matrix(&[0.0, 0.0, 0.0, 5.0]), &pairs, Correlation::Pearson, 24, 0).unwrap();
        assert!(test.exact && test.p_greater >= 0.25, "{test:?}");
        let disconnected = [(0, 1, 1.0), (1, 0, 2.0), (2, 3, 3.0)].map(pair);
        let test = mantel(
            &matrix(&[0.0, 5.0, 0.0, 5.0]),
            &disconnected,
            Correlation::Pearson,
            24,
            0,
        );
        assert!(test.is_err(), "all three distances are 5");
        let spread = mantel(
            &matrix(&[0.0, 5.0, 9.0, 5.0]),
            &disconnected,
            Correlation::Pearson,
            24,
            0,
        )
        .unwrap();
        assert!(spread.p_two_sided > 1.0 / 24.0);
    }

    #[test]
    fn impossible_tests_are_refused_with_a_reason() {
        let check = |pairs: &[(usize, usize, f64)], relabellings, expected: &str| {
            let pairs: Vec<_> = pairs.iter().copied().map(pair).collect();
            let found = mantel(
                &matrix(&[0.0, 1.0, 3.0]),
                &pairs,
                Correlation::Spearman,
                relabellings,
                0,
            );
            assert_eq!(found.unwrap_err().to_string(), expected);
        };
        let valid = [(0, 1, 1.0), (0, 2, 2.0), (1, 2, 4.0)];
        check(&valid, 0, "mantel test: found 0 relabellings, expected 1 to 1000000");
        check(
            &[(0, 3, 1.0)],
            9,
            "mantel test: found a value for the pair 0 to 3 that the matrix does not have, expected indices of its items",
        );
        check(
            &[(1, 1, 1.0)],
            9,
            "mantel test: found a value for the pair 1 to 1 of an item with itself, expected two items",
        );
        check(
            &[(0, 1, 1.0), (0, 1, 2.0)],
            9,
            "mantel test: found a value for the pair 0 to 1 a second time, expected each pair once",
        );
        check(
            &valid[..2],
            9,
            "correlation: found 2 pairs, expected at least 3: two always lie on a straight line; measure more",
        );
        let flat = valid.map(|(from, to, _)| (from, to, 7.0));
        check(
            &flat,
            9,
            "correlation: found 7 everywhere in the second list, expected numbers that differ: correlation is \
             undefined for a constant list",
        );
    }
}
