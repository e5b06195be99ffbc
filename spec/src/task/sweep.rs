//! [`Sweep`]: evenly spaced values of a parameter, for a family of variants.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Evenly spaced values of one number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "from": 0.1, "to": 10, "steps": 5, "spacing": "logarithmic" }]))]
pub struct Sweep {
    /// The first value.
    pub from: f64,
    /// The last value.
    pub to: f64,
    /// Number of values, including both ends.
    #[schemars(range(min = 2, max = 1000))]
    pub steps: u32,
    /// How the values are spaced.
    #[serde(default)]
    pub spacing: Spacing,
}

/// How the values of a sweep are spaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// The same difference between neighbours.
    #[default]
    Linear,
    /// The same ratio between neighbours; both ends are above 0.
    Logarithmic,
}

impl Sweep {
    /// The values in order, rounded to 12 digits, so that 0.1 + 0.2 is 0.3. `None` if a logarithmic sweep has an end
    /// at or below 0.
    pub fn values(&self) -> Option<Vec<f64>> {
        let last = f64::from(self.steps.max(2) - 1);
        let share = |k: u32| f64::from(k) / last;
        let value = |k: u32| match self.spacing {
            Spacing::Linear => self.from + (self.to - self.from) * share(k),
            Spacing::Logarithmic => {
                let (from, to) = (libm::log(self.from), libm::log(self.to));
                libm::exp(from + (to - from) * share(k))
            }
        };
        let possible = self.spacing == Spacing::Linear || (self.from > 0.0 && self.to > 0.0);
        possible.then(|| (0..self.steps.max(2)).map(|k| rounded(value(k))).collect())
    }
}

fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}
