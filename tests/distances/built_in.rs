//! Tests the laws of distances by parameters on every pair of variants of every built-in task.

use std::sync::Arc;

use driftworld::similarity::Weights;
use driftworld::spec::{DEFAULT_VARIANT, Domain, ParameterType, Role, TaskSpec, Value, Variant};
use driftworld::tasks;
use serde_json::{Map, Value as Json, json};

use super::laws_by_parameters::{are_close, measure, numbers};
use crate::tier::quick_or_full;

/// The built-in tasks, in the quick tier half of them, each with its document.
fn built_in() -> Vec<(Arc<TaskSpec>, Json)> {
    let read = |(name, text): &(&str, &str)| {
        let task = tasks::task(name).unwrap_or_else(|error| panic!("{error}"));
        (task, serde_json::from_str(text).expect("it is JSON"))
    };
    tasks::BUILT_IN.iter().step_by(quick_or_full(2, 1)).map(read).collect()
}

fn load(document: &Json) -> Arc<TaskSpec> {
    TaskSpec::from_json("retold", &document.to_string()).unwrap_or_else(|error| panic!("{error}"))
}

/// The values that a variant sets for parameters with the role `variant`.
fn set_by(variant: &Variant) -> Map<String, Json> {
    let parameters = variant.task().parameters();
    let is_set = |name: &str| parameters[name].role == Role::Variant;
    let values = variant.values().iter().filter(|(name, _)| is_set(name));
    values.map(|(name, value)| (name.clone(), value.to_json())).collect()
}

#[test]
fn every_pair_satisfies_the_laws_that_its_task_declares() {
    for (task, _) in built_in() {
        let (measure, all) = (measure(&task), task.all_variants());
        let d: Vec<Vec<f64>> = all
            .iter()
            .map(|a| {
                let to = |b: &Variant| measure.between(a, b).unwrap_or_else(|error| panic!("{error}")).total;
                all.iter().map(to).collect()
            })
            .collect();
        assert!(
            measure.properties().is_metric(),
            "{}: {:?}",
            task.name(),
            measure.properties()
        );
        for (i, a) in all.iter().enumerate() {
            for (j, b) in all.iter().enumerate() {
                assert_eq!(d[i][j], d[j][i], "{} and {}", a.id(), b.id());
                let is_equal = a
                    .values()
                    .keys()
                    .all(|name| a.value_as_read(name) == b.value_as_read(name));
                assert_eq!(d[i][j] == 0.0, is_equal, "{} and {}", a.id(), b.id());
                assert!(d[i][j] <= measure.diameter());
                for k in 0..all.len() {
                    assert!(d[i][k] <= d[i][j] + d[j][k] + 1e-9);
                }
            }
        }
    }
}

#[test]
fn distance_depends_on_the_pair_alone() {
    for (task, document) in built_in() {
        let all = task.all_variants();
        let parameters = document["parameters"].as_object().expect("it is an object");
        let mut other = document.clone();
        other["parameters"] = parameters
            .iter()
            .rev()
            .map(|(name, one)| (name.clone(), one.clone()))
            .collect();
        // All variants in reverse order under other names, after further variants at the ends of the declared ranges.
        let base = task.variant(DEFAULT_VARIANT).expect("there is a default variant");
        let mut variants = Map::new();
        for (name, parameter) in task.parameters() {
            let Some(Domain::Range(ends)) = parameter.domain() else {
                continue;
            };
            for (index, end) in ends.iter().enumerate() {
                let end = match parameter.vector_length() {
                    Some(length) => Value::Vector(vec![*end; length]),
                    None => Value::Number(*end),
                };
                if let Ok(extreme) = base.with("extreme", [(name.clone(), end)]) {
                    variants.insert(format!("end_{index}_{name}"), json!(set_by(&extreme)));
                }
            }
        }
        for variant in all.iter().rev() {
            variants.insert(format!("other_{}", variant.name()), json!(set_by(variant)));
        }
        other["variants"] = json!(variants);
        let other = load(&other);
        let (first, second) = (measure(&task), measure(&other));
        let named = |task: &Arc<TaskSpec>, name: &str| task.variant(name).unwrap_or_else(|error| panic!("{error}"));
        // The quick tier tests every third variant.
        for a in all.iter().step_by(quick_or_full(3, 1)) {
            for b in &all {
                let rewritten = |variant: &Variant| named(&other, &format!("other_{}", variant.name()));
                let [here, there] = [first.between(a, b), second.between(&rewritten(a), &rewritten(b))];
                let (here, there) = (here.expect("same task"), there.expect("same task"));
                assert!(
                    are_close(&here, &there),
                    "{} and {}: {here:#?} and {there:#?}",
                    a.id(),
                    b.id()
                );
            }
        }
        // The distance is the same in a task with no other variants.
        for pair in all.windows(2).step_by(quick_or_full(5, 1)) {
            let mut alone = document.clone();
            alone["variants"] = json!({ "b": set_by(&pair[1]), "a": set_by(&pair[0]) });
            let alone = load(&alone);
            let [a, b] = ["a", "b"].map(|name| named(&alone, name));
            let here = first.between(&pair[0], &pair[1]).expect("same task");
            assert_eq!(
                numbers(&here),
                numbers(&measure(&alone).between(&a, &b).expect("same task"))
            );
        }
    }
}

#[test]
fn equal_parameters_do_not_dilute_the_distance() {
    for (task, mut document) in built_in() {
        let more = [
            (
                "zz_set",
                json!({ "role": "variant", "type": "number", "affects": ["S", "A", "T", "R", "O"], "range": [0, 9], "default": 4 }),
            ),
            (
                "zz_drawn",
                json!({ "role": "randomized", "type": "number", "affects": ["R"], "distribution": { "uniform": { "low": 0, "high": 1 } } }),
            ),
            ("zz_fixed", json!({ "role": "fixed", "type": "number", "value": 4 })),
        ];
        for (name, parameter) in more {
            document["parameters"][name] = parameter;
        }
        let group = json!({ "name": "zz", "count": 2, "object": { "class": "bush" },
                            "placement": { "disc": { "center": [0, 0], "radius": 9 } } });
        document["groups"].as_array_mut().expect("it is a list").push(group);
        let other = load(&document);
        let (first, second) = (measure(&task), measure(&other));
        let pairs = || task.all_variants().into_iter().zip(other.all_variants());
        for (a, other_a) in pairs().step_by(quick_or_full(3, 1)) {
            for (b, other_b) in pairs() {
                let here = first.between(&a, &b).expect("same task");
                let there = second.between(&other_a, &other_b).expect("same task");
                assert_eq!(numbers(&here), numbers(&there), "{} and {}", a.id(), b.id());
            }
        }
    }
}

#[test]
fn full_range_of_a_parameter_has_distance_1_or_0_if_unread() {
    let mut idle = 0;
    for (task, _) in built_in() {
        let measure = measure(&task);
        assert_eq!(Weights::of_task(&task), Weights::default(), "{}", task.name());
        for variant in task.all_variants() {
            for (name, parameter) in task.parameters() {
                if parameter.kind == ParameterType::Heading || task.readers(name).are_draws_alone() {
                    continue;
                }
                let Some(Domain::Range(ends)) = parameter.domain() else {
                    continue;
                };
                let moved = ends.map(|end| {
                    let value = match parameter.vector_length() {
                        Some(length) => Value::Vector(vec![end; length]),
                        None => Value::Number(end),
                    };
                    variant.with("moved", [(name.clone(), value)]).ok()
                });
                let [Some(low), Some(high)] = moved else { continue };
                let found = measure.between(&low, &high).expect("same task");
                if variant.reads(name) {
                    let own = found
                        .parts
                        .iter()
                        .find(|part| part.name == *name)
                        .expect("it is compared");
                    assert!(
                        (own.normalised - 1.0).abs() < 1e-12,
                        "{} {name}: {}",
                        variant.id(),
                        own.normalised
                    );
                } else {
                    idle += 1;
                    assert_eq!(found.total, 0.0, "{} {name}", variant.id());
                }
            }
        }
    }
    assert!(idle > 50, "only {idle} unread parameters were moved");
}
