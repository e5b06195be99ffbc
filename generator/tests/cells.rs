//! Placement of groups and the agent in cells of a layout: by kind, letter, room and walking distance.

use std::sync::Arc;

use driftworld_generator::{Sampler, drift};
use driftworld_spec::{Object, Plan, TaskSpec, World};
use proptest::prelude::*;

/// A task with a layout, the agent's start, and a group of coins with this placement.
fn task(layout: &str, start: &str, count: u32, placement: &str) -> Arc<TaskSpec> {
    let placement = if placement.is_empty() {
        String::new()
    } else {
        format!(r#""placement": {placement},"#)
    };
    let text = format!(
        r#"{{ "name": "t", "world": {{ "environment_params": {{ "layout": {layout} }},
            "agent_params": {{ "agent_width": 0.5 {start} }} }},
          "groups": [{{ "name": "coin", "count": {count}, {placement} "object": {{ "class": "geometric" }},
            "keep_out": {{ "agent": 0 }} }}] }}"#
    );
    TaskSpec::from_json("t", &text).unwrap_or_else(|error| panic!("{error}"))
}

const ANY_START: &str = r#", "coordinates": { "cells": {} }"#;
const MAZE: &str = r#"{ "maze": { "cells": [6, 5], "cell": 2 } }"#;
const ROOMS: &str = r#"{ "rooms": { "grid": [2, 2], "room": [6, 6] } }"#;

fn worlds(task: &Arc<TaskSpec>, count: u64) -> Vec<World> {
    let sampler = Sampler::new(&task.variant("default").expect("it always exists"), 5);
    let world = |index| sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
    (0..count).map(world).collect()
}

/// The plan of a world, the agent's cell, and the cells of its objects.
fn cells(world: &World) -> (&Plan, usize, Vec<usize>) {
    let plan = world.plan().expect("the world has a layout");
    let cell_of = |place: [f64; 2]| plan.cell_at(place).expect("it lies in a cell");
    let objects = world.objects.iter().map(|object: &Object| cell_of(object.coordinates));
    (plan, cell_of(world.agent_params.coordinates), objects.collect())
}

fn error_for(task: &Arc<TaskSpec>) -> String {
    let sampler = Sampler::new(&task.variant("default").expect("it always exists"), 5);
    sampler
        .world(0)
        .map_or_else(|error| error.to_string(), |_| String::new())
}

#[test]
fn dead_ends_corridors_and_junctions_are_classified() {
    for (kind, sides) in [
        ("dead_end", 1..2),
        ("corridor", 2..3),
        ("junction", 3..5),
        ("any", 1..5),
    ] {
        let maze = r#"{ "maze": { "cells": [12, 12], "cell": 2 } }"#;
        let task = task(maze, ANY_START, 2, &format!(r#"{{ "cells": {{ "kind": "{kind}" }} }}"#));
        let mut seen = std::collections::BTreeSet::new();
        for world in worlds(&task, 20) {
            let (plan, _, coins) = cells(&world);
            assert!(
                coins.iter().all(|coin| sides.contains(&plan.cells[*coin].open_sides())),
                "{kind}"
            );
            assert_ne!(coins[0], coins[1], "each has a cell of its own");
            seen.extend(coins);
        }
        assert!(seen.len() >= 8, "{kind}: positions vary");
    }
}

#[test]
fn room_selects_the_agents_or_other_rooms() {
    for (room, is_same) in [("same_as_agent", true), ("other_than_agent", false)] {
        let task = task(
            ROOMS,
            ANY_START,
            3,
            &format!(r#"{{ "cells": {{ "room": "{room}" }} }}"#),
        );
        for world in worlds(&task, 20) {
            let (plan, agent, coins) = cells(&world);
            let same = |coin: &usize| plan.cells[*coin].room == plan.cells[agent].room;
            assert!(coins.iter().all(|coin| same(coin) == is_same), "{room}");
        }
    }
}

#[test]
fn groups_and_the_agent_are_placed_at_their_letters() {
    let text =
        r#"{ "text": ["*********", "*A c * c*", "*  * cA *", "*********"], "legend": { "c": { "group": "coin" } } }"#;
    let task = task(text, "", 3, "");
    let mut starts = std::collections::BTreeSet::new();
    for world in worlds(&task, 12) {
        let (plan, agent, mut coins) = cells(&world);
        starts.insert(agent);
        assert_eq!(plan.cells[agent].letter, Some('A'));
        coins.sort_unstable();
        let letters: Vec<usize> = (0..plan.cells.len())
            .filter(|cell| plan.cells[*cell].letter == Some('c'))
            .collect();
        assert_eq!(coins, letters);
    }
    assert_eq!(starts.len(), 2, "the agent starts at either letter");
}

#[test]
fn explicit_start_is_kept() {
    let text = r#"{ "text": ["*****", "*A c*", "*****"], "legend": { "c": { "group": "coin" } } }"#;
    let task = task(text, r#", "coordinates": [0, 0]"#, 1, "");
    assert_eq!(worlds(&task, 1)[0].agent_params.coordinates, [0.0, 0.0]);
}

#[test]
fn unsatisfiable_request_reports_number_of_cells() {
    let none = |layout: &str, start: &str, placement: &str| error_for(&task(layout, start, 2, placement));
    let braided = r#"{ "maze": { "cells": [4, 4], "braid": 1, "seed": 3 } }"#;
    let found = none(braided, ANY_START, r#"{ "cells": { "kind": "dead_end" } }"#);
    assert!(found.contains("of 16 cells, 0 are dead ends"), "{found}");
    let found = none(MAZE, ANY_START, r#"{ "cells": { "walk": [500, 600] } }"#);
    assert!(
        found.contains("0 are cells at a walking distance of 500 to 600 m from the agent"),
        "{found}"
    );
    let found = none(MAZE, ANY_START, r#"{ "cells": { "room": "other_than_agent" } }"#);
    assert!(found.contains("in a room other than the agent's"), "{found}");
    let found = none(r#"{ "walls": [] }"#, "", r#"{ "cells": {} }"#);
    assert!(found.contains("the world's layout has no cells"), "{found}");
    let found = none(
        r#"{ "maze": { "cells": [2, 1], "cell": 4 } }"#,
        r#", "coordinates": [1, 0]"#,
        r#"{ "cells": { "letter": "x" } }"#,
    );
    assert!(found.contains(r#"0 are cells at the letters "x""#), "{found}");
    let found = none(
        r#"{ "maze": { "cells": [1, 1], "cell": 4 } }"#,
        ANY_START,
        r#"{ "cells": {} }"#,
    );
    assert!(
        found.contains("group \"coin\", object 2 of 2") && found.contains("1 of them are taken"),
        "{found}"
    );
    let found = none(
        braided,
        r#", "coordinates": { "cells": { "kind": "dead_end" } }"#,
        r#"{ "cells": {} }"#,
    );
    assert!(
        found.contains("found no cell for the agent's start: of 16 cells, 0 are dead ends"),
        "{found}"
    );
}

#[test]
fn meaningless_placements_in_cells_are_rejected() {
    let error_for = |world: &str, group: &str| {
        let text = format!(
            r#"{{ "name": "t", "world": {world}, "groups": [
                {{ "name": "a", "count": 1, "object": {{ "class": "tree" }}, "placement": {{ "disc": {{ "center": [0, 0], "radius": 9 }} }} }},
                {{ "name": "b", "count": 1, "object": {{ "class": "tree" }} {group} }}] }}"#
        );
        TaskSpec::from_json("t", &text).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let maze = r#"{ "environment_params": { "layout": { "maze": {} } } }"#;
    let cells = r#", "placement": { "cells": {} }"#;
    assert!(error_for("{}", "").contains("(/groups/1): found nothing, expected the key \"placement\""));
    assert!(error_for("{}", cells).contains("(/groups/1/placement): found cells in a world without a layout"));
    assert_eq!(error_for(maze, cells), "");
    assert!(error_for(maze, &format!(r#"{cells}, "around": "a""#)).contains("cells with \"around\""));
    let mixed = r#", "placement": { "mixture": { "parts": [{ "cells": {} }, { "disc": { "center": [0, 0], "radius": 1 } }] } }"#;
    assert!(
        error_for(maze, mixed).contains("found cells in a mixture"),
        "{}",
        error_for(maze, mixed)
    );
    let walk = r#", "placement": { "cells": { "walk": [9, 3] } }"#;
    assert!(error_for(maze, walk).contains("the first not above the second"));
    let start = r#"{ "environment_params": { "layout": { "maze": {} } },
        "agent_params": { "coordinates": { "cells": { "walk": [1, 2] } } } }"#;
    assert!(
        error_for(start, cells).contains("(/world/agent_params/coordinates): found cells"),
        "{}",
        error_for(start, cells)
    );
}

#[test]
fn walking_distance_is_a_parameter_and_drifts() {
    let text = r#"{ "name": "t", "parameters": { "way": { "role": "variant", "type": "vector", "affects": ["S"], "range": [0, 40], "default": [0, 4] } },
      "world": { "environment_params": { "layout": { "maze": { "cells": [8, 8], "cell": 2 } } }, "agent_params": { "agent_width": 0.5, "coordinates": { "cells": {} } } },
      "groups": [{ "name": "goal", "count": 1, "object": { "class": "geometric" }, "keep_out": { "agent": 0 },
        "placement": { "cells": { "walk": [{ "param": "way", "index": 0 }, { "param": "way", "index": 1 }] } } }],
      "variants": { "near": {}, "far": { "way": [12, 20] } } }"#;
    let task = TaskSpec::from_json("t", text).unwrap_or_else(|error| panic!("{error}"));
    let [near, far] = ["near", "far"].map(|name| task.variant(name).unwrap());
    let between = drift(&near, &far, 0.5).unwrap();
    for (variant, [min, max]) in [(&near, [0.0, 4.0]), (&far, [12.0, 20.0]), (&between, [6.0, 12.0])] {
        let sampler = Sampler::new(variant, 2);
        for index in 0..20 {
            let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
            let (plan, agent, goal) = cells(&world);
            let metres = plan.walking_distances(agent)[goal[0]];
            assert!((min - 1e-6..=max + 1e-6).contains(&metres), "{metres} m");
        }
    }
    // Both variants share all other draws: mazes and starts.
    let [a, b] = [&near, &far].map(|variant| Sampler::new(variant, 2).world(7).unwrap());
    assert_eq!(
        (a.plan(), a.agent_params.coordinates),
        (b.plan(), b.agent_params.coordinates)
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A world does not depend on earlier draws; jittered positions stay in their cells and away from walls.
    #[test]
    fn worlds_do_not_depend_on_earlier_draws_and_objects_stay_in_their_cells(index in 0_u64..1000, jitter in 0.0..1.0_f64) {
        let task = task(MAZE, ANY_START, 4, &format!(r#"{{ "cells": {{ "jitter": {jitter} }} }}"#));
        let variant = task.variant("default").unwrap();
        let sampler = Sampler::new(&variant, 5);
        let _ = sampler.world(index / 2).unwrap();
        let world = sampler.world(index).unwrap();
        prop_assert_eq!(&world, &Sampler::new(&variant, 5).world(index).unwrap());
        let (plan, _, coins) = cells(&world);
        for (object, cell) in world.objects.iter().zip(&coins) {
            let middle = plan.cells[*cell].center;
            for ((place, middle), side) in object.coordinates.iter().zip(middle).zip(plan.cell) {
                prop_assert!((place - middle).abs() <= jitter * side / 2.0 + 1e-12);
            }
            prop_assert!(world.enclosure(object.coordinates).is_none());
        }
        let distinct: std::collections::BTreeSet<&usize> = coins.iter().collect();
        prop_assert_eq!(distinct.len(), coins.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 300)))]

    /// Without a start, the agent starts in a cell without a letter; no cell is assigned twice, and no solid object blocks a
    /// doorway.
    #[test]
    fn cells_are_assigned_once_and_doorways_stay_free(
        layout in prop_oneof![
            (1_u32..6, 2_u32..6).prop_map(|(a, b)| format!(r#"{{ "maze": {{ "cells": [{a}, {b}], "cell": 2 }} }}"#)),
            (1_u32..4, 2_u32..4).prop_map(|(a, b)| format!(r#"{{ "rooms": {{ "grid": [{a}, {b}], "room": [6, 6] }} }}"#)),
            Just(r#"{ "text": ["*******", "*ww.ww*", "***.***", "*ww..w*", "*******"], "cell": 2, "legend": { "w": "floor" } }"#.to_owned()),
        ],
        solid in any::<bool>(), jitter in 0.0..1.0_f64, index in 0_u64..1000,
    ) {
        let group = |name: &str| format!(r#"{{ "name": "{name}", "count": 1, "object": {{ "class": "geometric", "solid": {solid} }},
            "placement": {{ "cells": {{ "jitter": {jitter} }} }}, "keep_out": {{ "agent": 0, "walls": 0 }} }}"#);
        let text = format!(r#"{{ "name": "t", "world": {{ "environment_params": {{ "layout": {layout} }} }},
            "groups": [{}, {}] }}"#, group("a"), group("b"));
        let task = TaskSpec::from_json("t", &text).unwrap();
        let world = Sampler::new(&task.variant("default").unwrap(), 5).world(index);
        let world = match world {
            // Small rooms with jitter may have no position clear of the doorways.
            Err(error) if error.to_string().contains("in the way of a doorway") => return Ok(()),
            world => world.unwrap(),
        };
        let (plan, agent, objects) = cells(&world);
        prop_assert_eq!(plan.cells[agent].center, world.agent_params.coordinates);
        prop_assert!(plan.cells[agent].letter.is_none());
        prop_assert_ne!(objects[0], objects[1]);
        for object in world.objects.iter().filter(|object| object.solid) {
            let [x, y] = object.coordinates;
            let is_blocked = |doorway: &driftworld_spec::Doorway| {
                (x - doorway.center[0]).powi(2) + (y - doorway.center[1]).powi(2) < 4.0 - 1e-9
            };
            prop_assert!(!plan.doorways.iter().any(is_blocked));
        }
    }
}

#[test]
fn each_doorway_takes_one_object_turned_along_the_wall() {
    let task = |layout: &str, count: u32| {
        let text = format!(
            r#"{{ "name": "t", "world": {{ "environment_params": {{ "layout": {layout} }},
                "agent_params": {{ "agent_width": 0.5, "coordinates": {{ "cells": {{}} }} }} }},
                "groups": [{{ "name": "gate", "count": {count}, "object": {{ "class": "door", "scale": 1.5, "heading": 33 }},
                "keep_out": {{ "walls": 0, "agent": 0 }}, "placement": {{ "cells": {{ "kind": "doorway" }} }} }}] }}"#
        );
        TaskSpec::from_json("t", &text).unwrap_or_else(|error| panic!("{error}"))
    };
    let rooms = r#"{ "rooms": { "grid": [3, 2] } }"#;
    let text = r#"{ "text": ["*********", "*A.D.*..*", "*..*.D..*", "*********"] }"#;
    for (layout, max) in [(rooms, 7), (text, 2)] {
        for index in 0..10 {
            let sampler = Sampler::new(&task(layout, max).variant("default").unwrap(), 3);
            let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
            let sorted = |mut poses: Vec<([f64; 2], f64)>| {
                poses.sort_by(|a, b| a.partial_cmp(b).unwrap());
                poses
            };
            let doorways = &world.plan().unwrap().doorways;
            assert_eq!(doorways.len(), max as usize);
            assert_eq!(
                sorted(
                    world
                        .objects
                        .iter()
                        .map(|object| (object.coordinates, object.heading))
                        .collect()
                ),
                sorted(
                    doorways
                        .iter()
                        .map(|doorway| (doorway.center, doorway.heading))
                        .collect()
                )
            );
        }
        let error = Sampler::new(&task(layout, max + 1).variant("default").unwrap(), 3)
            .world(0)
            .unwrap_err();
        let expected = format!("of {max} doorways, {max} are doorways, and {max} of them are taken; lower the count");
        assert!(error.to_string().contains(&expected), "{error}");
    }
    let maze = task(r#"{ "maze": {} }"#, 1).variant("default").unwrap();
    let error = Sampler::new(&maze, 3).world(0).unwrap_err().to_string();
    assert!(error.contains("of 0 doorways"), "{error}");
}

#[test]
fn floor_letters_named_in_the_legend_are_found() {
    let layout =
        r########"{ "text": ["#######", "#P.w.w#", "#######"], "cell": 2, "legend": { "w": "floor" } }"########;
    let task = task(layout, "", 2, r#"{ "cells": { "letter": "w" } }"#);
    for world in worlds(&task, 5) {
        let (plan, _, mut found) = cells(&world);
        found.sort_unstable();
        let letters: Vec<usize> = (0..plan.cells.len())
            .filter(|cell| plan.cells[*cell].letter == Some('w'))
            .collect();
        assert_eq!((letters.len(), &found), (2, &letters));
    }
}

/// 0.1 + 0.2 exceeds 0.3 in binary.
#[test]
fn doorway_and_wall_may_fill_a_side() {
    for (room, doorway, wall) in [(0.3, 0.1, 0.2), (0.7, 0.1, 0.6), (1.1, 0.8, 0.3)] {
        let rooms = format!(
            r#"{{ "rooms": {{ "grid": [2, 2], "room": [{room}, {room}], "doorway": {doorway}, "wall": {wall} }} }}"#
        );
        let text = format!(
            r#"{{ "environment_params": {{ "layout": {rooms} }}, "agent_params": {{ "agent_width": 0.05 }} }}"#
        );
        let read = World::from_json("w", &text);
        assert!(read.is_ok(), "{room}: {:?}", read.err());
    }
}
