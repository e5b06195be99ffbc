//! Fuzz target for scenarios, in Driftworld's format and L2Explorer's, and for their plans.

use std::sync::{Arc, OnceLock};

use driftworld_curriculum::{FoundWorld, Plan, Sources};
use driftworld_spec::{Scenario, TaskSpec, World};

use crate::edited::Known;
use crate::{refusal, task, world};

fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let mut documents = vec![world::json(
            r#"{ "name": "small", "task_label": "name", "blocks": [
                { "type": "learning", "regimes": [{ "task": "find_objects", "variant": "red", "count": 3, "max_steps": 5 }] },
                { "type": "evaluation", "regimes": [{ "world": "w.json", "count": 2 }] }] }"#,
        )];
        documents.extend(EXAMPLES.map(world::json));
        Known::new(documents, include_str!("../../schemas/scenario.schema.json"))
    })
}

const EXAMPLES: [&str; 11] = [
    include_str!("../../examples/curricula/across_tasks.json"),
    include_str!("../../examples/curricula/action.json"),
    include_str!("../../examples/curricula/blue_red_green.json"),
    include_str!("../../examples/curricula/drift.json"),
    include_str!("../../examples/curricula/interaction.json"),
    include_str!("../../examples/curricula/map.json"),
    include_str!("../../examples/curricula/modality.json"),
    include_str!("../../examples/curricula/observation.json"),
    include_str!("../../examples/curricula/reward.json"),
    include_str!("../../examples/curricula/state.json"),
    include_str!("../../examples/curricula/transition.json"),
];

fn tasks() -> &'static [Arc<TaskSpec>] {
    static TASKS: OnceLock<Vec<Arc<TaskSpec>>> = OnceLock::new();
    TASKS.get_or_init(|| {
        let read = |text| TaskSpec::from_json("example", text).expect("the example is valid");
        task::EXAMPLES.map(read).to_vec()
    })
}

fn task_named(name: &str) -> Option<Arc<TaskSpec>> {
    tasks().iter().find(|task| task.name() == name).cloned()
}

/// A scenario that can be read can be written, and reads back the same. Its plan has the same number of experiences; the first,
/// middle and last one can be requested.
pub(crate) fn check(bytes: &[u8]) {
    let text = known().text(bytes);
    match Scenario::from_json_with("s.json", &text, task_named) {
        Ok(scenario) => {
            check_round_trip(&scenario);
            check_plan(&scenario);
        }
        Err(error) => refusal::check(&error, &text),
    }
    match Scenario::from_l2explorer("s.json", &text) {
        Ok((scenario, warnings)) => {
            refusal::messages(warnings);
            check_round_trip(&scenario);
        }
        Err(error) => refusal::check(&error, &text),
    }
}

fn check_round_trip(scenario: &Scenario) {
    let text = scenario.to_json_pretty();
    let reread =
        Scenario::from_json("again", &text).unwrap_or_else(|error| panic!("our own output is valid: {error}\n{text}"));
    assert_eq!(reread.to_json_pretty(), text);
}

fn check_plan(scenario: &Scenario) {
    let mut sources = Sources {
        task: &mut |name| task_named(name).ok_or_else(|| "there is no such task".to_owned()),
        world: &mut |_| {
            Ok(FoundWorld {
                world: World::default(),
                note: None,
            })
        },
    };
    let plan = match Plan::new(scenario, &mut sources) {
        Ok(plan) => plan,
        Err(error) => return refusal::message(&error.to_string()),
    };
    let total = plan.num_experiences();
    assert_eq!(total, scenario.num_experiences());
    for number in [0, total / 2, total.saturating_sub(1)] {
        match plan.experience_spec(number) {
            Ok(spec) => assert!((0.0..=1.0).contains(&spec.progress), "{}", spec.progress),
            Err(error) => assert_eq!(total, 0, "{error}"),
        }
        if let Err(error) = plan.world(number) {
            refusal::message(&error.to_string());
        }
    }
}
