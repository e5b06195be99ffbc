//! Tests that one of the project's agents solves every variant of every built-in task, and that every task has variants that differ
//! in one element only.

use driftworld::elements::{ElementsRequest, elements};
use driftworld::env::{Action, Agent, Environment, OnRailsAgent, ScriptedAgent, Step};
use driftworld::generator::Sampler;
use driftworld::similarity::{Weights, variant_distance};
use driftworld::spec::{Element, Variant};
use driftworld::tasks;

use crate::tier::quick_or_full;

/// Number of worlds per variant.
const WORLDS: u64 = 3;

/// Variants in which every object costs. They are solved by avoiding all objects: no episode ends in success, and the agent earns
/// only the reward for time.
const COSTLY: [&str; 2] = ["find_objects#penalty", "moving_object#stings"];

/// Runs a whole episode; returns its reward, its duration in seconds, and its last step.
fn run_episode(variant: &Variant, index: u64, agent: &mut dyn Agent) -> (f64, f64, Step) {
    let name = variant.id();
    let world = Sampler::new(variant, 11).world(index);
    let world = world.unwrap_or_else(|error| panic!("{name}, world {index}: {error}"));
    let mut environment = Environment::new(world);
    agent.begin(index);
    let mut last = Step::default();
    while !environment.ended() {
        let action = agent.act(&environment);
        last = environment
            .step(action)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    (environment.episode_return(), environment.seconds(), last)
}

fn check(task: &str) {
    let mut unsolved = Vec::new();
    for variant in tasks::variants(task).unwrap_or_else(|error| panic!("{error}")) {
        let name = variant.id();
        for index in 0..WORLDS {
            let solved = if COSTLY.contains(&name.as_str()) {
                let mut still = ScriptedAgent::parse("still", "step").expect("the script is valid");
                let (earned, seconds, last) = run_episode(&variant, index, &mut still);
                let haste = variant
                    .value("haste")
                    .and_then(driftworld::spec::Value::as_number)
                    .unwrap_or(-1.0);
                !last.success && (earned - haste * seconds).abs() < 1e-6
            } else {
                let (earned, _, last) = run_episode(&variant, index, &mut OnRailsAgent::new());
                last.success && earned > 0.0
            };
            if !solved {
                unsolved.push(format!("{name}, world {index}"));
            }
        }
    }
    assert!(unsolved.is_empty(), "not solved: {}", unsolved.join("; "));
}

#[test]
fn find_objects_is_solved_in_every_variant() {
    check("find_objects");
}

#[test]
fn get_to_goal_is_solved_in_every_variant() {
    check("get_to_goal");
}

#[test]
fn select_object_is_solved_in_every_variant() {
    check("select_object");
}

#[test]
fn moving_object_is_solved_in_every_variant() {
    check("moving_object");
}

#[test]
fn scavenger_hunt_is_solved_in_every_variant() {
    check("scavenger_hunt");
}

#[test]
fn blue_red_green_is_solved_in_every_variant() {
    check("blue_red_green");
}

#[test]
fn built_in_tasks_declare_every_element_that_their_variants_change() {
    for (task, _) in tasks::BUILT_IN.into_iter().step_by(quick_or_full(3, 1)) {
        let request = ElementsRequest {
            worlds: quick_or_full(1, 4),
            ..ElementsRequest::of(task)
        };
        let found = elements(&request).unwrap_or_else(|error| panic!("{task}: {error}"));
        let wrong: Vec<&str> = found.contradictions().collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

/// The element in which two variants differ, if it is the only one.
fn only_element(a: &Variant, b: &Variant) -> Option<Element> {
    let distance = variant_distance(a, b, &Weights::default()).unwrap_or_else(|error| panic!("{error}"));
    let differs = |element: &Element| distance.element(*element).is_some_and(|d| d > 0.0);
    let differing: Vec<Element> = Element::ALL.into_iter().filter(differs).collect();
    if let [one] = differing[..] { Some(one) } else { None }
}

#[test]
fn each_task_of_the_paper_has_variants_that_change_one_element_alone() {
    for task in crate::looks_alone::TASKS.split(' ') {
        let variants = tasks::variants(task).unwrap_or_else(|error| panic!("{error}"));
        let alone: Vec<_> = variants[1..]
            .iter()
            .map(|variant| only_element(&variants[0], variant))
            .collect();
        for element in Element::ALL {
            let of_element = variants[1..]
                .iter()
                .zip(&alone)
                .filter(|(_, alone)| **alone == Some(element));
            let names: Vec<&str> = of_element.map(|(variant, _)| variant.name()).collect();
            assert!(names.len() >= 3, "{task}: only {names:?} for {}", element.name());
        }
    }
}

/// For each task of the paper, two variants that differ only in the reward and call for different behaviour.
const OPTIMUM_CHANGES: [[&str; 3]; 6] = [
    ["find_objects", "blue", "turned"],
    ["get_to_goal", "bags", "traps"],
    ["select_object", "green", "yellow"],
    ["select_object", "red", "blue"],
    ["moving_object", "wandering", "turned"],
    ["scavenger_hunt", "plain", "grove"],
];

/// The rewards of an episode's steps, and the actions taken.
fn replay(variant: &Variant, index: u64, actions: Option<&[Action]>) -> (Vec<f64>, Vec<Action>) {
    let world = Sampler::new(variant, 11).world(index);
    let mut environment = Environment::new(world.unwrap_or_else(|error| panic!("{error}")));
    let mut expert = OnRailsAgent::new();
    let (mut rewards, mut taken) = (Vec::new(), Vec::new());
    while !environment.ended() && actions.is_none_or(|actions| taken.len() < actions.len()) {
        let action = actions.map_or_else(|| expert.act(&environment), |actions| actions[taken.len()]);
        taken.push(action);
        let step = environment.step(action).unwrap_or_else(|error| panic!("{error}"));
        rewards.push(step.reward);
    }
    (rewards, taken)
}

#[test]
fn reward_variants_change_the_optimum_and_reveal_it_within_an_episode() {
    for [task, a, b] in OPTIMUM_CHANGES {
        let variant = |name: &str| {
            let all = tasks::variants(task).unwrap_or_else(|error| panic!("{error}"));
            let own = all.into_iter().find(|variant| variant.name() == name);
            own.unwrap_or_else(|| panic!("{task} has {name}"))
        };
        let request = ElementsRequest {
            worlds: quick_or_full(3, 6),
            ..ElementsRequest::between(task, a, b)
        };
        let found = elements(&request).unwrap_or_else(|error| panic!("{error}"));
        let measured = &found.variants[0];
        assert_eq!(measured.elements(), [Element::R], "{task}: {a} and {b}");
        let optimum = measured
            .optimum
            .unwrap_or_else(|| panic!("{task}: {b} changes the reward"));
        assert!(
            optimum.turned && optimum.regret > 50.0,
            "{task}: {a} and {b}: {optimum:?}"
        );
        // In the worlds of `b`, the actions of `a`'s expert earn different rewards before half of its route is done.
        for index in 0..WORLDS {
            let (expected, actions) = replay(&variant(a), index, None);
            let (rewards, _) = replay(&variant(b), index, Some(&actions));
            let first = expected.iter().zip(&rewards).position(|(a, b)| a != b);
            let first = first.unwrap_or_else(|| panic!("{task}, world {index}: {a} and {b} pay the same"));
            assert!(
                first * 2 < expected.len(),
                "{task}, world {index}: step {first} of {}",
                expected.len()
            );
        }
    }
}
