//! Permutation test of whether two agents differ at all.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::{BootstrapOptions, ScoreTable};

/// If there are at most this many divisions of the runs, all of them are tried.
const MAX_EXHAUSTIVE: u64 = 20_000;

/// Tolerance for rounding when the same terms are summed in a different order.
const ROUNDING: f64 = 1e-12;

/// The result of the test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PermutationResult {
    /// Share of divisions that differ at least as much as the observed one, which is included.
    pub(super) p_value: f64,
    /// The smallest possible p-value with this number of runs.
    pub(super) least: f64,
}

/// The runs of two agents in the strata that both have.
struct Pool {
    num_of_a: usize,
    num_runs: usize,
    /// Per stratum, the rank of each run's score among the distinct scores, A's runs first; `None` for a missing score.
    ranks: Vec<Vec<Option<u32>>>,
}

/// Divides the runs of both agents in other ways, as whole runs with all their scores, and counts how often A's share of the
/// won pairs is at least as far from one half as observed. If the agents were equal, every division would be equally likely,
/// whatever the correlation across strata: then the result is at most p with a chance of at most p.
///
/// `None` if each agent has only one run: these can only be swapped.
pub(super) fn permutation_test(
    a: &ScoreTable,
    b: &ScoreTable,
    strata: &[&str],
    options: &BootstrapOptions,
) -> Option<PermutationResult> {
    let pool = Pool::new(a, b, strata);
    if pool.num_runs < 3 {
        return None;
    }
    let mut of_a: Vec<bool> = (0..pool.num_runs).map(|run| run < pool.num_of_a).collect();
    let found = pool.difference(&of_a);
    let is_as_extreme = |difference: f64| difference >= found - ROUNDING;
    let num_divisions = num_divisions(pool.num_runs as u64, pool.num_of_a as u64);
    // Swapping the agents gives the same difference; if both have the same number of runs, that is another division.
    let twins = if 2 * pool.num_of_a == pool.num_runs { 2.0 } else { 1.0 };
    let (num_as_extreme, all) = if let Some(num_divisions) = num_divisions {
        let mut num_as_extreme = 0;
        of_a.sort_unstable();
        loop {
            num_as_extreme += u64::from(is_as_extreme(pool.difference(&of_a)));
            if !next_division(&mut of_a) {
                break (num_as_extreme, num_divisions);
            }
        }
    } else {
        let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
        // A different stream from the intervals' resamples.
        rng.set_stream(1);
        let mut num_as_extreme = 1;
        for _ in 0..options.resamples {
            shuffle(&mut of_a, &mut rng);
            num_as_extreme += u64::from(is_as_extreme(pool.difference(&of_a)));
        }
        (num_as_extreme, u64::from(options.resamples) + 1)
    };
    let least = num_divisions.map_or(1.0 / all as f64, |num_divisions| twins / num_divisions as f64);
    Some(PermutationResult {
        p_value: num_as_extreme as f64 / all as f64,
        least,
    })
}

/// The number of ways to choose `of_a` of `num_runs` runs; `None` if there are too many to try.
fn num_divisions(num_runs: u64, of_a: u64) -> Option<u64> {
    let mut num_divisions = 1_u64;
    for k in 1..=of_a.min(num_runs - of_a) {
        num_divisions = num_divisions * (num_runs - k + 1) / k;
        if num_divisions > MAX_EXHAUSTIVE {
            return None;
        }
    }
    Some(num_divisions)
}

/// The next division in ascending order, from all of A's runs last to all first; false after the last.
fn next_division(of_a: &mut [bool]) -> bool {
    let Some(index) = (1..of_a.len()).rev().find(|&index| !of_a[index - 1] && of_a[index]) else {
        return false;
    };
    of_a.swap(index - 1, index);
    of_a[index + 1..].sort_unstable();
    true
}

fn shuffle(of_a: &mut [bool], rng: &mut ChaCha8Rng) {
    for last in (1..of_a.len()).rev() {
        of_a.swap(last, rng.random_range(0..=last as u32) as usize);
    }
}

impl Pool {
    fn new(a: &ScoreTable, b: &ScoreTable, strata: &[&str]) -> Self {
        let (num_of_a, num_runs) = (a.num_runs(), a.num_runs() + b.num_runs());
        let of_stratum = |name: &&str| {
            let of_b = b
                .scored_runs(name)
                .iter()
                .map(|(score, run)| (*score, *run as usize + num_of_a));
            let of_a = a.scored_runs(name).iter().map(|(score, run)| (*score, *run as usize));
            let mut scores: Vec<(f64, usize)> = of_a.chain(of_b).collect();
            scores.sort_by(|(a, _), (b, _)| a.total_cmp(b));
            let (mut ranks, mut rank, mut last) = (vec![None; num_runs], 0, f64::NAN);
            for (score, run) in scores {
                rank += u32::from(score != last);
                last = score;
                ranks[run] = Some(rank - 1);
            }
            ranks
        };
        Self {
            num_of_a,
            num_runs,
            ranks: strata.iter().map(of_stratum).collect(),
        }
    }

    /// Distance of A's share of won pairs, averaged over strata, from one half; 0 without pairs.
    fn difference(&self, of_a: &[bool]) -> f64 {
        let (mut sum, mut num_strata) = (0.0, 0);
        let mut counts = vec![(0_u64, 0_u64); self.num_runs];
        for ranks in &self.ranks {
            counts.fill((0, 0));
            for (rank, of_a) in ranks.iter().zip(of_a) {
                if let Some(rank) = rank {
                    // There are at most as many ranks as runs.
                    let (a, b) = &mut counts[*rank as usize];
                    *(if *of_a { a } else { b }) += 1;
                }
            }
            let (mut halves, mut below, mut num_of_a) = (0, 0, 0);
            for (a, b) in &counts {
                halves += a * (2 * below + b);
                below += b;
                num_of_a += a;
            }
            let pairs = num_of_a * below;
            if pairs > 0 {
                sum += halves as f64 / (2 * pairs) as f64;
                num_strata += 1;
            }
        }
        if num_strata == 0 {
            0.0
        } else {
            (sum / f64::from(num_strata) - 0.5).abs()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(runs: &[&[f64]]) -> ScoreTable {
        let named = |run: &[f64]| {
            run.iter()
                .enumerate()
                .map(|(k, score)| (k.to_string(), *score))
                .collect::<Vec<_>>()
        };
        ScoreTable::from_runs(runs.iter().enumerate().map(|(k, run)| (k.to_string(), named(run)))).unwrap()
    }

    fn check(a: &[&[f64]], b: &[&[f64]], p_value: f64, least: f64) {
        let found = permutation_test(&table(a), &table(b), &["0"], &BootstrapOptions::default()).unwrap();
        assert!(
            (found.p_value - p_value).abs() < 1e-12 && (found.least - least).abs() < 1e-12,
            "{found:?}"
        );
    }

    #[test]
    fn few_divisions_are_all_counted() {
        // Of 20 ways to choose three of six, only the observed one and its reverse differ this much.
        check(&[&[4.0], &[5.0], &[6.0]], &[&[1.0], &[2.0], &[3.0]], 0.1, 0.1);
        check(&[&[4.0], &[5.0], &[6.0]], &[&[4.0], &[5.0], &[6.0]], 1.0, 0.1);
        // scipy.stats.mannwhitneyu([1, 2, 7, 9], [3, 4, 5, 6, 8], method="exact").pvalue.
        check(
            &[&[1.0], &[2.0], &[7.0], &[9.0]],
            &[&[3.0], &[4.0], &[5.0], &[6.0], &[8.0]],
            0.904_761_904_761_904_8,
            1.0 / 126.0,
        );
    }

    #[test]
    fn many_divisions_are_sampled() {
        let runs: Vec<[f64; 1]> = (0..24).map(|run| [f64::from(run)]).collect();
        let runs: Vec<&[f64]> = runs.iter().map(|run| &run[..]).collect();
        let found = permutation_test(
            &table(&runs[12..]),
            &table(&runs[..12]),
            &["0"],
            &BootstrapOptions::default(),
        )
        .unwrap();
        assert_eq!(found.p_value, 1.0 / 2001.0);
    }

    #[test]
    fn every_division_occurs_once() {
        let mut way = [false, false, true, true];
        let mut seen = vec![way];
        while next_division(&mut way) {
            seen.push(way);
        }
        seen.dedup();
        assert_eq!(seen.len() as u64, num_divisions(4, 2).unwrap());
        assert_eq!(
            (num_divisions(10, 5), num_divisions(10, 0), num_divisions(40, 20)),
            (Some(252), Some(1), None)
        );
    }
}
