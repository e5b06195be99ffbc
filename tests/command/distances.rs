//! `driftworld distance`, `order` and `curriculum` by each measure.

use std::path::Path;

use serde_json::Value;

use super::terminal::{fail, scratch, succeed, text};

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&succeed(arguments)).expect("--json prints JSON")
}

#[test]
fn pictures_tell_apart_what_looks_different_and_nothing_else() {
    let folder = scratch();
    let world = |name: &str, ground: &str, reward: &str| {
        let path = folder.path().join(name);
        let json = format!(
            r#"{{ "environment_params": {{ "ground_color": {ground} }},
                "objects": [{{ "class": "tree", "coordinates": [0.0, 5.0], "reward": {reward} }}] }}"#
        );
        std::fs::write(&path, json).expect("the scratch folder can be written");
        path
    };
    let green = world("green.json", "[0.3, 0.5, 0.2]", "1.0");
    let paying = world("paying.json", "[0.3, 0.5, 0.2]", "9.0");
    let sand = world("sand.json", "[0.8, 0.7, 0.4]", "1.0");
    for by in ["pictures", "pictures:whole", "pictures:structure"] {
        let between = |a: &Path, b: &Path| json(&["distance", text(a), text(b), "--by", by, "--json"]);
        assert_eq!(
            between(&green, &paying)["total"],
            0.0,
            "{by}: what a tree pays cannot be seen"
        );
        let other = between(&green, &sand);
        assert!(other["total"].as_f64() > Some(0.01), "{other}");
        assert_eq!(
            (&other["by"], &other["compared"]),
            (&by.into(), &format!("by {by}").into())
        );
    }
    let said = succeed(&["distance", text(&green), text(&sand), "--by", "pictures", "--explain"]);
    assert!(
        said.contains("looks of surroundings") && said.contains("oklab, elsewhere"),
        "{said}"
    );
}

#[test]
fn every_measure_has_a_name_for_the_command() {
    let pair = ["find_objects#red", "find_objects#penalty"];
    for by in driftworld::distances::By::names() {
        // Whole meadows take seconds by bisimulation; the library's tests have a small one.
        if *by == "dynamics:bisimulation" {
            continue;
        }
        let found = json(&["distance", pair[0], pair[1], "--by", by, "--worlds", "1", "--json"]);
        assert_eq!(found["by"], *by);
        let total = found["total"].as_f64().expect("a number");
        let is_of_rewards = [
            "parameters",
            "worlds",
            "rewards",
            "dynamics",
            "behavior",
            "behavior:success",
        ]
        .contains(by);
        assert_eq!(
            total > 0.0,
            is_of_rewards,
            "{by}: red and penalty differ in what they pay alone, found {total}"
        );
    }
    let said = fail(2, &["distance", pair[0], pair[1], "--by", "looks"]);
    assert!(
        said.contains("found \"looks\", expected one of parameters, worlds"),
        "{said}"
    );
}

#[test]
fn order_and_curriculum_take_the_same_names() {
    let three = ["find_objects#red", "find_objects#blue", "find_objects#penalty"];
    let by_rewards = json(&[
        "order", three[0], three[1], three[2], "--by", "behavior", "--worlds", "2", "--json",
    ]);
    assert_eq!(by_rewards["by"], "behavior");
    assert_eq!(
        by_rewards["matrix"]["values"][0][1], 0.0,
        "red and blue ask for the same"
    );
    assert!(by_rewards["matrix"]["values"][0][2].as_f64() > Some(0.0));
    let said = fail(1, &["order", "find_objects#red", "get_to_goal#plain"]);
    assert!(
        said.contains("several tasks") && said.contains("dynamics or behavior"),
        "{said}"
    );
    let designed = json(&[
        "curriculum",
        three[0],
        three[1],
        three[2],
        "--by",
        "rewards",
        "--worlds",
        "0",
    ]);
    assert!(
        designed["blocks"].as_array().is_some_and(|blocks| blocks.len() > 3),
        "{designed}"
    );
    let said = fail(
        2,
        &["curriculum", "find_objects", "--by", "rewards", "--probe", "reward"],
    );
    assert!(said.contains("--by: found together with --probe"), "{said}");
}

#[test]
fn shares_are_of_the_tasks_diameter() {
    let between = |scale: &str| {
        json(&[
            "distance",
            "find_objects#red",
            "find_objects#dusk",
            "--scale",
            scale,
            "--json",
        ])
    };
    let (units, share) = (between("units"), between("share"));
    let said = share["compared"].as_str().expect("it says how");
    let (_, diameter) = said.split_once("diameter of ").expect("the diameter is printed");
    let diameter: f64 = diameter.parse().expect("it is a number");
    let [units, share] = [units, share].map(|found| found["total"].as_f64().expect("a number"));
    assert!(
        units > 0.0 && (units / diameter - share).abs() < 1e-12,
        "{units} {share} {diameter}"
    );
    let said = fail(
        1,
        &[
            "distance",
            "find_objects#red",
            "find_objects#dusk",
            "--scale",
            "share",
            "--by",
            "rewards",
        ],
    );
    assert!(said.contains("found rewards, as a share"), "{said}");
}

#[test]
fn placements_are_measured_as_they_come_out() {
    let between = |a: &str, b: &str| {
        let found = json(&["distance", a, b, "--by", "placements", "--json"]);
        found["total"].as_f64().expect("a number")
    };
    assert_eq!(between("find_objects#red", "find_objects#blue"), 0.0);
    assert!(between("find_objects#red", "find_objects#wide") > 0.0);
}
