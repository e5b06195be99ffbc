//! Properties of doors and keys in doorways, tested on random rooms.

use std::collections::BTreeSet;
use std::sync::Arc;

use driftworld_generator::Sampler;
use driftworld_spec::{Object, Plan, TaskSpec, World};
use proptest::prelude::*;

const COINS: &str = r#"[{ "name": "coin", "count": 3, "object": { "class": "geometric" },
    "placement": { "cells": { "jitter": 0.5 } } }]"#;

fn task(rooms: &str, groups: &str) -> Arc<TaskSpec> {
    let text = format!(
        r#"{{ "name": "t", "world": {{ "environment_params": {{ "layout": {rooms} }}, "agent_params": {{ "agent_width": 0.6,
            "carry_limit": 1, "coordinates": {{ "cells": {{ "jitter": 0.9 }} }} }} }}, "groups": {groups} }}"#
    );
    TaskSpec::from_json("t", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn world(task: &Arc<TaskSpec>, seed: u64, index: u64) -> World {
    let sampler = Sampler::new(
        &task.variant("default").expect("the default variant always exists"),
        seed,
    );
    sampler.world(index).unwrap_or_else(|error| panic!("{error}"))
}

fn doors(world: &World) -> Vec<&Object> {
    world.objects.iter().filter(|object| object.door.is_some()).collect()
}

fn keys(world: &World) -> Vec<&Object> {
    world
        .objects
        .iter()
        .filter(|object| object.portable.is_some())
        .collect()
}

/// The cells on both sides of a doorway.
fn cells_beside(plan: &Plan, doorway: usize) -> [usize; 2] {
    let doorway = &plan.doorways[doorway];
    let axis = usize::from(doorway.heading == 0.0);
    [-0.1, 0.1].map(|metres| {
        let mut at = doorway.center;
        at[axis] += metres;
        plan.cell_at(at).expect("a cell is on each side of a doorway")
    })
}

/// The cells that can be reached by opening only doors with keys that were reached earlier. An independent implementation,
/// which repeats all checks until nothing changes.
fn reached(world: &World) -> BTreeSet<usize> {
    let (plan, doors, keys) = (world.plan().expect("it has rooms"), doors(world), keys(world));
    let start = plan
        .cell_at(world.agent_params.coordinates)
        .expect("rooms fill the arena");
    let mut reached = BTreeSet::from([start]);
    loop {
        let before = reached.len();
        let owned: BTreeSet<_> = keys
            .iter()
            .filter(|key| reached.contains(&plan.cell_at(key.coordinates).expect("rooms fill the arena")))
            .map(|key| key.tag.clone())
            .collect();
        let mut shut = BTreeSet::new();
        for (number, object) in doors.iter().enumerate() {
            let door = object.door.as_ref().expect("it is a door");
            if door.key.is_some() && !owned.contains(&door.key) {
                let [a, b] = cells_beside(plan, number);
                shut.extend([(a, b), (b, a)]);
            }
        }
        for cell in reached.clone() {
            reached.extend(plan.neighbours(cell).filter(|next| !shut.contains(&(cell, *next))));
        }
        if reached.len() == before {
            return reached;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 96)))]

    #[test]
    fn all_rooms_can_be_reached_and_each_doorway_has_its_door(
        grid in (1_u32..5, 1_u32..5), loops in 0.0..1.0, kind in 0..3, standing in prop_oneof![Just(1.0), 0.2..1.0],
        seed in 0_u64..1000,
    ) {
        let word = ["open", "closed", "keyed"][kind as usize];
        let rooms = format!(
            r#"{{ "rooms": {{ "grid": [{}, {}], "room": [6, 5], "loops": {loops}, "doors": "{word}" }}, "standing": {standing} }}"#,
            grid.0, grid.1
        );
        let task = task(&rooms, COINS);
        let world = world(&task, seed, seed);
        let (plan, doors, keys) = (world.plan().unwrap(), doors(&world), keys(&world));
        prop_assert_eq!(doors.len(), plan.doorways.len());
        for (object, doorway) in doors.iter().zip(&plan.doorways) {
            prop_assert_eq!((object.coordinates, object.heading), (doorway.center, doorway.heading));
            prop_assert_eq!(object.scale, doorway.width);
            prop_assert_eq!(object.door.as_ref().unwrap().open, word == "open");
        }
        prop_assert_eq!(keys.len(), if word == "keyed" { doors.len() } else { 0 });
        if word == "keyed" {
            let colors = |objects: &[&Object]| -> Vec<String> {
                let mut found: Vec<String> = objects.iter().map(|object| format!("{:?}", object.color.unwrap())).collect();
                found.sort_unstable();
                found
            };
            prop_assert_eq!(colors(&doors), colors(&keys));
            let distinct: BTreeSet<String> = colors(&doors).into_iter().collect();
            prop_assert_eq!(distinct.len(), doors.len().min(8));
            for door in &doors {
                // A key with the door's tag has the door's colour.
                let own = keys.iter().filter(|key| key.tag == door.door.as_ref().unwrap().key);
                prop_assert!(own.clone().count() > 0 && own.clone().all(|key| key.color == door.color));
            }
        }
        prop_assert_eq!(reached(&world).len(), plan.cells.len());
        // Keys lie in free space, away from each other, the coins and the agent.
        for (index, key) in keys.iter().enumerate() {
            prop_assert!(world.enclosure(key.coordinates).is_none());
            let start = world.agent_params.coordinates;
            let coins = world.objects.iter().filter(|object| object.class == "geometric").map(|coin| coin.coordinates);
            for other in keys[..index].iter().map(|key| key.coordinates).chain(coins).chain([start]) {
                let offset = [0, 1].map(|axis| key.coordinates[axis] - other[axis]);
                prop_assert!(libm::hypot(offset[0], offset[1]) >= 0.79, "{:?} and {other:?}", key.coordinates);
            }
        }
        // The world round-trips through JSON.
        prop_assert_eq!(&World::from_json("w", &world.to_json()).unwrap(), &world);
    }

    #[test]
    fn doors_and_keys_change_nothing_else(seed in 0_u64..200) {
        let with = |word: &str| {
            let rooms = format!(r#"{{ "rooms": {{ "grid": [3, 2], "loops": 0.5, "doors": "{word}" }} }}"#);
            world(&task(&rooms, COINS), 3, seed)
        };
        let [without, keyed] = ["none", "keyed"].map(with);
        prop_assert!(doors(&without).is_empty() && keys(&without).is_empty());
        // A start inside a door is resampled.
        prop_assume!(without.agent_params.coordinates == keyed.agent_params.coordinates);
        prop_assert_eq!(&without.objects[..], &keyed.objects[..3]);
        prop_assert_eq!((without.plan(), without.seed), (keyed.plan(), keyed.seed));
    }
}

#[test]
fn worlds_differ_in_key_positions_and_colours() {
    let task = task(r#"{ "rooms": { "grid": [2, 2], "doors": "keyed", "seed": 4 } }"#, "[]");
    let worlds: Vec<World> = (0..10).map(|index| world(&task, 7, index)).collect();
    let first = |world: &World| format!("{:?}", keys(world)[0].coordinates);
    let color = |world: &World| format!("{:?}", doors(world)[0].color);
    assert!(worlds.iter().map(first).collect::<BTreeSet<_>>().len() > 5);
    assert!(worlds.iter().map(color).collect::<BTreeSet<_>>().len() > 3);
    assert_eq!(worlds[4], world(&task, 7, 4));
}

#[test]
fn some_keys_lie_behind_other_doors() {
    let task = task(r#"{ "rooms": { "grid": [3, 3], "loops": 0, "doors": "keyed" } }"#, "[]");
    let behind = (0..20)
        .filter(|index| {
            let world = world(&task, 1, *index);
            let plan = world.plan().unwrap();
            let room = |at| plan.cells[plan.cell_at(at).unwrap()].room;
            let home = room(world.agent_params.coordinates);
            keys(&world).iter().any(|key| room(key.coordinates) != home)
        })
        .count();
    assert!(behind >= 10, "{behind} of 20");
}

#[test]
fn agent_does_not_start_in_a_door() {
    let text = r#"{ "name": "t", "world": { "environment_params": { "layout": { "rooms": { "grid": [2, 1], "room": [4, 4],
        "doors": "closed" } } }, "agent_params": { "agent_width": 0.6,
        "coordinates": { "box": { "low": [-0.3, -1.5], "high": [0.3, 1.5] } } } } }"#;
    let task = TaskSpec::from_json("t", text).unwrap_or_else(|error| panic!("{error}"));
    for index in 0..50 {
        let world = world(&task, 5, index);
        let door = doors(&world)[0].coordinates;
        let [x, y] = world.agent_params.coordinates;
        assert!((x - door[0]).abs() >= 0.45 || (y - door[1]).abs() >= 0.75, "{x} {y}");
    }
}

#[test]
fn missing_cell_for_a_key_is_an_error() {
    let task = task(
        r#"{ "rooms": { "grid": [2, 1], "room": [2, 2], "doorway": 1, "doors": "keyed" } }"#,
        r#"[{ "name": "coin", "count": 32, "object": { "class": "geometric" }, "keep_out": { "walls": 0, "agent": 0 },
            "placement": { "grid": { "low": [-2, -1], "high": [2, 1], "columns": 8, "rows": 4 } } }]"#,
    );
    let error = Sampler::new(&task.variant("default").unwrap(), 1).world(0).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("keys of the layout's doors") && message.contains("lower the counts of groups"),
        "{message}"
    );
}
