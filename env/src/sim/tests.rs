//! Tests that the work of a time step grows at most linearly with the number of bodies, even in crowds.

use driftworld_spec::{MotionModel, Object, Pushable, Respawn, Stimulus, WorldDraft};
use proptest::prelude::*;

use super::action::Action;
use super::budget;
use super::environment::Environment;

/// The kind of bodies in a crowd.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Pushable,
    Predator,
    Ghost,
    Wanderer,
    Returning,
    Solid,
}

const KINDS: [Kind; 6] = [
    Kind::Pushable,
    Kind::Predator,
    Kind::Ghost,
    Kind::Wanderer,
    Kind::Returning,
    Kind::Solid,
];

fn body(kind: Kind, class: &str, at: [f64; 2]) -> Object {
    let mut object = Object::new(class, at);
    object.reward = 1.0;
    object.reward_stimulus = vec![Stimulus::AgentCollide];
    match kind {
        Kind::Pushable => {
            object.pushable = Some(Pushable {
                mass: 5.0,
                friction: 0.3,
            });
        }
        Kind::Predator => (object.motion_model, object.speed) = (MotionModel::Predator, 4.0),
        Kind::Ghost => {
            (object.motion_model, object.speed) = (MotionModel::Predator, 4.0);
            object.solid = false;
        }
        Kind::Wanderer => (object.motion_model, object.speed) = (MotionModel::RandomWaypoint, 4.0),
        Kind::Returning => {
            object.range_stimulus_distance = 100.0;
            object.reward_stimulus = vec![Stimulus::AgentInRange];
            object.destroy_stimulus = vec![Stimulus::AgentInRange];
            object.respawn = Some(Respawn {
                delay: 0.0,
                radius: 1.0,
            });
        }
        Kind::Solid => {}
    }
    object
}

/// Bodies within `spread` metres of a point in front of the agent, arranged by the golden angle.
fn crowd(kinds: &[Kind], class: &str, count: usize, spread: f64, time_step: f64) -> WorldDraft {
    let at = |k: usize| {
        let out = spread * (k as f64 / count as f64).sqrt();
        let angle = 2.399_963 * k as f64;
        [out * libm::sin(angle), 1.2 + out * libm::cos(angle)]
    };
    let mut world = WorldDraft {
        objects: (0..count).map(|k| body(kinds[k % kinds.len()], class, at(k))).collect(),
        seed: Some(3),
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [60.0, 60.0];
    world.agent_params.time_step = time_step;
    world
}

/// The largest number of queries in any of several steps.
fn max_queries_per_step(world: WorldDraft) -> u64 {
    let world = world.check().expect("the world is valid");
    let mut environment = Environment::new(world);
    let mut max = 0;
    for step in 0..4 {
        let before = environment.encounters.num_queries;
        environment
            .step(Action::Continuous([2.0, f64::from(step) * 10.0, 0.0]))
            .expect("the episode continues");
        max = max.max(environment.encounters.num_queries - before);
    }
    max
}

/// Upper bound on the queries of a time step with `count` objects of any kind. The constant term covers pushed bodies, in up to
/// sixty physics steps.
fn bound(count: usize) -> u64 {
    let each = (budget::PER_MOVER + budget::PER_RETURN + 4) * count as u64;
    budget::AGENTS + budget::MOVERS + budget::RETURNS + 1_000_000 + each
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(8, 24)))]

    #[test]
    fn work_of_any_crowd_is_at_most_linear(
        first in 0usize..6,
        second in 0usize..6,
        class in prop::sample::select(vec!["cube", "barrel", "ball", "tree"]),
        count in 300usize..1500,
        spread in prop_oneof![Just(0.0), 0.0..0.5, 0.5..6.0],
        time_step in prop_oneof![Just(0.1), 0.01..2.0],
    ) {
        let world = crowd(&[KINDS[first], KINDS[second]], class, count, spread, time_step);
        let num_queries = max_queries_per_step(world);
        prop_assert!(num_queries <= bound(count), "{num_queries} for {count}");
    }
}

#[test]
fn doubling_a_crowd_at_most_doubles_the_work() {
    for kind in KINDS {
        for spread in [0.0, 1.0] {
            let [some, more] =
                [4000, 8000].map(|count| max_queries_per_step(crowd(&[kind], "cube", count, spread, 0.1)));
            // Below the limits, twice as many bodies cause twice the work; beyond them, additional work is cut off.
            let fixed = budget::MOVERS + budget::RETURNS;
            assert!(
                more <= 2 * some + fixed / 2,
                "{kind:?} within {spread} m: {some}, then {more}"
            );
        }
    }
}
