//! Tests the task families: each is a valid task with a page and a film, and the planner succeeds in its worlds.

use std::path::Path;
use std::sync::Arc;

use driftworld::env::{Agent, Environment, OnRailsAgent};
use driftworld::generator::Sampler;
use driftworld::spec::{TaskSpec, World};
use driftworld::tasks;

/// Number of worlds per variant.
const WORLDS: u64 = 4;

/// The folder of the project.
const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn check(group: &str) {
    let (_, families) = tasks::groups()
        .find(|(known, _)| *known == group)
        .unwrap_or_else(|| panic!("there is no group {group}"));
    for (name, text) in families {
        let task = TaskSpec::from_json(name, text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(task.name(), *name);
        for file in [format!("families/{name}.md"), format!("images/families/{name}.gif")] {
            let path = format!("{ROOT}/docs/{file}");
            assert!(Path::new(&path).exists(), "{path}: scripts/families.py makes it");
        }
        assert_eq!(unsolved(&task), Vec::<String>::new());
    }
}

fn is_solved(world: World) -> bool {
    let (mut environment, mut agent) = (Environment::new(world), OnRailsAgent::new());
    let mut success = false;
    while !environment.ended() {
        let action = agent.act(&environment);
        success = environment
            .step(action)
            .unwrap_or_else(|error| panic!("{error}"))
            .success;
    }
    success
}

/// The worlds in which the planner does not succeed.
fn unsolved(task: &Arc<TaskSpec>) -> Vec<String> {
    let mut unsolved = Vec::new();
    for variant in task.variant_names() {
        let variant = task.variant(variant).unwrap_or_else(|error| panic!("{error}"));
        let sampler = Sampler::new(&variant, 77);
        for index in 0..WORLDS {
            let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
            if !is_solved(world) {
                unsolved.push(format!("{}, world {index}", variant.id()));
            }
        }
    }
    unsolved
}

/// Worlds in which pushed crates jam in the doorway and against each other.
#[test]
fn crates_that_jam_are_walked_around() {
    let variant = tasks::variant("push_box#slow").unwrap_or_else(|error| panic!("{error}"));
    let sampler = Sampler::new(&variant, 77);
    for index in [138, 152, 265, 314, 337, 357, 512, 528, 567, 587] {
        let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
        assert!(is_solved(world), "world {index}");
    }
}

#[test]
fn mazes_are_solved() {
    check("navigation");
}

#[test]
fn doors_are_opened_with_keys_and_switches() {
    check("doors and keys");
}

#[test]
fn things_are_found_and_carried() {
    check("things");
}

#[test]
fn hazards_are_avoided() {
    check("hazards");
}

#[test]
fn random_cues_are_followed() {
    check("memory");
}

#[test]
fn rewarding_objects_are_chosen() {
    check("choice");
}

#[test]
fn conflicting_variants_are_solved() {
    check("conflicts");
}

#[test]
fn levels_are_passed() {
    check("levels");
}

/// The worlds shown in the guide.
const IN_THE_GUIDE: &str = "maze four_rooms t_maze cue_t_maze locked_rooms key_corridor switches lava_crossing foraging \
                            hunt put_next";

#[test]
fn guide_shows_its_worlds() {
    let page = std::fs::read_to_string(format!("{ROOT}/docs/worlds.md")).expect("the page can be read");
    for name in IN_THE_GUIDE.split(' ') {
        assert!(
            page.contains(&format!("examples/worlds/{name}.json")),
            "{name} is on the page"
        );
        let picture = format!("{ROOT}/docs/images/world-{name}.png");
        assert!(Path::new(&picture).exists(), "{name} has a picture");
    }
}

/// A document can only be loaded by name if it is listed in `FAMILIES`.
#[test]
fn every_file_of_the_folder_is_a_family() {
    let mut named: Vec<String> = tasks::FAMILIES
        .iter()
        .flat_map(|(_, families)| families.iter().map(|(name, _)| format!("{name}.json")))
        .collect();
    let files = std::fs::read_dir(format!("{ROOT}/examples/worlds")).expect("the folder can be read");
    let mut found: Vec<String> = files
        .map(|file| {
            file.expect("the folder can be read")
                .file_name()
                .into_string()
                .expect("names are text")
        })
        .collect();
    named.sort();
    found.sort();
    assert_eq!(named, found);
}
