//! The example worlds: each is a sound task, its pages show it, and the agent on rails comes to the end that it asks for.

use std::path::Path;

use driftworld::env::{Agent, Environment, OnRailsAgent};
use driftworld::generator::Sampler;
use driftworld::spec::TaskSpec;

/// Worlds of each variant that are run.
const WORLDS: u64 = 4;

/// The folder of the project.
const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn check(name: &str) {
    let path = format!("{ROOT}/examples/worlds/{name}.json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let task = TaskSpec::from_json(name, &text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(task.name(), name);
    let page = std::fs::read_to_string(format!("{ROOT}/docs/worlds.md")).expect("the page can be read");
    assert!(
        page.contains(&format!("examples/worlds/{name}.json")),
        "{name} is on the page"
    );
    assert!(
        Path::new(&format!("{ROOT}/docs/images/world-{name}.png")).exists(),
        "{name} has a picture"
    );
    let mut unsolved = Vec::new();
    for variant in task.variant_names() {
        let variant = task.variant(variant).unwrap_or_else(|error| panic!("{error}"));
        let sampler = Sampler::new(&variant, 77);
        for index in 0..WORLDS {
            let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
            let (mut environment, mut agent) = (Environment::new(world), OnRailsAgent::new());
            agent.begin(index);
            let mut success = false;
            while !environment.ended() {
                let action = agent.act(&environment);
                success = environment
                    .step(action)
                    .unwrap_or_else(|error| panic!("{error}"))
                    .success;
            }
            if !success {
                unsolved.push(format!("{}, world {index}", variant.id()));
            }
        }
    }
    assert!(unsolved.is_empty(), "not solved: {}", unsolved.join("; "));
}

#[test]
fn mazes_are_solved() {
    check("maze");
}

#[test]
fn rooms_are_solved() {
    check("four_rooms");
}

#[test]
fn maps_of_letters_are_solved() {
    check("t_maze");
}

#[test]
fn cues_that_are_drawn_are_minded() {
    check("cue_t_maze");
}

#[test]
fn keys_of_rooms_are_fetched_in_their_order() {
    check("locked_rooms");
}

#[test]
fn keys_are_fetched_for_doors() {
    check("key_corridor");
}

#[test]
fn switches_open_gates() {
    check("switches");
}

#[test]
fn zones_that_end_the_episode_are_avoided() {
    check("lava_crossing");
}

#[test]
fn energy_lasts_as_long_as_there_is_fruit() {
    check("foraging");
}

#[test]
fn what_runs_away_is_caught() {
    check("hunt");
}

#[test]
fn things_are_carried_to_their_place() {
    check("put_next");
}
