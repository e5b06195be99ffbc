//! [`WorldDraft`]: a world whose fields can be set freely, before it is checked.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::{fields, word};
use super::{AgentParams, EnvironmentParams, Object, Progress, Rules};
use crate::limits::MAX_SEED;
use crate::maps::MapLibrary;
use crate::serde_defaults::is_default;
use crate::version::WORLD_VERSION;

fields! {
    /// A world whose fields can be set freely. [`WorldDraft::check`] turns it into a [`World`](crate::World).
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Object, WorldDraft};
    /// let world = WorldDraft::with_objects(vec![Object::new("tree", [3.0, 4.0])]).check()?;
    /// assert_eq!(world.objects[0].coordinates, [3.0, 4.0]);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "version": 1, "max_steps": 300, "objects": [{ "class": "tree", "model": "5", "coordinates": [3, 4] }] },
    ]))]
    #[schemars(inline)]
    pub struct WorldDraft {
        /// The address of this document's JSON Schema, for editors; not part of the world.
        #[serde(rename = "$schema", skip_serializing)]
        pub schema: Option<String> = None => Field::ours(Not("it names a schema for editors"))
                .named("$schema")
                .fixed("it names a schema for editors, and is not part of the world"),
        /// The version of this document format. Older versions are read, newer ones rejected; 1 if absent.
        #[schemars(range(min = 1, max = 1))]
        pub version: u32 = WORLD_VERSION => Field::ours(Not("it is the version of the document format"))
                .fixed("it is the version of the document format, and there is only one"),
        /// The seed of all random numbers in the running world: where wandering objects go, which pulls of a bandit arm pay,
        /// where objects reappear. In a sampled world it is derived from the task, the sampling seed and the world's number, so
        /// that all variants of the task share it. Without it, the initial positions of things determine the random numbers.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = MAX_SEED))]
        pub seed: Option<u64> = None
            => Field::ours(Not("two worlds that differ only in their seeds are two runs of one world"))
                .fixed("a sampled world derives it from its task, seed and number, so that all variants share it"),
        /// The purpose of the world.
        pub game_mode: GameMode = GameMode::default()
            => Field::original(Not("photographing objects is not a decision process")),
        /// Steps until the episode is truncated; 0 means never.
        #[schemars(range(min = 0, max = 1_000_000_000))]
        pub max_steps: u32 = 0 => Field::original(Measured(&[Limit])),
        /// Simulated seconds until the episode is truncated, even while an action is still being repeated; 0 means
        /// never. Whichever limit comes first applies. Unlike `max_steps`, it does not depend on how long a step lasts.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = 0.0, max = 1e9))]
        pub max_seconds: f64 = 0.0 => Field::ours(Measured(&[Limit])).unit("s"),
        /// The arena and its light.
        pub environment_params: EnvironmentParams = EnvironmentParams::default() => Field::original(AsPart)
                .in_parts("its keys take parameters of their own"),
        /// The agent.
        pub agent_params: AgentParams = AgentParams::default() => Field::original(AsPart)
                .in_parts("its keys take parameters of their own"),
        /// How objects are photographed in `collect_images`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub image_params: Option<ImageParams> = None
            => Field::original(Not("photographing objects is not a decision process")),
        /// Rewards and endings in addition to those of the objects.
        pub rules: Rules = Rules::default() => Field::ours(AsPart),
        /// The objects of the world. Moving objects move in this order: where two meet, the one listed first has the right of
        /// way.
        #[schemars(length(max = 100_000))]
        pub objects: Vec<Object> = Vec::new()
            => Field::original(Measured(&[Unmatched, Rewards, UnmatchedLooks]))
                .in_parts("how many objects there are is the count of their group"),
        /// The progress of the episode, in a world that was saved while it ran.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub progress: Option<Progress> = None
            => Field::ours(Not("it is the progress of a run, not a property of the world"))
                .fixed("a sampled world has not begun"),
    }
}

/// The purpose of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GameMode {
    /// An agent acts in it.
    #[default]
    Learn,
    /// Its objects are photographed.
    CollectImages,
}

fields! {
    /// How objects are photographed in `collect_images`.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "zoom": 2, "yaw_subdivisions": 8, "vertical_subdivisions": 1 }]))]
    pub struct ImageParams {
        /// Camera distance, as a multiple of the distance at which the object just fits into the picture.
        #[schemars(range(min = 0.1, max = 100.0))]
        pub zoom: f64 = 2.0 => Field::original(AsPart),
        /// Number of views around each object.
        #[schemars(range(min = 1, max = 360))]
        pub yaw_subdivisions: u32 = 8 => Field::original(AsPart),
        /// Number of views from the side up to the top.
        #[schemars(range(min = 1, max = 360))]
        pub vertical_subdivisions: u32 = 1 => Field::original(AsPart),
    }
}

impl WorldDraft {
    /// A world with these objects; all else is at its default.
    pub fn with_objects(objects: Vec<Object>) -> Self {
        Self {
            objects,
            ..Self::default()
        }
    }

    /// Time steps until `max_seconds` have passed: the first step that ends at or after that time. `None` without such a limit.
    pub fn max_ticks(&self) -> Option<u64> {
        // Slightly less, so that 60 s are 600 time steps of 0.1 s, which has no exact binary form.
        let ticks = || (self.max_seconds / self.agent_params.time_step - 1e-6).ceil();
        (self.max_seconds > 0.0).then(|| ticks().max(1.0) as u64)
    }

    /// Maximum number of steps until the episode is truncated, by `max_steps` or by `max_seconds`; `None` if never.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::WorldDraft;
    /// let mut world = WorldDraft { max_seconds: 20.0, ..WorldDraft::default() };
    /// assert_eq!(world.step_limit(), Some(200));
    /// world.agent_params.frame_skip = 3;
    /// assert_eq!(world.step_limit(), Some(67), "the last is cut short");
    /// world.max_steps = 50;
    /// assert_eq!(world.step_limit(), Some(50));
    /// ```
    pub fn step_limit(&self) -> Option<u32> {
        let held = u64::from(self.agent_params.frame_skip.max(1));
        let by_time = self
            .max_ticks()
            .map(|ticks| u32::try_from(ticks.div_ceil(held)).unwrap_or(u32::MAX));
        let by_steps = (self.max_steps > 0).then_some(self.max_steps);
        by_steps.into_iter().chain(by_time).min()
    }

    /// Replaces all limits of the world with a limit on steps, 0 for no limit.
    pub fn limit_steps(&mut self, max_steps: u32) {
        (self.max_steps, self.max_seconds) = (max_steps, 0.0);
    }
}

word!(GameMode);

impl MapLibrary {
    /// Writes the layout of the world's predefined map into the world, if the library has it; after that, the world needs no
    /// library.
    pub fn apply(&self, world: &mut WorldDraft) {
        let environment = &mut world.environment_params;
        if let Some(map) = self.layout(environment.map()) {
            environment.map_regions = Some(map.excluded_regions.clone());
        }
    }
}
