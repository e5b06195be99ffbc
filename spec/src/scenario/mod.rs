//! [`Scenario`]: a curriculum as a document, with learning and evaluation blocks.

mod check;
mod drift;
mod proof;
mod regime;

use std::sync::LazyLock;

use driftworld_text::NAME_PATTERN;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use drift::{DriftSchedule, DriftSwitch, RegimeDrift};
pub use proof::{ProvenVariant, ScenarioProof};
pub use regime::Regime;

use crate::schema::document::DocumentSchema;
use crate::serde_defaults::is_default;
use crate::version::SCENARIO_VERSION;

/// Maximum number of experiences of one regime.
pub const MAX_EXPERIENCES: u32 = 10_000_000;

/// A lifetime: blocks of learning and evaluation, in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "version": 1, "name": "two-colours", "blocks": [
        { "type": "learning", "regimes": [{ "task": "find_objects", "variant": "blue", "count": 100, "seed": 2 }] },
        { "type": "evaluation", "regimes": [{ "task": "find_objects", "variant": "red", "count": 10, "seed": 3 }] } ] },
]))]
pub struct Scenario {
    /// The address of this document's JSON Schema, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// The version of the document format. Older versions are read, newer ones rejected; 1 if absent.
    #[serde(default = "current")]
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// The scenario's name; logs are named after it.
    #[schemars(length(min = 1, max = 100), regex(pattern = NAME_PATTERN))]
    pub name: String,
    /// The purpose of the scenario, in a sentence or two.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// How its blocks are arranged; recorded in logs. Custom if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form: Option<ScenarioForm>,
    /// How complex it is, in l2logger's terms; recorded in logs. Not recorded if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub complexity: Option<ScenarioComplexity>,
    /// How hard its tasks are, in l2logger's terms; recorded in logs. Not recorded if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub difficulty: Option<ScenarioDifficulty>,
    /// Whether the learner gets the label of the task that it is in; by default it does not.
    #[serde(default, skip_serializing_if = "is_default")]
    pub task_label: TaskLabel,
    /// Experimental evidence that its variants differ in only one element; for scenarios that probe an element.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub proof: Option<ScenarioProof>,
    /// The blocks, in the order in which they are run.
    #[schemars(length(min = 1, max = 100_000))]
    pub blocks: Vec<Block>,
}

fn current() -> u32 {
    SCENARIO_VERSION
}

/// Named arrangements of blocks in lifelong learning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ScenarioForm {
    /// Each task once, in one long learning block.
    Condensed,
    /// Each task repeatedly, in several short learning blocks.
    Dispersed,
    /// The tasks in a random order, different in every lifetime.
    Permuted,
    /// Two tasks alternating.
    Alternating,
    /// A single task, as a baseline for a lifelong learner; `ste` in a log.
    Expert,
    /// All tasks interleaved: joint training, an upper bound for a lifelong learner; `custom` in a log.
    Joint,
    /// Anything else.
    Custom,
}

/// How complex a scenario is, in l2logger's terms; chosen by its author.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum ScenarioComplexity {
    /// Low.
    #[serde(rename = "1-low")]
    Low,
    /// Intermediate.
    #[serde(rename = "2-intermediate")]
    Intermediate,
    /// High.
    #[serde(rename = "3-high")]
    High,
}

/// How hard the tasks of a scenario are, in l2logger's terms; chosen by its author.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum ScenarioDifficulty {
    /// Easy.
    #[serde(rename = "1-easy")]
    Easy,
    /// Medium.
    #[serde(rename = "2-medium")]
    Medium,
    /// Hard.
    #[serde(rename = "3-hard")]
    Hard,
}

/// Whether the learner gets the label of the task that it is in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TaskLabel {
    /// It does not get the label.
    #[default]
    None,
    /// In the info, separate from its observations.
    Info,
    /// As part of its observations.
    Observation,
}

/// A block: the agent either learns, or is frozen and evaluated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "type": "learning", "regimes": [{ "task": "find_objects", "variant": "blue", "count": 100 }] },
]))]
pub struct Block {
    /// Whether the agent may learn.
    #[serde(rename = "type")]
    pub kind: BlockKind,
    /// Whether the block belongs to the time before deployment; such blocks come before all others.
    #[serde(default, skip_serializing_if = "is_default")]
    pub phase: Phase,
    /// The order in which its experiences are run; one regime after another if absent.
    #[serde(default, skip_serializing_if = "is_default")]
    pub mix: BlockMix,
    /// Sequences of experiences, each of one variant.
    #[schemars(length(min = 1, max = 100_000))]
    pub regimes: Vec<Regime>,
}

/// The order in which the experiences of a block are run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BlockMix {
    /// One regime after another.
    #[default]
    InOrder,
    /// All regimes interleaved, in a random order drawn from the first regime's seed: joint training. The worlds within a
    /// regime come in that order too.
    Shuffled,
}

/// Whether the agent may learn in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum BlockKind {
    /// The agent may learn.
    Learning,
    /// The agent is frozen.
    Evaluation,
}

/// The part of a lifetime to which a block belongs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Preparation: what is learned here is not scored as lifelong learning.
    PreDeployment,
    /// The lifetime itself.
    #[default]
    Deployment,
}

impl Block {
    /// A block of the deployment phase.
    pub fn new(kind: BlockKind, regimes: Vec<Regime>) -> Self {
        Self {
            kind,
            phase: Phase::default(),
            mix: BlockMix::default(),
            regimes,
        }
    }

    /// Number of experiences.
    pub fn num_experiences(&self) -> u64 {
        self.regimes.iter().map(|regime| u64::from(regime.count)).sum()
    }
}

impl Scenario {
    /// The schema of a scenario.
    pub fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<Scenario>("scenario", "Driftworld scenario"));
        &SCHEMA
    }

    /// A scenario of the current version with only a name and blocks.
    pub fn new(name: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self {
            schema: None,
            version: SCENARIO_VERSION,
            name: name.into(),
            description: String::new(),
            form: None,
            complexity: None,
            difficulty: None,
            task_label: TaskLabel::default(),
            proof: None,
            blocks,
        }
    }

    /// The scenario as indented JSON with a final newline.
    pub fn to_json_pretty(&self) -> String {
        let mut text = serde_json::to_string_pretty(self)
            .expect("a scenario has only strings, finite numbers and maps with string keys, which serialise");
        text.push('\n');
        text
    }

    /// Number of experiences in the whole lifetime.
    pub fn num_experiences(&self) -> u64 {
        self.blocks.iter().map(Block::num_experiences).sum()
    }
}
