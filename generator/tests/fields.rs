//! Every place of a world that the table of fields lists takes a parameter, and what the parameter says arrives in the
//! drawn world.

use driftworld_generator::Sampler;
use driftworld_spec::{FieldPlace, ParameterType, TaskSpec, World, schema};
use serde_json::{Value as Json, json};

/// A world in which there is something at every place, as the documents for the schemas have it.
fn full() -> Json {
    let read = |name: &str| -> Json {
        let path = format!(
            "{}/../tests/documents/good/task/{name}.json",
            env!("CARGO_MANIFEST_DIR")
        );
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        serde_json::from_str::<Json>(&text).expect("it is JSON")["world"].take()
    };
    let mut world = read("world_with_every_key");
    world["environment_params"]["walls"] =
        json!([{ "polygon": [[10, 10], [12, 10], [11, 14]], "height": 2, "color": "grey" }]);
    // Out of the way of what the tests move.
    world["agent_params"]["coordinates"] = json!([-20, 20]);
    world["agent_params"]["interact"] = json!(true);
    world["objects"] = read("fixtures_with_every_key")["objects"].take();
    world["objects"].as_array_mut().expect("it is a list").truncate(1);
    world
}

/// Another value than the one that stands at a place, and how a parameter with it is declared.
fn other(place: &FieldPlace, now: &Json) -> Json {
    let number = |at: &Json| at.as_f64().expect("a number stands there");
    match place.kind.expect("it can be a parameter") {
        ParameterType::Number
            if ["map_size", "field_of_view"]
                .iter()
                .any(|key| place.pointer.contains(key)) =>
        {
            json!(62.5)
        }
        ParameterType::Point if place.pointer.contains("map_size") => json!([62.5, 61.5]),
        ParameterType::Number | ParameterType::Heading if number(now) == 0.5 => json!(0.75),
        ParameterType::Number | ParameterType::Heading => json!(0.5),
        ParameterType::Integer => json!(if now == 3 { 2 } else { 3 }),
        ParameterType::Boolean => json!(!now.as_bool().expect("it is true or false")),
        ParameterType::Color => json!([0.125, 0.25, 0.5]),
        ParameterType::Point => json!([11.5, 12.5]),
        ParameterType::Vector => json!([0.5, 0.25, 2.0]),
        ParameterType::String => json!(
            match place.pointer.rsplit('/').find(|word| *word != "*").unwrap_or_default() {
                "game_mode" => "collect_images",
                "action_model" => "onrails",
                "modalities" => "class",
                "state_features" => "steps_left",
                "actions" => "normalized",
                "motion_model" => "prey",
                "model" => "3",
                key if key.ends_with("stimulus") => "AgentInteract",
                _ => "word",
            }
        ),
        ParameterType::Distribution => unreachable!("no place of a world holds a distribution"),
    }
}

/// The value at a pointer, made on the way there where nothing stands.
fn at<'a>(json: &'a mut Json, pointer: &str) -> &'a mut Json {
    pointer
        .split('/')
        .skip(1)
        .fold(json, |json, key| match key.parse::<usize>() {
            Ok(index) => &mut json[index],
            Err(_) => &mut json[key],
        })
}

/// The conditions of an ending are of one kind each: the number of one that has a place's key.
fn concrete(pointer: &str, full: &Json) -> String {
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
    let index = conditions.iter().position(|condition| condition.get(key).is_some());
    format!("{list}/{}/{key}", index.expect("there is a condition of each kind"))
}

#[test]
fn every_place_takes_a_parameter_and_what_it_says_arrives() {
    let full = full();
    let mut tried = 0;
    for place in World::places().iter().filter(|place| place.kind.is_some()) {
        let pointer = concrete(&place.pointer, &full);
        let mut world = full.clone();
        let now = at(&mut world, &pointer).clone();
        let expected = other(place, &now);
        *at(&mut world, &pointer) = json!({ "param": "tried" });
        let kind = place.kind.expect("filtered").name();
        let task = json!({ "name": "t", "world": world,
            "parameters": { "tried": { "role": "fixed", "type": kind, "value": expected } } });
        let task = TaskSpec::from_json(&place.pointer, &task.to_string()).unwrap_or_else(|error| panic!("{error}"));
        let drawn = Sampler::new(&task.variant("default").expect("it is always there"), 3)
            .world(0)
            .unwrap_or_else(|error| panic!("{}: {error}", place.pointer));
        let mut written: Json = serde_json::from_str(&drawn.to_json()).expect("a world is JSON");
        assert_eq!(*at(&mut written, &pointer), expected, "{}", place.pointer);
        tried += 1;
    }
    assert!(tried > 80, "{tried}");
}

#[test]
fn every_key_takes_a_parameter_or_says_why_not_or_holds_what_does() {
    let places = World::places();
    let silent = |place: &&FieldPlace| {
        let holds = |other: &FieldPlace| other.pointer.starts_with(&format!("{}/", place.pointer));
        place.kind.is_none()
            && place.field.fixed.is_none()
            && !places.iter().any(|other| other.kind.is_some() && holds(other))
    };
    let silent: Vec<&str> = places
        .iter()
        .filter(silent)
        .map(|place| place.pointer.as_str())
        .collect();
    assert!(
        silent.is_empty(),
        "no parameter can stand at {silent:?}, and the table of fields does not say why"
    );
    // The table has what the schema has.
    let schema = schema::world().json();
    for key in schema["properties"].as_object().expect("a world has keys").keys() {
        assert!(
            places.iter().any(|place| place.pointer == format!("/{key}")),
            "/{key} is not in the table of fields"
        );
    }
}
