//! Tests the laws of distances by parameters on random specs.

use driftworld::similarity::{Distance, VariantMeasure, Weights};
use driftworld::spec::{DEFAULT_VARIANT, Element, TaskSpec, Variant};
use proptest::prelude::*;
use serde_json::{Map, Value as Json, json};
use std::sync::Arc;

use super::by_hand;
use super::drawn_specs::{NAMES, Spec, specs, variants};

pub(crate) fn measure(task: &Arc<TaskSpec>) -> VariantMeasure {
    VariantMeasure::new(task, Weights::of_task(task))
}

/// The total of a distance and its value in each element, without the parts, which depend on the list of parameters.
pub(crate) fn numbers(distance: &Distance) -> (f64, Vec<(Element, f64)>) {
    let elements = Element::ALL.map(|element| (element, distance.element(element).unwrap_or(0.0)));
    (distance.total, elements.to_vec())
}

/// Whether two distances are equal except for rounding, which depends on the order in which their parts were added.
pub(crate) fn are_close(a: &Distance, b: &Distance) -> bool {
    let ((a, mine), (b, theirs)) = (numbers(a), numbers(b));
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + a.abs());
    near(a, b) && mine.iter().zip(&theirs).all(|(a, b)| near(a.1, b.1))
}

/// The values of a variant parameter at the two ends of its domain.
fn ends(parameter: &Json) -> [Json; 2] {
    if let Some(choices) = parameter["choices"].as_array() {
        return [choices[0].clone(), choices[choices.len() - 1].clone()];
    }
    let end = |at: usize| {
        let end = parameter["range"][at].clone();
        if parameter["type"] == "vector" {
            json!([end, end, end])
        } else {
            end
        }
    };
    [end(0), end(1)]
}

/// The same task written differently: with other names, its parameters in reverse order, and further variants at the ends of all
/// declared ranges.
fn rewritten(spec: &Spec, a: &str, b: &str) -> Spec {
    let parameters = spec.0["parameters"].as_object().expect("it is an object");
    let mut low = Map::new();
    let mut high = Map::new();
    for (name, parameter) in parameters
        .iter()
        .filter(|(_, parameter)| parameter["role"] == "variant")
    {
        let [first, last] = ends(parameter);
        low.insert(name.clone(), first);
        high.insert(name.clone(), last);
    }
    let mut other = spec.clone();
    other.0["parameters"] = parameters
        .iter()
        .rev()
        .map(|(name, one)| (name.clone(), one.clone()))
        .collect();
    other.0["name"] = json!("rewritten");
    other.0["variants"] = json!({
        "low": low, "second": spec.set_by(b), "high": high, "first": spec.set_by(a), "none": {}
    });
    other
}

fn pairs(all: &[Variant]) -> impl Iterator<Item = (&Variant, &Variant)> {
    all.iter().flat_map(|a| all.iter().map(move |b| (a, b)))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 128), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn distance_is_the_documented_sum(spec in specs()) {
        let task = spec.task();
        let measure = measure(&task);
        for (a, b) in pairs(&variants(&task)) {
            let found = measure.between(a, b).expect("both belong to the same task");
            let expected = by_hand::distance(&spec, a.name(), b.name());
            prop_assert!((found.total - expected.total).abs() < 1e-9, "{found:#?} and {expected:?}");
            for element in Element::ALL {
                let expected = expected.elements.get(element.letter()).copied().unwrap_or(0.0);
                let found = found.element(element).unwrap_or(0.0);
                prop_assert!((found - expected).abs() < 1e-9, "{}: {found} and {expected}", element.name());
            }
        }
    }

    #[test]
    fn distance_depends_on_the_pair_alone(spec in specs(), a in prop::sample::select(NAMES.to_vec()), b in prop::sample::select(NAMES.to_vec())) {
        let (task, other) = (spec.task(), rewritten(&spec, a, b).task());
        let named = |task: &Arc<TaskSpec>, name: &str| task.variant(name).expect("it is declared");
        let first = measure(&task).between(&named(&task, a), &named(&task, b)).expect("both belong to the same task");
        let second = measure(&other).between(&named(&other, "first"), &named(&other, "second")).expect("both belong to the same task");
        prop_assert!(are_close(&first, &second), "{first:#?} and {second:#?}");
    }

    #[test]
    fn full_range_of_a_parameter_is_1(spec in specs()) {
        let task = spec.task();
        let base = task.variant(DEFAULT_VARIANT).expect("the defaults satisfy the requirement");
        let measure = measure(&task);
        for (name, parameter) in spec.0["parameters"].as_object().expect("it is an object") {
            let weight = parameter["compare"]["weight"].as_f64().unwrap_or(1.0);
            let element_weight = |element: &Json| spec.0["element_weights"][element.as_str().expect("it is a letter")].as_f64().unwrap_or(1.0);
            let element_weight = parameter["affects"].as_array().into_iter().flatten().map(element_weight).fold(0.0, f64::max);
            let [low, high] = ends(parameter).map(|end| {
                let value = serde_json::from_value(end).ok()?;
                base.with("end", [(name.clone(), value)]).ok()
            });
            let (Some(low), Some(high)) = (low, high) else { continue };
            let distance = measure.between(&low, &high).expect("both belong to the same task").total;
            let is_beyond_a_half_turn = parameter["type"] == "heading"
                && parameter["range"][1].as_f64().zip(parameter["range"][0].as_f64()).is_some_and(|(b, a)| b - a > 180.0);
            let is_one_of_many = parameter["choices"].as_array().is_some_and(|choices| choices.len() > 2);
            let is_of_distribution = name.ends_with("_a") || name.ends_with("_b");
            if !(is_beyond_a_half_turn || is_one_of_many || is_of_distribution) {
                prop_assert!((distance - weight * element_weight).abs() < 1e-12, "{name}: {distance} at a weight of {weight} and {element_weight}");
            }
        }
        for (a, b) in pairs(&variants(&task)) {
            let found = measure.between(a, b).expect("both belong to the same task");
            prop_assert!(found.parts.iter().all(|part| part.normalised <= 1.0 + 1e-12), "{found:#?}");
            prop_assert!(found.total <= measure.diameter() * (1.0 + 1e-12));
        }
    }

    #[test]
    fn unread_parameters_do_not_count(spec in specs()) {
        let task = spec.task();
        let measure = measure(&task);
        for variant in variants(&task) {
            for (name, parameter) in spec.0["parameters"].as_object().expect("it is an object") {
                if parameter["read_if"] != "gate" {
                    continue;
                }
                for end in ends(parameter) {
                    let value = serde_json::from_value(end).expect("it is a value");
                    let moved = variant.with("moved", [(name.clone(), value)]).expect("it is in its range");
                    let distance = measure.between(&variant, &moved).expect("both belong to the same task").total;
                    if variant.reads(name) {
                        let is_same = moved.value(name) == variant.value(name);
                        prop_assert!(is_same || distance > 0.0 || !measure.properties().is_metric(), "{name}");
                    } else {
                        prop_assert_eq!(distance, 0.0, "{}", name);
                    }
                }
            }
        }
    }

    #[test]
    fn declared_laws_hold(spec in specs()) {
        let task = spec.task();
        let (measure, all) = (measure(&task), variants(&task));
        let d = |a: &Variant, b: &Variant| measure.between(a, b).expect("both belong to the same task");
        let laws = measure.properties();
        for (a, b) in pairs(&all) {
            prop_assert_eq!(d(a, b).total, d(b, a).total);
            prop_assert_eq!(d(a, b).elements, d(b, a).elements);
            let is_equal = a.values().keys().all(|name| a.value_as_read(name) == b.value_as_read(name));
            if is_equal {
                prop_assert_eq!(d(a, b).total, 0.0);
            } else if laws.is_metric() {
                prop_assert!(d(a, b).total > 0.0, "{:#?}", d(a, b));
            }
            for c in &all {
                if laws.keeps_triangles() {
                    prop_assert!(d(a, c).total <= d(a, b).total + d(b, c).total + 1e-9);
                }
            }
        }
    }

    #[test]
    fn moving_a_number_further_never_reduces_the_distance(spec in specs(), mut at in prop::array::uniform3(0_u32..=64)) {
        at.sort_unstable();
        let task = spec.task();
        let measure = measure(&task);
        let base = task.variant(DEFAULT_VARIANT).expect("the defaults satisfy the requirement");
        for (name, parameter) in spec.0["parameters"].as_object().expect("it is an object") {
            if parameter["role"] != "variant" || parameter["type"] != "number" {
                continue;
            }
            let [low, high] = [0, 1].map(|end| parameter["range"][end].as_f64().expect("numbers have ranges"));
            let moved = at.map(|at| {
                let value = driftworld::spec::Value::Number(low + (high - low) * f64::from(at) / 64.0);
                base.with("moved", [(name.clone(), value)]).ok()
            });
            let [Some(a), Some(b), Some(c)] = &moved else { continue };
            let d = |a: &Variant, b: &Variant| measure.between(a, b).expect("both belong to the same task").total;
            prop_assert!(d(a, b) <= d(a, c) && d(b, c) <= d(a, c), "{name}");
            // Distances add up along a line.
            prop_assert!((d(a, b) + d(b, c) - d(a, c)).abs() < 1e-9, "{name}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 64), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn equal_parameters_do_not_dilute_the_distance(spec in specs(), affects in prop::sample::subsequence(vec!["S", "A", "T", "R", "O"], 1..=5)) {
        let plain = spec.task();
        let all_variants = variants(&plain);
        let more = [
            json!({ "role": "fixed", "type": "number", "value": 3 }),
            json!({ "role": "variant", "type": "number", "affects": affects, "range": [0, 9], "default": 4 }),
            json!({ "role": "variant", "type": "color", "affects": affects, "choices": ["red", "blue"], "default": "blue" }),
            json!({ "role": "randomized", "type": "number", "affects": affects, "distribution": { "beta": { "alpha": 2, "beta": 3 } } }),
            json!({ "role": "randomized", "type": "heading", "affects": affects, "distribution": { "von_mises": { "mean": 10, "kappa": 2 } } }),
        ];
        let mut all: Vec<Spec> = more.map(|parameter| spec.with_parameter("zz", parameter)).to_vec();
        let mut grouped = spec.clone();
        grouped.0["groups"] = json!([{ "name": "trees", "count": 3, "object": { "class": "tree" },
                                       "placement": { "disc": { "center": [0, 0], "radius": 9 } } }]);
        all.push(grouped);
        for more in &all {
            let more = more.task();
            let (plain_measure, more_measure) = (measure(&plain), measure(&more));
            for (a, b) in [(0, 1), (1, 2), (0, 3)].map(|(a, b)| (&all_variants[a], &all_variants[b])) {
                let with = |variant: &Variant| more.variant(variant.name()).expect("it is declared");
                let before = plain_measure.between(a, b).expect("both belong to the same task");
                let after = more_measure.between(&with(a), &with(b)).expect("both belong to the same task");
                prop_assert_eq!(numbers(&before), numbers(&after));
            }
        }
    }
}
