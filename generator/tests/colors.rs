//! Tests that colours are drawn from continuous distributions as declared: per channel, under every sequence, along drifts, and
//! in groups. The distributions themselves are tested in the spec crate.

use std::sync::Arc;

use driftworld_generator::{Sampler, Sequence, drift};
use driftworld_spec::{ChannelSpread, Channels, Color, Distribution, TaskSpec, Value, Variant};

/// Number of draws per distribution.
const DRAWS: u64 = 20_000;

/// Critical value: the Kolmogorov statistic exceeds it in one of a thousand samples of the right distribution.
const KOLMOGOROV: f64 = 1.95;

fn task(parameters: &str, variants: &str) -> Arc<TaskSpec> {
    let text = format!(
        r#"{{ "version": 2, "name": "draws", "parameters": {{ {parameters} }}, "variants": {{ {variants} }},
            "world": {{ "environment_params": {{ "sky_color": {{ "param": "x" }} }} }} }}"#
    );
    TaskSpec::from_json("draws.json", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn color_parameter(distribution: &str) -> String {
    format!(r#""x": {{ "role": "randomized", "type": "color", "affects": ["O"], "distribution": {distribution} }}"#)
}

fn default(task: &Arc<TaskSpec>) -> Variant {
    task.variant("default").expect("it always exists")
}

fn law(variant: &Variant) -> Distribution {
    variant.distribution("x").expect("x is drawn")
}

fn colors(sampler: &Sampler, count: u64) -> Vec<[f64; 3]> {
    let value = |index| sampler.values(index).expect("no requirements").pop();
    let color = |index| match value(index) {
        Some((_, Value::Color(color))) => color.0,
        other => panic!("{other:?} is not a colour"),
    };
    (0..count).map(color).collect()
}

fn kolmogorov(mut drawn: Vec<f64>, cdf: impl Fn(f64) -> f64) -> f64 {
    drawn.sort_by(f64::total_cmp);
    let n = drawn.len() as f64;
    let gaps = drawn.iter().enumerate().map(|(k, x)| {
        let expected = cdf(*x);
        let (below, above) = (k as f64 / n, (k + 1) as f64 / n);
        (expected - below).abs().max((above - expected).abs())
    });
    gaps.fold(0.0, f64::max) * n.sqrt()
}

/// Checks the means and every entry of the covariance within five standard errors.
#[track_caller]
fn check_moments(name: &str, law: &Distribution, drawn: &[[f64; 3]]) {
    let moments = law.color_moments().expect("it draws colours");
    let n = drawn.len() as f64;
    let mean = |of: &dyn Fn(&[f64; 3]) -> f64| drawn.iter().map(of).sum::<f64>() / n;
    for i in 0..3 {
        let deviation = (mean(&|c| c[i]) - moments.mean[i]).abs();
        assert!(
            deviation <= 5.0 * (moments.covariance[i][i] / n).sqrt() + 1e-9,
            "{name}: mean {i} off by {deviation}"
        );
        for j in 0..3 {
            let product = |c: &[f64; 3]| (c[i] - moments.mean[i]) * (c[j] - moments.mean[j]);
            let found = mean(&product);
            let spread = mean(&|c| (product(c) - found).powi(2));
            let deviation = (found - moments.covariance[i][j]).abs();
            assert!(
                deviation <= 5.0 * (spread / n).sqrt() + 1e-9,
                "{name}: covariance {i} {j} off by {deviation}"
            );
        }
    }
}

#[test]
fn channels_follow_their_distributions() {
    for distribution in [
        r#"{ "color_uniform": { "from": "darkgreen", "to": [0.9, 0.1, 1] } }"#,
        r#"{ "color_uniform": { "from": "darkgreen", "to": [0.9, 0.1, 1], "channels": "together" } }"#,
        r#"{ "color_normal": { "mean": [0.5, 0.05, 1], "std": 0.2 } }"#,
        r#"{ "color_normal": { "mean": [0.3, 0.5, 0.7], "std": [0.01, 0.1, 3] } }"#,
        r#"{ "color_perturb": { "value": [0.3, 0.5, 0.7], "noise": 0.25 } }"#,
        r#"{ "color_perturb": { "value": [0.3, 0.5, 0.7], "noise": [0.1, 0.2, 0.3], "channels": "together" } }"#,
        r#"{ "mixture": { "parts": [{ "color_uniform": { "from": "black", "to": "gray" } },
                                    { "color_normal": { "mean": "gold", "std": 0.1 } }], "weights": [3, 1] } }"#,
    ] {
        let variant = default(&task(&color_parameter(distribution), ""));
        let drawn = colors(&Sampler::new(&variant, 11), DRAWS);
        let law = law(&variant);
        for (k, channel) in law.color_channels().expect("separate channels").iter().enumerate() {
            let cdf = |x| channel.cdf(x).expect("a channel is a number");
            let statistic = kolmogorov(drawn.iter().map(|color| color[k]).collect(), cdf);
            assert!(statistic < KOLMOGOROV, "{distribution}, channel {k}: {statistic}");
        }
        check_moments(distribution, &law, &drawn);
    }
}

#[test]
fn clipped_channels_reach_the_limits_with_the_right_frequency() {
    let distribution = r#"{ "color_perturb": { "value": [0.1, 0.5, 1], "noise": 0.4, "high": [1, 0.7, 1] } }"#;
    let variant = default(&task(&color_parameter(distribution), ""));
    let drawn = colors(&Sampler::new(&variant, 5), DRAWS);
    check_moments(distribution, &law(&variant), &drawn);
    for (k, limit, share) in [(0, 0.0, 0.375), (1, 0.7, 0.25), (2, 1.0, 0.5)] {
        let at = drawn.iter().filter(|color| color[k] == limit).count() as f64 / DRAWS as f64;
        assert!(
            (at - share).abs() < 5.0 * (0.25 / DRAWS as f64).sqrt(),
            "channel {k}: {at}"
        );
    }
}

/// Hue in degrees, saturation and value, as computed by Python's `colorsys.rgb_to_hsv`.
fn hsv([red, green, blue]: [f64; 3]) -> [f64; 3] {
    let (max, min) = (red.max(green).max(blue), red.min(green).min(blue));
    let width = max - min;
    let sixth = if red == max {
        (green - blue) / width
    } else if green == max {
        2.0 + (blue - red) / width
    } else {
        4.0 + (red - green) / width
    };
    [(60.0 * sixth).rem_euclid(360.0), width / max, max]
}

#[test]
fn hue_saturation_and_value_are_uniform_between_their_ends() {
    let distribution = r#"{ "color_hsv": { "hue": [-40, 110], "saturation": [0.2, 0.9], "value": [0.5, 1] } }"#;
    let variant = default(&task(&color_parameter(distribution), ""));
    let drawn = colors(&Sampler::new(&variant, 3), DRAWS);
    check_moments(distribution, &law(&variant), &drawn);
    for (k, low, high) in [(0, -40.0, 110.0), (1, 0.2, 0.9), (2, 0.5, 1.0)] {
        let turned = |x: f64| if k == 0 && x > 200.0 { x - 360.0 } else { x };
        let numbers = drawn.iter().map(|color| turned(hsv(*color)[k])).collect();
        let statistic = kolmogorov(numbers, |x| ((x - low) / (high - low)).clamp(0.0, 1.0));
        assert!(statistic < KOLMOGOROV, "{k}: {statistic}");
    }
}

#[test]
fn colour_does_not_depend_on_earlier_draws_or_other_parameters() {
    let own = color_parameter(r#"{ "color_normal": { "mean": "teal", "std": 0.2 } }"#);
    let other =
        r#""first": { "role": "randomized", "type": "color", "affects": ["O"], "distribution": { "color_hsv": {} } },"#;
    let alone = Sampler::new(&default(&task(&own, "")), 7);
    let together = Sampler::new(&default(&task(&format!("{other}{own}"), "")), 7);
    let sky = |sampler: &Sampler, index| {
        sampler
            .world(index)
            .expect("an empty world")
            .environment_params
            .sky_color
    };
    for index in [0, 1, 12_345, u64::MAX / 3] {
        assert_eq!(sky(&alone, index), sky(&together, index));
    }
    assert_eq!(Some(sky(&alone, 12_345).0), colors(&alone, 12_346).pop());
}

#[test]
fn variants_share_random_numbers_channel_by_channel() {
    let parameters = r#"
        "middle": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["black", "white", [0.25, 0.5, 0.75]], "default": "black" },
        "spread": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 1], "default": 0.1 },
        "x": { "role": "randomized", "type": "color", "affects": ["O"],
               "distribution": { "color_normal": { "mean": { "param": "middle" }, "std": { "param": "spread" } } } }"#;
    let task = task(
        parameters,
        r#""other": { "middle": [0.25, 0.5, 0.75], "spread": 0.3 }, "sure": { "spread": 0 }"#,
    );
    let of = |name: &str| task.variant(name).expect("the task declares it");
    let Distribution::ColorNormal { mean, std } = law(&of("other")) else {
        panic!("both variants use the same family")
    };
    assert_eq!((mean, std), (Channels([0.25, 0.5, 0.75]), ChannelSpread::Same(0.3)));
    let units_of = |name: &str| {
        let variant = of(name);
        let channels = law(&variant).color_channels().expect("separate channels");
        let drawn = colors(&Sampler::new(&variant, 1), 50);
        let units = move |color: [f64; 3]| [0, 1, 2].map(|k| channels[k].cdf(color[k]).expect("it is a number"));
        drawn.into_iter().map(units).collect::<Vec<_>>()
    };
    for (a, b) in units_of("default").into_iter().zip(units_of("other")) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{a:?} and {b:?}");
    }
    assert!(
        colors(&Sampler::new(&of("sure"), 1), 9)
            .iter()
            .all(|color| *color == [0.0; 3])
    );
}

#[test]
fn sequences_give_each_channel_one_world_per_stratum() {
    let own = color_parameter(r#"{ "color_uniform": { "from": "black", "to": "white" } }"#);
    let other = r#""n": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high": 1 } } },"#;
    let variant = default(&task(&format!("{other}{own}"), ""));
    let count = 64;
    for sequence in [Sequence::Sobol, Sequence::LatinHypercube { first: 0, count }] {
        let drawn = colors(&Sampler::new(&variant, 9).with_sequence(sequence), count);
        for k in 0..3 {
            let mut shares: Vec<u64> = drawn.iter().map(|color| (color[k] * count as f64) as u64).collect();
            assert!(!shares.is_sorted());
            shares.sort_unstable();
            assert_eq!(shares, (0..count).collect::<Vec<_>>(), "{sequence:?}, channel {k}");
        }
    }
}

const LAWS: &str = r#"
    "law": { "role": "variant", "type": "distribution", "affects": ["O"], "default": { "constant": { "value": "red" } }, "choices": [
        { "constant": { "value": "red" } },
        { "color_normal": { "mean": "red", "std": 0 } }, { "color_normal": { "mean": "blue", "std": [0.1, 0.2, 0.3] } },
        { "color_hsv": { "hue": [340, 360], "value": [0.5, 0.5] } }, { "color_hsv": { "hue": [0, 40] } },
        { "color_perturb": { "value": "gray", "noise": 0.1 } }, { "color_perturb": { "value": "gray", "noise": 0.3, "high": "silver" } },
        { "color_uniform": { "from": "red", "to": "blue" } }, { "color_uniform": { "from": "red", "to": "blue", "channels": "together" } } ] },
    "x": { "role": "randomized", "type": "color", "affects": ["O"], "distribution": { "param": "law" } }"#;

const OF_LAWS: &str = r#"
    "sure": { "law": { "color_normal": { "mean": "red", "std": 0 } } },
    "loose": { "law": { "color_normal": { "mean": "blue", "std": [0.1, 0.2, 0.3] } } },
    "before": { "law": { "color_hsv": { "hue": [340, 360], "value": [0.5, 0.5] } } },
    "after": { "law": { "color_hsv": { "hue": [0, 40] } } },
    "noisy": { "law": { "color_perturb": { "value": "gray", "noise": 0.1 } } },
    "cut": { "law": { "color_perturb": { "value": "gray", "noise": 0.3, "high": "silver" } } },
    "box": { "law": { "color_uniform": { "from": "red", "to": "blue" } } },
    "line": { "law": { "color_uniform": { "from": "red", "to": "blue", "channels": "together" } } }"#;

#[test]
fn drift_interpolates_colours_in_oklab_and_hues_the_shorter_way() {
    let task = task(LAWS, OF_LAWS);
    let of = |name: &str| task.variant(name).expect("the task declares it");
    let at = |from: &str, to: &str, t: f64| {
        let between = drift(&of(from), &of(to), t).unwrap_or_else(|error| panic!("{from} to {to}: {error}"));
        law(&between)
    };
    let Distribution::ColorNormal { mean, std } = at("sure", "loose", 0.5) else {
        panic!("distributions of one family are interpolated")
    };
    // The purple of CSS Color 4's color-mix(in oklab, red, blue).
    let near = mean
        .0
        .iter()
        .zip([0.548_6, 0.324_4, 0.635_4])
        .all(|(a, b)| (a - b).abs() < 0.002);
    assert!(near, "{mean:?}");
    assert_eq!(std, ChannelSpread::Each([0.05, 0.1, 0.15]));
    let Distribution::ColorHsv { hue, saturation, value } = at("before", "after", 0.5) else {
        panic!("distributions of one family are interpolated")
    };
    // The hue range goes from about 350 across 0 (red) to about 20.
    assert_eq!(hue, Some([-10.0, 20.0]));
    assert_eq!((saturation, value), (Some([0.0, 1.0]), Some([0.25, 0.75])));
    let Distribution::ColorPerturb { value, high, .. } = at("noisy", "cut", 0.5) else {
        panic!("distributions of one family are interpolated")
    };
    let gray = Color::from_name("gray").expect("it is a CSS name").0;
    let silver = Color::from_name("silver").expect("it is a CSS name").0;
    assert_eq!(
        (value, high),
        (Channels(gray), Some(Channels(silver.map(|c| f64::midpoint(1.0, c)))))
    );
    for (from, to) in [("box", "line"), ("default", "loose"), ("cut", "after")] {
        let Distribution::Mixture { parts, weights } = at(from, to, 0.25) else {
            panic!("{from} and {to} are mixed")
        };
        assert_eq!((parts.len(), weights), (2, Some(vec![0.75, 0.25])));
    }
}

#[test]
fn every_variant_of_a_drift_between_distributions_is_valid() {
    let task = task(LAWS, OF_LAWS);
    let variants = task.all_variants();
    for (from, to) in variants
        .iter()
        .flat_map(|from| variants.iter().map(move |to| (from, to)))
    {
        for step in 0..=8 {
            let variant = drift(from, to, f64::from(step) / 8.0).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(law(&variant).fault(), None);
            for color in colors(&Sampler::new(&variant, 2), 3) {
                assert!(color.iter().all(|channel| (0.0..=1.0).contains(channel)), "{color:?}");
            }
        }
    }
}

#[test]
fn each_object_of_a_group_has_its_own_colour() {
    let text = r#"{ "version": 2, "name": "woods", "parameters": {
            "leaf": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["green", "darkgoldenrod"], "default": "green" } },
        "groups": [{ "name": "trees", "count": 40, "placement": { "box": { "low": [-40, -40], "high": [40, 40] } },
            "object": { "class": "tree", "reward": { "param": "leaf", "index": 1 },
                "color": { "color_perturb": { "value": { "param": "leaf" }, "noise": 0.2, "channels": "together" } } } }],
        "variants": { "autumn": { "leaf": "darkgoldenrod" } } }"#;
    let task = TaskSpec::from_json("woods.json", text).unwrap_or_else(|error| panic!("{error}"));
    for (name, middle) in [("default", "green"), ("autumn", "darkgoldenrod")] {
        let world = Sampler::new(&task.variant(name).expect("the task declares it"), 1)
            .world(0)
            .expect("there is room for all trees");
        let middle = Color::from_name(middle).expect("it is a CSS name").0;
        let shades: Vec<f64> = world
            .objects
            .iter()
            .map(|tree| {
                let color = tree.color.expect("every tree has one").0;
                // The second channel of both is never clipped.
                let shade = color[1] - middle[1];
                let deviation = |k: usize| color[k] - (middle[k] + shade).clamp(0.0, 1.0);
                assert!((0..3).all(|k| deviation(k).abs() < 1e-12), "{color:?}");
                assert_eq!(tree.reward, middle[1]);
                shade
            })
            .collect();
        assert!(shades.iter().all(|shade| shade.abs() <= 0.2), "{shades:?}");
        let different: std::collections::BTreeSet<u64> = shades.iter().map(|shade| shade.to_bits()).collect();
        assert_eq!(different.len(), 40);
    }
}
