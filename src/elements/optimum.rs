//! [`Optimum`]: whether a variant calls for different behaviour from the base variant.

use driftworld_env::{Catalogue, Expertise};
use driftworld_generator::Sampler;
use driftworld_spec::Variant;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::behavior::{MAX_BEHAVIOR_WORLDS, regrets};
use crate::failure::{Failure, within};

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
    /// Exchanges the experts of two variants in pairs of worlds, at most 16, drawn under one seed and paired by index.
    ///
    /// # Errors
    /// [`Failure`] if a world cannot be drawn, or `worlds` is 0.
    pub fn measure(
        base: &Variant,
        other: &Variant,
        seed: u64,
        worlds: u64,
        catalogue: &Catalogue,
    ) -> Result<Self, Failure> {
        let worlds = worlds.min(MAX_WORLDS);
        within("worlds", worlds, 1..=MAX_BEHAVIOR_WORLDS)?;
        let catalogue = catalogue.clone();
        let expertise = Expertise {
            catalogue,
            ..Expertise::default()
        };
        let samplers = [base, other].map(|variant| Sampler::new(variant, seed));
        let exchange = |index| {
            let [a, b] = [samplers[0].world(index)?, samplers[1].world(index)?];
            let own = [expertise.at_home(&a)?, expertise.at_home(&b)?];
            Ok::<_, Failure>(regrets(&expertise, [&a, &b], own)?)
        };
        let pairs = (0..worlds).into_par_iter().map(exchange);
        Ok(Self::of(&pairs.collect::<Result<Vec<_>, _>>()?))
    }

    /// Summarises the regrets in pairs of worlds, the base's first.
    fn of(pairs: &[[f64; 3]]) -> Self {
        let count = pairs.len() as f64;
        let [regret_in_base, regret] = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count);
        let deviations = pairs.iter().map(|pair| (pair[1] - regret).powi(2));
        let variance = deviations.sum::<f64>() / (count - 1.0).max(1.0);
        let error = (variance / count).sqrt();
        Self {
            turned: regret >= MIN_REGRET && regret > 2.0 * error,
            regret,
            regret_in_base,
            worlds: pairs.len() as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The optimum if the first variant's expert earns less by these amounts in worlds of the second.
    fn optimum_of(regrets: &[f64]) -> Optimum {
        let pairs: Vec<_> = regrets.iter().map(|regret| [0.0, *regret, 0.0]).collect();
        Optimum::of(&pairs)
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
