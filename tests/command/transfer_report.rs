//! `driftworld transfer-report` distinguishes a learner whose transfer falls with distance from one whose transfer does not.
//! The learners are simple formulas that write ordinary logs.

use std::path::Path;

use driftworld::metrics::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp};
use driftworld::similarity::{DistanceMatrix, SimilarityError};
use serde_json::Value;

use super::terminal::{Says, fail_in, succeed_in};

/// Positions of six variants on a line.
const PLACES: [f64; 6] = [0.0, 0.1, 0.25, 0.5, 0.8, 1.0];

/// Orders in which lifetimes learn them.
const ORDERS: [[usize; 6]; 6] = [
    [0, 1, 2, 3, 4, 5],
    [5, 4, 3, 2, 1, 0],
    [3, 0, 5, 1, 4, 2],
    [2, 4, 1, 5, 0, 3],
    [4, 2, 0, 3, 5, 1],
    [1, 5, 3, 0, 2, 4],
];

/// The effect of learning one variant on another, as a share of the other's remaining room for improvement.
type Kernel = fn(usize, usize) -> f64;

/// The nearer the variants, the larger the effect.
#[expect(clippy::disallowed_methods, reason = "compared within a tolerance")]
fn by_distance(a: usize, b: usize) -> f64 {
    (-(PLACES[a] - PLACES[b]).abs() / 0.3).exp()
}

/// A value between a tenth and a half, independent of the distance.
fn independent(a: usize, b: usize) -> f64 {
    if a == b {
        1.0
    } else {
        0.1 + 0.4 * noise((a * 31 + b * 7) as u64 + 5)
    }
}

/// A pseudo-random number in 0..1.
fn noise(k: u64) -> f64 {
    let mixed = k.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 40) as f64 / (1_u64 << 24) as f64
}

/// A lifetime in progress: the learner's level in each variant, and its log.
struct Life {
    skill: [f64; 6],
    log: LogWriter,
    block: u64,
    experience: u64,
}

impl Life {
    fn experience(&mut self, kind: BlockType, variant: usize) {
        let reward = 10.0 * self.skill[variant] + 0.1 * noise(self.experience);
        let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + self.experience as i64).expect("a valid time");
        let record = Record::new(self.block, self.experience, kind, format!("line_v{variant}"), when);
        self.log
            .write(&record.with_metric("reward", reward))
            .expect("the folder can be written");
        self.experience += 1;
    }

    fn evaluate(&mut self) {
        for variant in 0..6 {
            (0..3).for_each(|_| self.experience(BlockType::Test, variant));
        }
        self.block += 1;
    }

    fn learn(&mut self, variant: usize, kernel: Kernel) {
        for _ in 0..15 {
            self.experience(BlockType::Train, variant);
            for other in 0..6 {
                self.skill[other] += 0.05 * kernel(variant, other) * (1.0 - self.skill[other]);
            }
        }
        self.block += 1;
    }
}

/// Learns the variants in this order, with evaluations before and after each unless disabled.
fn simulate(folder: &Path, order: &[usize], kernel: Kernel, evaluations: bool) {
    let info = LoggerInfo::new(["reward"]).expect("the columns are valid");
    let log = LogWriter::create(folder, &info, &ScenarioInfo::default()).expect("the folder is new");
    let mut life = Life {
        skill: [0.1; 6],
        log,
        block: 0,
        experience: 0,
    };
    for variant in order {
        if evaluations {
            life.evaluate();
        }
        life.learn(*variant, kernel);
    }
    if evaluations {
        life.evaluate();
    }
}

/// A folder with `logs/` of these lifetimes and `distances.csv`.
fn simulated(orders: &[&[usize]], kernel: Kernel, evaluations: bool) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("the machine has a folder for temporary files");
    for (k, order) in orders.iter().enumerate() {
        simulate(&folder.path().join(format!("logs/run{k}")), order, kernel, evaluations);
    }
    let labels = (0..6).map(|k| format!("line#v{k}")).collect();
    write_matrix(folder.path(), labels);
    folder
}

fn write_matrix(folder: &Path, labels: Vec<String>) {
    let matrix = DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>((PLACES[a] - PLACES[b]).abs()));
    let text = matrix.expect("these are distances").to_csv();
    std::fs::write(folder.join("distances.csv"), text).expect("the folder can be written");
}

const REPORT: [&str; 4] = ["transfer-report", "logs", "--distances", "distances.csv"];

#[track_caller]
fn reported(folder: &Path, more: &[&str]) -> String {
    succeed_in(folder, &[&REPORT, more].concat())
}

#[track_caller]
fn refused(folder: &Path, code: i32, more: &[&str]) -> String {
    fail_in(folder, code, &[&REPORT, more].concat())
}

fn json(folder: &Path) -> Value {
    serde_json::from_str(&reported(folder, &["--json"])).expect("--json prints JSON")
}

fn every_order() -> Vec<&'static [usize]> {
    ORDERS.iter().map(<[usize; 6]>::as_slice).collect()
}

#[test]
fn distance_dependent_transfer_is_distinguished() {
    let near = json(simulated(&every_order(), by_distance, true).path());
    let test = &near["forward"]["spearman"];
    assert_eq!(
        (&test["pairs"], &test["items"], &test["exact"]),
        (&30.into(), &6.into(), &true.into())
    );
    assert!(test["correlation"].as_f64() < Some(-0.6), "{test}");
    assert!(test["p_less"].as_f64() < Some(0.01), "{test}");
    assert_eq!((&near["lifetimes"], &near["learning_orders"]), (&6.into(), &6.into()));

    let unrelated = json(simulated(&every_order(), independent, true).path());
    let test = &unrelated["forward"]["spearman"];
    assert!(test["correlation"].as_f64().map(f64::abs) < Some(0.35), "{test}");
    assert!(test["p_two_sided"].as_f64() > Some(0.1), "{test}");
}

#[test]
fn report_explains_itself_and_draws_a_picture() {
    let folder = simulated(&every_order(), by_distance, true);
    let stdout = reported(folder.path(), &["--plot", "transfer.png"]);
    for words in [
        "6 lifetimes",
        "line#v0",
        "all 720 relabellings",
        "not the probability that similarity does not matter",
        "Correlation is not causation",
    ] {
        assert!(stdout.contains(words), "{words}: {stdout}");
    }
    assert!(!stdout.contains("the same order"), "{stdout}");
    let picture = std::fs::read(folder.path().join("transfer.png")).expect("it was written");
    assert!(picture.starts_with(b"\x89PNG"));
    if let Some(keep) = std::env::var_os("DRIFTWORLD_KEEP_PICTURES") {
        std::fs::copy(
            folder.path().join("transfer.png"),
            Path::new(&keep).join("transfer.png"),
        )
        .expect("the folder is writable");
    }
    let one = simulated(&[&ORDERS[0]], by_distance, true);
    assert!(reported(one.path(), &[]).contains("learned in the same order"));
}

#[test]
fn impossible_reports_say_what_is_needed() {
    let folder = simulated(&[&ORDERS[0]], by_distance, false);
    let error = refused(folder.path(), 1, &[]);
    error.says("no evaluation in 1 logs");
    error.says("--evaluate every");

    let folder = simulated(&[&ORDERS[0][..2]], by_distance, true);
    write_matrix(folder.path(), vec!["line#v0".to_owned(), "line#v1".to_owned()]);
    let error = refused(folder.path(), 1, &[]);
    error.says("1 forward and 1 backward");
    error.says("at least 3");

    write_matrix(folder.path(), vec!["curve#v0".to_owned(), "curve#v1".to_owned()]);
    let error = refused(folder.path(), 1, &[]);
    assert!(error.contains("line_v0") && error.contains("curve#v0"), "{error}");

    let error = refused(folder.path(), 1, &["--perf-measure", "joy"]);
    assert!(error.contains("\"joy\"") && error.contains("reward"), "{error}");
    std::fs::write(folder.path().join("distances.csv"), "nothing").expect("the folder can be written");
    assert!(refused(folder.path(), 1, &[]).contains("distances.csv: matrix, line 1: found \"nothing\""));
    std::fs::remove_dir_all(folder.path().join("logs")).expect("it exists");
    std::fs::create_dir(folder.path().join("logs")).expect("it is gone");
    write_matrix(folder.path(), vec!["line#v0".to_owned(), "line#v1".to_owned()]);
    assert!(refused(folder.path(), 1, &[]).contains("logs: found no log"));
    refused(folder.path(), 2, &["--relabellings", "0"]);
}
