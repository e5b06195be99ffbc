//! The law of crowds, tested: what a time step looks at grows no faster than the number of bodies, wherever they stand.

use driftworld_spec::{MotionModel, Object, Pushable, Respawn, Stimulus, WorldDraft};
use proptest::prelude::*;

use super::action::Action;
use super::budget;
use super::environment::Environment;

/// What the bodies of a crowd are.
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

/// Bodies within so many metres of a place in front of the agent, in the order of the golden angle.
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

/// The most that one of some steps looked at.
fn looked(world: WorldDraft) -> u64 {
    let world = world.check().expect("the world is sound");
    let mut environment = Environment::new(world);
    let mut most = 0;
    for step in 0..4 {
        let before = environment.encounters.looked;
        environment
            .step(Action::Continuous([2.0, f64::from(step) * 10.0, 0.0]))
            .expect("the episode goes on");
        most = most.max(environment.encounters.looked - before);
    }
    most
}

/// What no time step with so many objects goes beyond, whatever they are: looks, and sixty parts of physics.
fn bound(count: usize) -> u64 {
    let each = (budget::EACH_MOVER + budget::EACH_RETURN + 4) * count as u64;
    budget::AGENTS + budget::MOVERS + budget::RETURNS + 1_000_000 + each
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_crowd_is_looked_at_more_than_in_proportion(
        first in 0usize..6,
        second in 0usize..6,
        class in prop::sample::select(vec!["cube", "barrel", "ball", "tree"]),
        count in 300usize..1500,
        spread in prop_oneof![Just(0.0), 0.0..0.5, 0.5..6.0],
        time_step in prop_oneof![Just(0.1), 0.01..2.0],
    ) {
        let world = crowd(&[KINDS[first], KINDS[second]], class, count, spread, time_step);
        let looked = looked(world);
        prop_assert!(looked <= bound(count), "{looked} for {count}");
    }
}

#[test]
fn a_crowd_of_twice_as_many_is_looked_at_twice_as_much_and_not_four_times() {
    for kind in KINDS {
        for spread in [0.0, 1.0] {
            let [some, more] = [4000, 8000].map(|count| looked(crowd(&[kind], "cube", count, spread, 0.1)));
            // Where limits bind, what is over them does not count; below them twice as many are looked at twice as
            // much.
            let fixed = budget::MOVERS + budget::RETURNS;
            assert!(
                more <= 2 * some + fixed / 2,
                "{kind:?} within {spread} m: {some}, then {more}"
            );
        }
    }
}
