//! [`RegimeDrift`]: a drift from one variant to another, as declared in a scenario.

use driftworld_text::{IDENTIFIER_PATTERN, NAME_PATTERN};
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::serde_defaults::{is_default, is_one, one};
use crate::value::Value;

/// A drift from a regime's variant to another variant: of the same task, or of any task if whole variants switch.
///
/// A drift can cross a block boundary: the next block's regime continues from the progress at which the previous regime
/// stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "to": "dusk" },
    { "to": "dusk", "values": { "light": 1.2 }, "name": "dim" },
    { "to": "dusk", "schedule": { "steps": 4 }, "switch": "mixture", "from": 0, "until": 0.5 },
    { "to": "plain", "task": "get_to_goal", "switch": "task" },
]))]
pub struct RegimeDrift {
    /// The end variant.
    #[schemars(length(min = 1, max = 200))]
    pub to: String,
    /// The task of the end variant; the regime's task if absent. A different task requires the switch `task`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 4096))]
    pub task: Option<String>,
    /// Values that override those of the end variant, by parameter.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(schema_with = "values_schema")]
    pub values: IndexMap<String, Value>,
    /// The name of the variant with these values in tables and logs; only with `values`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 100), regex(pattern = NAME_PATTERN))]
    pub name: Option<String>,
    /// The fraction of the drift that is reached, as a function of its progress.
    #[serde(default, skip_serializing_if = "is_default")]
    pub schedule: DriftSchedule,
    /// How values that cannot be interpolated change.
    #[serde(default, skip_serializing_if = "is_default")]
    pub switch: DriftSwitch,
    /// Progress of the drift at the regime's first experience, 0..1; 0 if absent.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub from: f64,
    /// Progress of the drift at the regime's last experience, 0..1; 1 if absent.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub until: f64,
}

/// The fraction of a drift that is reached, as a function of its progress.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(extend("examples" = [
    "linear",
    { "sawtooth": 3 },
]))]
pub enum DriftSchedule {
    /// Evenly.
    #[default]
    Linear,
    /// Slowly at the beginning and at the end.
    Cosine,
    /// In this number of equal steps.
    Steps(#[schemars(range(min = 1, max = 1_000_000))] u32),
    /// From the beginning to the end, then straight back to the beginning, this number of times.
    Sawtooth(#[schemars(range(min = 1, max = 1_000_000))] u32),
}

impl DriftSchedule {
    /// The fraction of the drift, 0..=1, at a `progress` of 0..=1. Cosine: (1 − cos π·progress) / 2. With steps, the first
    /// happens at progress `1 / (steps + 1)`, the last at `steps / (steps + 1)`.
    pub fn at(self, progress: f64) -> f64 {
        let progress = progress.clamp(0.0, 1.0);
        match self {
            Self::Linear => progress,
            Self::Cosine => (1.0 - libm::cos(std::f64::consts::PI * progress)) / 2.0,
            Self::Steps(steps) => {
                let steps = f64::from(steps.max(1));
                ((progress * (steps + 1.0)).floor() / steps).min(1.0)
            }
            Self::Sawtooth(_) if progress == 1.0 => 1.0,
            Self::Sawtooth(periods) => (progress * f64::from(periods.max(1))).fract(),
        }
    }
}

/// How values that cannot be interpolated change in a drift: texts, booleans, numbers from a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DriftSwitch {
    /// At the fraction that the parameter declares as `switch_at`; at one half by default.
    #[default]
    AtPoint,
    /// At random: at fraction t of the drift, a world has the new value with probability t, drawn under the regime's seed.
    Mixture,
    /// At random, with all values at once: at fraction t of the drift, a world comes from the end variant with probability t,
    /// otherwise from the start variant. Nothing is interpolated, not even numbers.
    Task,
}

impl RegimeDrift {
    /// A complete linear drift to a variant.
    pub fn to(variant: impl Into<String>) -> Self {
        Self {
            to: variant.into(),
            task: None,
            values: IndexMap::new(),
            name: None,
            schedule: DriftSchedule::default(),
            switch: DriftSwitch::default(),
            from: 0.0,
            until: 1.0,
        }
    }

    /// Name of the end variant in tables and logs: the drift's name if it has one, otherwise the variant's.
    pub fn variant_name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.to)
    }

    /// The drift's progress, 0..=1, at experience number `experience`, from 0, of a regime of `count`.
    ///
    /// Linear from `from` at the first to `until` at the last; halfway between them if there is only one.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::RegimeDrift;
    /// let second_half = RegimeDrift { from: 0.5, ..RegimeDrift::to("dusk") };
    /// assert_eq!([0, 1, 2].map(|experience| second_half.progress(experience, 3)), [0.5, 0.75, 1.0]);
    /// assert_eq!(RegimeDrift::to("dusk").progress(0, 1), 0.5);
    /// ```
    pub fn progress(&self, experience: u32, count: u32) -> f64 {
        if count <= 1 {
            return f64::midpoint(self.from, self.until);
        }
        let last = count - 1;
        let share = f64::from(experience.min(last)) / f64::from(last);
        self.from * (1.0 - share) + self.until * share
    }
}

/// Values by parameter. Only the task knows which values are valid, so the schema accepts anything that can be a value.
pub(super) fn values_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({
        "type": "object",
        "propertyNames": { "pattern": IDENTIFIER_PATTERN, "maxLength": 100 },
        "additionalProperties": { "type": ["boolean", "number", "string", "array", "object"] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drift_may_go_backwards_and_stays_within_its_bounds() {
        let back = RegimeDrift {
            from: 1.0,
            until: 0.25,
            ..RegimeDrift::to("dusk")
        };
        assert_eq!(
            [0, 2, 4].map(|experience| back.progress(experience, 5)),
            [1.0, 0.625, 0.25]
        );
        assert_eq!(back.progress(9, 5), 0.25);
    }

    #[test]
    fn defaults_of_a_drift_are_not_written() {
        let json = |drift: &RegimeDrift| serde_json::to_string(drift).unwrap();
        assert_eq!(json(&RegimeDrift::to("dusk")), r#"{"to":"dusk"}"#);
        let all = r#"{"to":"dusk","values":{"light":0.5},"name":"dim","schedule":{"steps":4},"switch":"mixture","from":0.25,"until":0.75}"#;
        assert_eq!(json(&serde_json::from_str(all).unwrap()), all);
    }

    #[test]
    fn schedules_start_at_0_and_end_at_1() {
        for schedule in [
            DriftSchedule::Linear,
            DriftSchedule::Cosine,
            DriftSchedule::Steps(1),
            DriftSchedule::Steps(4),
            DriftSchedule::Sawtooth(3),
        ] {
            assert_eq!(schedule.at(0.0), 0.0, "{schedule:?}");
            assert_eq!(schedule.at(1.0), 1.0, "{schedule:?}");
        }
        assert!((DriftSchedule::Cosine.at(0.5) - 0.5).abs() < 1e-15 && DriftSchedule::Cosine.at(0.1) < 0.05);
        assert_eq!([0.3, 0.4, 0.7].map(|x| DriftSchedule::Steps(2).at(x)), [0.0, 0.5, 1.0]);
        assert_eq!(
            [0.125, 0.375, 0.5, 0.625].map(|x| DriftSchedule::Sawtooth(2).at(x)),
            [0.25, 0.75, 0.0, 0.25]
        );
    }
}
