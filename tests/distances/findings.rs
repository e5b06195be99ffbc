//! Regression tests for bugs in distances by parameters that an audit found. Each comment states the former, wrong result.

use std::sync::Arc;

use driftworld::generator::{Subject, at_distance};
use driftworld::similarity::Distance;
use driftworld::spec::{DEFAULT_VARIANT, Element, TaskSpec, Value, Variant};
use driftworld::tasks;
use serde_json::{Value as Json, json};

use super::laws_by_parameters::measure;

fn load(task: &Json) -> Arc<TaskSpec> {
    TaskSpec::from_json("t", &task.to_string()).unwrap_or_else(|error| panic!("{error}"))
}

fn named(task: &Arc<TaskSpec>, name: &str) -> Variant {
    task.variant(name).unwrap_or_else(|error| panic!("{error}"))
}

fn between(task: &Arc<TaskSpec>, a: &str, b: &str) -> Distance {
    let found = measure(task).between(&named(task, a), &named(task, b));
    found.unwrap_or_else(|error| panic!("{error}"))
}

fn built_in(name: &str) -> Variant {
    tasks::variant(name).unwrap_or_else(|error| panic!("{error}"))
}

fn distance(a: &Variant, b: &Variant) -> f64 {
    measure(a.task())
        .between(a, b)
        .unwrap_or_else(|error| panic!("{error}"))
        .total
}

/// An unused parameter with equal values changed 0.1194 into 0.0895. Four randomized parameters besides one with a reversed sign
/// turned an R of 1.0 into 0.2.
#[test]
fn equal_parameters_do_not_dilute_the_distance() {
    let mut task = json!({ "name": "t", "parameters": {
        "pay": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 } },
        "variants": { "a": {}, "b": { "pay": -100 } } });
    for index in 0..4 {
        task["parameters"][format!("drawn_{index}")] = json!({
            "role": "randomized", "type": "number", "affects": ["R"],
            "distribution": { "normal": { "mean": 0, "std": 1 } } });
        task["parameters"][format!("idle_{index}")] = json!({
            "role": "variant", "type": "number", "affects": ["R"], "range": [0, 1], "default": 0 });
        let found = between(&load(&task), "a", "b");
        assert_eq!((found.total, found.element(Element::R)), (1.0, Some(1.0)));
    }
}

/// The distance of two normal distributions with means 0 and 1 was 0.143, and 0.001 as soon as a third variant had a mean of
/// 1000.
#[test]
fn scale_depends_on_declarations_and_not_on_other_variants() {
    let mut task = json!({ "name": "t", "parameters": {
        "mean": { "role": "variant", "type": "number", "affects": ["S"], "range": [0, 1000], "default": 0 },
        "x": { "role": "randomized", "type": "number", "affects": ["S"],
               "distribution": { "normal": { "mean": { "param": "mean" }, "std": 3 } } } },
        "variants": { "a": {}, "b": { "mean": 1 } } });
    assert!((between(&load(&task), "a", "b").total - 1e-3).abs() < 1e-12);
    task["variants"]["far"] = json!({ "mean": 1000 });
    assert!((between(&load(&task), "a", "b").total - 1e-3).abs() < 1e-12);
    assert!((between(&load(&task), "a", "far").total - 1.0).abs() < 1e-12);
}

/// As above, if the defaults break a requirement: the feasible ends were then computed for the document's first variant, so that
/// the distance of a pair depended on which variant comes first.
#[test]
fn scale_does_not_depend_on_the_first_variant_if_defaults_break_a_requirement() {
    let task = |variants: Json| {
        load(&json!({ "name": "t", "parameters": {
            "most": { "role": "variant", "type": "number", "affects": ["S"], "range": [1, 10], "default": 1 },
            "high": { "role": "variant", "type": "number", "affects": ["S"], "range": [1, 10], "default": 5 },
            "x": { "role": "randomized", "type": "number", "affects": ["S"],
                   "distribution": { "uniform": { "low": 0, "high": { "param": "high" } } } } },
            "require": ["high <= most"], "variants": variants }))
    };
    let (a, b) = (json!({ "most": 10, "high": 2 }), json!({ "most": 5, "high": 3 }));
    let first = between(&task(json!({ "a": a, "b": b })), "a", "b");
    let second = between(&task(json!({ "b": b, "a": a })), "a", "b");
    assert_eq!(first.total, second.total);
    let drawn = first
        .parts
        .iter()
        .find(|part| part.name == "x")
        .expect("it is compared");
    assert!((drawn.normalised - 1.0 / 9.0).abs() < 1e-12, "{drawn:#?}");
}

/// As above, if a distribution depends on a component of a vector, or on a choice: these ends were ignored, so that 1 was a
/// metre, or the width at the default.
#[test]
fn scale_covers_everything_that_a_distribution_reads() {
    let uniform = |high: Json| json!({ "uniform": { "low": 0, "high": high } });
    let parts = |task: Json, a: &str, b: &str| {
        let found = between(&load(&task), a, b);
        found
            .parts
            .iter()
            .map(|part| (part.name.clone(), part.normalised))
            .collect::<Vec<_>>()
    };
    let by_vector = json!({ "name": "t", "parameters": {
        "sizes": { "role": "variant", "type": "vector", "affects": ["S"], "range": [0, 40], "default": [4, 4] },
        "x": { "role": "randomized", "type": "number", "affects": ["S"],
               "distribution": { "uniform": { "low": -1, "high": { "param": "sizes", "index": 1 } } } } },
        "variants": { "a": { "sizes": [7, 0] }, "b": { "sizes": [3, 40] } } });
    assert_eq!(parts(by_vector, "a", "b"), [("x".to_owned(), 1.0)]);
    let by_choice = json!({ "name": "t", "parameters": {
        "high": { "role": "variant", "type": "number", "affects": ["S"], "range": [1, 101], "default": 4 },
        "law": { "role": "variant", "type": "distribution", "affects": ["S"], "default": uniform(json!({ "param": "high" })),
                 "choices": [uniform(json!({ "param": "high" })), uniform(json!(3))] } },
        "variants": { "a": { "high": 101 }, "b": { "high": 1 }, "c": { "high": 1, "law": uniform(json!(3)) },
                      "d": { "high": 9, "law": uniform(json!(3)) } } });
    assert_eq!(parts(by_choice.clone(), "a", "b"), [("law".to_owned(), 1.0)]);
    assert_eq!(parts(by_choice, "c", "d"), [("law".to_owned(), 0.0)]);
}

/// A suspected bug: among more than 24 distributions, the search for the widest pair starts at the first one.
#[test]
fn scale_does_not_depend_on_the_order_of_parameters() {
    let task = |is_reversed: bool| {
        let ends = ["a", "b", "c", "d", "e"];
        let mut names = ends.to_vec();
        if is_reversed {
            names.reverse();
        }
        let mut parameters = serde_json::Map::new();
        for (index, name) in names.iter().enumerate() {
            let rank = ends.iter().position(|end| end == name).unwrap_or(index) as f64;
            let range = [rank * rank - 3.0, rank * rank + 1.0 + rank];
            let one =
                json!({ "role": "variant", "type": "number", "affects": ["S"], "range": range, "default": range[0] });
            parameters.insert((*name).to_owned(), one);
        }
        let part = |mean: &str| json!({ "normal": { "mean": { "param": mean }, "std": 0.5 } });
        parameters.insert(
            "x".to_owned(),
            json!({ "role": "randomized", "type": "number", "affects": ["S"],
            "distribution": { "mixture": { "parts": ends.map(part), "weights": [1, 2, 3, 1, 2] } } }),
        );
        load(&json!({ "name": "t", "parameters": parameters, "variants": { "v": {}, "w": { "a": 1, "d": 13 } } }))
    };
    assert_eq!(
        between(&task(false), "v", "w").total,
        between(&task(true), "v", "w").total
    );
}

/// `vary find_objects#blue --element T --distance 0.5` printed `reach 20, hold 10`, although `reach` has no effect on objects
/// that are triggered by contact. 15 of 125 results for built-in variants had the same fault.
#[test]
fn unread_parameters_make_no_distance() {
    let from = built_in("find_objects#blue");
    let measured = measure(from.task());
    let in_transition = |other: &Variant| {
        let found = measured.between(&from, other).unwrap_or_else(|error| panic!("{error}"));
        found.element(Element::T).unwrap_or(0.0)
    };
    let found = at_distance(&from, &Subject::Element(Element::T), 0.5, 1e-3, in_transition);
    let found = found.unwrap_or_else(|error| panic!("{error}")).variant;
    let changed = |name: &&String| found.value(name) != from.value(name);
    for name in found.values().keys().filter(changed) {
        assert!(found.reads(name) || from.reads(name), "{name}");
    }
    let moved = |name: &str, changes: &[(&str, f64)]| {
        let base = built_in(name);
        let changes = changes
            .iter()
            .map(|(name, value)| ((*name).to_owned(), Value::Number(*value)));
        let moved = base.with("moved", changes).unwrap_or_else(|error| panic!("{error}"));
        distance(&base, &moved)
    };
    assert_eq!(moved("find_objects#blue", &[("reach", 20.0)]), 0.0);
    assert!(moved("find_objects#near", &[("reach", 20.0)]) > 0.0);
    assert_eq!(moved("get_to_goal#plain", &[("hazard_reward", -90.0)]), 0.0);
    assert_eq!(moved("get_to_goal#plain", &[("goal_speed", 6.0)]), 0.0);
    assert_eq!(moved("select_object", &[("drift", 4.0)]), 0.0);
}

/// As above, through a distribution: a parameter declared idle counted through its effect on the distribution.
#[test]
fn unread_parameters_do_not_count_through_distributions() {
    let task = load(&json!({ "name": "t", "parameters": {
        "moves": { "role": "variant", "type": "boolean", "affects": ["T"], "choices": [false, true], "default": false },
        "fastest": { "role": "variant", "type": "number", "affects": ["T"], "range": [1, 9], "default": 1, "read_if": "moves" },
        "speed": { "role": "randomized", "type": "number", "affects": ["T"],
                   "distribution": { "uniform": { "low": 0, "high": { "param": "fastest" } } } } },
        "variants": { "a": {}, "b": { "fastest": 9 }, "c": { "moves": true }, "d": { "moves": true, "fastest": 9 } } }));
    assert_eq!(between(&task, "a", "b").total, 0.0);
    assert!((between(&task, "c", "d").total - 1.0).abs() < 1e-12);
    assert!((between(&task, "b", "d").total - 2.0).abs() < 1e-12);
}

/// `compare.measure` of a placement accepted five names, and all of them gave planar Wasserstein-2.
#[test]
fn declared_measure_of_a_placement_is_used_or_refused() {
    let text = |name: &str| {
        let disc = |radius: f64| json!({ "disc": { "center": [0, 0], "radius": radius } });
        let gaussian = json!({ "gaussian": { "mean": [3, 0], "std": 1 } });
        json!({ "name": "t", "parameters": { "where": { "role": "variant", "type": "distribution", "affects": ["S"],
            "choices": [disc(9.0), gaussian], "default": disc(9.0), "compare": { "measure": name } } },
            "variants": { "a": {}, "b": { "where": gaussian } } })
        .to_string()
    };
    let raw = |name: &str| {
        let task = TaskSpec::from_json("t", &text(name)).unwrap_or_else(|error| panic!("{error}"));
        between(&task, "a", "b").parts[0].raw
    };
    assert!(raw("wasserstein_1") < raw("wasserstein_2"));
    assert_eq!(raw("same_or_not"), 1.0);
    for name in ["total_variation", "hellinger", "jensen_shannon"] {
        let error = TaskSpec::from_json("t", &text(name))
            .expect_err("the measure does not suit points")
            .to_string();
        assert!(
            error.contains("wasserstein_1, wasserstein_2, bures_wasserstein or same_or_not"),
            "{error}"
        );
    }
}

/// Some different distributions had distance 0 in a measure that claims to be a metric: points at least 1 m or 10 m apart, points
/// in turn or at random, shares that are extreme or nearly equal.
#[test]
fn different_distributions_have_a_distance_above_0() {
    let poisson =
        |distance: f64| json!({ "poisson_disc": { "low": [-20, -20], "high": [20, 20], "distance": distance } });
    let points = |order: &str| json!({ "points": { "values": [[0, 0], [3, 4], [9, 9]], "order": order } });
    let shares = |alpha: f64| json!({ "dirichlet": { "alpha": [alpha, alpha] } });
    let pairs = [
        (poisson(1.0), poisson(10.0)),
        (points("turn"), points("random")),
        (shares(0.01), shares(100.0)),
    ];
    for (a, b) in pairs {
        let task = load(
            &json!({ "name": "t", "parameters": { "law": { "role": "variant", "type": "distribution",
            "affects": ["S"], "choices": [a, b], "default": a } }, "variants": { "b": { "law": b } } }),
        );
        assert_eq!(between(&task, DEFAULT_VARIANT, "b").total, 1.0, "{a} and {b}");
        assert_eq!(between(&task, "b", "b").total, 0.0, "{b}");
    }
}
