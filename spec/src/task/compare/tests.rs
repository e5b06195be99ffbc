//! Tests which measures fit which parameters, and which tables of costs are accepted.

use crate::TaskSpec;

fn check(compare: &str, parameter: &str, expected: &str) {
    let text = format!(
        r#"{{ "name": "t", "parameters": {{ "p": {{ "affects": ["O"], "compare": {compare}, {parameter} }} }} }}"#
    );
    let error = TaskSpec::from_json("t.json", &text).map_or_else(|error| error.to_string(), |_| String::new());
    let error = error.split_once(" (").map_or("", |(_, error)| error);
    assert_eq!(error, expected);
}

const NUMBER: &str = r#""role": "variant", "type": "number", "range": [0, 1], "default": 0"#;
const WORDS: &str = r#""role": "variant", "type": "string", "choices": ["a", "b", "c"], "default": "a""#;

#[test]
fn measure_must_fit_its_parameter() {
    check(r#"{ "measure": "difference", "weight": 3 }"#, NUMBER, "");
    check(r#"{ "measure": "same_or_not" }"#, WORDS, "");
    let drawn = r#""role": "randomized", "type": "number", "distribution": { "uniform": { "low": 0, "high": 1 } }"#;
    check(r#"{ "measure": "hellinger" }"#, drawn, "");
    let color = r#""role": "variant", "type": "color", "choices": ["red", "tan"], "default": "red""#;
    check(r#"{ "measure": "hyab" }"#, color, "");
    check(r#"{ "measure": "relative_difference" }"#, NUMBER, "");
    let number = "a variant parameter of type number or integer";
    let colors = "a parameter of type color, or one whose distributions draw colours,";
    let laws = "a randomized parameter, or one of type distribution,";
    for (parameter, measure, expected) in [
        (NUMBER, "log_ratio", "NUMBER with values above 0, for this measure"),
        (WORDS, "ciede2000", "COLORS for this measure"),
        (NUMBER, "hellinger", "LAWS for this measure"),
        (color, "relative_difference", "NUMBER for this measure"),
        (NUMBER, "hyab", "COLORS for this measure"),
        (NUMBER, "energy", "LAWS for this measure"),
        (drawn, "hyab", "MEASURES energy or same_or_not"),
        (drawn, "relative_difference", "MEASURES energy or same_or_not"),
    ] {
        let measures = "wasserstein_1, wasserstein_2, total_variation, hellinger, jensen_shannon,";
        let mut error = format!("/parameters/p/compare/measure): found {measure}, expected {expected}");
        for (word, meaning) in [
            ("NUMBER", number),
            ("COLORS", colors),
            ("LAWS", laws),
            ("MEASURES", measures),
        ] {
            error = error.replace(word, meaning);
        }
        check(&format!(r#"{{ "measure": "{measure}" }}"#), parameter, &error);
    }
}

#[test]
fn drawn_colours_need_a_measure_with_distances() {
    let drawn =
        r#""role": "randomized", "type": "color", "distribution": { "color_normal": { "mean": "red", "std": 0.1 } }"#;
    let law = r#""role": "variant", "type": "distribution", "choices": [{ "color_hsv": {} }], "default": { "color_hsv": {} }"#;
    for parameter in [drawn, law] {
        for fits in "srgb cie76 ciede2000 oklab hyab wasserstein_1 wasserstein_2 same_or_not".split(' ') {
            check(&format!(r#"{{ "measure": "{fits}" }}"#), parameter, "");
        }
        for unfit in ["total_variation", "energy", "bures_wasserstein"] {
            let error = format!(
                "/parameters/p/compare/measure): found {unfit}, expected wasserstein_1, wasserstein_2, oklab, srgb, cie76, ciede2000, hyab or \
                 same_or_not, since colours from a continuum are compared by their distance"
            );
            check(&format!(r#"{{ "measure": "{unfit}" }}"#), parameter, &error);
        }
    }
    let words = r#""role": "randomized", "type": "color", "distribution": { "choice": { "values": ["red", "blue"] } }"#;
    check(r#"{ "measure": "total_variation" }"#, words, "");
    check(r#"{ "measure": "hyab" }"#, words, "");
    check(
        r#"{ "measure": "energy" }"#,
        words,
        "/parameters/p/compare/measure): found energy, expected wasserstein_1, wasserstein_2, total_variation, \
         hellinger, jensen_shannon, a measure of colours or same_or_not",
    );
}

#[test]
fn measure_that_does_not_fit_the_draws_is_rejected() {
    let drawn = |kind: &str, distribution: &str| {
        format!(r#""role": "randomized", "type": "{kind}", "distribution": {{ {distribution} }}"#)
    };
    let point = drawn("point", r#""disc": { "center": [0, 0], "radius": 2 }"#);
    let shares = drawn("vector", r#""dirichlet": { "alpha": [1, 2] }"#);
    let heading = drawn("heading", r#""uniform": { "low": 0, "high": 90 }"#);
    let words = drawn("string", r#""choice": { "values": ["a", "b"] }"#);
    let numbers = drawn("number", r#""uniform": { "low": 0, "high": 90 }"#);
    let turns = r#""role": "variant", "type": "distribution", "choices": [{ "von_mises": { "mean": 0, "kappa": 1 } }],
        "default": { "von_mises": { "mean": 0, "kappa": 1 } }"#;
    let measures = "wasserstein_1 wasserstein_2 total_variation hellinger jensen_shannon energy bures_wasserstein";
    for (parameter, fits) in [
        (point.as_str(), [true, true, false, false, false, false, true]),
        (&shares, [true, false, false, false, false, false, false]),
        (&heading, [true, false, true, true, true, false, false]),
        (turns, [true, false, true, true, true, false, false]),
        (&words, [false, false, true, true, true, false, false]),
        (&numbers, [true, true, true, true, true, true, false]),
    ] {
        for (measure, fits) in measures.split(' ').zip(fits) {
            let text = format!(
                r#"{{ "name": "t", "parameters": {{ "p": {{ "affects": ["S"], "compare": {{ "measure": "{measure}" }}, {parameter} }} }} }}"#
            );
            let error = TaskSpec::from_json("t", &text).map_or_else(|error| error.to_string(), |_| String::new());
            assert_eq!(error.is_empty(), fits, "{measure} of {parameter}: {error}");
            assert!(fits || error.contains("or same_or_not"), "{error}");
        }
    }
}

#[test]
fn measure_is_checked_against_the_distributions_of_another_parameter() {
    let text = r#"{ "name": "t", "parameters": {
        "law": { "role": "variant", "type": "distribution", "affects": ["O"], "choices": [{ "color_hsv": {} }], "default": { "color_hsv": {} } },
        "p": { "role": "randomized", "type": "color", "affects": ["O"], "distribution": { "param": "law" },
               "compare": { "measure": "hellinger" } } } }"#;
    let error = TaskSpec::from_json("t.json", text).map_or_else(|error| error.to_string(), |_| String::new());
    assert!(
        error.contains("(/parameters/p/compare/measure): found hellinger, expected wasserstein_1"),
        "{error}"
    );
}

#[test]
fn costs_must_be_distances_among_the_choices() {
    check(r#"{ "costs": [[0, 1, 2], [1, 0, 1.5], [2, 1.5, 0]] }"#, WORDS, "");
    for row in "
[[0, 1], [1, 0]] => ): found 2 rows, expected 3, one for each choice
[[0, 1, 1], [1, 0], [1, 1, 0]] => /1): found 2 numbers, expected 3, one for each choice
[[0, 1, 1], [2, 0, 1], [1, 1, 0]] => /1/0): found 2, expected 1, as at /0/1: costs must be symmetric
[[0, 1, 1], [1, 3, 1], [1, 1, 0]] => /1/1): found 3, expected 0, the distance of a choice from itself
[[0, -1, 1], [-1, 0, 1], [1, 1, 0]] => /0/1): found -1, expected a number of at least 0
[[0, 0, 0], [0, 0, 0], [0, 0, 0]] => ): found costs that are all 0, expected at least one above 0, or a weight of 0"
        .trim()
        .lines()
    {
        let (costs, error) = row.split_once(" => ").expect("a row has two parts");
        let error = format!("/parameters/p/compare/costs{error}");
        check(&format!(r#"{{ "costs": {costs} }}"#), WORDS, &error);
    }
    check(
        r#"{ "costs": [[0]] }"#,
        NUMBER,
        "/parameters/p/compare/costs): found costs for a parameter without choices, expected a variant parameter with choices",
    );
    check(
        r#"{ "costs": [[0, 1], [1, 0]] }"#,
        r#""role": "variant", "type": "string", "choices": ["a", "a"], "default": "a""#,
        "/parameters/p/compare/costs): found costs for choices with a duplicate, expected each choice once",
    );
    check(
        r#"{ "measure": "same_or_not", "costs": [[0, 1, 1], [1, 0, 1], [1, 1, 0]] }"#,
        WORDS,
        "/parameters/p/compare/costs): found costs and a measure, expected one of the two",
    );
}
