//! Tests that sampled worlds are reproducible and valid, keep their distances, and share random numbers as specified.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use std::sync::Arc;

use driftworld_generator::{GeneratorError, Sampler, sample};
use driftworld_spec::{Object, TaskSpec, World, maps};
use proptest::prelude::*;

fn example(name: &str) -> Arc<TaskSpec> {
    let path = format!("{}/../examples/tasks/{name}.json", env!("CARGO_MANIFEST_DIR"));
    load(&std::fs::read_to_string(path).expect("the example tasks ship with the project"))
}

fn load(text: &str) -> Arc<TaskSpec> {
    TaskSpec::from_json("task.json", text).unwrap_or_else(|error| panic!("{error}"))
}

fn world(task: &Arc<TaskSpec>, variant: &str, seed: u64, index: u64) -> World {
    let variant = task.variant(variant).expect("the tests name existing variants");
    sample(&variant, seed, index).unwrap_or_else(|error| panic!("{error}"))
}

fn tagged<'a>(world: &'a World, tag: &str) -> Vec<&'a Object> {
    world
        .objects
        .iter()
        .filter(|object| object.tag.as_deref() == Some(tag))
        .collect()
}

/// `DRIFTWORLD_UPDATE_GOLDEN=1` rewrites the files. A difference is a breaking change, as the same seeds then draw other worlds.
#[test]
fn golden_worlds_are_reproduced() {
    for (task, variant, index) in [
        ("find_objects", "red", 0),
        ("find_objects", "red", 12_345),
        ("find_objects", "huddle", 1),
        ("get_to_goal", "hazards", 2),
    ] {
        let found = world(&example(task), variant, 7, index).to_json_pretty();
        let path = format!(
            "{}/tests/golden/{task}-{variant}-7-{index}.json",
            env!("CARGO_MANIFEST_DIR")
        );
        if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
            std::fs::write(&path, &found).expect("the golden file can be written");
        }
        let golden = std::fs::read_to_string(&path).expect("the golden file is committed");
        assert!(found == golden, "the sampled world differs from {path}");
    }
}

#[test]
fn worlds_do_not_depend_on_the_order_of_drawing() {
    let task = example("find_objects");
    let sampler = Sampler::new(&task.variant("red").expect("red is a variant"), 3);
    let forwards: Vec<String> = (0..20)
        .map(|index| sampler.world(index).expect("all objects can be placed").to_json())
        .collect();
    for index in (0..20).rev() {
        assert_eq!(world(&task, "red", 3, index).to_json(), forwards[index as usize]);
    }
    assert_ne!(forwards[0], forwards[1]);
    assert_ne!(world(&task, "red", 4, 0).to_json(), forwards[0]);
}

#[test]
fn variants_share_random_numbers() {
    let task = example("find_objects");
    let (red, penalty) = (world(&task, "red", 7, 5), world(&task, "penalty", 7, 5));
    let mut expected = red.into_draft();
    for object in expected.objects.iter_mut().filter(|object| object.reward == 100.0) {
        object.reward = -100.0;
    }
    assert_eq!(
        expected, *penalty,
        "variants that differ in rewards differ in nothing else"
    );
}

#[test]
fn added_parameter_group_or_object_leaves_the_rest_unchanged() {
    let text = std::fs::read_to_string(format!(
        "{}/../examples/tasks/find_objects.json",
        env!("CARGO_MANIFEST_DIR")
    ))
    .expect("the example tasks ship with the project");
    let before = world(&load(&text), "red", 7, 9);
    let parameter = r#""target_count": {"#;
    let with_parameter = text.replacen(
        parameter,
        &format!(
            r#""mist": {{ "role": "randomized", "type": "number", "affects": ["O"], "distribution": {{ "uniform": {{ "low": 0, "high": 1 }} }} }}, {parameter}"#
        ),
        1,
    );
    assert_eq!(world(&load(&with_parameter), "red", 7, 9), before);
    let group = r#"{ "name": "bags", "count": 3, "object": { "class": "bag" }, "placement": { "disc": { "center": [0, 0], "radius": 25 } } }"#;
    let with_group = text.replacen("  ],\n  \"require\"", &format!("  , {group} ],\n  \"require\""), 1);
    let after = world(&load(&with_group), "red", 7, 9);
    assert_eq!(after.objects[..before.objects.len()], before.objects[..]);
    assert_eq!(after.objects.len(), before.objects.len() + 3);
    let with_target = text.replacen("\"value\": 5", "\"value\": 6", 1);
    let after = world(&load(&with_target), "red", 7, 9);
    assert_eq!(tagged(&after, "targets")[..5], tagged(&before, "targets")[..]);
}

#[test]
fn groups_keep_their_distances() {
    let distance =
        |a: &Object, b: &Object| (a.coordinates[0] - b.coordinates[0]).hypot(a.coordinates[1] - b.coordinates[1]);
    for index in 0..50 {
        let world = world(&example("find_objects"), "blue", 1, index);
        assert_eq!(tagged(&world, "targets").len(), 5);
        for (number, object) in world.objects.iter().enumerate() {
            let separation = if object.tag.as_deref() == Some("targets") {
                2.0
            } else {
                3.0
            };
            assert!(
                world.objects[..number]
                    .iter()
                    .all(|other| distance(object, other) >= separation),
                "{index}"
            );
            assert!(
                object.coordinates.iter().all(|metres| metres.abs() <= 29.0),
                "objects stay a metre from the walls"
            );
            assert!(
                object.coordinates[0].hypot(object.coordinates[1]) >= 2.0,
                "objects stay away from the agent's start"
            );
        }
    }
}

#[test]
fn objects_keep_out_of_excluded_regions() {
    for map in 1..=4_u8 {
        let text = format!(
            r#"{{ "name": "maps", "world": {{ "environment_params": {{ "predefined_map": {map} }}, "agent_params": {{ "coordinates": {{ "box": {{ "low": [-99, -99], "high": [99, 99] }} }} }} }},
                "groups": [{{ "name": "rocks", "count": 300, "object": {{ "class": "rock" }},
                "placement": {{ "box": {{ "low": [-100, -100], "high": [100, 100] }} }}, "keep_out": {{ "walls": 1.5 }} }}] }}"#
        );
        for object in &world(&load(&text), "default", 5, 0).objects {
            let [x, y] = object.coordinates;
            for region in maps::excluded_regions(map).iter().map(|region| &region.0) {
                // Sums the winding number from angles, as an independent oracle.
                let turns: f64 = region
                    .iter()
                    .zip(region.iter().cycle().skip(1))
                    .map(|(a, b)| {
                        let angle = (b[1] - y).atan2(b[0] - x) - (a[1] - y).atan2(a[0] - x);
                        (angle + 9.0 * std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI
                    })
                    .sum();
                assert!(turns.abs() < 1.0, "map {map}: {x}, {y} is inside {region:?}");
                assert!(
                    region.iter().all(|c| (c[0] - x).hypot(c[1] - y) >= 1.5),
                    "map {map}: too close to a corner"
                );
            }
        }
    }
}

#[test]
fn unplaceable_object_error_names_the_group_and_the_field_to_relax() {
    let crowd = load(
        r#"{ "name": "crowd", "world": { "environment_params": { "map_size": [10, 10] } },
             "groups": [{ "name": "crowd", "count": 100, "object": { "class": "cube" },
                          "placement": { "box": { "low": [-5, -5], "high": [5, 5] } }, "separation": 3 }] }"#,
    );
    let error = sample(&crowd.variant("default").expect("it always exists"), 0, 0).expect_err("100 cubes do not fit");
    assert_eq!(error.code(), "generator/no-place");
    insta::assert_snapshot!(error);
    let beyond = load(
        r#"{ "name": "beyond", "groups": [{ "name": "g", "count": 1, "object": { "class": "cube" },
                          "placement": { "points": { "values": [[80, 0]] } } }] }"#,
    );
    let error = sample(&beyond.variant("default").expect("it always exists"), 0, 0).expect_err("80 m is outside");
    insta::assert_snapshot!(error);
}

#[test]
fn out_of_range_draw_error_names_its_key() {
    let wild = load(
        r#"{ "name": "wild", "world": { "environment_params": { "light_intensity": { "normal": { "mean": 1, "std": 50 } } } } }"#,
    );
    let variant = wild.variant("default").expect("it always exists");
    let error = (0..100)
        .find_map(|index| sample(&variant, 0, index).err())
        .expect("half of the draws are negative");
    assert!(matches!(error, GeneratorError::OutOfRange { .. }));
    insta::assert_snapshot!(error);
}

#[test]
fn incompatible_draws_are_an_error_with_the_reason() {
    let pictures = load(
        r#"{ "name": "fine", "world": { "agent_params": {
             "observation_size": { "integer_uniform": { "low": 84, "high": 4096 } },
             "supersampling": { "integer_uniform": { "low": 1, "high": 4 } } } } }"#,
    );
    let variant = pictures.variant("default").expect("it always exists");
    let worlds: Vec<_> = (0..100).map(|index| sample(&variant, 0, index)).collect();
    let large = worlds
        .iter()
        .flatten()
        .find(|world| world.agent_params.observation_size > 1000);
    assert!(large.is_some(), "large pictures without much supersampling are valid");
    let error = worlds
        .into_iter()
        .find_map(Result::err)
        .expect("some pictures have too many samples");
    assert!(matches!(error, GeneratorError::Clash { .. }));
    insta::assert_snapshot!(error);
}

#[test]
fn ten_thousand_objects_can_be_placed() {
    let many = load(
        r#"{ "name": "many", "world": { "environment_params": { "map_size": [300, 300] } },
             "groups": [{ "name": "g", "count": 10000, "object": { "class": "rock" },
                          "placement": { "box": { "low": [-149, -149], "high": [149, 149] } }, "separation": 1 }] }"#,
    );
    assert_eq!(world(&many, "default", 0, 0).objects.len(), 10_000);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 48), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_world_passes_the_strict_reader(seed in any::<u64>(), index in 0..u64::MAX) {
        for name in ["find_objects", "get_to_goal"] {
            let task = example(name);
            for variant in task.all_variants() {
                let world = sample(&variant, seed, index).unwrap_or_else(|error| panic!("{error}"));
                let reread = World::from_json("sampled", &world.to_json()).unwrap_or_else(|error| panic!("{error}"));
                prop_assert_eq!(reread, world);
            }
        }
    }
}
