//! The distributions that draw colours: which colour chance decides, their means and covariances. Those of numbers are in `moments.rs`.

use super::{ChannelChance, Distribution};
use crate::Color;
use crate::value::{ParameterType, Value};

/// Mean and covariance of a distribution of colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorMoments {
    /// The mean of red, green and blue.
    pub mean: [f64; 3],
    /// The covariance matrix of red, green and blue.
    pub covariance: [[f64; 3]; 3],
}

impl ColorMoments {
    /// Of channels whose means, and means of products of two, are known.
    fn of(mean: [f64; 3], product: impl Fn(usize, usize) -> f64) -> Self {
        let entry = |i: usize, j: usize| product(i, j) - mean[i] * mean[j];
        Self {
            mean,
            covariance: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        }
    }

    /// Of a mixture of parts, each with its weight.
    fn mixed(parts: &[(Self, f64)]) -> Self {
        let total: f64 = parts.iter().map(|part| part.1).sum();
        let average =
            |of: &dyn Fn(&Self) -> f64| parts.iter().map(|(part, weight)| weight * of(part)).sum::<f64>() / total;
        let mean = [0, 1, 2].map(|k| average(&|part| part.mean[k]));
        let entry = |i: usize, j: usize| {
            average(&|part| part.covariance[i][j] + (part.mean[i] - mean[i]) * (part.mean[j] - mean[j]))
        };
        Self {
            mean,
            covariance: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        }
    }
}

impl<N> Distribution<N> {
    /// Whether it, or a part of it, draws colours out of a continuum: `color_uniform`, `color_normal`, `color_perturb` or
    /// `color_hsv`.
    pub fn draws_colors(&self) -> bool {
        match self {
            Self::ColorUniform { .. }
            | Self::ColorNormal { .. }
            | Self::ColorPerturb { .. }
            | Self::ColorHsv { .. } => true,
            Self::Mixture { parts, .. } => parts.iter().any(Self::draws_colors),
            _ => false,
        }
    }
}

impl Distribution<f64> {
    /// The colour that three numbers of chance in `0..1` decide; of channels that stray together, and of a constant, fewer do.
    ///
    /// Each channel rises with its number, so that variants under one seed share their chance; of `color_hsv` the numbers are
    /// those of hue, saturation and value. The same bits on every platform. `None` for choices and mixtures, which draw first
    /// what they take, and for distributions of anything else.
    pub fn color_at(&self, chance: [f64; 3]) -> Option<Color> {
        let (inside, limits) = match self {
            Self::Constant { value } => match value.cast(ParameterType::Color)? {
                Value::Color(color) => return Some(color),
                _ => return None,
            },
            Self::ColorUniform { from, to, channels } => {
                let colour = match channels {
                    // From the lesser to the greater end, whichever is named first.
                    ChannelChance::Apart => [0, 1, 2].map(|k| {
                        let (low, high) = (from.0[k].min(to.0[k]), from.0[k].max(to.0[k]));
                        low + (high - low) * chance[k]
                    }),
                    ChannelChance::Together => [0, 1, 2].map(|k| from.0[k] + (to.0[k] - from.0[k]) * chance[0]),
                };
                (colour, [[0.0; 3], [1.0; 3]])
            }
            Self::ColorNormal { .. } => {
                let laws = self.color_channels()?;
                let mut colour = [0.0; 3];
                for ((channel, law), chance) in colour.iter_mut().zip(&laws).zip(chance) {
                    *channel = law.quantile(chance)?;
                }
                (colour, [[0.0; 3], [1.0; 3]])
            }
            Self::ColorPerturb {
                value,
                noise,
                low,
                high,
                channels,
            } => {
                let noise = noise.to_array();
                let own = |k: usize| if *channels == ChannelChance::Together { 0 } else { k };
                let colour = [0, 1, 2].map(|k| value.0[k] + noise[k] * (2.0 * chance[own(k)] - 1.0));
                let end = |end: Option<&super::Channels>, else_: f64| end.map_or([else_; 3], |end| end.0);
                (colour, [end(low.as_ref(), 0.0), end(high.as_ref(), 1.0)])
            }
            Self::ColorHsv { .. } => {
                let [hue, saturation, value] = self.hsv_ends()?;
                let along = |[low, high]: [f64; 2], chance: f64| low + (high - low) * chance;
                let (hue, saturation, value) = (
                    along(hue, chance[0]),
                    along(saturation, chance[1]),
                    along(value, chance[2]),
                );
                let colour = [0, 1, 2].map(|k| value - value * saturation * dip(k, hue));
                (colour, [[0.0; 3], [1.0; 3]])
            }
            _ => return None,
        };
        Some(Color([0, 1, 2].map(|k| inside[k].clamp(limits[0][k], limits[1][k]))))
    }

    /// The distributions of red, green and blue, each by itself: numbers in `0..=1`.
    ///
    /// `None` for `color_hsv`, whose channels have no law with a name, for what holds it, and for distributions of anything
    /// but colours. Whether the channels stray together they do not say.
    pub fn color_channels(&self) -> Option<[Self; 3]> {
        let number = |number: f64| Self::Constant {
            value: Value::Number(number),
        };
        Some(match self {
            Self::Constant { value } => color_of(value)?.0.map(number),
            Self::Choice { values, weights } => {
                let colors = values.iter().map(color_of).collect::<Option<Vec<_>>>()?;
                [0, 1, 2].map(|k| Self::Choice {
                    values: colors.iter().map(|color| Value::Number(color.0[k])).collect(),
                    weights: weights.clone(),
                })
            }
            Self::ColorUniform { from, to, .. } => [0, 1, 2].map(|k| {
                let (low, high) = (from.0[k].min(to.0[k]), from.0[k].max(to.0[k]));
                if low < high {
                    Self::Uniform { low, high }
                } else {
                    number(low)
                }
            }),
            Self::ColorNormal { mean, std } => {
                let std = std.to_array();
                [0, 1, 2].map(|k| {
                    if std[k] == 0.0 {
                        return number(mean.0[k]);
                    }
                    Self::TruncatedNormal {
                        mean: mean.0[k],
                        std: std[k],
                        low: 0.0,
                        high: 1.0,
                    }
                })
            }
            Self::ColorPerturb {
                value,
                noise,
                low,
                high,
                ..
            } => {
                let noise = noise.to_array();
                [0, 1, 2].map(|k| Self::Perturb {
                    value: value.0[k],
                    noise: noise[k],
                    low: Some(low.as_ref().map_or(0.0, |low| low.0[k])),
                    high: Some(high.as_ref().map_or(1.0, |high| high.0[k])),
                })
            }
            Self::Mixture { parts, weights } => {
                let parts = parts.iter().map(Self::color_channels).collect::<Option<Vec<_>>>()?;
                [0, 1, 2].map(|k| Self::Mixture {
                    parts: parts.iter().map(|part| part[k].clone()).collect(),
                    weights: weights.clone(),
                })
            }
            _ => return None,
        })
    }

    /// Whether each channel has chance of its own, so that [`Distribution::color_channels`] says all of the distribution.
    pub fn has_independent_channels(&self) -> bool {
        match self {
            Self::ColorUniform { channels, .. } | Self::ColorPerturb { channels, .. } => {
                *channels == ChannelChance::Apart
            }
            Self::ColorNormal { .. } => true,
            Self::Constant { value } => color_of(value).is_some(),
            _ => false,
        }
    }

    /// Mean and covariance of red, green and blue, exact but for rounding; `None` if it draws anything but colours.
    pub fn color_moments(&self) -> Option<ColorMoments> {
        if self.has_independent_channels() {
            let laws = self.color_channels()?;
            let mut moments = ColorMoments {
                mean: [0.0; 3],
                covariance: [[0.0; 3]; 3],
            };
            for (k, law) in laws.iter().enumerate() {
                moments.mean[k] = law.mean()?;
                moments.covariance[k][k] = law.variance()?;
            }
            return Some(moments);
        }
        let weigh = |parts: Vec<ColorMoments>, weights: Option<&Vec<f64>>| {
            let weight = |k: usize| weights.map_or(1.0, |weights| weights[k]);
            let parts = parts.into_iter().enumerate().map(|(k, part)| (part, weight(k)));
            ColorMoments::mixed(&parts.collect::<Vec<_>>())
        };
        match self {
            Self::Choice { values, weights } => {
                let point = |value: &Value| {
                    Some(ColorMoments {
                        mean: color_of(value)?.0,
                        covariance: [[0.0; 3]; 3],
                    })
                };
                let parts = values.iter().map(point).collect::<Option<Vec<_>>>()?;
                Some(weigh(parts, weights.as_ref()))
            }
            Self::Mixture { parts, weights } => {
                let parts = parts.iter().map(Self::color_moments).collect::<Option<Vec<_>>>()?;
                Some(weigh(parts, weights.as_ref()))
            }
            Self::ColorHsv { .. } => self.hsv_moments(),
            // One number of chance moves all channels, each along straight lines between its knots.
            _ => {
                let knots = self.knots()?;
                let at = |u: f64| self.color_at([u; 3]).map_or([0.0; 3], |color| color.0);
                let mean = [0, 1, 2].map(|k| integral(&knots, |u| at(u)[k]));
                Some(ColorMoments::of(mean, |i, j| integral(&knots, |u| at(u)[i] * at(u)[j])))
            }
        }
    }

    /// The numbers of chance in `0..=1` between which channels that stray together go straight.
    fn knots(&self) -> Option<Vec<f64>> {
        let mut knots = vec![0.0, 1.0];
        match self {
            Self::ColorUniform { .. } => {}
            Self::ColorPerturb {
                value,
                noise,
                low,
                high,
                ..
            } => {
                let noise = noise.to_array();
                for k in (0..3).filter(|k| noise[*k] > 0.0) {
                    let low = low.as_ref().map_or(0.0, |low| low.0[k]);
                    let high = high.as_ref().map_or(1.0, |high| high.0[k]);
                    knots.extend([low, high].map(|limit| 0.5 * ((limit - value.0[k]) / noise[k] + 1.0)));
                }
            }
            _ => return None,
        }
        knots.retain(|knot| (0.0..=1.0).contains(knot));
        knots.sort_by(f64::total_cmp);
        Some(knots)
    }

    /// The least and greatest hue in degrees, saturation and value of a `color_hsv`.
    pub(super) fn hsv_ends(&self) -> Option<[[f64; 2]; 3]> {
        let Self::ColorHsv { hue, saturation, value } = self else {
            return None;
        };
        Some([
            hue.unwrap_or([0.0, 360.0]),
            saturation.unwrap_or([0.0, 1.0]),
            value.unwrap_or([0.0, 1.0]),
        ])
    }

    /// A channel is `v − v s d` for a dip `d` that the hue decides; hue, saturation and value do not depend on each other.
    fn hsv_moments(&self) -> Option<ColorMoments> {
        let [hue, saturation, value] = self.hsv_ends()?;
        let mean_of = |[low, high]: [f64; 2]| f64::midpoint(low, high);
        let square_of = |[low, high]: [f64; 2]| (low * low + low * high + high * high) / 3.0;
        // The dips go straight between multiples of 60 degrees.
        let mut knots = vec![hue[0], hue[1]];
        let (first, last) = ((hue[0] / 60.0).ceil() as i32, (hue[1] / 60.0).floor() as i32);
        knots.extend((first..=last).map(|sixth| 60.0 * f64::from(sixth)));
        knots.sort_by(f64::total_cmp);
        let width = hue[1] - hue[0];
        let over_hues = |of: &dyn Fn(f64) -> f64| {
            if width > 0.0 {
                integral(&knots, of) / width
            } else {
                of(hue[0])
            }
        };
        let dips = [0, 1, 2].map(|k| over_hues(&|hue| dip(k, hue)));
        let mean = dips.map(|dip| mean_of(value) * (1.0 - mean_of(saturation) * dip));
        Some(ColorMoments::of(mean, |i, j| {
            let both = over_hues(&|hue| dip(i, hue) * dip(j, hue));
            square_of(value) * (1.0 - mean_of(saturation) * (dips[i] + dips[j]) + square_of(saturation) * both)
        }))
    }

    /// Corners of a box in sRGB that holds all colours that a continuous law draws; `None` for any other distribution.
    pub(super) fn color_box(&self) -> Option<[Color; 2]> {
        let ends = match self {
            Self::ColorUniform { from, to, .. } => {
                let pick = |of: fn(f64, f64) -> f64| [0, 1, 2].map(|k| of(from.0[k], to.0[k]));
                [pick(f64::min), pick(f64::max)]
            }
            Self::ColorNormal { .. } => {
                let laws = self.color_channels()?;
                let mut ends = [[0.0; 3], [1.0; 3]];
                for (k, law) in laws.iter().enumerate() {
                    if let Self::Constant { value } = law {
                        let channel = value.as_number()?;
                        (ends[0][k], ends[1][k]) = (channel, channel);
                    }
                }
                ends
            }
            Self::ColorPerturb { .. } => [self.color_at([0.0; 3])?.0, self.color_at([1.0; 3])?.0],
            Self::ColorHsv { .. } => {
                let [_, saturation, value] = self.hsv_ends()?;
                [[value[0] * (1.0 - saturation[1]); 3], [value[1]; 3]]
            }
            _ => return None,
        };
        Some(ends.map(Color))
    }
}

/// The colour that a value is, or names.
fn color_of(value: &Value) -> Option<Color> {
    match value.cast(ParameterType::Color)? {
        Value::Color(color) => Some(color),
        _ => None,
    }
}

/// How far a hue in degrees takes a channel (0 red, 1 green, 2 blue) down from the value: 0 not at all, 1 as far as the
/// saturation goes.
fn dip(channel: usize, hue: f64) -> f64 {
    let turned = (5.0 - 2.0 * channel as f64 + hue / 60.0).rem_euclid(6.0);
    turned.min(4.0 - turned).clamp(0.0, 1.0)
}

/// The integral over pieces between knots of a function that is a polynomial of degree 3 or less on each: Simpson's rule.
fn integral(knots: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let piece = |low: f64, high: f64| (high - low) / 6.0 * (of(low) + 4.0 * of(f64::midpoint(low, high)) + of(high));
    knots.windows(2).map(|ends| piece(ends[0], ends[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(text: &str) -> Distribution {
        serde_json::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[track_caller]
    fn check(text: &str, chance: [f64; 3], expected: [f64; 3]) {
        let found = law(text).color_at(chance).expect("it draws colours").0;
        let near = found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found - expected).abs() < 1e-12);
        assert!(near, "{text} at {chance:?}: {found:?}, expected {expected:?}");
    }

    #[test]
    fn chance_decides_a_colour() {
        let between = r#"{"color_uniform": {"from": "red", "to": [0, 0, 0.5]}}"#;
        check(between, [0.25, 0.5, 0.5], [0.25, 0.0, 0.25]);
        let line = r#"{"color_uniform": {"from": "red", "to": [0, 0, 0.5], "channels": "together"}}"#;
        check(line, [0.25, 0.9, 0.9], [0.75, 0.0, 0.125]);
        check(
            r#"{"color_normal": {"mean": [0.5, 0.2, 1], "std": [0.1, 0, 0]}}"#,
            [0.5; 3],
            [0.5, 0.2, 1.0],
        );
        let noisy = r#"{"color_perturb": {"value": [0, 0.5, 0.5], "noise": 0.25, "channels": "together"}}"#;
        check(noisy, [0.25, 0.9, 0.9], [0.0, 0.375, 0.375]);
        check(noisy, [1.0, 0.0, 0.0], [0.25, 0.75, 0.75]);
    }

    /// The six corners of the colour circle, and the values that Python's `colorsys.hsv_to_rgb` gives.
    #[test]
    fn hues_saturations_and_values_are_those_of_hsv() {
        let circle = ["red", "yellow", "lime", "cyan", "blue", "magenta", "red"];
        for (k, name) in circle.into_iter().enumerate() {
            let expected = Color::from_name(name).expect("a CSS name").0;
            let full = r#"{"color_hsv": {"saturation": [1, 1], "value": [1, 1]}}"#;
            check(full, [k as f64 / 6.0, 0.3, 0.7], expected);
        }
        let all = r#"{"color_hsv": {}}"#;
        check(all, [0.1, 0.5, 0.8], [0.8, 0.64, 0.4]);
        check(all, [0.55, 0.25, 0.9], [0.675, 0.8325, 0.9]);
        // Across red, by degrees below 0 or above 360.
        let reds = r#"{"color_hsv": {"hue": [-30, 30], "saturation": [1, 1], "value": [1, 1]}}"#;
        check(reds, [0.0, 0.0, 0.0], [1.0, 0.0, 0.5]);
        check(reds, [1.0, 0.0, 0.0], [1.0, 0.5, 0.0]);
        check(
            &reds.replace("[-30, 30]", "[330, 390]"),
            [0.75, 0.0, 0.0],
            [1.0, 0.25, 0.0],
        );
    }

    /// The moments are those of a fine grid of chance.
    #[test]
    fn moments_are_those_of_what_is_drawn() {
        for text in [
            r#"{"color_uniform": {"from": "red", "to": [0.2, 0.4, 0.5]}}"#,
            r#"{"color_uniform": {"from": "red", "to": [0.2, 0.4, 0.5], "channels": "together"}}"#,
            r#"{"color_normal": {"mean": [0.5, 0.05, 1], "std": [0.1, 0.3, 0]}}"#,
            r#"{"color_perturb": {"value": [0.1, 0.5, 0.9], "noise": [0.3, 0, 0.2], "high": [1, 1, 0.95]}}"#,
            r#"{"color_perturb": {"value": [0.1, 0.5, 0.9], "noise": [0.3, 0.1, 0.2], "channels": "together"}}"#,
            r#"{"color_hsv": {"hue": [-50, 200], "saturation": [0.2, 0.9], "value": [0.5, 0.8]}}"#,
            r#"{"color_hsv": {}}"#,
        ] {
            let law = law(text);
            assert_eq!(law.fault(), None, "{text}");
            let moments = law.color_moments().expect("it draws colours");
            let steps = 60;
            let chance = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
            let mut colors = Vec::new();
            for a in 0..steps {
                for b in 0..steps {
                    let each = (0..steps).map(|c| law.color_at([chance(a), chance(b), chance(c)]));
                    colors.extend(each.map(|color| color.expect("it draws colours").0));
                }
            }
            let mean = |of: &dyn Fn(&[f64; 3]) -> f64| colors.iter().map(of).sum::<f64>() / colors.len() as f64;
            for i in 0..3 {
                assert!((mean(&|c| c[i]) - moments.mean[i]).abs() < 1e-3, "{text}: {moments:?}");
                for j in 0..3 {
                    let found = mean(&|c| (c[i] - moments.mean[i]) * (c[j] - moments.mean[j]));
                    assert!(
                        (found - moments.covariance[i][j]).abs() < 1e-3,
                        "{text}: {i} {j} {found} {moments:?}"
                    );
                }
            }
        }
    }

    /// Three trees of a map that the original's generator made: its template adds one uniform noise to all channels and cuts
    /// off what leaves 0..1.
    #[test]
    fn the_originals_template_of_a_tree_is_noise_of_channels_together() {
        let template = law(r#"{"color_perturb": {"value": [0, 0.5, 0.5], "noise": 0.25, "channels": "together"}}"#);
        for tree in [
            [0.0, 0.358_542_129_941_070_4, 0.358_542_129_941_070_4],
            [
                0.163_728_826_027_545_35,
                0.663_728_826_027_545_3,
                0.663_728_826_027_545_3,
            ],
            [
                0.028_286_179_236_649_61,
                0.528_286_179_236_649_6,
                0.528_286_179_236_649_6,
            ],
        ] {
            let chance = f64::midpoint((tree[1] - 0.5) / 0.25, 1.0);
            let found = template.color_at([chance, 0.5, 0.5]).expect("it draws colours").0;
            assert!(
                (0..3).all(|k| (found[k] - tree[k]).abs() < 1e-12),
                "{found:?}, expected {tree:?}"
            );
        }
    }

    #[test]
    fn a_mixture_lies_between_its_parts() {
        let text = r#"{"mixture": {"parts": [{"constant": {"value": "red"}}, {"color_normal": {"mean": "blue", "std": 0}},
            {"choice": {"values": ["lime", "lime"]}}], "weights": [1, 1, 2]}}"#;
        let law = law(text);
        let moments = law.color_moments().expect("it draws colours");
        assert_eq!(moments.mean, [0.25, 0.5, 0.25]);
        assert_eq!(moments.covariance[0], [0.1875, -0.125, -0.0625]);
        let channels = law.color_channels().expect("no part is of hues");
        assert_eq!(
            channels.map(|channel| channel.mean()),
            [Some(0.25), Some(0.5), Some(0.25)]
        );
        assert!(law.draws_colors() && law.yields(ParameterType::Color) && !law.yields(ParameterType::Vector));
    }
}
