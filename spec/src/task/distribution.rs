//! The distributions that specs declare, as data. Drawing from them is the generator's job, comparing them `similarity`'s.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::value::{ParameterType, Value};

/// A number in a distribution: itself, or that of a fixed or variant parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or {\"param\": NAME}")]
pub enum Number {
    /// The number itself.
    Literal(f64),
    /// The number that a parameter has.
    Param(ParamRef),
}

/// A reference to a parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParamRef {
    /// The parameter's name.
    pub param: String,
}

/// How values scatter. `N` is [`Number`] in a spec, where numbers may be references, and `f64` once a variant has settled them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[schemars(rename = "Distribution")]
pub enum Distribution<N = f64> {
    /// Every number in `low..high` alike.
    Uniform {
        /// Lower end, may occur.
        low: N,
        /// Upper end, above `low`; does not occur.
        high: N,
    },
    /// Every whole number in `low..=high` alike.
    IntegerUniform {
        /// Least value.
        low: N,
        /// Greatest value, not below `low`.
        high: N,
    },
    /// The normal (Gaussian) distribution.
    Normal {
        /// Mean.
        mean: N,
        /// Standard deviation, at least 0.
        std: N,
    },
    /// The normal distribution, drawn again while it falls outside `low..=high`.
    TruncatedNormal {
        /// Mean of the normal before truncation.
        mean: N,
        /// Standard deviation of the normal before truncation, above 0.
        std: N,
        /// Least value.
        low: N,
        /// Greatest value, above `low`.
        high: N,
    },
    /// One of a list, by weight.
    Choice {
        /// What may be chosen.
        #[schemars(length(min = 1, max = 10_000))]
        values: Vec<Value>,
        /// Weight of each value, at least 0, not all 0; all alike if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        weights: Option<Vec<N>>,
    },
    /// True with probability `p`.
    Bernoulli {
        /// Probability, 0..1.
        p: N,
    },
    /// How many of `n` tries succeed.
    Binomial {
        /// Number of tries, a whole number from 0 to 100,000.
        n: N,
        /// Probability that a try succeeds, 0..1.
        p: N,
    },
    /// Every point of a rectangle alike.
    Box {
        /// South-west corner in metres.
        low: [N; 2],
        /// North-east corner in metres, above `low` in both coordinates.
        high: [N; 2],
    },
    /// Every point of a disc alike.
    Disc {
        /// Centre in metres.
        center: [N; 2],
        /// Radius in metres, above 0.
        radius: N,
    },
    /// Every point of a ring alike.
    Annulus {
        /// Centre in metres.
        center: [N; 2],
        /// Inner radius in metres, at least 0.
        inner: N,
        /// Outer radius in metres, above `inner`.
        outer: N,
    },
    /// The round normal distribution of the plane.
    Gaussian {
        /// Mean in metres.
        mean: [N; 2],
        /// Standard deviation along each axis in metres, at least 0.
        std: N,
    },
    /// A list of points, taken in turn: the first object stands at the first, and so on, round and round.
    Points {
        /// The points in metres.
        #[schemars(length(min = 1, max = 100_000))]
        values: Vec<[N; 2]>,
    },
}

impl<N> Distribution<N> {
    /// The name as documents write it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Uniform { .. } => "uniform",
            Self::IntegerUniform { .. } => "integer_uniform",
            Self::Normal { .. } => "normal",
            Self::TruncatedNormal { .. } => "truncated_normal",
            Self::Choice { .. } => "choice",
            Self::Bernoulli { .. } => "bernoulli",
            Self::Binomial { .. } => "binomial",
            Self::Box { .. } => "box",
            Self::Disc { .. } => "disc",
            Self::Annulus { .. } => "annulus",
            Self::Gaussian { .. } => "gaussian",
            Self::Points { .. } => "points",
        }
    }

    /// Whether it draws points, so that objects can be placed by it.
    pub fn is_planar(&self) -> bool {
        matches!(
            self,
            Self::Box { .. } | Self::Disc { .. } | Self::Annulus { .. } | Self::Gaussian { .. } | Self::Points { .. }
        )
    }

    /// Whether all it draws can stand where this type is wanted.
    pub fn yields(&self, kind: ParameterType) -> bool {
        match self {
            Self::Uniform { .. } | Self::Normal { .. } | Self::TruncatedNormal { .. } => kind == ParameterType::Number,
            Self::IntegerUniform { .. } | Self::Binomial { .. } => ParameterType::Integer.fits(kind),
            Self::Bernoulli { .. } => kind == ParameterType::Boolean,
            Self::Choice { values, .. } => values.iter().all(|value| value.cast(kind).is_some()),
            _ => kind == ParameterType::Point,
        }
    }

    /// The same distribution with every number passed through `f`.
    pub(crate) fn try_map<M, E>(&self, f: &mut impl FnMut(&N) -> Result<M, E>) -> Result<Distribution<M>, E> {
        let mut pair = |[x, y]: &[N; 2]| Ok([f(x)?, f(y)?]);
        Ok(match self {
            Self::Box { low, high } => Distribution::Box {
                low: pair(low)?,
                high: pair(high)?,
            },
            Self::Points { values } => Distribution::Points {
                values: values.iter().map(pair).collect::<Result<_, E>>()?,
            },
            Self::Disc { center, radius } => Distribution::Disc {
                center: pair(center)?,
                radius: f(radius)?,
            },
            Self::Annulus { center, inner, outer } => Distribution::Annulus {
                center: pair(center)?,
                inner: f(inner)?,
                outer: f(outer)?,
            },
            Self::Gaussian { mean, std } => Distribution::Gaussian {
                mean: pair(mean)?,
                std: f(std)?,
            },
            Self::Uniform { low, high } => Distribution::Uniform {
                low: f(low)?,
                high: f(high)?,
            },
            Self::IntegerUniform { low, high } => Distribution::IntegerUniform {
                low: f(low)?,
                high: f(high)?,
            },
            Self::Normal { mean, std } => Distribution::Normal {
                mean: f(mean)?,
                std: f(std)?,
            },
            Self::TruncatedNormal { mean, std, low, high } => Distribution::TruncatedNormal {
                mean: f(mean)?,
                std: f(std)?,
                low: f(low)?,
                high: f(high)?,
            },
            Self::Choice { values, weights } => Distribution::Choice {
                values: values.clone(),
                weights: weights
                    .as_ref()
                    .map(|weights| weights.iter().map(&mut *f).collect())
                    .transpose()?,
            },
            Self::Bernoulli { p } => Distribution::Bernoulli { p: f(p)? },
            Self::Binomial { n, p } => Distribution::Binomial { n: f(n)?, p: f(p)? },
        })
    }
}

impl Distribution<f64> {
    /// What is wrong with the numbers, as (found, expected); nothing if all can be drawn from.
    pub fn fault(&self) -> Option<(String, &'static str)> {
        let unless = |fine: bool, found: String, expected| (!fine).then_some((found, expected));
        match self {
            Self::Uniform { low, high } => unless(low < high, format!("low {low} and high {high}"), "low below high"),
            Self::IntegerUniform { low, high } => {
                let fine =
                    low <= high && low.fract() == 0.0 && high.fract() == 0.0 && low.abs().max(high.abs()) <= 1e15;
                unless(
                    fine,
                    format!("low {low} and high {high}"),
                    "whole numbers, low not above high",
                )
            }
            Self::Normal { std, .. } | Self::Gaussian { std, .. } => {
                unless(*std >= 0.0, format!("std {std}"), "a standard deviation of at least 0")
            }
            Self::TruncatedNormal { mean, std, low, high } => {
                let fine = *std > 0.0 && low < high && *low <= mean + 6.0 * std && *high >= mean - 6.0 * std;
                let found = format!("mean {mean}, std {std}, low {low}, high {high}");
                unless(
                    fine,
                    found,
                    "std above 0, low below high, and the range within 6 std of the mean",
                )
            }
            Self::Choice { values, weights } => weights.as_ref().and_then(|weights| {
                let fine = weights.len() == values.len()
                    && weights.iter().all(|weight| *weight >= 0.0 && weight.is_finite())
                    && weights.iter().sum::<f64>() > 0.0;
                unless(
                    fine,
                    format!("weights {weights:?}"),
                    "one weight per value, none negative, not all 0",
                )
            }),
            Self::Bernoulli { p } => unless((0.0..=1.0).contains(p), format!("p {p}"), "a probability in 0..1"),
            Self::Binomial { n, p } => {
                let fine = (0.0..=1.0).contains(p) && n.fract() == 0.0 && (0.0..=100_000.0).contains(n);
                unless(fine, format!("n {n} and p {p}"), "a whole n in 0..100000 and p in 0..1")
            }
            Self::Box { low, high } => unless(
                low[0] < high[0] && low[1] < high[1],
                format!("low {low:?} and high {high:?}"),
                "low below high",
            ),
            Self::Disc { radius, .. } => unless(*radius > 0.0, format!("radius {radius}"), "a radius above 0"),
            Self::Annulus { inner, outer, .. } => {
                let found = format!("inner {inner} and outer {outer}");
                unless(
                    *inner >= 0.0 && inner < outer,
                    found,
                    "inner at least 0 and below outer",
                )
            }
            Self::Points { .. } => None,
        }
    }

    /// The least and greatest number it can draw, or all values of a choice; `None` where that has no bounds or is no number.
    pub fn support(&self) -> Option<Vec<Value>> {
        match self {
            Self::Uniform { low, high } | Self::TruncatedNormal { low, high, .. } => {
                Some(vec![Value::Number(*low), Value::Number(*high)])
            }
            Self::IntegerUniform { low, high } => Some(vec![Value::Integer(*low as i64), Value::Integer(*high as i64)]),
            Self::Binomial { n, .. } => Some(vec![Value::Integer(0), Value::Integer(*n as i64)]),
            Self::Bernoulli { .. } => Some(vec![Value::Boolean(false), Value::Boolean(true)]),
            Self::Choice { values, .. } => Some(values.clone()),
            Self::Box { low, high } => Some(vec![Value::Point(*low), Value::Point(*high)]),
            Self::Disc { center: [x, y], radius }
            | Self::Annulus {
                center: [x, y],
                outer: radius,
                ..
            } => Some(vec![
                Value::Point([x - radius, y - radius]),
                Value::Point([x + radius, y + radius]),
            ]),
            Self::Points { values } => Some(values.iter().copied().map(Value::Point).collect()),
            Self::Normal { .. } | Self::Gaussian { .. } => None,
        }
    }

    /// Some value it can draw, to try a template with.
    pub(crate) fn example(&self) -> Value {
        match self {
            Self::Normal { mean, .. } => Value::Number(*mean),
            Self::Gaussian { mean, .. } => Value::Point(*mean),
            other => other
                .support()
                .and_then(|values| values.into_iter().next())
                .unwrap_or(Value::Number(0.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(json: &str) -> Option<&'static str> {
        serde_json::from_str::<Distribution>(json)
            .unwrap()
            .fault()
            .map(|(_, expected)| expected)
    }

    #[test]
    fn numbers_that_cannot_be_drawn_from_are_faults() {
        assert_eq!(fault(r#"{"uniform": {"low": 0, "high": 1}}"#), None);
        assert_eq!(fault(r#"{"uniform": {"low": 1, "high": 1}}"#), Some("low below high"));
        assert_eq!(
            fault(r#"{"normal": {"mean": 1, "std": -1}}"#),
            Some("a standard deviation of at least 0")
        );
        assert_eq!(fault(r#"{"bernoulli": {"p": 1.5}}"#), Some("a probability in 0..1"));
        assert!(fault(r#"{"choice": {"values": [1, 2], "weights": [0, 0]}}"#).is_some());
        assert!(fault(r#"{"choice": {"values": [1, 2], "weights": [1]}}"#).is_some());
        assert!(fault(r#"{"annulus": {"center": [0, 0], "inner": 3, "outer": 2}}"#).is_some());
        assert!(fault(r#"{"binomial": {"n": 2.5, "p": 0.5}}"#).is_some());
    }

    #[test]
    fn a_choice_yields_the_type_that_all_its_values_have() {
        let colors: Distribution = serde_json::from_str(r#"{"choice": {"values": ["red", [0, 0, 1]]}}"#).unwrap();
        assert!(colors.yields(ParameterType::Color) && !colors.yields(ParameterType::String));
    }
}
