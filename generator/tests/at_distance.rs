//! Tests of the search for variants at a given distance when requirements cut off parts of the ranges: it finds every distance
//! that a grid search of the allowed region finds.

use std::sync::Arc;

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_spec::{TaskSpec, Variant};
use proptest::prelude::*;

/// Tolerance for distances found by the search.
const TOLERANCE: f64 = 1e-3;

/// A task of numbers in 0..1 with requirements on them, and a variant with the default values.
#[derive(Clone, Debug)]
struct Case {
    defaults: Vec<f64>,
    require: Vec<String>,
    /// Whether the distance is the mean of the differences; otherwise it is their maximum.
    is_mean: bool,
}

const NAMES: [&str; 3] = ["a", "b", "c"];

impl Case {
    fn task(&self) -> Option<Arc<TaskSpec>> {
        let parameters: Vec<String> = self.defaults.iter().zip(NAMES).map(|(default, name)| {
            format!(
                r#""{name}": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [0, 1], "default": {default} }}"#
            )
        }).collect();
        // The debug output of a list of plain strings is valid JSON.
        let require = format!("{:?}", self.require);
        let text = format!(
            r#"{{ "name": "t", "parameters": {{ {} }}, "require": {require}, "variants": {{ "here": {{}} }} }}"#,
            parameters.join(", ")
        );
        // If the defaults violate a requirement, there is no variant to start from.
        TaskSpec::from_json("t", &text).ok()
    }

    fn values(variant: &Variant, axes: usize) -> Vec<f64> {
        let value = |name: &&str| {
            variant
                .value(name)
                .and_then(driftworld_spec::Value::as_number)
                .expect("the parameter is a number")
        };
        NAMES[..axes].iter().map(value).collect()
    }

    fn distance(&self, to: &[f64]) -> f64 {
        let difference = self.defaults.iter().zip(to).map(|(a, b)| (a - b).abs());
        if self.is_mean {
            difference.sum::<f64>() / self.defaults.len() as f64
        } else {
            difference.fold(0.0, f64::max)
        }
    }

    /// The distances of all allowed points of a grid.
    fn on_a_grid(&self, from: &Variant, parts: usize) -> Vec<f64> {
        let axes = self.defaults.len();
        let mut found = Vec::new();
        for number in 0..(parts + 1).pow(axes as u32) {
            let digit = |axis: usize| number / (parts + 1).pow(axis as u32) % (parts + 1);
            let point: Vec<f64> = (0..axes).map(|axis| digit(axis) as f64 / parts as f64).collect();
            let changes = point
                .iter()
                .zip(NAMES)
                .map(|(x, name)| (name.to_owned(), driftworld_spec::Value::Number(*x)));
            if from.with("grid", changes).is_ok() {
                found.push(self.distance(&point));
            }
        }
        found
    }
}

/// A requirement on two of the numbers and a constant.
fn requirement(axes: usize) -> impl Strategy<Value = String> {
    (0..axes, 0..axes, 0.05_f64..0.95, 0..7).prop_map(|(a, b, x, form)| {
        let (a, b) = (NAMES[a], NAMES[b]);
        match form {
            0 => format!("{a} <= {b}"),
            1 => format!("{a} + {b} <= {}", 2.0 * x),
            2 => format!("{a} + {b} >= {x}"),
            3 => format!("abs({a} - {b}) <= {x}"),
            4 => format!("{a} < {x} or {b} < {x}"),
            5 => format!("{a} * {b} <= {x}"),
            _ => format!("({a} - {x}) * ({a} - {x}) + ({b} - 0.5) * ({b} - 0.5) <= 0.5"),
        }
    })
}

fn case() -> impl Strategy<Value = Case> {
    (1_usize..4).prop_flat_map(|axes| {
        let defaults = prop::collection::vec((0_u32..=20).prop_map(|k| f64::from(k) / 20.0), axes);
        let require = prop::collection::vec(requirement(axes), 1..4);
        (defaults, require, any::<bool>()).prop_map(|(defaults, require, is_mean)| Case {
            defaults,
            require,
            is_mean,
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 120)))]

    #[test]
    fn every_distance_of_a_grid_of_allowed_points_is_found(case in case(), which in any::<prop::sample::Index>()) {
        let Some(task) = case.task() else { return Ok(()) };
        let from = task.variant("here").expect("the task declares it");
        let axes = case.defaults.len();
        let grid = case.on_a_grid(&from, [40, 12, 8][axes - 1]);
        if grid.is_empty() {
            return Ok(());
        }
        let farthest = grid.iter().copied().fold(0.0, f64::max);
        let names: Vec<String> = NAMES[..axes].iter().map(|name| (*name).to_owned()).collect();
        for target in [*which.get(&grid), farthest] {
            let found = at_distance(&from, &Subject::Parameters(names.clone()), target, TOLERANCE, |other| {
                case.distance(&Case::values(other, axes))
            });
            let found = found.map_err(|error| TestCaseError::fail(format!("{error}; the grid has {target}")))?;
            let values = Case::values(&found.variant, axes);
            prop_assert!((case.distance(&values) - target).abs() <= TOLERANCE);
        }
    }
}

#[test]
fn line_cut_off_by_a_requirement_is_followed_to_its_border() {
    let text = r#"{ "name": "chase", "require": ["wolf_speed < agent_speed"], "variants": { "calm": {} }, "parameters": {
        "wolf_speed": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 10], "default": 1 },
        "agent_speed": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 10], "default": 5 } } }"#;
    let task = TaskSpec::from_json("chase", text).unwrap();
    let from = task.variant("calm").unwrap();
    let number =
        |variant: &Variant, name: &str| variant.value(name).and_then(driftworld_spec::Value::as_number).unwrap();
    let distance = |other: &Variant| {
        let difference = |name: &str| (number(&from, name) - number(other, name)).abs() / 10.0;
        f64::midpoint(difference("wolf_speed"), difference("agent_speed"))
    };
    let subject = Subject::Element(driftworld_spec::Element::T);
    // With the agent at 10 and the wolf just below, the distance approaches (0.9 + 0.5) / 2 without reaching it.
    for target in [0.05, 0.25, 0.3, 0.45, 0.6, 0.699] {
        let found =
            at_distance(&from, &subject, target, 1e-4, distance).unwrap_or_else(|error| panic!("{target}: {error}"));
        assert!(number(&found.variant, "wolf_speed") < number(&found.variant, "agent_speed"));
        assert!((found.distance - target).abs() <= 1e-4, "{target}: {}", found.distance);
    }
    let error = at_distance(&from, &subject, 0.9, 1e-4, distance).unwrap_err();
    let GeneratorError::TooFar { farthest, .. } = &error else {
        panic!("{error}")
    };
    assert!((farthest - 0.7).abs() < 1e-6, "{error}");
}

#[test]
fn forbidden_variant_is_never_found() {
    let text = r#"{ "name": "t", "require": ["good != bad", "distance(good, bad) >= 0.2"], "variants": { "base": {} }, "parameters": {
        "good": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "green", "crimson"], "default": "green" },
        "bad": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "green", "blue"], "default": "red" } } }"#;
    let task = TaskSpec::from_json("t", text).unwrap();
    let from = task.variant("base").unwrap();
    let changed = |other: &Variant| {
        let is_other = |name: &str| f64::from(u8::from(from.value(name) != other.value(name)));
        f64::midpoint(is_other("good"), is_other("bad"))
    };
    let subject = Subject::Element(driftworld_spec::Element::O);
    let found = at_distance(&from, &subject, 0.5, 0.01, changed).unwrap().variant;
    // Green and green, and crimson and red, are too similar; so the search can only make the bad ones blue.
    assert_eq!(found.value("bad").unwrap().to_string(), "blue");
    assert_eq!(found.value("good").unwrap().to_string(), "green");
}
