//! Tests `driftworld distance`, `order` and `curriculum` with each measure of distance.

use super::run_files::write;
use super::terminal::{Says, json, json_in, scratch, succeed_in};

#[test]
fn pictures_distinguish_visible_changes_only() {
    let folder = scratch();
    for (name, ground, reward) in [
        ("green.json", "[0.3, 0.5, 0.2]", "1.0"),
        ("paying.json", "[0.3, 0.5, 0.2]", "9.0"),
        ("sand.json", "[0.8, 0.7, 0.4]", "1.0"),
    ] {
        let json = format!(
            r#"{{ "environment_params": {{ "ground_color": {ground} }},
                "objects": [{{ "class": "tree", "coordinates": [0.0, 5.0], "reward": {reward} }}] }}"#
        );
        write(&folder.path().join(name), &json);
    }
    for by in ["pictures", "pictures:whole", "pictures:structure"] {
        let from_green = |to: &str| json_in(folder.path(), &format!("distance green.json {to} --by {by} --json"));
        assert_eq!(
            from_green("paying.json")["total"],
            0.0,
            "{by}: a tree's reward is invisible"
        );
        let other = from_green("sand.json");
        assert!(other["total"].as_f64() > Some(0.01), "{other}");
        assert_eq!(
            (&other["by"], &other["compared"]),
            (&by.into(), &format!("by {by}").into())
        );
    }
    let stdout = succeed_in(folder.path(), "distance green.json sand.json --by pictures --explain");
    stdout.says("looks of surroundings");
    stdout.says("oklab, elsewhere");
}

#[test]
fn every_measure_has_a_name_for_the_command() {
    for by in driftworld::distances::By::names() {
        // With bisimulation, a whole meadow takes seconds; the library's tests use a small one.
        if *by == "dynamics:bisimulation" {
            continue;
        }
        let found = json(&format!(
            "distance find_objects#red penalty --by {by} --worlds 1 --json"
        ));
        assert_eq!(found["by"], *by);
        let total = found["total"].as_f64().expect("it is a number");
        let of_rewards = "parameters worlds rewards dynamics behavior behavior:success";
        let is_of_rewards = of_rewards.split(' ').any(|name| name == *by);
        assert_eq!(
            total > 0.0,
            is_of_rewards,
            "{by}: red and penalty differ only in rewards, found {total}"
        );
    }
}

#[test]
fn order_and_curriculum_accept_the_same_names() {
    let order = json("order find_objects#red blue penalty --by behavior --worlds 2 --json");
    assert_eq!(order["by"], "behavior");
    let values = &order["matrix"]["values"][0];
    assert_eq!(values[1], 0.0, "red and blue require the same behaviour");
    assert!(values[2].as_f64() > Some(0.0));
    let designed = json("curriculum find_objects#red blue penalty --by rewards --worlds 0");
    assert!(
        designed["blocks"].as_array().is_some_and(|blocks| blocks.len() > 3),
        "{designed}"
    );
}

#[test]
fn shares_divide_distances_by_the_tasks_diameter() {
    let between = |scale: &str| json(&format!("distance find_objects#red dusk --scale {scale} --json"));
    let (units, share) = (between("units"), between("share"));
    let description = share["compared"].as_str().expect("the output describes the comparison");
    let (_, diameter) = description.split_once("diameter of ").expect("the diameter is printed");
    let diameter: f64 = diameter.parse().expect("it is a number");
    let [units, share] = [units, share].map(|found| found["total"].as_f64().expect("it is a number"));
    assert!(
        units > 0.0 && (units / diameter - share).abs() < 1e-12,
        "{units} {share} {diameter}"
    );
}

#[test]
fn placements_are_measured_after_rejections() {
    let between = |a: &str, b: &str| {
        let found = json(&format!("distance {a} {b} --by placements --json"));
        found["total"].as_f64().expect("it is a number")
    };
    assert_eq!(between("find_objects#red", "find_objects#blue"), 0.0);
    assert!(between("find_objects#red", "find_objects#wide") > 0.0);
}

#[test]
fn comparison_of_methods_starts_as_each_method_alone_does() {
    let folder = scratch();
    for named in [
        "find_objects#red blue dusk penalty",
        "find_objects#red blue dusk --end blue",
        "find_objects",
    ] {
        let all = json_in(folder.path(), &format!("order {named} --compare --json"));
        for found in all
            .as_array()
            .expect("a list of methods")
            .iter()
            .filter(|found| found.get("error").is_none())
        {
            let method = found["method"].as_str().expect("each has a name");
            let alone = json_in(folder.path(), &format!("order {named} --order {method} --json"));
            assert_eq!(found["order"], alone["order"], "{named}: {method}");
        }
    }
}

#[test]
fn number_of_worlds_rules_out_parameters_in_orders_as_in_distances() {
    let folder = scratch();
    let order = json_in(folder.path(), "order find_objects#red dusk --worlds 2 --json");
    let distance = json_in(folder.path(), "distance find_objects#red dusk --worlds 2 --json");
    assert_eq!((&order["by"], &order["length"]), (&"worlds".into(), &distance["total"]));
}
