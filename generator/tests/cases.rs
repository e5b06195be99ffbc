//! Properties of look-ups, tested on random tasks. Error messages about look-ups are tested in the spec crate.

use std::sync::Arc;

use driftworld_generator::{Sampler, Sequence};
use driftworld_spec::{Distribution, TaskSpec, Value};
use proptest::prelude::*;
use serde_json::{Value as Json, json};

fn task(json: &Json) -> Arc<TaskSpec> {
    TaskSpec::from_json("t.json", &json.to_string()).unwrap_or_else(|error| panic!("{error}\n{json:#}"))
}

fn worlds(task: &Arc<TaskSpec>, variant: &str, seed: u64) -> Vec<Json> {
    let sampler = Sampler::new(&task.variant(variant).unwrap_or_else(|error| panic!("{error}")), seed);
    (0..12).map(|index| world(&sampler, index)).collect()
}

/// A world, or the error: random walls may leave too little room for all objects.
fn world(sampler: &Sampler, index: u64) -> Json {
    match sampler.world(index) {
        Ok(world) => serde_json::to_value(world).expect("a world serialises"),
        Err(error) => json!({ "refused": error.code() }),
    }
}

/// A look-up over `of` with these two cases.
fn case(of: &str, red: &Json, blue: &Json) -> Json {
    json!({ "case": { "param": of }, "of": { "red": red, "blue": blue } })
}

/// The values, for `red` and for `blue`, of all keys in the test task that allow a look-up.
type Fillings = [[Json; 2]; 8];

/// A task with these fillings in a world, a group, a parameter and a distribution, and this declaration of `cue`.
fn filled(cue: &Json, [light, color, heading, count, placement, pay, high, layout]: &[Json; 8]) -> Json {
    json!({
        "version": 2, "name": "t",
        "parameters": {
            "cue": cue,
            "pay": { "role": "randomized", "type": "number", "affects": ["R"], "distribution": pay },
            "start": { "role": "randomized", "type": "heading", "affects": ["S"],
                       "distribution": { "uniform": { "low": 0, "high": 360 } } },
            "scale": { "role": "randomized", "type": "number", "affects": ["S"],
                       "distribution": { "uniform": { "low": 0.5, "high": high } } }
        },
        "world": { "environment_params": { "light_intensity": light, "layout": layout },
                   "agent_params": { "heading": { "param": "start" } } },
        "groups": [
            { "name": "trees", "count": 2, "object": { "class": "tree", "heading": heading, "scale": { "param": "scale" } },
              "placement": { "box": { "low": [-9, -9], "high": [9, 9] } }, "separation": 2 },
            { "name": "cubes", "count": count, "object": { "class": "cube", "color": color, "reward": { "param": "pay" } },
              "placement": placement }
        ],
        "variants": if cue["role"] == "variant" { json!({ "red": {}, "blue": { "cue": "blue" } }) } else { json!({}) }
    })
}

fn variant_cue() -> Json {
    json!({ "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "blue"], "default": "red" })
}

fn drawn_cue() -> Json {
    json!({ "role": "randomized", "type": "string", "affects": ["O"],
            "distribution": { "choice": { "values": ["red", "blue"], "weights": [1, 2] } } })
}

fn fillings() -> impl Strategy<Value = Fillings> {
    let numbers = prop::array::uniform2(1..40i32).prop_map(|numbers| numbers.map(|n| json!(f64::from(n) / 10.0)));
    let colors = prop::array::uniform2(prop::sample::select(vec!["gold", "red", "lime", "black"]))
        .prop_map(|names| names.map(|name| json!(name)));
    let laws = prop::array::uniform2(prop_oneof![
        (-5..5i32).prop_map(|n| json!(n)),
        (1..5i32).prop_map(|n| json!({ "uniform": { "low": -3, "high": n } })),
        (1..5i32).prop_map(|n| json!({ "normal": { "mean": n, "std": 1 } })),
        Just(json!({ "choice": { "values": [1, 2, 5] } })),
    ]);
    let headings = prop::array::uniform2(prop_oneof![
        (-400..400i32).prop_map(|n| json!(f64::from(n).rem_euclid(360.0))),
        Just(json!({ "param": "start" })),
        Just(json!({ "von_mises": { "mean": 90, "kappa": 2 } })),
    ]);
    let counts = prop::array::uniform2(prop_oneof![
        (0..4i32).prop_map(|n| json!(n)),
        (1..4i32).prop_map(|n| json!({ "integer_uniform": { "low": 0, "high": n } })),
    ]);
    let placements = prop::array::uniform2(prop_oneof![
        (3..9i32).prop_map(|n| json!({ "disc": { "center": [0, 0], "radius": n } })),
        (3..9i32).prop_map(|n| json!({ "points": { "values": [[n, n], [-n, n], [n, -n], [-n, -n]] } })),
        Just(json!({ "poisson_disc": { "low": [-9, -9], "high": [9, 9], "distance": 1 } })),
    ]);
    let layouts = prop::array::uniform2(prop_oneof![
        Just(json!({ "walls": [] })),
        Just(json!({ "rooms": { "grid": [2, 2], "room": [12, 12], "doorway": 4 } })),
        Just(json!({ "maze": { "cells": [4, 4], "cell": 7, "braid": 0.5 }, "standing": 0.2 })),
    ]);
    let highs = prop::array::uniform2((6..30i32).prop_map(|n| json!(f64::from(n) / 10.0)));
    (numbers, colors, headings, counts, placements, laws, highs, layouts).prop_map(
        |(light, color, heading, count, placement, pay, high, layout)| {
            [light, color, heading, count, placement, pay, high, layout]
        },
    )
}

fn looked_up(fillings: &Fillings, of: &str) -> [Json; 8] {
    fillings.each_ref().map(|[red, blue]| case(of, red, blue))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    /// A look-up over a variant parameter equals its case written out in place: worlds and distributions are identical.
    #[test]
    fn look_up_over_variant_parameter_equals_its_case_written_out(fillings in fillings(), seed in 0..9u64) {
        let looked_up = task(&filled(&variant_cue(), &looked_up(&fillings, "cue")));
        for (number, name) in ["red", "blue"].into_iter().enumerate() {
            let mut written = fillings.each_ref().map(|both| both[number].clone());
            if written[5].is_number() {
                written[5] = json!({ "constant": { "value": written[5] } });
            }
            let written = task(&filled(&variant_cue(), &written));
            prop_assert_eq!(worlds(&looked_up, name, seed), worlds(&written, name, seed));
            let [a, b] = [&looked_up, &written].map(|task| task.variant(name).expect("it is declared"));
            for parameter in ["pay", "scale", "start"] {
                prop_assert_eq!(a.distribution(parameter), b.distribution(parameter));
            }
            let covered = |variant| {
                let sampler = Sampler::new(variant, seed).with_sequence(Sequence::Sobol);
                (0..9).map(|index| format!("{:?}", sampler.values(index))).collect::<Vec<_>>()
            };
            prop_assert_eq!(covered(&a), covered(&b));
        }
    }

    /// With a look-up over a randomized parameter, each world equals one in which the case for its cue is written out.
    #[test]
    fn look_up_over_drawn_parameter_equals_its_case_in_each_world(fillings in fillings(), seed in 0..9u64) {
        let drawn = task(&filled(&drawn_cue(), &looked_up(&fillings, "cue")));
        let by_variant = task(&filled(&variant_cue(), &looked_up(&fillings, "cue")));
        let sampler = Sampler::new(&drawn.variant("default").expect("it always exists"), seed);
        let all = worlds(&drawn, "default", seed);
        let [red, blue] = ["red", "blue"].map(|name| worlds(&by_variant, name, seed));
        for (index, world) in all.iter().enumerate() {
            let values = sampler.values(index as u64).expect("the values can be sampled");
            let cue = values.iter().find(|(name, _)| *name == "cue").map(|(_, value)| value.to_string());
            let expected = if cue.as_deref() == Some("red") { &red[index] } else { &blue[index] };
            prop_assert_eq!(world, expected);
        }
    }

    /// Worlds can be sampled in any order, also by a new sampler.
    #[test]
    fn worlds_with_look_ups_can_be_drawn_in_any_order(fillings in fillings(), seed in 0..9u64, index in 0..12u64) {
        let drawn = task(&filled(&drawn_cue(), &looked_up(&fillings, "cue")));
        let variant = drawn.variant("default").expect("it always exists");
        let alone = world(&Sampler::new(&variant, seed), index);
        prop_assert_eq!(&alone, &worlds(&drawn, "default", seed)[index as usize]);
        // The task round-trips through its own JSON.
        let reread = TaskSpec::from_json("again.json", &drawn.to_json()).expect("our own output is valid");
        prop_assert_eq!(worlds(&reread, "default", seed), worlds(&drawn, "default", seed));
    }

    /// Adding a look-up for one key changes only the values of that key.
    #[test]
    fn added_look_up_changes_no_other_draw(fillings in fillings(), seed in 0..9u64) {
        let mut plain = fillings.each_ref().map(|[red, _]| red.clone());
        if plain[5].is_number() {
            plain[5] = json!({ "constant": { "value": plain[5] } });
        }
        let before = worlds(&task(&filled(&drawn_cue(), &plain)), "default", seed);
        for (index, keys) in [
            (0, &["/environment_params/light_intensity"][..]),
            (1, &["/objects/2/color", "/objects/3/color", "/objects/4/color", "/objects/5/color"]),
            (2, &["/objects/0/heading", "/objects/1/heading"]),
            (5, &["/objects/2/reward", "/objects/3/reward", "/objects/4/reward", "/objects/5/reward"]),
        ] {
            let mut looked_up_once = plain.clone();
            looked_up_once[index] = case("cue", &fillings[index][0], &fillings[index][1]);
            let mut after = worlds(&task(&filled(&drawn_cue(), &looked_up_once)), "default", seed);
            for (before, after) in before.iter().zip(&mut after) {
                for key in keys {
                    if let (Some(old), Some(new)) = (before.pointer(key), after.pointer_mut(key)) {
                        *new = old.clone();
                    }
                }
                prop_assert_eq!(before, &*after);
            }
        }
    }

    /// The distribution of a look-up gives the probability of each of its values.
    #[test]
    fn look_up_is_distributed_as_the_mixture_of_its_cases(weight in 1..9i32, chance in 0.1..0.9f64, seed in 0..99u64) {
        let task = task(&json!({ "version": 2, "name": "t", "parameters": {
            "pay": { "role": "randomized", "type": "number", "affects": ["R"], "distribution":
                { "case": { "param": "hot" }, "of": { "true": { "case": { "param": "cue" }, "of": { "red": 1 }, "else": 2 }, "false": 3 } } },
            "hot": { "role": "randomized", "type": "boolean", "affects": ["S"], "distribution": { "bernoulli": { "p":
                { "case": { "param": "cue" }, "of": { "red": chance }, "else": 0.5 } } } },
            "cue": { "role": "randomized", "type": "string", "affects": ["S"],
                     "distribution": { "choice": { "values": ["red", "blue"], "weights": [weight, 3] } } } } }));
        let variant = task.variant("default").expect("it always exists");
        let Some(Distribution::Choice { values, weights: Some(weights) }) = variant.distribution("pay") else {
            panic!("it is drawn from a list")
        };
        let red = f64::from(weight) / f64::from(weight + 3);
        let expected = [(1, red * chance), (2, (1.0 - red) * 0.5), (3, red * (1.0 - chance) + (1.0 - red) * 0.5)];
        for (value, share) in expected {
            let index = values.iter().position(|known| *known == Value::Integer(value)).expect("it can be drawn");
            prop_assert!((weights[index] - share).abs() < 1e-12);
        }
        let sampler = Sampler::new(&variant, seed);
        let count = 2000;
        let mut drawn = [0.0; 4];
        for index in 0..count {
            let values = sampler.values(index).expect("it can be drawn");
            drawn[values[0].1.as_number().expect("it is a number") as usize] += 1.0 / count as f64;
        }
        for (value, share) in expected {
            let spread = (share * (1.0 - share) / count as f64).sqrt();
            prop_assert!((drawn[value as usize] - share).abs() < 6.0 * spread, "{value}: {} of {share}", drawn[value as usize]);
        }
    }
}

#[test]
fn look_up_cases_may_be_names_of_choices() {
    let task = task(&json!({ "version": 2, "name": "t",
        "parameters": { "map": { "role": "variant", "type": "layout", "affects": ["S"], "default": "open", "choices": {
            "open": { "walls": [] }, "rooms": { "rooms": { "grid": [2, 2], "room": [8, 8], "doorway": 2 } } } } },
        "world": { "max_steps": { "case": { "param": "map" }, "of": { "open": 50 }, "else": 400 },
                   "environment_params": { "layout": { "param": "map" } } },
        "variants": { "open": {}, "rooms": { "map": "rooms" } } }));
    let steps = |variant| worlds(&task, variant, 1)[0]["max_steps"].clone();
    assert_eq!((steps("open"), steps("rooms")), (json!(50), json!(400)));
}
