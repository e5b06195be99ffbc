//! User-defined metrics alongside the crate's own, and definitions other than the reference's.

use driftworld_metrics::{
    Assessment, BlockType, Definitions, Direction, Headline, LifetimeMetrics, Log, LogWriter, LoggerInfo, Metric,
    MetricsError, Noise, NormalizationMethod, Options, Record, ScenarioInfo, Scorer, Timestamp, read_log, score,
};
use serde_json::json;

use BlockType::{Test, Train};

/// Blocks of one task each: type, task, a parameter of the task, and performances.
type Block<'a> = (BlockType, &'a str, u8, &'a [f64]);

fn log_of(blocks: &[Block<'_>]) -> Log {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("life");
    let mut writer = LogWriter::create(&dir, &LoggerInfo::new(["reward"]).unwrap(), &ScenarioInfo::default()).unwrap();
    let mut exp_num = 0;
    for (block_num, (block_type, task, parameter, performances)) in (0..).zip(blocks) {
        for performance in *performances {
            let stamp = Timestamp::from_unix_micros(exp_num as i64).unwrap();
            let params = json!({ "level": parameter }).as_object().unwrap().clone();
            let record = Record::new(block_num / 10, exp_num, *block_type, *task, stamp);
            writer
                .write(&record.with_task_params(params).with_metric("reward", *performance))
                .unwrap();
            exp_num += 1;
        }
    }
    read_log(&dir).unwrap()
}

fn plain() -> Options {
    Options {
        normalization_method: NormalizationMethod::Off,
        ..Options::default()
    }
}

/// The worst evaluation of a task, and the difference of each evaluation from it.
struct WorstEvaluation;

impl Metric for WorstEvaluation {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![Headline::new(
            "worst_eval_perf",
            "how bad did it get?",
            Direction::Higher,
        )]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        for task in assessment.lifetime().tasks() {
            let regimes = || {
                assessment
                    .lifetime()
                    .regimes_of(task)
                    .filter(|regime| regime.block_type == Test)
            };
            let ends =
                regimes().filter_map(|regime| Some((regime.regime_num, assessment.term_perf(regime.regime_num)?)));
            let ends: Vec<(usize, f64)> = ends.collect();
            let worst = ends.iter().map(|(_, end)| *end).reduce(f64::min);
            for (regime_num, end) in ends {
                assessment.set_regime(regime_num, "above_worst", worst.map(|worst| end - worst));
            }
            assessment.set_task(task, "worst_eval_perf", worst);
        }
        Ok(())
    }
}

const LIFE: [Block<'static>; 5] = [
    (Train, "a_1", 0, &[1.0]),
    (Test, "a_1", 0, &[4.0]),
    (Test, "b_1", 0, &[7.0]),
    (Test, "a_1", 1, &[2.0]),
    (Test, "c_1", 0, &[f64::NAN]),
];

#[test]
fn user_metric_appears_beside_the_others_at_every_level() {
    let scorer = Scorer::new().with(WorstEvaluation).unwrap();
    let metrics = scorer.score(&log_of(&LIFE), &[], &plain()).unwrap();
    assert_eq!(
        metrics.lifetime.number("worst_eval_perf"),
        Some(4.5),
        "the mean of 2 and 7"
    );
    assert_eq!(metrics.task_metrics["a_1"].number("worst_eval_perf"), Some(2.0));
    let table = metrics.regime_tsv();
    assert!(
        table.lines().next().unwrap().ends_with("avg_perf\tabove_worst\trun_id"),
        "{table}"
    );
    let row = metrics.summary().pop().unwrap();
    assert_eq!((row.name.as_ref(), row.value), ("worst_eval_perf", Some(4.5)));
    let json = serde_json::to_value(&metrics).unwrap();
    assert_eq!(
        (
            &json["worst_eval_perf"],
            &json["task_metrics"]["b_1"]["worst_eval_perf"]
        ),
        (&json!(4.5), &json!(7.0))
    );
    let back: LifetimeMetrics = serde_json::from_value(json).unwrap();
    assert_eq!(back.lifetime, metrics.lifetime);
}

/// A metric with a given name that fails.
struct Broken(&'static str);

impl Metric for Broken {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![Headline::new(self.0, "", Direction::Lower)]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        Err(MetricsError::Metric {
            metric: self.0.to_owned(),
            run_id: assessment.log().run_id.clone(),
            source: "found no column energy, expected one".into(),
        })
    }
}

#[test]
fn taken_names_are_refused_and_errors_are_passed_on() {
    for name in ["", "avg_eval_perf", "num_lx", "task_metrics"] {
        let error = Scorer::new().with(Broken(name)).err().unwrap().to_string();
        let expected = "a non-empty name that no other metric or field of the results has";
        assert_eq!(
            error,
            format!("option headline of a metric: found {name:?}, expected {expected}")
        );
    }
    let scorer = Scorer::new().with(Broken("energy")).unwrap();
    let error = scorer.score(&log_of(&LIFE), &[], &plain()).unwrap_err().to_string();
    assert_eq!(error, "metric energy, log life: found no column energy, expected one");
}

/// A metric without headlines that sets one value of a given name.
struct Sets(Level, &'static str);

#[derive(Clone, Copy, Debug)]
enum Level {
    Lifetime,
    Task,
    Regime,
}

impl Metric for Sets {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        Vec::new()
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        match self.0 {
            Level::Lifetime => assessment.set_lifetime(self.1, Some(1.0)),
            Level::Task => assessment.set_task("b_1", self.1, Some(1.0)),
            Level::Regime => assessment.set_regime(2, self.1, Some(1.0)),
        }
        Ok(())
    }
}

#[test]
fn values_with_reserved_names_are_refused() {
    let log = log_of(&LIFE);
    let of = |level, name| {
        let scorer = Scorer::new().with(Sets(level, name)).unwrap();
        scorer.score(&log, &[], &plain())
    };
    let written = serde_json::to_value(score(&log, &[], &plain()).unwrap()).unwrap();
    let check = |level, name: &'static str, whose: &str| {
        let error = of(level, name).expect_err(name).to_string();
        let expected = "a name that no field or column of the results has";
        assert_eq!(
            error,
            format!("option value of a metric: found {name:?} of {whose}, expected {expected}")
        );
    };
    for name in "run_id complexity metrics_column min runtime task_metrics".split(' ') {
        assert!(written.get(name).is_some(), "{name} is a field");
        check(Level::Lifetime, name, "the lifetime");
    }
    check(Level::Lifetime, "definitions", "the lifetime");
    for name in ["min", "max", "num_lx", "num_ex"] {
        assert!(written["task_metrics"]["b_1"].get(name).is_some(), "{name} is a field");
        check(Level::Task, name, "task \"b_1\"");
    }
    for name in "block_num block_type task_name regime_num task_params run_id".split(' ') {
        check(Level::Regime, name, "a regime");
    }
    // An empty list in JSON does not show its element type.
    let tasks = |metrics: &LifetimeMetrics| serde_json::to_value(&metrics.task_metrics).unwrap();
    // At a different level, the same name is free.
    for (level, name) in [
        (Level::Lifetime, "block_num"),
        (Level::Task, "run_id"),
        (Level::Regime, "min"),
    ] {
        let metrics = of(level, name).unwrap();
        let json = serde_json::to_string(&metrics).unwrap();
        let back: LifetimeMetrics = serde_json::from_str(&json).unwrap();
        assert_eq!(
            (&back.lifetime, tasks(&back)),
            (&metrics.lifetime, tasks(&metrics)),
            "{level:?}"
        );
    }
}

#[test]
fn one_scorer_scores_many_lifetimes_in_parallel() {
    let scorer = Scorer::new().with(WorstEvaluation).unwrap();
    let logs = [log_of(&LIFE), log_of(&LIFE[..4])];
    let at_once = std::thread::scope(|scope| {
        let threads = logs
            .each_ref()
            .map(|log| scope.spawn(|| scorer.score(log, &[], &plain()).unwrap()));
        threads.map(|thread| thread.join().unwrap())
    });
    assert_eq!(
        at_once,
        logs.each_ref().map(|log| scorer.score(log, &[], &plain()).unwrap())
    );
}

fn by(definitions: Definitions, blocks: &[Block<'_>]) -> LifetimeMetrics {
    let options = Options { definitions, ..plain() };
    score(&log_of(blocks), &[], &options).unwrap()
}

#[test]
fn published_definitions_split_regimes_by_parameters() {
    let blocks: [Block<'_>; 3] = [
        (Train, "a_1", 0, &[1.0]),
        (Test, "a_1", 0, &[4.0]),
        (Test, "a_1", 1, &[2.0]),
    ];
    assert_eq!(by(Definitions::Reference, &blocks).regimes.len(), 2);
    let published = by(Definitions::Published, &blocks);
    assert_eq!(published.regimes.len(), 3);
    assert_eq!(
        published.lifetime.number("perf_maintenance_mrlep"),
        Some(-2.0),
        "the block with other parameters is a second evaluation"
    );
}

#[test]
fn published_definitions_credit_transfer_to_every_task_in_a_gap() {
    let blocks: [Block<'_>; 4] = [
        (Test, "c_1", 0, &[2.0]),
        (Train, "a_1", 0, &[1.0]),
        (Train, "b_1", 0, &[1.0]),
        (Test, "c_1", 1, &[3.0]),
    ];
    let to_c = |definitions| {
        let metrics = by(definitions, &blocks);
        let from = |task: &str| {
            metrics.task_metrics[task]
                .pairs("forward_transfer_ratio")
                .unwrap()
                .get("c_1")
                .cloned()
        };
        (from("a_1"), from("b_1"))
    };
    assert_eq!(
        to_c(Definitions::Reference),
        (None, Some(vec![1.5])),
        "the last pair gets the transfer"
    );
    assert_eq!(to_c(Definitions::Published), (Some(vec![1.5]), Some(vec![1.5])));
}

#[test]
fn files_with_published_definitions_are_labelled_and_not_rounded() {
    let thirds: [Block<'_>; 1] = [(Test, "a_1", 0, &[1.0, 1.0, 2.0])];
    let average = |definitions| {
        let json = serde_json::to_value(by(definitions, &thirds)).unwrap();
        (
            json["avg_eval_perf"].as_f64().unwrap(),
            json.get("definitions").cloned(),
        )
    };
    assert_eq!(average(Definitions::Reference), (1.333_333_333_3, None));
    assert_eq!(average(Definitions::Published), (4.0 / 3.0, Some(json!("published"))));
}

#[test]
fn noise_shifts_performances_and_depends_on_the_seed() {
    let with = |mean, std, seed| {
        let options = Options {
            noise: Some(Noise { mean, std, seed }),
            ..plain()
        };
        let metrics = score(&log_of(&LIFE), &[], &options).unwrap();
        metrics.lifetime.number("avg_train_perf").unwrap()
    };
    assert_eq!(with(10.0, 0.0, 1), 11.0, "not normalised here");
    assert_eq!(with(0.0, 1.0, 1), with(0.0, 1.0, 1));
    assert_ne!(with(0.0, 1.0, 1), with(0.0, 1.0, 2));
    let options = Options {
        noise: Some(Noise {
            mean: 0.0,
            std: -1.0,
            seed: 0,
        }),
        ..plain()
    };
    let error = score(&log_of(&LIFE), &[], &options).unwrap_err().to_string();
    assert_eq!(
        error,
        "option noise: found mean 0e0, standard deviation -1e0, expected two numbers below 1e100 in magnitude, the \
         second not negative"
    );
}
