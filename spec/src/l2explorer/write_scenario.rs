//! A [`Scenario`] written in the original's form, and what of it that form cannot say.

use serde_json::{Map, Value as Json, json};

use super::read_scenario::stem;
use crate::error::{Problem, SpecError};
use crate::scenario::{Block, BlockKind, Phase, Regime, Scenario, ScenarioForm, TaskLabel};
use crate::warning::Warning;

impl Scenario {
    /// The scenario in the original's form, and what of it that form cannot say.
    ///
    /// # Errors
    /// [`SpecError::Document`] with every regime that has no world file: the original lives one map in each regime.
    pub fn to_l2explorer(&self) -> Result<(String, Vec<Warning>), SpecError> {
        let mut writer = Writer::default();
        let json = writer.scenario(self);
        if !writer.problems.is_empty() {
            let name = self.name.clone();
            let problems = writer.problems;
            return Err(SpecError::Document {
                name,
                problems,
                more: false,
            });
        }
        let mut text = serde_json::to_string_pretty(&json).expect("texts and whole numbers serialise");
        text.push('\n');
        Ok((text, writer.warnings))
    }
}

#[derive(Default)]
struct Writer {
    warnings: Vec<Warning>,
    problems: Vec<Problem>,
    /// Variants that were warned about.
    renamed: Vec<String>,
}

impl Writer {
    fn scenario(&mut self, scenario: &Scenario) -> Json {
        if !scenario.description.is_empty() {
            self.lost("/description", "the description");
        }
        if scenario.form.is_some_and(|form| form != ScenarioForm::Custom) {
            self.lost("/form", "the form");
        }
        if scenario.task_label != TaskLabel::None {
            self.lost("/task_label", "that the learner is told its task");
        }
        if scenario.proof.is_some() {
            self.lost("/proof", "the proof of what it probes");
        }
        let blocks = scenario.blocks.iter().enumerate();
        let blocks: Vec<Json> = blocks
            .map(|(b, block)| self.block(&format!("/blocks/{b}"), block))
            .collect();
        json!({ "logging_base_dir": scenario.name, "scenario": blocks })
    }

    fn block(&mut self, at: &str, block: &Block) -> Json {
        if block.phase == Phase::PreDeployment {
            self.lost(&format!("{at}/phase"), "that the block comes before deployment");
        }
        let kind = match block.kind {
            BlockKind::Learning => "train",
            BlockKind::Evaluation => "test",
        };
        let regimes = block.regimes.iter().enumerate();
        let regimes: Vec<Json> = regimes
            .map(|(r, regime)| self.regime(&format!("{at}/regimes/{r}"), regime))
            .collect();
        json!({ "type": kind, "regimes": regimes })
    }

    fn regime(&mut self, at: &str, regime: &Regime) -> Json {
        let Some(world) = &regime.world else {
            let found = format!("worlds drawn from {}#{}", regime.task, regime.variant_name());
            let problem = Problem::new("spec/value", at, found, "the key \"world\" with a world file");
            let advice = "the original lives one map in each regime: draw worlds with driftworld sample and name them";
            self.problems.push(problem.advise(advice));
            return Json::Null;
        };
        if stem(world) != regime.variant && !self.renamed.contains(&regime.variant) {
            self.renamed.push(regime.variant.clone());
            self.lost(
                &format!("{at}/variant"),
                &format!("the variant's name {:?}", regime.variant),
            );
        }
        let mut params = Map::new();
        params.insert("map".into(), json!(world));
        if let Some(steps) = regime.max_steps {
            params.insert("maxsteps".into(), json!(steps));
        }
        json!({ "task": regime.task, "count": regime.count, "params": params })
    }

    fn lost(&mut self, pointer: &str, what: &str) {
        self.warnings.push(Warning {
            name: "scenario".to_owned(),
            pointer: pointer.to_owned(),
            line: 0,
            column: 0,
            text: format!("{what} cannot be said in the original's form and is left out"),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn what_the_original_cannot_say_is_told() {
        let mut scenario = Scenario::new(
            "s",
            vec![Block::new(BlockKind::Learning, vec![Regime::new("find", "red", 3)])],
        );
        let error = scenario.to_l2explorer().unwrap_err().to_string();
        assert!(
            error.contains("(/blocks/0/regimes/0): found worlds drawn from find#red, expected the key \"world\""),
            "{error}"
        );
        scenario.blocks[0].regimes[0].world = Some("maps/yard.json".into());
        scenario.description = "Long.".into();
        scenario.blocks[0].phase = Phase::PreDeployment;
        let (_, warnings) = scenario.to_l2explorer().unwrap();
        let pointers: Vec<&str> = warnings.iter().map(|warning| warning.pointer.as_str()).collect();
        assert_eq!(
            pointers,
            ["/description", "/blocks/0/phase", "/blocks/0/regimes/0/variant"]
        );
    }
}
