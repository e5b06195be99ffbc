//! Lifetimes small enough to be scored by hand; the comments show the calculations.

use driftworld_metrics::{
    BlockSubtype, BlockType, DataRange, Definitions, LifetimeMetrics, Log, LogWriter, LoggerInfo, MaintenanceMethod,
    NormalizationMethod, Options, PairValues, Record, ScenarioInfo, SteAveragingMethod, SteLog, Timestamp,
    TransferMethod, Value, VariantMode, read_log, score,
};

use BlockSubtype::{Sleep, Wake};
use BlockType::{Test, Train};

/// A block of one task: its type, its task, and the performance of each experience.
type Block<'a> = (BlockType, &'a str, &'a [f64]);

/// Writes the blocks to disk and reads them back, so that every test here covers the path from file to result.
fn log_of(blocks: &[Block<'_>]) -> Log {
    let awake: Vec<_> = blocks.iter().map(|block| (*block, Wake)).collect();
    log_with_sleep(&awake)
}

fn log_with_sleep(blocks: &[(Block<'_>, BlockSubtype)]) -> Log {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("tiny");
    let mut writer = LogWriter::create(&dir, &LoggerInfo::new(["reward"]).unwrap(), &ScenarioInfo::default()).unwrap();
    let mut exp_num = 0;
    for (block_num, ((block_type, task, performances), block_subtype)) in (0..).zip(blocks) {
        for performance in *performances {
            let stamp = Timestamp::from_unix_micros(exp_num as i64 * 500_000).unwrap();
            let record = Record::new(block_num, exp_num, *block_type, *task, stamp).with_metric("reward", *performance);
            writer
                .write(&Record {
                    block_subtype: *block_subtype,
                    ..record
                })
                .unwrap();
            exp_num += 1;
        }
    }
    read_log(&dir).unwrap()
}

/// Unnormalised performances, for scoring by hand. No block here is long enough to be smoothed.
fn plain() -> Options {
    Options {
        normalization_method: NormalizationMethod::Off,
        ..Options::default()
    }
}

fn scored(blocks: &[Block<'_>], options: &Options) -> LifetimeMetrics {
    score(&log_of(blocks), &[], options).unwrap()
}

/// Two alternating tasks, each evaluated after every learning block.
const ALTERNATING: [Block<'static>; 11] = [
    (Test, "a_1", &[2.0, 2.0]),   // regime 0
    (Test, "b_1", &[4.0]),        // 1
    (Train, "a_1", &[2.0, 8.0]),  // 2: its last tenth begins at index ⌊1.8⌋ = 1, so it ends at 8
    (Test, "a_1", &[10.0, 10.0]), // 3: reference of regime 2
    (Test, "b_1", &[6.0]),        // 4
    (Train, "b_1", &[6.0, 12.0]), // 5: ends at 12
    (Test, "a_1", &[9.0, 7.0]),   // 6: terminal performance 8
    (Test, "b_1", &[12.0]),       // 7: reference of regime 5
    (Train, "a_1", &[7.0, 9.0]),  // 8: ends at 9; reaches the 8 of regime 2 at index 1
    (Test, "a_1", &[11.0]),       // 9: reference of regime 8
    (Test, "b_1", &[15.0]),       // 10
];

#[test]
fn maintenance_is_the_difference_from_the_evaluation_right_after_learning() {
    let options = Options {
        maintenance_method: MaintenanceMethod::Both,
        ..plain()
    };
    let metrics = scored(&ALTERNATING, &options);
    // a: regime 0 precedes all learning, 3 and 9 are references; regime 6 gives 8 − 10.
    let a = &metrics.task_metrics["a_1"];
    assert_eq!(a.get("maintenance_val_mrlep"), Some(&Value::Runs(vec![vec![-2.0]])));
    // Against the end of learning, 8 − 8.
    assert_eq!(a.get("maintenance_val_mrtlp"), Some(&Value::Runs(vec![vec![0.0]])));
    // b: regime 10 gives 15 − 12, and 15 − 12 against the end of learning.
    let b = &metrics.task_metrics["b_1"];
    assert_eq!(
        (b.number("perf_maintenance_mrlep"), b.number("perf_maintenance_mrtlp")),
        (Some(3.0), Some(3.0))
    );
    assert_eq!(
        metrics.lifetime.number("perf_maintenance_mrlep"),
        Some(0.5),
        "mean of −2 and 3"
    );
    assert_eq!(
        metrics.lifetime.number("perf_maintenance_mrtlp"),
        Some(1.5),
        "mean of 0 and 3"
    );
}

#[test]
fn transfer_compares_evaluations_before_and_after_another_task_is_learned() {
    let options = Options {
        transfer_method: TransferMethod::Both,
        ..plain()
    };
    let metrics = scored(&ALTERNATING, &options);
    let (a, b) = (&metrics.task_metrics["a_1"], &metrics.task_metrics["b_1"]);
    let pair = |task: &str, values: &[f64]| PairValues::from([(task.to_owned(), values.to_vec())]);
    // a is learned (2) between the evaluations 1 and 4 of b, before b's first learning: 6/4, and 2/10.
    assert_eq!(a.pairs("forward_transfer_ratio"), Some(&pair("b_1", &[1.5])));
    assert_eq!(a.pairs("forward_transfer_contrast"), Some(&pair("b_1", &[0.2])));
    // a is learned again (8) between the evaluations 7 and 10 of b, after b's first learning: 15/12, and 3/27.
    assert_eq!(a.pairs("backward_transfer_ratio"), Some(&pair("b_1", &[1.25])));
    assert_eq!(a.pairs("backward_transfer_contrast"), Some(&pair("b_1", &[3.0 / 27.0])));
    // b is learned (5) between the evaluations 3 and 6 of a, which was learned before: 8/10, and −2/18.
    assert_eq!(b.pairs("forward_transfer_ratio"), Some(&[].into()));
    assert_eq!(b.pairs("backward_transfer_ratio"), Some(&pair("a_1", &[0.8])));
    assert_eq!(
        b.pairs("backward_transfer_contrast"),
        Some(&pair("a_1", &[-2.0 / 18.0]))
    );
    assert_eq!(metrics.lifetime.number("forward_transfer_ratio"), Some(1.5));
    assert_eq!(
        metrics.lifetime.number("backward_transfer_ratio"),
        Some(f64::midpoint(1.25, 0.8))
    );
}

#[test]
fn recovery_and_averages_are_computed_regime_by_regime() {
    let metrics = scored(&ALTERNATING, &plain());
    let a = &metrics.task_metrics["a_1"];
    assert!(
        a.numbers("recovery_times").unwrap().is_empty(),
        "the reference does not list a single recovery time"
    );
    let published = Options {
        definitions: Definitions::Published,
        ..plain()
    };
    let published = scored(&ALTERNATING, &published).task_metrics["a_1"].clone();
    assert_eq!(published.numbers("recovery_times").unwrap(), [1.0]);
    assert_eq!(published.number("perf_recovery"), None, "one recovery has no trend");
    assert_eq!(
        (a.numbers("avg_train_perf_vals").unwrap(), a.number("avg_train_perf")),
        (&[5.0, 8.0][..], Some(6.5))
    );
    // Regimes have equal weight whatever their length: 2, 10, 8, 11.
    assert_eq!(a.number("avg_eval_perf"), Some(31.0 / 4.0));
    assert_eq!(
        (
            a.number("num_lx").unwrap(),
            a.number("num_ex").unwrap(),
            metrics.num_lx,
            metrics.num_ex
        ),
        (4.0, 7.0, 6, 11)
    );
    assert_eq!(
        (
            a.number("min").unwrap(),
            a.number("max").unwrap(),
            metrics.min,
            metrics.max
        ),
        (2.0, 11.0, 2.0, 15.0)
    );
    assert_eq!(metrics.runtime, 8.0, "seventeen experiences, half a second apart");
    assert_eq!(metrics.run_id, "tiny");
    assert_eq!(metrics.task_metrics.keys().collect::<Vec<_>>(), ["a_1", "b_1"]);
}

#[test]
fn slowing_recovery_is_negative() {
    let blocks: [Block<'_>; 4] = [
        (Train, "a_1", &[5.0]),
        (Train, "a_1", &[5.0, 6.0]), // reaches 5 at index 0, ends at 6
        (Train, "a_1", &[1.0, 6.0]), // reaches 6 at index 1, ends at 6
        (Train, "a_1", &[1.0, 2.0]), // never reaches 6: two experiences plus one
    ];
    let a = &scored(&blocks, &plain()).task_metrics["a_1"];
    assert_eq!(a.numbers("recovery_times").unwrap(), [0.0, 1.0, 3.0]);
    // Slopes 1, 1.5 and 2; the median is 1.5.
    assert_eq!(a.number("perf_recovery"), Some(-1.5));
}

#[test]
fn constant_recovery_is_0_without_a_sign() {
    let again: Block<'_> = (Train, "a_1", &[5.0]);
    let metrics = scored(&[again, again, again], &plain());
    assert_eq!(
        metrics.task_metrics["a_1"].numbers("recovery_times").unwrap(),
        [0.0, 0.0]
    );
    for values in [&metrics.task_metrics["a_1"], &metrics.lifetime] {
        let recovery = values.number("perf_recovery").unwrap();
        assert_eq!(recovery.to_bits(), 0.0_f64.to_bits(), "{recovery:?}");
    }
}

#[test]
fn last_pair_gets_the_transfer_of_a_shared_gap() {
    let blocks: [Block<'_>; 5] = [
        (Test, "c_1", &[2.0]),
        (Train, "b_1", &[1.0]),
        (Train, "a_1", &[1.0]),
        (Test, "c_1", &[6.0]),
        (Test, "a_1", &[1.0]),
    ];
    // Order of appearance is c, b, a; (a, c) comes after (b, c).
    let metrics = scored(&blocks, &plain());
    assert_eq!(
        metrics.task_metrics["b_1"].pairs("forward_transfer_ratio"),
        Some(&[].into())
    );
    assert_eq!(
        metrics.task_metrics["a_1"].pairs("forward_transfer_ratio"),
        Some(&[("c_1".to_owned(), vec![3.0])].into())
    );
    // Trained tasks come first, in the order in which they were learned.
    assert_eq!(metrics.task_metrics.keys().collect::<Vec<_>>(), ["b_1", "a_1", "c_1"]);
    assert_eq!(metrics.task_metrics["c_1"].number("avg_train_perf"), None);
}

#[test]
fn transfer_from_0_to_0_is_undefined() {
    let blocks: [Block<'_>; 3] = [(Test, "b_1", &[0.0]), (Train, "a_1", &[1.0]), (Test, "b_1", &[0.0])];
    let options = Options {
        transfer_method: TransferMethod::Both,
        ..plain()
    };
    let metrics = scored(&blocks, &options);
    assert_eq!(metrics.lifetime.number("forward_transfer_ratio"), None);
    assert_eq!(metrics.lifetime.number("forward_transfer_contrast"), None);
}

#[test]
fn sleeping_agent_is_judged_by_evaluations_after_sleep() {
    let blocks = [
        ((Train, "a_1", &[4.0][..]), Wake),
        ((Test, "a_1", &[4.0][..]), Wake),
        ((Test, "a_1", &[6.0][..]), Sleep),
        ((Test, "a_1", &[5.0][..]), Sleep),
    ];
    let metrics = score(&log_with_sleep(&blocks), &[], &plain()).unwrap();
    let a = &metrics.task_metrics["a_1"];
    // The wake evaluation is neither the reference nor part of the average: 5 − 6, and the mean of 6 and 5.
    assert_eq!(
        (a.number("perf_maintenance_mrlep"), a.number("avg_eval_perf")),
        (Some(-1.0), Some(5.5))
    );
    assert_eq!(metrics.regimes[1].values.number("avg_perf"), None);
    assert_eq!(a.number("num_ex"), Some(3.0));
}

#[test]
fn constant_task_is_1_everywhere() {
    let metrics = scored(
        &[(Train, "a_1", &[3.0, 3.0]), (Test, "a_1", &[3.0])],
        &Options::default(),
    );
    assert_eq!((metrics.min, metrics.max), (1.0, 1.0));
    assert_eq!(
        (
            metrics.lifetime.number("avg_train_perf"),
            metrics.lifetime.number("avg_eval_perf")
        ),
        (Some(1.0), Some(1.0))
    );
}

#[test]
fn rows_without_a_number_are_dropped_before_forming_regimes() {
    let blocks: [Block<'_>; 3] = [
        (Train, "a_1", &[f64::NAN, 1.0, f64::NAN, 3.0]),
        (Test, "b_1", &[f64::NAN]),
        (Test, "a_1", &[2.0]),
    ];
    let metrics = scored(&blocks, &plain());
    assert_eq!((metrics.num_lx, metrics.num_ex, metrics.regimes.len()), (2, 1, 2));
    assert_eq!(metrics.task_metrics.keys().collect::<Vec<_>>(), ["a_1"]);
    assert_eq!(metrics.lifetime.number("avg_train_perf"), Some(2.0));
}

#[test]
fn single_row_is_a_lifetime() {
    let metrics = scored(&[(Train, "a_1", &[7.0])], &Options::default());
    let regime = &metrics.regimes[0];
    assert_eq!(
        (
            regime.values.number("saturation"),
            regime.values.number("exp_to_sat"),
            regime.values.number("term_perf"),
            regime.values.number("exp_to_term_perf")
        ),
        (Some(1.0), Some(0.0), Some(1.0), Some(0.0))
    );
    assert_eq!(metrics.runtime, 0.0);
}

#[test]
fn uncomputable_values_are_null_and_never_nan() {
    let metrics = scored(&[(Train, "a_1", &[7.0])], &Options::default());
    let json = serde_json::to_string(&metrics).unwrap();
    assert!(!json.contains("NaN"), "{json}");
    let object: serde_json::Map<String, serde_json::Value> = serde_json::from_str(&json).unwrap();
    assert_eq!(object["avg_train_perf"], 1.0);
    assert!(
        object["avg_eval_perf"].is_null(),
        "requested, but there was no evaluation"
    );
    assert!(!object.contains_key("perf_maintenance_mrtlp"), "not requested");
    assert!(!serde_json::to_string(&object["task_metrics"]).unwrap().contains("null"));
    let values: Vec<_> = metrics
        .summary()
        .into_iter()
        .filter_map(|row| row.value.map(|_| row.name))
        .collect();
    assert_eq!(values, ["avg_train_perf"]);
    // Saved results can be read back, except for the regimes, which have a separate file.
    let back: LifetimeMetrics = serde_json::from_str(&json).unwrap();
    assert_eq!((&back.lifetime, back.regimes.len()), (&metrics.lifetime, 0));
    let again = serde_json::to_value(&back).unwrap();
    assert!(object.iter().all(|(name, value)| again[name] == *value), "{again}");
}

#[test]
fn variants_are_one_task_if_they_do_not_count() {
    let blocks: [Block<'_>; 3] = [
        (Train, "Find_Red", &[1.0]),
        (Train, "find_blue", &[3.0]),
        (Test, "find_blue", &[2.0]),
    ];
    let tasks = |mode| {
        let metrics = scored(
            &blocks,
            &Options {
                variant_mode: mode,
                ..plain()
            },
        );
        metrics.task_metrics.keys().cloned().collect::<Vec<_>>()
    };
    assert_eq!(tasks(VariantMode::Aware), ["find_red", "find_blue"]);
    assert_eq!(tasks(VariantMode::Agnostic), ["find"]);
}

#[test]
fn experts_are_compared_run_by_run_or_on_average() {
    let log = log_of(&[(Train, "a_1", &[2.0, 4.0]), (Train, "a_1", &[6.0])]);
    let expert = |performances: &[f64]| SteLog::new(log_of(&[(Train, "A_1", performances)])).unwrap();
    let experts = [expert(&[4.0, 8.0, 12.0, 16.0]), expert(&[2.0, 4.0])];
    let with = |method| {
        let options = Options {
            ste_averaging_method: method,
            ..plain()
        };
        score(&log, &experts, &options).unwrap().task_metrics["a_1"].clone()
    };
    // Against three of the first run's four: 12/24; against the two of the second: 6/6.
    let by_run = with(SteAveragingMethod::Metrics);
    assert_eq!(
        (
            by_run.numbers("ste_rel_perf_vals").unwrap(),
            by_run.number("ste_rel_perf")
        ),
        (&[0.5, 1.0][..], Some(0.75))
    );
    // Saturation 6 after 2; the runs' 16 after 3 and 4 after 1: (6/16)·(3/2) and (6/4)·(1/2).
    assert_eq!(
        (by_run.number("se_task_saturation"), by_run.number("se_task_exp_to_sat")),
        (Some(6.0), Some(2.0))
    );
    assert_eq!(by_run.numbers("sample_efficiency_vals").unwrap(), [0.5625, 0.75]);
    // The average of the runs' first two is 3 and 6: 6/9; (6/6)·(1/2).
    let on_average = with(SteAveragingMethod::Time);
    assert_eq!(on_average.number("ste_rel_perf"), Some(6.0 / 9.0));
    assert_eq!(on_average.numbers("sample_efficiency_vals").unwrap(), [0.5]);
    // An expert of a task that the lifetime lacks changes nothing.
    let stranger = SteLog::new(log_of(&[(Train, "z_1", &[1.0, 2.0])])).unwrap();
    assert_eq!(
        score(&log, &[stranger], &plain())
            .unwrap()
            .lifetime
            .number("ste_rel_perf"),
        None
    );
}

#[test]
fn results_are_saved_under_the_references_names() {
    let metrics = scored(&ALTERNATING, &Options::default());
    let base = tempfile::tempdir().unwrap();
    let settings = driftworld_metrics::Settings {
        log_dir: "logs/tiny".to_owned(),
        options: Options::default(),
    };
    let files = metrics.save(base.path().join("results"), "my run", &settings).unwrap();
    let name = |path: &std::path::Path| path.file_name().unwrap().to_string_lossy().into_owned();
    let names: Vec<String> = files.iter().map(|file| name(file)).collect();
    assert_eq!(
        names,
        ["my_run_metrics.json", "my_run_regime.tsv", "my_run_settings.json"]
    );
    let table = std::fs::read_to_string(&files[1]).unwrap();
    assert_eq!(table.lines().count(), 12);
    assert!(!table.contains("task_params"), "no regime differs in its parameters");
    assert_eq!(table, metrics.regime_tsv());
    let settings: driftworld_metrics::Settings = serde_json::from_slice(&std::fs::read(&files[2]).unwrap()).unwrap();
    assert_eq!(settings.options, Options::default());
    let error = metrics.save(base.path(), "../up", &settings).unwrap_err().to_string();
    assert_eq!(
        error,
        "option output name: found \"../up\", expected a file name without / and \\"
    );
}

#[test]
fn given_ranges_replace_those_of_the_data() {
    let range = |min, max| DataRange { min, max };
    let score_with = |mode, ranges: &[(&str, DataRange)], clamp_outliers| {
        let data_range = Some(
            ranges
                .iter()
                .map(|(task, range)| ((*task).to_owned(), *range))
                .collect(),
        );
        let options = Options {
            variant_mode: mode,
            data_range,
            clamp_outliers,
            ..Options::default()
        };
        score(
            &log_of(&[(Train, "a_1", &[5.0]), (Test, "a_2", &[12.0])]),
            &[],
            &options,
        )
    };
    // On the range 0..=10, 5 becomes 51, and 12 becomes 121, or 101 if it is clamped to the range first.
    let both = [("a_1", range(0.0, 10.0)), ("a_2", range(0.0, 10.0))];
    let maximum = |clamped| score_with(VariantMode::Aware, &both, clamped).unwrap().max;
    assert_eq!((maximum(false), maximum(true)), (121.0, 101.0));
    // If variants do not count, the ranges 0..=5 and 5..=20 are merged; on 0..=20, 12 becomes 61.
    let apart = [("a_1", range(0.0, 5.0)), ("a_2", range(5.0, 20.0))];
    assert_eq!(score_with(VariantMode::Agnostic, &apart, false).unwrap().max, 61.0);
    assert_eq!(
        score_with(VariantMode::Aware, &both[..1], false)
            .unwrap_err()
            .to_string(),
        "option data_range: found no range for task a_2, expected one for each of a_1, a_2"
    );
}

#[test]
fn run_is_scaled_as_a_whole_on_request() {
    let blocks: [Block<'_>; 2] = [(Train, "a_1", &[0.0, 5.0]), (Test, "b_1", &[10.0])];
    let options = Options {
        normalization_method: NormalizationMethod::Run,
        ..Options::default()
    };
    let metrics = scored(&blocks, &options);
    assert_eq!(
        (
            metrics.task_metrics["a_1"].number("max").unwrap(),
            metrics.task_metrics["b_1"].number("max").unwrap()
        ),
        (51.0, 101.0)
    );
}
