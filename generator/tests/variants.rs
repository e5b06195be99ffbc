//! Tests interpolated variants, variants at given distances, and named choices. `worlds.rs` tests worlds.

use std::sync::Arc;

use driftworld_generator::{Drift, GeneratorError, Sampler, Subject, Switch, at_distance, drift, sample};
use driftworld_spec::{Color, Distribution, DriftSchedule, Element, TaskSpec, Value, Variant};
use proptest::prelude::*;

const TASK: &str = r#"{
  "version": 2, "name": "t",
  "parameters": {
    "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 1 },
    "color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "blue", "white"], "default": "red" },
    "pay": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 },
    "count": { "role": "variant", "type": "integer", "affects": ["S"], "range": [0, 10], "default": 2 },
    "model": { "role": "variant", "type": "string", "affects": ["S"], "choices": ["1", "2", "3"], "default": "1", "switch_at": 0.25 },
    "solid": { "role": "variant", "type": "boolean", "affects": ["T"], "choices": [true, false], "default": true },
    "look": { "role": "variant", "type": "heading", "affects": ["S"], "range": [0, 360], "default": 350 },
    "scatter": { "role": "variant", "type": "distribution", "affects": ["S"], "choices": [
      { "disc": { "center": [0, 0], "radius": 5 } }, { "disc": { "center": [10, 0], "radius": 15 } },
      { "gaussian": { "mean": [0, 0], "std": 4 } }, { "gaussian": { "mean": [4, 0], "covariance": [[4, 1], [1, 9]] } }
    ], "default": { "disc": { "center": [0, 0], "radius": 5 } } },
    "steps": { "role": "randomized", "type": "number", "affects": ["R"], "distribution":
      { "uniform": { "low": { "param": "pay" }, "high": 200 } } }
  },
  "world": { "agent_params": { "heading": { "param": "look" } }, "rules": { "step_reward": { "param": "steps" } },
             "environment_params": { "light_intensity": { "param": "light" } } },
  "groups": [{ "name": "cubes", "count": { "param": "count" }, "placement": { "param": "scatter" },
               "object": { "class": "cube", "model": { "param": "model" }, "color": { "param": "color" },
                           "reward": { "param": "pay" }, "solid": { "param": "solid" } } }],
  "variants": {
    "a": {},
    "b": { "light": 3, "color": "blue", "pay": -100, "count": 5, "model": "3", "solid": false, "look": 30,
           "scatter": { "disc": { "center": [10, 0], "radius": 15 } } },
    "c": { "scatter": { "gaussian": { "mean": [0, 0], "std": 4 } } },
    "d": { "scatter": { "gaussian": { "mean": [4, 0], "covariance": [[4, 1], [1, 9]] } } }
  }
}"#;

fn task() -> Arc<TaskSpec> {
    TaskSpec::from_json("t.json", TASK).unwrap_or_else(|error| panic!("{error}"))
}

fn variant(name: &str) -> Variant {
    task().variant(name).unwrap_or_else(|error| panic!("{error}"))
}

fn between(from: &str, to: &str, t: f64) -> Variant {
    drift(&variant(from), &variant(to), t).unwrap_or_else(|error| panic!("{error}"))
}

fn number(variant: &Variant, name: &str) -> f64 {
    variant
        .value(name)
        .and_then(Value::as_number)
        .expect("the parameter is a number")
}

#[test]
fn numbers_interpolate_linearly_headings_the_short_way_and_integers_rounded() {
    let half = between("a", "b", 0.5);
    assert_eq!((number(&half, "light"), number(&half, "pay")), (2.0, 0.0));
    assert_eq!(number(&half, "look"), 10.0, "from 350 over north to 30");
    assert_eq!(half.value("count"), Some(&Value::Integer(4)));
    assert_eq!(half.name(), "a..b@0.5");
    let Some(Distribution::Disc { center, radius }) = half.distribution("scatter") else {
        panic!("two discs interpolate to a disc")
    };
    assert_eq!((center, radius), ([5.0, 0.0], 10.0));
    assert_eq!(
        half.distribution("steps"),
        Some(Distribution::Uniform { low: 0.0, high: 200.0 })
    );
    assert!(sample(&half, 1, 0).is_ok());
}

#[test]
fn colours_interpolate_in_oklab_and_may_leave_the_list_of_choices() {
    let half = between("a", "b", 0.5);
    let Some(Value::Color(Color([red, green, blue]))) = half.value("color") else {
        panic!("colours interpolate to a colour")
    };
    // The purple that CSS Color 4 defines as color-mix(in oklab, red, blue).
    for (found, expected) in [(red, 0.548_6), (green, 0.324_4), (blue, 0.635_4)] {
        assert!((found - expected).abs() < 0.002, "{found}, expected {expected}");
    }
}

#[test]
fn values_without_interpolation_switch_at_a_point_or_at_random() {
    assert_eq!(between("a", "b", 0.24).value("model"), Some(&Value::Text("1".into())));
    assert_eq!(between("a", "b", 0.25).value("model"), Some(&Value::Text("3".into())));
    assert_eq!(between("a", "b", 0.49).value("solid"), Some(&Value::Boolean(true)));
    let mixed = Drift::new(variant("a"), variant("b"))
        .expect("both belong to the same task")
        .with_switch(Switch::Mixture { seed: 3 });
    let num_switched = |progress| {
        let is_switched = |index: &u64| {
            let variant = mixed.at(progress, *index).expect("every variant of the drift is valid");
            variant.value("solid") == Some(&Value::Boolean(false))
        };
        (0..2000).filter(is_switched).count()
    };
    assert!((150..250).contains(&num_switched(0.1)) && (1350..1450).contains(&num_switched(0.7)));
}

#[test]
fn different_distributions_mix_and_gaussians_interpolate_their_covariance() {
    let Some(Distribution::Mixture { parts, weights }) = between("a", "c", 0.25).distribution("scatter") else {
        panic!("a disc and a Gaussian interpolate to a mixture")
    };
    assert_eq!((parts.len(), weights), (2, Some(vec![0.75, 0.25])));
    let covariance = between("c", "d", 0.5)
        .distribution("scatter")
        .and_then(|d| d.gaussian_covariance());
    assert_eq!(covariance, Some([[10.0, 0.5], [0.5, 12.5]]));
}

#[test]
fn drift_starts_and_ends_with_the_given_variants() {
    for schedule in [
        DriftSchedule::Linear,
        DriftSchedule::Cosine,
        DriftSchedule::Steps(3),
        DriftSchedule::Sawtooth(2),
    ] {
        let drift = Drift::new(variant("a"), variant("b"))
            .expect("both belong to the same task")
            .with_schedule(schedule);
        assert_eq!(
            drift.at(0.0, 0).expect("the start is valid").values(),
            variant("a").values()
        );
        assert_eq!(
            drift.at(1.0, 0).expect("the end is valid").values(),
            variant("b").values()
        );
    }
    let other = TaskSpec::from_json("u.json", r#"{ "name": "u" }"#).expect("a task needs only a name");
    let other = other.variant("default").expect("it always exists");
    assert!(matches!(
        Drift::new(variant("a"), other),
        Err(GeneratorError::DifferentTasks { .. })
    ));
}

/// A distance from a variant with a known shape: a weighted sum of changes in numbers relative to their ranges, plus 0.3 if the
/// colours differ.
fn distance(from: &Variant) -> impl Fn(&Variant) -> f64 + '_ {
    let parts = [("light", 4.0, 0.3), ("pay", 200.0, 0.2), ("count", 10.0, 0.2)];
    move |other| {
        let numbers: f64 = parts
            .iter()
            .map(|(name, range, weight)| weight * (number(from, name) - number(other, name)).abs() / range)
            .sum();
        let color = if from.value("color") == other.value("color") {
            0.0
        } else {
            0.3
        };
        numbers + color
    }
}

#[test]
fn variant_at_given_distance_changes_only_its_subject() {
    let a = variant("a");
    let found =
        at_distance(&a, &Subject::Element(Element::R), 0.1, 1e-9, distance(&a)).expect("half of the range of pay");
    assert!((number(&found.variant, "pay") - 0.0).abs() < 1e-5);
    let changed: Vec<&String> = found
        .variant
        .values()
        .iter()
        .filter(|(name, value)| a.value(name) != Some(*value))
        .map(|(name, _)| name)
        .collect();
    assert_eq!(changed, ["pay"]);
    let repeated =
        at_distance(&a, &Subject::Element(Element::R), 0.1, 1e-9, distance(&a)).expect("as in the first search");
    assert_eq!(repeated.variant.values(), found.variant.values());
    // Light alone cannot reach this distance, so the colour changes too and light makes up the rest.
    let combined = at_distance(&a, &Subject::Element(Element::O), 0.4, 1e-6, distance(&a)).expect("colour and light");
    assert!((combined.distance - 0.4).abs() <= 1e-6 && combined.variant.value("color") != a.value("color"));
}

#[test]
fn unreachable_distance_error_reports_the_nearest_one() {
    let a = variant("a");
    let far = at_distance(&a, &Subject::Element(Element::R), 0.9, 1e-3, distance(&a)).expect_err("pay is worth 0.2");
    let gap = at_distance(&a, &Subject::Parameters(vec!["color".into()]), 0.2, 1e-3, distance(&a))
        .expect_err("colours contribute 0 or 0.3");
    let none =
        at_distance(&a, &Subject::Element(Element::A), 0.2, 1e-3, distance(&a)).expect_err("no parameter affects A");
    insta::assert_snapshot!(format!("{far}\n{gap}\n{none}"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 64), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_reachable_distance_is_met(target in 0.0..0.7_f64) {
        let a = variant("a");
        let names = ["light", "pay", "color"].map(str::to_owned).to_vec();
        let found = at_distance(&a, &Subject::Parameters(names), target, 1e-6, distance(&a));
        prop_assert!((found.map_err(|error| TestCaseError::fail(error.to_string()))?.distance - target).abs() <= 1e-6);
    }

    #[test]
    fn every_variant_of_a_drift_can_be_sampled(t in 0.0..=1.0_f64, index in any::<u64>()) {
        for to in ["b", "c", "d"] {
            prop_assert!(sample(&between("a", to, t), 5, index).is_ok());
        }
    }
}

/// A task that names its choices draws the same worlds as one that lists their values.
#[test]
fn named_choices_draw_the_same_worlds_as_listed_ones() {
    let (open, maze) = (r#"{ "walls": [] }"#, r#"{ "maze": { "cells": [4, 4], "cell": 5 } }"#);
    let (near, far) = (
        r#"{ "disc": { "center": [0, 0], "radius": 5 } }"#,
        r#"{ "disc": { "center": [0, 0], "radius": 9 } }"#,
    );
    let (touch, reach) = (r#"["AgentCollide"]"#, r#"["AgentInRange"]"#);
    let task = |map: &str, place: &str, how: &str, [a, b, c]: [&str; 3], [d, e, f]: [&str; 3]| {
        let parameter = |kind: &str, choices: &str, default: &str| {
            format!(
                r#"{{ "role": "variant", "type": "{kind}", "affects": ["S"], "choices": {choices}, "default": {default} }}"#
            )
        };
        let (map, place, how) = (
            parameter("layout", map, a),
            parameter("distribution", place, b),
            parameter("json", how, c),
        );
        let text = format!(
            r#"{{ "version": 2, "name": "t", "parameters": {{ "map": {map}, "place": {place}, "how": {how} }},
                "world": {{ "environment_params": {{ "layout": {{ "param": "map" }} }} }},
                "groups": [{{ "name": "g", "count": 2, "placement": {{ "param": "place" }}, "keep_out": {{ "walls": 0, "agent": 0 }},
                    "object": {{ "class": "geometric", "reward_stimulus": {{ "param": "how" }} }} }}],
                "variants": {{ "first": {{}}, "second": {{ "map": {d}, "place": {e}, "how": {f} }}, "maps": {{ "grid": {{ "map": [{a}, {d}] }} }} }} }}"#
        );
        TaskSpec::from_json("t", &text).unwrap_or_else(|error| panic!("{error}"))
    };
    let listed = |a: &str, b: &str| format!("[{a}, {b}]");
    let named = |a: &str, b: &str| format!(r#"{{ "one": {a}, "two": {b} }}"#);
    let values = task(
        &listed(open, maze),
        &listed(near, far),
        &listed(touch, reach),
        [open, near, touch],
        [maze, far, reach],
    );
    let names = task(
        &named(open, maze),
        &named(near, far),
        &named(touch, reach),
        [r#""one""#; 3],
        [r#""two""#; 3],
    );
    for variant in ["first", "second"] {
        let world =
            |task: &std::sync::Arc<TaskSpec>| Sampler::new(&task.variant(variant).unwrap(), 3).world(5).unwrap();
        assert_eq!(world(&values), world(&names), "{variant}");
    }
    assert_eq!(names.variant_names(), ["first", "second", "maps-one", "maps-two"]);
    let second = names.variant("second").unwrap();
    for (name, parameter) in names.parameters() {
        assert_eq!(parameter.name_of(second.value(name).unwrap()), Some("two"), "{name}");
    }
    let reread = TaskSpec::from_json("again", &names.to_json()).unwrap();
    assert_eq!(reread.to_json(), names.to_json());
}

#[test]
fn errors_in_named_choices_quote_the_names() {
    let error_for = |kind: &str, choices: &str, default: &str, value: &str| {
        let text = format!(
            r#"{{ "version": 2, "name": "t", "parameters": {{ "p": {{ "role": "variant", "type": "{kind}", "affects": ["S"],
                "choices": {choices}, "default": {default} }} }}, "variants": {{ "v": {{ "p": {value} }} }} }}"#
        );
        TaskSpec::from_json("t", &text).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let maps = r#"{ "open": { "walls": [] }, "maze": { "maze": { "cells": [4, 4] } } }"#;
    assert_eq!(error_for("layout", maps, r#""open""#, r#""maze""#), "");
    assert!(
        error_for("layout", maps, r#""open""#, r#""maize""#)
            .contains(r#"(/variants/v/p): found "maize", expected one of open, maze; did you mean "maze"?"#)
    );
    assert!(error_for("layout", maps, r#""opn""#, r#""maze""#).contains("(/parameters/p/default): found \"opn\""));
    let misspelt = maps.replace("cells", "cel");
    assert!(
        error_for("layout", &misspelt, r#""open""#, r#""maze""#)
            .contains("(/parameters/p/choices/maze/maze/cel): found the unknown key")
    );
    assert!(error_for("number", r#"{ "one": 1 }"#, "1", "1").contains("(/parameters/p/choices): found"));
}
