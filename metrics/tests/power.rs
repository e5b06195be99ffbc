//! The power of Welch's test, compared with independent simulations and with tests of random lifetimes.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use driftworld_metrics::{lifetimes_for, smallest_effect, welch_power};
use proptest::prelude::*;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

#[test]
fn needed_lifetimes_match_simulations() {
    // Standard deviations of actual learners. The expected numbers come from independent simulations, with an error of one or two
    // lifetimes in a hundred.
    let check = |deviations: [f64; 2], needed: [usize; 3], at_5_and_10: [f64; 2]| {
        for (effect, expected) in [10.0, 20.0, 30.0].into_iter().zip(needed) {
            let found = lifetimes_for(deviations, effect).unwrap();
            let slack = 1 + expected / 40;
            assert!(
                found.abs_diff(expected) <= slack,
                "{deviations:?} {effect}: {found} {expected}"
            );
        }
        for (num, expected) in [5, 10].into_iter().zip(at_5_and_10) {
            let found = welch_power([num; 2], deviations, 10.0).unwrap();
            assert!(
                (found - expected).abs() < 0.016,
                "{deviations:?} {num}: {found} {expected}"
            );
        }
    };
    check([9.7, 9.7], [16, 5, 4], [0.28, 0.57]);
    check([9.7, 22.8], [52, 14, 7], [0.12, 0.22]);
    check([22.8, 22.8], [84, 22, 11], [0.09, 0.15]);
    assert_eq!(lifetimes_for([9.7, 9.7], 10.0), Some(16));
}

/// A standard normal number, by Box and Muller.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (a, b): (f64, f64) = (rng.random_range(f64::MIN_POSITIVE..1.0), rng.random_range(0.0..1.0));
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// Welch's test of two samples: t and its degrees of freedom.
fn welch(samples: [&[f64]; 2]) -> (f64, f64) {
    let parts = samples.map(|sample| {
        let num = sample.len() as f64;
        let mean = sample.iter().sum::<f64>() / num;
        let variance = sample.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (num - 1.0);
        (mean, variance / num, num)
    });
    let [(mean_a, a, num_a), (mean_b, b, num_b)] = parts;
    let freedom = (a + b).powi(2) / (a * a / (num_a - 1.0) + b * b / (num_b - 1.0));
    ((mean_a - mean_b) / (a + b).sqrt(), freedom)
}

/// The chance beyond ±t, by integrating the density of Student's t.
fn p_value(t: f64, freedom: f64) -> f64 {
    let density = |x: f64| (1.0 + x * x / freedom).powf(-f64::midpoint(freedom, 1.0));
    // Substitutes x = tan(angle), so that the interval is finite.
    let area = |from: f64, to: f64| {
        let width = (to - from) / 400.0;
        (0..400)
            .map(|column| {
                let angle = from + (f64::from(column) + 0.5) * width;
                density(angle.tan()) / angle.cos().powi(2) * width
            })
            .sum::<f64>()
    };
    let half = std::f64::consts::FRAC_PI_2;
    area(t.abs().atan(), half) / area(0.0, half)
}

#[test]
fn simulated_tests_detect_as_often_as_predicted() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for (nums, deviations, effect) in [
        ([3, 3], [1.0, 1.0], 2.5),
        ([5, 9], [1.0, 3.0], 2.0),
        ([12, 4], [2.0, 0.5], 0.0),
    ] {
        let drawn: u32 = 3000;
        let detected = (0..drawn).filter(|_| {
            let a: Vec<f64> = (0..nums[0])
                .map(|_| effect + deviations[0] * normal(&mut rng))
                .collect();
            let b: Vec<f64> = (0..nums[1]).map(|_| deviations[1] * normal(&mut rng)).collect();
            let (t, freedom) = welch([&a, &b]);
            p_value(t, freedom) < 0.05
        });
        let share = detected.count() as f64 / f64::from(drawn);
        let found = welch_power(nums, deviations, effect).unwrap();
        // The tolerance is four standard errors.
        let slack = 4.0 * (found * (1.0 - found) / f64::from(drawn)).sqrt();
        assert!(
            (found - share).abs() < slack,
            "{nums:?} {deviations:?} {effect}: {found} {share}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(8, 24)))]

    #[test]
    fn power_grows_with_effect_and_lifetimes_in_any_unit(
        nums in [2_usize..30, 2_usize..30],
        deviations in [0.1..20.0_f64, 0.1..20.0_f64],
        effect in 0.0..40.0_f64,
        unit in 0.01..100.0_f64,
    ) {
        let power = welch_power(nums, deviations, effect).unwrap();
        prop_assert!((0.0..=1.0).contains(&power));
        prop_assert!(welch_power(nums, deviations, effect + 1.0).unwrap() >= power - 1e-9);
        // Agents are interchangeable, and the test is two-sided.
        let swapped = welch_power([nums[1], nums[0]], [deviations[1], deviations[0]], -effect).unwrap();
        prop_assert!((swapped - power).abs() < 1e-6, "{} {}", swapped, power);
        let scaled = welch_power(nums, deviations.map(|deviation| deviation * unit), effect * unit).unwrap();
        prop_assert!((scaled - power).abs() < 1e-6);
        let smallest = smallest_effect(nums, deviations).unwrap();
        prop_assert!((welch_power(nums, deviations, smallest).unwrap() - 0.8).abs() < 1e-3);
        if let Some(needed) = lifetimes_for(deviations, effect.max(0.5)) {
            prop_assert!(welch_power([needed; 2], deviations, effect.max(0.5)).unwrap() >= 0.8);
            if needed > 2 {
                prop_assert!(welch_power([needed - 1; 2], deviations, effect.max(0.5)).unwrap() < 0.8);
            }
        }
    }
}

#[test]
fn power_is_none_for_one_lifetime_or_without_deviation() {
    assert_eq!(welch_power([1, 5], [1.0, 1.0], 1.0), None);
    assert_eq!(welch_power([5, 5], [0.0, 0.0], 1.0), None);
    assert_eq!(lifetimes_for([1.0, 1.0], 0.0), None);
}
