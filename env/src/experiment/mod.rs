//! Determines, by experiments on pairs of worlds, which elements of the decision process differ between two tasks.
//!
//! The definitions are those of `docs/decisions/0024-elements-by-experiment.md`.

mod findings;
mod matching;
mod policy;
mod run;
mod space;

use driftworld_spec::{Element, Modality, World};
use rayon::prelude::*;

pub use findings::{Findings, Proof, Witness};
pub use policy::Policy;

use crate::EnvError;
use crate::assets::Catalogue;
use matching::Paired;
use run::Run;
use space::StateSpace;

/// Maximum number of steps of a run.
pub const MAX_EXPERIMENT_STEPS: u32 = 100_000;

/// Settings of an experiment.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Modalities of the learner's images; by default those that each world requests.
    pub modalities: Option<Vec<Modality>>,
    /// Steps of a run, 1 to [`MAX_EXPERIMENT_STEPS`]; 100 by default. [`Policy::Still`] runs for a fifth of them.
    pub steps: u32,
    /// Observations are compared at the first step and every this many steps after it; 25 by default, at least 1.
    pub look_every: u32,
    /// Height and width of the images that are compared, in pixels, 1 to 4096; 48 by default.
    pub side: u32,
    /// Seed of the random agent.
    pub seed: u64,
    /// The catalogue of assets.
    pub catalogue: Catalogue,
}

impl Default for Experiment {
    fn default() -> Self {
        Self {
            modalities: None,
            steps: 100,
            look_every: 25,
            side: 48,
            seed: 0,
            catalogue: Catalogue::default(),
        }
    }
}

impl Experiment {
    /// Finds the differences between the first and second worlds of pairs, with a witness for each element that differs.
    ///
    /// Each pair runs twice per [`Policy`]. In one run the agent acts in the first world, and the second world is set to the
    /// same state before every step; in the other run the worlds swap roles, so that their order does not matter. Pairs run in
    /// parallel; the findings depend only on the pairs and on these settings.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] unless `side` is 1 to 4096.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::Experiment;
    /// use driftworld_spec::{Element, World};
    /// let dusk = World::default().edit(|world| world.environment_params.light_intensity = 0.2)?;
    /// let found = Experiment::default().compare(&[(World::default(), dusk)])?;
    /// assert_eq!(found.elements(), [Element::Phi]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn compare(&self, pairs: &[(World, World)]) -> Result<Findings, EnvError> {
        let first = StateSpace::of(pairs.iter().map(|(a, _)| a));
        let second = StateSpace::of(pairs.iter().map(|(_, b)| b));
        let compare_pair =
            |(number, pair): (usize, &(World, World))| self.compare_pair(number, pair, [&first, &second]);
        let per_pair: Vec<Findings> = pairs
            .par_iter()
            .enumerate()
            .map(compare_pair)
            .collect::<Result<_, _>>()?;
        let mut found = Findings::default();
        if let Some(difference) = first.difference(&second) {
            found.record(Element::S, Witness::of(None, None, None, difference));
        }
        for own in per_pair {
            found.add(own);
        }
        Ok(found)
    }

    fn compare_pair(
        &self,
        number: usize,
        (a, b): &(World, World),
        spaces: [&StateSpace; 2],
    ) -> Result<Findings, EnvError> {
        let paired = Paired::new(a, b);
        let mut found = Findings::default();
        let state_space = space::ground_difference(a, b).map(|difference| (Element::S, difference));
        let start = paired.count_difference(spaces).or_else(|| paired.start_difference());
        let actions = space::action_difference(a, b).map(|difference| (Element::A, difference));
        let observations =
            space::observation_difference(a, b, self.modalities.is_some()).map(|difference| (Element::O, difference));
        let start = start.map(|difference| (Element::P, difference));
        for (element, difference) in [state_space, start, actions, observations].into_iter().flatten() {
            found.record(element, Witness::of(Some(number), None, None, difference));
        }
        found.proof.worlds += 1;
        for leader in [0, 1] {
            let mut run = Run::new(self, number, &paired, leader)?;
            for policy in Policy::ALL {
                run.run_policy(policy, &mut found)?;
            }
            run.compare_at_time_limit(&mut found);
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests;
