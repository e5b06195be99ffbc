//! Means of a lifetime's columns as logged, before preprocessing.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::lifetime::complete_rows;
use crate::statistics::mean;
use crate::{BlockType, Log, MetricsError, Options};

/// Means of one column over the complete rows that have a number in it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct AsLogged {
    /// Over learning blocks; `None` if none of their rows has a number.
    pub learning: Option<f64>,
    /// Over evaluation blocks.
    pub evaluation: Option<f64>,
}

/// Columns that show an agent's performance without any scaling.
const UNSCALED_COLUMNS: [&str; 2] = ["reward", "success"];

/// Means of the scored column, then of `reward` and `success`, each once and only if the log has it.
pub(crate) fn as_logged(log: &Log, options: &Options) -> Result<IndexMap<String, AsLogged>, MetricsError> {
    let mut found = IndexMap::new();
    for column in std::iter::once(options.perf_measure.as_str()).chain(UNSCALED_COLUMNS) {
        let Some(numbers) = log.rows.metric(column) else {
            continue;
        };
        let rows = complete_rows(log, &log.run_id, &options.perf_measure)?;
        let of = |block_type: BlockType| {
            let rows = rows
                .indices
                .iter()
                .filter(|row| log.rows.block_types()[**row] == block_type);
            let numbers = rows.map(|row| numbers[*row]).filter(|number| number.is_finite());
            mean(&numbers.collect::<Vec<_>>())
        };
        let means = AsLogged {
            learning: of(BlockType::Train),
            evaluation: of(BlockType::Test),
        };
        found.insert(column.to_owned(), means);
    }
    Ok(found)
}
