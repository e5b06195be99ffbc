//! `driftworld metrics` with null bands: results of tasks, null bands, and when a metric is called "good".

use std::path::Path;

use super::terminal::{Says, scratch, succeed_in};
use driftworld::metrics::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp};
use serde_json::Value;

pub(crate) fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("it is JSON")
}

/// Writes a log: a row for each block, type, task, world index and reward.
pub(crate) fn write(folder: &Path, rows: &[(u64, BlockType, &str, u32, f64)]) {
    let info = LoggerInfo::new(["reward", "world_index"]).expect("the columns are valid");
    let mut log = LogWriter::create(folder, &info, &ScenarioInfo::default()).expect("the folder is new");
    for (number, (block, block_type, task, world, reward)) in (0..).zip(rows) {
        let when = Timestamp::from_unix_micros(number as i64).expect("it is a valid time");
        let record = Record::new(*block, number, *block_type, *task, when).with_metric("reward", *reward);
        let record = record.with_metric("world_index", f64::from(*world));
        log.write(&record).expect("the folder can be written");
    }
}

/// Evaluates two tasks, learns one, evaluates both, learns the other, evaluates both, in worlds that differ.
fn live(folder: &Path, reward: impl Fn(u64, &str) -> f64) {
    let mut rows = Vec::new();
    for block in 0..5 {
        let (block_type, tasks): (_, &[&str]) = match block {
            1 => (BlockType::Train, &["find_red"]),
            3 => (BlockType::Train, &["find_blue"]),
            _ => (BlockType::Test, &["find_red", "find_blue"]),
        };
        for task in tasks {
            rows.extend((0..8).map(|world| {
                let of_world = f64::from(world * 5 % 7);
                (block, block_type, *task, world, reward(block, task) + of_world)
            }));
        }
    }
    write(folder, &rows);
}

#[test]
fn good_appears_only_outside_the_null_band() {
    let folder = scratch();
    live(&folder.path().join("still"), |_, _| 0.0);
    live(&folder.path().join("learns"), |block, _| 20.0 * block as f64);
    let still = succeed_in(folder.path(), &["metrics", "still", "-m", "both", "-t", "both"]);
    let named = ["helps", "interferes", "keeps", "forgets", "mixed  "];
    assert!(
        named.iter().all(|word| !still.contains(&format!("  {word}"))),
        "{still}"
    );
    still.says("no null");
    still.says("no clear effect");
    let learns = succeed_in(folder.path(), &["metrics", "learns"]);
    let line = learns
        .lines()
        .find(|line| line.starts_with("forward_transfer_contrast"));
    assert!(line.is_some_and(|line| line.contains("  helps")), "{learns}");
    let place = |words: &str| learns.find(words).unwrap_or_else(|| panic!("no {words} in {learns}"));
    // Results of tasks come first; contrasts, although not requested, before ratios.
    assert!(place("last evaluation") < place("mean reward"), "{learns}");
    assert!(
        place("forward_transfer_contrast") < place("forward_transfer_ratio"),
        "{learns}"
    );
    assert!(
        place("backward_transfer_contrast") < place("forward_transfer_ratio"),
        "{learns}"
    );

    let json = parsed(&succeed_in(folder.path(), &["metrics", "learns", "--json"]));
    // Eight worlds cannot show maintenance, but do show that learning one task helps the other.
    let band = &json["null"]["forward_transfer_contrast"];
    assert!(band["high"].as_f64() < band["value"].as_f64(), "{json}");
    assert!(
        band["p"].as_f64().expect("it is a number") < 0.01 && band["exchanged"] == "worlds",
        "{json}"
    );
    // The files are in l2metrics' format.
    succeed_in(folder.path(), &["metrics", "learns", "-O", "results"]);
    let file = std::fs::read_to_string(folder.path().join("results/learns_metrics.json")).expect("the file exists");
    for ours in ["readings", "null", "contrasts", "reached", "forward_transfer_contrast"] {
        assert_eq!(parsed(&file).get(ours), None, "{ours}");
    }
}

#[test]
fn task_that_was_never_learned_is_marked() {
    let folder = scratch();
    live(&folder.path().join("life"), |block, task| {
        if task == "find_red" && block > 0 { 60.0 } else { -3.0 }
    });
    for (task, level) in [("find_red", 80.0), ("find_blue", 250.0)] {
        let rows: Vec<_> = (0..10).map(|world| (0, BlockType::Train, task, world, level)).collect();
        write(&folder.path().join(task), &rows);
    }
    let shown = succeed_in(folder.path(), &["metrics", "life", "--ste", "find_red", "find_blue"]);
    let line = |task: &str| {
        let lines = shown.lines().find(|line| line.starts_with(task));
        lines.unwrap_or_else(|| panic!("no {task} in {shown}"))
    };
    assert!(
        line("find_blue").ends_with("never learned") && line("find_blue").contains('±'),
        "{shown}"
    );
    assert!(!line("find_red").contains("never learned"), "{shown}");
    let json = parsed(&succeed_in(
        folder.path(),
        &["metrics", "life", "--ste", "find_red", "find_blue", "--json"],
    ));
    assert_eq!(json["reached"]["find_blue"]["expert"], 250.0, "{json}");
    assert_eq!(
        json["reached"]["find_red"]["evaluations"].as_array().map(Vec::len),
        Some(3),
        "{json}"
    );
}
