//! `cargo xtask images`: draws the pictures of `docs/images` anew, each by the command that its page names.
//!
//! Which picture is made how stands in the two lists; a test compares them with the folder. Not here: `speed.svg`, which
//! `cargo xtask bench peers` draws, and a screenshot of a report.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{cargo, run};
use crate::workspace::Workspace;

/// The folder of the pictures.
const FOLDER: &str = "docs/images";

/// Pictures that are made elsewhere, and how.
#[cfg_attr(not(test), expect(dead_code, reason = "what is not made here is only listed"))]
const ORIGINS: [(&str, &str); 10] = [
    (
        "first-hour-berries.png",
        "docs/first-hour.md: DRIFTWORLD_UPDATE_PAGES=1 cargo test --test pages",
    ),
    (
        "first-hour-curriculum.png",
        "docs/first-hour.md: DRIFTWORLD_UPDATE_PAGES=1 cargo test --test pages",
    ),
    (
        "first-hour-empty.png",
        "docs/first-hour.md: DRIFTWORLD_UPDATE_PAGES=1 cargo test --test pages",
    ),
    (
        "first-hour-episode.png",
        "docs/first-hour.md: DRIFTWORLD_UPDATE_PAGES=1 cargo test --test pages",
    ),
    (
        "first-hour-order.png",
        "docs/first-hour.md: DRIFTWORLD_UPDATE_PAGES=1 cargo test --test pages",
    ),
    (
        "first-hour-report.png",
        "docs/first-hour.md: a browser's picture of its report",
    ),
    (
        "first-hour-variants.png",
        "docs/first-hour.md: DRIFTWORLD_UPDATE_PAGES=1 cargo test --test pages",
    ),
    ("first-hour.svg", "python book/record.py target/release/driftworld"),
    ("speed.svg", "cargo xtask bench peers PYTHON SCRIPTS"),
    (
        "report.png",
        "a browser's picture, 1060 pixels wide, of driftworld report on a log of examples/curricula/reward.json",
    ),
];

/// Each picture with the commands that make it: `{}` is its path, `{tmp}` an empty folder.
const IMAGES: &[(&str, &[&str])] = &[
    ("looks-sizes.png", &["render find_objects --view looks -o {}"]),
    ("models.png", &["assets show -o {}"]),
    (
        "demo.png",
        &[
            "sheet find_objects#blue find_objects#red find_objects#green find_objects#dusk find_objects#huddle \
          find_objects#penalty --seed 7 --size 200 -o {}",
        ],
    ),
    (
        "distances.png",
        &["demo -o {tmp}/demo", "cp {tmp}/demo/distances.png {}"],
    ),
    (
        "order.png",
        &[
            "order find_objects#blue find_objects#slim find_objects#held find_objects#long_held find_objects#half \
          find_objects#modest find_objects#poor find_objects#penalty find_objects#dusk find_objects#red \
          find_objects#green find_objects#slow find_objects#wide find_objects#stiff find_objects#spheres \
          find_objects#waypoints find_objects#huddle find_objects#clearing find_objects#interact find_objects#near \
          --method two-opt --start find_objects#blue --plot {}",
        ],
    ),
    (
        "distances-apart.png",
        &[
            "vary find_objects#red --element S --distance 0.05 --name at_0.05 -o {tmp}/apart.json",
            "vary {tmp}/apart.json#red --parameters light --distance 0.2 --name at_0.2 -o {tmp}/apart.json --force",
            "vary {tmp}/apart.json#red --parameters target_color --distance 1 --name at_1 -o {tmp}/apart.json --force",
            "vary {tmp}/apart.json#red --parameters target_color,target_model,light,agent_width --distance 3 --name at_3 \
             -o {tmp}/apart.json --force",
            "vary {tmp}/apart.json#red --element R --distance 1 --name unseen_1 -o {tmp}/apart.json --force",
            "sheet {tmp}/apart.json#red {tmp}/apart.json#at_0.05 {tmp}/apart.json#at_0.2 {tmp}/apart.json#at_1 \
             {tmp}/apart.json#at_3 {tmp}/apart.json#unseen_1 --seed 3 --size 150 -o {}",
        ],
    ),
    (
        "curriculum-timeline.png",
        &[
            "curriculum find_objects#blue find_objects#huddle find_objects#wide find_objects#clearing --probe state \
          --start find_objects#blue --order outward --learn 100 --eval-episodes 10 --name timeline -o {tmp}/timeline.json \
          --plot {}",
        ],
    ),
    (
        "curriculum-reward.png",
        &["sheet --scenario examples/curricula/reward.json --size 120 -o {}"],
    ),
    (
        "curriculum-state.png",
        &["sheet --scenario examples/curricula/state.json --size 120 -o {}"],
    ),
    (
        "curriculum-transition.png",
        &["sheet --scenario examples/curricula/transition.json --size 120 -o {}"],
    ),
    (
        "curriculum-observation.png",
        &["sheet --scenario examples/curricula/observation.json --size 120 -o {}"],
    ),
    (
        "curriculum-action.png",
        &["sheet --scenario examples/curricula/action.json --size 120 -o {}"],
    ),
    (
        "curriculum-blue_red_green.png",
        &["sheet --scenario examples/curricula/blue_red_green.json --size 120 -o {}"],
    ),
    (
        "curriculum-map.png",
        &["sheet --scenario examples/curricula/map.json --size 150 -o {}"],
    ),
    (
        "task-find_objects.png",
        &[
            "sheet find_objects#blue find_objects#spheres find_objects#dusk find_objects#huddle find_objects#penalty \
          find_objects#near find_objects#rooms find_objects#village --size 150 -o {}",
        ],
    ),
    (
        "task-get_to_goal.png",
        &[
            "sheet get_to_goal#plain get_to_goal#landmarks get_to_goal#hazards get_to_goal#bags get_to_goal#sphere \
          get_to_goal#wandering get_to_goal#craters get_to_goal#maze --size 150 -o {}",
        ],
    ),
    (
        "task-select_object.png",
        &[
            "sheet select_object#green select_object#red select_object#bandit select_object#spheres select_object#dusk \
          select_object#drifting --size 150 -o {}",
        ],
    ),
    (
        "task-moving_object.png",
        &[
            "sheet moving_object#wandering moving_object#still moving_object#fast moving_object#shy moving_object#curious \
          moving_object#turned --size 150 -o {}",
        ],
    ),
    (
        "task-scavenger_hunt.png",
        &[
            "sheet scavenger_hunt#plain scavenger_hunt#landmarks scavenger_hunt#alike scavenger_hunt#huddle \
          scavenger_hunt#woods scavenger_hunt#village --size 150 -o {}",
        ],
    ),
    ("task-blue_red_green.png", &["sheet blue_red_green --size 150 -o {}"]),
    (
        "looks.png",
        &[
            "sheet find_objects#huddle find_objects#dusk examples/worlds/four_rooms.json#nine \
          examples/worlds/key_corridor.json#closed --size 160 -o {}",
        ],
    ),
    ("world-maze.png", &["sheet examples/worlds/maze.json --size 150 -o {}"]),
    (
        "world-four_rooms.png",
        &["sheet examples/worlds/four_rooms.json --size 150 -o {}"],
    ),
    (
        "world-t_maze.png",
        &["sheet examples/worlds/t_maze.json --size 150 -o {}"],
    ),
    (
        "world-key_corridor.png",
        &["sheet examples/worlds/key_corridor.json --size 150 -o {}"],
    ),
    (
        "world-locked_rooms.png",
        &["sheet examples/worlds/locked_rooms.json --size 150 -o {}"],
    ),
    (
        "world-switches.png",
        &["sheet examples/worlds/switches.json --size 150 -o {}"],
    ),
    (
        "world-put_next.png",
        &["sheet examples/worlds/put_next.json --size 150 -o {}"],
    ),
    (
        "world-lava_crossing.png",
        &["sheet examples/worlds/lava_crossing.json --size 150 -o {}"],
    ),
    (
        "world-foraging.png",
        &["sheet examples/worlds/foraging.json --size 150 -o {}"],
    ),
    ("world-hunt.png", &["sheet examples/worlds/hunt.json --size 150 -o {}"]),
    (
        "solved-key_corridor.png",
        &["render examples/worlds/key_corridor.json#closed --seed 5 --view episode --size 200 -o {}"],
    ),
];

/// Draws all pictures, or those whose names hold one of these words; by a command that is built already, or by one built now.
pub(crate) fn draw(workspace: &Workspace, command: Option<&Path>, words: &[String]) -> Result<(), XtaskError> {
    let command: PathBuf = if let Some(command) = command {
        command.to_owned()
    } else {
        run(cargo(workspace, &["build", "--release", "--bin", "driftworld"]))?;
        workspace
            .target
            .join("release")
            .join(format!("driftworld{}", std::env::consts::EXE_SUFFIX))
    };
    for (name, commands) in IMAGES {
        if !words.is_empty() && !words.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let folder = workspace.target.join("xtask-images").join(name);
        let error = |source| XtaskError::File {
            path: folder.clone(),
            source,
        };
        if folder.exists() {
            std::fs::remove_dir_all(&folder).map_err(error)?;
        }
        std::fs::create_dir_all(&folder).map_err(error)?;
        let path = format!("{FOLDER}/{name}");
        for line in *commands {
            let words = line.split_whitespace();
            let words: Vec<String> = words
                .map(|word| word.replace("{tmp}", &folder.to_string_lossy()).replace("{}", &path))
                .collect();
            if let [copy, from, to] = &words[..]
                && copy == "cp"
            {
                std::fs::copy(from, workspace.root.join(to)).map_err(error)?;
                continue;
            }
            let mut child = Command::new(&command);
            child.current_dir(&workspace.root).args(words);
            run(child)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every picture of the folder is made here or has an origin, and none is listed that is not there.
    #[test]
    fn every_picture_says_where_it_comes_from() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(FOLDER);
        let entries = std::fs::read_dir(folder).expect("the folder is there");
        let mut there: Vec<String> = entries
            .map(|entry| {
                entry
                    .expect("it can be read")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        there.sort();
        let made = IMAGES
            .iter()
            .map(|image| image.0)
            .chain(ORIGINS.iter().map(|origin| origin.0));
        let mut listed: Vec<String> = made.map(str::to_owned).collect();
        listed.sort();
        assert_eq!(there, listed);
        for (name, commands) in IMAGES {
            let last = commands.last().expect("each has commands");
            assert!(last.contains("{}"), "{name}");
        }
    }
}
