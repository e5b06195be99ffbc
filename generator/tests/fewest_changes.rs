//! Laws of variants at a wanted distance: what a search of everything finds is found, by no more changes, and nothing idle changes.

use std::sync::Arc;

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_spec::{Element, TaskSpec, Value, Variant};
use proptest::prelude::*;

/// How far off a found distance may be.
const TOLERANCE: f64 = 1e-3;

/// Parts that the grid divides each range into.
const PARTS: u32 = 12;

const NAMES: [&str; 3] = ["a", "b", "word"];

/// Two numbers in 0..1 and a word, requirements over them, and when `b` is read.
#[derive(Clone, Debug)]
struct Case {
    defaults: [f64; 2],
    require: Vec<String>,
    read_if: Option<String>,
}

impl Case {
    fn task(&self) -> Option<Arc<TaskSpec>> {
        let read_if = self
            .read_if
            .as_ref()
            .map_or_else(String::new, |text| format!(r#", "read_if": {text:?}"#));
        let [a, b] = self.defaults;
        let text = format!(
            r#"{{ "name": "t", "require": {:?}, "variants": {{ "here": {{}} }}, "parameters": {{
                "a": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [0, 1], "default": {a} }},
                "b": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [0, 1], "default": {b}{read_if} }},
                "word": {{ "role": "variant", "type": "string", "affects": ["T"], "choices": ["x", "y", "z"], "default": "x" }} }} }}"#,
            self.require
        );
        // Where the defaults break a requirement there is no variant to go from.
        TaskSpec::from_json("t", &text).ok()
    }
}

/// One for a number moved over its whole range and for another word, as far as they are read.
fn distance(from: &Variant, to: &Variant) -> f64 {
    let apart = |name: &str| match (from.value_as_read(name).as_deref(), to.value_as_read(name).as_deref()) {
        (Some(Value::Number(a)), Some(Value::Number(b))) => (a - b).abs(),
        (a, b) => f64::from(u8::from(a != b)),
    };
    NAMES.iter().map(|name| apart(name)).sum()
}

fn changed(from: &Variant, to: &Variant) -> Vec<&'static str> {
    NAMES
        .into_iter()
        .filter(|name| from.value(name) != to.value(name))
        .collect()
}

/// The distance of every variant on a grid that the task allows, and how many parameters it changes.
fn on_a_grid(from: &Variant) -> Vec<(f64, usize)> {
    let numbers = |name: &str| {
        let here = from.value(name).cloned();
        let grid = (0..=PARTS).map(|part| Value::Number(f64::from(part) / f64::from(PARTS)));
        here.into_iter().chain(grid).collect::<Vec<_>>()
    };
    let mut found = Vec::new();
    for a in numbers("a") {
        for b in numbers("b") {
            for word in ["x", "y", "z"] {
                let values = [a.clone(), b.clone(), Value::Text(word.to_owned())];
                if let Ok(variant) = from.with("grid", NAMES.map(str::to_owned).into_iter().zip(values)) {
                    found.push((distance(from, &variant), changed(from, &variant).len()));
                }
            }
        }
    }
    found
}

fn requirement() -> impl Strategy<Value = String> {
    let bound = || (1..20_u32).prop_map(|twentieths| f64::from(twentieths) / 20.0);
    prop_oneof![
        bound().prop_map(|bound| format!("a < {bound}")),
        bound().prop_map(|bound| format!("b >= {bound}")),
        bound().prop_map(|bound| format!("a + b <= {}", 2.0 * bound)),
        bound().prop_map(|bound| format!("a - b <= {bound}")),
        bound().prop_map(|bound| format!("word == 'x' or a > {bound}")),
        bound().prop_map(|bound| format!("word != 'y' or b < {bound}")),
        bound().prop_map(|bound| format!("a < {bound} or b > {bound}")),
    ]
}

fn case() -> impl Strategy<Value = Case> {
    let value = || (0..=10_u32).prop_map(|tenths| f64::from(tenths) / 10.0);
    let read_if = prop::sample::select(vec![None, Some("word == 'x'"), Some("word == 'y'"), Some("a > 0.5")]);
    ((value(), value()), prop::collection::vec(requirement(), 1..4), read_if).prop_map(|((a, b), require, read_if)| {
        Case {
            defaults: [a, b],
            require,
            read_if: read_if.map(str::to_owned),
        }
    })
}

fn whole() -> Subject {
    Subject::Parameters(NAMES.map(str::to_owned).to_vec())
}

/// Which distance is asked for: one of the grid's, the farthest of them, or one that nothing has.
#[derive(Clone, Copy)]
enum Asked {
    Drawn(prop::sample::Index),
    Farthest,
    Beyond,
}

/// A distance that the grid has is found by as few changes; beyond what it has, the error names no less than its farthest.
fn check(case: &Case, asked: Asked) -> Result<bool, TestCaseError> {
    let Some(task) = case.task() else { return Ok(false) };
    let from = task.variant("here").expect("it is declared");
    let grid = on_a_grid(&from);
    let farthest = grid
        .iter()
        .fold(0.0_f64, |farthest, (distance, _)| farthest.max(*distance));
    let target = match asked {
        Asked::Drawn(which) => which.get(&grid).0,
        Asked::Farthest => farthest,
        Asked::Beyond => 9.0,
    };
    let found = at_distance(&from, &whole(), target, TOLERANCE, |other| distance(&from, other));
    if let (Asked::Beyond, Err(GeneratorError::TooFar { farthest: most, .. })) = (asked, &found) {
        prop_assert!(
            *most >= farthest - 1e-9,
            "found at most {most}, the grid has {farthest}"
        );
        return Ok(true);
    }
    let found = found.map_err(|error| TestCaseError::fail(format!("{error}; the grid has {target}")))?;
    prop_assert!((distance(&from, &found.variant) - target).abs() <= TOLERANCE);
    let as_far = grid.iter().filter(|(distance, _)| (distance - target).abs() < 1e-9);
    let fewest = as_far.map(|(_, count)| *count).min().expect("it is one of them");
    let changes = changed(&from, &found.variant);
    prop_assert!(
        changes.len() <= fewest,
        "{target}: {changes:?}, the grid changes {fewest}"
    );
    for name in changes.into_iter().filter(|name| !found.variant.reads(name)) {
        let back = from.value(name).cloned().map(|value| (name.to_owned(), value));
        prop_assert!(
            found.variant.with("back", back).is_err(),
            "nothing reads {name} and nothing forbids it"
        );
    }
    Ok(true)
}

/// A tenth of the 500 specs: tests that run side by side.
fn check_fifty(seed: u8) {
    let algorithm = prop::test_runner::RngAlgorithm::ChaCha;
    let rng = prop::test_runner::TestRng::from_seed(algorithm, &[seed; 32]);
    let mut runner = prop::test_runner::TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let mut num_checked = 0;
    while num_checked < 50 {
        let drawn = (case(), any::<prop::sample::Index>())
            .new_tree(&mut runner)
            .expect("it can be drawn");
        let (case, which) = prop::strategy::ValueTree::current(&drawn);
        let asked = match num_checked % 25 {
            24 => Asked::Beyond,
            odd if odd % 2 == 1 => Asked::Farthest,
            _ => Asked::Drawn(which),
        };
        match check(&case, asked) {
            Ok(is_checked) => num_checked += u32::from(is_checked),
            Err(error) => panic!("{case:?}: {error}"),
        }
    }
}

macro_rules! fifties {
    ($($name:ident: $seed:literal,)*) => {
        /// What a search of everything finds is found, by as few changes.
        mod what_a_grid_finds_is_found_by_as_few_changes {
            $(
                #[test]
                fn $name() {
                    super::check_fifty($seed);
                }
            )*
        }
    };
}

fifties! {
    in_the_first_fifty: 1,
    in_the_second_fifty: 2,
    in_the_third_fifty: 3,
    in_the_fourth_fifty: 4,
    in_the_fifth_fifty: 5,
    in_the_sixth_fifty: 6,
    in_the_seventh_fifty: 7,
    in_the_eighth_fifty: 8,
    in_the_ninth_fifty: 9,
    in_the_tenth_fifty: 10,
}

#[test]
fn the_parameter_that_alone_will_do_is_changed_alone() {
    let case = Case {
        defaults: [0.2, 0.5],
        require: vec!["a <= 0.6".to_owned()],
        read_if: None,
    };
    let task = case.task().expect("its defaults are allowed");
    let from = task.variant("here").expect("it is declared");
    let find = |target: f64| {
        let found = at_distance(&from, &Subject::Element(Element::T), target, 1e-6, |other| {
            distance(&from, other)
        });
        changed(&from, &found.expect("it is allowed").variant)
    };
    assert_eq!(find(0.1), ["a"]);
    assert_eq!(find(0.5), ["b"], "a cannot go as far");
    assert_eq!(find(1.0), ["word"]);
    assert_eq!(find(1.2), ["a", "word"]);
}
