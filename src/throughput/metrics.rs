//! How fast logs are written, read and scored: one lifetime of 1,000,000 experiences, on one core.

use std::path::Path;
use std::time::Instant;

use crate::metrics::{
    BlockType, LogWriter, LoggerInfo, MetricsError, Options, Record, ScenarioInfo, TaskParams, Timestamp, read_log,
    score,
};
use driftworld_atomic_files::ScratchFolder;
use serde_json::{Map, json};

use crate::Failure;

use super::{Figures, best_of_three};

/// Experiences of the lifetime, and of the one that is looked at quickly.
const NUM_ROWS: u64 = 1_000_000;
const NUM_ROWS_QUICK: u64 = 20_000;

/// Blocks, which train and evaluate in turn.
const NUM_BLOCKS: u64 = 100;

/// Workers, each with a part of every block and a file of its own for it.
const WORKERS: [&str; 4] = ["worker-0", "worker-1", "worker-2", "worker-3"];

/// Tasks: one for each training block, all for each evaluation.
const TASKS: [&str; 4] = ["find_red", "find_blue", "reach_near", "reach_far"];

/// Microseconds between two experiences.
const PACE: i64 = 1_234_567;

/// Seconds and rows each second of writing, reading and scoring.
pub(crate) fn measure(is_quick: bool) -> Result<Figures, Failure> {
    let num_rows = if is_quick { NUM_ROWS_QUICK } else { NUM_ROWS };
    let base = ScratchFolder::new(".driftworld-bench-", &std::env::temp_dir())?;
    let dir = base.path().join("lifetime");
    let start = Instant::now();
    write(&dir, num_rows)?;
    let writing = start.elapsed().as_secs_f64();
    let reading = best_of_three(|| read_log(&dir).map(drop))?;
    let log = read_log(&dir)?;
    let scoring = best_of_three(|| score(&log, &[], &Options::default()).map(drop))?;
    let mut figures = Figures::new();
    figures.insert("rows".to_owned(), json!(num_rows));
    for (name, seconds) in [("write", writing), ("read", reading), ("score", scoring)] {
        figures.insert(format!("{name}_seconds"), json!((seconds * 1e4).round() / 1e4));
        figures.insert(
            format!("{name}_rows_per_second"),
            json!((num_rows as f64 / seconds).round()),
        );
    }
    Ok(figures)
}

/// Writes the log, record by record as an agent does.
fn write(dir: &Path, num_rows: u64) -> Result<(), MetricsError> {
    let columns = LoggerInfo::new(["reward", "success", "episode_step_count"])?;
    let mut writer = LogWriter::create(dir, &columns, &ScenarioInfo::default())?;
    let of_block = num_rows / NUM_BLOCKS;
    for exp_num in 0..num_rows {
        let (block, place) = (exp_num / of_block, exp_num % of_block);
        let is_training = block % 2 == 0;
        let block_type = if is_training { BlockType::Train } else { BlockType::Test };
        let task = if is_training {
            block / 2
        } else {
            place * TASKS.len() as u64 / of_block
        };
        let task = TASKS[task as usize % TASKS.len()];
        // Better with every block, and spread evenly: the golden ratio's multiples are.
        let reward = (exp_num as f64 * 0.618_033_988_749_895).fract() + block as f64 / NUM_BLOCKS as f64;
        let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + exp_num as i64 * PACE)?;
        let worker = WORKERS[(place * WORKERS.len() as u64 / of_block) as usize];
        let record = Record::new(block, exp_num, block_type, task, when)
            .with_worker(worker)
            .with_task_params(params(block))
            .with_metric("reward", reward)
            .with_metric("success", f64::from(reward > 0.5))
            .with_metric("episode_step_count", (300 - exp_num % 200) as f64);
        writer.write(&record)?;
    }
    writer.finish()
}

/// The same throughout a block.
fn params(block: u64) -> TaskParams {
    let params = [
        ("num_objects", json!(block % 8)),
        ("light", json!(0.25)),
        ("variant", json!("red")),
    ];
    TaskParams::new(
        params
            .map(|(name, value)| (name.to_owned(), value))
            .into_iter()
            .collect::<Map<_, _>>(),
    )
}
