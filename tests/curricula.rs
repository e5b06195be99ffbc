//! Tests the curricula in `examples/curricula/`: they are valid, change only what they claim, and can be run.

use std::path::{Path, PathBuf};
use std::process::Command;

use driftworld::similarity::{Weights, variant_distance};
use driftworld::spec::{BlockKind, Element, Regime, Scenario, Variant};
use driftworld::tasks;
use serde_json::Value;

use crate::is_turn;

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/curricula/{name}.json"))
}

fn text(name: &str) -> String {
    std::fs::read_to_string(path(name)).expect("the curricula ship with the project")
}

fn scenario(name: &str) -> Scenario {
    Scenario::from_json(name, &text(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The variants that a scenario learns, in order.
fn learned(scenario: &Scenario) -> Vec<Variant> {
    let learning = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    let regimes = learning.flat_map(|block| &block.regimes);
    let variant = |regime: &Regime| {
        let task = tasks::task(&regime.task).unwrap_or_else(|error| panic!("{error}"));
        regime.resolve(&task).unwrap_or_else(|error| panic!("{error}"))
    };
    regimes.map(variant).collect()
}

/// The elements in which two variants differ, by letter.
fn differs(a: &Variant, b: &Variant) -> String {
    let distance = variant_distance(a, b, &Weights::default()).unwrap_or_else(|error| panic!("{error}"));
    let elements = Element::ALL
        .into_iter()
        .filter(|element| distance.element(*element).is_some_and(|d| d > 0.0));
    elements.map(Element::letter).collect::<Vec<_>>().join(" ")
}

fn check(name: &str, element: Element) {
    let variants = learned(&scenario(name));
    assert!(variants.len() >= 4, "{name}: {} variants", variants.len());
    for (index, a) in variants.iter().enumerate() {
        for b in &variants[index + 1..] {
            assert_eq!(differs(a, b), element.letter(), "{name}: {} and {}", a.id(), b.id());
        }
    }
}

#[test]
fn each_assessment_curriculum_changes_only_its_element() {
    for (name, element) in [
        ("reward", Element::R),
        ("state", Element::S),
        ("transition", Element::T),
        ("observation", Element::O),
        ("action", Element::A),
        ("modality", Element::O),
    ] {
        check(name, element);
    }
}

#[test]
fn paper_example_changes_what_it_says() {
    let variants = learned(&scenario("blue_red_green"));
    let names: Vec<&str> = variants.iter().map(Variant::name).collect();
    assert_eq!(names, ["a", "b", "c", "d"]);
    let steps: Vec<String> = variants.windows(2).map(|pair| differs(&pair[0], &pair[1])).collect();
    assert_eq!(
        steps,
        ["S R", "S R", "S R O"],
        "only the last block changes how the surroundings look"
    );
}

#[test]
fn map_curriculum_changes_states_transitions_and_observations() {
    let variants = learned(&scenario("map"));
    assert!(variants.len() >= 6, "the open field, four maps and rooms");
    for (index, a) in variants.iter().enumerate() {
        for b in &variants[index + 1..] {
            assert_eq!(differs(a, b), "S T O", "{} and {}", a.id(), b.id());
        }
    }
}

#[test]
fn interaction_curriculum_changes_actions_and_their_effects() {
    let variants = learned(&scenario("interaction"));
    let steps: Vec<String> = variants.windows(2).map(|pair| differs(&pair[0], &pair[1])).collect();
    assert_eq!(steps, ["A", "A T", "T"]);
}

#[test]
fn drift_curriculum_drifts_in_every_learning_block() {
    let scenario = scenario("drift");
    let learning: Vec<_> = (scenario.blocks.iter())
        .filter(|block| block.kind == BlockKind::Learning)
        .flat_map(|block| &block.regimes)
        .collect();
    assert!(learning.len() >= 3 && learning.iter().all(|regime| regime.drift.is_some()));
}

#[test]
fn curriculum_across_tasks_learns_each_of_them() {
    let variants = learned(&scenario("across_tasks"));
    let mut names: Vec<&str> = variants.iter().map(|variant| variant.task().name()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(
        names,
        ["find_objects", "get_to_goal", "moving_object", "scavenger_hunt"]
    );
}

#[test]
fn training_and_evaluation_share_no_world() {
    for file in std::fs::read_dir(path("reward").with_file_name("")).expect("the folder exists") {
        let file = file.expect("the folder can be listed").path();
        let name = file
            .file_stem()
            .and_then(|stem| stem.to_str())
            .expect("file names are UTF-8");
        let scenario = scenario(name);
        let seeds = |kind| {
            let blocks = scenario.blocks.iter().filter(move |block| block.kind == kind);
            blocks
                .flat_map(|block| &block.regimes)
                .map(|regime| regime.seed)
                .collect::<Vec<_>>()
        };
        let evaluated = seeds(BlockKind::Evaluation);
        assert!(
            seeds(BlockKind::Learning).iter().all(|seed| !evaluated.contains(seed)),
            "{name}"
        );
    }
}

/// Runs a curriculum shortened to two experiences per regime, in all of which the agent must succeed.
fn run_briefly(name: &str, agent: &str) {
    let folder = tempfile::tempdir().expect("the machine has a folder for temporary files");
    let mut document: Value = serde_json::from_str(&text(name)).expect("the curriculum is JSON");
    for block in document["blocks"].as_array_mut().expect("it has blocks") {
        for regime in block["regimes"].as_array_mut().expect("it has regimes") {
            regime["count"] = 2.into();
        }
    }
    let short = folder.path().join("short.json");
    std::fs::write(&short, document.to_string()).expect("the scenario can be written");
    let log = folder.path().join("log");
    let mut command = Command::new(env!("CARGO_BIN_EXE_driftworld"));
    let command = command
        .arg("run")
        .arg(&short)
        .args(["--agent", agent, "--json", "--output"])
        .arg(&log);
    let output = command.output().expect("the command is built before its tests");
    assert!(
        output.status.success(),
        "{name}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let summary: Value = serde_json::from_slice(&output.stdout).expect("the summary is JSON");
    for regime in summary["regimes"].as_array().expect("it lists the regimes") {
        assert_eq!(regime["experiences"], 2, "{name}: {regime}");
        assert_eq!(regime["success_rate"], 1.0, "{name}: {regime}");
    }
}

#[test]
fn planner_runs_and_solves_every_curriculum() {
    let names = "reward state transition observation action blue_red_green map modality interaction drift across_tasks";
    for (_, name) in names.split(' ').enumerate().filter(|(number, _)| is_turn(*number, 3)) {
        run_briefly(name, "onrails");
    }
}

#[test]
fn script_runs_a_curriculum() {
    let folder = tempfile::tempdir().expect("the machine has a folder for temporary files");
    let script = folder.path().join("tour.txt");
    std::fs::write(&script, "touch goal # wherever it lies\ntour\n").expect("the script can be written");
    run_briefly("action", &format!("scripted:{}", script.display()));
}
