//! [`Scenario`]: a curriculum as a document: learning and evaluation blocks. Designing and running one is `curriculum`'s job.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Document;
use crate::error::{Problem, SpecError};
use crate::version::SCENARIO_VERSION;
use crate::{schema, version};

/// The most experiences that one regime may hold.
pub const MAX_EXPERIENCES: u32 = 10_000_000;

/// A lifetime: blocks of learning and evaluation, in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Where the JSON Schema of this document is, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// The version of this form of document. Older ones are read, newer ones refused; without it, it is taken to be 1.
    #[serde(default = "current")]
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// The scenario's name; logs are named after it.
    #[schemars(length(min = 1, max = 100), regex(pattern = "^[0-9a-zA-Z_.-]+$"))]
    pub name: String,
    /// What it is for, in a sentence or two.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// The blocks, in the order in which they are lived.
    #[schemars(length(min = 1, max = 100_000))]
    pub blocks: Vec<Block>,
}

fn current() -> u32 {
    SCENARIO_VERSION
}

/// A block: the agent either learns, or is frozen and evaluated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Whether the agent may learn.
    #[serde(rename = "type")]
    pub kind: BlockKind,
    /// Stretches of experiences of one variant each, in order.
    #[schemars(length(min = 1, max = 100_000))]
    pub regimes: Vec<Regime>,
}

/// Whether the agent may learn in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum BlockKind {
    /// It may.
    Learning,
    /// It is frozen.
    Evaluation,
}

/// A stretch of experiences (episodes) of one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Regime {
    /// The task: a built-in name, or the path of a task spec.
    #[schemars(length(min = 1, max = 4096))]
    pub task: String,
    /// The variant of the task.
    #[schemars(length(min = 1, max = 100))]
    pub variant: String,
    /// How many experiences.
    #[schemars(range(min = 1, max = 10_000_000))]
    pub count: u32,
    /// The seed of its worlds.
    #[serde(default)]
    pub seed: u64,
    /// The index of its first world; the others follow.
    #[serde(default)]
    pub first_index: u64,
}

impl Scenario {
    /// Reads a scenario, strictly. `name` is what messages call the document, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with every problem of the text at once, sorted by place.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        let mut document = Document::parse(name, text)?;
        document.upgrade(&version::SCENARIO)?;
        document.check_schema(schema::scenario())?;
        let scenario: Self = document.deserialize()?;
        document.fail_on(scenario.problems())?;
        Ok(scenario)
    }

    /// The scenario as indented JSON with a final newline.
    pub fn to_json_pretty(&self) -> String {
        let mut text =
            serde_json::to_string_pretty(self).expect("a scenario is texts and whole numbers, which serialise");
        text.push('\n');
        text
    }

    /// How many experiences the whole lifetime has.
    pub fn num_experiences(&self) -> u64 {
        self.blocks
            .iter()
            .flat_map(|block| &block.regimes)
            .map(|regime| u64::from(regime.count))
            .sum()
    }

    fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        for (b, block) in self.blocks.iter().enumerate() {
            for (r, regime) in block.regimes.iter().enumerate() {
                if regime.first_index.checked_add(u64::from(regime.count)).is_none() {
                    let pointer = format!("/blocks/{b}/regimes/{r}/first_index");
                    let found = regime.first_index.to_string();
                    problems.push(Problem::new(
                        "spec/range",
                        pointer,
                        found,
                        "an index that leaves room for count more",
                    ));
                }
            }
        }
        problems
    }
}
