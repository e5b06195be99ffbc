//! A log may be torn at any byte: every state that a killed run can leave can be resumed, and only the torn row is lost.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use driftworld_metrics::{
    BlockType, ExpStatus, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log, validate_log,
};

use crate::files_below::files_below;
use crate::tier::quick_or_full;

/// Bytes of every file, by its path within the log.
type Files = BTreeMap<String, Vec<u8>>;

/// Records with cells that are hard to write as a table: line breaks, tabs and quotes within quotes, multi-byte characters.
fn records() -> Vec<Record> {
    let record = |index: u64, block_num: u64, exp_num: u64, worker: &str, task: &str| {
        let stamp = Timestamp::from_unix_micros(1_600_000_000_000_000 + index as i64).unwrap();
        let params = serde_json::Map::from_iter([("é \"quoted\"\n".to_owned(), index.into())]);
        let block_type = if block_num == 1 {
            BlockType::Test
        } else {
            BlockType::Train
        };
        Record::new(block_num, exp_num, block_type, task, stamp)
            .with_worker(worker)
            .with_task_params(params)
            .with_metric("reward", index as f64 / 3.0)
            .with_metric("a\n\"b\"\té", f64::NAN)
    };
    let mut begun = record(2, 0, 1, "v", "\n\"\n");
    begun.exp_status = ExpStatus::Incomplete;
    vec![
        record(0, 0, 0, "v", "find_red"),
        record(1, 0, 0, "w", "line\nbreak\ttab"),
        begun,
        record(3, 0, 1, "v", "é\n"),
        record(4, 1, 2, "w", "\r\n"),
        record(5, 1, 3, "v", "\"\"\t"),
        record(6, 2, 3, "w", "ü"),
    ]
}

fn lay_out(dir: &Path, files: &Files) {
    for (path, bytes) in files {
        let path = dir.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

/// The log after each record, from none to all.
fn stages(records: &[Record]) -> Vec<Files> {
    let base = tempfile::tempdir().unwrap();
    let info = LoggerInfo::new(["reward"]).unwrap();
    let mut writer = LogWriter::create(base.path(), &info, &ScenarioInfo::default()).unwrap();
    let mut stages = vec![files_below(base.path())];
    for record in records {
        writer.write(record).unwrap();
        stages.push(files_below(base.path()));
    }
    stages
}

/// Distance between cuts in the quick tier, in bytes.
const QUICK_STEP: usize = 7;

/// The states of the disk between one stage and the next: the one file that grew is cut at every byte, or at fewer bytes in the
/// quick tier. The file may be empty.
fn cuts<'a>(before: &'a Files, after: &'a Files) -> impl Iterator<Item = Files> + 'a {
    let mut grown = after.iter().filter(|(path, bytes)| before.get(*path) != Some(bytes));
    let (path, bytes) = grown.next().unwrap();
    assert!(grown.next().is_none(), "a record goes to one file");
    let start = before.get(path).map_or(0, Vec::len);
    (start..bytes.len())
        .step_by(quick_or_full(QUICK_STEP, 1))
        .map(move |end| {
            let mut cut = before.clone();
            cut.insert(path.clone(), bytes[..end].to_vec());
            cut
        })
}

#[test]
fn log_cut_at_any_byte_resumes_as_if_uninterrupted() {
    let records = records();
    let stages = stages(&records);
    let whole = stages.last().unwrap();
    let mut num_cuts = 0;
    for (done, pair) in stages.windows(2).enumerate() {
        for cut in cuts(&pair[0], &pair[1]) {
            let base = tempfile::tempdir().unwrap();
            lay_out(base.path(), &cut);
            let mut writer = LogWriter::resume(base.path()).unwrap_or_else(|error| panic!("{done}: {error}\n{cut:?}"));
            if done > 0 {
                let kept = read_log(base.path()).unwrap().rows.len();
                assert_eq!(kept, done, "nothing but the torn row is lost: {cut:?}");
            }
            for record in &records[done..] {
                writer.write(record).unwrap();
            }
            writer.finish().unwrap();
            assert!(
                files_below(base.path()) == *whole,
                "after {done} records and a cut: {cut:?}"
            );
            num_cuts += 1;
        }
    }
    let num_bytes = |files: &Files| files.values().map(Vec::len).sum::<usize>();
    let grown = num_bytes(whole) - num_bytes(&stages[0]);
    let expected = quick_or_full(grown / QUICK_STEP..=grown / QUICK_STEP + records.len(), grown..=grown);
    assert!(expected.contains(&num_cuts), "{num_cuts} cuts of {grown} bytes");
}

#[test]
fn torn_rows_are_located_and_never_read() {
    let records = records();
    let stages = stages(&records);
    for (done, pair) in stages.windows(2).enumerate().skip(1) {
        for cut in cuts(&pair[0], &pair[1]) {
            let base = tempfile::tempdir().unwrap();
            lay_out(base.path(), &cut);
            let codes: Vec<&str> = validate_log(base.path())
                .problems
                .iter()
                .map(driftworld_metrics::MetricsError::code)
                .collect();
            match read_log(base.path()) {
                // The cut lies between two rows.
                Ok(log) => assert_eq!((log.rows.len(), codes.len()), (done, 0), "{cut:?}"),
                Err(error) => {
                    assert!(
                        ["metrics/torn-last-line", "metrics/empty-file"].contains(&error.code()),
                        "{error}\n{cut:?}"
                    );
                    assert_eq!(codes, [error.code()], "{cut:?}");
                }
            }
        }
    }
}

#[test]
fn quote_that_swallowed_rows_is_not_a_torn_row_and_nothing_is_removed() {
    let mut records = records();
    for record in &mut records {
        record.task_name = "a_b".to_owned();
        record.block_num = 0;
        record.block_type = BlockType::Train;
        record.worker_id = "w".to_owned();
    }
    records.dedup_by_key(|record| record.exp_num);
    let mut log = stages(&records).pop().unwrap();
    let path = "w/0-train/data-log.tsv";
    let text = String::from_utf8(log[path].clone())
        .unwrap()
        .replacen("a_b", "\"a_b", 1);
    log.insert(path.to_owned(), text.replace("\\n\"\"", "n").into_bytes());
    let base = tempfile::tempdir().unwrap();
    lay_out(base.path(), &log);
    // The quotes of the parameters close the cell again and again; the rest is not a table, but all of it is kept.
    LogWriter::resume(base.path()).unwrap_err();
    assert!(files_below(base.path()) == log);
}

#[test]
fn truncated_info_files_are_reported_and_rows_are_kept() {
    let log = stages(&records()).pop().unwrap();
    for name in ["logger_info.json", "scenario_info.json"] {
        for end in 0..log[name].len() - 1 {
            let mut cut = log.clone();
            cut.get_mut(name).unwrap().truncate(end);
            let base = tempfile::tempdir().unwrap();
            lay_out(base.path(), &cut);
            assert_eq!(
                read_log(base.path()).unwrap_err().code(),
                "metrics/json",
                "{name} {end}"
            );
            if name == "logger_info.json" {
                assert_eq!(LogWriter::resume(base.path()).unwrap_err().code(), "metrics/json");
            }
            assert!(files_below(base.path()) == cut);
        }
    }
}
