//! Tests that variants of the built-in tasks that claim to change only looks do not affect motion: the same seed and actions give
//! the same path, bit for bit, in walks that touch objects.

use std::collections::BTreeSet;
use std::sync::Arc;

use driftworld::elements::{ElementsRequest, elements_of};
use driftworld::env::{Action, Agent, Environment, RandomAgent, ScriptedAgent};
use driftworld::generator::Sampler;
use driftworld::spec::{Element, TaskSpec, Variant, World};
use driftworld::tasks;

const STEPS: usize = 300;

/// Worlds per variant.
const WORLDS: u64 = 6;

/// A built-in task with modified text.
fn task(name: &str, change: impl Fn(&str) -> String) -> Arc<TaskSpec> {
    let (_, text) = tasks::BUILT_IN
        .iter()
        .find(|(own, _)| *own == name)
        .unwrap_or_else(|| panic!("{name} is built in"));
    TaskSpec::from_json(name, &change(text)).unwrap_or_else(|error| panic!("{error}"))
}

/// The task without body models, so that the bodies of objects follow their looks.
fn with_bodies_of_looks(name: &str) -> Arc<TaskSpec> {
    task(name, |text| {
        let cut = ["1", "2", "3"].map(|model| format!(r#" "body_model": "{model}","#));
        cut.iter().fold(text.to_owned(), |text, cut| text.replace(cut, ""))
    })
}

/// The variants that claim to differ from the first only in looks.
fn of_looks(task: &Arc<TaskSpec>) -> Vec<Variant> {
    let variants = task.all_variants();
    let claims_looks = |variant: &&Variant| {
        let differs = |name: &&String| variants[0].value(name) != variant.value(name);
        let mut claimed = variant.values().keys().filter(differs).peekable();
        let is_look = |element: &Element| matches!(element, Element::O | Element::Phi);
        claimed.peek().is_some() && claimed.all(|name| task.parameters()[name].affects.iter().all(is_look))
    };
    variants.iter().filter(claims_looks).cloned().collect()
}

/// The path of a walk, step by step and as bits: positions, headings, presence and rewards. Also the number of steps with events.
fn path(world: World, actions: &[Action]) -> (Vec<Vec<u64>>, usize) {
    let mut environment = Environment::new(world);
    let mut path = Vec::new();
    let mut touches = 0;
    for action in actions {
        if environment.ended() {
            break;
        }
        let step = environment.step(*action).unwrap_or_else(|error| panic!("{error}"));
        touches += usize::from(!step.events.is_empty());
        let agent = environment.agent();
        let mut bits: Vec<u64> = [agent.position[0], agent.position[1], agent.heading_deg]
            .map(|number| u64::from(number.to_bits()))
            .to_vec();
        bits.push(step.reward.to_bits());
        for item in &environment.scene().items {
            let numbers = [item.position[0], item.position[1], item.heading_deg];
            bits.extend(numbers.map(|number| u64::from(number.to_bits())));
            bits.push(u64::from(item.visible));
        }
        path.push(bits);
    }
    (path, touches)
}

/// The actions of an agent that touches one kind of object after another, in some walks with random actions in between.
fn walk(world: &World, seed: u64) -> Vec<Action> {
    let tags: BTreeSet<&str> = world
        .objects
        .iter()
        .filter_map(|object| object.tag.as_deref())
        .collect();
    // Pass objects at their sides, where bodies differ most, instead of only walking into their centres.
    let turn = 40 - (seed as i64 % 5) * 20;
    let visit =
        |tag: &&str| format!("near {tag} 2 90\nstep 2 4 {turn} 0\nstep 6 6 0 0\ntouch {tag} 60\nstep 3 -4 30 0\n");
    let visits: Vec<String> = tags.iter().map(visit).collect();
    let script = format!("{}repeat\n", visits.concat());
    let mut visitor = ScriptedAgent::parse("visitor", &script).unwrap_or_else(|error| panic!("{error}"));
    let mut random = RandomAgent::new(seed);
    let mut environment = Environment::new(world.clone());
    let mut actions = Vec::new();
    while actions.len() < STEPS && !environment.ended() {
        let is_random = seed % 3 == 2 && actions.len() % 30 < 8;
        let action = if is_random {
            random.act(&environment)
        } else {
            visitor.act(&environment)
        };
        actions.push(action);
        environment.step(action).unwrap_or_else(|error| panic!("{error}"));
    }
    actions
}

/// For each variant of looks: its name, the number of walks that touched an object, and the number of walks with a different path.
fn paths(task: &Arc<TaskSpec>) -> Vec<(String, usize, usize)> {
    let first = &task.all_variants()[0];
    let world = |variant: &Variant, index| {
        let world = Sampler::new(variant, 77).world(index);
        world.unwrap_or_else(|error| panic!("{}: {error}", variant.id()))
    };
    let walks = (0..WORLDS).map(|index| {
        let world = world(first, index);
        let actions = walk(&world, index);
        let path = path(world, &actions);
        (index, actions, path)
    });
    let walks: Vec<_> = walks.collect();
    let of_variant = |variant: &Variant| {
        let (mut touched, mut differ) = (0, 0);
        for (index, actions, own) in &walks {
            let other = path(world(variant, *index), actions);
            touched += usize::from(own.1 > 0);
            differ += usize::from(own.0 != other.0);
        }
        (variant.id(), touched, differ)
    };
    of_looks(task).iter().map(of_variant).collect()
}

/// The tasks of the paper.
pub(crate) const TASKS: &str = "find_objects get_to_goal select_object moving_object scavenger_hunt";

#[test]
fn same_actions_give_the_same_path_if_only_looks_differ() {
    for name in TASKS.split(' ') {
        let found = paths(&task(name, str::to_owned));
        assert!(found.len() >= 3, "{name}: {found:?}");
        for (variant, touched, differ) in found {
            assert_eq!(differ, 0, "{variant}: {differ} of {WORLDS} walks differ");
            assert!(
                touched * 2 > WORLDS as usize,
                "{variant}: only {touched} walks touched anything"
            );
        }
    }
}

#[test]
fn walks_and_experiment_detect_bodies_that_differ_with_looks() {
    for name in TASKS.split(' ') {
        let task = with_bodies_of_looks(name);
        let forms: Vec<_> = paths(&task).into_iter().filter(|(_, _, differ)| *differ > 0).collect();
        let shaped: Vec<String> = of_looks(&task)
            .into_iter()
            .filter(|variant| ["spheres", "cylinders", "sphere", "cubes"].contains(&variant.name()))
            .map(|variant| variant.id())
            .collect();
        let differing: Vec<String> = forms.iter().map(|(variant, ..)| variant.clone()).collect();
        assert_eq!(differing, shaped, "{name}: {forms:?}");
        for variant in of_looks(&task) {
            let request = ElementsRequest {
                worlds: crate::tier::quick_or_full(2, 4),
                ..ElementsRequest::of(variant.id())
            };
            let found = elements_of(&task, &request).unwrap_or_else(|error| panic!("{error}"));
            let is_shaped = shaped.contains(&variant.id());
            let measures_motion = found.variants[0].elements().contains(&Element::T);
            assert_eq!(measures_motion, is_shaped, "{}: {found:#?}", variant.id());
        }
    }
}
