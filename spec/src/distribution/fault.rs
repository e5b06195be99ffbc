//! Checks the numbers of a distribution. References and types are checked in `task/check/`.

use std::ops::RangeInclusive;

use super::{ChannelSpread, Channels, Distribution, Spread};

/// What was found and what was expected.
type Fault = Option<(String, &'static str)>;

impl Distribution<f64> {
    /// The first fault in the numbers, as (found, expected); `None` if the distribution can be drawn from.
    pub fn fault(&self) -> Fault {
        match self {
            Self::Constant { .. } | Self::Points { .. } => None,
            Self::Choice { values, weights } => weights_fault(values.len(), weights.as_deref()),
            Self::Mixture { parts, weights } => parts
                .iter()
                .find_map(Self::fault)
                .or_else(|| weights_fault(parts.len(), weights.as_deref())),
            Self::Uniform { low, high } => unless(low < high, format!("low {low} and high {high}"), "low below high"),
            Self::IntegerUniform { low, high } => {
                let whole = low.fract() == 0.0 && high.fract() == 0.0 && low.abs().max(high.abs()) <= 1e15;
                unless(
                    low <= high && whole,
                    format!("low {low} and high {high}"),
                    "whole numbers, low not above high",
                )
            }
            Self::Normal { std, .. } => unless(*std >= 0.0, format!("std {std}"), "a standard deviation of at least 0"),
            Self::TruncatedNormal { mean, std, low, high } => {
                let is_valid = *std > 0.0 && low < high && *low <= mean + 6.0 * std && *high >= mean - 6.0 * std;
                let found = format!("mean {mean}, std {std}, low {low}, high {high}");
                unless(
                    is_valid,
                    found,
                    "std above 0, low below high, and a range that reaches within 6 std of the mean",
                )
            }
            Self::LogNormal { mu, sigma } => {
                let is_valid = (0.0..=30.0).contains(sigma) && mu.abs() <= 300.0;
                unless(
                    is_valid,
                    format!("mu {mu} and sigma {sigma}"),
                    "mu in -300..300 and sigma in 0..30",
                )
            }
            Self::Exponential { rate } => unless(*rate > 0.0, format!("rate {rate}"), "a rate above 0"),
            Self::Beta { alpha, beta, low, high } => {
                let shapes = (1e-3..=1e6).contains(alpha) && (1e-3..=1e6).contains(beta);
                let is_valid = shapes && low.unwrap_or(0.0) < high.unwrap_or(1.0);
                let found = format!(
                    "alpha {alpha}, beta {beta}, low {}, high {}",
                    low.unwrap_or(0.0),
                    high.unwrap_or(1.0)
                );
                unless(is_valid, found, "alpha and beta in 0.001..1000000 and low below high")
            }
            Self::Triangular { low, mode, high } => {
                let is_valid = low < high && (*low..=*high).contains(mode);
                unless(
                    is_valid,
                    format!("low {low}, mode {mode}, high {high}"),
                    "low below high and the mode between them",
                )
            }
            Self::Perturb { noise, low, high, .. } => {
                let limits = low.zip(*high).is_none_or(|(low, high)| low <= high);
                unless(
                    limits && *noise >= 0.0,
                    describe_perturb(*noise, *low, *high),
                    "noise of at least 0 and low not above high",
                )
            }
            Self::VonMises { kappa, .. } => outside(0.0..=1e4, "kappa", *kappa, "a concentration in 0..10000"),
            Self::Bernoulli { p } => outside(0.0..=1.0, "p", *p, "a probability in 0..1"),
            Self::Binomial { n, p } => {
                let found = format!("n {n} and p {p}");
                let is_valid = (0.0..=1.0).contains(p) && n.fract() == 0.0 && (0.0..=100_000.0).contains(n);
                unless(is_valid, found, "a whole n in 0..100000 and p in 0..1")
            }
            Self::Poisson { mean } => outside(0.0..=1e5, "mean", *mean, "a mean in 0..100000"),
            Self::Geometric { p } => outside(1e-9..=1.0, "p", *p, "a probability in 0.000000001..1"),
            Self::Dirichlet { alpha } => {
                let is_valid = alpha.iter().all(|shape| (1e-3..=1e6).contains(shape));
                unless(is_valid, format!("alpha {alpha:?}"), "shapes in 0.001..1000000")
            }
            Self::ColorUniform { .. }
            | Self::ColorNormal { .. }
            | Self::ColorPerturb { .. }
            | Self::ColorHsv { .. } => self.color_fault(),
            planar => planar.planar_fault().or_else(|| planar.far_fault()),
        }
    }

    fn color_fault(&self) -> Fault {
        let color = |channels: &Channels| {
            let is_valid = channels.0.iter().all(|channel| (0.0..=1.0).contains(channel));
            unless(
                is_valid,
                format!("the colour {:?}", channels.0),
                "a colour with channels in 0..1",
            )
        };
        let spread = |name: &str, spread: &ChannelSpread| {
            let is_valid = spread.to_array().iter().all(|spread| (0.0..=10.0).contains(spread));
            unless(
                is_valid,
                format!("{name} {:?}", spread.to_array()),
                "a channel spread in 0..10",
            )
        };
        match self {
            Self::ColorUniform { from, to, .. } => color(from).or_else(|| color(to)),
            Self::ColorNormal { mean, std } => color(mean).or_else(|| spread("std", std)),
            Self::ColorPerturb {
                value,
                noise,
                low,
                high,
                ..
            } => {
                let limits = [low, high].into_iter().flatten().find_map(color);
                let crossed = low.as_ref().zip(high.as_ref()).and_then(|(low, high)| {
                    let is_valid = (0..3).all(|k| low.0[k] <= high.0[k]);
                    let found = format!("low {:?} and high {:?}", low.0, high.0);
                    unless(is_valid, found, "low not above high in any channel")
                });
                color(value).or_else(|| spread("noise", noise)).or(limits).or(crossed)
            }
            _ => self.hsv_ends().and_then(|[hue, saturation, value]| {
                let turns = hue[0] <= hue[1] && hue[1] - hue[0] <= 360.0 && hue[0] >= -360.0 && hue[1] <= 720.0;
                let part = |name: &str, ends: [f64; 2]| {
                    let is_valid = 0.0 <= ends[0] && ends[0] <= ends[1] && ends[1] <= 1.0;
                    unless(
                        is_valid,
                        format!("{name} {ends:?}"),
                        "two numbers in 0..1, the first not above the second",
                    )
                };
                let expected = "two hues in -360..720, the first not above the second, at most 360 degrees apart";
                unless(turns, format!("hue {hue:?}"), expected)
                    .or_else(|| part("saturation", saturation))
                    .or_else(|| part("value", value))
            }),
        }
    }

    fn planar_fault(&self) -> Fault {
        let rectangle = |low: &[f64; 2], high: &[f64; 2]| {
            let is_valid = low[0] < high[0] && low[1] < high[1];
            unless(
                is_valid,
                format!("low {low:?} and high {high:?}"),
                "low below high in both coordinates",
            )
        };
        match self {
            Self::Box { low, high } => rectangle(low, high),
            Self::Disc { radius, .. } => unless(*radius > 0.0, format!("radius {radius}"), "a radius above 0"),
            Self::Annulus { inner, outer, .. } => {
                let found = format!("inner {inner} and outer {outer}");
                unless(
                    *inner >= 0.0 && inner < outer,
                    found,
                    "inner at least 0 and below outer",
                )
            }
            Self::Gaussian {
                std,
                correlation,
                covariance,
                ..
            } => gaussian(std.as_ref(), *correlation, covariance.as_ref()),
            Self::Grid {
                low,
                high,
                columns,
                rows,
                jitter,
                ..
            } => rectangle(low, high).or_else(|| {
                let whole = |n: &f64| n.fract() == 0.0 && (1.0..=1000.0).contains(n);
                let jitter = jitter.unwrap_or(0.0);
                let is_valid = whole(columns) && whole(rows) && (0.0..=1.0).contains(&jitter);
                let found = format!("columns {columns}, rows {rows}, jitter {jitter}");
                unless(is_valid, found, "whole columns and rows in 1..1000 and jitter in 0..1")
            }),
            Self::Cells { walk, jitter, .. } => {
                let [least, most] = walk.unwrap_or([0.0, 0.0]);
                let far = unless(
                    least >= 0.0 && least <= most && most <= 1e6,
                    format!("a walk of {least} to {most} m"),
                    "two distances in 0..1000000 m, the first not above the second",
                );
                far.or_else(|| outside(0.0..=1.0, "a jitter of", jitter.unwrap_or(0.0), "a share in 0..1"))
            }
            Self::PoissonDisc { low, high, distance } => rectangle(low, high)
                .or_else(|| outside(1e-9..=600.0, "distance", *distance, "a distance above 0, at most 600 m")),
            _ => None,
        }
    }

    /// The fault of coordinates far beyond any arena; their squares could overflow.
    fn far_fault(&self) -> Fault {
        let mut far = None;
        let mapped: Result<Self, std::convert::Infallible> = self.try_map(&mut |number| {
            if number.is_nan() || number.abs() > 1e6 {
                far = Some(*number);
            }
            Ok(*number)
        });
        drop(mapped);
        far.map(|number| (crate::describe::plain_number(number), "metres in -1000000..1000000"))
    }
}

fn unless(is_valid: bool, found: String, expected: &'static str) -> Fault {
    (!is_valid).then_some((found, expected))
}

/// The fault of a number outside its limits.
fn outside(limits: RangeInclusive<f64>, name: &str, number: f64, expected: &'static str) -> Fault {
    unless(limits.contains(&number), format!("{name} {number}"), expected)
}

fn weights_fault(count: usize, weights: Option<&[f64]>) -> Fault {
    let weights = weights?;
    let is_valid = weights.len() == count
        && weights.iter().all(|weight| *weight >= 0.0 && weight.is_finite())
        && weights.iter().sum::<f64>() > 0.0;
    unless(
        is_valid,
        format!("weights {weights:?}"),
        "one weight per value, none negative, not all 0",
    )
}

fn describe_perturb(noise: f64, low: Option<f64>, high: Option<f64>) -> String {
    let limit = |name: &str, limit: Option<f64>| limit.map_or_else(String::new, |limit| format!(", {name} {limit}"));
    format!("noise {noise}{}{}", limit("low", low), limit("high", high))
}

fn gaussian(std: Option<&Spread>, correlation: Option<f64>, covariance: Option<&[[f64; 2]; 2]>) -> Fault {
    match (std, covariance) {
        (Some(_), Some(_)) | (None, None) => {
            let found = if std.is_some() {
                "std and covariance"
            } else {
                "neither std nor covariance"
            };
            Some((found.to_owned(), "one of std and covariance"))
        }
        (Some(std), None) => {
            let least = match std {
                Spread::Round(std) => *std,
                Spread::Axes([x, y]) => x.min(*y),
            };
            let correlation = correlation.unwrap_or(0.0);
            let is_valid = least >= 0.0 && (-1.0..=1.0).contains(&correlation);
            let found = format!("std {least} and correlation {correlation}");
            unless(
                is_valid,
                found,
                "standard deviations of at least 0 and a correlation in -1..1",
            )
        }
        (None, Some([[xx, xy], [yx, yy]])) => {
            let is_valid = xy == yx && *xx >= 0.0 && *yy >= 0.0 && xy * xy <= xx * yy && correlation.is_none();
            let found = format!("covariance [[{xx}, {xy}], [{yx}, {yy}]]");
            unless(
                is_valid,
                found,
                "a symmetric matrix without negative eigenvalues, and no correlation",
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each row is a distribution and the expectation that it violates, or "sound".
    fn check(rows: &str) {
        for row in rows.trim().lines() {
            let (json, expected) = row.split_once(" => ").expect("a row has two parts");
            let distribution: Distribution =
                serde_json::from_str(json).unwrap_or_else(|error| panic!("{row}: {error}"));
            let found = distribution.fault().map_or("sound", |(_, expected)| expected);
            assert_eq!(found, expected, "{json}");
        }
    }

    #[test]
    fn invalid_numbers_are_faults() {
        check(
            r#"
{"uniform": {"low": 0, "high": 1}} => sound
{"uniform": {"low": 1, "high": 1}} => low below high
{"normal": {"mean": 1, "std": -1}} => a standard deviation of at least 0
{"bernoulli": {"p": 1.5}} => a probability in 0..1
{"choice": {"values": [1, 2], "weights": [0, 0]}} => one weight per value, none negative, not all 0
{"choice": {"values": [1, 2], "weights": [1]}} => one weight per value, none negative, not all 0
{"mixture": {"parts": [{"bernoulli": {"p": 2}}]}} => a probability in 0..1
{"mixture": {"parts": [{"bernoulli": {"p": 1}}], "weights": [-1]}} => one weight per value, none negative, not all 0
{"annulus": {"center": [0, 0], "inner": 3, "outer": 2}} => inner at least 0 and below outer
{"binomial": {"n": 2.5, "p": 0.5}} => a whole n in 0..100000 and p in 0..1
{"gaussian": {"mean": [0, 0]}} => one of std and covariance
{"gaussian": {"mean": [0, 0], "std": [1, 2], "correlation": 0.5}} => sound
{"gaussian": {"mean": [0, 0], "covariance": [[4, 1], [1, 2]]}} => sound
{"gaussian": {"mean": [0, 0], "covariance": [[1, 2], [2, 1]]}} => a symmetric matrix without negative eigenvalues, and no correlation
{"exponential": {"rate": 0}} => a rate above 0
{"geometric": {"p": 0}} => a probability in 0.000000001..1
{"poisson_disc": {"low": [0, 0], "high": [1, 1], "distance": 0}} => a distance above 0, at most 600 m
{"dirichlet": {"alpha": [1, 0]}} => shapes in 0.001..1000000
{"von_mises": {"mean": 0, "kappa": -1}} => a concentration in 0..10000"#,
        );
    }

    #[test]
    fn invalid_colours_are_faults() {
        check(
            r#"
{"color_uniform": {"from": "red", "to": "blue"}} => sound
{"color_uniform": {"from": "red", "to": [0, 2, 0]}} => a colour with channels in 0..1
{"color_normal": {"mean": [-1, 0, 0], "std": 0}} => a colour with channels in 0..1
{"color_normal": {"mean": "red", "std": [0, 0, -1]}} => a channel spread in 0..10
{"color_perturb": {"value": "red", "noise": 11}} => a channel spread in 0..10
{"color_perturb": {"value": "red", "noise": 1, "low": [0, 0, 3]}} => a colour with channels in 0..1
{"color_perturb": {"value": "red", "noise": 1, "low": "gray", "high": "red"}} => low not above high in any channel
{"color_hsv": {"hue": [350, 370]}} => sound
{"color_hsv": {"hue": [350, 10]}} => two hues in -360..720, the first not above the second, at most 360 degrees apart
{"color_hsv": {"hue": [0, 361]}} => two hues in -360..720, the first not above the second, at most 360 degrees apart
{"color_hsv": {"saturation": [0.5, 0.4]}} => two numbers in 0..1, the first not above the second
{"color_hsv": {"value": [0.5, 1.4]}} => two numbers in 0..1, the first not above the second"#,
        );
    }
}
