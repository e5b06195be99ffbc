//! Heaps and crowds of objects can be stepped, do not depend on the world's history, and give a warning.

use driftworld_env::{Action, Environment, Warning};
use driftworld_spec::{MotionModel, Object, Pushable, Respawn, Stimulus, World, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::start;

/// Makes one body of a crowd.
type Make = fn([f64; 2]) -> Object;

const MAKES: [Make; 5] = [pushable, predator, ghost, wanderer, returning];

fn pushable(at: [f64; 2]) -> Object {
    let mut object = Object::new("cube", at);
    object.pushable = Some(Pushable {
        mass: 5.0,
        friction: 0.3,
    });
    object
}

fn predator(at: [f64; 2]) -> Object {
    let mut object = Object::new("cube", at);
    (object.motion_model, object.speed) = (MotionModel::Predator, 4.0);
    object.reward = 1.0;
    object.reward_stimulus = vec![Stimulus::AgentCollide];
    object
}

fn ghost(at: [f64; 2]) -> Object {
    let mut object = predator(at);
    object.solid = false;
    object
}

fn wanderer(at: [f64; 2]) -> Object {
    let mut object = Object::new("barrel", at);
    (object.motion_model, object.speed) = (MotionModel::RandomWaypoint, 4.0);
    object
}

/// An object that respawns near the same point as all others.
fn returning(at: [f64; 2]) -> Object {
    let mut object = Object::new("barrel", at);
    object.range_stimulus_distance = 50.0;
    object.destroy_stimulus = vec![Stimulus::AgentInRange];
    object.respawn = Some(Respawn {
        delay: 0.0,
        radius: 1.0,
    });
    object
}

/// Bodies within `spread` metres of a point in front of the agent.
fn crowd(makes: &[Make], count: usize, spread: f64) -> WorldDraft {
    let at = |k: usize| {
        let share = |step: f64| spread * ((k as f64 * step).fract() - 0.5);
        [share(0.618_034), 1.2 + share(0.754_878)]
    };
    let mut world = WorldDraft {
        objects: (0..count).map(|k| makes[k % makes.len()](at(k))).collect(),
        seed: Some(7),
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [60.0, 60.0];
    world
}

fn go(environment: &mut Environment, steps: u32) -> f64 {
    let mut paid = 0.0;
    for step in 0..steps {
        let action = Action::Continuous([2.0, f64::from(step % 5) * 20.0 - 40.0, 0.0]);
        paid += environment.step(action).expect("the episode continues").reward;
    }
    paid
}

/// The visible state of a world.
fn places(environment: &Environment) -> Vec<([f32; 2], f32, bool)> {
    let items = environment.scene().items.iter();
    items
        .map(|item| (item.position, item.heading_deg, item.visible))
        .collect()
}

/// Regression test: a heap of 2,500 cubes did not finish its first step in a hundred seconds, and took gigabytes.
#[test]
fn heaps_of_ten_thousand_can_be_stepped() {
    for make in MAKES {
        for spread in [0.0, 2.0] {
            go(&mut start(crowd(&[make], 10_000, spread)), 3);
        }
    }
}

#[test]
fn heap_gives_way_or_stops_the_agent() {
    let mut environment = start(crowd(&[pushable], 1000, 0.0));
    for _ in 0..30 {
        environment
            .step(Action::Continuous([2.0, 0.0, 0.0]))
            .expect("the episode continues");
    }
    let [_, y] = environment.agent().position;
    assert!(y < 1.0, "the agent reached y = {y}");
}

#[test]
fn heap_gives_a_warning_with_place_and_size() {
    let heaps = |count: usize| {
        let is_heap = |warning: &Warning| matches!(warning, Warning::Heap { .. });
        let warnings = start(crowd(&[pushable], count, 0.0)).warnings();
        let heaps: Vec<String> = warnings
            .iter()
            .filter(|warning| is_heap(warning))
            .map(ToString::to_string)
            .collect();
        heaps
    };
    assert!(heaps(200).is_empty());
    let warnings = heaps(1000);
    assert_eq!(warnings.len(), 1, "only the first body is reported");
    assert!(
        warnings[0].starts_with(
            "/objects/0/coordinates: found 999 bodies that overlap a pushable object, expected at most 256"
        ),
        "{warnings:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(5, 12)))]

    /// Limits depend only on the objects' positions: a world that was saved in the middle of a crowd, and whose trees were
    /// built in a different order, resumes bit for bit, and so does one restored from a snapshot.
    #[test]
    fn crowd_resumes_from_its_state_and_from_a_snapshot(
        first in 0usize..5,
        second in 0usize..5,
        count in 300usize..1200,
        spread in prop_oneof![Just(0.0), 0.1..4.0],
        before in 1u32..5,
    ) {
        let mut here = start(crowd(&[MAKES[first], MAKES[second]], count, spread));
        go(&mut here, before);
        let written = here.state().to_json();
        let moment = here.snapshot();
        let paid = go(&mut here, 3);
        let there = World::from_json("state", &written).expect("a state is a valid world");
        let mut there = start(there.into_draft());
        prop_assert_eq!(go(&mut there, 3), paid);
        prop_assert!(places(&there) == places(&here), "resumed from a state");
        here.restore(&moment);
        prop_assert_eq!(go(&mut here, 3), paid);
        prop_assert!(places(&there) == places(&here), "restored from a snapshot");
    }
}
