//! Regression tests of bugs in distances that an audit of the command found. Comments give the former output.

use serde_json::Value;

use super::terminal::{fail, scratch, succeed, text};

/// The distance of the first two variants in a list, as measured by `order`.
fn first_two(list: &[&str], by: &[&str]) -> f64 {
    let folder = scratch();
    let path = folder.path().join("matrix.json");
    succeed(&[&["order"], list, by, &["--matrix", text(&path)]].concat());
    let matrix = std::fs::read_to_string(&path).expect("the matrix was written");
    let matrix: Value = serde_json::from_str(&matrix).expect("the matrix is JSON");
    assert_eq!([&matrix["labels"][0], &matrix["labels"][1]], [list[0], list[1]]);
    matrix["values"][0][1].as_f64().expect("it is a number")
}

/// blue–penalty was 0.2358 in a list with wide, and 0.0157 in a list with `get_to_goal#plain`: if a list had variants of a
/// second task, all pairs were silently measured by worlds.
#[test]
fn distance_of_a_pair_does_not_depend_on_the_list() {
    let pair = ["find_objects#blue", "find_objects#penalty"];
    let more = [&pair[..], &["find_objects#wide", "find_objects#near"]].concat();
    let many = [&pair[..], &["get_to_goal#plain", "find_objects#wide"]].concat();
    for (by, lists) in [("parameters", vec![&more]), ("worlds", vec![&more, &many])] {
        let by = ["--by", by];
        let stdout = succeed(&[&["distance"], &pair[..], &by, &["--json"]].concat());
        let stdout: Value = serde_json::from_str(&stdout).expect("it is JSON");
        let alone = first_two(&pair, &by);
        assert!(
            (stdout["total"].as_f64().expect("it is a number") - alone).abs() < 1e-12,
            "{stdout}"
        );
        for list in lists {
            assert_eq!(first_two(list, &by), alone, "{by:?}");
        }
    }
    assert_eq!(first_two(&more, &[]), first_two(&pair, &[]));
    let refused = fail(1, &[&["order"], &many[..]].concat());
    assert!(refused.contains("found variants of several tasks"), "{refused}");
    assert!(
        succeed(&[&["order"], &more[..]].concat()).contains(" by parameters"),
        "the output names the measure"
    );
    assert!(
        succeed(&[&["order"], &many[..], &["--by", "worlds"]].concat()).contains(" by worlds"),
        "the output names the measure"
    );
}

/// `vary find_objects#blue --element T --distance 0.5` answered `reach 20, hold 10`, but `reach` has no effect on objects that
/// are triggered by contact.
#[test]
fn unread_parameters_make_no_distance() {
    for (variant, element, idle) in [
        ("find_objects#blue", "T", "reach"),
        ("get_to_goal#plain", "R", "hazard_reward"),
    ] {
        let stdout = succeed(&["vary", variant, "--element", element, "--distance", "0.5", "--json"]);
        let found: Value = serde_json::from_str(&stdout).expect("it is JSON");
        let values = found["variant"]["found"].as_object().expect("the variant has values");
        assert!(
            found["held"].as_object().is_some_and(|held| !held.is_empty()),
            "{found}"
        );
        assert!(
            values.len() == 2 && values.contains_key("extends") && !values.contains_key(idle),
            "{stdout}"
        );
    }
}
