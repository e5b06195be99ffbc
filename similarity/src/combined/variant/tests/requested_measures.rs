//! Measures that a parameter requests by name: values computed by hand, normalisation, and metric properties.

use super::*;
use crate::Lab;
use driftworld_spec::Color;
use proptest::prelude::*;

/// A task with a parameter `p` of this type, compared by this measure; variants `v0`, `v1` … set it to each choice in turn.
fn task(kind: &str, measure: &str, choices: &[String]) -> Arc<TaskSpec> {
    let variants: Vec<String> = (choices.iter().enumerate())
        .map(|(index, choice)| format!(r#""v{index}": {{ "p": {choice} }}"#))
        .collect();
    let text = format!(
        r#"{{ "name": "t", "parameters": {{
            "p": {{ "role": "variant", "type": "{kind}", "affects": ["O"], "choices": [{}], "default": {},
                    "compare": {{ "measure": "{measure}" }} }} }},
          "variants": {{ {} }} }}"#,
        choices.join(", "),
        choices[0],
        variants.join(", ")
    );
    TaskSpec::from_json("t.json", &text).unwrap()
}

fn between(task: &Arc<TaskSpec>, a: &str, b: &str) -> Result<Distance, SimilarityError> {
    variant_distance(
        &task.variant(a).unwrap(),
        &task.variant(b).unwrap(),
        &Weights::default(),
    )
}

/// The measure's name, and its raw and normalised number between `v0` and `v1`.
fn found(kind: &str, measure: &str, choices: &[&str]) -> (&'static str, f64, f64) {
    let choices: Vec<String> = choices.iter().map(|choice| (*choice).to_owned()).collect();
    let distance = between(&task(kind, measure, &choices), "v0", "v1").unwrap();
    let part = &distance.parts[0];
    (part.measure, part.raw, part.normalised)
}

#[track_caller]
fn assert_found(found: (&'static str, f64, f64), measure: &str, raw: f64, normalised: f64) {
    assert_eq!(found.0, measure);
    assert!(
        (found.1 - raw).abs() < 1e-9 && (found.2 - normalised).abs() < 1e-9,
        "{found:?}, by hand {raw} and {normalised}"
    );
}

/// Difference in lightness plus the Euclidean distance in a and b.
fn hyab_by_hand(a: &str, b: &str) -> f64 {
    let [Lab([l, u, v]), Lab([m, x, y])] = [a, b].map(|name| Lab::from(Color::from_name(name).unwrap()));
    (l - m).abs() + libm::hypot(u - x, v - y)
}

#[test]
fn hyab_is_normalised_by_the_widest_choice() {
    let (raw, widest) = (
        hyab_by_hand("red", "tan"),
        hyab_by_hand("red", "navy").max(hyab_by_hand("tan", "navy")),
    );
    assert!(widest > raw);
    let named = ["\"red\"", "\"tan\"", "\"navy\""];
    assert_found(
        found("color", "hyab", &named),
        "hyab / widest choice",
        raw,
        raw / widest,
    );
    let drawn = named.map(|name| format!(r#"{{ "color_normal": {{ "mean": {name}, "std": 0 }} }}"#));
    let drawn = drawn.each_ref().map(String::as_str);
    let by_draws = found("distribution", "hyab", &drawn);
    assert_found(by_draws, "wasserstein-1 of hyab / widest", raw, raw / widest);
}

#[test]
fn layouts_are_compared_by_the_requested_aspect_alone() {
    // One wall of 4 m in a 100 m arena, `x` metres east.
    let wall = |x: f64| format!(r#"{{ "walls": [{{ "from": [{x}, -2], "to": [{x}, 2], "thickness": 0.5 }}] }}"#);
    let ask = |measure: &str, choices: [String; 3]| found("layout", measure, &choices.each_ref().map(String::as_str));
    let three = || [-30.0, -5.0, 20.0].map(wall);
    assert_found(
        ask("wall_transport", three()),
        "wall transport / widest choice",
        0.25,
        0.5,
    );
    // Without overlap, the distance between the walls does not matter.
    assert_found(ask("wall_jaccard", three()), "wall jaccard / widest choice", 1.0, 1.0);
    let rooms = |rows: [&str; 5]| format!(r#"{{ "text": {}, "cell": 2 }}"#, serde_json::to_string(&rows).unwrap());
    let doorway = ["#######", "#..#..#", "#.....#", "#..#..#", "#######"];
    let with_door = ["#######", "#..#..#", "#..D..#", "#..#..#", "#######"];
    let shut = ["#######", "#..#..#", "#..#..#", "#..#..#", "#######"];
    let (_, ways, share) = ask("walking_distance", [rooms(doorway), rooms(with_door), rooms(shut)]);
    assert_eq!((ways, share), (0.0, 0.0), "a door counts as a passage");
    let (_, ways, share) = ask("walking_distance", [rooms(doorway), rooms(shut), rooms(with_door)]);
    assert!(ways > 0.0 && share == 1.0, "{ways} {share}: the widest pair");
}

#[test]
fn relative_differences_are_normalised_by_the_domain() {
    let check = |domain: &str, other: &str, raw: f64, normalised: f64| {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{ "p": {{ "role": "variant", "type": "number", "affects": ["T"], {domain},
                "compare": {{ "measure": "relative_difference" }} }} }}, "variants": {{ "a": {{}}, "b": {{ "p": {other} }} }} }}"#
        );
        let distance = between(&TaskSpec::from_json("t.json", &text).unwrap(), "a", "b").unwrap();
        let part = &distance.parts[0];
        assert_found(
            (part.measure, part.raw, part.normalised),
            "relative difference / widest",
            raw,
            normalised,
        );
    };
    check(r#""range": [2, 8], "default": 4"#, "5", 0.2, 0.2 / 0.75);
    check(r#""range": [2, 8], "default": 2"#, "8", 0.75, 1.0);
    check(r#""range": [-8, -2], "default": -2"#, "-8", 0.75, 1.0);
    check(r#""range": [0, 8], "default": 0"#, "0.5", 1.0, 1.0);
    check(r#""range": [-1, 4], "default": -1"#, "4", 1.25, 0.625);
    check(r#""range": [-1, 4], "default": -1"#, "1", 2.0, 1.0);
    check(r#""choices": [1, 2, 4], "default": 1"#, "2", 0.5, 0.5 / 0.75);
}

#[test]
fn distribution_measures_match_values_computed_by_hand() {
    let at = |x: f64| format!(r#"{{ "normal": {{ "mean": {x}, "std": 0 }} }}"#);
    let ask = |measure: &str, three: [String; 3]| found("distribution", measure, &three.each_ref().map(String::as_str));
    // The energy distance of single numbers is √(2 |a − b|).
    let energy = ask("energy", [at(0.0), at(1.0), at(4.0)]);
    assert_found(energy, "energy / widest", 2.0_f64.sqrt(), 0.5);
    let round = |x: f64, std: f64| format!(r#"{{ "gaussian": {{ "mean": [{x}, 0], "std": {std} }} }}"#);
    let places = ask("bures_wasserstein", [round(0.0, 1.0), round(3.0, 3.0), round(6.0, 1.0)]);
    // Means are 3 m apart, and standard deviations differ by 2 m along both axes.
    assert_found(
        places,
        "bures-wasserstein / widest",
        17.0_f64.sqrt(),
        17.0_f64.sqrt() / 6.0,
    );
}

#[test]
fn measures_declare_their_metric_properties() {
    let properties = |kind: &str, measure: &str, choices: [&str; 2]| {
        let task = task(kind, measure, &choices.map(str::to_owned));
        VariantMeasure::new(&task, Weights::default()).properties()
    };
    let normals = [
        r#"{ "normal": { "mean": 0, "std": 1 } }"#,
        r#"{ "normal": { "mean": 1, "std": 1 } }"#,
    ];
    let places = [
        r#"{ "disc": { "center": [0, 0], "radius": 2 } }"#,
        r#"{ "gaussian": { "mean": [0, 0], "std": 1 } }"#,
    ];
    let walls = [1, 3].map(|number| format!(r#"{{ "predefined": {number} }}"#));
    assert_eq!(
        properties("layout", "wall_jaccard", walls.each_ref().map(String::as_str)),
        MetricProperties::Pseudometric
    );
    assert_eq!(
        properties("color", "hyab", ["\"red\"", "\"tan\""]),
        MetricProperties::Metric
    );
    assert_eq!(
        properties("number", "relative_difference", ["1", "2"]),
        MetricProperties::Metric
    );
    assert_eq!(properties("distribution", "energy", normals), MetricProperties::Metric);
    assert_eq!(
        properties("distribution", "bures_wasserstein", places),
        MetricProperties::Pseudometric
    );
    assert_eq!(
        properties("distribution", "wasserstein_2", places),
        MetricProperties::Distance
    );
    let task = task("distribution", "bures_wasserstein", &places.map(str::to_owned));
    assert!(
        between(&task, "v0", "v1").unwrap().total < 1e-7,
        "equal means and spreads"
    );
}

fn three(of: impl Strategy<Value = String>) -> impl Strategy<Value = Vec<String>> {
    prop::collection::vec(of, 3)
}

/// A type, a measure and three random choices.
fn requested() -> impl Strategy<Value = (&'static str, &'static str, Vec<String>)> {
    let normal = (-9.0..9.0_f64, 0.5..4.0_f64)
        .prop_map(|(mean, std)| format!(r#"{{ "normal": {{ "mean": {mean}, "std": {std} }} }}"#));
    let flat = (-9.0..0.0_f64, 1.0..4.0_f64)
        .prop_map(|(low, high)| format!(r#"{{ "uniform": {{ "low": {low}, "high": {high} }} }}"#));
    let around = |law: &'static str, middle: &'static str, width: &'static str| {
        let numbers = (prop::array::uniform2(-9.0..9.0_f64), 0.5..4.0_f64);
        numbers.prop_map(move |(at, wide)| format!(r#"{{ "{law}": {{ "{middle}": {at:?}, "{width}": {wide} }} }}"#))
    };
    let place = prop_oneof![around("gaussian", "mean", "std"), around("disc", "center", "radius")];
    let number = (-9.0..9.0_f64).prop_map(|x| x.to_string());
    let color = prop::array::uniform3(0.0..=1.0_f64).prop_map(|color| format!("{color:?}"));
    prop_oneof![
        three(prop_oneof![normal, flat]).prop_map(|choices| ("distribution", "energy", choices)),
        three(place).prop_map(|choices| ("distribution", "bures_wasserstein", choices)),
        three(number).prop_map(|choices| ("number", "relative_difference", choices)),
        three(color).prop_map(|choices| ("color", "hyab", choices)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn requested_measures_satisfy_their_metric_properties((kind, measure, choices) in requested()) {
        let task = task(kind, measure, &choices);
        let d = |a: &str, b: &str| between(&task, a, b).unwrap().total;
        prop_assert_eq!(d("v0", "v0"), 0.0);
        prop_assert!((d("v0", "v1") - d("v1", "v0")).abs() < 1e-9);
        let all = [d("v0", "v1"), d("v1", "v2"), d("v0", "v2")];
        let widest = all.into_iter().fold(0.0, f64::max);
        prop_assert!((widest - 1.0).abs() < 1e-9, "the distance of the widest pair is 1: {all:?}");
        if VariantMeasure::new(&task, Weights::default()).properties().keeps_triangles() {
            prop_assert!(all[2] <= all[0] + all[1] + 1e-6, "{all:?}");
        }
    }

    #[test]
    fn equal_parameter_changes_nothing((kind, measure, choices) in requested(), other in requested()) {
        let alone = task(kind, measure, &choices);
        let beside = format!(
            r#""p": {{ "role": "variant", "type": "{kind}", "affects": ["O"], "choices": [{list}], "default": {first},
                       "compare": {{ "measure": "{measure}" }} }},
               "q": {{ "role": "variant", "type": "{}", "affects": ["O"], "choices": [{}], "default": {},
                       "compare": {{ "measure": "{}" }} }}"#,
            other.0, other.2.join(", "), other.2[1], other.1, list = choices.join(", "), first = choices[0],
        );
        let text = format!(
            r#"{{ "name": "t", "parameters": {{ {beside} }}, "variants": {{ "v0": {{}}, "v1": {{ "p": {} }} }} }}"#,
            choices[1]
        );
        let both = TaskSpec::from_json("t.json", &text).unwrap();
        let d = |task: &Arc<TaskSpec>| between(task, "v0", "v1").unwrap().total;
        prop_assert_eq!(d(&alone), d(&both));
    }
}
