//! `driftworld convert --from`: maps of letters of other programs.

use std::fs;

use driftworld::env::{Agent, Environment, OnRailsAgent};

use crate::terminal::{driftworld, fail, output, scratch, succeed, text};

#[test]
fn a_map_of_letters_becomes_a_world_with_warnings_on_standard_error() {
    let folder = scratch();
    let level = folder.path().join("level.txt");
    let path = text(&level);
    fs::write(&level, "*****\n*PQG*\n*****\n").expect("the folder is there");
    let done = output(&mut driftworld(&["convert", path, "--from", "dmlab-text"]));
    assert!(done.status.success());
    let world = driftworld::spec::World::from_json("written", &String::from_utf8_lossy(&done.stdout));
    assert_eq!(world.expect("it is a world").objects.len(), 1);
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    let expected = ":2:3 (/environment_params/layout/text): the letter 'Q' is not known";
    assert!(said.contains(expected), "{said}");
    fs::write(&level, "WGWGWG\nWG>>WG\nWGWGWG\n").expect("the folder is there");
    assert!(succeed(&["convert", path, "--from", "minigrid-text"]).contains("\"#A#\""));
    fs::write(&level, "***\n").expect("the folder is there");
    let said = fail(1, &["convert", path, "--from", "dmlab-text"]);
    assert!(said.contains("a letter that is floor"), "{said}");
    fail(2, &["convert", path, "--from", "dmlab-text", "--seed", "3"]);
}

/// Opens the red door, fetches the blue key behind it, and unlocks the way to the goal; goes around lava.
#[test]
fn grids_of_minigrid_with_a_locked_door_and_with_lava_can_be_solved() {
    let folder = scratch();
    let grid = folder.path().join("grid.txt");
    let doors = "WGWGWGWGWG\nWG>>DRKBWG\nWGLBWGWGWG\nWG__WGGGWG\nWG      WG\nWGWGWGWGWG\n";
    let lava = "WGWGWGWGWG\nWG>>VR  WG\nWG  VR  WG\nWG    GGWG\nWGWGWGWGWG\n";
    for map in [doors, lava] {
        fs::write(&grid, map).expect("the folder is there");
        let written = succeed(&["convert", text(&grid), "--from", "minigrid-text"]);
        let world = driftworld::spec::World::from_json("written", &written).expect("it is a world");
        let mut environment = Environment::new(world);
        let mut agent = OnRailsAgent::new();
        agent.begin(0);
        let last = loop {
            let action = agent.act(&environment);
            let step = environment.step(action).expect("the agent's actions are sound");
            if step.ended() || environment.num_steps() > 2000 {
                break step;
            }
        };
        assert!(last.success, "{:?}", last.ended_by);
    }
}
