//! The table a newcomer reads: each metric with its value, what it means, and which way is good.
//!
//! Not here: printing it.

use serde::Serialize;

use super::{LifetimeMetrics, LifetimeScores};

/// Which way a metric is good, and from where on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// The higher the better.
    Higher,
    /// The higher the better, and this value means no effect.
    HigherThan(f64),
}

/// One line of the table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SummaryRow {
    /// Name of the metric, as in the JSON.
    pub name: &'static str,
    /// Its value; `None` where it was not asked for or could not be computed.
    pub value: Option<f64>,
    /// What it says, in one line.
    pub explanation: &'static str,
    /// Which way is good.
    pub good: Direction,
}

type Value = fn(&LifetimeScores) -> Option<f64>;

const ROWS: [(&str, Value, &str, Direction); 11] = [
    (
        "perf_recovery",
        |scores| scores.perf_recovery,
        "does relearning a task get faster each time? experiences saved per relearning",
        Direction::HigherThan(0.0),
    ),
    (
        "avg_train_perf",
        |scores| scores.avg_train_perf,
        "mean performance while learning, where 1 is the worst and 101 the best seen in each task",
        Direction::Higher,
    ),
    (
        "avg_eval_perf",
        |scores| scores.avg_eval_perf,
        "mean performance in evaluations, where 1 is the worst and 101 the best seen in each task",
        Direction::Higher,
    ),
    (
        "perf_maintenance_mrlep",
        |scores| scores.perf_maintenance_mrlep,
        "is a learnt task kept? points gained or lost since the evaluation right after learning it",
        Direction::HigherThan(0.0),
    ),
    (
        "perf_maintenance_mrtlp",
        |scores| scores.perf_maintenance_mrtlp,
        "is a learnt task kept? points gained or lost since the end of learning it",
        Direction::HigherThan(0.0),
    ),
    (
        "forward_transfer_ratio",
        |scores| scores.forward_transfer_ratio,
        "does learning one task help others not learnt yet? performance after over before",
        Direction::HigherThan(1.0),
    ),
    (
        "backward_transfer_ratio",
        |scores| scores.backward_transfer_ratio,
        "does learning one task help others learnt before? performance after over before",
        Direction::HigherThan(1.0),
    ),
    (
        "forward_transfer_contrast",
        |scores| scores.forward_transfer_contrast,
        "does learning one task help others not learnt yet? change over sum, from -1 to 1",
        Direction::HigherThan(0.0),
    ),
    (
        "backward_transfer_contrast",
        |scores| scores.backward_transfer_contrast,
        "does learning one task help others learnt before? change over sum, from -1 to 1",
        Direction::HigherThan(0.0),
    ),
    (
        "ste_rel_perf",
        |scores| scores.ste_rel_perf,
        "performance gathered while learning, over that of an expert trained on the task alone",
        Direction::HigherThan(1.0),
    ),
    (
        "sample_efficiency",
        |scores| scores.sample_efficiency,
        "how good and how quickly, over an expert trained on the task alone",
        Direction::HigherThan(1.0),
    ),
];

impl LifetimeMetrics {
    /// The lifetime's values as a table, one row per metric of the crate, also those without a value.
    pub fn summary(&self) -> Vec<SummaryRow> {
        let row = |(name, value, explanation, good): &(&'static str, Value, &'static str, Direction)| SummaryRow {
            name,
            value: value(&self.lifetime),
            explanation,
            good: *good,
        };
        ROWS.iter().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_of_the_scores_has_a_row_of_its_own_name() {
        let names: Vec<&str> = ROWS.iter().map(|row| row.0).collect();
        let all: serde_json::Map<String, serde_json::Value> = names
            .iter()
            .enumerate()
            .map(|(index, name)| ((*name).to_owned(), index.into()))
            .collect();
        let scores: LifetimeScores = serde_json::from_value(all.into()).unwrap();
        let fields = serde_json::to_value(&scores).unwrap();
        assert_eq!(
            fields.as_object().unwrap().keys().collect::<Vec<_>>(),
            names,
            "names and their order"
        );
        for (index, (name, value, ..)) in ROWS.iter().enumerate() {
            assert_eq!(value(&scores), Some(index as f64), "{name}");
        }
    }
}
