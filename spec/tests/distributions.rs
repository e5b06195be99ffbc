//! Moments, CDFs and quantiles of distributions, compared with scipy's values and with their definitions. Draws are tested in
//! the generator.

use driftworld_spec::{Distribution, Number, Spread, Value};
use proptest::prelude::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    distribution: Distribution,
    mean: f64,
    variance: f64,
    cdf: Vec<[f64; 2]>,
    quantile: Vec<[f64; 2]>,
}

/// The difference of two numbers, relative to the expected one, or absolute if that is below 1.
fn relative_error(found: f64, expected: f64) -> f64 {
    (found - expected).abs() / expected.abs().max(1.0)
}

/// The values come from scipy, through `oracles/distributions.py`.
#[test]
fn moments_cumulative_function_and_quantiles_agree_with_scipy() {
    let text = include_str!("oracles/distributions.json");
    let cases: Vec<Case> = serde_json::from_str(text).expect("the oracle file has the form that its script writes");
    assert!(cases.len() >= 40);
    for case in cases {
        let name = case.distribution.to_string();
        assert_eq!(case.distribution.fault(), None, "{name}");
        // scipy itself loses digits in the variances of narrow distributions far from 0, because it subtracts squares.
        let tolerance = 1e-9;
        let mean = case.distribution.mean().expect("it draws numbers");
        assert!(
            relative_error(mean, case.mean) < tolerance,
            "{name}: mean {mean}, expected {}",
            case.mean
        );
        let variance = case.distribution.variance().expect("it draws numbers");
        assert!(
            relative_error(variance, case.variance) < tolerance,
            "{name}: variance {variance}, expected {}",
            case.variance
        );
        for [x, expected] in case.cdf {
            let found = case.distribution.cdf(x).expect("it draws numbers");
            // Binomials of 100,000 use the logarithm of the gamma function, about 1e6, with a precision of 1e-10.
            assert!(
                (found - expected).abs() < 1e-10,
                "{name}: cdf({x}) is {found}, expected {expected}"
            );
        }
        for [p, expected] in case.quantile {
            let found = case.distribution.quantile(p).expect("it draws numbers");
            // At 1 - 1e-9, a quantile moves with the last bits of p.
            assert!(
                relative_error(found, expected) < 1e-7,
                "{name}: quantile({p}) is {found}, expected {expected}"
            );
        }
    }
}

/// Any valid distribution of numbers, except mixtures.
fn any_family() -> impl Strategy<Value = Distribution> {
    prop_oneof![
        (-9.0..9.0, 0.01..9.0).prop_map(|(low, wide): (f64, f64)| Distribution::Uniform { low, high: low + wide }),
        (-9_i32..9, 0_i32..9).prop_map(|(low, wide)| Distribution::IntegerUniform {
            low: low.into(),
            high: (low + wide).into()
        }),
        (-9.0..9.0, 0.0..4.0).prop_map(|(mean, std)| Distribution::Normal { mean, std }),
        (-3.0..3.0, 0.1..4.0, -3.0..3.0, 0.1..3.0).prop_map(|(mean, std, low, wide): (f64, f64, f64, f64)| {
            Distribution::TruncatedNormal {
                mean,
                std,
                low: mean + std * low,
                high: mean + std * (low + wide),
            }
        }),
        (-2.0..2.0, 0.0..0.8).prop_map(|(mu, sigma)| Distribution::LogNormal { mu, sigma }),
        (0.01..9.0).prop_map(|rate| Distribution::Exponential { rate }),
        (0.2..9.0, 0.2..9.0).prop_map(|(alpha, beta)| Distribution::Beta {
            alpha,
            beta,
            low: Some(-1.0),
            high: None
        }),
        (-9.0..9.0, 0.1..9.0, 0.0..=1.0).prop_map(|(low, wide, share): (f64, f64, f64)| {
            Distribution::Triangular {
                low,
                mode: low + wide * share,
                high: low + wide,
            }
        }),
        (-9.0..9.0, 0.0..4.0).prop_map(|(value, noise): (f64, f64)| {
            Distribution::Perturb {
                value,
                noise,
                low: Some(-5.0),
                high: Some(5.0),
            }
        }),
        (0.0..=1.0).prop_map(|p| Distribution::Bernoulli { p }),
        (0_u32..40, 0.0..=1.0).prop_map(|(n, p)| Distribution::Binomial { n: n.into(), p }),
        (0.0..90.0).prop_map(|mean| Distribution::Poisson { mean }),
        (0.01..=1.0).prop_map(|p| Distribution::Geometric { p }),
        prop::collection::vec((-9.0..9.0, 0.0..3.0), 1..5).prop_map(|atoms: Vec<(f64, f64)>| {
            let weights = atoms.iter().map(|atom| atom.1 + 0.01).collect();
            Distribution::Choice {
                values: atoms.into_iter().map(|atom| Value::Number(atom.0)).collect(),
                weights: Some(weights),
            }
        }),
    ]
}

/// Any valid distribution of numbers.
fn any_numbers() -> impl Strategy<Value = Distribution> {
    any_family().prop_recursive(2, 6, 3, |inner| {
        prop::collection::vec((inner, 0.01..3.0), 1..4).prop_map(|parts: Vec<(Distribution, f64)>| {
            let (parts, weights) = parts.into_iter().unzip();
            Distribution::Mixture {
                parts,
                weights: Some(weights),
            }
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 512), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn quantile_and_cumulative_function_are_inverse(law in any_numbers(), p in 0.001..0.999_f64, q in 0.001..0.999_f64) {
        prop_assert_eq!(law.fault(), None);
        let quantile = |p| law.quantile(p).expect("it draws numbers");
        let cdf = |x| law.cdf(x).expect("it draws numbers");
        let x = quantile(p);
        let margin = 1e-9 * x.abs().max(1.0);
        prop_assert!(cdf(x + margin) >= p - 1e-9, "{law}: at least {p} lies up to {x}, found {}", cdf(x));
        prop_assert!(cdf(x - margin) <= p + 1e-9, "{law}: at most {p} lies below {x}, found {}", cdf(x - margin));
        prop_assert!((p <= q) == (quantile(p) <= quantile(q)) || quantile(p) == quantile(q), "{law}");
        prop_assert!(cdf(x) >= cdf(x - 1.0) && (0.0..=1.0).contains(&cdf(x)));
    }

    #[test]
    fn distribution_round_trips_through_json(law in any_numbers()) {
        let text = serde_json::to_string(&law).expect("a distribution serialises");
        prop_assert_eq!(serde_json::from_str::<Distribution>(&text).expect("a written distribution can be read"), law);
        prop_assert!(serde_json::from_str::<Distribution<Number>>(&text).is_ok());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 64), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mean_and_variance_agree_with_the_quantiles(law in any_family()) {
        // Midpoints of 400 equal shares of probability: this cuts the tails and is coarse, so the tolerance is wide.
        let shares = 400;
        let numbers: Vec<f64> = (0..shares)
            .map(|k| law.quantile((f64::from(k) + 0.5) / f64::from(shares)).expect("it draws numbers"))
            .collect();
        let mean = numbers.iter().sum::<f64>() / f64::from(shares);
        let variance = numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(shares);
        let (own, spread) = (law.mean().expect("numbers"), law.variance().expect("numbers"));
        prop_assert!((mean - own).abs() <= 0.03 * spread.sqrt() + 0.01, "{law}: mean {own}, by quantiles {mean}");
        prop_assert!(variance <= spread * 1.1 + 0.02, "{law}: variance {spread}, by quantiles {variance}");
        prop_assert!(variance >= spread * 0.7 - 0.02 || spread > 50.0, "{law}: variance {spread}, by quantiles {variance}");
    }

    #[test]
    fn mixture_has_the_moments_of_its_parts(parts in prop::collection::vec((any_family(), 0.01..3.0), 1..5)) {
        let (parts, weights): (Vec<Distribution>, Vec<f64>) = parts.into_iter().unzip();
        let total: f64 = weights.iter().sum();
        let mean_of = |of: &dyn Fn(&Distribution) -> f64| -> f64 {
            parts.iter().zip(&weights).map(|(part, weight)| weight * of(part)).sum::<f64>() / total
        };
        let mean = |law: &Distribution| law.mean().expect("numbers");
        let square = |law: &Distribution| law.variance().expect("numbers") + mean(law) * mean(law);
        let (first, second) = (mean_of(&mean), mean_of(&square));
        let mixture = Distribution::Mixture { parts: parts.clone(), weights: Some(weights.clone()) };
        prop_assert!((mean(&mixture) - first).abs() <= 1e-9 * first.abs().max(1.0));
        prop_assert!((square(&mixture) - second).abs() <= 1e-9 * second.max(1.0));
    }
}

fn is_close(found: [[f64; 2]; 2], expected: [[f64; 2]; 2]) -> bool {
    (0..2).all(|i| (0..2).all(|j| (found[i][j] - expected[i][j]).abs() < 1e-9))
}

#[test]
fn planar_moments_match_closed_forms() {
    let covariance = |law: &Distribution| law.planar_moments().expect("it draws points").covariance;
    let gaussian = |std, correlation| Distribution::Gaussian {
        mean: [1.0, 2.0],
        std,
        correlation,
        covariance: None,
    };
    assert!(is_close(
        covariance(&gaussian(Some(Spread::Round(3.0)), None)),
        [[9.0, 0.0], [0.0, 9.0]]
    ));
    assert!(is_close(
        covariance(&gaussian(Some(Spread::Axes([3.0, 2.0])), Some(-0.5))),
        [[9.0, -3.0], [-3.0, 4.0]]
    ));
    let disc = Distribution::Disc {
        center: [0.0, 0.0],
        radius: 4.0,
    };
    assert!(is_close(covariance(&disc), [[4.0, 0.0], [0.0, 4.0]]));
    // Two points 2 apart along x with equal weights: variance 1 along x, none along y.
    let two = Distribution::Mixture {
        parts: [-1.0, 1.0]
            .map(|x| Distribution::Constant {
                value: Value::Point([x, 5.0]),
            })
            .to_vec(),
        weights: None,
    };
    assert!(is_close(covariance(&two), [[1.0, 0.0], [0.0, 0.0]]));
    // A grid's cells, counted one by one.
    let grid = |jitter| Distribution::Grid {
        low: [0.0, 0.0],
        high: [6.0, 4.0],
        columns: 3.0,
        rows: 2.0,
        jitter,
        order: driftworld_spec::Order::Turn,
    };
    assert!(is_close(covariance(&grid(None)), [[8.0 / 3.0, 0.0], [0.0, 1.0]]));
    assert!(is_close(covariance(&grid(Some(1.0))), [[3.0, 0.0], [0.0, 16.0 / 12.0]]));
}

#[test]
fn von_mises_is_centred_on_its_mean_direction() {
    let around = |mean, kappa| Distribution::VonMises { mean, kappa };
    assert_eq!(around(-90.0, 3.0).mean(), Some(270.0));
    assert_eq!(around(0.0, 3.0).variance(), None);
    assert!((around(10.0, 0.0).cdf(100.0).expect("a heading") - 0.75).abs() < 1e-12);
    assert!((around(350.0, 5.0).cdf(350.0).expect("a heading") - 0.5).abs() < 1e-12);
    let p = around(350.0, 5.0).cdf(20.0).expect("a heading");
    assert!((around(350.0, 5.0).quantile(p).expect("a heading") - 380.0).abs() < 1e-9);
}
