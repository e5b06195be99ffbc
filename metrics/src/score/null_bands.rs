//! Null bands: what the metrics of a lifetime would be if the agent had never changed.
//!
//! Not here: which evaluations are exchanged, see `exchange`; what a band says, see `results::null_band`.

use indexmap::IndexMap;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::exchange::Evaluations;
use super::{performance_maintenance, transfer};
use crate::lifetime::Lifetime;
use crate::results::NullBand;
use crate::{Log, MetricsError, Options};

/// How often the evaluations of a lifetime are permuted.
pub const NULL_PERMUTATIONS: usize = 1000;

/// What permutations are drawn from: a lifetime has the same bands wherever it is scored.
const SEED: u64 = 0;

/// The null band of each metric that evaluations decide, by name: maintenance as far as it is asked for, transfer as a
/// contrast, and as a ratio where it is asked for. `term_perfs` are the lifetime's, by regime number.
///
/// An agent that never changes is as likely to earn one of its rewards in a world at one evaluation as at another. So
/// the rows of each world are permuted among the evaluations of their task, and every metric is computed of them anew. Performances
/// are permuted as they are scored: scaling and clamping treat every row alike. Smoothing does not, so there are no bands
/// where evaluations are smoothed.
pub(super) fn null_bands(
    log: &Log,
    lifetime: &Lifetime,
    options: &Options,
    term_perfs: &[f64],
) -> Result<IndexMap<String, NullBand>, MetricsError> {
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
        return Ok(IndexMap::new());
    }
    let mut evaluations = Evaluations::of(log, lifetime, options)?;
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut permuted = term_perfs.to_vec();
    for _ in 0..NULL_PERMUTATIONS {
        evaluations.permute(&mut rng);
        evaluations.set_term_perfs(&mut permuted);
        for (_, statistic, drawn) in &mut found {
            drawn.extend(statistic.of(&permuted));
        }
    }
    let exchanged = evaluations.exchanged;
    let bands = found.into_iter().filter_map(|(value, statistic, drawn)| {
        let band = NullBand::new(value, &drawn, exchanged)?;
        Some((statistic.name.to_owned(), band))
    });
    Ok(bands.collect())
}
