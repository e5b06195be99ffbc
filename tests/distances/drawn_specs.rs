//! Generates random task specs: parameters of all roles and types with ranges, choices, weights, measures, conditions and
//! parametric distributions, four variants, and requirements.

use std::sync::Arc;

use driftworld::spec::{TaskSpec, Variant};
use proptest::prelude::*;
use serde_json::{Map, Value as Json, json};

/// The variants of a random spec. The last extends the one before.
pub(crate) const NAMES: [&str; 4] = ["v0", "v1", "v2", "v3"];

/// Minimum width of a random uniform distribution, which a requirement ensures.
pub(crate) const MIN_WIDTH: f64 = 0.125;

const COLORS: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 1.0, 1.0],
    [1.0, 0.0, 0.0],
    [0.125, 0.25, 0.875],
    [0.5, 0.75, 0.25],
    [0.5, 0.5, 0.5],
];

/// The kind of a parameter; some need further parameters for their distributions.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Number,
    Ratio,
    Integer,
    Heading,
    Color,
    Point,
    Vector,
    Boolean,
    Word,
    Costs,
    /// A uniform distribution, both ends of which are parameters.
    Uniform,
    /// A normal distribution with a parameter as its mean.
    Normal,
    /// A choice of three distributions.
    Distribution,
    Fixed,
    /// The same distribution in every variant.
    Drawn,
}

const KINDS: [Kind; 15] = [
    Kind::Number,
    Kind::Ratio,
    Kind::Integer,
    Kind::Heading,
    Kind::Color,
    Kind::Point,
    Kind::Vector,
    Kind::Boolean,
    Kind::Word,
    Kind::Costs,
    Kind::Uniform,
    Kind::Normal,
    Kind::Distribution,
    Kind::Fixed,
    Kind::Drawn,
];

/// The random numbers from which a parameter is generated.
#[derive(Clone, Debug)]
struct Seeds {
    kind: Kind,
    low: f64,
    width: f64,
    /// Positions of the default and of each variant's value in the domain: two numbers each, from 0 to 1.
    at: [[f64; 2]; 5],
    /// Which variants set the parameter.
    sets: [bool; 4],
    affects: Vec<&'static str>,
    weight: Option<f64>,
    is_gated: bool,
}

/// A random spec.
#[derive(Clone, Debug)]
pub(crate) struct Spec(pub(crate) Json);

impl Spec {
    /// The task, loaded.
    pub(crate) fn task(&self) -> Arc<TaskSpec> {
        let text = self.0.to_string();
        TaskSpec::from_json("drawn", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    /// The values that a variant sets, including those of the variant that it extends.
    pub(crate) fn set_by(&self, name: &str) -> Map<String, Json> {
        let own = self.0["variants"][name].as_object().cloned().unwrap_or_default();
        let mut all = own
            .get("extends")
            .map_or_else(Map::new, |base| self.set_by(base.as_str().expect("it is a name")));
        all.extend(own.into_iter().filter(|(key, _)| key != "extends"));
        all
    }

    /// The same spec with an additional last parameter.
    pub(crate) fn with_parameter(&self, name: &str, parameter: Json) -> Self {
        let mut more = self.clone();
        more.0["parameters"][name] = parameter;
        more
    }
}

/// All variants of a task with their names.
pub(crate) fn variants(task: &Arc<TaskSpec>) -> Vec<Variant> {
    let variant = |name: &&str| task.variant(name).unwrap_or_else(|error| panic!("{error}"));
    NAMES.iter().map(variant).collect()
}

/// Numbers from 0 to 1. All numbers here have exact sums, so that the ends of ranges are reached.
fn share() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 4 => (0..=64).prop_map(|at| f64::from(at) / 64.0)]
}

fn seeds() -> impl Strategy<Value = Seeds> {
    let elements = prop::sample::subsequence(vec!["S", "A", "T", "R", "O"], 1..=3);
    let at = prop::array::uniform5(prop::array::uniform2(share()));
    (
        prop::sample::select(KINDS.to_vec()),
        (-400..400).prop_map(|low| f64::from(low) / 8.0),
        (8..320).prop_map(|width| f64::from(width) / 8.0),
        at,
        prop::array::uniform4(prop::bool::weighted(0.7)),
        elements,
        prop::option::of(0.25..3.0_f64),
        prop::bool::weighted(0.3),
    )
        .prop_map(|(kind, low, width, at, sets, affects, weight, is_gated)| Seeds {
            kind,
            low,
            width,
            at,
            sets,
            affects,
            weight,
            is_gated,
        })
}

/// Random specs.
pub(crate) fn specs() -> impl Strategy<Value = Spec> {
    let gates = prop::array::uniform4(any::<bool>());
    let weights = prop::option::of((0.5..3.0_f64, 0.0..2.0_f64));
    (prop::collection::vec(seeds(), 1..7), gates, weights).prop_map(|(all, gates, weights)| {
        let mut parts = Parts::default();
        let gate = json!({ "role": "variant", "type": "boolean", "affects": ["T"], "choices": [true, false],
                           "default": true });
        parts.declare("gate", gate, [true, true, true, true], &gates.map(Json::from));
        for (index, seeds) in all.iter().enumerate() {
            parts.add(&format!("p{index}"), seeds);
        }
        let [v0, v1, v2, mut v3] = parts.variants;
        v3.insert("extends".to_owned(), json!("v2"));
        let mut spec = json!({ "name": "drawn", "parameters": parts.parameters, "require": parts.require,
                               "variants": { "v0": v0, "v1": v1, "v2": v2, "v3": v3 } });
        if let Some((reward, observation)) = weights {
            spec["element_weights"] = json!({ "R": reward, "O": observation });
        }
        Spec(spec)
    })
}

#[derive(Default)]
struct Parts {
    parameters: Map<String, Json>,
    require: Vec<String>,
    variants: [Map<String, Json>; 4],
}

impl Parts {
    fn declare(&mut self, name: &str, parameter: Json, sets: [bool; 4], values: &[Json; 4]) {
        self.parameters.insert(name.to_owned(), parameter);
        for ((variant, sets), value) in self.variants.iter_mut().zip(sets).zip(values) {
            if sets {
                variant.insert(name.to_owned(), value.clone());
            }
        }
    }

    fn add(&mut self, name: &str, seeds: &Seeds) {
        let affects = &seeds.affects;
        let mut common = json!({ "affects": affects });
        if let Some(weight) = seeds.weight {
            common["compare"]["weight"] = json!(weight);
        }
        if let Kind::Fixed | Kind::Drawn | Kind::Uniform | Kind::Normal = seeds.kind {
            return self.add_drawn(name, seeds, common);
        }
        if seeds.is_gated {
            common["read_if"] = json!("gate");
        }
        let (domain, value) = domain(seeds, &mut common);
        let [default, values @ ..] = seeds.at.map(|[first, second]| value(first, second));
        let mut parameter = json!({ "role": "variant", "default": default });
        for part in [domain, common] {
            let part = part.as_object().cloned().unwrap_or_default();
            parameter.as_object_mut().expect("it is an object").extend(part);
        }
        self.declare(name, parameter, seeds.sets, &values);
    }

    /// Adds a parameter that no variant sets, and the parameters that its distribution needs.
    fn add_drawn(&mut self, name: &str, seeds: &Seeds, mut common: Json) {
        let (low, width) = (seeds.low, seeds.width);
        let (first, second) = (format!("{name}_a"), format!("{name}_b"));
        let drawn_by = |range: [f64; 2], default: f64| json!({ "role": "variant", "type": "number", "affects": ["S"], "range": range, "default": default });
        let distribution = match seeds.kind {
            Kind::Fixed => {
                let fixed = json!({ "role": "fixed", "type": "number", "value": low });
                self.parameters.insert(name.to_owned(), fixed);
                return;
            }
            Kind::Uniform => {
                let ends = seeds.at.map(|[a, b]| {
                    let a = low + 2.0 * width * a;
                    (a, (low + width + 2.0 * width * b).max(a + 2.0 * MIN_WIDTH))
                });
                let [(a, b), ..] = ends;
                let [_, first_values @ ..] = ends.map(|(a, _)| json!(a));
                let [_, second_values @ ..] = ends.map(|(_, b)| json!(b));
                let ranges = [[low, low + 2.0 * width], [low + width, low + 3.0 * width]];
                self.declare(&first, drawn_by(ranges[0], a), [true; 4], &first_values);
                self.declare(&second, drawn_by(ranges[1], b), [true; 4], &second_values);
                self.require.push(format!("{first} + {MIN_WIDTH} <= {second}"));
                json!({ "uniform": { "low": { "param": first }, "high": { "param": second } } })
            }
            Kind::Normal => {
                let [mean, means @ ..] = seeds.at.map(|[at, _]| low + width * at);
                let range = [low, low + width];
                self.declare(&first, drawn_by(range, mean), seeds.sets, &means.map(Json::from));
                json!({ "normal": { "mean": { "param": first }, "std": 2.5 } })
            }
            _ => json!({ "uniform": { "low": low, "high": low + width } }),
        };
        for (key, value) in [("role", json!("randomized")), ("type", json!("number"))] {
            common[key] = value;
        }
        common["distribution"] = distribution;
        self.parameters.insert(name.to_owned(), common);
    }
}

type ValueAt = Box<dyn Fn(f64, f64) -> Json>;

/// The type and domain of a parameter that variants set, and its value at a position in the domain.
fn domain(seeds: &Seeds, common: &mut Json) -> (Json, ValueAt) {
    let (low, width) = (seeds.low, seeds.width);
    let within = |low: f64, high: f64| -> ValueAt { Box::new(move |at, _| json!((low + (high - low) * at).min(high))) };
    let among = |choices: &Json| -> ValueAt {
        let choices = choices.as_array().cloned().expect("it is a list");
        Box::new(move |at, _| choices[((at * choices.len() as f64) as usize).min(choices.len() - 1)].clone())
    };
    let listed = |kind: &str, choices: Json| {
        let value = among(&choices);
        (json!({ "type": kind, "choices": choices }), value)
    };
    match seeds.kind {
        Kind::Ratio => {
            common["compare"]["measure"] = json!("log_ratio");
            let (low, high) = (0.125 + low.abs(), 0.125 + low.abs() + width);
            (json!({ "type": "number", "range": [low, high] }), within(low, high))
        }
        Kind::Integer => {
            let (low, high) = (low.floor(), low.floor() + width.ceil());
            let value = move |at: f64, _| json!((low + (high - low) * at).floor() as i64);
            (
                json!({ "type": "integer", "range": [low as i64, high as i64] }),
                Box::new(value),
            )
        }
        Kind::Heading => {
            let high = low + (width * 9.0).min(359.0);
            let value = within(low, high);
            (json!({ "type": "heading", "range": [low, high] }), value)
        }
        Kind::Color => listed("color", json!(&COLORS[..3 + (width as usize) % 4])),
        Kind::Point => listed(
            "point",
            json!([[low, width], [width, 0.0], [-low, -width], [0.0, 0.25]]),
        ),
        Kind::Vector => {
            let high = low + width;
            let value =
                move |a: f64, b: f64| json!([a, b, 1.0 - a].map(|at| (low + (high - low) * at).clamp(low, high)));
            (json!({ "type": "vector", "range": [low, high] }), Box::new(value))
        }
        Kind::Boolean => listed("boolean", json!([false, true])),
        Kind::Word => listed("string", json!(["tree", "bush", "rock"])),
        Kind::Costs => {
            let (a, b, c) = (width, low.abs() + 1.0, width / 2.0 + 1.0);
            common["compare"]["costs"] = json!([[0.0, a, b], [a, 0.0, c], [b, c, 0.0]]);
            listed("string", json!(["walk", "run", "fly"]))
        }
        Kind::Distribution => {
            let uniform = |low: f64, high: f64| json!({ "uniform": { "low": low, "high": high } });
            let choices = json!([
                uniform(low, low + width),
                uniform(low - 3.0, low + width / 2.0),
                uniform(low + 1.0, low + 2.0 * width)
            ]);
            listed("distribution", choices)
        }
        _ => {
            let high = low + width;
            (json!({ "type": "number", "range": [low, high] }), within(low, high))
        }
    }
}
