//! [`ScalesFile`]: a file of floors and ceilings of variants.

use std::collections::BTreeMap;
use std::path::Path;

use driftworld_metrics::{Anchors, Scales, Unlabelled};
use driftworld_text::{ShownPath, in_plain_words, one_line};
use serde::{Deserialize, Serialize};

use super::{BestAgent, UnlabelledCeiling};
use crate::{Failure, documents};

/// Floors and ceilings of variants, and how they were measured. A file made by hand needs only `scales`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScalesFile {
    /// Version of the program that measured them.
    #[serde(default)]
    pub version: String,
    /// Worlds per variant that each agent ran in.
    #[serde(default)]
    pub worlds: u64,
    /// The seed of the worlds.
    #[serde(default)]
    pub seed: u64,
    /// The variants by their names in logs, such as `findobjects_red`.
    pub scales: BTreeMap<String, VariantScale>,
    /// Ceilings of agents that cannot distinguish the variants of a set.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unlabelled: Vec<UnlabelledCeiling>,
}

/// The floor and ceiling of a variant, in reward per episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VariantScale {
    /// The variant's own name, such as `find_objects#red`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub variant: String,
    /// Reward of the best agent that knows nothing.
    pub floor: f64,
    /// Reward of an agent that knows the map; if it is not above the floor, nothing can be learned.
    pub ceiling: f64,
    /// Results of each agent.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub agents: BTreeMap<String, AgentLevel>,
}

/// An agent's results in a variant's worlds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AgentLevel {
    /// Mean reward of an episode.
    pub mean: f64,
    /// Standard error of the mean, over worlds.
    pub standard_error: f64,
    /// Share of successful episodes, 0..=1.
    pub success: f64,
}

impl AgentLevel {
    /// Summarises at least two episodes, each given by its reward and whether it succeeded. Rounds to six decimals, as in files.
    pub(super) fn of(episodes: &[(f64, bool)]) -> Self {
        let num = episodes.len() as f64;
        let mean = episodes.iter().map(|episode| episode.0).sum::<f64>() / num;
        let squares: f64 = episodes.iter().map(|episode| (episode.0 - mean).powi(2)).sum();
        let rounded = |value: f64| (value * 1e6).round() / 1e6;
        Self {
            mean: rounded(mean),
            standard_error: rounded((squares / (num - 1.0) / num).sqrt()),
            success: rounded(episodes.iter().filter(|episode| episode.1).count() as f64 / num),
        }
    }
}

impl ScalesFile {
    /// Reads a file of scales.
    ///
    /// # Errors
    /// [`Failure`] if the file cannot be read or has the wrong contents.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let expected = "scales, such as {\"scales\": {\"find_red\": {\"floor\": 0, \"ceiling\": 10}}}";
        serde_json::from_str(&documents::text(path)?).map_err(|error| {
            Failure::input(format!(
                "{}: {}; expected {expected}",
                path.shown(),
                one_line(in_plain_words(error))
            ))
        })
    }

    /// The floors and ceilings alone, by lower-case names.
    pub fn anchors(&self) -> Scales {
        let unlabelled = |name: &str| {
            let of_set = |set: &UnlabelledCeiling| {
                let level = |best: &BestAgent| {
                    let mut levels = best.levels.iter();
                    let own = levels.find(|(variant, _)| variant.to_lowercase() == name);
                    own.map(|(_, level)| level.mean)
                };
                Some(Unlabelled {
                    among: set.among.iter().map(|variant| variant.to_lowercase()).collect(),
                    fixed: level(&set.fixed)?,
                    finds_out: level(&set.finds_out)?,
                })
            };
            self.unlabelled.iter().filter_map(of_set).collect()
        };
        let anchors = |(name, scale): (&String, &VariantScale)| {
            let name = name.to_lowercase();
            let anchors = Anchors {
                floor: scale.floor,
                ceiling: scale.ceiling,
                unlabelled: unlabelled(&name),
            };
            (name, anchors)
        };
        self.scales.iter().map(anchors).collect()
    }
}
