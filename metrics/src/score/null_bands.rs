//! Null bands: the values to expect of a lifetime's metrics if the agent had never changed.

use indexmap::IndexMap;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::exchange::Evaluations;
use super::{performance_maintenance, transfer};
use crate::lifetime::{Lifetime, Regime, worlds};
use crate::results::{NullBand, performance_error};
use crate::{BlockType, Log, Options};

/// Number of permutations of a lifetime's evaluations.
pub const NULL_PERMUTATIONS: usize = 1000;

/// Seed of the permutations; fixed, so that a lifetime gets the same bands wherever it is scored.
const SEED: u64 = 0;

/// The null bands of a lifetime, and the permuted values behind them.
#[derive(Default)]
pub(super) struct NullBands {
    pub(super) bands: IndexMap<String, NullBand>,
    /// For each metric, its value for each permutation, in order; infinite where it cannot be computed.
    pub(super) drawn: IndexMap<String, Vec<f64>>,
}

/// Null bands, by name, of the metrics that can be tested by permuting evaluations: maintenance if requested, transfer as a
/// contrast, and as a ratio if requested. `term_perfs` are the lifetime's terminal performances, by regime number.
///
/// If an agent never changes, its rewards in one world are exchangeable between evaluations. So the rows of each world are
/// permuted among the evaluations of their task, and every metric is recomputed. Performances are permuted as scored: scaling
/// and clamping treat every row in the same way. Smoothing does not, so there are no bands if evaluations are smoothed.
pub(super) fn null_bands(log: &Log, lifetime: &Lifetime, options: &Options, term_perfs: &[f64]) -> NullBands {
    let mut statistics = performance_maintenance::statistics(lifetime, options);
    statistics.extend(transfer::statistics(lifetime, options));
    let mut found: Vec<_> = (statistics.into_iter())
        .filter_map(|statistic| {
            Some((
                statistic.of(term_perfs)?,
                statistic,
                Vec::with_capacity(NULL_PERMUTATIONS),
            ))
        })
        .collect();
    if options.smooth_eval_data || found.is_empty() {
        return NullBands::default();
    }
    let mut evaluations = Evaluations::of(log, lifetime);
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut permuted = term_perfs.to_vec();
    for _ in 0..NULL_PERMUTATIONS {
        evaluations.permute(&mut rng);
        evaluations.set_term_perfs(&mut permuted);
        for (_, statistic, drawn) in &mut found {
            drawn.push(statistic.of(&permuted).unwrap_or(f64::INFINITY));
        }
    }
    let exchanged = evaluations.exchanged;
    let errors = errors(log, lifetime);
    let mut bands = NullBands::default();
    for (value, statistic, drawn) in found {
        let finite: Vec<f64> = drawn.iter().copied().filter(|value| value.is_finite()).collect();
        if let Some(mut band) = NullBand::new(value, &finite, exchanged) {
            band.standard_error = standard_error(&statistic, term_perfs, &errors);
            bands.bands.insert(statistic.name.to_owned(), band);
            bands.drawn.insert(statistic.name.to_owned(), drawn);
        }
    }
    bands
}

/// The standard error, if known, of each evaluation that counts, by its regime number.
fn errors(log: &Log, lifetime: &Lifetime) -> Vec<(usize, Option<f64>)> {
    let worlds = worlds(log, lifetime.regimes());
    let counts = |regime: &&Regime| regime.block_type == BlockType::Test && lifetime.is_assessed(regime);
    let evaluated = lifetime.regimes().iter().filter(counts);
    let error = |regime: &Regime| (regime.regime_num, performance_error(regime, &worlds[regime.regime_num]));
    evaluated.map(error).collect()
}

/// Maximum number of evaluations for a standard error; varying more of them one by one would take too long.
const MAX_EVALUATIONS: usize = 2000;

/// Propagates the evaluations' standard errors to the statistic, to first order.
fn standard_error(statistic: &Statistic<'_>, term_perfs: &[f64], errors: &[(usize, Option<f64>)]) -> Option<f64> {
    if errors.len() > MAX_EVALUATIONS {
        return None;
    }
    let mut varied = term_perfs.to_vec();
    let mut square = 0.0;
    for (regime, error) in errors {
        let step = 1e-4 * term_perfs[*regime].abs().max(1.0);
        let mut at = |value: f64| {
            varied[*regime] = value;
            statistic.of(&varied)
        };
        let slope = (at(term_perfs[*regime] + step)? - at(term_perfs[*regime] - step)?) / (2.0 * step);
        varied[*regime] = term_perfs[*regime];
        if slope != 0.0 {
            square += (slope * (*error)?).powi(2);
        }
    }
    Some(square.sqrt())
}

/// Computes a value of the lifetime from terminal performances, by regime number.
type Compute<'a> = dyn Fn(&[f64]) -> Option<f64> + 'a;

/// A headline metric that depends on terminal performances alone.
pub(super) struct Statistic<'a> {
    pub(super) name: &'static str,
    compute: Box<Compute<'a>>,
}

impl<'a> Statistic<'a> {
    pub(super) fn new(name: &'static str, compute: impl Fn(&[f64]) -> Option<f64> + 'a) -> Self {
        Self {
            name,
            compute: Box::new(compute),
        }
    }

    /// The value of the lifetime for the terminal performance of each regime, by its number; `None` where it cannot be computed.
    pub(super) fn of(&self, term_perfs: &[f64]) -> Option<f64> {
        (self.compute)(term_perfs).filter(|value| value.is_finite())
    }
}
