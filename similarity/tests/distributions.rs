//! Compares distances between distributions with scipy and POT, and checks the metric properties that they claim.

use driftworld_similarity::distribution::{
    Measured, Method, bures_wasserstein, circular_wasserstein_1, energy, hellinger, jensen_shannon, kullback_leibler,
    planar_wasserstein_1, planar_wasserstein_2, total_variation, wasserstein_1, wasserstein_2,
};
use driftworld_spec::{Distribution, Value};
use proptest::prelude::*;
use serde::Deserialize;

/// A measure of the distance between two distributions.
type Measure = fn(&Distribution, &Distribution) -> Option<Measured>;

#[derive(Deserialize)]
struct Oracle {
    pairs: Vec<Pair>,
    samples: Vec<Samples>,
}

#[derive(Deserialize)]
struct Pair {
    a: Distribution,
    b: Distribution,
    #[serde(flatten)]
    expected: std::collections::BTreeMap<String, serde_json::Value>,
}

#[derive(Deserialize)]
struct Samples {
    x: Vec<f64>,
    y: Vec<f64>,
    headings: Vec<f64>,
    other_headings: Vec<f64>,
    #[serde(flatten)]
    expected: std::collections::BTreeMap<String, f64>,
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracle/distributions.json")).expect("the oracle is valid")
}

fn measure(name: &str) -> Measure {
    match name {
        "total_variation" => total_variation,
        "hellinger" => hellinger,
        "jensen_shannon" => jensen_shannon,
        "kullback_leibler" => kullback_leibler,
        "wasserstein_1" => wasserstein_1,
        "wasserstein_2" => wasserstein_2,
        "energy" => energy,
        "circular_wasserstein_1" => circular_wasserstein_1,
        "planar_wasserstein_2" => planar_wasserstein_2,
        _ => panic!("no measure is called {name}"),
    }
}

fn tolerance(found: Measured) -> f64 {
    match found.method {
        Method::Quadrature { tolerance } => tolerance,
        _ => 0.0,
    }
}

#[test]
fn distances_match_scipy_and_pot() {
    let pairs = oracle().pairs;
    assert!(pairs.len() > 130);
    let mut mismatches = Vec::new();
    for Pair { a, b, expected } in pairs {
        for (name, expected) in expected {
            let expected = expected.as_f64().unwrap_or(f64::INFINITY);
            let found = measure(&name)(&a, &b).expect("every pair here has this distance");
            // The oracle's own quadrature is accurate to about 1e-8; roots of small sums to less.
            let slack = 1e-7 * expected.max(1.0) + tolerance(found);
            let near = found.value == expected || (found.value - expected).abs() <= slack;
            // The documented accuracy, in degrees for headings.
            let max_tolerance = if name == "circular_wasserstein_1" { 1e-3 } else { 1e-5 };
            if !near || tolerance(found) > max_tolerance {
                mismatches.push(format!("{name} of {a} and {b}: {found:?}, expected {expected}"));
            }
        }
    }
    assert!(mismatches.is_empty(), "{}", mismatches.join("\n"));
}

#[test]
fn sample_distances_match_scipy_and_pot() {
    for case in oracle().samples {
        let choice = |numbers: &[f64]| Distribution::Choice {
            values: numbers.iter().map(|number| Value::Number(*number)).collect(),
            weights: None,
        };
        let (x, y) = (choice(&case.x), choice(&case.y));
        let (headings, others) = (choice(&case.headings), choice(&case.other_headings));
        for (name, found) in [
            ("wasserstein_1", wasserstein_1(&x, &y)),
            ("wasserstein_2", wasserstein_2(&x, &y)),
            ("energy", energy(&x, &y)),
            ("circular_wasserstein_1", circular_wasserstein_1(&headings, &others)),
        ] {
            let found = found.expect("the samples are numbers").value;
            let expected = case.expected[name];
            assert!((found - expected).abs() < 1e-8, "{name}: {found}, expected {expected}");
        }
    }
}

fn numbers() -> impl Strategy<Value = Distribution> {
    use Distribution::{
        Beta, Binomial, Exponential, IntegerUniform, LogNormal, Normal, Perturb, Poisson, Triangular, TruncatedNormal,
        Uniform,
    };
    let single = prop_oneof![
        (-5.0..5.0, 0.1..4.0).prop_map(|(low, wide)| Uniform { low, high: low + wide }),
        (-5.0..5.0, 0.1..4.0).prop_map(|(mean, std)| Normal { mean, std }),
        (-5.0..5.0, 0.2..3.0).prop_map(|(mean, std)| TruncatedNormal {
            mean,
            std,
            low: mean - std,
            high: mean + 3.0
        }),
        (-1.0..1.0, 0.1..1.5).prop_map(|(mu, sigma)| LogNormal { mu, sigma }),
        (0.2..5.0).prop_map(|rate| Exponential { rate }),
        (0.2..20.0, 0.2..20.0, -2.0..2.0).prop_map(|(alpha, beta, low)| Beta {
            alpha,
            beta,
            low: Some(low),
            high: Some(3.0)
        }),
        (0.1_f64..3.0, 0.1_f64..3.0).prop_map(|(rise, fall)| Triangular {
            low: -rise,
            mode: 0.0,
            high: fall
        }),
        (-1.0..1.0, 0.0..2.0).prop_map(|(value, noise)| Perturb {
            value,
            noise,
            low: Some(-1.0),
            high: None
        }),
        (-5..5, 0..6).prop_map(|(low, wide)| IntegerUniform {
            low: f64::from(low),
            high: f64::from(low + wide)
        }),
        (0u32..20, 0.0..=1.0).prop_map(|(n, p)| Binomial { n: f64::from(n), p }),
        (0.0..9.0).prop_map(|mean| Poisson { mean }),
        (-5_i64..5).prop_map(|value| Distribution::Constant {
            value: Value::Integer(value)
        }),
    ]
    .boxed();
    prop_oneof![
        4 => single.clone(),
        1 => (single.clone(), single, 0.1..1.0).prop_map(|(a, b, weight)| Distribution::Mixture {
            parts: vec![a, b],
            weights: Some(vec![weight, 1.0])
        }),
    ]
}

fn headings() -> impl Strategy<Value = Distribution> {
    prop_oneof![
        (0.0..360.0, 0.0..60.0).prop_map(|(mean, kappa)| Distribution::VonMises { mean, kappa }),
        (-200.0..200.0, 1.0..500.0).prop_map(|(low, wide)| Distribution::Uniform { low, high: low + wide }),
        prop::collection::vec(0.0..360.0, 1..5).prop_map(|values| Distribution::Choice {
            values: values.into_iter().map(Value::Number).collect(),
            weights: None
        }),
    ]
}

fn placements() -> impl Strategy<Value = Distribution> {
    prop_oneof![
        (-5.0..5.0, 0.5..4.0).prop_map(|(x, radius)| Distribution::Disc {
            center: [x, 1.0],
            radius
        }),
        (-5.0..5.0, 0.5..4.0).prop_map(|(x, wide)| Distribution::Box {
            low: [x, 0.0],
            high: [x + wide, 2.0]
        }),
        (-5.0..5.0, 0.1..2.0, -0.9..0.9).prop_map(|(x, std, correlation)| Distribution::Gaussian {
            mean: [x, 0.0],
            std: Some(driftworld_spec::Spread::Axes([std, 1.0])),
            correlation: Some(correlation),
            covariance: None
        }),
    ]
}

/// Checks the axioms of a metric, within the tolerances.
fn check_metric(measure: Measure, [a, b, c]: [&Distribution; 3], bound: f64) -> Result<(), TestCaseError> {
    let between = |a, b| measure(a, b).expect("there is a distance");
    let (ab, bc, ac, ba) = (between(a, b), between(b, c), between(a, c), between(b, a));
    prop_assert_eq!(between(a, a).value, 0.0);
    prop_assert!(ab.value >= 0.0 && ab.value <= bound, "{:?}", ab);
    let slack = 1e-7 * (1.0 + ab.value);
    prop_assert!(
        (ab.value - ba.value).abs() <= slack + tolerance(ab) + tolerance(ba),
        "{a} to {b}: {ab:?}, back {ba:?}"
    );
    let total_tolerance = tolerance(ab) + tolerance(bc) + tolerance(ac);
    prop_assert!(total_tolerance < 1e-2, "{a}, {b}, {c}: {total_tolerance}");
    prop_assert!(
        ac.value <= ab.value + bc.value + total_tolerance + slack,
        "{a} over {b} to {c}: {ab:?} and {bc:?}, straight {ac:?}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 40)))]

    #[test]
    fn probability_distances_are_metrics(a in numbers(), b in numbers(), c in numbers()) {
        for measure in [total_variation, hellinger, jensen_shannon] {
            check_metric(measure, [&a, &b, &c], 1.0)?;
        }
    }

    #[test]
    fn number_distances_are_metrics(a in numbers(), b in numbers(), c in numbers()) {
        for measure in [wasserstein_1, wasserstein_2, energy] {
            check_metric(measure, [&a, &b, &c], f64::INFINITY)?;
        }
    }

    #[test]
    fn heading_distances_are_metrics(a in headings(), b in headings(), c in headings()) {
        check_metric(circular_wasserstein_1, [&a, &b, &c], 180.0)?;
        // Numbers within one turn have the same distance on the line as on the circle.
        let within = |distribution: &Distribution| match distribution {
            Distribution::Uniform { low, high } => Distribution::Uniform {
                low: low.abs(),
                high: low.abs() + (high - low) * 0.3,
            },
            other => other.clone(),
        };
        let (a, b, c) = (within(&a), within(&b), within(&c));
        for measure in [total_variation, hellinger, jensen_shannon] {
            check_metric(measure, [&a, &b, &c], 1.0)?;
        }
    }

    #[test]
    fn measures_bound_each_other(a in numbers(), b in numbers()) {
        let of = |measure: Measure| {
            let found = measure(&a, &b).expect("there is a distance");
            (found.value, tolerance(found) + 1e-7 * (1.0 + found.value))
        };
        let (total, total_off) = of(total_variation);
        let (hellinger, hellinger_off) = of(hellinger);
        let (divergence, divergence_off) = of(kullback_leibler);
        let (first, first_off) = of(wasserstein_1);
        let (second, second_off) = of(wasserstein_2);
        prop_assert!(hellinger * hellinger <= total + total_off + 2.0 * hellinger_off);
        prop_assert!(total <= 2.0_f64.sqrt() * hellinger + total_off + 2.0 * hellinger_off);
        // Pinsker's inequality.
        prop_assert!(2.0 * total * total <= divergence + 4.0 * total_off + divergence_off, "{total}, {divergence}");
        prop_assert!(first <= second + first_off + second_off, "{first}, {second}");
        let means = a.mean().zip(b.mean()).map_or(0.0, |(a, b)| (a - b).abs());
        prop_assert!(means <= first + first_off, "{means}, {first}");
    }
}

proptest! {
    // Expensive cases: hundreds of points or nodes on either side.
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn point_distances_keep_their_bounds(a in placements(), b in placements()) {
        let of = |measure: Measure| measure(&a, &b).expect("both draw points");
        let (first, second) = (of(planar_wasserstein_1), of(planar_wasserstein_2));
        let least = bures_wasserstein(&a, &b).expect("both draw points");
        // Samples represent each distribution within a few per cent.
        let slack = if matches!(second.method, Method::Samples { .. }) { 0.1 } else { 1e-6 };
        prop_assert!(second.value >= least * (1.0 - slack) - slack, "{second:?}, at least {least}");
        let slack = if first.method == second.method { 1e-6 } else { 0.1 };
        prop_assert!(first.value <= second.value * (1.0 + slack) + slack, "{first:?}, {second:?}");
        for measure in [planar_wasserstein_1, planar_wasserstein_2] {
            prop_assert_eq!(measure(&a, &a).map(|found| found.value), Some(0.0));
            let (there, back) = (of(measure).value, measure(&b, &a).expect("both draw points").value);
            prop_assert!((there - back).abs() < 1e-9 * (1.0 + there));
        }
    }
}
