//! Regimes: the uninterrupted stretches of a lifetime in which one task is trained or evaluated.

use std::collections::BTreeMap;

use indexmap::IndexSet;

use super::drift::Drift;
use super::usable::Usable;
use crate::log::TaskParams;
use crate::{BlockSubtype, BlockType, Definitions, MetricsError, Options};

/// Maximum number of regimes in a lifetime, because the Theil–Sen slope compares every pair of regimes of a task.
pub const MAX_REGIMES: usize = 10_000;

/// A maximal run of rows with the same block number, block type, subtype and task.
///
/// QUIRK: task parameters do not split regimes. A block that changes only a task's parameters is one regime, and tables list it
/// with the parameters of its first row. Under the published definitions, they do split regimes.
///
/// Rows with the parameter `"mix": "shuffled"` belong to a block in which tasks are interleaved: there, the rows of one task
/// form one regime, while the reference counts many.
#[derive(Debug, Clone, PartialEq)]
#[expect(
    clippy::struct_field_names,
    reason = "`regime_num` is the name of the column in tables"
)]
pub struct Regime {
    /// Index among the regimes of the lifetime.
    pub regime_num: usize,
    /// Number of the block, as logged.
    pub block_num: u64,
    /// Learning or evaluation.
    pub block_type: BlockType,
    /// Awake or asleep.
    pub block_subtype: BlockSubtype,
    /// The task, lower-case; without its variant if variants do not count.
    pub task_name: String,
    /// Parameters of its first row.
    pub task_params: TaskParams,
    /// The ends of the drift, if the variant changes gradually.
    pub drift: Option<Drift>,
    /// The tasks that it counts as learning, for maintenance and transfer: its own, or, for a drift, the ends that it
    /// counts towards. Empty for an evaluation.
    pub learns: Vec<String>,
    /// Indices of its rows in the log; those of a shuffled block need not ascend.
    pub(crate) rows: Vec<usize>,
    /// Experience number of each row, ascending.
    pub exp_nums: Vec<u64>,
    /// Cumulative environment steps at the end of each row, over all rows of the lifetime that count; `None` unless the log has
    /// a column `episode_step_count` with a non-negative number in each of these rows.
    pub steps: Option<Vec<f64>>,
    /// Performance of each row as logged.
    pub raw: Vec<f64>,
    /// Performance of each row after preprocessing.
    pub performance: Vec<f64>,
}

impl Regime {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.performance.len()
    }

    /// Whether there are no rows; never true for a regime of a [`Lifetime`](crate::Lifetime).
    pub fn is_empty(&self) -> bool {
        self.performance.is_empty()
    }

    /// Whether it is wake training.
    pub fn is_wake_training(&self) -> bool {
        self.block_type == BlockType::Train && self.block_subtype == BlockSubtype::Wake
    }

    /// Drops rows without a number in the performance column.
    pub(super) fn keep_numbers(&mut self) {
        fn keep<T>(list: &mut Vec<T>, is_kept: &[bool]) {
            let mut is_kept = is_kept.iter();
            list.retain(|_| is_kept.next().is_some_and(|is_kept| *is_kept));
        }
        let is_kept: Vec<bool> = self.raw.iter().map(|value| !value.is_nan()).collect();
        keep(&mut self.rows, &is_kept);
        keep(&mut self.exp_nums, &is_kept);
        keep(&mut self.raw, &is_kept);
        keep(&mut self.performance, &is_kept);
        if let Some(steps) = &mut self.steps {
            keep(steps, &is_kept);
        }
        if let Some(drift) = &mut self.drift {
            keep(&mut drift.is_nearer_to, &is_kept);
        }
    }

    /// One performance per experience: the mean of its rows.
    pub(crate) fn per_experience(&self) -> Vec<f64> {
        mean_per_experience(&self.exp_nums, &self.performance)
    }
}

/// One value per experience number, in ascending order; rows of one experience are averaged.
pub(crate) fn mean_per_experience(exp_nums: &[u64], performance: &[f64]) -> Vec<f64> {
    if exp_nums.windows(2).all(|pair| pair[0] < pair[1]) {
        return performance.to_vec();
    }
    let mut sums: BTreeMap<u64, (f64, f64)> = BTreeMap::new();
    for (exp_num, value) in exp_nums.iter().zip(performance) {
        let (sum, count) = sums.entry(*exp_num).or_default();
        *sum += value;
        *count += 1.0;
    }
    sums.into_values().map(|(sum, count)| sum / count).collect()
}

/// Splits rows, sorted by experience, into regimes.
pub(crate) fn form(run_id: &str, usable: &Usable<'_>, options: &Options) -> Result<Vec<Regime>, MetricsError> {
    let rows = usable.rows;
    // The names under which tasks are scored, and, for each logged name, the index of its scored name.
    let mut names = IndexSet::new();
    let number = |name: &String| names.insert_full(options.variant_mode.scored_name(name)).0;
    let scored: Vec<usize> = rows.task_names().values().iter().map(number).collect();
    let key = |row: usize| {
        let block = (
            rows.block_nums()[row],
            rows.block_types()[row],
            rows.block_subtypes()[row],
        );
        (block, scored[rows.task_names().ids()[row] as usize])
    };
    let params_of = |row: usize| rows.task_params().of(row);
    let same_params = |a: usize, b: usize| match options.definitions {
        Definitions::Reference => true,
        Definitions::Published => {
            rows.task_params().ids()[a] == rows.task_params().ids()[b] || params_of(a) == params_of(b)
        }
    };
    let stretches = usable.indices.chunk_by(|&a, &b| key(a) == key(b) && same_params(a, b));
    let mut steps = cumulative_steps(usable).map(Vec::into_iter);
    let mut regimes = Vec::new();
    for (regime_num, stretch) in stretches.enumerate() {
        if regime_num == MAX_REGIMES {
            return Err(MetricsError::TooManyRegimes {
                run_id: run_id.to_owned(),
                limit: MAX_REGIMES,
            });
        }
        // A stretch is never empty.
        let first = stretch[0];
        let ((block_num, block_type, block_subtype), task) = key(first);
        let performance: Vec<f64> = stretch.iter().map(|&row| usable.performance[row]).collect();
        regimes.push(Regime {
            regime_num,
            block_num,
            block_type,
            block_subtype,
            task_name: names[task].clone(),
            drift: Drift::of(rows, stretch, params_of(first), options),
            learns: Vec::new(),
            task_params: params_of(first).clone(),
            rows: stretch.to_vec(),
            exp_nums: stretch.iter().map(|&row| rows.exp_nums()[row]).collect(),
            steps: (steps.as_mut()).map(|steps| steps.by_ref().take(stretch.len()).collect()),
            raw: performance.clone(),
            performance,
        });
    }
    Ok(regimes)
}

/// Environment steps up to the end of each usable row, in the order of `usable.indices`. Steps accumulate in the order of the log,
/// which differs from that order in shuffled blocks.
fn cumulative_steps(usable: &Usable<'_>) -> Option<Vec<f64>> {
    let steps = usable.rows.metric("episode_step_count")?;
    let mut indices: Vec<usize> = (0..usable.indices.len()).collect();
    indices.sort_unstable_by_key(|&index| usable.indices[index]);
    let (mut sum, mut cumulated) = (0.0, vec![0.0; indices.len()]);
    for index in indices {
        let steps_of_row = steps[usable.indices[index]];
        if !(steps_of_row.is_finite() && steps_of_row >= 0.0) {
            return None;
        }
        sum += steps_of_row;
        cumulated[index] = sum;
    }
    Some(cumulated)
}

#[cfg(test)]
mod tests {
    use super::super::usable::grouped_by_task;
    use super::*;
    use crate::{Record, Rows, VariantMode};

    fn record(block_num: u64, block_type: BlockType, task: &str) -> Record {
        Record::new(block_num, 0, block_type, task, "20200101T000000.0".parse().unwrap())
    }

    #[test]
    fn tasks_of_a_shuffled_block_are_one_regime_each() {
        let params = serde_json::Map::from_iter([("mix".to_owned(), "shuffled".into())]);
        let row = |number: u64, block: u64, task: &str, params: Option<&serde_json::Map<String, serde_json::Value>>| {
            let stamp = "20200101T000000.0".parse().unwrap();
            let record = Record::new(block, number, BlockType::Train, task, stamp)
                .with_metric("episode_step_count", 10.0_f64.powi(number.try_into().unwrap()));
            match params {
                Some(params) => record.with_task_params(params.clone()),
                None => record,
            }
        };
        let mixed = Some(&params);
        let records = [
            row(0, 0, "b_x", mixed),
            row(1, 0, "a_x", mixed),
            row(2, 0, "b_x", mixed),
            row(3, 1, "a_x", mixed),
            row(4, 2, "b_x", None),
            row(5, 2, "a_x", None),
            row(6, 2, "b_x", None),
        ];
        let rows = Rows::from_records(&records);
        let usable = Usable {
            rows: &rows,
            indices: grouped_by_task(&rows, (0..records.len()).collect()),
            performance: &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        };
        let regimes = form("run", &usable, &Options::default()).unwrap();
        let numbers: Vec<&[u64]> = regimes.iter().map(|regime| regime.exp_nums.as_slice()).collect();
        assert_eq!(numbers, [&[0, 2][..], &[1], &[3], &[4], &[5], &[6]]);
        let steps = regimes[0].steps.as_deref().unwrap();
        assert_eq!(steps, [1.0, 111.0], "steps include those of all earlier rows");
    }

    #[test]
    fn regimes_end_at_block_type_and_task_but_not_parameter_changes() {
        let params = serde_json::Map::from_iter([("a".to_owned(), 1.into())]);
        let records = [
            record(0, BlockType::Train, "A_x"),
            record(0, BlockType::Train, "a_x").with_task_params(params),
            record(0, BlockType::Train, "a_y"),
            record(1, BlockType::Train, "a_y"),
            record(1, BlockType::Test, "a_y"),
        ];
        let rows = Rows::from_records(&records);
        let usable = Usable {
            rows: &rows,
            indices: (0..records.len()).collect(),
            performance: &[1.0; 5],
        };
        let lengths = |variant_mode, definitions| {
            let options = Options {
                variant_mode,
                definitions,
                ..Options::default()
            };
            form("run", &usable, &options)
                .unwrap()
                .iter()
                .map(Regime::len)
                .collect::<Vec<_>>()
        };
        assert_eq!(lengths(VariantMode::Aware, Definitions::Reference), [2, 1, 1, 1]);
        assert_eq!(lengths(VariantMode::Agnostic, Definitions::Reference), [3, 1, 1]);
        assert_eq!(lengths(VariantMode::Aware, Definitions::Published), [1, 1, 1, 1, 1]);
    }

    #[test]
    fn steps_accumulate_over_the_rows_that_count() {
        let check = |steps: &[f64], expected: Option<[f64; 2]>| {
            let record = |(block, steps): (u64, &f64)| {
                record(block, BlockType::Train, "a_x").with_metric("episode_step_count", *steps)
            };
            let records: Vec<_> = (0..).zip(steps).map(record).collect();
            let rows = Rows::from_records(&records);
            let usable = Usable {
                rows: &rows,
                indices: vec![0, 2],
                performance: &[1.0; 3],
            };
            let regimes = form("run", &usable, &Options::default()).unwrap();
            let found: Option<Vec<f64>> = regimes.into_iter().map(|regime| Some(regime.steps?[0])).collect();
            assert_eq!(found, expected.map(Vec::from));
        };
        check(&[3.0, 10.0, 4.0], Some([3.0, 7.0]));
        check(&[3.0, -1.0, 4.0], Some([3.0, 7.0]));
        check(&[3.0, 10.0, -4.0], None);
        check(&[f64::NAN, 10.0, 4.0], None);
    }

    #[test]
    fn rows_of_one_experience_are_averaged() {
        let check = |exp_nums: &[u64], expected: &[f64]| {
            assert_eq!(mean_per_experience(exp_nums, &[1.0, 3.0, 8.0]), expected);
        };
        check(&[0, 1, 2], &[1.0, 3.0, 8.0]);
        check(&[0, 0, 2], &[2.0, 8.0]);
        check(&[0, 2, 2], &[1.0, 5.5]);
        check(&[1, 2, 1], &[4.5, 3.0]);
    }
}
