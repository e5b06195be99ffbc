//! `scenario_info.json`: the complexity, difficulty and type of a scenario, and other notes of its author.

use std::path::Path;
use std::str::FromStr;

use serde::Serialize;
use serde_json::{Map, Value};

use super::json_file;
use super::warning::LogWarning;
use crate::MetricsError;
use crate::choice::choice;

pub(super) const FILE_NAME: &str = "scenario_info.json";

choice! {
    /// How complex the scenario is.
    Complexity, "complexity" {
        /// Low.
        Low = "1-low",
        /// Intermediate.
        Intermediate = "2-intermediate",
        /// High.
        High = "3-high",
    }
}

choice! {
    /// How hard the tasks of the scenario are.
    Difficulty, "difficulty" {
        /// Easy.
        Easy = "1-easy",
        /// Medium.
        Medium = "2-medium",
        /// Hard.
        Hard = "3-hard",
    }
}

choice! {
    /// How the scenario orders its tasks.
    ScenarioType, "scenario type" {
        /// Each task in one learning block.
        Condensed = "condensed",
        /// Each task in several learning blocks.
        Dispersed = "dispersed",
        /// The tasks in a random order.
        Permuted = "permuted",
        /// Two tasks in turn.
        Alternating = "alternating",
        /// A single-task expert: one task, trained alone as a baseline.
        Ste = "ste",
        /// Anything else.
        Custom = "custom",
    }
}

/// The description of a run. Every field is optional; the evaluation copies the first three into its results.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ScenarioInfo {
    /// Complexity of the scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub complexity: Option<Complexity>,
    /// Difficulty of its tasks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difficulty: Option<Difficulty>,
    /// Order of its tasks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scenario_type: Option<ScenarioType>,
    /// All other fields, as written by the author: author, version, the scenario itself, …
    #[serde(flatten)]
    pub extra: Map<String, Value>,
}

impl ScenarioInfo {
    /// Reads the file from a log directory. A missing file and unknown words become warnings, because the rows do not depend on them.
    pub(super) fn read(dir: &Path, warnings: &mut Vec<LogWarning>) -> Result<Self, MetricsError> {
        let mut extra = match json_file::read_object(&dir.join(FILE_NAME), "a JSON object") {
            Ok(object) => object,
            Err(MetricsError::MissingFile { .. }) => {
                warnings.push(LogWarning::NoScenarioInfo);
                return Ok(Self::default());
            }
            Err(error) => return Err(error),
        };
        Ok(Self {
            complexity: take_word("complexity", &mut extra, warnings, Complexity::expected),
            difficulty: take_word("difficulty", &mut extra, warnings, Difficulty::expected),
            scenario_type: take_word("scenario_type", &mut extra, warnings, ScenarioType::expected),
            extra,
        })
    }

    /// The agent's name, if it is logged.
    pub(crate) fn agent(&self) -> Option<String> {
        Some(self.extra.get("agent")?.as_str()?.to_owned())
    }

    /// Whether a block of our own scenario may skip experience numbers here: some of its regimes have a budget of decisions, and
    /// either a regime ends here, or regimes are mixed, so any of them may have ended.
    pub(super) fn leaves_numbers_unused(&self, block: u64, regime_ends: bool) -> bool {
        let Some(block) = self
            .extra
            .get("scenario")
            .and_then(|scenario| scenario["blocks"].get(block as usize))
        else {
            return false;
        };
        let regimes = block["regimes"].as_array();
        let has_budgets = regimes.is_some_and(|regimes| regimes.iter().any(|regime| regime["steps"].is_u64()));
        has_budgets && (regime_ends || block.get("mix").is_some())
    }

    /// The number of experiences that our own scenario plans, if a log that ends in this block after `done` of them is unfinished.
    pub(super) fn missing_end(&self, last_block: u64, done: u64) -> Option<u64> {
        let blocks = self.extra.get("scenario")?["blocks"].as_array()?;
        let regimes = blocks.iter().filter_map(|block| block["regimes"].as_array()).flatten();
        let planned = regimes.filter_map(|regime| regime["count"].as_u64()).sum();
        let is_last = last_block + 1 >= blocks.len() as u64;
        (done < planned && !(is_last && self.leaves_numbers_unused(last_block, true))).then_some(planned)
    }

    /// Warns about each of the three fields that is missing.
    pub(super) fn warn_of_missing(&self, warnings: &mut Vec<LogWarning>) {
        let mut warn = |field: &'static str, is_missing: bool, expected: fn() -> String| {
            let reported = |warning: &LogWarning| matches!(warning, LogWarning::ScenarioInfo { field: other, .. } if *other == field);
            if is_missing && !warnings.iter().any(reported) {
                warnings.push(LogWarning::ScenarioInfo {
                    field,
                    found: "nothing".to_owned(),
                    expected: expected(),
                });
            }
        };
        // In our own scenarios, the author may leave out complexity and difficulty.
        let ours = self
            .extra
            .get("scenario")
            .is_some_and(|scenario| scenario.get("blocks").is_some());
        warn("complexity", !ours && self.complexity.is_none(), Complexity::expected);
        warn("difficulty", !ours && self.difficulty.is_none(), Difficulty::expected);
        warn("scenario_type", self.scenario_type.is_none(), ScenarioType::expected);
    }
}

/// Removes a field from the object. Warns about and drops a value that is not an accepted word.
fn take_word<T: FromStr>(
    field: &'static str,
    object: &mut Map<String, Value>,
    warnings: &mut Vec<LogWarning>,
    expected: fn() -> String,
) -> Option<T> {
    let value = object.shift_remove(field)?;
    let word = value.as_str().and_then(|text| text.to_lowercase().parse().ok());
    if word.is_none() {
        warnings.push(LogWarning::ScenarioInfo {
            field,
            found: value.to_string(),
            expected: expected(),
        });
    }
    word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_end_is_reported_unless_a_budget_may_leave_numbers_unused() {
        let with = |last: &str| {
            let text = format!(
                r#"{{"scenario": {{"blocks": [{{"regimes": [{{"count": 3}}, {{"count": 2}}]}}, {{"regimes": [{last}]}}]}}}}"#
            );
            ScenarioInfo {
                extra: serde_json::from_str(&text).unwrap(),
                ..ScenarioInfo::default()
            }
        };
        let counted = with(r#"{"count": 4}"#);
        assert_eq!(counted.missing_end(0, 5), Some(9));
        assert_eq!(counted.missing_end(1, 8), Some(9));
        assert_eq!(counted.missing_end(1, 9), None);
        let budget = with(r#"{"count": 4, "steps": 100}"#);
        assert_eq!(budget.missing_end(0, 5), Some(9));
        assert_eq!(budget.missing_end(1, 6), None);
        assert_eq!(ScenarioInfo::default().missing_end(0, 1), None);
    }

    #[test]
    fn unknown_words_warn_and_the_rest_is_kept() {
        let dir = tempfile::tempdir().unwrap();
        let text = r#"{"author": "me", "complexity": "1-LOW", "difficulty": "mild", "scenario_type": 3}"#;
        std::fs::write(dir.path().join(FILE_NAME), text).unwrap();
        let mut warnings = Vec::new();
        let info = ScenarioInfo::read(dir.path(), &mut warnings).unwrap();
        assert_eq!(
            (info.complexity, info.difficulty, info.scenario_type),
            (Some(Complexity::Low), None, None)
        );
        assert_eq!(info.extra["author"], "me");
        let messages: Vec<String> = warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            messages,
            [
                "scenario_info.json, difficulty: found \"mild\", expected one of 1-easy, 2-medium, 3-hard; left out",
                "scenario_info.json, scenario_type: found 3, expected one of condensed, dispersed, permuted, alternating, \
                 ste, custom; left out",
            ]
        );
    }
}
