//! The values of each regime, and their table: columns of the reference's `NAME_regime.tsv`.
//!
//! Not here: how they are computed, see `score`.

use super::LifetimeMetrics;
use crate::log::line;
use crate::{BlockSubtype, BlockType};

/// Characters of the task parameters that the table shows.
const SHOWN_PARAMS: usize = 25;

/// Values of one regime, in normalised units.
#[derive(Debug, Clone, PartialEq)]
pub struct RegimeMetrics {
    /// Number of the block, as logged.
    pub block_num: u64,
    /// Learning or evaluation.
    pub block_type: BlockType,
    /// Awake or asleep.
    pub block_subtype: BlockSubtype,
    /// The task.
    pub task_name: String,
    /// Position among the regimes, from 0.
    pub regime_num: usize,
    /// Parameters of its first row, as JSON.
    pub task_params: String,
    /// Best smoothed performance.
    pub saturation: f64,
    /// Experiences before the first time it is reached.
    pub exp_to_sat: usize,
    /// Mean performance at the end: last tenth of a learning regime, all of an evaluation.
    pub term_perf: f64,
    /// Experiences before the middle of the end.
    pub exp_to_term_perf: usize,
    /// Mean performance; `None` for wake evaluations of a lifetime that sleeps.
    pub avg_perf: Option<f64>,
}

impl LifetimeMetrics {
    /// The regimes as tab-separated text with a header.
    ///
    /// The column `task_params` is there only where regimes differ in them; it holds the first 25 characters.
    pub fn regime_tsv(&self) -> String {
        let params_vary = self
            .regimes
            .windows(2)
            .any(|pair| pair[0].task_params != pair[1].task_params);
        let keep = |cells: Vec<(&'static str, String)>| -> Vec<(&'static str, String)> {
            cells
                .into_iter()
                .filter(|(column, _)| params_vary || *column != "task_params")
                .collect()
        };
        let rows: Vec<_> = self
            .regimes
            .iter()
            .map(|regime| keep(regime.cells(&self.run_id)))
            .collect();
        let header = rows.first().map(|cells| line(cells.iter().map(|(column, _)| *column)));
        let lines = rows.iter().map(|cells| line(cells.iter().map(|(_, text)| text)));
        let bytes: Vec<u8> = header.into_iter().chain(lines).flatten().collect();
        String::from_utf8(bytes).expect("cells are text, and quoting adds only quotes")
    }
}

impl RegimeMetrics {
    fn cells(&self, run_id: &str) -> Vec<(&'static str, String)> {
        vec![
            ("block_num", self.block_num.to_string()),
            ("block_type", self.block_type.to_string()),
            ("block_subtype", self.block_subtype.to_string()),
            ("task_name", self.task_name.clone()),
            ("regime_num", self.regime_num.to_string()),
            ("task_params", shortened(&self.task_params)),
            ("saturation", format!("{:?}", self.saturation)),
            ("exp_to_sat", self.exp_to_sat.to_string()),
            ("term_perf", format!("{:?}", self.term_perf)),
            ("exp_to_term_perf", self.exp_to_term_perf.to_string()),
            (
                "avg_perf",
                self.avg_perf.map(|value| format!("{value:?}")).unwrap_or_default(),
            ),
            ("run_id", run_id.to_owned()),
        ]
    }
}

fn shortened(params: &str) -> String {
    match params.char_indices().nth(SHOWN_PARAMS) {
        Some((end, _)) => format!("{}...", &params[..end]),
        None => params.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_cut_after_twenty_five_characters() {
        let check = |params: &str, expected: &str| assert_eq!(shortened(params), expected);
        check(r#"{"a": 1}"#, r#"{"a": 1}"#);
        check(&"é".repeat(25), &"é".repeat(25));
        check(&"é".repeat(26), &format!("{}...", "é".repeat(25)));
    }
}
