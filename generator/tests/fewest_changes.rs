//! Tests of the search for variants at a given distance, with parameters of every type: it finds every distance that an
//! exhaustive search finds, with no more changes, and changes no parameter needlessly. `at_distance.rs` tests tasks that have
//! only numbers and requirements.

use std::collections::BTreeMap;

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_spec::{Domain, Element, ParameterType, TaskSpec, Value, Variant};

use crate::drawn_task::{Drawn, Numbers};

/// Tolerance for distances found by the search.
const TOLERANCE: f64 = 1e-3;

/// Number of distances to request per task.
fn distances() -> usize {
    crate::tier::quick_or_full(6, 24)
}

/// The values of a parameter on a grid: all choices, integers and ends, and the variant's own value.
fn grid_of(from: &Variant, name: &str, parts: usize) -> Vec<Value> {
    let parameter = &from.task().parameters()[name];
    let here = from.value(name).expect("it has a value").clone();
    let [low, high] = match parameter.domain() {
        Some(Domain::Choices(choices)) => return choices,
        Some(Domain::Range(range)) => range,
        None => panic!("{name} has a domain"),
    };
    let at = |part: usize| low + (high - low) * part as f64 / parts as f64;
    let mut values: Vec<Value> = match (&here, parameter.kind) {
        (Value::Integer(_), _) => (low as i64..=high as i64).map(Value::Integer).collect(),
        (Value::Vector(_), _) => {
            let corner = |x: usize| (0..=parts).map(move |y| Value::Vector(vec![at(x), at(y)]));
            (0..=parts).flat_map(corner).collect()
        }
        (_, ParameterType::Heading) => (0..=parts)
            .map(|part| Value::Number(at(part).rem_euclid(360.0)))
            .collect(),
        _ => (0..=parts).map(|part| Value::Number(at(part))).collect(),
    };
    values.push(here);
    values
}

/// The difference of two variants in a parameter, as a share of its range; 0 or 1 for strings and booleans.
fn difference(from: &Variant, to: &Variant, name: &str) -> f64 {
    let parameter = &from.task().parameters()[name];
    let [low, high] = parameter.range.unwrap_or([0.0, 1.0]);
    let (a, b) = (from.value_as_read(name), to.value_as_read(name));
    match (a.as_deref(), b.as_deref()) {
        (Some(Value::Number(a)), Some(Value::Number(b))) if parameter.kind == ParameterType::Heading => {
            let turn = (a - b).rem_euclid(360.0);
            turn.min(360.0 - turn) / 180.0
        }
        (Some(Value::Number(a)), Some(Value::Number(b))) => (a - b).abs() / (high - low),
        (Some(Value::Integer(a)), Some(Value::Integer(b))) => (a - b).abs() as f64 / (high - low),
        (Some(Value::Vector(a)), Some(Value::Vector(b))) => {
            let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            (squares / a.len() as f64).sqrt() / (high - low)
        }
        (Some(Value::Color(a)), Some(Value::Color(b))) => a.distance(*b),
        (Some(Value::Point(a)), Some(Value::Point(b))) => libm::hypot(a[0] - b[0], a[1] - b[1]) / 40.0,
        (Some(Value::Distribution(a)), Some(Value::Distribution(b))) => {
            let mean = |variant: &Variant, law| variant.settle(law).mean().expect("it draws numbers");
            (mean(from, a) - mean(to, b)).abs()
        }
        (a, b) => f64::from(u8::from(a != b)),
    }
}

/// The Wasserstein-1 distance between the two variants' uniform distributions from `lo` to `hi`.
fn distribution_distance(from: &Variant, to: &Variant) -> f64 {
    let number = |variant: &Variant, name| variant.value(name).and_then(Value::as_number);
    let ends = |name| Some(number(from, name)? - number(to, name)?);
    let (Some(low), Some(high)) = (ends("lo"), ends("hi")) else {
        return 0.0;
    };
    if low * high >= 0.0 {
        return f64::midpoint(low.abs(), high.abs());
    }
    // The quantile functions cross, which leaves two triangles.
    (low * low + high * high) / (2.0 * (low.abs() + high.abs()))
}

/// The sum over all parameters, as in `similarity`.
fn distance(from: &Variant, to: &Variant, names: &[String]) -> f64 {
    let by_value = names.iter().filter(|name| *name != "lo" && *name != "hi");
    by_value.map(|name| difference(from, to, name)).sum::<f64>() + distribution_distance(from, to)
}

fn changed<'a>(from: &Variant, to: &Variant, names: &'a [String]) -> Vec<&'a String> {
    names.iter().filter(|name| from.value(name) != to.value(name)).collect()
}

/// Distances rounded to nine digits.
type Digits = u64;

fn digits(distance: f64) -> Digits {
    (distance * 1e9).round() as Digits
}

/// Every distance on a grid of allowed variants, with the minimum number of changes that reaches it.
fn on_a_grid(from: &Variant, names: &[String]) -> BTreeMap<Digits, usize> {
    let smooth = |name: &&String| {
        let parameter = &from.task().parameters()[*name];
        parameter.range.is_some() && parameter.kind != ParameterType::Integer
    };
    let axes: usize = names
        .iter()
        .filter(smooth)
        .map(|name| 1 + usize::from(name == "pays"))
        .sum();
    let parts = [1, 40, 12, 6, 4, 3].get(axes).copied().unwrap_or(2);
    let grids: Vec<Vec<Value>> = names.iter().map(|name| grid_of(from, name, parts)).collect();
    let mut found = BTreeMap::new();
    for number in 0..grids.iter().map(Vec::len).product() {
        let mut left: usize = number;
        let mut value = |grid: &Vec<Value>| {
            let value = grid[left % grid.len()].clone();
            left /= grid.len();
            value
        };
        let values: Vec<Value> = grids.iter().map(&mut value).collect();
        if let Ok(variant) = from.with("grid", names.iter().cloned().zip(values)) {
            let count = changed(from, &variant, names).len();
            let fewest = found.entry(digits(distance(from, &variant, names))).or_insert(count);
            *fewest = count.min(*fewest);
        }
    }
    found
}

/// The smallest distance above 0, the largest, and random distances from equal intervals between them.
fn targets(grid: &BTreeMap<Digits, usize>, numbers: &mut Numbers, max: usize) -> Vec<Digits> {
    let all: Vec<Digits> = grid.keys().copied().filter(|distance| *distance > 0).collect();
    if all.len() <= max {
        return all;
    }
    let (step, last) = ((all.len() - 2) as f64 / (max - 2) as f64, all.len() - 1);
    let between = (0..max - 2).map(|k| all[(1.0 + (k as f64 + numbers.share()) * step) as usize]);
    let mut targets: Vec<Digits> = [all[0], all[last]].into_iter().chain(between).collect();
    targets.dedup();
    targets
}

/// The fault in the answer for a distance that the grid reaches with `fewest` changes.
fn fault(from: &Variant, names: &[String], target: f64, fewest: usize) -> Option<String> {
    let measure = |other: &Variant| distance(from, other, names);
    let found = match at_distance(from, &Subject::Parameters(names.to_vec()), target, TOLERANCE, measure) {
        Ok(found) => found.variant,
        Err(error) => return Some(format!("{error}; the grid reaches {target} with {fewest} changes")),
    };
    let is_allowed = from.with(
        "again",
        found
            .values()
            .iter()
            .filter(|(name, _)| names.contains(name))
            .map(|(name, value)| (name.clone(), value.clone())),
    );
    if is_allowed.is_err() || (measure(&found) - target).abs() > TOLERANCE {
        return Some(format!("{target}: found {}, {is_allowed:?}", measure(&found)));
    }
    let changes = changed(from, &found, names);
    if changes.len() > fewest {
        return Some(format!("{target}: changes {changes:?}, the grid {fewest}"));
    }
    let idle = changes.into_iter().filter(|name| !found.reads(name)).find(|name| {
        let back = from.value(name).cloned().map(|value| ((*name).clone(), value));
        found
            .with("back", back)
            .is_ok_and(|back| (measure(&back) - target).abs() <= TOLERANCE)
    });
    idle.map(|name| format!("{target}: nothing reads {name}, and nothing prevents it from keeping its value"))
}

/// Checks that the error for a distance beyond reach reports at least the grid's farthest distance.
fn fault_beyond(from: &Variant, names: &[String], farthest: f64) -> Option<String> {
    let measure = |other: &Variant| distance(from, other, names);
    match at_distance(from, &Subject::Parameters(names.to_vec()), 50.0, TOLERANCE, measure) {
        Err(GeneratorError::TooFar { farthest: max, .. }) if max >= farthest - 1e-9 => None,
        Err(GeneratorError::NoneBetween { .. }) => None,
        other => Some(format!("50: found {other:?}, the grid's farthest is {farthest}")),
    }
}

/// Requests many distances of each of `tasks` random tasks; returns the faults in the answers.
fn faults(seed: u64, tasks: usize, max: usize) -> Vec<String> {
    let mut numbers = Numbers(seed);
    let (mut found, mut checked) = (Vec::new(), 0);
    while checked < tasks {
        let Drawn { text, names } = Drawn::new(&mut numbers);
        // If the variant violates a requirement, there is no variant to start from.
        let Ok(task) = TaskSpec::from_json("t", &text) else {
            continue;
        };
        let from = task.variant("here").expect("the task declares it");
        let grid = on_a_grid(&from, &names);
        // Only the variant itself is allowed.
        if grid.len() < 2 {
            continue;
        }
        checked += 1;
        let as_number = |digits: Digits| digits as f64 / 1e9;
        let targets = targets(&grid, &mut numbers, max);
        let mut wrong: Vec<String> = targets
            .iter()
            .filter_map(|target| fault(&from, &names, as_number(*target), grid[target]))
            .collect();
        let farthest = *grid.keys().next_back().expect("it has one");
        wrong.extend(fault_beyond(&from, &names, as_number(farthest)));
        if !wrong.is_empty() {
            found.push(format!("{text}\n  {}", wrong.join("\n  ")));
        }
    }
    found
}

#[track_caller]
fn check(seed: u64, tasks: usize, max: usize) {
    let faults = faults(seed, tasks, max);
    assert!(
        faults.is_empty(),
        "{} of {tasks} tasks:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

/// Declares tests that check a number of tasks each and run in parallel.
macro_rules! drawn_tasks {
    ($tasks:literal: $($name:ident: $seed:literal,)*) => {
        $(
            #[test]
            fn $name() {
                super::check($seed, $tasks, super::distances());
            }
        )*
    };
}

/// The search finds everything that an exhaustive search finds, with no more changes.
mod search_needs_no_more_changes_than_the_grid {
    drawn_tasks! {
        4:
        in_the_first_four: 1,
        in_the_second_four: 2,
        in_the_third_four: 3,
        in_the_fourth_four: 4,
    }

    #[test]
    #[ignore = "500 tasks take minutes: cargo nextest run -p driftworld-generator --run-ignored only"]
    fn in_five_hundred() {
        super::check(1000, 500, super::distances());
    }
}

#[test]
fn single_sufficient_parameter_is_changed_alone() {
    let text = r#"{ "name": "t", "require": ["a <= 0.6"], "variants": { "here": {} }, "parameters": {
        "a": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 1], "default": 0.2 },
        "b": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 1], "default": 0.5 },
        "word": { "role": "variant", "type": "string", "affects": ["T"], "choices": ["x", "y", "z"], "default": "x" } } }"#;
    let task = TaskSpec::from_json("t", text).expect("its defaults are allowed");
    let from = task.variant("here").expect("the task declares it");
    let names = ["a", "b", "word"].map(str::to_owned);
    let find = |target: f64| {
        let found = at_distance(&from, &Subject::Element(Element::T), target, 1e-6, |other| {
            distance(&from, other, &names)
        });
        changed(&from, &found.expect("it is allowed").variant, &names)
    };
    assert_eq!(find(0.1), ["a"]);
    assert_eq!(find(0.5), ["b"], "a alone cannot reach this distance");
    assert_eq!(find(1.0), ["word"]);
    assert_eq!(find(1.2), ["a", "word"]);
}

#[test]
fn vector_moves_to_its_farthest_corner() {
    let text = r#"{ "name": "t", "variants": { "here": {} }, "parameters": {
        "pays": { "role": "variant", "type": "vector", "affects": ["T"], "range": [-10, 10], "default": [8, -8] } } }"#;
    let task = TaskSpec::from_json("t", text).expect("the task is valid");
    let from = task.variant("here").expect("the task declares it");
    let names = ["pays".to_owned()];
    let find = |target| {
        at_distance(&from, &Subject::Element(Element::T), target, 1e-6, |other| {
            distance(&from, other, &names)
        })
    };
    assert!(find(0.89).is_ok());
    let Err(GeneratorError::TooFar { farthest, .. }) = find(0.95) else {
        panic!("both numbers can change by 18 of 20 and no more")
    };
    assert!((farthest - 0.9).abs() < 1e-9, "{farthest}");
}

#[test]
fn number_moves_to_activate_another_parameter() {
    let text = r#"{ "name": "t", "variants": { "here": { "hi": 0.4, "m": 1, "word": "x" } }, "parameters": {
        "lo": { "role": "variant", "affects": ["T"], "type": "number", "range": [0, 1], "default": 0.1 },
        "hi": { "role": "variant", "affects": ["T"], "type": "number", "range": [0, 1], "default": 0.4 },
        "m": { "role": "variant", "affects": ["T"], "type": "integer", "range": [-3, 8], "default": 1, "read_if": "lo <= 0.05" },
        "arc": { "role": "variant", "affects": ["T"], "type": "heading", "range": [300, 420], "default": 350 },
        "word": { "role": "variant", "affects": ["T"], "type": "string", "choices": ["x", "y", "z"], "default": "x" },
        "law": { "role": "variant", "affects": ["T"], "type": "distribution", "default": { "constant": { "value": 0.2 } },
                 "choices": [{ "constant": { "value": 0.2 } }, { "uniform": { "low": 0, "high": 1 } }, { "normal": { "mean": 0.9, "std": 0.1 } }] },
        "drawn": { "role": "randomized", "type": "number", "affects": ["T"],
                   "distribution": { "uniform": { "low": { "param": "lo" }, "high": { "param": "hi" } } } } } }"#;
    let task = TaskSpec::from_json("t", text).expect("the task is valid");
    let from = task.variant("here").expect("the task declares it");
    let names = ["lo", "hi", "m", "arc", "word", "law"].map(str::to_owned);
    // 1 for the word, 0.7 for the law, 0.05 for lo at 0, which activates m; m adds five of eleven steps, and the arc the rest.
    assert_eq!(fault(&from, &names, 2.482_323_232, 5), None);
}
