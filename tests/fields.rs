//! Checks the table of fields for each place of a world: a parameter can set it, its value appears in the sampled world, and
//! worlds that differ only there differ in exactly the documented comparisons.

use std::collections::BTreeSet;
use std::sync::Arc;

use driftworld::generator::{Sampler, drift};
use driftworld::similarity::{Weights, variant_distance, world_distance};
use driftworld::spec::{Compared, Comparison, Element, FieldPlace, ParameterType, TaskSpec, World};
use serde_json::{Value as Json, json};

use crate::is_turn;

/// A world with a value at every place, as in the documents for the schemas.
fn full() -> Json {
    let read = |name: &str| -> Json {
        let path = format!("{}/tests/documents/good/task/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        serde_json::from_str::<Json>(&text).expect("it is JSON")["world"].take()
    };
    let mut world = read("world_with_every_key");
    world["environment_params"]["walls"] =
        json!([{ "polygon": [[10, 10], [12, 10], [11, 14]], "height": 2, "color": "grey" }]);
    // Away from everything that the tests move, and different from the defaults.
    world["agent_params"]["coordinates"] = json!([-20, 20]);
    world["agent_params"]["interact"] = json!(true);
    // The effective limit is the step limit, whose duration depends on the step length.
    world["max_steps"] = json!(100);
    world["agent_params"]["modalities"] = json!(["rgb"]);
    world["objects"] = read("fixtures_with_every_key")["objects"].take();
    world["objects"].as_array_mut().expect("it is a list").truncate(1);
    world
}

/// The same world with the kind of zone or layout that has this place.
fn full_with(place: &FieldPlace) -> Json {
    let mut world = full();
    if place.pointer.starts_with("/environment_params/zones/*/polygon") {
        let zone = &mut world["environment_params"]["zones"][0];
        zone.as_object_mut().expect("it is a zone").remove("disc");
        zone["polygon"] = json!([[3, -9], [7, -9], [7, -5], [3, -5]]);
    }
    let Some(inside) = place.pointer.strip_prefix("/environment_params/layout") else {
        return world;
    };
    let words: Vec<&str> = inside.split('/').skip(1).collect();
    world["environment_params"]["predefined_map"] = json!(0);
    world["agent_params"]["coordinates"] = json!([0.3, 0.3]);
    world["environment_params"]["zones"] = json!([]);
    let wall = |form: Json| json!({ "walls": [form] });
    world["environment_params"]["layout"] = match words.as_slice() {
        ["rooms", ..] => json!({ "rooms": {
            "grid": [1, 3], "room": [7.0, 6.0], "doorway": 1.0, "wall": 0.25, "height": 3.0, "loops": 0.25, "doors": "none", "seed": 4 } }),
        ["text" | "cell" | "height" | "legend", ..] => json!({
            "text": ["#####", "#D  #", "#   #", "#####"], "cell": 1.0, "height": 2.0, "legend": { "D": "wall" } }),
        ["predefined" | "size", ..] => json!({ "predefined": 1, "size": [150.0, 140.0] }),
        ["walls", "*", "circle", ..] => {
            wall(json!({ "circle": { "center": [20.0, 9.0], "radius": 2.0 }, "height": 3.0 }))
        }
        ["walls", "*", "polygon", ..] => {
            wall(json!({ "polygon": [[20.0, 9.0], [22.0, 9.0], [21.0, 13.0]], "color": "grey" }))
        }
        ["walls", ..] => wall(json!({
            "from": [20.0, 9.0], "to": [22.0, 9.0], "thickness": 0.25, "height": 3.0, "color": "grey" })),
        _ => json!({ "maze": {
            "cells": [4, 4], "cell": 2.0, "wall": 0.25, "height": 3.0, "braid": 0.25, "seed": 4 }, "standing": 0.75 }),
    };
    world
}

/// A value different from the one at a place.
fn other(place: &FieldPlace, now: &Json) -> Json {
    let words: Vec<&str> = place.pointer.split('/').collect();
    let key = words
        .iter()
        .rfind(|word| **word != "*")
        .expect("a place is at or below a key");
    match place.kind.expect("it can be a parameter") {
        ParameterType::Number if *key == "most" => json!(60),
        ParameterType::Number if ["map_size", "size", "field_of_view"].contains(key) => json!(62.5),
        ParameterType::Point if ["map_size", "size"].contains(key) => json!([62.5, 61.5]),
        ParameterType::Number if *key == "room" => json!(6.5),
        ParameterType::Point if *key == "room" => json!([6.5, 7.5]),
        ParameterType::Number | ParameterType::Heading if *now == 0.5 => json!(0.75),
        ParameterType::Number | ParameterType::Heading => json!(0.5),
        ParameterType::Integer if *key == "predefined" => json!(2),
        ParameterType::Integer => json!(if *now == 3 { 2 } else { 3 }),
        ParameterType::Boolean => json!(!now.as_bool().expect("it is true or false")),
        ParameterType::Color => json!([0.125, 0.25, 0.5]),
        ParameterType::Point => json!([11.5, 12.5]),
        ParameterType::Vector if ["cells", "grid"].contains(key) => json!([5, 3]),
        ParameterType::Vector => json!([0.5, 0.25, 2.0]),
        ParameterType::String => json!(match *key {
            "game_mode" => "collect_images",
            "action_model" => "onrails",
            "modalities" => "class",
            "state_features" => "steps_left",
            "actions" => "normalized",
            "motion_model" => "prey",
            "doors" => "closed",
            "model" => "3",
            key if key.ends_with("stimulus") || ["on", "opens_on", "closes_on"].contains(&key) => "AgentInteract",
            "action" => "close",
            "ends" => "success",
            "range_trigger" | "contact_trigger" => "edge",
            "style" => "plain",
            "surface" if *now == json!("stripes") => "tile",
            "surface" => "stripes",
            "text" => "EXIT",
            _ => "word",
        }),
        ParameterType::Distribution => unreachable!("no place of a world holds a distribution"),
        ParameterType::Layout => json!({ "maze": { "cells": [3, 5], "seed": 9 } }),
        ParameterType::Json => other_whole(&place.pointer, now),
    }
}

/// A different value for a place that accepts parameters only as whole JSON values.
fn other_whole(pointer: &str, now: &Json) -> Json {
    let triangle = json!([[30.0, 30.0], [32.0, 30.0], [31.0, 33.0]]);
    match pointer {
        "/environment_params/map_regions" => json!([triangle]),
        "/environment_params/map_regions/*"
        | "/environment_params/walls/*/polygon"
        | "/environment_params/zones/*/polygon"
        | "/environment_params/layout/walls/*/polygon" => triangle,
        "/environment_params/walls" => {
            json!([{ "polygon": triangle }, { "polygon": [[-30.0, 3.0], [-32.0, 3.0], [-31.0, 6.0]] }])
        }
        "/environment_params/walls/*" => json!({ "polygon": triangle, "height": 3.0 }),
        "/environment_params/zones" | "/environment_params/zones/*" => {
            let zone = json!({ "disc": { "center": [-8.0, -9.0], "radius": 1.0 }, "speed_factor": 0.25, "color": "navy",
                "reward_per_second": 3.0 });
            if pointer.ends_with('*') { zone } else { json!([zone]) }
        }
        "/environment_params/zones/*/disc" => json!({ "center": [9.0, -9.0], "radius": 1.0 }),
        "/agent_params/energy" => json!({ "start": 7.0, "per_second": -2.0 }),
        "/agent_params/modalities" => json!(["rgb", "instance"]),
        "/agent_params/instruction" => json!([0.5, 0.25]),
        "/agent_params/state_features" => json!(["heading", "counts"]),
        "/environment_params/layout/maze" => json!({ "cells": [3, 5], "seed": 9 }),
        "/environment_params/layout/rooms" => json!({ "grid": [3, 1], "seed": 9 }),
        "/environment_params/layout/text" => json!(["#####", "#   #", "#####"]),
        "/environment_params/layout/legend" => json!({ "x": "floor" }),
        "/environment_params/layout/walls" => json!([{ "circle": { "center": [30.0, 0.0], "radius": 1.0 } }]),
        "/environment_params/layout/walls/*" => json!({ "from": [30.0, 0.0], "to": [33.0, 0.0] }),
        "/environment_params/layout/walls/*/circle" => json!({ "center": [30.0, 0.0], "radius": 1.0 }),
        "/environment_params/looks" => json!({ "style": "natural", "shadows": false }),
        "/environment_params/looks/ground" | "/environment_params/looks/walls" => json!({ "surface": "tile" }),
        "/image_params" => json!({ "zoom": 5.0 }),
        "/rules" => json!({ "step_reward": -0.25, "success": ["all_collected"] }),
        "/rules/shaping" => json!({ "scale": 2.0 }),
        "/rules/success" | "/rules/failure" => json!([{ "return_at_least": 77.0 }]),
        "/rules/success/*" | "/rules/failure/*" => json!({ "return_at_most": -77.0 }),
        "/rules/success/*/delivered" | "/rules/failure/*/delivered" => {
            json!({ "tag": "coin", "to": "coin", "within": 4.0 })
        }
        "/objects/*/door" => json!({ "opens_on": ["AgentCollide"], "key": "word", "period": 3.0 }),
        "/objects/*/door/opens_on"
        | "/objects/*/door/closes_on"
        | "/objects/*/switch/on"
        | "/objects/*/portable/on" => json!(["AgentInRange"]),
        "/objects/*/switch" => json!({ "target": "word", "action": "close" }),
        "/objects/*/portable" => json!({ "on": ["AgentInRange"] }),
        "/objects/*/pushable" => json!({ "mass": 9.0, "friction": 0.25 }),
        "/objects/*/waypoints" => json!([[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]]),
        "/objects/*/respawn" => json!({ "delay": 9.0 }),
        stimuli if stimuli.ends_with("_stimulus") && *now == json!(["AgentInRange"]) => json!(["AgentInteract"]),
        stimuli if stimuli.ends_with("_stimulus") => json!(["AgentInRange"]),
        unknown => panic!("give this test a value for {unknown}"),
    }
}

/// The value at a pointer.
fn at<'a>(json: &'a mut Json, pointer: &str) -> &'a mut Json {
    let keys = pointer.split('/').skip(1);
    keys.fold(json, |json, key| match key.parse::<usize>() {
        Ok(index) => &mut json[index],
        Err(_) => &mut json[key],
    })
}

/// The pointer to the first occurrence of a place: among the conditions of an ending, the first with its key.
fn first(place: &FieldPlace, full: &Json) -> String {
    let pointer = &place.pointer;
    let Some((list, key)) = pointer
        .split_once("/*/")
        .filter(|(list, _)| list.starts_with("/rules/"))
    else {
        return pointer.replace('*', "0");
    };
    let conditions = full
        .pointer(list)
        .and_then(Json::as_array)
        .expect("there are conditions");
    let index = conditions
        .iter()
        .position(|condition| condition.pointer(&format!("/{key}")).is_some());
    format!("{list}/{}/{key}", index.expect("there is a condition of each kind"))
}

/// A world drawn from a task with this template, in which `tried` is a parameter.
fn drawn(name: &str, template: &Json, tried: &Json) -> World {
    let task = json!({ "name": "t", "world": template, "parameters": { "tried": tried } });
    let task = TaskSpec::from_json(name, &task.to_string()).unwrap_or_else(|error| panic!("{error}"));
    let variant = task.variant("default").expect("it always exists");
    let world = Sampler::new(&variant, 3).world(0);
    world.unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn parameter_sets_exactly_its_own_place() {
    for place in World::places() {
        let Some(kind) = place.kind else { continue };
        let full = full_with(place);
        let pointer = first(place, &full);
        let mut template = full.clone();
        let value = other(place, at(&mut template, &pointer));
        let tried = json!({ "role": "fixed", "type": kind.name(), "value": value });
        *at(&mut template, &pointer) = value;
        let expected = drawn(&place.pointer, &template, &tried);
        *at(&mut template, &pointer) = json!({ "param": "tried" });
        assert_eq!(drawn(&place.pointer, &template, &tried), expected, "{}", place.pointer);
        assert_ne!(expected, drawn(&place.pointer, &full, &tried), "{}", place.pointer);
    }
}

/// A task in which variants give a place of the world one of two values.
fn task_of_two(place: &FieldPlace, pointer: &str, full: &Json, values: &[Json; 2]) -> Arc<TaskSpec> {
    let mut template = full.clone();
    *at(&mut template, pointer) = json!({ "param": "tried" });
    let comparisons = place.field.compared.comparisons().iter();
    let affects: BTreeSet<&str> = comparisons.map(|comparison| comparison.element().letter()).collect();
    let [first, second] = values;
    let task = json!({ "name": "t", "world": template, "parameters": { "tried": {
        "role": "variant", "type": "json", "affects": affects, "choices": values, "default": first } },
        "variants": { "first": {}, "second": { "tried": second } } });
    let read = |text: &str| TaskSpec::from_json(pointer, text).unwrap_or_else(|error| panic!("{error}"));
    let task = read(&task.to_string());
    // Serialising it gives the same task.
    read(&task.to_json())
}

fn world_of(task: &Arc<TaskSpec>, variant: &str) -> World {
    let variant = task.variant(variant).unwrap_or_else(|error| panic!("{error}"));
    let world = Sampler::new(&variant, 3).world(0);
    world.unwrap_or_else(|error| panic!("{}: {error}: {:?}", variant.id(), variant.values()))
}

#[test]
fn json_parameter_at_every_place_changes_the_documented_elements() {
    for place in places_in_turn() {
        let full = full_with(place);
        let pointer = first(place, &full);
        let mut template = full.clone();
        let now = at(&mut template, &pointer).clone();
        let second = other(place, &now);
        let task = task_of_two(place, &pointer, &full, &[now, second.clone()]);
        let plain = |template: &Json| {
            drawn(
                &pointer,
                template,
                &json!({ "role": "fixed", "type": "number", "value": 1 }),
            )
        };
        assert_eq!(world_of(&task, "first"), plain(&template), "{pointer}");
        *at(&mut template, &pointer) = second;
        assert_eq!(world_of(&task, "second"), plain(&template), "{pointer}");
        let [first, second] = ["first", "second"].map(|name| task.variant(name).expect("it is declared"));
        let distance = variant_distance(&first, &second, &Weights::default()).expect("both belong to the same task");
        let row_elements: BTreeSet<Element> = place
            .field
            .compared
            .comparisons()
            .iter()
            .map(|part| part.element())
            .collect();
        for element in Element::ALL.iter().filter(|element| **element == element.coarse()) {
            let in_element = distance.element(*element).unwrap_or(0.0);
            assert_eq!(
                in_element > 0.0,
                row_elements.contains(element),
                "{pointer} in {}",
                element.letter()
            );
        }
        // A drift switches half-way, without values in between.
        for (t, expected) in [(0.25, &first), (0.75, &second)] {
            let between = drift(&first, &second, t).unwrap_or_else(|error| panic!("{pointer}: {error}"));
            assert_eq!(between.value("tried"), expected.value("tried"), "{pointer}");
        }
    }
}

/// Places that take a parameter; in the quick tier every third.
fn places_in_turn() -> impl Iterator<Item = &'static FieldPlace> {
    let places = World::places().iter().filter(|place| place.kind.is_some());
    places
        .enumerate()
        .filter_map(|(number, place)| is_turn(number, 3).then_some(place))
}

#[test]
fn optional_values_are_absent_if_a_parameter_is_null() {
    let mut count = 0;
    for place in World::places()
        .iter()
        .filter(|place| place.kind.is_some() && place.is_key)
    {
        let full = full_with(place);
        let pointer = first(place, &full);
        let mut template = full.clone();
        let now = at(&mut template, &pointer).take();
        if World::from_json("absent", &template.to_string()).is_err() {
            continue;
        }
        count += 1;
        let expected = drawn(
            &pointer,
            &template,
            &json!({ "role": "fixed", "type": "number", "value": 1 }),
        );
        let task = task_of_two(place, &pointer, &full, &[now, Json::Null]);
        assert_eq!(world_of(&task, "second"), expected, "{pointer}");
        assert_ne!(world_of(&task, "first"), expected, "{pointer}");
    }
    assert!(count >= 15, "{count} keys that may be absent");
}

#[test]
fn every_place_takes_a_random_choice_from_a_list() {
    for place in places_in_turn() {
        let full = full_with(place);
        let pointer = first(place, &full);
        let mut template = full.clone();
        let now = at(&mut template, &pointer).clone();
        let listed = [now.clone(), other(place, &now)];
        let fixed = json!({ "role": "fixed", "type": "number", "value": 1 });
        let either = listed.clone().map(|value| {
            *at(&mut template, &pointer) = value;
            drawn(&pointer, &template, &fixed)
        });
        *at(&mut template, &pointer) = json!({ "choice": { "values": listed } });
        let task = json!({ "name": "t", "world": template });
        let task = TaskSpec::from_json(&pointer, &task.to_string()).unwrap_or_else(|error| panic!("{error}"));
        let sampler = Sampler::new(&task.variant("default").expect("it always exists"), 3);
        let mut seen = [false; 2];
        for index in 0..crate::tier::quick_or_full(16, 40) {
            let world = sampler
                .world(index)
                .unwrap_or_else(|error| panic!("{pointer}: {error}"));
            let unseeded = |world: &World| world.clone().edit(|world| world.seed = None).expect("it stays valid");
            let which = either.iter().position(|either| unseeded(either) == unseeded(&world));
            seen[which.unwrap_or_else(|| panic!("{pointer}: neither of the two"))] = true;
        }
        assert_eq!(seen, [true; 2], "{pointer}");
    }
}

#[test]
fn every_key_takes_a_parameter_or_documents_why_not() {
    let places = World::places();
    let is_silent = |place: &&FieldPlace| {
        let inside = format!("{}/", place.pointer);
        let holds = places
            .iter()
            .any(|other| other.kind.is_some() && other.pointer.starts_with(&inside));
        place.kind.is_none() && place.field.fixed.is_none() && !holds
    };
    let silent: Vec<&str> = places
        .iter()
        .filter(is_silent)
        .map(|place| place.pointer.as_str())
        .collect();
    assert!(
        silent.is_empty(),
        "no parameter can set {silent:?}, and the table of fields does not say why"
    );
}

/// Changes the value at a place; `false` if a world can have only one value there.
fn change(world: &mut Json, place: &FieldPlace, full: &Json) -> bool {
    let pointer = first(place, full);
    match place.pointer.as_str() {
        // A layout needs its text.
        "/$schema"
        | "/version"
        | "/objects/*"
        | "/environment_params/walls/*/polygon"
        | "/environment_params/layout/text" => return false,
        "/seed" => world["seed"] = json!(5),
        "/progress" => world["progress"] = json!({ "steps": 3, "objects": [{}] }),
        "/objects/*/unique_name" => world["objects"][0]["unique_name"] = json!("another"),
        _ if place.kind.is_some() => {
            let now = at(world, &pointer);
            *now = other(place, now);
        }
        // Lists and parts are removed.
        _ if place.is_key => {
            let (parent, key) = pointer.rsplit_once('/').expect("a pointer begins with a slash");
            let parent = if parent.is_empty() { world } else { at(world, parent) };
            parent.as_object_mut().expect("keys are those of objects").remove(key);
        }
        _ => return false,
    }
    true
}

/// A world in which the value at a place is read.
fn read_by(place: &FieldPlace) -> Json {
    let mut full = full_with(place);
    match place.pointer.as_str() {
        // A ceiling would hide them.
        "/environment_params/looks/clouds" => full["environment_params"]["looks"]["ceiling"] = json!(false),
        "/objects/*/text" => full["objects"][0]["class"] = json!("sign"),
        _ => {}
    }
    let motion = match place.pointer.split('/').nth(3) {
        Some("pushable") => "stationary",
        Some("sight_range") => "predator",
        _ => return full,
    };
    full["objects"][0]["motion_model"] = json!(motion);
    full["objects"][0]["solid"] = json!(true);
    full
}

#[test]
fn unread_fields_of_an_object_do_not_affect_the_distance() {
    let read = |json: &Json| World::from_json("world", &json.to_string()).unwrap_or_else(|error| panic!("{error}"));
    let with = |motion: &str, changes: &[(&str, Json)]| {
        let mut world = full();
        let object = &mut world["objects"][0];
        object["motion_model"] = json!(motion);
        for (key, value) in changes {
            object[*key] = value.clone();
        }
        read(&world)
    };
    let d = |a: &World, b: &World| world_distance(a, b, &Weights::default()).total;
    let (stands, hunts) = (with("stationary", &[]), with("predator", &[]));
    assert_eq!(
        d(
            &stands,
            &with("stationary", &[("speed", json!(9)), ("sight_range", json!(9))])
        ),
        0.0
    );
    assert!(d(&hunts, &with("predator", &[("speed", json!(9))])) > 0.0);
    let unpaid = [("reward_stimulus", json!([])), ("reward_once_stimulus", json!([]))];
    let at = |reward: i32| [&unpaid[..], &[("reward", json!(reward))]].concat();
    assert_eq!(d(&with("stationary", &at(5)), &with("stationary", &at(-50))), 0.0);
}

#[test]
fn worlds_that_differ_in_one_place_differ_in_exactly_its_comparisons() {
    let read =
        |name: &str, json: &Json| World::from_json(name, &json.to_string()).unwrap_or_else(|error| panic!("{error}"));
    let mut wrong = Vec::new();
    for place in World::places()
        .iter()
        .filter(|place| place.field.compared != Compared::AsPart)
    {
        let mut full = read_by(place);
        // Own regions replace those of a predefined map; rooms in a row have no loops.
        if place.pointer == "/environment_params/layout/predefined" {
            let around = full["environment_params"].as_object_mut();
            around.expect("it is an object").remove("map_regions");
        }
        if ["loops", "seed"]
            .map(|key| format!("/environment_params/layout/rooms/{key}"))
            .contains(&place.pointer)
        {
            full["environment_params"]["layout"]["rooms"]["grid"] = json!([3, 3]);
        }
        let world = read("full", &full);
        assert_eq!(world_distance(&world, &world, &Weights::default()).total, 0.0);
        let mut changed = full.clone();
        if !change(&mut changed, place, &full) {
            continue;
        }
        let distance = world_distance(&world, &read(&place.pointer, &changed), &Weights::default());
        let differs = distance.parts.iter().filter(|part| part.normalised > 0.0);
        let mut differs: Vec<&str> = differs.map(|part| part.name.as_str()).collect();
        // A layout also determines the arena's size; for some keys that is the only visible effect, because shapes are compared
        // in shares of its sides.
        if place.pointer.starts_with("/environment_params/layout") {
            let layouts = Comparison::Layouts.name();
            let sides = Comparison::ArenaSize.name();
            let scales = ["/cell", "/size", "/size/*"].map(|key| format!("/environment_params/layout{key}"));
            if differs == [sides] && scales.contains(&place.pointer) {
                differs = vec![layouts];
            }
            differs.retain(|part| *part != sides);
        }
        let mut expected: Vec<&str> = place
            .field
            .compared
            .comparisons()
            .iter()
            .map(|part| part.name())
            .collect();
        differs.sort_unstable();
        expected.sort_unstable();
        if differs != expected || (distance.total > 0.0) == expected.is_empty() {
            wrong.push(format!(
                "{}: the table says {expected:?}, worlds differ in {differs:?}",
                place.pointer
            ));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
