//! Generates random worlds: small, but with everything that distances by worlds compare.

use driftworld::spec::{Color, MotionModel, Object, Stimulus, World, WorldDraft};
use proptest::prelude::*;

/// Maximum number of objects in a random world.
pub(crate) const MAX_OBJECTS: usize = 6;

/// A class that no random world contains.
pub(crate) const OTHER_CLASS: &str = "lamp";

fn stimuli() -> impl Strategy<Value = Vec<Stimulus>> {
    let all = vec![Stimulus::AgentCollide, Stimulus::AgentInteract, Stimulus::AgentInRange];
    prop::sample::subsequence(all, 0..=3)
}

fn position() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(-20.0..20.0_f64)
}

/// Random objects of two classes.
pub(crate) fn objects() -> impl Strategy<Value = Object> {
    let looks = (
        prop::sample::select(vec!["tree", "pot"]),
        prop::option::of(prop::array::uniform3(0.0..=1.0_f64)),
        0.25..4.0_f64,
        prop::sample::select(vec!["1", "2"]),
    );
    let pays = (-100.0..100.0_f64, 0.0..=1.0_f64, stimuli(), stimuli(), 0.5..9.0_f64);
    let moves = (any::<bool>(), 0.5..5.0_f64, any::<bool>());
    (position(), 0.0..360.0_f64, looks, pays, moves).prop_map(|(position, heading, looks, pays, moves)| {
        let (class, color, scale, model) = looks;
        let mut object = Object::new(class, position);
        (object.heading, object.color, object.scale) = (heading, color.map(Color), scale);
        model.clone_into(&mut object.model.0);
        (object.reward, object.reward_probability) = (pays.0, pays.1);
        (object.reward_stimulus, object.destroy_stimulus) = (pays.2, pays.3);
        object.range_stimulus_distance = pays.4;
        if moves.0 {
            object.motion_model = MotionModel::RandomWaypoint;
        }
        (object.speed, object.solid) = (moves.1, moves.2);
        object
    })
}

/// Random worlds.
pub(crate) fn worlds() -> impl Strategy<Value = World> {
    let agent = (
        position(),
        0.0..360.0_f64,
        1.0..20.0_f64,
        10.0..180.0_f64,
        1..5_u32,
        0.2..3.0_f64,
    );
    let rules = (
        -2.0..2.0_f64,
        -2.0..2.0_f64,
        0..500_u32,
        prop_oneof![Just(0.0), 1.0..90.0_f64],
    );
    let size = prop::array::uniform2(60.0..100.0_f64);
    let around = (
        0.0..4.0_f64,
        prop::option::of(2.0..90.0_f64),
        size,
        prop::array::uniform3(0.0..=1.0_f64),
    );
    (prop::collection::vec(objects(), 0..=MAX_OBJECTS), agent, rules, around).prop_map(
        |(objects, agent, rules, around)| {
            let mut world = WorldDraft::with_objects(objects);
            let body = &mut world.agent_params;
            (body.coordinates, body.heading, body.max_linear_speed) = (agent.0, agent.1, agent.2);
            (body.max_angular_speed, body.frame_skip, body.agent_width) = (agent.3, agent.4, agent.5);
            (world.rules.step_reward, world.rules.reward_per_second) = (rules.0, rules.1);
            (world.max_steps, world.max_seconds) = (rules.2, rules.3);
            let air = &mut world.environment_params;
            (air.light_intensity, air.fog_distance, air.map_size) = (around.0, around.1, around.2);
            air.sky_color = Color(around.3);
            world.check().unwrap_or_else(|error| panic!("{error}"))
        },
    )
}
