//! Smoothing with a moving window over data with mirrored ends.

use std::f64::consts::PI;

use crate::lifetime::Lifetime;
use crate::statistics::sum;
use crate::{BlockType, Options, SmoothingMethod};

/// Maximum default window length.
const MAX_DEFAULT_LENGTH: usize = 100;

/// Smooths learning regimes, evaluation regimes if requested, and every regime of the experts.
pub(crate) fn smooth(lifetime: &mut Lifetime, options: &Options) {
    if options.smoothing_method == SmoothingMethod::Off {
        return;
    }
    let num_own = lifetime.regimes().len();
    for (index, regime) in lifetime.all_regimes_mut().enumerate() {
        let is_expert = index >= num_own;
        if is_expert || regime.block_type == BlockType::Train || options.smooth_eval_data {
            regime.performance = smoothed(&regime.performance, options.window_length, options.smoothing_method);
        }
    }
}

/// The values smoothed by a moving window; their number stays the same.
///
/// `window_length` counts values; `None`, or more values than there are, means a fifth of the data but at most 100. Windows shorter
/// than 3 leave the data unchanged. Both ends are mirrored without repeating the last value. QUIRK: an even window reaches one
/// value further back than ahead, an odd one two.
pub(crate) fn smoothed(values: &[f64], window_length: Option<usize>, method: SmoothingMethod) -> Vec<f64> {
    let num = values.len();
    let fifth = (num as f64 * 0.2) as usize;
    let length = window_length
        .filter(|length| *length <= num)
        .unwrap_or(fifth.min(MAX_DEFAULT_LENGTH));
    let weights = window(method, length);
    let total = sum(&weights);
    if length < 3 || total <= 0.0 {
        return values.to_vec();
    }
    // Normalises the weights before adding, as the reference does. Windows that tie in exact arithmetic, as on a
    // plateau of clamped data, then round as in the reference, so the same one is the first maximum. For windows
    // longer than 11, the reference's order of addition depends on the processor.
    let shares: Vec<f64> = weights.iter().map(|weight| weight / total).collect();
    let mirrored: Vec<f64> = (values[1..length].iter().rev())
        .chain(values)
        .chain(values[num - length..num - 1].iter().rev())
        .copied()
        .collect();
    // Of the num + length - 1 positions where the window fits, num are kept, starting here.
    let start = (length / 2).saturating_sub(1);
    moving_sums(&mirrored[start..start + num + length - 1], &shares)
}

/// Number of windows summed in parallel: enough independent sums to hide the latency of additions.
const LANES: usize = 16;

/// The weighted sum of each window, from the first position where it fits to the last.
///
/// Each sum adds its values from the first to the last, so that its bits do not depend on its neighbours.
fn moving_sums(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let num = values.len() + 1 - weights.len();
    let mut sums = Vec::with_capacity(num + LANES);
    while sums.len() + LANES <= num {
        let mut lanes = [0.0; LANES];
        for (part, weight) in values[sums.len()..].windows(LANES).zip(weights) {
            for (sum, value) in lanes.iter_mut().zip(part) {
                *sum += value * weight;
            }
        }
        sums.extend(lanes);
    }
    for part in values[sums.len()..].windows(weights.len()) {
        sums.push(
            part.iter()
                .zip(weights)
                .fold(0.0, |sum, (value, weight)| sum + value * weight),
        );
    }
    sums
}

/// Unnormalised weights of a symmetric window, computed from its middle as in `NumPy`.
fn window(method: SmoothingMethod, length: usize) -> Vec<f64> {
    let last = length.saturating_sub(1).max(1) as f64;
    let weight = |index: usize| {
        // From -last to last in steps of two.
        let position = (2 * index) as f64 - last;
        let turn = PI * position / last;
        match method {
            SmoothingMethod::Flat | SmoothingMethod::Off => 1.0,
            SmoothingMethod::Hanning => 0.5 + 0.5 * libm::cos(turn),
            SmoothingMethod::Hamming => 0.54 + 0.46 * libm::cos(turn),
            SmoothingMethod::Bartlett if position <= 0.0 => 1.0 + position / last,
            SmoothingMethod::Bartlett => 1.0 - position / last,
            SmoothingMethod::Blackman => 0.42 + 0.5 * libm::cos(turn) + 0.08 * libm::cos(2.0 * PI * position / last),
        }
    };
    (0..length).map(weight).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn window_of_three_averages_a_value_with_the_two_before_it() {
        // Mirrored: 9 4 | 1 4 9 16 | 9 4; the first four windows of three are kept: (9+4+1)/3, (4+1+4)/3, …
        let found = smoothed(&[1.0, 4.0, 9.0, 16.0], Some(3), SmoothingMethod::Flat);
        let expected = [14.0 / 3.0, 3.0, 14.0 / 3.0, 29.0 / 3.0];
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12),
            "{found:?}"
        );
    }

    #[test]
    fn window_of_four_averages_two_values_before_and_one_after() {
        // Mirrored: 16 9 4 | 1 4 9 16 25 | 16 9 4; the first window starts one later: 9 4 1 4.
        let found = smoothed(&[1.0, 4.0, 9.0, 16.0, 25.0], Some(4), SmoothingMethod::Flat);
        assert_eq!(found, [4.5, 4.5, 7.5, 13.5, 16.5]);
    }

    #[test]
    fn short_data_are_unchanged() {
        let check = |values: &[f64], length: Option<usize>| {
            assert_eq!(smoothed(values, length, SmoothingMethod::Flat), values);
        };
        check(&[], None);
        check(&[7.0], None);
        check(&[1.0, 5.0], Some(1));
        check(&[1.0, 5.0, 2.0], Some(2));
        check(&[1.0; 14], None);
        // A window longer than the data falls back to a fifth of four, which rounds down to 0.
        check(&[1.0, 5.0, 2.0, 4.0], Some(9));
    }

    #[test]
    fn window_shapes_match_the_textbook() {
        let check = |method: SmoothingMethod, expected: [f64; 5]| {
            let found = window(method, 5);
            assert!(
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12),
                "{method}: {found:?}"
            );
        };
        check(SmoothingMethod::Flat, [1.0; 5]);
        check(SmoothingMethod::Hanning, [0.0, 0.5, 1.0, 0.5, 0.0]);
        check(SmoothingMethod::Hamming, [0.08, 0.54, 1.0, 0.54, 0.08]);
        check(SmoothingMethod::Bartlett, [0.0, 0.5, 1.0, 0.5, 0.0]);
        check(SmoothingMethod::Blackman, [0.0, 0.34, 1.0, 0.34, 0.0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn parallel_sums_are_bit_identical_to_sequential_ones(
            values in proptest::collection::vec(-100.0..100.0, 7..100),
            weights in proptest::collection::vec(0.0..1.0, 3..7),
        ) {
            let sum = |part: &[f64]| part.iter().zip(&weights).fold(0.0, |sum: f64, (value, weight)| sum + value * weight);
            let expected: Vec<u64> = values.windows(weights.len()).map(|part| sum(part).to_bits()).collect();
            let found: Vec<u64> = moving_sums(&values, &weights).into_iter().map(f64::to_bits).collect();
            prop_assert_eq!(found, expected);
        }

        #[test]
        fn smoothing_keeps_length_and_bounds(
            values in proptest::collection::vec(-100.0..100.0, 0..60),
            length in proptest::option::of(1_usize..80),
            method in proptest::sample::select(SmoothingMethod::ALL),
        ) {
            let found = smoothed(&values, length, method);
            prop_assert_eq!(found.len(), values.len());
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
            prop_assert!(found.iter().all(|value| *value >= low - 1e-9 && *value <= high + 1e-9));
        }
    }
}
