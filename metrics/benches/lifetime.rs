//! Benchmarks of writing, reading, validating and scoring a lifetime.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_metrics::{
    BlockType, LogWriter, LoggerInfo, MetricsError, Options, Record, ScenarioInfo, Timestamp, read_log, score,
    validate_log,
};

const NUM_ROWS: u64 = 10_000;
const ROWS_PER_BLOCK: u64 = 500;

/// Writes a log of two alternating tasks, each evaluated after its learning blocks.
fn write(dir: &Path) -> Result<(), MetricsError> {
    let mut writer = LogWriter::create(dir, &LoggerInfo::new(["reward"])?, &ScenarioInfo::default())?;
    for exp_num in 0..NUM_ROWS {
        let block = exp_num / ROWS_PER_BLOCK;
        let block_type = [BlockType::Train, BlockType::Test][block as usize % 2];
        let task = ["find_red", "find_blue"][(block / 2) as usize % 2];
        let when = Timestamp::from_unix_micros(exp_num as i64 * 1_234_567)?;
        let params = serde_json::Map::from_iter([("block".to_owned(), block.into())]);
        let record = Record::new(block, exp_num, block_type, task, when).with_task_params(params);
        writer.write(&record.with_metric("reward", (exp_num as f64 * 0.618).fract()))?;
    }
    writer.finish()
}

fn lifetime(c: &mut Criterion) {
    let base = tempfile::tempdir().expect("a temporary folder can be created");
    let dir = base.path().join("log");
    c.bench_function("write a log of 10,000 rows", |bench| {
        bench.iter(|| {
            let _ = std::fs::remove_dir_all(&dir);
            write(&dir).expect("the folder is gone");
        });
    });
    c.bench_function("read a log of 10,000 rows", |bench| {
        bench.iter(|| read_log(black_box(&dir)).expect("it is valid"));
    });
    c.bench_function("validate a log of 10,000 rows", |bench| {
        bench.iter(|| validate_log(black_box(&dir)));
    });
    let log = read_log(&dir).expect("it is valid");
    c.bench_function("score a lifetime of 10,000 rows", |bench| {
        bench.iter(|| score(black_box(&log), &[], &Options::default()).expect("it has rewards"));
    });
}

criterion_group!(benches, lifetime);
criterion_main!(benches);
