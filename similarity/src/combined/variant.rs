//! Distance between two variants of one task, parameter by parameter. Distances of concrete worlds are in `world.rs`.

use driftworld_spec::{Distribution, Domain, Parameter, ParameterType, Role, Value, Variant};

use crate::SimilarityError;
use crate::color::oklab_distance;
use crate::combined::{Distance, Part, Weights};
use crate::distribution::planar::{bures_wasserstein, spread};
use crate::distribution::wasserstein::{total_variation, wasserstein_1, width};

/// How one parameter differs: measure, raw number, number in 0..=1.
type Difference = (&'static str, f64, f64);

/// How far apart two variants of one task are.
///
/// Every parameter counts, with weight 1, for each element that it affects. Variant parameters are compared by value:
/// numbers by difference over the declared range, colours in Oklab, points over the widest pair of choices, anything else as
/// the same or not. Randomized ones are compared by distribution: Wasserstein-1 over the width of both, total variation for
/// words, Bures–Wasserstein for points. A parameter that is alike in both contributes exactly 0, so variants that differ in
/// what they pay are 0 apart in all elements but the reward. Fixed parameters cannot differ and are left out.
///
/// # Errors
/// [`SimilarityError::DifferentTasks`].
pub fn variant_distance(a: &Variant, b: &Variant, weights: &Weights) -> Result<Distance, SimilarityError> {
    if a.task().name() != b.task().name() {
        let (a, b) = (a.task().name().to_owned(), b.task().name().to_owned());
        return Err(SimilarityError::DifferentTasks { a, b });
    }
    let mut parts = Vec::new();
    for (name, parameter) in a.task().parameters() {
        let difference = match parameter.role {
            Role::Fixed => None,
            Role::Variant if parameter.kind != ParameterType::Distribution => {
                a.value(name).zip(b.value(name)).map(|(a, b)| by_value(parameter, a, b))
            }
            Role::Variant | Role::Randomized => a
                .distribution(name)
                .zip(b.distribution(name))
                .map(|(a, b)| by_distribution(&a, &b)),
        };
        let Some((measure, raw, normalised)) = difference else {
            continue;
        };
        parts.extend(parameter.affects.iter().map(|element| Part {
            name: name.clone(),
            element: *element,
            measure,
            raw,
            normalised: normalised.clamp(0.0, 1.0),
            weight: 1.0,
        }));
    }
    Ok(Distance::new(parts, weights))
}

fn by_value(parameter: &Parameter, a: &Value, b: &Value) -> Difference {
    match (a, b) {
        (Value::Color(a), Value::Color(b)) => {
            let raw = oklab_distance(*a, *b);
            ("oklab", raw, raw)
        }
        (Value::Point(a), Value::Point(b)) => {
            let raw = length(*a, *b);
            ("euclidean / widest choice", raw, share(raw, widest_choice(parameter)))
        }
        (Value::Vector(a), Value::Vector(b)) => {
            let raw = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
            (
                "euclidean / range",
                raw,
                share(raw, range(parameter) * (a.len() as f64).sqrt()),
            )
        }
        _ if parameter.kind == ParameterType::Heading => {
            let turn = (a.as_number().unwrap_or(0.0) - b.as_number().unwrap_or(0.0)).rem_euclid(360.0);
            let raw = turn.min(360.0 - turn);
            ("turn / 180 degrees", raw, raw / 180.0)
        }
        _ => {
            if let (Some(a), Some(b)) = (a.as_number(), b.as_number()) {
                (
                    "difference / range",
                    (a - b).abs(),
                    share((a - b).abs(), range(parameter)),
                )
            } else {
                let raw = if a == b { 0.0 } else { 1.0 };
                ("same or not", raw, raw)
            }
        }
    }
}

fn by_distribution(a: &Distribution, b: &Distribution) -> Difference {
    if a == b {
        return ("distribution", 0.0, 0.0);
    }
    if let Some(raw) = wasserstein_1(a, b) {
        let wide = match (width(a), width(b)) {
            (Some([a_low, a_high]), Some([b_low, b_high])) => a_high.max(b_high) - a_low.min(b_low),
            _ => 0.0,
        };
        return ("wasserstein-1 / width", raw, share(raw, wide));
    }
    if let Some(raw) = bures_wasserstein(a, b) {
        let spread = |distribution| spread(distribution).unwrap_or(0.0);
        // Far apart is 1, and one spread of the two apart is a half.
        return (
            "bures-wasserstein",
            raw,
            raw / (raw + f64::midpoint(spread(a), spread(b)).max(1e-12)),
        );
    }
    if let Some(raw) = total_variation(a, b) {
        return ("total variation", raw, raw);
    }
    ("same or not", 1.0, 1.0)
}

fn share(raw: f64, whole: f64) -> f64 {
    if raw == 0.0 {
        0.0
    } else {
        raw / whole.max(f64::MIN_POSITIVE)
    }
}

/// Width of what a number may be.
fn range(parameter: &Parameter) -> f64 {
    match parameter.domain() {
        Some(Domain::Range([low, high])) => high - low,
        Some(Domain::Choices(choices)) => {
            let numbers_of = |choice: &Value| match choice {
                Value::Vector(numbers) => numbers.clone(),
                other => other.as_number().into_iter().collect(),
            };
            let numbers: Vec<f64> = choices.iter().flat_map(numbers_of).collect();
            let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
            numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
        }
        None => 0.0,
    }
}

fn widest_choice(parameter: &Parameter) -> f64 {
    let Some(Domain::Choices(choices)) = parameter.domain() else {
        return 0.0;
    };
    let points = || {
        choices.iter().filter_map(|choice| {
            if let Value::Point(point) = choice {
                Some(*point)
            } else {
                None
            }
        })
    };
    points()
        .flat_map(|a| points().map(move |b| length(a, b)))
        .fold(0.0, f64::max)
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
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
        assert_eq!(pay.total, 1.0 / 3.0);
        assert_eq!(distance("a", "look").element(Element::R), Some(0.0));
        assert!(distance("a", "look").element(Element::O).unwrap() > 0.49);
    }

    #[test]
    fn a_parameter_counts_for_each_element_that_it_affects() {
        let model = distance("a", "model");
        assert_eq!(model.element(Element::S), Some(1.0 / 3.0));
        assert_eq!(model.element(Element::O), Some(1.0 / 2.0));
    }

    #[test]
    fn a_wider_distribution_is_farther_by_its_wasserstein_distance() {
        let wide = distance("a", "wide");
        let heading = wide.parts.iter().find(|part| part.name == "heading").unwrap();
        assert!(
            (heading.raw - 5.0).abs() < 1e-9,
            "uniform 0..1 to uniform 0..11 is 5 apart"
        );
        assert!((heading.normalised - 5.0 / 11.0).abs() < 1e-9);
    }

    #[test]
    fn a_variant_is_0_from_itself_and_as_far_there_as_back() {
        for name in ["a", "pay", "look", "model", "wide"] {
            assert_eq!(distance(name, name).total, 0.0);
            assert_eq!(distance(name, "a").total, distance("a", name).total);
        }
    }

    #[test]
    fn weights_shift_the_whole_to_an_element() {
        let weights = Weights::default().with(Element::R, 0.0).unwrap();
        assert!(Weights::default().with(Element::R, f64::NAN).is_err());
        let task = TaskSpec::from_json("t.json", r#"{ "name": "t", "parameters": {
            "r": { "role": "variant", "type": "number", "affects": ["R"], "range": [0, 1], "default": 0 },
            "o": { "role": "variant", "type": "boolean", "affects": ["O"], "choices": [true, false], "default": true } },
            "variants": { "a": {}, "b": { "r": 1 } } }"#).unwrap();
        let distance = variant_distance(&task.variant("a").unwrap(), &task.variant("b").unwrap(), &weights).unwrap();
        assert_eq!((distance.total, distance.element(Element::R)), (0.0, Some(1.0)));
    }
}
