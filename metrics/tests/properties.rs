//! Properties of logs and scores, for arbitrary lifetimes.

use std::path::Path;

use driftworld_metrics::{
    LogWriter, LoggerInfo, MaintenanceMethod, NormalizationMethod, Options, Record, Row, ScenarioInfo, SmoothingMethod,
    TransferMethod, read_log, read_ste_log, score,
};
use proptest::prelude::*;
use serde_json::Value;

use crate::generators::{LifetimeRow, any_log, expert, lay_out, lifetime};

/// Options that request all values.
fn options(normalization_method: NormalizationMethod, smoothing_method: SmoothingMethod) -> Options {
    Options {
        normalization_method,
        smoothing_method,
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    }
}

/// The scores of a log as JSON, without the fields about performances as logged.
fn scores(dir: &Path, expert: Option<&Path>, options: &Options) -> Value {
    let experts: Vec<_> = expert.into_iter().map(|dir| read_ste_log(dir).unwrap()).collect();
    let mut scores = serde_json::to_value(score(&read_log(dir).unwrap(), &experts, options).unwrap()).unwrap();
    for of_the_log in ["normalization_data_range", "as_logged"] {
        scores.as_object_mut().unwrap().shift_remove(of_the_log);
    }
    scores
}

/// Where two JSON values differ by more than rounding, which is 1e-9 of the number.
fn difference(a: &Value, b: &Value, place: &str) -> Option<String> {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => a
            .iter()
            .find_map(|(key, value)| difference(value, &b[key], &format!("{place}/{key}"))),
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            (0..a.len()).find_map(|index| difference(&a[index], &b[index], &format!("{place}/{index}")))
        }
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64()?, y.as_f64()?);
            ((x - y).abs() > 1e-9 * x.abs().max(1.0)).then(|| format!("{place}: {x} {y}"))
        }
        _ => (a != b).then(|| format!("{place}: {a} {b}")),
    }
}

/// Whether the performances of every task are all equal, or far enough apart that rounding does not matter.
fn is_spread(rows: &[&[LifetimeRow]]) -> bool {
    let rows = || rows.iter().copied().flatten();
    rows().all(|row| {
        let of_task = || {
            rows()
                .filter(|other| other.task == row.task)
                .map(|other| other.performance)
        };
        let width = of_task().fold(f64::MIN, f64::max) - of_task().fold(f64::MAX, f64::min);
        width == 0.0 || width > 0.1
    })
}

/// Data with at least this number of rows are smoothed.
const SMOOTHED: usize = 15;

/// Whether the learning of a task, or of the expert, is smoothed. The first windows of smoothed data tie by mirroring (of x2 x1
/// | x0 x1 x2 the first three and the last three have equal sums), and the last bit of the sums decides which is the first
/// maximum.
fn ties(rows: &[&[LifetimeRow]]) -> bool {
    rows.iter().any(|rows| {
        let num_of = |row: &LifetimeRow| rows.iter().filter(|other| other.task == row.task).count();
        rows.iter().any(|row| num_of(row) >= SMOOTHED)
    })
}

/// Removes values that depend on which of two equal maxima comes first.
fn without_places_of_maxima(scores: &mut Value) {
    let depends = |key: &str| {
        ["exp_to_sat", "sample_efficiency", "saturation", "cautions"]
            .iter()
            .any(|part| key.contains(part))
    };
    if let Value::Object(fields) = scores {
        fields.retain(|key, _| !depends(key));
        fields.values_mut().for_each(without_places_of_maxima);
    }
}

/// Compares the scores of a lifetime with those after the same change to all performances.
fn check_invariance(
    life: &[LifetimeRow],
    expert: &[LifetimeRow],
    options: &Options,
    change: impl Fn(f64) -> f64,
) -> Result<(), TestCaseError> {
    prop_assume!(is_spread(&[life, expert]));
    let base = tempfile::tempdir().unwrap();
    let changed = |rows: &[LifetimeRow]| -> Vec<LifetimeRow> {
        let row = |row: &LifetimeRow| LifetimeRow {
            performance: change(row.performance),
            ..row.clone()
        };
        rows.iter().map(row).collect()
    };
    let scored = |name: &str, life: &[LifetimeRow], expert: &[LifetimeRow]| {
        let (dir, expert_dir) = (base.path().join(name).join("log"), base.path().join(name).join("ste"));
        lay_out(&dir, life.iter().map(|row| (row, 0)));
        lay_out(&expert_dir, expert.iter().map(|row| (row, 0)));
        let mut scores = scores(&dir, Some(&expert_dir), options);
        if ties(&[life, expert]) {
            without_places_of_maxima(&mut scores);
        }
        scores
    };
    let before = scored("before", life, expert);
    let after = scored("after", &changed(life), &changed(expert));
    prop_assert_eq!(difference(&before, &after, ""), None);
    Ok(())
}

fn normalized() -> impl Strategy<Value = Options> {
    let by = prop::sample::select(vec![NormalizationMethod::Task, NormalizationMethod::Run]);
    (by, prop::sample::select(SmoothingMethod::ALL)).prop_map(|(by, smoothing)| options(by, smoothing))
}

/// The same lifetime with performances that are small whole numbers, so that many sums tie, shifted in turn by
/// 1e-11 times each entry of `moved`.
fn tied(rows: &[LifetimeRow], moved: &[i8]) -> Vec<LifetimeRow> {
    let moves = moved.iter().cycle();
    let row = |(row, moved): (&LifetimeRow, &i8)| LifetimeRow {
        performance: (row.performance / 34.0).round() + 10.0 + f64::from(*moved) * 1e-11,
        ..row.clone()
    };
    rows.iter().zip(moves).map(row).collect()
}

/// A record as text; equal for equal records.
fn shown(record: &Record) -> String {
    format!("{record:?}")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 40)))]

    #[test]
    fn written_records_are_read_back(records in any_log()) {
        let base = tempfile::tempdir().unwrap();
        let info = LoggerInfo::new(["reward"]).unwrap();
        let mut writer = LogWriter::create(base.path(), &info, &ScenarioInfo::default()).unwrap();
        for record in &records {
            writer.write(record).unwrap();
        }
        let mut found: Vec<Record> = read_log(base.path()).unwrap().rows.iter().map(Row::to_record).collect();
        prop_assert!(found.is_sorted_by_key(|record| (record.exp_num, record.block_num)));
        // Rows of several workers may have the same numbers; their time stamps show the order of writing.
        found.sort_by_key(|record| record.timestamp);
        prop_assert_eq!(found.iter().map(shown).collect::<Vec<_>>(), records.iter().map(|record| {
            let mut record = record.clone();
            record.metrics.sort_by(|a, _, b, _| (a != "reward").cmp(&(b != "reward")));
            shown(&record)
        }).collect::<Vec<_>>());
        // A log can be continued where it stopped, whatever its contents.
        drop(writer);
        let last = records.last().unwrap();
        let next = Record { exp_num: last.exp_num + 1, ..last.clone() };
        LogWriter::resume(base.path()).unwrap().write(&next).unwrap();
        prop_assert_eq!(read_log(base.path()).unwrap().rows.len(), records.len() + 1);
    }

    #[test]
    fn scores_do_not_depend_on_files(life in lifetime(), folders in prop::collection::vec(0_usize..5, 1..40)) {
        let base = tempfile::tempdir().unwrap();
        let (one, many) = (base.path().join("one/log"), base.path().join("many/log"));
        lay_out(&one, life.iter().map(|row| (row, 0)));
        lay_out(&many, life.iter().zip(folders.iter().copied().cycle()));
        for normalization in NormalizationMethod::ALL {
            let options = options(*normalization, SmoothingMethod::Flat);
            prop_assert_eq!(scores(&one, None, &options), scores(&many, None, &options));
        }
    }

    #[test]
    fn rounding_changes_no_number_without_a_caution(
        life in lifetime(), expert in expert(), moved in prop::collection::vec(-1..=1_i8, 1..50),
        smoothing in prop::sample::select(SmoothingMethod::ALL), clean in any::<bool>(),
    ) {
        let base = tempfile::tempdir().unwrap();
        let scored = |name: &str, moved: &[i8]| {
            let (dir, expert_dir) = (base.path().join(name).join("log"), base.path().join(name).join("ste"));
            lay_out(&dir, tied(&life, moved).iter().map(|row| (row, 0)));
            lay_out(&expert_dir, tied(&expert, moved).iter().map(|row| (row, 0)));
            let experts = [read_ste_log(&expert_dir).unwrap()];
            let found = score(&read_log(&dir).unwrap(), &experts, &options(NormalizationMethod::Off, smoothing)).unwrap();
            (serde_json::to_value(&found).unwrap(), found.cautions.concat())
        };
        // Computes scores from whole numbers, or from numbers very close to them.
        let (before, after) = (scored("before", if clean { &[0] } else { &[1, 0, -1] }), scored("after", &moved));
        let ((before, cautions), (after, cautions_after)) = (before, after);
        let mut tasks = before["task_metrics"].as_object().unwrap().iter();
        prop_assert!(tasks.all(|(task, values)| {
            let others = &after["task_metrics"][task];
            let mut names = values.as_object().unwrap().keys().chain(others.as_object().unwrap().keys());
            names.all(|name| {
                let [one, other] = [&values[name], &others[name]].map(serde_json::Value::as_f64);
                let is_same = one.zip(other).map_or(one == other, |(one, other)| (one - other).abs() < 1e-6);
                let what = format!("{name} of {task}");
                is_same || cautions.contains(&what) || cautions_after.contains(&what)
            })
        }), "{before:#} {after:#}");
    }

    #[test]
    fn normalised_scores_do_not_depend_on_the_zero_point(
        life in lifetime(), expert in expert(), options in normalized(), shift in -1000.0..1000.0,
    ) {
        check_invariance(&life, &expert, &options, |performance| performance + shift)?;
    }

    #[test]
    fn normalised_scores_do_not_depend_on_the_unit(
        life in lifetime(), expert in expert(), options in normalized(), scale in 0.01..100.0,
    ) {
        check_invariance(&life, &expert, &options, |performance| performance * scale)?;
    }
}
