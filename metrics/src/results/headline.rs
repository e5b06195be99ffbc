//! Headlines: the main values of a lifetime, with an explanation and the direction that is good.

use std::borrow::Cow;
use std::cmp::Ordering;

use serde::Serialize;

use super::Reading;

/// The direction in which a metric is good, with its neutral value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// The higher the better.
    Higher,
    /// The lower the better.
    Lower,
    /// The higher the better; this value means no effect.
    HigherThan(f64),
    /// The lower the better; this value means no effect.
    LowerThan(f64),
}

impl Direction {
    /// The value that means no effect, if the metric has one.
    pub fn neutral(self) -> Option<f64> {
        match self {
            Self::HigherThan(neutral) | Self::LowerThan(neutral) => Some(neutral),
            Self::Higher | Self::Lower => None,
        }
    }

    /// Whether higher values are better.
    pub(crate) fn is_higher(self) -> bool {
        matches!(self, Self::Higher | Self::HigherThan(_))
    }

    /// Whether a value is good or bad, judged only by its side of the neutral value; unclear if it is on neither side.
    pub fn side(self, value: f64) -> Reading {
        match self.neutral().and_then(|neutral| value.partial_cmp(&neutral)) {
            None | Some(Ordering::Equal) => Reading::Unclear,
            Some(order) if order.is_gt() == self.is_higher() => Reading::Good,
            Some(_) => Reading::Bad,
        }
    }
}

/// A main value of a lifetime: one row of its table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Headline {
    /// Name of the value, as in the JSON.
    pub name: Cow<'static, str>,
    /// One-line explanation.
    pub explanation: Cow<'static, str>,
    /// The good direction.
    pub good: Direction,
}

impl Headline {
    /// A headline from its parts.
    pub fn new(name: impl Into<Cow<'static, str>>, explanation: impl Into<Cow<'static, str>>, good: Direction) -> Self {
        Self {
            name: name.into(),
            explanation: explanation.into(),
            good,
        }
    }
}
