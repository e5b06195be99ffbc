//! [`Optimum`]: whether a variant calls for different behaviour from the base variant.

use driftworld_env::Catalogue;
use driftworld_spec::Variant;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::behavior::{BehaviorOutcome, ExpertPair, behavior};

/// Maximum number of pairs of worlds in which experts are exchanged.
const MAX_WORLDS: u64 = 16;

/// Smallest regret, in points, that counts as a change of the optimum.
const MIN_REGRET: f64 = 1.0;

/// The loss of the base variant's expert in worlds of this variant, and vice versa.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimum {
    /// Whether the base's optimum is not optimal here: the regret is at least one point, and more than two standard errors above
    /// 0.
    pub turned: bool,
    /// How much less the base's expert earns here than this variant's own, in points, on average.
    pub regret: f64,
    /// How much less this variant's expert earns in the base's worlds than the base's own, in points, on average.
    pub regret_in_base: f64,
    /// Pairs of worlds in which experts were exchanged.
    pub worlds: u64,
}

impl Optimum {
    /// Exchanges the experts of two variants in pairs of worlds, at most 16.
    ///
    /// # Errors
    /// [`Failure`] if a world cannot be drawn.
    pub(crate) fn measure(
        base: &Variant,
        other: &Variant,
        seed: u64,
        worlds: u64,
        catalogue: &Catalogue,
    ) -> Result<Self, Failure> {
        Ok(Self::of(&behavior(
            base,
            other,
            worlds.min(MAX_WORLDS),
            seed,
            catalogue,
        )?))
    }

    /// Summarises an exchange of experts, with its first variant as the base.
    pub fn of(found: &BehaviorOutcome) -> Self {
        let count = found.pairs.len().max(1) as f64;
        let deviation = |pair: &ExpertPair| (pair.regret_in_b() - found.regret_in_b).powi(2);
        let variance = found.pairs.iter().map(deviation).sum::<f64>() / (count - 1.0).max(1.0);
        let error = (variance / count).sqrt();
        Self {
            turned: found.regret_in_b >= MIN_REGRET && found.regret_in_b > 2.0 * error,
            regret: found.regret_in_b,
            regret_in_base: found.regret_in_a,
            worlds: found.pairs.len() as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use driftworld_env::ExpertRun;

    use super::*;

    /// The optimum if the first variant's expert earns less by these amounts in worlds of the second.
    fn optimum_of(regrets: &[f64]) -> Optimum {
        let pair = |regret: &f64| ExpertPair {
            b_in_b: ExpertRun {
                earned: *regret,
                ..ExpertRun::default()
            },
            ..ExpertPair::default()
        };
        let pairs: Vec<ExpertPair> = regrets.iter().map(pair).collect();
        let mean = regrets.iter().sum::<f64>() / regrets.len() as f64;
        Optimum::of(&BehaviorOutcome {
            distance: mean / 200.0,
            regret_in_a: 0.0,
            regret_in_b: mean,
            success_difference: 0.0,
            pairs,
        })
    }

    #[test]
    fn clear_regret_means_a_different_optimum() {
        assert!(optimum_of(&[100.0, 100.0, 100.0]).turned);
        assert!(optimum_of(&[40.0, 60.0, 50.0]).turned);
        assert!(!optimum_of(&[0.0, 0.0]).turned, "no regret");
        assert!(!optimum_of(&[0.5, 0.5]).turned, "below the minimum regret");
        assert!(!optimum_of(&[-50.0, 60.0, -20.0, 30.0]).turned, "noise");
        assert!(!optimum_of(&[-80.0, -90.0]).turned, "the base's expert earns more");
    }
}
