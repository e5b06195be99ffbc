//! [`World`]: the reset JSON, one fully concrete world. Its L2Explorer dialect is read and written in `l2explorer/`.

mod agent;
mod check;
mod defaults;
mod environment;
mod features;
mod fields;
mod object;
mod places;
mod progress;
mod remarks;
mod rules;
mod table;

use std::sync::LazyLock;

use std::fmt::Write;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

pub use agent::{ActionModel, ActionSpace, AgentParams, Modality};
pub use environment::{Enclosure, EnvironmentParams, Region, Wall};
pub use features::StateFeature;
pub use fields::{Compared, Comparison, Field, FieldPlace};
pub(crate) use fields::{Fields, Place, Setter, places_of};
use fields::{fields, word};
pub use object::{Model, MotionModel, Object, Pushable, Respawn, Stimulus};
pub use progress::{LastEvent, ObjectProgress, Origin, Progress, RailsProgress};
pub use rules::{EndCondition, Rules, Shaping};
pub use table::SameTexts;

use crate::classes::Classes;
use crate::document::Document;
use crate::error::{Problem, SpecError};
use crate::limits::MAX_WORLD_VALUES;
use crate::schema::document::DocumentSchema;
use crate::version;
use crate::version::WORLD_VERSION;
use defaults::is_default;

/// The most objects that one world may hold.
pub const MAX_OBJECTS: usize = 100_000;

/// The largest seed of a world or an object, 2⁵³ − 1: the largest whole number that every reader of JSON keeps.
pub const MAX_SEED: u64 = (1 << 53) - 1;

/// The most points of one picture: 4096 × 4096 pixels with 2 × 2 points each.
pub const MAX_POINTS: u64 = 1 << 26;

fields! {
    /// One fully concrete world: what a reset takes.
    ///
    /// A superset of L2Explorer's reset payload. Reading is strict: [`World::from_json`] names every unknown key, wrong type
    /// and value out of range at once, with its place.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let world = World::from_json("inline", r#"{ "max_steps": 50, "objects": [{ "class": "tree", "coordinates": [3, 4] }] }"#)?;
    /// assert_eq!(world.objects[0].coordinates, [3.0, 4.0]);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "version": 1, "max_steps": 300, "objects": [{ "class": "tree", "model": "5", "coordinates": [3, 4] }] },
    ]))]
    pub struct World {
        /// Where the JSON Schema of this document is, for editors; not part of the world.
        #[serde(rename = "$schema", skip_serializing)]
        pub schema: Option<String> = None => Field::ours(Not("it names a schema for editors"))
                .named("$schema")
                .fixed("it names a schema for editors, and is no part of the world"),
        /// The version of this form of document. Older ones are read, newer ones refused; without it, it is taken to be 1.
        #[schemars(range(min = 1, max = 1))]
        pub version: u32 = WORLD_VERSION => Field::ours(Not("it is the form of the document"))
                .fixed("it is the form of the document, which has one"),
        /// What all chance in the running world grows from: where wanderers go, which pulls of a bandit arm pay, where objects come
        /// back. A sampled world has one of its task, seed and number, so that all variants of the task share it. Without it
        /// the places of things decide.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = MAX_SEED))]
        pub seed: Option<u64> = None
            => Field::ours(Not("two worlds that differ in chance alone are two runs of one world"))
                .fixed("a sampled world has that of its task, seed and number, so that all variants share it"),
        /// What the world is for.
        pub game_mode: GameMode = GameMode::default()
            => Field::original(Not("photographing objects is no decision process")),
        /// Steps until the episode is truncated; 0 is never.
        #[schemars(range(min = 0, max = 1_000_000_000))]
        pub max_steps: u32 = 0 => Field::original(Measured(&[Limit])),
        /// Seconds of the world's own time until the episode is truncated, be it in the midst of an action that is held; 0 is never.
        /// Of two limits the earlier holds. Unlike `max_steps` it does not depend on how long a step lasts.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = 0.0, max = 1e9))]
        pub max_seconds: f64 = 0.0 => Field::ours(Measured(&[Limit])).unit("s"),
        /// The arena and its light.
        pub environment_params: EnvironmentParams = EnvironmentParams::default() => Field::original(AsPart),
        /// The agent.
        pub agent_params: AgentParams = AgentParams::default() => Field::original(AsPart),
        /// How objects are photographed in `collect_images`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub image_params: Option<ImageParams> = None
            => Field::original(Not("photographing objects is no decision process")),
        /// Rewards and endings beside those of the objects.
        pub rules: Rules = Rules::default() => Field::ours(AsPart),
        /// What stands in the world.
        #[schemars(length(max = 100_000))]
        pub objects: Vec<Object> = Vec::new()
            => Field::original(Measured(&[NumbersOfObjects, PlacesOfObjects, CellsTaken])),
        /// How far it has come, for a world that was written down while it ran.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub progress: Option<Progress> = None
            => Field::ours(Not("it is how far a world has come, not which world it is"))
                .fixed("a sampled world has not begun"),
    }
}

/// What a world is for.
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
        /// Distance of the camera as a factor on that from which the object just fits into the picture.
        #[schemars(range(min = 0.1, max = 100.0))]
        pub zoom: f64 = 2.0 => Field::original(AsPart),
        /// Views around each object.
        #[schemars(range(min = 1, max = 360))]
        pub yaw_subdivisions: u32 = 8 => Field::original(AsPart),
        /// Views from the side up to the top.
        #[schemars(range(min = 1, max = 360))]
        pub vertical_subdivisions: u32 = 1 => Field::original(AsPart),
    }
}

impl World {
    /// The schema of a world.
    pub fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<World>("world", "Driftworld world"));
        &SCHEMA
    }

    /// Reads a world, strictly. `name` is what messages call the document, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with every problem of the text at once, sorted by place.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        Self::from_json_with(name, text, None)
    }

    /// As [`World::from_json`], and refuses objects whose classes are none of these, where it is told any.
    ///
    /// # Errors
    /// As [`World::from_json`].
    pub fn from_json_with(name: &str, text: &str, classes: Option<&Classes>) -> Result<Self, SpecError> {
        let mut document = Document::parse(name, text, MAX_WORLD_VALUES)?;
        document.upgrade(&version::WORLD)?;
        document.fail_on(World::schema().problems(&document.value))?;
        let world: Self = document.deserialize()?;
        let mut problems = world.problems();
        problems.extend(classes.into_iter().flat_map(|classes| world.unknown_classes(classes)));
        document.fail_on(problems)?;
        Ok(world)
    }

    /// The world as one line of JSON: the same world gives the same bytes on every platform.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a world has string keys and finite numbers only, which always serialise")
    }

    /// The world as indented JSON with a final newline.
    pub fn to_json_pretty(&self) -> String {
        let mut text = serde_json::to_string_pretty(self)
            .expect("a world has string keys and finite numbers only, which always serialise");
        text.push('\n');
        text
    }

    /// The world's name by its content: the SHA-256 of [`World::to_json`] in hexadecimal, 64 characters.
    pub fn hash(&self) -> String {
        hexadecimal(&Sha256::digest(self.to_json()))
    }

    /// Time steps until `max_seconds` have passed: the first at whose end they have. `None` without such a limit.
    pub fn max_ticks(&self) -> Option<u64> {
        // A little less, so that 60 s are 600 time steps of 0.1 s, which is no number of binary digits.
        let ticks = || (self.max_seconds / self.agent_params.time_step - 1e-6).ceil();
        (self.max_seconds > 0.0).then(|| ticks().max(1.0) as u64)
    }

    /// Steps until the episode is truncated at the latest, by `max_steps` or by `max_seconds`; `None` for never.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let mut world = World { max_seconds: 20.0, ..World::default() };
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

    /// Sets a limit of steps, 0 for never, in place of all limits that the world has.
    pub fn limit_steps(&mut self, max_steps: u32) {
        (self.max_steps, self.max_seconds) = (max_steps, 0.0);
    }

    /// Every object whose class is none of these.
    pub fn unknown_classes(&self, classes: &Classes) -> Vec<Problem> {
        let objects = self.objects.iter().enumerate();
        objects
            .filter_map(|(index, object)| classes.problem(format!("/objects/{index}/class"), &object.class))
            .collect()
    }

    /// What the schema cannot say: checks that look at several values at once.
    pub(crate) fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.environment_params.sun_direction == [0.0; 3] {
            problems.push(Problem::new(
                "spec/zero-direction",
                "/environment_params/sun_direction",
                "[0, 0, 0]",
                "a direction, such as [0.4, -0.3, 0.8]",
            ));
        }
        if self.environment_params.predefined_map == 0 && self.environment_params.map_size.contains(&0.0) {
            problems.push(
                Problem::new(
                    "spec/empty-arena",
                    "/environment_params/map_size",
                    "a side of 0 m",
                    "sides above 0 m",
                )
                .advise("or choose a predefined_map from 1 to 4"),
            );
        }
        let [width, height] = self.agent_params.picture_size();
        let points = u64::from(width) * u64::from(height) * u64::from(self.agent_params.supersampling).pow(2);
        if points > MAX_POINTS {
            problems.push(
                Problem::new(
                    "spec/too-many-points",
                    "/agent_params/supersampling",
                    format!("{points} points for {width} × {height} pixels"),
                    format!("at most {MAX_POINTS} points"),
                )
                .advise("use smaller observations or less supersampling"),
            );
        }
        let agent = &self.agent_params;
        if (agent.action_model, &agent.actions) == (ActionModel::ByWaypoint, &ActionSpace::DefaultDiscrete) {
            problems.push(Problem::new(
                "spec/no-default-actions",
                "/agent_params/actions",
                "default_discrete under bywaypoint, whose rows are places",
                "a table, such as {\"discrete\": [[3, 4, 0], [-3, 4, 0]]}",
            ));
        }
        problems.extend(progress::problems(self));
        problems.extend(duplicate_names(&self.objects));
        problems
    }
}

/// Bytes as hexadecimal letters, two for each.
fn hexadecimal(bytes: &[u8]) -> String {
    bytes
        .iter()
        .fold(String::with_capacity(2 * bytes.len()), |mut letters, byte| {
            write!(letters, "{byte:02x}").expect("writing to a String does not fail");
            letters
        })
}

fn duplicate_names(objects: &[Object]) -> impl Iterator<Item = Problem> {
    let mut seen = std::collections::BTreeMap::new();
    objects.iter().enumerate().filter_map(move |(index, object)| {
        let name = object.unique_name.as_ref()?;
        let first = *seen.entry(name).or_insert(index);
        (first != index).then(|| {
            Problem::new(
                "spec/duplicate-name",
                format!("/objects/{index}/unique_name"),
                format!("{name:?}, which object {first} has too"),
                "a name of its own",
            )
        })
    })
}

word!(GameMode);
