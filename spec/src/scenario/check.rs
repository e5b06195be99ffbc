//! Reads a scenario, and checks it beyond its schema: rules across blocks, and the tasks that it names.

use std::collections::BTreeMap;
use std::sync::Arc;

use indexmap::IndexMap;

use super::{Block, BlockKind, DriftSwitch, Phase, Regime, Scenario};
use crate::document::Document;
use crate::error::{MAX_PROBLEMS, Problem, SpecError, first_of};
use crate::limits::MAX_SCENARIO_VALUES;
use crate::names;
use crate::task::TaskSpec;
use crate::value::Value;
use crate::version;

impl Scenario {
    /// Reads a scenario strictly. `name` is the document's name in messages, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with all problems of the text, sorted by position.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        Self::from_json_with(name, text, |_| None)
    }

    /// Reads a scenario strictly, and checks its variants and their values against the tasks that can be found.
    ///
    /// `task` is called once for each task that the scenario names; if it returns `None`, that task is not checked.
    ///
    /// # Errors
    /// [`SpecError::Document`] with all problems of the text, sorted by position.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Scenario, TaskSpec};
    /// let lamps = TaskSpec::from_json("lamps", r#"{ "name": "lamps", "variants": { "dim": {}, "bright": {} } }"#)?;
    /// let text = r#"{ "name": "s", "blocks": [{ "type": "learning",
    ///     "regimes": [{ "task": "lamps", "variant": "brigth", "count": 1 }] }] }"#;
    /// let error = Scenario::from_json_with("s", text, |name| (name == "lamps").then(|| lamps.clone())).unwrap_err();
    /// assert!(error.to_string().ends_with("did you mean \"bright\"?"));
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn from_json_with(
        name: &str,
        text: &str,
        task: impl FnMut(&str) -> Option<Arc<TaskSpec>>,
    ) -> Result<Self, SpecError> {
        let mut document = Document::parse(name, text, MAX_SCENARIO_VALUES)?;
        document.upgrade(&version::SCENARIO)?;
        document.fail_on(Self::schema().problems(&document.value))?;
        let scenario: Self = document.deserialize()?;
        let mut problems = alone(&scenario);
        problems.extend(against_tasks(&scenario, task));
        document.fail_on(problems)?;
        Ok(scenario)
    }
}

/// Each regime with its block and its pointer.
fn regimes(scenario: &Scenario) -> impl Iterator<Item = (String, &Block, &Regime)> {
    scenario.blocks.iter().enumerate().flat_map(|(b, block)| {
        let regimes = block.regimes.iter().enumerate();
        regimes.map(move |(r, regime)| (format!("/blocks/{b}/regimes/{r}"), block, regime))
    })
}

/// The start or end variant that a regime declares.
struct DeclaredVariant<'a> {
    pointer: String,
    /// The key that names the variant.
    key: &'static str,
    task: &'a str,
    variant: &'a str,
    values: &'a IndexMap<String, Value>,
    name: Option<&'a str>,
    world: Option<&'a str>,
}

/// The start variant of a regime, and the end variant of its drift.
fn declared_variants<'a>(pointer: &str, regime: &'a Regime) -> impl Iterator<Item = DeclaredVariant<'a>> {
    let start = DeclaredVariant {
        pointer: pointer.to_owned(),
        key: "variant",
        task: &regime.task,
        variant: &regime.variant,
        values: &regime.values,
        name: regime.name.as_deref(),
        world: regime.world.as_deref(),
    };
    let end = regime.drift.as_ref().map(|drift| DeclaredVariant {
        pointer: format!("{pointer}/drift"),
        key: "to",
        task: regime.end_task(),
        variant: &drift.to,
        values: &drift.values,
        name: drift.name.as_deref(),
        world: None,
    });
    [start].into_iter().chain(end)
}

impl<'a> DeclaredVariant<'a> {
    fn label(&self) -> &'a str {
        self.name.unwrap_or(self.variant)
    }

    fn pointer_to_name(&self) -> String {
        let key = if self.name.is_some() { "name" } else { self.key };
        format!("{}/{key}", self.pointer)
    }

    fn is_same(&self, other: &Self) -> bool {
        (self.variant, self.values, self.world) == (other.variant, other.values, other.world)
    }

    /// Reports a name without values, or values without a name.
    fn naming_problem(&self) -> Option<Problem> {
        let (name, values) = (format!("{}/name", self.pointer), format!("{}/values", self.pointer));
        match (self.name, self.values.is_empty()) {
            (Some(found), true) => {
                let found = format!("the name {found:?} without values");
                let problem = Problem::new("spec/value", name, found, "a name together with values");
                Some(problem.advise("remove it: the variant has a name of its own"))
            }
            (None, false) => {
                let problem = Problem::new("spec/missing-key", values, "values without a name", "the key \"name\"");
                Some(problem.advise("name the variant that has these values"))
            }
            _ => None,
        }
    }
}

/// All problems of a scenario that can be found without its tasks.
fn alone(scenario: &Scenario) -> Vec<Problem> {
    let mut problems = phases(scenario);
    problems.extend(budgets(scenario));
    problems.extend(names::problem("/name", &scenario.name));
    let mut named: BTreeMap<(&str, &str), DeclaredVariant> = BTreeMap::new();
    for (pointer, _, regime) in regimes(scenario) {
        // Other names refer to tasks, which follow the grammar; a world file has no task.
        if regime.world.is_some() {
            problems.extend(names::problem(format!("{pointer}/task"), &regime.task));
            problems.extend(names::problem(format!("{pointer}/variant"), &regime.variant));
        }
        if regime.first_index.checked_add(u64::from(regime.count)).is_none() {
            let found = regime.first_index.to_string();
            let expected = "an index to which count can be added";
            problems.push(Problem::new(
                "spec/range",
                format!("{pointer}/first_index"),
                found,
                expected,
            ));
        }
        if regime.world.is_some() && (regime.drift.is_some() || !regime.values.is_empty()) {
            let key = if regime.drift.is_some() { "drift" } else { "values" };
            let found = format!("a world file and {key}");
            let problem = Problem::new("spec/value", format!("{pointer}/{key}"), found, "one of the two");
            problems.push(problem.advise("a world file is used unchanged: edit the file instead"));
            continue;
        }
        if let Some((drift, task)) = regime
            .drift
            .as_ref()
            .and_then(|drift| Some((drift, drift.task.as_ref()?)))
            && drift.switch != DriftSwitch::Task
        {
            let pointer = format!("{pointer}/drift/task");
            let problem = Problem::new(
                "spec/value",
                pointer,
                format!("{task:?}"),
                "\"switch\": \"task\" with it",
            );
            problems.push(problem.advise("different tasks cannot be interpolated: only whole variants can switch"));
            continue;
        }
        let fault = declared_variants(&pointer, regime).find_map(|variant| {
            let own = variant
                .name
                .and_then(|name| names::problem(variant.pointer_to_name(), name));
            variant.naming_problem().or(own)
        });
        if let Some(fault) = fault {
            problems.push(fault);
            continue;
        }
        for variant in declared_variants(&pointer, regime) {
            let key = (variant.task, variant.label());
            if let Some(first) = named.get(&key).filter(|first| !variant.is_same(first)) {
                let found = format!("{:?}, which another variant has at {}", variant.label(), first.pointer);
                let expected = "a different name for each variant of a task";
                problems.push(Problem::new("spec/value", variant.pointer_to_name(), found, expected));
            }
            named.entry(key).or_insert(variant);
        }
    }
    problems
}

fn phases(scenario: &Scenario) -> Vec<Problem> {
    let first = scenario
        .blocks
        .iter()
        .position(|block| block.phase == Phase::Deployment);
    let late =
        |(b, block): &(usize, &Block)| block.phase == Phase::PreDeployment && first.is_some_and(|first| first < *b);
    let problem = |(b, _)| {
        let found = format!("a pre-deployment block after block {}", first.unwrap_or(0));
        let expected = "all pre-deployment blocks before the others";
        Problem::new("spec/value", format!("/blocks/{b}/phase"), found, expected).advise("move the block up")
    };
    scenario.blocks.iter().enumerate().filter(late).map(problem).collect()
}

/// Reports step budgets where the number of experiences must be known: evaluations are compared, and a drift ends with the last
/// experience.
fn budgets(scenario: &Scenario) -> impl Iterator<Item = Problem> {
    regimes(scenario).filter_map(|(pointer, block, regime)| {
        let is_fixed = block.kind == BlockKind::Evaluation || regime.drift.is_some();
        let steps = regime.steps.filter(|_| is_fixed)?;
        let expected = "no step budget in an evaluation or a drift";
        let problem = Problem::new("spec/value", format!("{pointer}/steps"), steps.to_string(), expected);
        Some(problem.advise("set the number of experiences with count"))
    })
}

/// All problems of a scenario with the tasks that it names. Each task is requested once, even if it is not found.
fn against_tasks(scenario: &Scenario, mut find: impl FnMut(&str) -> Option<Arc<TaskSpec>>) -> Vec<Problem> {
    let mut tasks: BTreeMap<&str, Option<Arc<TaskSpec>>> = BTreeMap::new();
    let mut problems = Vec::new();
    for (pointer, _, regime) in regimes(scenario).filter(|(.., regime)| regime.world.is_none()) {
        let mut found = |name| tasks.entry(name).or_insert_with(|| find(name)).clone();
        let (task, end_task) = (found(&regime.task), found(regime.end_task()));
        // Checking a regime takes time, because variants and similar names are looked up.
        if problems.len() > MAX_PROBLEMS {
            break;
        }
        if let Some(Err(error)) = task.map(|task| regime.resolve(&task)) {
            problems.extend(placed(error, &pointer, "variant"));
        }
        if let Some(Err(error)) = end_task.map(|task| regime.resolve_end(&task)) {
            problems.extend(placed(error, &format!("{pointer}/drift"), "to"));
        }
    }
    problems
}

/// Turns an error about a variant into problems of the document that names the variant under `key`.
fn placed(error: SpecError, pointer: &str, key: &str) -> Vec<Problem> {
    match error {
        SpecError::UnknownVariant { task, found, known } => {
            let expected = format!("a variant of {task}: {}", first_of(&known));
            let problem = Problem::new(
                "spec/unknown-variant",
                format!("{pointer}/{key}"),
                format!("{found:?}"),
                expected,
            );
            vec![problem.suggest(&found, &known)]
        }
        SpecError::Values { problems, .. } => problems
            .into_iter()
            .map(|problem| problem.within(&format!("{pointer}/values")))
            .collect(),
        other => vec![Problem::new(
            "spec/value",
            format!("{pointer}/{key}"),
            other.to_string(),
            "a variant that can be drawn from",
        )],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_for(regimes: &str) -> String {
        let text = format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regimes}] }}] }}"#);
        let task = TaskSpec::from_json(
            "t",
            r#"{ "name": "t", "variants": { "day": {}, "dusk": { "light": 0.3 } }, "parameters": {
                "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 } } }"#,
        )
        .unwrap();
        let read = Scenario::from_json_with("s", &text, |name| (name == "t").then(|| Arc::clone(&task)));
        read.map_or_else(|error| error.to_string(), |_| String::new())
    }

    /// Abbreviations in the rows below, each with its expansion.
    const WORDS: [(&str, &str); 9] = [
        ("DIM", r#"{ AT, "values": { "light": 1 }, "name": "dim" }"#),
        ("AT", r#""task": "t", "variant": "day", "count": 1"#),
        ("DUSK", r#""task": "t", "variant": "dusk", "count": 1"#),
        ("YARD", r#""task": "t", "variant": "yard", FILE"#),
        ("OTHER", r#""task": "t", "variant": "yard", "world": "b.json", MORE"#),
        ("FILE", r#""world": "maps/yard.json", MORE"#),
        ("MORE", r#""max_steps": 20, "count": 1"#),
        ("(0", "(/blocks/0/regimes/0"),
        ("(1", "(/blocks/0/regimes/1"),
    ];

    /// Each row holds regimes and a part of the expected error; nothing if they are valid.
    #[track_caller]
    fn check(rows: &str) {
        for row in rows.trim().lines() {
            let whole = WORDS
                .iter()
                .fold(row.to_owned(), |row, (word, text)| row.replace(word, text));
            let (regimes, expected) = whole.split_once(" =>").expect("a row has two parts");
            let expected = expected.trim().replace("at 0", "at /blocks/0/regimes/0");
            let error = error_for(regimes);
            assert!(
                error.contains(&expected) && error.is_empty() == expected.is_empty(),
                "{row}: {error}"
            );
        }
    }

    #[test]
    fn values_require_a_name_and_a_name_belongs_to_one_variant() {
        check(
            r#"
DIM =>
DIM, DIM =>
{ AT, "name": "dim" } => (0/name): found the name "dim" without values, expected a name together with values; remove it
{ AT, "values": { "light": 1 } } => (0/values): found values without a name, expected the key "name"
DIM, { AT, "values": { "light": 1.5 }, "name": "dim" } => (1/name): found "dim", which another variant has at 0
{ AT, "values": { "light": 1 }, "name": "dusk" }, { DUSK } => (1/variant): found "dusk", which another variant has at 0"#,
        );
    }

    #[test]
    fn end_of_a_drift_follows_the_rules_of_names() {
        // A name belongs to a single task.
        check(
            r#"
{ AT, "drift": { "to": "day", "values": { "light": 1 }, "name": "dim" } } =>
{ AT, "drift": { "to": "day", "values": { "light": 1 } } } => (0/drift/values): found values without a name, expected the key "name"
{ AT, "drift": { "to": "dusk", "name": "dim" } } => (0/drift/name): found the name "dim" without values
{ AT, "drift": { "to": "day", "values": { "light": 1 }, "name": "day" } } => (0/drift/name): found "day", which another variant has at 0
{ AT, "drift": { "to": "day", "task": "u" } } => (0/drift/task): found "u", expected "switch": "task" with it; different tasks
{ AT, "drift": { "to": "day", "values": { "light": 1 }, "name": "day", "task": "u", "switch": "task" } } =>
{ AT, "drift": { "to": "day", "values": { "light": 1 }, "name": "dim" } }, DIM =>
{ AT, "drift": { "to": "day", "values": { "light": 1.5 }, "name": "dim" } }, DIM => (1/name): found "dim", which another variant has at 0/drift"#,
        );
    }

    #[test]
    fn world_file_allows_no_drift_and_needs_valid_names() {
        check(
            r#"
{ YARD } =>
{ YARD, "drift": { "to": "dusk" } } => (0/drift): found a world file and drift, expected one of the two; a world file is used unchanged
{ "task": "t", "variant": "a/yard", FILE } => (0/variant): found the name "a/yard" with the character "/", expected letters
{ "task": "=t", "variant": "yard", FILE } => (0/task): found the name "=t" with
{ YARD }, { OTHER } => (1/variant): found "yard", which another variant has at 0"#,
        );
    }

    #[test]
    fn variants_values_and_drifts_are_checked_against_the_task() {
        check(
            r#"
{ "task": "elsewhere.json", "variant": "any", "count": 1 } =>
{ "task": "t", "variant": "dask", "count": 1 } => (0/variant): found "dask", expected a variant of t: day, dusk; did you mean "dusk"?
{ AT, "values": { "light": 5 }, "name": "glare" } => (0/values/light): found 5, expected a number in 0..4
{ AT, "drift": { "to": "night" } } => (0/drift/to): found "night", expected a variant of t: day, dusk
{ AT, "drift": { "to": "dusk", "values": { "lihgt": 1 }, "name": "dim" } } => did you mean "light"?"#,
        );
    }

    #[test]
    fn pre_deployment_blocks_come_first() {
        let block = |phase: &str| {
            format!(r#"{{ "type": "learning"{phase}, "regimes": [{{ "task": "t", "variant": "day", "count": 1 }}] }}"#)
        };
        let read = |phases: [&str; 3]| {
            let blocks = phases.map(block).join(", ");
            Scenario::from_json("s", &format!(r#"{{ "name": "s", "blocks": [{blocks}] }}"#))
        };
        let pre = r#", "phase": "pre_deployment""#;
        assert!(read([pre, pre, ""]).is_ok());
        assert!(read([pre, pre, pre]).is_ok());
        let error = read([pre, "", pre]).unwrap_err().to_string();
        assert!(
            error.ends_with(
                "(/blocks/2/phase): found a pre-deployment block after block 1, expected all pre-deployment \
                 blocks before the others; move the block up"
            ),
            "{error}"
        );
    }
}
