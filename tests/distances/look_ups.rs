//! Tests distances by parameters of tasks with look-ups: they equal the distances of the cases, and dependence on a random draw
//! counts.

use driftworld::similarity::{Distance, VariantMeasure, Weights};
use driftworld::spec::{Element, TaskSpec};
use proptest::prelude::*;
use serde_json::{Value as Json, json};

use super::laws_by_parameters::numbers;

/// The distance of `a` and `b` with these declarations of `pay` and `mode`.
fn distance(mode: &Json, b: &Json, pay: &Json) -> Distance {
    let text = json!({
        "version": 2, "name": "t",
        "parameters": {
            "mode": mode,
            "cue": { "role": "randomized", "type": "string", "affects": ["S"],
                     "distribution": { "choice": { "values": ["red", "blue"], "weights": [1, 3] } } },
            "pay": { "role": "randomized", "type": "number", "affects": ["R"], "distribution": pay }
        },
        "variants": { "a": {}, "b": { "mode": b } }
    });
    let task = TaskSpec::from_json("t.json", &text.to_string()).unwrap_or_else(|error| panic!("{error}"));
    let measure = VariantMeasure::new(&task, Weights::of_task(&task));
    let [a, b] = ["a", "b"].map(|name| task.variant(name).expect("it is declared"));
    measure.between(&a, &b).unwrap_or_else(|error| panic!("{error}"))
}

fn mode() -> Json {
    json!({ "role": "variant", "type": "string", "affects": ["T"], "choices": ["near", "far"], "default": "near" })
}

fn laws() -> impl Strategy<Value = Json> {
    prop_oneof![
        (-9..9i32).prop_map(|n| json!({ "constant": { "value": n } })),
        (1..9i32).prop_map(|n| json!({ "uniform": { "low": 0, "high": n } })),
        (1..9i32).prop_map(|n| json!({ "normal": { "mean": n, "std": 2 } })),
        (1..9i32).prop_map(|n| json!({ "choice": { "values": [0, n, 20] } })),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    /// A look-up over a variant parameter is compared like a parameter of type distribution with the same two values.
    #[test]
    fn look_up_over_a_variant_parameter_equals_its_cases(near in laws(), far in laws()) {
        prop_assume!(near != far);
        let looked_up = json!({ "case": { "param": "mode" }, "of": { "near": near, "far": far } });
        let law = json!({ "role": "variant", "type": "distribution", "affects": ["T"], "choices": [near, far], "default": near });
        let one = distance(&mode(), &json!("far"), &looked_up);
        let other = distance(&law, &far, &json!({ "param": "mode" }));
        prop_assert_eq!(numbers(&one), numbers(&other));
        prop_assert_eq!(one.element(Element::T).unwrap_or(0.0), 0.0);
    }

    /// A look-up over a random draw is compared as the mixture of the cases, and the variant parameter by itself.
    #[test]
    fn look_up_over_a_draw_equals_its_mixtures(numbers in prop::array::uniform4(-9..9i32)) {
        let [a, b, c, d] = numbers;
        let looked_up = json!({ "case": { "param": "mode" }, "of": {
            "near": { "case": { "param": "cue" }, "of": { "red": a, "blue": b } },
            "far": { "case": { "param": "cue" }, "of": { "red": c }, "else": d } } });
        let list = |red, blue| json!({ "choice": { "values": [red, blue], "weights": [1, 3] } });
        let mixed = json!({ "case": { "param": "mode" }, "of": { "near": list(a, b), "far": list(c, d) } });
        let [looked_up, mixed] = [looked_up, mixed].map(|pay| distance(&mode(), &json!("far"), &pay));
        let of = |distance: &Distance, element| distance.element(element).unwrap_or(0.0);
        prop_assert!((of(&looked_up, Element::R) - of(&mixed, Element::R)).abs() < 1e-12);
        prop_assert_eq!(of(&looked_up, Element::T), 1.0);
    }
}

/// The variants differ although only the cue that pays is reversed: each still pays equally often.
#[test]
fn dependence_on_a_draw_counts_by_its_parameter() {
    let either = |red, blue| json!({ "case": { "param": "cue" }, "of": { "red": red, "blue": blue } });
    let pay = json!({ "case": { "param": "mode" }, "of": { "near": either(1, -1), "far": either(-1, 1) } });
    assert!(distance(&mode(), &json!("far"), &pay).total >= 1.0);
}
