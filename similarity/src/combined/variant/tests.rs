//! Tests of distances between variants of one task: by parameter types, by declared measures, by elements.

mod requested_measures;

use super::*;
use driftworld_spec::{Element, TaskSpec};

fn distance(a: &str, b: &str) -> Distance {
    let text = r#"{ "name": "t", "parameters": {
        "color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["black", "white"], "default": "black" },
        "reward": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 },
        "model": { "role": "variant", "type": "string", "affects": ["S", "O"], "choices": ["1", "2"], "default": "1" },
        "wide": { "role": "variant", "type": "number", "affects": ["S"], "range": [1, 11], "default": 1 },
        "heading": { "role": "randomized", "type": "number", "affects": ["S"],
                     "distribution": { "uniform": { "low": 0, "high": { "param": "wide" } } } } },
      "variants": { "a": {}, "pay": { "reward": -100 }, "look": { "color": "white" }, "model": { "model": "2" },
                    "wide": { "wide": 11 } } }"#;
    let task = TaskSpec::from_json("t.json", text).unwrap();
    variant_distance(
        &task.variant(a).unwrap(),
        &task.variant(b).unwrap(),
        &Weights::default(),
    )
    .unwrap()
}

#[test]
fn variants_that_differ_in_one_element_are_0_apart_in_the_others() {
    let pay = distance("a", "pay");
    assert_eq!(pay.elements, [Some(0.0), None, None, Some(1.0), Some(0.0)]);
    assert_eq!(pay.total, 1.0);
    assert_eq!(distance("a", "look").element(Element::R), Some(0.0));
    assert_eq!(distance("a", "look").element(Element::O), Some(1.0));
}

#[test]
fn fine_element_counts_once_for_its_coarse_one() {
    use Element::{O, P, Phi, R, S};
    assert_eq!(counts_for(&[P, Phi]), [S, O]);
    assert_eq!(counts_for(&[P, S, R]), [S, R]);
    let distance_for = |affects: &str| {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{
                "a": {{ "role": "variant", "type": "number", "affects": {affects}, "range": [0, 4], "default": 2 }},
                "b": {{ "role": "variant", "type": "number", "affects": ["S"], "range": [0, 4], "default": 2 }} }},
               "variants": {{ "a": {{}}, "b": {{ "a": 3 }} }} }}"#
        );
        let task = TaskSpec::from_json("t.json", &text).unwrap();
        let [a, b] = ["a", "b"].map(|name| task.variant(name).unwrap());
        variant_distance(&a, &b, &Weights::default()).unwrap()
    };
    assert_eq!(distance_for(r#"["p"]"#), distance_for(r#"["S"]"#));
    assert_eq!(distance_for(r#"["S", "p"]"#), distance_for(r#"["S"]"#));
    assert_eq!(distance_for(r#"["p"]"#).element(P), Some(0.25));
}

#[test]
fn parameter_counts_for_each_element_that_it_affects() {
    let model = distance("a", "model");
    assert_eq!(model.element(Element::S), Some(1.0));
    assert_eq!(model.element(Element::O), Some(1.0));
    assert_eq!(model.total, 1.0);
}

#[test]
fn wider_distribution_is_measured_by_wasserstein() {
    let wide = distance("a", "wide");
    let heading = wide.parts.iter().find(|part| part.name == "heading").unwrap();
    assert!(
        (heading.raw - 5.0).abs() < 1e-9,
        "uniform 0..1 to uniform 0..11 is 5 apart"
    );
    assert_eq!(heading.normalised, 1.0);
    assert!(
        !wide.parts.iter().any(|part| part.name == "wide"),
        "it counts through the distribution"
    );
    assert_eq!(wide.total, 1.0);
}

#[test]
fn variant_distance_is_symmetric_and_zero_on_itself() {
    for name in ["a", "pay", "look", "model", "wide"] {
        assert_eq!(distance(name, name).total, 0.0);
        assert_eq!(distance(name, "a").total, distance("a", name).total);
    }
}

#[test]
fn element_weights_scale_the_total() {
    let weights = Weights::default().with(Element::R, 0.0).unwrap();
    assert!(Weights::default().with(Element::R, f64::NAN).is_err());
    let task = TaskSpec::from_json(
        "t.json",
        r#"{ "name": "t", "parameters": {
        "r": { "role": "variant", "type": "number", "affects": ["R"], "range": [0, 1], "default": 0 },
        "o": { "role": "variant", "type": "boolean", "affects": ["O"], "choices": [true, false], "default": true } },
        "variants": { "a": {}, "b": { "r": 1 } } }"#,
    )
    .unwrap();
    let distance = variant_distance(&task.variant("a").unwrap(), &task.variant("b").unwrap(), &weights).unwrap();
    assert_eq!((distance.total, distance.element(Element::R)), (0.0, Some(1.0)));
}

/// Checks the distance between two variants in the parameter `p`, as the task declares it.
fn check(parameter: &str, other: &str, measure: &str, expected: f64) {
    let text = format!(
        r#"{{ "name": "t", "parameters": {{ "p": {{ "affects": ["O"], {parameter} }} }}, "variants": {{ "a": {{}}, "b": {{ "p": {other} }} }} }}"#
    );
    let task = TaskSpec::from_json("t.json", &text).unwrap();
    let (a, b) = (task.variant("a").unwrap(), task.variant("b").unwrap());
    let distance = variant_distance(&a, &b, &Weights::of_task(&task)).unwrap();
    let part = &distance.parts[0];
    assert_eq!(part.measure, measure);
    assert!(
        (part.normalised - expected).abs() < 1e-6,
        "{measure}: {}",
        part.normalised
    );
}

#[test]
fn task_chooses_the_measure_of_a_parameter() {
    let number = r#""role": "variant", "type": "number", "range": [1, 100], "default": 1"#;
    check(number, "10", "difference / range", 9.0 / 99.0);
    check(
        &format!(r#"{number}, "compare": {{ "measure": "log_ratio" }}"#),
        "10",
        "log ratio / range",
        0.5,
    );
    check(
        &format!(r#"{number}, "compare": {{ "measure": "same_or_not" }}"#),
        "10",
        "same or not",
        1.0,
    );
    let word = r#""role": "variant", "type": "string", "choices": ["a", "b", "c"], "default": "a""#;
    check(word, r#""b""#, "same or not", 1.0);
    check(
        &format!(r#"{word}, "compare": {{ "costs": [[0, 1, 4], [1, 0, 4], [4, 4, 0]] }}"#),
        r#""b""#,
        "cost / largest",
        0.25,
    );
    let heading = r#""role": "variant", "type": "heading", "range": [0, 360], "default": 350"#;
    check(heading, "10", "turn / widest", 20.0 / 180.0);
    let point = r#""role": "variant", "type": "point", "choices": [[0, 0], [3, 4], [0, 10]], "default": [0, 0]"#;
    check(point, "[3, 4]", "euclidean / widest choice", 0.5);
    let vector = r#""role": "variant", "type": "vector", "range": [0, 1], "default": [0, 0, 0, 0]"#;
    check(vector, "[1, 1, 0, 0]", "euclidean / range", 0.5_f64.sqrt());
    let color = r#""role": "variant", "type": "color", "choices": ["black", "white"], "default": "black""#;
    check(color, r#""white""#, "oklab / widest choice", 1.0);
    for (name, measure) in [("srgb", "srgb / widest choice"), ("cie76", "cie76 / widest choice")] {
        let compare = format!(r#"{color}, "compare": {{ "measure": "{name}" }}"#);
        check(&compare, r#""white""#, measure, 1.0);
    }
    let drawn = |more: &str| {
        format!(
            r#""role": "variant", "type": "distribution", "choices": [{{ "uniform": {{ "low": 0, "high": 1 }} }}, {{ "uniform": {{ "low": 1, "high": 3 }} }}],
               "default": {{ "uniform": {{ "low": 0, "high": 1 }} }}{more}"#
        )
    };
    let other = r#"{ "uniform": { "low": 1, "high": 3 } }"#;
    check(&drawn(""), other, "wasserstein-1 / widest", 1.0);
    check(
        &drawn(r#", "compare": { "measure": "total_variation" }"#),
        other,
        "total variation / widest",
        1.0,
    );
}

#[test]
fn drawn_colours_are_compared_by_transport() {
    let around = |color: &str| format!(r#"{{ "color_normal": {{ "mean": "{color}", "std": 0 }} }}"#);
    let drawn = |more: &str| {
        let (black, white) = (around("black"), around("white"));
        format!(r#""role": "variant", "type": "distribution", "choices": [{black}, {white}], "default": {black}{more}"#)
    };
    let requested = |name: &str| drawn(&format!(r#", "compare": {{ "measure": "{name}" }}"#));
    let white = around("white");
    check(&drawn(""), &white, "wasserstein-1 of oklab / widest", 1.0);
    check(&requested("oklab"), &white, "wasserstein-1 of oklab / widest", 1.0);
    check(
        &requested("wasserstein_1"),
        &white,
        "wasserstein-1 of oklab / widest",
        1.0,
    );
    check(
        &requested("wasserstein_2"),
        &white,
        "wasserstein-2 of oklab / widest",
        1.0,
    );
    check(&requested("srgb"), &white, "wasserstein-1 of srgb / widest", 1.0);
    check(&requested("cie76"), &white, "wasserstein-1 of cie76 / widest", 1.0);
    check(&requested("same_or_not"), &white, "same or not", 1.0);
}

#[test]
fn weights_of_parameters_and_elements_come_from_the_task() {
    let task = TaskSpec::from_json("t.json", r#"{ "name": "t", "element_weights": { "R": 3 }, "parameters": {
        "r": { "role": "variant", "type": "number", "affects": ["R"], "range": [0, 1], "default": 0 },
        "o": { "role": "variant", "type": "boolean", "affects": ["O"], "choices": [true, false], "default": true, "compare": { "weight": 0 } },
        "p": { "role": "variant", "type": "boolean", "affects": ["O"], "choices": [true, false], "default": true } },
        "variants": { "a": {}, "b": { "r": 1, "o": false } } }"#).unwrap();
    let (a, b) = (task.variant("a").unwrap(), task.variant("b").unwrap());
    let distance = variant_distance(&a, &b, &Weights::of_task(&task)).unwrap();
    assert_eq!(distance.elements, [None, None, None, Some(1.0), Some(0.0)]);
    assert_eq!(distance.total, 3.0);
}

#[test]
fn nonmetric_measure_makes_the_whole_nonmetric() {
    let properties = |compare: &str| {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{ "p": {{ "role": "variant", "affects": ["O"], {compare} }} }} }}"#
        );
        let task = TaskSpec::from_json("t.json", &text).unwrap();
        VariantMeasure::new(&task, Weights::default()).properties()
    };
    let color = r#""type": "color", "choices": ["red", "blue"], "default": "red""#;
    assert_eq!(properties(color), MetricProperties::Metric);
    assert_eq!(
        properties(&format!(r#"{color}, "compare": {{ "measure": "ciede2000" }}"#)),
        MetricProperties::Distance
    );
    let word = r#""type": "string", "choices": ["a", "b", "c"], "default": "a""#;
    let costs = |c: f64| format!(r#"{word}, "compare": {{ "costs": [[0, 1, {c}], [1, 0, 1], [{c}, 1, 0]] }}"#);
    assert_eq!(properties(&costs(2.0)), MetricProperties::Metric);
    assert_eq!(properties(&costs(2.5)), MetricProperties::Distance);
}

#[test]
fn variants_of_a_different_task_with_the_same_name_are_refused() {
    let task = |range: &str| {
        TaskSpec::from_json(
            "t.json",
            &format!(
                r#"{{ "name": "t", "parameters": {{
            "p": {{ "role": "variant", "type": "number", "affects": ["O"], "range": {range}, "default": 0 }} }} }}"#
            ),
        )
        .unwrap()
    };
    let variant = |range: &str| task(range).variant("default").unwrap();
    let weights = Weights::default();
    assert!(variant_distance(&variant("[0, 1]"), &variant("[0, 1]"), &weights).is_ok());
    assert!(variant_distance(&variant("[0, 1]"), &variant("[0, 2]"), &weights).is_err());
}
