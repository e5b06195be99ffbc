//! `docs/metrics.md` describes the metrics exactly as the code does.

use driftworld_metrics::{
    BlockType, Direction, LifetimeMetrics, LogWriter, LoggerInfo, MaintenanceMethod, Options, Record, ScenarioInfo,
    Timestamp, TransferMethod, read_log, score,
};

const PAGE: &str = include_str!("../../docs/metrics.md");

/// The scores of a lifetime of one experience; only their names matter here.
fn scores() -> LifetimeMetrics {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("life");
    let mut log = LogWriter::create(&dir, &LoggerInfo::new(["reward"]).unwrap(), &ScenarioInfo::default()).unwrap();
    let when = Timestamp::from_unix_micros(0).unwrap();
    log.write(&Record::new(0, 0, BlockType::Train, "a_1", when).with_metric("reward", 1.0))
        .unwrap();
    let options = Options {
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    };
    score(&read_log(&dir).unwrap(), &[], &options).unwrap()
}

#[test]
fn documented_metrics_table_matches_the_code() {
    let summary = scores().summary();
    let rows = summary.iter().map(|row| {
        let good = match row.good {
            Direction::Higher => "higher".to_owned(),
            Direction::Lower => "lower".to_owned(),
            Direction::HigherThan(neutral) => format!("above {neutral}"),
            Direction::LowerThan(neutral) => format!("below {neutral}"),
        };
        format!("| `{}` | {} | {good} |\n", row.name, row.explanation)
    });
    let table = format!(
        "| metric | what it says | good |\n|---|---|---|\n{}\n",
        rows.collect::<String>()
    );
    assert!(
        PAGE.contains(&table),
        "docs/metrics.md should have this table:\n{table}"
    );
}

#[test]
fn every_task_value_is_documented() {
    let scores = scores();
    let columns = scores.regimes[0].values.iter().map(|(name, _)| name);
    for name in columns.chain([
        "recovery_times",
        "avg_train_perf_vals",
        "avg_eval_perf_vals",
        "ste_rel_perf_vals",
    ]) {
        assert!(
            PAGE.contains(&format!("`{name}`")),
            "docs/metrics.md does not explain {name}"
        );
    }
}
