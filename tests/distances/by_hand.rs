//! Computes the distance of two variants from the JSON of their task alone, following the table in `docs/similarity.md`,
//! without the crate `similarity`.

#![expect(
    clippy::disallowed_methods,
    reason = "compared within a tolerance, and independent of the tested code"
)]

use std::collections::BTreeMap;

use serde_json::{Map, Value as Json};

use super::drawn_specs::{MIN_WIDTH, Spec};

/// The total distance, and the distance in each element.
#[derive(Debug)]
pub(crate) struct ByHand {
    pub(crate) total: f64,
    pub(crate) elements: BTreeMap<String, f64>,
}

/// The distance of two variants of a random spec.
pub(crate) fn distance(spec: &Spec, a: &str, b: &str) -> ByHand {
    let parameters = spec.0["parameters"].as_object().expect("it is an object");
    let [a, b] = [a, b].map(|name| effective_values(parameters, &spec.set_by(name)));
    let mut found = ByHand {
        total: 0.0,
        elements: BTreeMap::new(),
    };
    for (name, parameter) in parameters {
        let difference = match parameter["role"].as_str() {
            Some("variant") if !is_drawn_by(parameters, name) => of_values(parameter, &a[name], &b[name]),
            Some("randomized") => of_draws(parameters, &parameter["distribution"], &a, &b),
            _ => continue,
        };
        let difference = difference * parameter["compare"]["weight"].as_f64().unwrap_or(1.0);
        let weight = |element: &str| spec.0["element_weights"][element].as_f64().unwrap_or(1.0);
        let affects = parameter["affects"].as_array().expect("it is a list");
        let affects = affects.iter().map(|element| element.as_str().expect("it is a letter"));
        found.total += difference * affects.clone().map(weight).fold(0.0, f64::max);
        for element in affects {
            *found.elements.entry(element.to_owned()).or_default() += difference;
        }
    }
    found
}

/// The effective value of each parameter: the value that a variant sets, or the default if it sets none or is not read.
fn effective_values(parameters: &Map<String, Json>, set: &Map<String, Json>) -> BTreeMap<String, Json> {
    let is_open = set.get("gate").is_none_or(|gate| gate == true);
    let value = |(name, parameter): (&String, &Json)| {
        let is_read = is_open || parameter["read_if"] != "gate";
        let value = set.get(name).filter(|_| is_read).unwrap_or(&parameter["default"]);
        (name.clone(), value.clone())
    };
    parameters.iter().map(value).collect()
}

/// Whether the distribution of another parameter reads this parameter.
fn is_drawn_by(parameters: &Map<String, Json>, name: &str) -> bool {
    let reference = serde_json::json!({ "param": name }).to_string();
    let mut distributions = parameters.values().map(|other| other["distribution"].to_string());
    distributions.any(|text| text.contains(&reference))
}

fn number(json: &Json) -> f64 {
    json.as_f64().expect("it is a number")
}

fn numbers(json: &Json) -> Vec<f64> {
    json.as_array()
        .map_or_else(|| vec![number(json)], |list| list.iter().map(number).collect())
}

fn euclidean(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The distance of two values of a variant parameter, where 1 is the whole declared range.
fn of_values(parameter: &Json, a: &Json, b: &Json) -> f64 {
    let range = || numbers(&parameter["range"]);
    let width = || range()[1] - range()[0];
    let choices = || parameter["choices"].as_array().expect("it is a list");
    let over_choices = |difference: &dyn Fn(&Json, &Json) -> f64| {
        let pairs = choices().iter().flat_map(|a| choices().iter().map(move |b| (a, b)));
        difference(a, b) / pairs.map(|(a, b)| difference(a, b)).fold(0.0, f64::max)
    };
    match (parameter["type"].as_str(), &parameter["compare"]) {
        (Some("string"), compare) if compare["costs"].is_array() => {
            let index = |value: &Json| {
                choices()
                    .iter()
                    .position(|choice| choice == value)
                    .expect("it is a choice")
            };
            over_choices(&|a, b| number(&compare["costs"][index(a)][index(b)]))
        }
        (_, compare) if compare["measure"] == "log_ratio" => {
            (number(a) / number(b)).ln().abs() / (range()[1] / range()[0]).ln()
        }
        (Some("number" | "integer"), _) => (number(a) - number(b)).abs() / width(),
        (Some("heading"), _) => {
            let turn = (number(a) - number(b)).rem_euclid(360.0);
            turn.min(360.0 - turn) / width().min(180.0)
        }
        (Some("vector"), _) => euclidean(&numbers(a), &numbers(b)) / (width() * 3.0_f64.sqrt()),
        (Some("point"), _) => over_choices(&|a, b| euclidean(&numbers(a), &numbers(b))),
        (Some("color"), _) => over_choices(&|a, b| euclidean(&oklab(&numbers(a)), &oklab(&numbers(b)))),
        (Some("distribution"), _) => over_choices(&|a, b| {
            let ends = |json: &Json| [number(&json["uniform"]["low"]), number(&json["uniform"]["high"])];
            between_uniforms(ends(a), ends(b))
        }),
        _ => f64::from(u8::from(a != b)),
    }
}

/// The distance of two distributions of a randomized parameter, where 1 is the widest pair in the declared ranges.
fn of_draws(
    parameters: &Map<String, Json>,
    distribution: &Json,
    a: &BTreeMap<String, Json>,
    b: &BTreeMap<String, Json>,
) -> f64 {
    let name = |json: &Json| json["param"].as_str().map(str::to_owned);
    let range = |name: &str| numbers(&parameters[name]["range"]);
    let (uniform, normal) = (&distribution["uniform"], &distribution["normal"]);
    if let Some(mean) = name(&normal["mean"]) {
        return (number(&a[&mean]) - number(&b[&mean])).abs() / (range(&mean)[1] - range(&mean)[0]);
    }
    let (Some(low), Some(high)) = (name(&uniform["low"]), name(&uniform["high"])) else {
        return 0.0;
    };
    let ends = |values: &BTreeMap<String, Json>| [number(&values[&low]), number(&values[&high])];
    let corners = || {
        let pairs = range(&low)
            .into_iter()
            .flat_map(|a| range(&high).into_iter().map(move |b| [a, b]));
        pairs.filter(|[low, high]| low + MIN_WIDTH <= *high).collect::<Vec<_>>()
    };
    let pairs = corners()
        .into_iter()
        .flat_map(|a| corners().into_iter().map(move |b| (a, b)));
    between_uniforms(ends(a), ends(b)) / pairs.map(|(a, b)| between_uniforms(a, b)).fold(0.0, f64::max)
}

/// The Wasserstein-1 distance of two uniform distributions: the mean distance of their quantiles, which changes linearly from
/// the distance of the low ends to the distance of the high ends.
fn between_uniforms(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (from, to) = (a[0] - b[0], a[1] - b[1]);
    if from * to >= 0.0 {
        f64::midpoint(from, to).abs()
    } else {
        (from * from + to * to) / (2.0 * (from - to).abs())
    }
}

/// A colour in Oklab, after Ottosson.
pub(crate) fn oklab(rgb: &[f64]) -> [f64; 3] {
    let linear = |x: f64| {
        if x <= 0.04045 {
            x / 12.92
        } else {
            ((x + 0.055) / 1.055).powf(2.4)
        }
    };
    let [r, g, b] = [rgb[0], rgb[1], rgb[2]].map(linear);
    let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
    let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
    let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}
