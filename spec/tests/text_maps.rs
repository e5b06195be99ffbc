//! Maps of other programs, read as worlds: their walls, their things, and what is said of what did not pass.

use driftworld_spec::{Legend, World, ZoneEnd};
use proptest::prelude::*;

const LEVEL: &str = "\
*********
*P  *  A*
*   I   *
* Q *  G*
*****H***
*P
*********

.........
.AAA.BBB.
.AAA.BBB.
.AAA.BBB.
.........
.........
.........
";

#[test]
fn a_text_level_of_dmlab_has_its_walls_things_and_warnings() {
    let (world, warnings) = World::from_dmlab_text("level.txt", LEVEL).unwrap();
    let plan = world.plan().unwrap();
    assert_eq!((plan.lattice, plan.size), ([9, 7], [9.0 * 3.125, 7.0 * 3.125]));
    assert_eq!(plan.doorways.len(), 2);
    // The rest of a short line is wall.
    assert!(plan.cell_at([0.0, -2.0 * 3.125]).is_none());
    assert_eq!(world.agent_params.coordinates, [-3.0 * 3.125, 2.0 * 3.125]);
    let of = |tag: &str| {
        let found = world.objects.iter().filter(|object| object.tag.as_deref() == Some(tag));
        found
            .map(|object| (object.coordinates, object.reward))
            .collect::<Vec<_>>()
    };
    assert_eq!(of("apple"), [([3.0 * 3.125, 2.0 * 3.125], 1.0)]);
    assert_eq!(of("goal"), [([3.0 * 3.125, 0.0], 10.0)]);
    let said: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(said.join("\n"));
    let again = World::from_json("again", &world.to_json()).unwrap();
    assert_eq!((again.plan(), &again), (world.plan(), &world));
}

#[test]
fn a_grid_of_minigrid_has_its_rooms_and_things() {
    let grid = "WGWGWGWGWGWG\nWG>>  DY  WG\nWG  KYWGGGWG\nWGVRARWGXXWG\nWGWGWGWGWGWG\n";
    let (world, warnings) = World::from_minigrid_text("grid.txt", grid).unwrap();
    let plan = world.plan().unwrap();
    assert_eq!((plan.lattice, plan.doorways.len()), ([6, 5], 1));
    assert_eq!(
        (world.agent_params.coordinates, world.agent_params.heading),
        ([-3.0, 2.0], 90.0)
    );
    let tags: Vec<&str> = world
        .objects
        .iter()
        .filter_map(|object| object.tag.as_deref())
        .collect();
    assert_eq!(tags, ["yellow_key", "goal", "ball", "door"]);
    let zones = &world.environment_params.zones;
    assert_eq!(zones.len(), 1);
    assert_eq!(zones[0].ends, Some(ZoneEnd::Failure));
    // Its cell, whole: the second of the fourth row.
    let corners = [[-4.0, -3.0], [-2.0, -3.0], [-2.0, -1.0], [-4.0, -1.0]];
    assert_eq!(zones[0].polygon.as_deref(), Some(&corners[..]));
    assert_eq!(world.agent_params.carry_limit, 1);
    let said: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(said.join("\n"));
    World::from_json("again", &world.to_json()).unwrap();
}

/// Across their doorways, with the key of their colour.
#[test]
fn doors_of_minigrid_stand_in_their_doorways() {
    let grid = "WGWGWGWGWG\nWG>>DRKBWG\nWGLBWGWGWG\nWG__WGGGWG\nWG      WG\nWGWGWGWGWG\n";
    let (world, warnings) = World::from_minigrid_text("grid.txt", grid).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let doors = world.objects.iter().filter_map(|object| {
        let door = object.door.as_ref()?;
        let cell = object.coordinates.map(|metres| (metres / 2.0).floor());
        Some((cell, object.heading % 180.0, object.scale, door.open, door.key.clone()))
    });
    let blue = Some("blue_key".to_owned());
    assert_eq!(
        doors.collect::<Vec<_>>(),
        [
            ([0.0, 1.0], 90.0, 2.0, false, None),
            ([-1.0, 0.0], 0.0, 2.0, false, blue.clone()),
            ([-1.0, -1.0], 0.0, 2.0, true, None),
        ]
    );
    let key = world.objects.iter().find(|object| object.portable.is_some()).unwrap();
    assert_eq!((key.class.as_str(), &key.tag), ("key", &blue));
}

#[test]
fn what_is_not_known_is_said_once() {
    let (_, warnings) = World::from_dmlab_text("level.txt", "*****\n*P.G*\n*.?.*\n*****\n").unwrap();
    let said: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "level.txt:2:3 (/environment_params/layout/text): the letter '.' is not known (3 of it, this one first); it is read as floor",
            "level.txt:3:3 (/environment_params/layout/text): the letter '?' is not known; it is read as floor",
        ]
    );
}

#[test]
fn a_text_that_is_no_map_is_refused() {
    let text = "Dear all,\nhere is the map that I promised.\n";
    let read = [
        World::from_dmlab_text("letter.txt", text),
        World::from_minigrid_text("letter.txt", text),
    ];
    for error in read.map(|read| read.unwrap_err().to_string()) {
        assert!(
            error.starts_with("letter.txt:1:1 (/): found ") && error.contains("signs that are not known"),
            "{error}"
        );
        assert!(error.contains("expected "), "{error}");
    }
    // What stands above a grid in MiniGrid's own output.
    for name in [
        "<DoorKeyEnv<MiniGrid-DoorKey-5x5-v0>>",
        "<GoToLocal<BabyAI-GoToLocal-v0>>",
    ] {
        let grid = format!("{name}\nWGWGWG\nWG>>WG\nWGWGWG\n");
        let (world, warnings) = World::from_minigrid_text("grid.txt", &grid).unwrap();
        assert_eq!((world.plan().unwrap().lattice, warnings.len()), ([3, 3], 0));
    }
}

/// Keys of several colours each have a letter, and their doors find them.
#[test]
fn keys_of_several_colours_are_of_several_groups() {
    let grid = "WGWGWGWGWGWG\nWG>>KRKBKR  WG\nWGWGWGWGWGWG\n";
    let (world, _) = World::from_minigrid_text("grid.txt", grid).unwrap();
    let plan = world.plan().unwrap();
    let layout = world.environment_params.layout.as_ref().unwrap();
    for object in world.objects.iter().filter(|object| object.portable.is_some()) {
        let letter = plan.cells[plan.cell_at(object.coordinates).unwrap()].letter.unwrap();
        let group = Legend::Group(object.tag.clone().unwrap());
        assert_eq!(layout.legend.get(&letter.to_string()), Some(&group), "{letter}");
    }
    assert_eq!(layout.legend.len(), 2);
}

#[test]
fn a_text_without_floor_is_refused() {
    for text in ["", "\n\n", "***\n***\n"] {
        let error = World::from_dmlab_text("level.txt", text).unwrap_err().to_string();
        assert!(error.starts_with("level.txt") && error.contains("expected"), "{error}");
    }
}

proptest! {
    /// Every thing stands where its letter stands, and the agent in a free cell.
    #[test]
    fn things_stand_at_their_letters(rows in prop::collection::vec("[*PGA IH?]{1,12}", 1..10)) {
        let text = rows.join("\n");
        let Ok((world, _)) = World::from_dmlab_text("drawn", &text) else {
            let num = |letters: &str| text.chars().filter(|letter| letters.contains(*letter)).count();
            prop_assert!(!text.contains([' ', 'P', 'G', 'A', 'I', 'H', '?']) || num("?") > num("*PGAIH"));
            return Ok(());
        };
        let plan = world.plan().unwrap();
        let count = |letter: char| text.chars().filter(|other| *other == letter).count();
        prop_assert_eq!(world.objects.len(), "GAIH".chars().map(count).sum::<usize>());
        for object in &world.objects {
            let cell = plan.cell_at(object.coordinates).map(|cell| plan.cells[cell]);
            if object.door.is_some() {
                prop_assert!(matches!(cell.and_then(|cell| cell.letter), Some('I' | 'H')));
                continue;
            }
            let letter = if object.tag.as_deref() == Some("goal") { 'G' } else { 'A' };
            prop_assert_eq!(cell.and_then(|cell| cell.letter), Some(letter));
        }
        prop_assert!(plan.cell_at(world.agent_params.coordinates).is_some() || count('P') + count(' ') + count('?') + count('I') + count('H') == 0);
    }
}
