//! Tests parameters of type layout in variants, draws and drifts.

use std::sync::Arc;

use driftworld_generator::{Sampler, drift};
use driftworld_spec::{Layout, Maze, ParameterType, Plan, TaskSpec, Value, Variant, World};

/// A task whose layout is a variant parameter; `more` adds keys to the parameter.
fn task(more: &str) -> Arc<TaskSpec> {
    let text = format!(
        r#"{{ "name": "t", "parameters": {{ "map": {{ "role": "variant", "type": "layout", "affects": ["T"], {more}
            "choices": [
              {{ "walls": [] }},
              {{ "maze": {{ "cells": [4, 4], "cell": 3, "seed": 7 }} }},
              {{ "maze": {{ "cells": [9, 6], "cell": 2, "seed": 7 }} }},
              {{ "rooms": {{ "grid": [2, 2], "room": [6, 6], "seed": 7 }} }}],
            "default": {{ "walls": [] }} }} }},
          "world": {{ "environment_params": {{ "layout": {{ "param": "map" }}, "map_size": [12, 12] }},
            "agent_params": {{ "agent_width": 0.5, "coordinates": [0.7, 0.9] }} }},
          "variants": {{ "open": {{}}, "small": {{ "map": {{ "maze": {{ "cell": 3, "cells": [4, 4], "seed": 7 }} }} }},
            "large": {{ "map": {{ "maze": {{ "cells": [9, 6], "cell": 2, "seed": 7 }} }} }},
            "rooms": {{ "map": {{ "rooms": {{ "grid": [2, 2], "room": [6, 6], "seed": 7 }} }} }} }} }}"#
    );
    TaskSpec::from_json("t", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn world(variant: &Variant) -> World {
    Sampler::new(variant, 1)
        .world(0)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn plan(world: &World) -> &Plan {
    world.plan().expect("the world has a layout")
}

#[test]
fn variants_keep_their_layouts_through_json() {
    let task = task("");
    let reread = TaskSpec::from_json("again", &task.to_json()).unwrap();
    assert_eq!(task.parameters()["map"].kind, ParameterType::Layout);
    for task in [&task, &reread] {
        assert_eq!(plan(&world(&task.variant("small").unwrap())).cells.len(), 16);
        assert_eq!(plan(&world(&task.variant("large").unwrap())).cells.len(), 54);
    }
    assert_eq!(
        reread.variant("large").unwrap().hash(),
        task.variant("large").unwrap().hash()
    );
    // The variant writes the same values with its keys in a different order than the choice.
    assert_eq!(
        task.variant("small").unwrap().value("map"),
        Some(
            &task.parameters()["map"].choices.as_ref().unwrap()[1]
                .cast(ParameterType::Layout)
                .unwrap()
        )
    );
}

#[test]
fn drift_from_open_field_to_maze_adds_walls_and_keeps_cells_reachable() {
    let task = task("");
    let [open, small] = ["open", "small"].map(|name| task.variant(name).unwrap());
    let mut walls = Vec::new();
    for step in 0..=8 {
        let between = drift(&open, &small, f64::from(step) / 8.0).unwrap_or_else(|error| panic!("{error}"));
        let world = world(&between);
        // At the open end, the world has no layout.
        let Some(plan) = world.plan() else {
            walls.push(0.0);
            continue;
        };
        let metres: f64 = plan.walls.iter().map(|wall| length(&wall.polygon)).sum();
        walls.push(metres);
        if !plan.cells.is_empty() {
            assert!(
                plan.walking_distances(0).iter().all(|metres| metres.is_finite()),
                "step {step}"
            );
        }
    }
    assert!(
        walls.is_sorted() && walls[4] == 0.0 && walls[5] > 0.0 && walls[6] < walls[8],
        "{walls:?}"
    );
}

/// The longer side of a wall's bounding box.
fn length(polygon: &[[f64; 2]]) -> f64 {
    let side = |axis: usize| {
        let coordinates = polygon.iter().map(|corner| corner[axis]);
        coordinates.clone().fold(f64::MIN, f64::max) - coordinates.fold(f64::MAX, f64::min)
    };
    side(0).max(side(1))
}

#[test]
fn layouts_of_the_same_kind_interpolate_linearly_and_round_integers() {
    let task = task("");
    let [small, large, rooms] = ["small", "large", "rooms"].map(|name| task.variant(name).unwrap());
    let at = |from: &Variant, to: &Variant, t: f64| match drift(from, to, t).unwrap().value("map") {
        Some(Value::Layout(layout)) => (**layout).clone(),
        other => panic!("{other:?} is not a layout"),
    };
    let maze = |cells, cell| Layout {
        maze: Some(Maze {
            cells,
            cell,
            seed: Some(7),
            ..Maze::default()
        }),
        ..Layout::default()
    };
    assert_eq!(at(&small, &large, 0.0), maze([4, 4], 3.0));
    assert_eq!(at(&small, &large, 0.5), maze([7, 5], 2.5));
    assert_eq!(at(&small, &large, 1.0), maze([9, 6], 2.0));
    assert_eq!(
        at(&small, &rooms, 0.25),
        Layout {
            standing: 0.5,
            ..maze([4, 4], 3.0)
        }
    );
    let rising = at(&small, &rooms, 0.75);
    assert!(rising.rooms.is_some() && rising.standing == 0.5);
}

#[test]
fn numbers_in_a_layout_are_parameters_and_sizes_can_be_swept() {
    let text = r#"{ "name": "t", "parameters": {
        "size": { "role": "variant", "type": "vector", "affects": ["T"], "range": [2, 9], "default": [4, 3] },
        "loops": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 1], "default": 0 } },
      "world": { "environment_params": { "layout": { "maze": {
          "cells": { "param": "size" }, "cell": 2, "braid": { "param": "loops" }, "seed": 3 } } },
        "agent_params": { "agent_width": 0.5, "coordinates": { "cells": {} } } },
      "variants": { "a": {}, "b": { "size": [6, 9] }, "dense": { "sweep": { "loops": { "from": 0, "to": 1, "steps": 3 } } } } }"#;
    let task = TaskSpec::from_json("t", text).unwrap_or_else(|error| panic!("{error}"));
    let [a, b] = ["a", "b"].map(|name| task.variant(name).unwrap());
    assert_eq!(plan(&world(&a)).lattice, [4, 3]);
    assert_eq!(plan(&world(&drift(&a, &b, 0.6).unwrap())).lattice, [5, 7]);
    let num_dead_ends = |name: &str| {
        let world = world(&task.variant(name).unwrap());
        plan(&world).cells.iter().filter(|cell| cell.open_sides() == 1).count()
    };
    assert!(num_dead_ends("dense-0") > 0 && num_dead_ends("dense-1") == 0);
}

#[test]
fn invalid_layout_is_refused_with_its_json_pointer() {
    let error_for = |parameter: &str| {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{ "map": {parameter} }},
                 "world": {{ "environment_params": {{ "layout": {{ "param": "map" }} }} }} }}"#
        );
        TaskSpec::from_json("t", &text).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let fixed = |layout: &str| {
        error_for(&format!(
            r#"{{ "role": "fixed", "type": "layout", "value": {layout} }}"#
        ))
    };
    let randomized = |layout: &str| {
        error_for(&format!(
            r#"{{ "role": "randomized", "type": "layout", "affects": ["T"],
                 "distribution": {{ "choice": {{ "values": [{{ "maze": {{}} }}, {layout}] }} }} }}"#
        ))
    };
    for (layout, pointer, expected) in [
        (
            r#"{ "maze": { "cells": [4, 4], "wall": 5 } }"#,
            "/maze/wall",
            "less than the side of a cell",
        ),
        (
            r#"{ "maze": {}, "rooms": {} }"#,
            "",
            "exactly one of maze, rooms, text, predefined, walls",
        ),
        (
            r#"{ "maze": { "cels": [4, 4] } }"#,
            "/maze/cels",
            "did you mean \"cells\"?",
        ),
        (r##"{ "text": ["#. ", "#"] }"##, "/text/1", "3, as in the first line"),
    ] {
        let error = fixed(layout);
        assert!(
            error.contains(&format!("(/parameters/map/value{pointer}): ")) && error.contains(expected),
            "{error}"
        );
        let error = randomized(layout);
        let pointer = format!("(/parameters/map/distribution/choice/values/1{pointer}): ");
        assert!(error.contains(&pointer) && error.contains(expected), "{error}");
    }
    assert_eq!(randomized(r#"{ "rooms": {} }"#), "");
}
