//! Distributions of colours: maps random numbers to colours. Means and covariances are in `color_moments.rs`.

use super::{ChannelChance, Distribution};
use crate::Color;
use crate::value::Value;

impl<N> Distribution<N> {
    /// Whether it or one of its parts draws colours from a continuum: `color_uniform`, `color_normal`, `color_perturb`
    /// or `color_hsv`.
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
    /// The colour for three random numbers in `0..1`; fewer are used if the channels vary together, and none for a constant.
    ///
    /// Each channel increases with its number, so that variants under one seed share random numbers; for `color_hsv` the
    /// numbers stand for hue, saturation and value. Results are identical bit for bit on every platform. `None` for choices and
    /// mixtures, which must draw a value or part first, and for distributions of anything else.
    pub fn color_at(&self, units: [f64; 3]) -> Option<Color> {
        let (inside, limits) = match self {
            Self::Constant { value } => return value.as_color(),
            Self::ColorUniform { from, to, channels } => {
                let colour = match channels {
                    // From the lesser to the greater end, in whichever order they are given.
                    ChannelChance::Apart => [0, 1, 2].map(|k| {
                        let (low, high) = (from.0[k].min(to.0[k]), from.0[k].max(to.0[k]));
                        low + (high - low) * units[k]
                    }),
                    ChannelChance::Shared => [0, 1, 2].map(|k| from.0[k] + (to.0[k] - from.0[k]) * units[0]),
                };
                (colour, [[0.0; 3], [1.0; 3]])
            }
            Self::ColorNormal { .. } => {
                let laws = self.color_channels()?;
                let mut colour = [0.0; 3];
                for ((channel, law), unit) in colour.iter_mut().zip(&laws).zip(units) {
                    *channel = law.quantile(unit)?;
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
                let own = |k: usize| if *channels == ChannelChance::Shared { 0 } else { k };
                let colour = [0, 1, 2].map(|k| value.0[k] + noise[k] * (2.0 * units[own(k)] - 1.0));
                let end = |end: Option<&super::Channels>, default: f64| end.map_or([default; 3], |end| end.0);
                (colour, [end(low.as_ref(), 0.0), end(high.as_ref(), 1.0)])
            }
            Self::ColorHsv { .. } => {
                let ends = self.hsv_ends()?;
                let [hue, saturation, value] = [0, 1, 2].map(|k| ends[k][0] + (ends[k][1] - ends[k][0]) * units[k]);
                let colour = [0, 1, 2].map(|k| value - value * saturation * dip(k, hue));
                (colour, [[0.0; 3], [1.0; 3]])
            }
            _ => return None,
        };
        Some(Color([0, 1, 2].map(|k| inside[k].clamp(limits[0][k], limits[1][k]))))
    }

    /// The distributions of red, green and blue separately: numbers in `0..=1`.
    ///
    /// `None` for `color_hsv`, whose channels follow no named distribution, for anything that contains it, and for
    /// distributions of anything but colours. The result does not show whether the channels vary together.
    pub fn color_channels(&self) -> Option<[Self; 3]> {
        let number = |number: f64| Self::Constant {
            value: Value::Number(number),
        };
        Some(match self {
            Self::Constant { value } => value.as_color()?.0.map(number),
            Self::Choice { values, weights } => {
                let colors = values.iter().map(Value::as_color).collect::<Option<Vec<_>>>()?;
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

    /// Whether the channels are independent, so that [`Distribution::color_channels`] describes the distribution completely.
    pub fn has_independent_channels(&self) -> bool {
        match self {
            Self::ColorUniform { channels, .. } | Self::ColorPerturb { channels, .. } => {
                *channels == ChannelChance::Apart
            }
            Self::ColorNormal { .. } => true,
            Self::Constant { value } => value.as_color().is_some(),
            _ => false,
        }
    }

    /// Minimum and maximum of hue (in degrees), saturation and value of a `color_hsv`.
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

    /// Opposite corners of an sRGB box that contains all colours of a continuous distribution; `None` for any other
    /// distribution.
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

/// How far a hue in degrees lowers a channel (0 red, 1 green, 2 blue) below the value: 0 means not at all, 1 means as far as
/// the saturation allows.
pub(super) fn dip(channel: usize, hue: f64) -> f64 {
    let turned = (5.0 - 2.0 * channel as f64 + hue / 60.0).rem_euclid(6.0);
    turned.min(4.0 - turned).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(text: &str) -> Distribution {
        serde_json::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[track_caller]
    fn check(text: &str, units: [f64; 3], expected: [f64; 3]) {
        let found = law(text).color_at(units).expect("it draws colours").0;
        let near = found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found - expected).abs() < 1e-12);
        assert!(near, "{text} at {units:?}: {found:?}, expected {expected:?}");
    }

    #[test]
    fn color_at_maps_units_to_a_colour() {
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

    /// The six corners of the colour circle, with the values of Python's `colorsys.hsv_to_rgb`.
    #[test]
    fn color_hsv_agrees_with_colorsys() {
        let circle = ["red", "yellow", "lime", "cyan", "blue", "magenta", "red"];
        for (k, name) in circle.into_iter().enumerate() {
            let expected = Color::from_name(name).expect("a CSS name").0;
            let full = r#"{"color_hsv": {"saturation": [1, 1], "value": [1, 1]}}"#;
            check(full, [k as f64 / 6.0, 0.3, 0.7], expected);
        }
        let all = r#"{"color_hsv": {}}"#;
        check(all, [0.1, 0.5, 0.8], [0.8, 0.64, 0.4]);
        check(all, [0.55, 0.25, 0.9], [0.675, 0.8325, 0.9]);
        // A range across red may use degrees below 0 or above 360.
        let reds = r#"{"color_hsv": {"hue": [-30, 30], "saturation": [1, 1], "value": [1, 1]}}"#;
        check(reds, [0.0, 0.0, 0.0], [1.0, 0.0, 0.5]);
        check(reds, [1.0, 0.0, 0.0], [1.0, 0.5, 0.0]);
        check(
            &reds.replace("[-30, 30]", "[330, 390]"),
            [0.75, 0.0, 0.0],
            [1.0, 0.25, 0.0],
        );
    }

    /// Three trees from a map generated by L2Explorer: its template adds one uniform noise value to all channels and clips them
    /// to 0..1.
    #[test]
    fn l2explorer_tree_template_shares_noise_between_channels() {
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
            let unit = f64::midpoint((tree[1] - 0.5) / 0.25, 1.0);
            let found = template.color_at([unit, 0.5, 0.5]).expect("it draws colours").0;
            assert!(
                (0..3).all(|k| (found[k] - tree[k]).abs() < 1e-12),
                "{found:?}, expected {tree:?}"
            );
        }
    }
}
