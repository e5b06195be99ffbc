//! Wasserstein distances between distributions of colours.

use driftworld_spec::{Color, Distribution, Moments};

use super::measured::Measured;
use super::scatter::choose;
use super::values;
use super::wasserstein_2::wasserstein_2;
use crate::{Assignment, ColorMeasure, optimal_transport};

/// Number of sample colours per distribution with a density; also the maximum length of lists that are compared
/// exactly.
const NUM_SAMPLES: usize = 256;

/// Wasserstein-1 between two distributions of colours, with `measure` between single colours: in the measure's own unit, at
/// most its [`diameter`](ColorMeasure::diameter).
///
/// Exact between single colours and between lists of at most 256; otherwise from 256 evenly spread colours of each,
/// matched at minimum cost, which is accurate to a few per cent of the spreads. A metric among distributions with a
/// density (except that equal samples are 0 apart) if the measure is one. `None` if either draws anything but colours.
///
/// Source: Villani 2009, "Optimal Transport: Old and New", chapter 6.
///
/// # Example
/// ```
/// use driftworld_similarity::{ColorMeasure, distribution::color_wasserstein_1};
/// use driftworld_spec::{Channels, ChannelSpread, Distribution::ColorNormal};
/// let around = |color: [f64; 3], std| ColorNormal { mean: Channels(color), std: ChannelSpread::Same(std) };
/// let (black, grey) = (around([0.0; 3], 0.0), around([0.5; 3], 0.0));
/// let distance = color_wasserstein_1(&black, &grey, ColorMeasure::Srgb).unwrap();
/// assert!((distance.value - 0.75_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn color_wasserstein_1(a: &Distribution, b: &Distribution, measure: ColorMeasure) -> Option<Measured> {
    transport(a, b, measure, |distance| distance)
}

/// Wasserstein-2: the root mean square of the distances by which colours have to move, in the unit of `measure`.
///
/// Never below [`color_wasserstein_1`]. In sRGB channel by channel and as exact as [`wasserstein_2`](super::wasserstein_2()) if
/// the channels of both are independent; otherwise computed like [`color_wasserstein_1`]. `None` if either draws anything but
/// colours.
pub fn color_wasserstein_2(a: &Distribution, b: &Distribution, measure: ColorMeasure) -> Option<Measured> {
    if measure == ColorMeasure::Srgb && a.has_independent_channels() && b.has_independent_channels() {
        let (a, b) = (a.color_channels()?, b.color_channels()?);
        let (mut square, mut tolerance) = (0.0, 0.0);
        for (a, b) in a.iter().zip(&b) {
            let channel = wasserstein_2(a, b)?;
            square += channel.value * channel.value;
            tolerance += channel.tolerance();
        }
        return Some(Measured::within(square.sqrt(), tolerance));
    }
    transport(a, b, measure, |distance| distance * distance).map(Measured::root)
}

/// The mean of a function of the distances in the cheapest matching.
fn transport(a: &Distribution, b: &Distribution, measure: ColorMeasure, of: impl Fn(f64) -> f64) -> Option<Measured> {
    if a == b {
        return sample_colors(a).map(|_| Measured::closed(0.0));
    }
    let costs = |a: &[Color], b: &[Color]| -> Vec<f64> {
        let prepare =
            |colors: &[Color]| -> Vec<[f64; 3]> { colors.iter().map(|color| measure.prepare(*color)).collect() };
        let (a, b) = (prepare(a), prepare(b));
        let row = |x: &[f64; 3]| -> Vec<f64> { b.iter().map(|y| of(measure.between_prepared(*x, *y))).collect() };
        a.iter().flat_map(row).collect()
    };
    if let (Some((x, p)), Some((y, q))) = (weighted_colors(a), weighted_colors(b)) {
        let plan = optimal_transport(&p, &q, &costs(&x, &y)).ok()?;
        return Some(Measured::atoms(plan.cost.max(0.0)));
    }
    let (x, y) = (sample_colors(a)?, sample_colors(b)?);
    let total = Assignment::new().solve(&costs(&x, &y), x.len(), y.len()).ok()?;
    Some(Measured::samples(total.max(0.0) / x.len() as f64, x.len()))
}

/// The colours of a distribution without a density, each with its probability; `None` for others, and for long lists.
fn weighted_colors(distribution: &Distribution) -> Option<(Vec<Color>, Vec<f64>)> {
    let single = |law: &Distribution| law.has_independent_channels() && law.color_moments().is_some_and(is_a_point);
    if single(distribution) {
        return Some((vec![distribution.color_at([0.5; 3])?], vec![1.0]));
    }
    let found = values::probabilities(distribution)?;
    if found.len() > NUM_SAMPLES {
        return None;
    }
    let each = found.into_iter().map(|(value, mass)| Some((value.as_color()?, mass)));
    Some(each.collect::<Option<Vec<_>>>()?.into_iter().unzip())
}

fn is_a_point(moments: Moments<3>) -> bool {
    (0..3).all(|k| moments.covariance[k][k] == 0.0)
}

/// Deterministic sample colours of equal weight; `None` if it draws anything but colours.
///
/// All distributions use the same random numbers, so equal ones get equal colours.
fn sample_colors(distribution: &Distribution) -> Option<Vec<Color>> {
    // Hammersley's points: even along one axis, digit-reversed along the others.
    let units = (0..NUM_SAMPLES as u32).map(|k| {
        let even = (f64::from(k) + 0.5) / NUM_SAMPLES as f64;
        [even, radical_inverse(k, 2), radical_inverse(k, 3)]
    });
    units.map(|unit| color(distribution, unit)).collect()
}

/// The digits of a number in a base, mirrored at the radix point and moved off 0.
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut sum, mut share) = (0.5 / NUM_SAMPLES as f64, 1.0);
    while number > 0 {
        share /= f64::from(base);
        sum += share * f64::from(number % base);
        number /= base;
    }
    sum.min(1.0 - 1e-9)
}

/// The colour for three random numbers.
fn color(distribution: &Distribution, [u, v, w]: [f64; 3]) -> Option<Color> {
    match distribution {
        Distribution::Choice { values, weights } => values[choose(values.len(), weights.as_deref(), u).0].as_color(),
        Distribution::Mixture { parts, weights } => {
            let (index, within) = choose(parts.len(), weights.as_deref(), u);
            color(&parts[index], [within, v, w])
        }
        other => other.color_at([u, v, w]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::Method;
    use proptest::prelude::*;

    fn law(text: &str) -> Distribution {
        serde_json::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    fn any_law() -> impl Strategy<Value = Distribution> {
        let color = || prop::array::uniform3(0.0..=1.0_f64).prop_map(driftworld_spec::Channels);
        let spread = || prop::array::uniform3(0.0..0.5_f64).prop_map(driftworld_spec::ChannelSpread::Each);
        let chance = || {
            use driftworld_spec::ChannelChance::{Apart, Shared};
            prop::sample::select(vec![Apart, Shared])
        };
        prop_oneof![
            (color(), color(), chance()).prop_map(|(from, to, channels)| Distribution::ColorUniform {
                from,
                to,
                channels
            }),
            (color(), spread()).prop_map(|(mean, std)| Distribution::ColorNormal { mean, std }),
            (color(), spread(), chance()).prop_map(|(value, noise, channels)| Distribution::ColorPerturb {
                value,
                noise,
                low: None,
                high: None,
                channels
            }),
            (0.0..300.0_f64, 0.0..60.0_f64).prop_map(|(from, wide)| Distribution::ColorHsv {
                hue: Some([from, from + wide]),
                saturation: None,
                value: Some([0.5, 1.0])
            }),
        ]
    }

    /// Checks that samples have the moments of their distribution.
    #[test]
    fn sample_colours_have_the_moments_of_their_distribution() {
        for text in [
            r#"{"color_uniform": {"from": "black", "to": [1, 0.5, 0.2]}}"#,
            r#"{"color_uniform": {"from": "red", "to": [0.2, 0.4, 0.5], "channels": "together"}}"#,
            r#"{"color_normal": {"mean": [0.5, 0.2, 0.8], "std": [0.1, 0.2, 0.05]}}"#,
            r#"{"color_perturb": {"value": [0, 0.5, 0.5], "noise": 0.25, "channels": "together"}}"#,
            r#"{"color_hsv": {"hue": [60, 180], "saturation": [0.5, 1]}}"#,
            r#"{"mixture": {"parts": [{"constant": {"value": "red"}}, {"color_normal": {"mean": "gray", "std": 0.1}}], "weights": [1, 3]}}"#,
        ] {
            let law = law(text);
            let (colors, moments) = (sample_colors(&law).unwrap(), law.color_moments().unwrap());
            for k in 0..3 {
                let mean = colors.iter().map(|color| color.0[k]).sum::<f64>() / NUM_SAMPLES as f64;
                let square = colors.iter().map(|color| (color.0[k] - mean).powi(2)).sum::<f64>() / NUM_SAMPLES as f64;
                assert!((mean - moments.mean[k]).abs() < 0.01, "{text}: {k} {mean} {moments:?}");
                assert!(
                    (square - moments.covariance[k][k]).abs() < 0.004,
                    "{text}: {k} {square} {moments:?}"
                );
            }
        }
    }

    #[test]
    fn single_colours_are_compared_by_the_measure() {
        let (red, blue) = (Color([1.0, 0.0, 0.0]), Color([0.0, 0.0, 1.0]));
        let (a, b) = (
            law(r#"{"color_normal": {"mean": "red", "std": 0}}"#),
            law(r#"{"constant": {"value": "blue"}}"#),
        );
        for &measure in ColorMeasure::ALL {
            let expected = measure.between(red, blue);
            for found in [
                color_wasserstein_1(&a, &b, measure).unwrap(),
                color_wasserstein_2(&a, &b, measure).unwrap(),
            ] {
                assert!(
                    (found.value - expected).abs() < 1e-9 * expected,
                    "{measure:?}: {found:?}"
                );
            }
        }
    }

    #[test]
    fn lists_of_colours_are_matched_exactly() {
        let a = law(r#"{"choice": {"values": ["black", "white"], "weights": [3, 1]}}"#);
        let b = law(r#"{"choice": {"values": ["white", "black"]}}"#);
        let found = color_wasserstein_1(&a, &b, ColorMeasure::Srgb).unwrap();
        assert_eq!(found.method, Method::Atoms);
        assert!((found.value - 0.25 * 3.0_f64.sqrt()).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn colourless_distributions_have_no_distance() {
        let (red, number) = (
            law(r#"{"color_normal": {"mean": "red", "std": 0.1}}"#),
            law(r#"{"uniform": {"low": 0, "high": 1}}"#),
        );
        assert_eq!(color_wasserstein_1(&red, &number, ColorMeasure::Oklab), None);
        assert_eq!(color_wasserstein_2(&number, &number, ColorMeasure::Srgb), None);
        assert_eq!(super::super::wasserstein_1(&red, &red), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(6, 24)))]

        #[test]
        fn colour_transport_is_a_metric_for_metric_measures(a in any_law(), b in any_law(), c in any_law()) {
            let d = |a, b| color_wasserstein_1(a, b, ColorMeasure::Oklab).unwrap().value;
            prop_assert_eq!(d(&a, &a), 0.0);
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-9);
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9);
            prop_assert!((0.0..=1.0).contains(&d(&a, &b)));
        }

        /// Computes the same number in two ways: channel by channel, and by pairs of colours. For any pairing, the distance
        /// is at least the distance of the means.
        #[test]
        fn samples_approximate_the_closed_form(a in any_law(), b in any_law()) {
            let by_samples = transport(&a, &b, ColorMeasure::Srgb, |distance| distance * distance).unwrap().root().value;
            let found = color_wasserstein_2(&a, &b, ColorMeasure::Srgb).unwrap();
            prop_assert!((found.value - by_samples).abs() < 0.05, "{} to {}: {:?}, by samples {}", a, b, found, by_samples);
            let (p, q) = (a.color_moments().unwrap().mean, b.color_moments().unwrap().mean);
            let distance = ColorMeasure::Srgb.between_prepared(p, q);
            let first = color_wasserstein_1(&a, &b, ColorMeasure::Srgb).unwrap().value;
            prop_assert!(first >= distance - 0.02 && first <= by_samples + 1e-9, "{first}, means {distance} apart");
        }
    }
}
