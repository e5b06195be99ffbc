//! Whether the agent on rails comes to the success of worlds before they are learned in.

use driftworld_env::{Catalogue, Expertise};
use driftworld_generator::Sampler;
use driftworld_spec::{Variant, World, ZoneEnd};
use serde::Serialize;

/// Steps after which the agent on rails gives up in a world that sets no limit.
const PATIENCE: u32 = 10_000;

/// The most worlds that are told one by one.
const MOST_TOLD: usize = 100;

/// In how many worlds the agent on rails came to a success.
///
/// It is a good planner and not a perfect one: where it fails, a success may still be possible.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Finished {
    /// How many of the worlds can end as a success: by a rule or by a zone.
    pub worlds: u64,
    /// In how many of those the agent on rails came to it.
    pub succeeded: u64,
    /// The numbers of the first in which it did not, 100 at most.
    pub failed: Vec<u64>,
}

impl Finished {
    /// Lets the agent on rails try a world, and counts what came of it. One without a success is not counted.
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
        } else if self.failed.len() < MOST_TOLD {
            self.failed.push(index);
        }
    }
}

/// Lets the agent on rails try the first `worlds` worlds of a variant under a seed; those that cannot be drawn are left out.
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
