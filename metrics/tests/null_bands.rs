//! Null bands: values of agents that never change lie inside, and values of agents that forget lie outside; one band is checked
//! against all permutations.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use driftworld_metrics::BlockType::{Test, Train};
use driftworld_metrics::{
    BlockType, BootstrapOptions, Direction, Exchanged, LifetimeMetrics, Log, MaintenanceMethod, NullBand, Options,
    Reading, RepeatedMetric, SteLog, Timestamp, TransferMethod, over_repeats, read_log, score,
};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// One row: block, its type, task, number of the world, reward.
type LifetimeRow = (u64, BlockType, &'static str, f64, f64);

const TASKS: [&str; 3] = ["find_red", "find_blue", "find_green"];

/// Writes the log by hand: a writer that checks and flushes each row takes longer than scoring.
fn log_of(rows: &[LifetimeRow]) -> Log {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("life");
    let folder = dir.join("worker/0-train");
    fs::create_dir_all(&folder).unwrap();
    let info = r#"{"metrics_columns": ["reward", "world_index"], "log_format_version": "1.1"}"#;
    fs::write(dir.join("logger_info.json"), info).unwrap();
    fs::write(dir.join("scenario_info.json"), "{}").unwrap();
    let mut text =
        "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\t\
                    reward\tworld_index\n"
            .to_owned();
    for (number, (block, block_type, task, world, reward)) in (0_i64..).zip(rows) {
        let seed = if *block_type == Train { 1 } else { 2 };
        let stamp = Timestamp::from_unix_micros(number).unwrap();
        let params = format!("{{\"\"seed\"\": {seed}}}");
        let world = if world.is_nan() {
            "nan".to_owned()
        } else {
            world.to_string()
        };
        writeln!(
            text,
            "{block}\t{number}\tworker\t{block_type}\twake\t{task}\t\"{params}\"\tcomplete\t{stamp}\t{reward:?}\t{world}"
        )
        .unwrap();
    }
    fs::write(folder.join("data-log.tsv"), text).unwrap();
    read_log(&dir).unwrap()
}

/// Every task is evaluated before the first learning block and after each, always in the same worlds. `reward` gets the number
/// of learned tasks, the block type, and the numbers of the task and the world.
fn lifetime(worlds: u32, mut reward: impl FnMut(usize, BlockType, usize, u32) -> f64) -> Vec<LifetimeRow> {
    let mut rows = Vec::new();
    for learned in 0..=TASKS.len() {
        let block = 2 * learned as u64;
        for (number, task) in TASKS.into_iter().enumerate() {
            for world in 0..worlds {
                let earned = reward(learned, Test, number, world);
                rows.push((block, Test, task, f64::from(world), earned));
            }
        }
        if let Some(task) = TASKS.get(learned) {
            for world in 0..worlds {
                let earned = reward(learned, Train, learned, world);
                rows.push((block + 1, Train, *task, f64::from(world), earned));
            }
        }
    }
    rows
}

fn options() -> Options {
    Options {
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    }
}

fn scored(rows: &[LifetimeRow]) -> LifetimeMetrics {
    score(&log_of(rows), &[], &options()).unwrap()
}

/// The metrics that have a band, with the good direction.
fn directions() -> Vec<(&'static str, Direction)> {
    let (points, ratio) = (Direction::HigherThan(0.0), Direction::HigherThan(1.0));
    vec![
        ("perf_maintenance_mrlep", points),
        ("perf_maintenance_mrtlp", points),
        ("forward_transfer_contrast", points),
        ("backward_transfer_contrast", points),
        ("forward_transfer_ratio", ratio),
        ("backward_transfer_ratio", ratio),
    ]
}

/// A reward like that of a random agent: near the floor, with occasional lucky touches, in some worlds more often than in
/// others.
fn by_luck(rng: &mut ChaCha8Rng, world: u32) -> f64 {
    let luck = 0.1 + 0.05 * f64::from(world % 5);
    let touched = rng.random_range(0.0..1.0) < luck;
    let touch = if touched { rng.random_range(30.0..130.0) } else { 0.0 };
    touch - 20.0 + rng.random_range(0.0..5.0)
}

/// Lifetimes of an agent that never changes, with 20 worlds or fewer per evaluation.
fn random_lifetimes(num: u64, shown: fn(LifetimeRow) -> LifetimeRow) -> Vec<LifetimeMetrics> {
    let lifetimes = 0..num;
    let of_seed = |seed: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let rows = lifetime(10 + 5 * (seed % 3) as u32, |_, _, _, world| by_luck(&mut rng, world));
        scored(&rows.into_iter().map(shown).collect::<Vec<_>>())
    };
    lifetimes.map(of_seed).collect()
}

fn check_calibration(lifetimes: &[LifetimeMetrics], exchanged: Exchanged) {
    for (name, good) in directions() {
        let bands = lifetimes.iter().map(|scores| scores.null_bands[name]);
        let (mut inside, mut called_good, mut called_bad) = (0, 0, 0);
        for band in bands {
            assert_eq!(band.exchanged, exchanged);
            assert!(0.0 < band.p && band.p <= 1.0, "{band:?}");
            inside += usize::from(!band.is_outside());
            called_good += usize::from(band.reading(good) == Reading::Good);
            called_bad += usize::from(band.reading(good) == Reading::Bad);
        }
        let num_readings = |reading| lifetimes.iter().filter(|life| life.readings[name] == reading).count();
        let (num_good_readings, num_bad_readings) = (num_readings(Reading::Good), num_readings(Reading::Bad));
        // The reading also depends on the parts.
        assert!(
            num_good_readings <= called_good && num_bad_readings <= called_bad,
            "{name}: {num_good_readings}, {num_bad_readings}"
        );
        let counts = format!(
            "{name}: {inside} inside, {called_good} good, {called_bad} bad of {}",
            lifetimes.len()
        );
        assert!(inside * 100 >= lifetimes.len() * 93, "{counts}");
        // 5 of 100, plus two standard errors.
        assert!(called_good * 100 <= lifetimes.len() * 8, "{counts}");
        assert!(called_bad * 100 <= lifetimes.len() * 8, "{counts}");
    }
}

/// Aggregates over groups of lifetimes.
fn aggregate_groups(lifetimes: &[LifetimeMetrics], size: usize) -> Vec<Vec<RepeatedMetric>> {
    let options = BootstrapOptions {
        resamples: 40,
        ..BootstrapOptions::default()
    };
    let groups = lifetimes.chunks(size);
    groups.map(|group| over_repeats(group, &options).unwrap()).collect()
}

#[test]
fn several_lifetimes_of_an_unchanging_agent_are_rarely_called_good() {
    // 2.5 of 100 are expected to be called good; six of 50, or five of 20, occur with a probability below 1 in 1,000.
    let (number, limit) = crate::tier::quick_or_full((20, 5), (50, 6));
    let groups = aggregate_groups(&random_lifetimes(5 * number, |row| row), 5);
    for (name, good) in directions() {
        let bands: Vec<NullBand> = (groups.iter())
            .filter_map(|group| group.iter().find(|row| row.headline.name == name)?.null)
            .collect();
        assert_eq!(bands.len(), groups.len());
        let count = |reading: Reading| bands.iter().filter(|band| band.reading(good) == reading).count();
        let counts = format!(
            "{name}: {} good, {} bad of {number}",
            count(Reading::Good),
            count(Reading::Bad)
        );
        assert!(count(Reading::Good) < limit && count(Reading::Bad) < limit, "{counts}");
    }
}

#[test]
fn copies_of_a_lifetime_have_the_band_of_one() {
    let one = random_lifetimes(1, |row| row).remove(0);
    let several = [one.clone(), one.clone(), one.clone()];
    for (name, _) in directions() {
        let (own, found) = (one.null_bands[name], NullBand::over_lifetimes(name, &several).unwrap());
        for (own, found) in [(own.value, found.value), (own.low, found.low), (own.high, found.high)] {
            assert!((own - found).abs() < 1e-9, "{name} {own} {found}");
        }
        assert_eq!(own.p, found.p, "{name}");
    }
}

#[test]
fn several_lifetimes_show_what_one_leaves_unclear() {
    // Learning is lost gradually, hidden by noise.
    let lifetimes: Vec<LifetimeMetrics> = (0..12_u64)
        .map(|seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let rows = lifetime(15, |learned, kind, number, world| {
                let kept = if learned > number {
                    20.0 - 6.0 * (learned - number) as f64
                } else {
                    0.0
                };
                by_luck(&mut rng, world) + if kind == Test { kept } else { 0.0 }
            });
            scored(&rows)
        })
        .collect();
    let good = Direction::HigherThan(0.0);
    let name = "perf_maintenance_mrlep";
    let readings = lifetimes.iter().map(|life| life.null_bands[name].reading(good));
    assert!(readings.filter(|reading| *reading == Reading::Bad).count() < 8);
    let found = NullBand::over_lifetimes(name, &lifetimes).unwrap();
    assert_eq!(found.reading(good), Reading::Bad, "{found:?}");
    assert_eq!(NullBand::over_lifetimes("avg_eval_perf", &lifetimes), None);
}

#[test]
fn unchanging_agent_is_called_good_in_at_most_one_of_twenty_lifetimes() {
    let lifetimes = random_lifetimes(crate::tier::quick_or_full(100, 200), |row| row);
    check_calibration(&lifetimes, Exchanged::Worlds);
    // The purpose of bands: without them, most of these lifetimes show "transfer".
    let is_above = |scores: &&LifetimeMetrics| scores.lifetime.number("forward_transfer_ratio").unwrap() > 1.0;
    let above = lifetimes.iter().filter(is_above).count();
    let all = lifetimes.len();
    assert!(
        100 * above > 55 * all,
        "forward ratio above 1 in {above} of {all} lifetimes"
    );
}

#[test]
fn rows_without_worlds_are_permuted_by_position() {
    let lifetimes = random_lifetimes(60, |(block, block_type, task, _, reward)| {
        (block, block_type, task, f64::NAN, reward)
    });
    check_calibration(&lifetimes, Exchanged::Positions);
}

#[test]
fn band_of_constant_rewards_is_the_value() {
    let scores = scored(&lifetime(8, |_, _, task, world| f64::from(world * 7 % 5) + task as f64));
    for (name, good) in directions() {
        let band = scores.null_bands[name];
        assert_eq!((band.low, band.high, band.p), (band.value, band.value, 1.0), "{name}");
        assert_eq!(band.reading(good), Reading::Unclear, "{name}");
    }
    assert_eq!(scores.null_bands["perf_maintenance_mrlep"].value, 0.0);
    assert_eq!(scores.null_bands["forward_transfer_ratio"].value, 1.0);
}

/// Learns each task, and forgets it when learning the next.
fn forgetting(rng: &mut ChaCha8Rng) -> Vec<LifetimeRow> {
    lifetime(20, |learned, block_type, task, _| {
        let knows = if block_type == Train {
            task
        } else {
            learned.wrapping_sub(1)
        };
        let level = if knows == task { 80.0 } else { 10.0 };
        level + rng.random_range(-8.0..8.0)
    })
}

#[test]
fn forgetting_agent_lies_outside_the_bands() {
    let scores = scored(&forgetting(&mut ChaCha8Rng::seed_from_u64(1)));
    for name in [
        "perf_maintenance_mrlep",
        "perf_maintenance_mrtlp",
        "backward_transfer_contrast",
    ] {
        let band = scores.null_bands[name];
        assert_eq!(
            band.reading(Direction::HigherThan(0.0)),
            Reading::Bad,
            "{name}: {band:?}"
        );
        assert!(band.p < 0.01, "{name}: {band:?}");
    }
    let ratio = scores.null_bands["backward_transfer_ratio"];
    assert_eq!(ratio.reading(Direction::HigherThan(1.0)), Reading::Bad, "{ratio:?}");
}

#[test]
fn agent_that_learns_all_tasks_at_once_is_called_good() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let scores = scored(&lifetime(20, |learned, _, _, _| {
        20.0 * learned as f64 + rng.random_range(0.0..10.0)
    }));
    for (name, good) in directions() {
        if name != "perf_maintenance_mrtlp" {
            let band = scores.null_bands[name];
            assert_eq!(band.reading(good), Reading::Good, "{name}: {band:?}");
        }
    }
}

#[test]
fn each_band_holds_the_lifetimes_value_and_contrast_comes_first() {
    let rows = forgetting(&mut ChaCha8Rng::seed_from_u64(3));
    let scores = scored(&rows);
    assert_eq!(scores.null_bands.len(), directions().len());
    for (name, _) in directions() {
        let (found, expected) = (scores.null_bands[name].value, scores.lifetime.number(name).unwrap());
        assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{name}");
    }
    // Only ratios were requested; the contrasts still come before them, but are not in any file.
    let scores = score(&log_of(&rows), &[], &Options::default()).unwrap();
    let names: Vec<String> = scores.summary().into_iter().map(|row| row.name.into_owned()).collect();
    let place = |name: &str| names.iter().position(|found| found == name).unwrap();
    assert!(
        place("forward_transfer_contrast") < place("forward_transfer_ratio"),
        "{names:?}"
    );
    assert!(
        place("backward_transfer_contrast") < place("forward_transfer_ratio"),
        "{names:?}"
    );
    let json = serde_json::to_value(&scores).unwrap();
    for ours in ["readings", "null", "contrasts", "reached", "forward_transfer_contrast"] {
        assert_eq!(json.get(ours), None, "{ours}");
    }
    // These have no band, because they depend on learning.
    let band = |name: &str| {
        scores
            .summary()
            .into_iter()
            .find(|row| row.name == name)
            .unwrap()
            .null_band
    };
    assert_eq!(band("avg_train_perf"), None);
    assert_eq!(band("perf_recovery"), None);
}

#[test]
fn shown_contrast_has_pairs_and_round_trips() {
    for seed in 0..6 {
        let rows = forgetting(&mut ChaCha8Rng::seed_from_u64(seed));
        for (method, smooth) in [
            (TransferMethod::Ratio, false),
            (TransferMethod::Ratio, true),
            (TransferMethod::Both, false),
        ] {
            let options = Options {
                transfer_method: method,
                smooth_eval_data: smooth,
                ..Options::default()
            };
            let scores = score(&log_of(&rows), &[], &options).unwrap();
            let shown = scores.summary().into_iter().filter(|row| row.name.contains("transfer"));
            for row in shown {
                let (Some(value), parts) = (row.value, scores.parts(&row.name)) else {
                    panic!("{} has no value", row.name);
                };
                let mean = parts.iter().map(|part| part.value).sum::<f64>() / parts.len() as f64;
                assert!((mean - value).abs() < 1e-9, "{}: {value}, {parts:?}", row.name);
            }
            let json = serde_json::to_string(&scores.whole()).unwrap();
            let back: LifetimeMetrics = serde_json::from_str(&json).unwrap();
            let rows = |scores: &LifetimeMetrics| -> Vec<_> {
                let rows = scores.summary().into_iter().filter(|row| row.value.is_some());
                rows.map(|row| (row.name, row.reading, row.word)).collect()
            };
            assert_eq!(rows(&back), rows(&scores));
            assert_eq!(
                back.parts("forward_transfer_contrast"),
                scores.parts("forward_transfer_contrast")
            );
        }
    }
}

#[test]
fn transfer_from_negative_performances_has_no_reading() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let rows: Vec<LifetimeRow> = forgetting(&mut rng)
        .into_iter()
        .map(|(block, kind, task, world, reward)| (block, kind, task, world, reward - 50.0))
        .collect();
    let unscaled = Options {
        normalization_method: driftworld_metrics::NormalizationMethod::Off,
        ..Options::default()
    };
    let scores = score(&log_of(&rows), &[], &unscaled).unwrap();
    for name in ["forward_transfer_contrast", "backward_transfer_ratio"] {
        assert_eq!(scores.readings[name], Reading::Undefined, "{name}");
    }
    assert_eq!(scores.readings["perf_maintenance_mrlep"], Reading::Bad);
    assert_eq!(scores.notes.len(), 1);
}

#[test]
fn smoothed_evaluations_have_no_bands() {
    let rows = forgetting(&mut ChaCha8Rng::seed_from_u64(4));
    let options = Options {
        smooth_eval_data: true,
        ..options()
    };
    assert!(score(&log_of(&rows), &[], &options).unwrap().null_bands.is_empty());
}

/// Rewards of one task in three evaluations of four worlds; it is learned after the first.
const EVALUATIONS: [[f64; 4]; 3] = [[3.0, 0.0, 10.0, 4.0], [9.0, 7.0, 2.0, 8.0], [1.0, 6.0, 5.0, 0.5]];

/// All orders of three.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

#[test]
fn all_permutations_of_a_small_lifetime_give_the_band() {
    let mut rows = Vec::new();
    for (number, evaluation) in EVALUATIONS.iter().enumerate() {
        let block = 2 * number as u64;
        for (world, reward) in evaluation.iter().enumerate() {
            rows.push((block, Test, "find_red", world as f64, *reward));
        }
        if number == 0 {
            rows.push((1, Train, "find_red", 0.0, 5.0));
        }
    }
    let band = scored(&rows).null_bands["perf_maintenance_mrlep"];
    // Normalisation maps 0..10 to 1..101, which is a factor of ten. Maintenance is the last evaluation minus the one right after
    // learning.
    let maintenance = |orders: [[usize; 3]; 4]| {
        let mean = |evaluation: usize| {
            let earned = (0..4).map(|world| EVALUATIONS[orders[world][evaluation]][world]);
            earned.sum::<f64>() / 4.0
        };
        10.0 * (mean(2) - mean(1))
    };
    let mut all = Vec::new();
    for a in ORDERS {
        for b in ORDERS {
            for c in ORDERS {
                all.extend(ORDERS.map(|d| maintenance([a, b, c, d])));
            }
        }
    }
    assert_eq!(all.len(), 6 * 6 * 6 * 6);
    let value = maintenance([ORDERS[0]; 4]);
    assert!((band.value - value).abs() < 1e-9, "{band:?} {value}");
    let share = |is: &dyn Fn(f64) -> bool| all.iter().filter(|drawn| is(**drawn)).count() as f64 / all.len() as f64;
    let extreme = share(&|drawn| drawn <= value + 1e-9).min(share(&|drawn| drawn >= value - 1e-9));
    // Four standard errors of twice a share that is estimated from a thousand draws.
    let error = 8.0 * (extreme * (1.0 - extreme) / 1000.0).sqrt() + 0.004;
    assert!((band.p - 2.0 * extreme).abs() < error, "{band:?} {extreme}");
    // About 2.5 % of all permutations lie beyond each end; fewer than 5 % must lie beyond it, and more than 1 % at or beyond it.
    for beyond in [
        share(&|drawn| drawn < band.low - 1e-9),
        share(&|drawn| drawn > band.high + 1e-9),
    ] {
        assert!(beyond < 0.05, "{beyond} {band:?}");
    }
    for outside in [
        share(&|drawn| drawn <= band.low + 1e-9),
        share(&|drawn| drawn >= band.high - 1e-9),
    ] {
        assert!(outside > 0.01, "{outside} {band:?}");
    }
}

/// An expert's log; the expert learns one task at one level, and is evaluated at another, if at all.
fn expert(task: &'static str, learning: f64, evaluation: Option<f64>) -> SteLog {
    let mut rows: Vec<LifetimeRow> = (0..10)
        .map(|world| (0, Train, task, f64::from(world), learning))
        .collect();
    rows.extend((0..4).filter_map(|world| Some((1, Test, task, f64::from(world), evaluation?))));
    SteLog::new(log_of(&rows)).unwrap()
}

#[test]
fn task_below_a_fifth_of_the_expert_counts_as_never_learned() {
    // The second task is never learned; the first is learned and then forgotten.
    let rows = lifetime(4, |learned, block_type, task, world| {
        match (task, block_type, learned) {
            (0, Test, 1) => 60.0 + 10.0 * f64::from(world),
            (1, ..) => -6.0,
            (_, Train, _) => 30.0,
            _ => 4.0,
        }
    });
    let experts = [
        expert("find_red", 10.0, Some(100.0)),
        expert("find_blue", 284.0, None),
        expert("find_green", -5.0, None),
    ];
    let scores = score(&log_of(&rows), &experts, &Options::default()).unwrap();
    let reached: BTreeMap<&str, _> = scores
        .reached
        .iter()
        .map(|(task, found)| (task.as_str(), found))
        .collect();
    let red = reached["find_red"];
    assert_eq!(red.evaluations.len(), 4);
    // The variance of 60, 70, 80, 90 is 500 / 3.
    let best = red.best().unwrap();
    assert_eq!((best.block, best.mean, best.num_worlds), (2, 75.0, 4));
    assert!((best.standard_error.unwrap() - (500.0_f64 / 12.0).sqrt()).abs() < 1e-12);
    assert_eq!(
        (red.last().unwrap().mean, red.last().unwrap().standard_error),
        (4.0, Some(0.0))
    );
    assert_eq!(
        (red.expert, red.share, red.is_never_learned()),
        (Some(100.0), Some(0.75), Some(false))
    );
    let blue = reached["find_blue"];
    assert_eq!((blue.expert, blue.is_never_learned()), (Some(284.0), Some(true)));
    // No share can be computed from an expert at or below 0.
    assert_eq!(
        (reached["find_green"].share, reached["find_green"].is_never_learned()),
        (None, None)
    );
}
