//! Computes the distance of two random worlds by the units in `docs/reference/comparison.md`, trying every matching of their
//! objects, without using `similarity`.

use driftworld::similarity::{Weights, world_distance};
use driftworld::spec::{MotionModel, Object, Stimulus, World};
use proptest::prelude::*;

use super::by_hand::oklab;
use super::drawn_worlds::worlds;

/// Weight of rewards in the cost of a matching, small enough to only break ties.
const TIE_BREAK: f64 = 1e-9;

/// The difference of two numbers, divided by the larger one.
fn relative(a: f64, b: f64) -> f64 {
    let larger = a.abs().max(b.abs());
    if larger == 0.0 { 0.0 } else { (a - b).abs() / larger }
}

fn word<T: PartialEq>(a: &T, b: &T) -> f64 {
    f64::from(u8::from(a != b))
}

fn metres(a: [f64; 2], b: [f64; 2]) -> f64 {
    ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
}

fn turn(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(360.0);
    turn.min(360.0 - turn)
}

fn color(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (a, b) = (oklab(&a), oklab(&b));
    a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The number of words to change, add or remove to turn one set into the other.
fn words(a: &[Stimulus], b: &[Stimulus]) -> f64 {
    let lacking = |a: &[Stimulus], b: &[Stimulus]| a.iter().filter(|one| !b.contains(one)).count();
    lacking(a, b).max(lacking(b, a)) as f64
}

/// The difference of two keys: 1 if only one of them is read.
fn read(a: Option<f64>, b: Option<f64>) -> f64 {
    a.zip(b).map_or_else(|| word(&a, &b), |(a, b)| relative(a, b))
}

fn is_paid(object: &Object) -> bool {
    !object.reward_stimulus.is_empty()
}

fn reward(object: &Object) -> f64 {
    if is_paid(object) { object.reward } else { 0.0 }
}

/// The difference of two matched objects in everything except rewards, and in rewards.
fn difference(a: &Object, b: &Object) -> (f64, f64) {
    let reach = |object: &Object| {
        let is_read = [&object.reward_stimulus, &object.destroy_stimulus]
            .iter()
            .any(|list| list.contains(&Stimulus::AgentInRange));
        if is_read { object.range_stimulus_distance } else { 0.0 }
    };
    let speed = |object: &Object| {
        let moves = object.motion_model != MotionModel::Stationary;
        if moves {
            object.speed
        } else {
            Object::new("cube", [0.0; 2]).speed
        }
    };
    let odds = |object: &Object| {
        if is_paid(object) {
            object.reward_probability
        } else {
            1.0
        }
    };
    let colors = match (a.color, b.color) {
        (Some(a), Some(b)) => color(a.0, b.0),
        (None, None) => 0.0,
        _ => 1.0,
    };
    let total = metres(a.coordinates, b.coordinates) / 10.0
        + turn(a.heading, b.heading) / 180.0
        + word(&a.motion_model, &b.motion_model)
        + relative(speed(a), speed(b))
        + word(&a.solid, &b.solid)
        + words(&a.destroy_stimulus, &b.destroy_stimulus)
        + words(&a.reward_stimulus, &b.reward_stimulus)
        + relative(reach(a), reach(b))
        + colors
        + word(&a.model.0, &b.model.0)
        + relative(a.scale, b.scale);
    (total, (reward(a) - reward(b)).abs() / 100.0 + (odds(a) - odds(b)).abs())
}

/// The cheapest matching of a set of objects with a larger set: the cost by which it is selected, and its share of the distance.
fn matched(fewer: &[&Object], more: &[&Object]) -> (f64, f64) {
    let Some((first, rest)) = fewer.split_first() else {
        // Unmatched objects: presence, looks, reward.
        let left = more.iter().map(|object| 2.0 + reward(object).abs() / 100.0);
        return (0.0, left.sum());
    };
    let matchings = (0..more.len()).map(|at| {
        let mut left = more.to_vec();
        let (other, pays) = difference(first, left.remove(at));
        let (cost, counts) = matched(rest, &left);
        (cost + other + TIE_BREAK * pays.min(1.0), counts + other + pays)
    });
    matchings.fold(
        (f64::INFINITY, 0.0),
        |best, next| if next.0 < best.0 { next } else { best },
    )
}

fn by_hand(a: &World, b: &World) -> f64 {
    let mut sum = 0.0;
    for class in ["tree", "pot"] {
        let of = |world: &'_ World| {
            world
                .objects
                .iter()
                .filter(|object| object.class == class)
                .cloned()
                .collect()
        };
        let (a, b): (Vec<Object>, Vec<Object>) = (of(a), of(b));
        let (fewer, more) = if a.len() <= b.len() { (&a, &b) } else { (&b, &a) };
        sum += matched(&fewer.iter().collect::<Vec<_>>(), &more.iter().collect::<Vec<_>>()).1;
    }
    let (mine, theirs) = (&a.agent_params, &b.agent_params);
    sum += metres(mine.coordinates, theirs.coordinates) / 10.0 + turn(mine.heading, theirs.heading) / 180.0;
    sum += relative(mine.max_linear_speed, theirs.max_linear_speed);
    sum += relative(mine.max_angular_speed, theirs.max_angular_speed);
    sum += relative(f64::from(mine.frame_skip), f64::from(theirs.frame_skip));
    sum += relative(mine.agent_width, theirs.agent_width);
    let second = |world: &World| {
        let seconds = world.agent_params.time_step * f64::from(world.agent_params.frame_skip);
        world.rules.step_reward / seconds + world.rules.reward_per_second
    };
    sum += (second(a) - second(b)).abs();
    let limit = |world: &World| {
        let seconds = world.agent_params.time_step * f64::from(world.agent_params.frame_skip);
        let limits = [world.max_seconds, f64::from(world.max_steps) * seconds];
        limits.into_iter().filter(|limit| *limit > 0.0).reduce(f64::min)
    };
    sum += read(limit(a), limit(b));
    let (mine, theirs) = (&a.environment_params, &b.environment_params);
    sum += relative(mine.map_size[0], theirs.map_size[0]) + relative(mine.map_size[1], theirs.map_size[1]);
    sum += relative(mine.light_intensity, theirs.light_intensity);
    sum += read(mine.fog_distance, theirs.fog_distance);
    sum + color(mine.sky_color.0, theirs.sky_color.0)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 256), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn distance_matches_the_cheapest_matching(a in worlds(), b in worlds()) {
        let found = world_distance(&a, &b, &Weights::default());
        let expected = by_hand(&a, &b);
        // Limits are compared with a resolution of a microsecond.
        prop_assert!((found.total - expected).abs() < 1e-6, "{expected} by hand, {found:#?}");
    }
}
