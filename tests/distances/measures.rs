//! Tests that a measure declared for a parameter is used, or refused on loading with a list of suitable measures.

use driftworld::similarity::VariantMeasure;
use driftworld::similarity::Weights;
use driftworld::spec::{DEFAULT_VARIANT, TaskSpec};
use serde_json::{Value as Json, json};

/// Every measure named in the task schema.
fn names() -> Vec<String> {
    let path = format!("{}/schemas/task.schema.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let schema: Json = serde_json::from_str(&text).expect("it is JSON");
    let listed = schema["$defs"]["MeasureName"]["oneOf"]
        .as_array()
        .cloned()
        .expect("it is a list");
    let names: Vec<String> = listed
        .iter()
        .filter_map(|one| one["const"].as_str().map(str::to_owned))
        .collect();
    assert!(names.len() >= 12, "{names:?}");
    names
}

/// A parameter of every type and of every kind of distribution, each with a description and a second value.
fn parameters() -> Vec<(&'static str, Json, Json)> {
    let variant = |kind: &str, domain: [&str; 1], values: Json, default: Json| {
        let mut one = json!({ "role": "variant", "type": kind, "affects": ["O"], "default": default });
        one[domain[0]] = values;
        one
    };
    let choices = |kind: &str, a: Json, b: Json| (variant(kind, ["choices"], json!([a, b]), a.clone()), b);
    let range = |kind: &str, a: Json, b: Json| (variant(kind, ["range"], json!([1, 90]), a), b);
    let drawn = |a: Json, b: Json| choices("distribution", a, b);
    let mut cases = vec![
        ("number", range("number", json!(1), json!(9))),
        ("integer", range("integer", json!(1), json!(9))),
        ("heading", range("heading", json!(1), json!(9))),
        ("vector", range("vector", json!([1, 2]), json!([2, 9]))),
        ("boolean", choices("boolean", json!(true), json!(false))),
        ("string", choices("string", json!("a"), json!("b"))),
        ("color", choices("color", json!("red"), json!("blue"))),
        ("point", choices("point", json!([0, 0]), json!([3, 4]))),
        (
            "layout",
            choices("layout", json!({ "predefined": 1 }), json!({ "predefined": 3 })),
        ),
    ];
    let normal = |mean: f64| json!({ "normal": { "mean": mean, "std": 2 } });
    let disc = |radius: f64| json!({ "disc": { "center": [0, 0], "radius": radius } });
    let color = |mean: &str| json!({ "color_normal": { "mean": mean, "std": 0 } });
    let words = |weight: f64| json!({ "choice": { "values": ["a", "b"], "weights": [1, weight] } });
    let shares = |alpha: f64| json!({ "dirichlet": { "alpha": [1, alpha] } });
    let headings = |mean: f64| json!({ "von_mises": { "mean": mean, "kappa": 2 } });
    cases.extend([
        ("drawn numbers", drawn(normal(1.0), normal(2.0))),
        ("drawn points", drawn(disc(3.0), disc(9.0))),
        ("drawn colours", drawn(color("red"), color("blue"))),
        ("drawn words", drawn(words(1.0), words(3.0))),
        ("drawn shares", drawn(shares(1.0), shares(4.0))),
        ("drawn headings", drawn(headings(1.0), headings(60.0))),
    ]);
    cases
        .into_iter()
        .map(|(of, (parameter, other))| (of, parameter, other))
        .collect()
}

#[test]
fn declared_measure_is_used_or_refused_with_suitable_ones() {
    for (of, parameter, other) in parameters() {
        let mut used = Vec::new();
        for name in names() {
            let mut parameter = parameter.clone();
            parameter["compare"] = json!({ "measure": name });
            let text = json!({ "name": "t", "parameters": { "p": parameter }, "variants": { "b": { "p": other } } });
            let task = match TaskSpec::from_json("t", &text.to_string()) {
                Ok(task) => task,
                Err(error) => {
                    let error_text = error.to_string();
                    assert!(
                        error_text.contains("/parameters/p/compare/measure") && error_text.contains(&name),
                        "{of}: {error_text}"
                    );
                    assert!(error_text.contains("expected"), "{of}: {error_text}");
                    continue;
                }
            };
            let [a, b] = [DEFAULT_VARIANT, "b"].map(|name| task.variant(name).expect("it is declared"));
            let measure = VariantMeasure::new(&task, Weights::default());
            let found = measure.between(&a, &b).expect("both belong to the same task");
            let words = |text: &str| text.replace(['_', '-'], " ");
            let part = &found.parts[0];
            assert!(
                words(part.measure).contains(&words(&name)),
                "{of}: asked for {name}, found {}",
                part.measure
            );
            assert!(
                part.normalised > 0.0 && found.total == part.normalised,
                "{of} by {name}: {found:#?}"
            );
            used.push(name);
        }
        assert!(used.contains(&"same_or_not".to_owned()), "{of}: {used:?}");
    }
}
