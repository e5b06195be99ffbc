//! Lifetimes with drifting variants: which drifts count as learning which tasks, and measures that need no task boundaries.

use driftworld_metrics::BlockType::{Test, Train};
use driftworld_metrics::{
    Anchors, BlockType, EvaluationCurve, LifetimeMetrics, Log, LogWriter, LoggerInfo, MaintenanceMethod,
    NormalizationMethod, Options, PairValues, Record, ScaledBy, ScenarioInfo, SteLog, Timestamp, TransferMethod,
    VariantMode, read_log, score,
};
use proptest::prelude::*;

/// A stretch of rows: learning or evaluation, the variant, the variant that it drifts to, and rewards.
#[derive(Debug, Clone)]
struct Stretch {
    block_type: BlockType,
    variant: &'static str,
    to: Option<&'static str>,
    rewards: Vec<f64>,
}

fn evaluation(variant: &'static str, rewards: &[f64]) -> Stretch {
    Stretch {
        block_type: Test,
        variant,
        to: None,
        rewards: rewards.to_vec(),
    }
}

fn learning(variant: &'static str, to: Option<&'static str>, rewards: &[f64]) -> Stretch {
    Stretch {
        block_type: Train,
        variant,
        to,
        rewards: rewards.to_vec(),
    }
}

/// Writes each stretch as a block of the task f, or of another task that its variant names (`g#x`), as Driftworld does;
/// `has_progress` says whether the log has that column.
fn log_of(stretches: &[Stretch], has_progress: bool) -> Log {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("drifting");
    let columns = if has_progress {
        vec!["progress", "reward"]
    } else {
        vec!["reward"]
    };
    let mut writer = LogWriter::create(&dir, &LoggerInfo::new(columns).unwrap(), &ScenarioInfo::default()).unwrap();
    let mut number = 0;
    for (block, stretch) in (0..).zip(stretches) {
        let mut params = serde_json::Map::from_iter([("variant".to_owned(), stretch.variant.into())]);
        params.extend(stretch.to.map(|to| ("to".to_owned(), to.into())));
        let name = match stretch.to {
            Some(to) => format!("f_{}to{}", stretch.variant, to.replace('#', "")),
            None => match stretch.variant.split_once('#') {
                Some((task, variant)) => format!("{task}_{variant}"),
                None => format!("f_{}", stretch.variant),
            },
        };
        for (place, reward) in stretch.rewards.iter().enumerate() {
            let when = Timestamp::from_unix_micros(number as i64).unwrap();
            let mut record = Record::new(block, number, stretch.block_type, &*name, when)
                .with_metric("reward", *reward)
                .with_task_params(params.clone());
            if has_progress {
                let progress = place as f64 / stretch.rewards.len() as f64;
                record = record.with_metric("progress", if stretch.to.is_some() { progress } else { 0.0 });
            }
            writer.write(&record).unwrap();
            number += 1;
        }
    }
    read_log(&dir).unwrap()
}

fn options() -> Options {
    Options {
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    }
}

/// An agent that forgets everything whenever the world drifts: c to a, then a to b.
fn forgetting() -> Vec<Stretch> {
    let evaluate = |a: f64, b: f64, c: f64| {
        [
            evaluation("a", &[a, a]),
            evaluation("b", &[b, b]),
            evaluation("c", &[c, c]),
        ]
    };
    let mut lifetime = evaluate(0.0, 0.0, 0.0).to_vec();
    lifetime.push(learning("c", Some("a"), &[10.0, 20.0, 60.0, 90.0]));
    lifetime.extend(evaluate(90.0, 0.0, 20.0));
    lifetime.push(learning("a", Some("b"), &[90.0, 40.0, 50.0, 90.0]));
    lifetime.extend(evaluate(5.0, 90.0, 0.0));
    lifetime
}

fn pairs(scores: &LifetimeMetrics, task: &str, name: &str) -> PairValues {
    scores.task_metrics[task].pairs(name).cloned().unwrap_or_default()
}

#[test]
fn drift_away_counts_as_forgetting_and_never_as_forward_transfer() {
    for has_progress in [true, false] {
        let plain = Options {
            normalization_method: NormalizationMethod::Off,
            ..options()
        };
        let scores = score(&log_of(&forgetting(), has_progress), &[], &plain).unwrap();
        // The first drift taught a, which then fell from 90 to 5; it also taught c, which fell from 20 to 0.
        let maintenance = |task: &str| scores.task_metrics[task].number("perf_maintenance_mrlep");
        assert_eq!(
            (maintenance("f_a"), maintenance("f_b"), maintenance("f_c")),
            (Some(-85.0), None, Some(-20.0))
        );
        assert_eq!(scores.lifetime.number("perf_maintenance_mrlep"), Some(-52.5));
        let backward = pairs(&scores, "f_b", "backward_transfer_contrast");
        assert_eq!(backward.get("f_a"), Some(&vec![-85.0 / 95.0]));
        assert_eq!(backward.get("f_c"), Some(&vec![-1.0]));
        // Forgetting f_a never counts as forward transfer, and learning it is not transfer at all.
        for (task, values) in &scores.task_metrics {
            for name in ["forward_transfer_contrast", "forward_transfer_ratio"] {
                let to: Vec<&String> = values.pairs(name).unwrap().keys().collect();
                assert!(to.iter().all(|other| *other == "f_b"), "{task} {name}: {to:?}");
            }
        }
        assert!(scores.null_bands["perf_maintenance_mrlep"].value < 0.0);
        // The end of a drift is on the drift's own scale, so nothing is compared with it.
        assert_eq!(scores.lifetime.number("perf_maintenance_mrtlp"), None);
    }
}

#[test]
fn drift_between_tasks_counts_as_learning_both() {
    let evaluate = |a: f64, x: f64| [evaluation("a", &[a, a]), evaluation("g#x", &[x, x])];
    let mut lifetime = evaluate(0.0, 0.0).to_vec();
    lifetime.push(learning("a", Some("g#x"), &[10.0, 20.0, 60.0, 90.0]));
    lifetime.extend(evaluate(30.0, 90.0));
    lifetime.push(learning("a", None, &[50.0, 60.0, 70.0, 80.0]));
    lifetime.extend(evaluate(80.0, 10.0));
    let plain = Options {
        normalization_method: NormalizationMethod::Off,
        ..options()
    };
    let scores = score(&log_of(&lifetime, true), &[], &plain).unwrap();
    let maintenance = |task: &str| scores.task_metrics[task].number("perf_maintenance_mrlep");
    assert_eq!(maintenance("g_x"), Some(-80.0));
    let backward = pairs(&scores, "f_a", "backward_transfer_contrast");
    assert_eq!(backward.get("g_x"), Some(&vec![-80.0 / 100.0]));
}

#[test]
fn drift_is_ignored_if_variants_do_not_count() {
    let agnostic = Options {
        variant_mode: VariantMode::Agnostic,
        ..options()
    };
    let scores = score(&log_of(&forgetting(), true), &[], &agnostic).unwrap();
    assert_eq!(scores.task_metrics.keys().collect::<Vec<_>>(), ["f"]);
}

#[test]
fn drift_between_unevaluated_variants_counts_as_learning_itself() {
    let lifetime = [
        evaluation("b", &[1.0, 1.0]),
        learning("c", Some("a"), &[1.0, 2.0]),
        evaluation("b", &[3.0, 3.0]),
    ];
    let scores = score(&log_of(&lifetime, true), &[], &options()).unwrap();
    assert_eq!(
        pairs(&scores, "f_ctoa", "forward_transfer_contrast")
            .get("f_b")
            .map(Vec::len),
        Some(1)
    );
}

/// Lifetimes of learning blocks, some of them drifts, with evaluations between them.
fn lifetimes() -> impl Strategy<Value = Vec<Stretch>> {
    let variant = || prop::sample::select(vec!["a", "b", "c"]);
    let rewards = || prop::collection::vec(-50.0..100.0_f64, 1..6);
    let learned = (variant(), prop::option::of(variant()), rewards())
        .prop_map(|(variant, to, rewards)| learning(variant, to.filter(|to| *to != variant), &rewards));
    let evaluated = (variant(), rewards()).prop_map(|(variant, rewards)| evaluation(variant, &rewards));
    prop::collection::vec(prop_oneof![1 => learned, 2 => evaluated], 1..14)
}

/// The evaluations of a variant as (number of preceding learning experiences, mean), with distinct positions.
fn points_of(lifetime: &[Stretch], variant: &str) -> Vec<(f64, f64)> {
    let (mut learned, mut found) = (0, Vec::<(f64, Vec<f64>)>::new());
    for stretch in lifetime {
        let mean = stretch.rewards.iter().sum::<f64>() / stretch.rewards.len() as f64;
        match stretch.block_type {
            Train => learned += stretch.rewards.len(),
            Test if stretch.variant != variant => {}
            Test => match found.last_mut() {
                Some((at, means)) if *at == f64::from(learned as u32) => means.push(mean),
                _ => found.push((f64::from(learned as u32), vec![mean])),
            },
        }
    }
    let mean = |means: &[f64]| means.iter().sum::<f64>() / means.len() as f64;
    found.into_iter().map(|(at, means)| (at, mean(&means))).collect()
}

/// Height of a curve, found by checking every pair of neighbours.
fn height(points: &[(f64, f64)], at: f64) -> f64 {
    for pair in points.windows(2) {
        if pair[0].0 <= at && at <= pair[1].0 {
            let share = (at - pair[0].0) / (pair[1].0 - pair[0].0);
            return (1.0 - share) * pair[0].1 + share * pair[1].1;
        }
    }
    if at < points[0].0 {
        points[0].1
    } else {
        points[points.len() - 1].1
    }
}

/// The variant that is learned in each learning experience; in a drift, the nearer one.
fn learned_variants(lifetime: &[Stretch]) -> Vec<&'static str> {
    let learned = lifetime.iter().filter(|stretch| stretch.block_type == Train);
    let rows = learned.flat_map(|stretch| {
        let num = stretch.rewards.len();
        (0..num).map(move |place| match stretch.to {
            Some(to) if 2 * place >= num => to,
            _ => stretch.variant,
        })
    });
    rows.collect()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1.0)
}

fn check_curve(lifetime: &[Stretch], variant: &'static str, curve: &EvaluationCurve, expert: f64) {
    let points = points_of(lifetime, variant);
    let heights: Vec<f64> = points.iter().map(|point| point.1).collect();
    let (low, high) = (
        heights.iter().copied().fold(f64::INFINITY, f64::min),
        heights.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    );
    assert_eq!(curve.points.len(), points.len());
    // The area as the mean height of thin columns, which is exact for straight lines.
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    let columns = ((last - first) * 4.0) as u32;
    let middles = (0..columns).map(|column| height(&points, first + (f64::from(column) + 0.5) / 4.0));
    let area = if columns == 0 {
        points[0].1
    } else {
        middles.sum::<f64>() / f64::from(columns)
    };
    assert!(close(curve.area, area), "{} {area}", curve.area);
    assert!(low - 1e-9 <= curve.area && curve.area <= high + 1e-9);
    // Forgetting is the largest difference from the last height.
    let losses = heights.iter().map(|height| height - heights[heights.len() - 1]);
    assert!(close(curve.forgetting, losses.fold(0.0, f64::max)));
    assert!(curve.forgetting >= 0.0);
    if heights.is_sorted() {
        assert_eq!(curve.forgetting, 0.0);
    }
    // Regret is summed experience by experience.
    let rows = learned_variants(lifetime);
    let regrets: Vec<f64> = (0..rows.len())
        .filter(|row| rows[*row] == variant)
        .map(|row| expert - height(&points, row as f64 + 0.5))
        .collect();
    assert_eq!(curve.num_present, regrets.len());
    match curve.regret {
        Some(found) => assert!(close(found, regrets.iter().sum::<f64>() / regrets.len() as f64)),
        None => assert!(regrets.is_empty()),
    }
    if let Some(lag) = curve.lag {
        assert!(0.0 <= lag && lag <= learned_variants(lifetime).len() as f64, "{lag}");
    }
}

fn with_experts(lifetime: &[Stretch], expert: f64) -> LifetimeMetrics {
    let of = |variant| SteLog::new(log_of(&[learning(variant, None, &[expert; 3])], true)).unwrap();
    let experts = ["a", "b", "c"].map(of);
    let plain = Options {
        normalization_method: NormalizationMethod::Off,
        ..options()
    };
    score(&log_of(lifetime, true), &experts, &plain).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 60)))]

    #[test]
    fn curves_match_their_definitions(lifetime in lifetimes(), expert in -20.0..120.0_f64) {
        let scores = with_experts(&lifetime, expert);
        for variant in ["a", "b", "c"] {
            match scores.curves.get(&format!("f_{variant}")) {
                Some(curve) => check_curve(&lifetime, variant, curve, expert),
                None => prop_assert!(points_of(&lifetime, variant).is_empty()),
            }
        }
    }

    /// A curve does not depend on other tasks: without their evaluations, it is the same.
    #[test]
    fn curve_depends_on_its_own_task_alone(lifetime in lifetimes(), expert in -20.0..120.0_f64) {
        let all = with_experts(&lifetime, expert);
        let only: Vec<Stretch> = (lifetime.iter())
            .filter(|stretch| stretch.block_type == Train || stretch.variant == "a")
            .cloned()
            .collect();
        prop_assume!(!only.is_empty());
        let alone = with_experts(&only, expert);
        prop_assert_eq!(all.curves.get("f_a"), alone.curves.get("f_a"));
    }

    /// Scaling by floor and ceiling is a change of units.
    #[test]
    fn scaled_curves_are_unscaled_curves_in_other_units(lifetime in lifetimes(), floor in -60.0..40.0_f64, width in 10.0..200.0_f64) {
        let plain = with_experts(&lifetime, floor + width);
        let anchors = Anchors { floor, ceiling: floor + width, unlabelled: Vec::new() };
        let scaled = Options {
            scales: Some([("f_a".to_owned(), anchors)].into()),
            ..options()
        };
        let scaled = score(&log_of(&lifetime, true), &[], &scaled).unwrap();
        let reached = scaled.reached.get("f_a").map(|reached| reached.scaled_by);
        prop_assert!(reached.is_none_or(|by| by == ScaledBy::Anchors));
        if let (Some(a), Some(b)) = (plain.curves.get("f_a"), scaled.curves.get("f_a")) {
            prop_assert!(b.is_scaled && !a.is_scaled);
            prop_assert!(close(b.area, (a.area - floor) / width), "{} {}", a.area, b.area);
            prop_assert!(close(b.forgetting, a.forgetting / width));
            // The expert is at the ceiling in both.
            prop_assert_eq!(a.regret.is_some(), b.regret.is_some());
            if let (Some(a), Some(b)) = (a.regret, b.regret) {
                prop_assert!(close(b, a / width));
            }
            prop_assert_eq!(a.lag.is_some(), b.lag.is_some());
            if let (Some(a), Some(b)) = (a.lag, b.lag) {
                prop_assert!((a - b).abs() < 1e-6, "{} {}", a, b);
            }
        }
    }
}

#[test]
fn lag_is_the_time_to_half_of_the_gain() {
    let lifetime = [
        evaluation("a", &[10.0]),
        learning("b", None, &[0.0; 5]),
        evaluation("a", &[20.0]),
        learning("a", None, &[0.0; 10]),
        evaluation("a", &[40.0]),
        learning("a", None, &[0.0; 10]),
        evaluation("a", &[100.0]),
    ];
    // Learning begins after 5 experiences, at 20. Half-way to 100 is 60, which is a third of the way from 40 to 100.
    let scores = with_experts(&lifetime, 100.0);
    let lag = scores.curves["f_a"].lag.unwrap();
    assert!((lag - (10.0 + 10.0 / 3.0)).abs() < 1e-9, "{lag}");
    // A curve that does not rise has no lag.
    let level = [
        evaluation("a", &[5.0]),
        learning("a", None, &[0.0; 4]),
        evaluation("a", &[5.0]),
    ];
    assert_eq!(with_experts(&level, 100.0).curves["f_a"].lag, None);
}

#[test]
fn evaluations_after_each_learning_block_show_lost_plasticity() {
    let lifetime = [
        learning("a", None, &[0.0; 4]),
        evaluation("a", &[80.0]),
        learning("b", None, &[0.0; 4]),
        evaluation("a", &[50.0]),
        learning("a", None, &[0.0; 4]),
        evaluation("a", &[30.0]),
    ];
    let scores = with_experts(&lifetime, 100.0);
    let a = &scores.reached["f_a"];
    assert_eq!(a.shares, [0.8, 0.3]);
    assert!((a.plasticity_loss().unwrap() - 0.5).abs() < 1e-12);
    assert_eq!(scores.reached["f_b"].plasticity_loss(), None);
}
