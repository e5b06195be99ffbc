//! Maps of other programs, read as worlds: their walls, their things, and what is said of what did not pass.

use driftworld_spec::World;
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
    assert_eq!(tags, ["key", "goal", "lava", "ball"]);
    let said: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(said.join("\n"));
    World::from_json("again", &world.to_json()).unwrap();
}

#[test]
fn a_text_without_floor_is_refused() {
    for text in ["", "\n\n", "***\n***\n"] {
        let error = World::from_dmlab_text("level.txt", text).unwrap_err().to_string();
        assert!(error.contains("expected"), "{error}");
    }
}

proptest! {
    /// Every thing stands where its letter stands, and the agent in a free cell.
    #[test]
    fn things_stand_at_their_letters(rows in prop::collection::vec("[*PGA IH?]{1,12}", 1..10)) {
        let text = rows.join("\n");
        let Ok((world, _)) = World::from_dmlab_text("drawn", &text) else {
            prop_assert!(!text.contains([' ', 'P', 'G', 'A', 'I', 'H', '?']));
            return Ok(());
        };
        let plan = world.plan().unwrap();
        let count = |letter: char| text.chars().filter(|other| *other == letter).count();
        prop_assert_eq!(world.objects.len(), count('G') + count('A'));
        for object in &world.objects {
            let cell = plan.cell_at(object.coordinates).map(|cell| plan.cells[cell]);
            let letter = if object.tag.as_deref() == Some("goal") { 'G' } else { 'A' };
            prop_assert_eq!(cell.and_then(|cell| cell.letter), Some(letter));
        }
        prop_assert!(plan.cell_at(world.agent_params.coordinates).is_some() || count('P') + count(' ') + count('?') + count('I') + count('H') == 0);
    }
}
