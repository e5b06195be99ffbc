//! Distance between two concrete worlds, property by property. Distances of variants are in `variant.rs`.

use std::collections::BTreeMap;

use driftworld_spec::{Element, Object, World};

use crate::color::oklab_distance;
use crate::combined::{Distance, Part, Weights};
use crate::occupancy::{Classes, Occupancy, jaccard_distance};

/// Side of the cells in which places are compared, in metres: what the original's placement grid has.
const CELL: f64 = 2.0;

/// How far apart two worlds are.
///
/// State: cells taken (Jaccard, 2 m), numbers of objects per class, the agent's start. Action: the action model, its limits,
/// its space. Transition: how things move, how solid they are, the time step, walls and map. Reward: what objects pay and for
/// what, the step's reward, shaping and endings. Observation: colours of objects and surroundings (Oklab), models, light,
/// camera. Objects are compared with that of the same class and number in the other world; what has no counterpart counts
/// in the state. All parts weigh 1 within their element.
///
/// Each part is 0 on equal worlds, symmetric and in 0..=1, and so is the whole.
pub fn world_distance(a: &World, b: &World, weights: &Weights) -> Distance {
    let pairs = pairs(a, b);
    let mut parts = Vec::new();
    let mut add = |name: &str, element, measure, raw: f64, normalised: f64| {
        let normalised = normalised.clamp(0.0, 1.0);
        parts.push(Part {
            name: name.to_owned(),
            element,
            measure,
            raw,
            normalised,
            weight: 1.0,
        });
    };
    state(a, b, &mut add);
    action(a, b, &mut add);
    transition(a, b, &pairs, &mut add);
    reward(a, b, &pairs, &mut add);
    observation(a, b, &pairs, &mut add);
    Distance::new(parts, weights)
}

/// Mean distance of worlds in pairs: the first with the first, and so on; worlds without a partner are left out.
///
/// Draw both sets under the same seed and indices: then pairs share their chance, and what differs is what differs between
/// the variants. `None` if there is no pair.
pub fn world_sets_distance(a: &[World], b: &[World], weights: &Weights) -> Option<f64> {
    let totals: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(a, b)| world_distance(a, b, weights).total)
        .collect();
    (!totals.is_empty()).then(|| totals.iter().sum::<f64>() / totals.len() as f64)
}

type Add<'a> = dyn FnMut(&str, Element, &'static str, f64, f64) + 'a;

fn state(a: &World, b: &World, add: &mut Add) {
    let occupancy = |world| Occupancy::of_world(world, CELL, Classes::Separate);
    let places = jaccard_distance(&occupancy(a), &occupancy(b));
    add("places of objects", Element::S, "jaccard", places, places);
    let (missing, all) = count_difference(a, b);
    add(
        "numbers of objects",
        Element::S,
        "difference / all",
        missing,
        share(missing, all),
    );
    let (from, to) = (&a.agent_params, &b.agent_params);
    let metres = length(from.coordinates, to.coordinates);
    let [width, depth] = larger(a.environment_params.arena_size(), b.environment_params.arena_size());
    add(
        "agent's start",
        Element::S,
        "euclidean / diagonal",
        metres,
        share(metres, width.hypot(depth)),
    );
    let turn = (from.heading - to.heading).rem_euclid(360.0);
    let turn = turn.min(360.0 - turn);
    add("agent's heading", Element::S, "circular", turn, turn / 180.0);
}

fn action(a: &World, b: &World, add: &mut Add) {
    let (a, b) = (&a.agent_params, &b.agent_params);
    let model = differs(a.action_model != b.action_model);
    add("action model", Element::A, "same or not", model, model);
    let space = differs((&a.actions, a.interact) != (&b.actions, b.interact));
    add("action space", Element::A, "same or not", space, space);
    let (raw, part) = relative(a.max_linear_speed, b.max_linear_speed);
    add("largest speed", Element::A, "difference / larger", raw, part);
    let (raw, part) = relative(a.max_angular_speed, b.max_angular_speed);
    add("largest turn rate", Element::A, "difference / larger", raw, part);
}

fn transition(a: &World, b: &World, pairs: &[(&Object, &Object)], add: &mut Add) {
    let moves = mean(pairs, |a, b| {
        differs((a.motion_model, a.speed, &a.waypoints) != (b.motion_model, b.speed, &b.waypoints))
    });
    add("motion of objects", Element::T, "share that differs", moves, moves);
    let solid = mean(pairs, |a, b| {
        let body = |object: &Object| (object.solid, object.pushable, object.respawn.clone());
        differs(body(a) != body(b) || a.destroy_stimulus != b.destroy_stimulus)
    });
    add("bodies of objects", Element::T, "share that differs", solid, solid);
    let seconds = |world: &World| world.agent_params.time_step * f64::from(world.agent_params.frame_skip);
    let (raw, part) = relative(seconds(a), seconds(b));
    add("time step", Element::T, "difference / larger", raw, part);
    let (raw, part) = relative(a.agent_params.agent_width, b.agent_params.agent_width);
    add("agent's width", Element::T, "difference / larger", raw, part);
    let (from, to) = (&a.environment_params, &b.environment_params);
    let walls = differs(from.predefined_map != to.predefined_map || from.walls != to.walls);
    add("map and walls", Element::T, "same or not", walls, walls);
    let ([aw, ad], [bw, bd]) = (from.arena_size(), to.arena_size());
    let (raw, part) = relative(aw * ad, bw * bd);
    add("size of the arena", Element::T, "difference / larger", raw, part);
}

fn reward(a: &World, b: &World, pairs: &[(&Object, &Object)], add: &mut Add) {
    let largest = a
        .objects
        .iter()
        .chain(&b.objects)
        .map(|object| object.reward.abs())
        .fold(0.0, f64::max);
    let raw = mean(pairs, |a, b| (a.reward - b.reward).abs());
    add(
        "rewards of objects",
        Element::R,
        "difference / range",
        raw,
        share(raw, 2.0 * largest),
    );
    let paid_for = |object: &Object| {
        let stimuli = (object.reward_stimulus.clone(), object.reward_once_stimulus.clone());
        (stimuli, object.order, object.range_stimulus_distance)
    };
    let stimuli = mean(pairs, |a, b| differs(paid_for(a) != paid_for(b)));
    add("what is paid for", Element::R, "share that differs", stimuli, stimuli);
    let odds = mean(pairs, |a, b| (a.reward_probability - b.reward_probability).abs());
    add("odds of reward", Element::R, "difference", odds, odds);
    let (from, to) = (&a.rules, &b.rules);
    let (raw, part) = relative(from.step_reward, to.step_reward);
    add("step reward", Element::R, "difference / larger", raw, part);
    let ends = differs((&from.success, &from.failure) != (&to.success, &to.failure));
    let pays = differs((from.order_penalty, &from.shaping) != (to.order_penalty, &to.shaping));
    let rules = ends.max(pays);
    add("shaping and endings", Element::R, "same or not", rules, rules);
    let limit = differs(a.max_steps != b.max_steps);
    add("limit of steps", Element::R, "same or not", limit, limit);
}

fn observation(a: &World, b: &World, pairs: &[(&Object, &Object)], add: &mut Add) {
    let colors = mean(pairs, |a, b| match (a.color, b.color) {
        (Some(a), Some(b)) => oklab_distance(a, b),
        (None, None) => 0.0,
        _ => 1.0,
    });
    add("colours of objects", Element::O, "oklab", colors, colors);
    let models = mean(pairs, |a, b| differs((&a.model, a.scale) != (&b.model, b.scale)));
    add("models of objects", Element::O, "share that differs", models, models);
    let (from, to) = (&a.environment_params, &b.environment_params);
    let (raw, part) = relative(from.light_intensity, to.light_intensity);
    add("light", Element::O, "difference / larger", raw, part);
    let surroundings = [
        oklab_distance(from.bounding_wall_color, to.bounding_wall_color),
        oklab_distance(from.sky_color, to.sky_color),
        oklab_distance(from.ground_color, to.ground_color),
        oklab_distance(from.light_color, to.light_color),
    ];
    let raw = surroundings.iter().sum::<f64>() / 4.0;
    add("colours of surroundings", Element::O, "oklab", raw, raw);
    let view = |world: &World| {
        let agent = &world.agent_params;
        (
            agent.agent_height,
            agent.field_of_view,
            agent.picture_size(),
            agent.supersampling,
            world.environment_params.fog_distance,
            agent.modalities.clone(),
            agent.state_features.clone(),
        )
    };
    let camera = differs(view(a) != view(b));
    add("camera", Element::O, "same or not", camera, camera);
}

/// Objects of one class and number within it, in both worlds.
fn pairs<'a>(a: &'a World, b: &'a World) -> Vec<(&'a Object, &'a Object)> {
    let mut others = by_class(b);
    let mut pairs = Vec::new();
    for (class, mine) in by_class(a) {
        let theirs = others.remove(&class).unwrap_or_default();
        pairs.extend(mine.into_iter().zip(theirs));
    }
    pairs
}

fn by_class(world: &World) -> BTreeMap<String, Vec<&Object>> {
    let mut classes: BTreeMap<String, Vec<&Object>> = BTreeMap::new();
    for object in &world.objects {
        classes.entry(object.class.to_lowercase()).or_default().push(object);
    }
    classes
}

/// How many objects one world has more of than the other, class by class, and how many there are at most.
fn count_difference(a: &World, b: &World) -> (f64, f64) {
    let (mine, theirs) = (by_class(a), by_class(b));
    let count = |classes: &BTreeMap<String, Vec<&Object>>, class: &str| classes.get(class).map_or(0, Vec::len);
    let classes: std::collections::BTreeSet<&String> = mine.keys().chain(theirs.keys()).collect();
    classes.into_iter().fold((0.0, 0.0), |(missing, all), class| {
        let (m, t) = (count(&mine, class), count(&theirs, class));
        (missing + m.abs_diff(t) as f64, all + m.max(t) as f64)
    })
}

fn mean(pairs: &[(&Object, &Object)], measure: impl Fn(&Object, &Object) -> f64) -> f64 {
    if pairs.is_empty() {
        return 0.0;
    }
    pairs.iter().map(|(a, b)| measure(a, b)).sum::<f64>() / pairs.len() as f64
}

/// Difference of two numbers, and its share of the larger one.
fn relative(a: f64, b: f64) -> (f64, f64) {
    let raw = (a - b).abs();
    (raw, share(raw, a.abs().max(b.abs())))
}

fn share(raw: f64, whole: f64) -> f64 {
    if raw == 0.0 {
        0.0
    } else {
        raw / whole.max(f64::MIN_POSITIVE)
    }
}

fn differs(different: bool) -> f64 {
    if different { 1.0 } else { 0.0 }
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn larger(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::Color;

    fn world(color: &str, reward: f64) -> World {
        let mut object = Object::new("cube", [3.0, 4.0]);
        object.color = Color::from_name(color);
        object.reward = reward;
        World {
            objects: vec![object, Object::new("tree", [-5.0, 1.0])],
            ..World::default()
        }
    }

    #[test]
    fn equal_worlds_are_0_apart_in_every_part() {
        let distance = world_distance(&world("red", 1.0), &world("red", 1.0), &Weights::default());
        assert!(
            distance
                .parts
                .iter()
                .all(|part| part.normalised == 0.0 && part.raw == 0.0)
        );
        assert_eq!(distance.total, 0.0);
    }

    #[test]
    fn a_change_of_reward_shows_in_the_reward_only_and_one_of_colour_in_the_observation_only() {
        let base = world("red", 1.0);
        let paid = world_distance(&base, &world("red", -1.0), &Weights::default());
        let changed = |d: &Distance| Element::ALL.map(|element| d.element(element).is_some_and(|x| x > 0.0));
        assert_eq!(changed(&paid), [false, false, false, true, false]);
        let seen = world_distance(&base, &world("blue", 1.0), &Weights::default());
        assert_eq!(changed(&seen), [false, false, false, false, true]);
    }

    #[test]
    fn it_is_as_far_there_as_back_and_never_beyond_1() {
        let mut other = world("blue", 1e9);
        other.objects.push(Object::new("rock", [100.0, 100.0]));
        other.agent_params.heading = 350.0;
        other.environment_params.light_intensity = 0.0;
        other.agent_params.time_step = 9.0;
        let (a, b) = (world("red", -5.0), other);
        let (there, back) = (
            world_distance(&a, &b, &Weights::default()),
            world_distance(&b, &a, &Weights::default()),
        );
        assert_eq!(there, back);
        assert!(there.parts.iter().all(|part| (0.0..=1.0).contains(&part.normalised)));
        assert!(
            there
                .parts
                .iter()
                .any(|part| part.name == "agent's heading" && part.raw == 10.0)
        );
    }
}
