//! Generators for property tests: arbitrary valid records, and lifetimes that can be scored.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use driftworld_metrics::{BlockSubtype, BlockType, ExpStatus, Record, Timestamp};
use proptest::prelude::*;

/// A time stamp this number of microseconds after a fixed one.
pub(crate) fn stamp(micros: i64) -> Timestamp {
    Timestamp::from_unix_micros(1_600_000_000_000_000 + micros).unwrap()
}

/// Strings that are hard to write as table cells.
fn awkward_text() -> impl Strategy<Value = String> {
    prop_oneof![
        "[a-z]{1,6}_[0-9]{1,3}",
        "\\PC{0,12}",
        "[\t\n\r\"' ,;#\\\\]{1,6}",
        Just("nan".to_owned()),
        Just(String::new()),
    ]
}

/// A record with arbitrary cells, except numbers and time, which [`any_log`] adds.
fn any_record() -> impl Strategy<Value = Record> {
    let metric = prop_oneof![
        any::<f64>().prop_filter("finite", |value| value.is_finite()),
        Just(f64::MIN_POSITIVE / 3.0),
        Just(-0.0),
    ];
    let params = prop::collection::vec(
        (awkward_text(), prop_oneof![Just(None), any::<i32>().prop_map(Some)]),
        0..3,
    );
    let cells = (awkward_text(), params, "[0-9a-zA-Z_.-]{0,4}w", any::<[bool; 2]>());
    (cells, metric).prop_map(|((task_name, params, worker_id, choices), metric)| {
        let params = params.into_iter().map(|(key, value)| (key, value.into()));
        let block_type = if choices[0] { BlockType::Train } else { BlockType::Test };
        let mut record = Record::new(0, 0, block_type, task_name, stamp(0))
            .with_task_params(params.collect::<serde_json::Map<_, _>>())
            .with_worker(worker_id)
            .with_metric("reward", metric)
            .with_metric("a \"b\"\tc", 1.5);
        if choices[1] {
            record.block_subtype = BlockSubtype::Sleep;
        }
        record
    })
}

/// A valid sequence of records: numbers stay the same or increase, sometimes by a lot, and a worker's experience ends with its
/// complete row. Each record has a different time stamp.
pub(crate) fn any_log() -> impl Strategy<Value = Vec<Record>> {
    let step = || prop_oneof![4 => Just(0_u64), 4 => Just(1), 1 => 2_u64..1_000_000];
    let rows = prop::collection::vec((any_record(), step(), step(), any::<bool>()), 1..10);
    rows.prop_map(|rows| {
        let (mut block_num, mut exp_num) = (0, 0);
        let mut completed: BTreeMap<u64, Vec<String>> = BTreeMap::new();
        let mut types = BTreeMap::new();
        let numbered = rows
            .into_iter()
            .enumerate()
            .map(|(index, (mut record, blocks, exps, complete))| {
                block_num += blocks;
                exp_num += exps;
                if completed
                    .get(&exp_num)
                    .is_some_and(|workers| workers.contains(&record.worker_id))
                {
                    exp_num += 1;
                }
                (record.block_num, record.exp_num, record.timestamp) = (block_num, exp_num, stamp(index as i64));
                let place = (exp_num, block_num, record.worker_id.clone());
                record.block_type = *types.entry(place).or_insert(record.block_type);
                if complete {
                    completed.entry(exp_num).or_default().push(record.worker_id.clone());
                } else {
                    record.exp_status = ExpStatus::Incomplete;
                }
                record
            });
        numbered.collect()
    })
}

/// One row of a lifetime, with the fields that scoring depends on.
#[derive(Debug, Clone)]
pub(crate) struct LifetimeRow {
    pub(crate) block_num: u64,
    pub(crate) exp_num: u64,
    pub(crate) block_type: BlockType,
    pub(crate) block_subtype: BlockSubtype,
    pub(crate) task: &'static str,
    pub(crate) performance: f64,
}

const TASKS: [&str; 3] = ["find_red", "find_blue", "reach_near"];

/// Unstructured performances, so that no two sums are equal by chance.
fn performances(num: std::ops::Range<usize>) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-100.0..100.0, num)
}

/// Lifetimes of several blocks, some long enough to be smoothed; each experience is one row.
pub(crate) fn lifetime() -> impl Strategy<Value = Vec<LifetimeRow>> {
    let subtype = prop_oneof![6 => Just(BlockSubtype::Wake), 1 => Just(BlockSubtype::Sleep)];
    let stretch = (
        prop::sample::select(BlockType::ALL),
        subtype,
        prop::sample::select(&TASKS[..]),
        performances(1..24),
        any::<bool>(),
    );
    prop::collection::vec(stretch, 1..10).prop_map(|stretches| {
        let (mut block_num, mut exp_num) = (0, 0);
        let mut rows = Vec::new();
        for (block_type, block_subtype, task, performances, new_block) in stretches {
            block_num += u64::from(new_block);
            for performance in performances {
                rows.push(LifetimeRow {
                    block_num,
                    exp_num,
                    block_type,
                    block_subtype,
                    task,
                    performance,
                });
                exp_num += 1;
            }
        }
        rows
    })
}

/// A run of an expert in the first task.
pub(crate) fn expert() -> impl Strategy<Value = Vec<LifetimeRow>> {
    performances(1..40).prop_map(|performances| {
        let row = |(exp_num, performance)| LifetimeRow {
            block_num: 0,
            exp_num,
            block_type: BlockType::Train,
            block_subtype: BlockSubtype::Wake,
            task: TASKS[0],
            performance,
        };
        (0..).zip(performances).map(row).collect()
    })
}

/// Writes a log whose rows, in the given order, go to the data file of their folder; the folder's name is the worker's.
pub(crate) fn lay_out<'a>(dir: &Path, rows: impl IntoIterator<Item = (&'a LifetimeRow, usize)>) {
    fs::create_dir_all(dir).unwrap();
    fs::write(
        dir.join("logger_info.json"),
        r#"{"metrics_columns": ["reward"], "log_format_version": "1.1"}"#,
    )
    .unwrap();
    fs::write(dir.join("scenario_info.json"), "{}").unwrap();
    let mut files: BTreeMap<usize, String> = BTreeMap::new();
    for (row, folder) in rows {
        let text = files.entry(folder).or_insert_with(|| {
            "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\treward\n".to_owned()
        });
        let LifetimeRow {
            block_num,
            exp_num,
            block_type,
            block_subtype,
            task,
            performance,
        } = row;
        let stamp = stamp(*exp_num as i64);
        writeln!(
            text,
            "{block_num}\t{exp_num}\tw{folder}\t{block_type}\t{block_subtype}\t{task}\t{{}}\tcomplete\t{stamp}\t{performance:?}"
        )
        .unwrap();
    }
    for (folder, text) in files {
        let folder = dir.join(format!("w{folder}/0-train"));
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("data-log.tsv"), text).unwrap();
    }
}
