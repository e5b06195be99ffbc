//! Checks whether the built-in planner reaches success in worlds before an agent learns in them.

use driftworld_env::{Catalogue, Expertise};
use driftworld_generator::Sampler;
use driftworld_spec::{Variant, World, ZoneEnd};
use serde::Serialize;

/// Steps after which the planner gives up in a world without a step or time limit.
const PATIENCE: u32 = 10_000;

/// Maximum number of failed worlds that are listed.
const MAX_LISTED: usize = 100;

/// The number of worlds in which the built-in planner reached success.
///
/// The planner is good but not perfect: if it fails, success may still be possible.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Finished {
    /// Number of worlds that can end in success: by a rule or by a zone.
    pub worlds: u64,
    /// Number of those in which the planner succeeded.
    pub succeeded: u64,
    /// The indices of the first failures, at most 100.
    pub failed: Vec<u64>,
}

impl Finished {
    /// Lets the planner try a world, and counts the result. A world without a success condition is not counted.
    pub fn count(&mut self, world: &World, index: u64, catalogue: &Catalogue) {
        let mut zones = world.environment_params.zones.iter();
        if world.rules.success.is_empty() && !zones.any(|zone| zone.ends == Some(ZoneEnd::Success)) {
            return;
        }
        let has_limit = world.max_steps > 0 || world.max_seconds > 0.0;
        let expertise = Expertise {
            steps: if has_limit {
                driftworld_env::MAX_EXPERT_STEPS
            } else {
                PATIENCE
            },
            catalogue: catalogue.clone(),
        };
        self.worlds += 1;
        if expertise.at_home(world).is_ok_and(|run| run.success) {
            self.succeeded += 1;
        } else if self.failed.len() < MAX_LISTED {
            self.failed.push(index);
        }
    }
}

/// Lets the planner try the first `worlds` worlds of a variant under a seed; those that cannot be drawn are skipped.
///
/// # Example
/// ```
/// use driftworld_curriculum::try_expert;
/// use driftworld_env::Catalogue;
/// use driftworld_spec::TaskSpec;
/// let task = TaskSpec::from_json("zone.json", r#"{ "version": 2, "name": "zone", "world": { "max_steps": 200,
///     "environment_params": { "zones": [{ "disc": { "center": [0, 8], "radius": 2 }, "ends": "success" }] } } }"#)?;
/// let found = try_expert(&task.variant("default")?, 7, 3, &Catalogue::default());
/// assert_eq!((found.worlds, found.succeeded), (3, 3));
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
pub fn try_expert(variant: &Variant, seed: u64, worlds: u64, catalogue: &Catalogue) -> Finished {
    let sampler = Sampler::new(variant, seed);
    let mut finished = Finished::default();
    for index in 0..worlds {
        if let Ok(world) = sampler.world(index) {
            finished.count(&world, index, catalogue);
        }
    }
    finished
}
