//! Layouts of sampled worlds: each world has its own layout, objects are in free space, and the seed is saved.

use std::sync::Arc;

use driftworld_generator::{GeneratorError, Sampler};
use driftworld_spec::{TaskSpec, World};

fn task(layout: &str, more: &str) -> Arc<TaskSpec> {
    let text = format!(
        r#"{{ "version": 2, "name": "mazes", {more}
            "world": {{ "environment_params": {{ "layout": {layout} }}, "agent_params": {{ "coordinates": [1.5, 1.5] }} }},
            "groups": [{{ "name": "coins", "count": 8, "object": {{ "class": "geometric" }}, "keep_out": {{ "walls": 0.3 }},
                         "placement": {{ "box": {{ "low": [-12, -12], "high": [12, 12] }} }} }}] }}"#
    );
    TaskSpec::from_json("task.json", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn sampler(task: &Arc<TaskSpec>, variant: &str, seed: u64) -> Sampler {
    Sampler::new(&task.variant(variant).expect("the task has the variant"), seed)
}

fn world(sampler: &Sampler, index: u64) -> World {
    sampler.world(index).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn each_world_has_its_own_maze_and_saves_its_seed() {
    let task = task(r#"{ "maze": { "cells": [8, 8], "braid": 0.2 } }"#, "");
    let all = sampler(&task, "default", 7);
    let worlds: Vec<World> = (0..20).map(|index| world(&all, index)).collect();
    for (index, drawn) in worlds.iter().enumerate().rev() {
        // Random access, and a round trip through JSON.
        assert_eq!(*drawn, world(&sampler(&task, "default", 7), index as u64));
        let read = World::from_json("w.json", &drawn.to_json()).expect("a sampled world is valid");
        assert_eq!(read.plan(), drawn.plan());
        let layout = drawn
            .environment_params
            .layout
            .as_ref()
            .expect("the world has a layout");
        assert!(layout.seed().is_some() && layout.seed() != drawn.seed);
        for object in &drawn.objects {
            assert!(drawn.enclosure(object.coordinates).is_none());
        }
    }
    let mazes: std::collections::BTreeSet<String> = worlds
        .iter()
        .map(|world| format!("{:?}", world.plan().expect("the world has a layout").walls))
        .collect();
    assert_eq!(mazes.len(), worlds.len());
    let other = world(&sampler(&task, "default", 8), 0);
    assert_ne!(other.plan(), worlds[0].plan());
}

#[test]
fn layout_with_a_seed_is_the_same_in_every_world() {
    let task = task(r#"{ "maze": { "seed": 5 } }"#, "");
    let all = sampler(&task, "default", 7);
    assert_eq!(world(&all, 0).plan(), world(&all, 1).plan());
}

#[test]
fn variants_share_mazes_and_a_parameter_removes_walls() {
    let parameters = r#""parameters": { "standing": { "role": "variant", "type": "number", "affects": ["T"],
        "range": [0, 1], "default": 1 } }, "variants": { "open": { "standing": 0 }, "half": { "standing": 0.5 } },"#;
    let task = task(r#"{ "maze": {}, "standing": { "param": "standing" } }"#, parameters);
    let [open, half, all] = ["open", "half", "default"].map(|variant| world(&sampler(&task, variant, 3), 0));
    let [open, half, all] = [&open, &half, &all].map(|world| world.plan().expect("the world has a layout"));
    assert!(open.walls.is_empty() && !half.walls.is_empty());
    for (half, all) in half.cells.iter().zip(&all.cells) {
        assert_eq!(
            half.sides & all.sides,
            all.sides,
            "every open side of the full maze is open in the half maze"
        );
    }
}

#[test]
fn drawn_numbers_that_make_an_invalid_layout_are_an_error() {
    let task = task(
        r#"{ "maze": { "cells": [2, 2], "seed": 1, "wall": { "uniform": { "low": 2, "high": 4 } } } }"#,
        "",
    );
    let all = sampler(&task, "default", 7);
    let error = (0..50).find_map(|index| all.world(index).err());
    let error = error.expect("walls as wide as cells leave no corridor");
    assert!(matches!(error, GeneratorError::Clash { .. }), "{error}");
    assert!(
        error.to_string().contains("/environment_params/layout/maze/wall"),
        "{error}"
    );
}
