//! Permutes those evaluations of a lifetime that would be exchangeable if the agent never changed.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::lifetime::{Lifetime, Regime, World, mean_per_experience, worlds};
use crate::results::Exchanged;
use crate::statistics::mean;
use crate::{BlockType, Log};

/// The evaluations of a lifetime that count, with their rows concatenated.
pub(super) struct Evaluations<'a> {
    regimes: Vec<(&'a Regime, Range<usize>)>,
    /// Whether every experience of an evaluation is one row.
    is_one_row_each: Vec<bool>,
    /// Performance of each row.
    performance: Vec<f64>,
    /// Rows that are permuted in the same way.
    bundles: Vec<Bundle>,
    pub(super) exchanged: Exchanged,
}

/// Lists of rows, each of one task in one world or at one position, all of equal length: one permutation applies to all.
type Bundle = Vec<Vec<usize>>;

/// The unit of permutation: the scored task with the world, or with the position in the evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Unit {
    World(World),
    Position(usize),
}

impl<'a> Evaluations<'a> {
    /// Collects the evaluations of a lifetime, which must have been prepared from this log.
    pub(super) fn of(log: &Log, lifetime: &'a Lifetime) -> Self {
        let worlds = worlds(log, lifetime.regimes());
        let is_counted = |regime: &&Regime| regime.block_type == BlockType::Test && lifetime.is_assessed(regime);
        let assessed: Vec<&Regime> = lifetime.regimes().iter().filter(is_counted).collect();
        let mut regimes = Vec::new();
        let mut performance = Vec::new();
        for regime in assessed {
            let first = performance.len();
            performance.extend_from_slice(&regime.performance);
            regimes.push((regime, first..performance.len()));
        }
        let groups = groups(&regimes, &worlds);
        let by_world = |(_, unit): &(&str, Unit)| matches!(unit, Unit::World(_));
        let exchanged = match (groups.keys().any(by_world), groups.keys().all(by_world)) {
            (true, true) => Exchanged::Worlds,
            (true, false) => Exchanged::WorldsAndPositions,
            (false, _) => Exchanged::Positions,
        };
        Self {
            bundles: bundles(groups, &regimes),
            is_one_row_each: (regimes.iter())
                .map(|(regime, _)| regime.exp_nums.is_sorted_by(|a, b| a < b))
                .collect(),
            regimes,
            performance,
            exchanged,
        }
    }

    /// Permutes the rows of each world, or of each position, among their evaluations.
    pub(super) fn permute(&mut self, rng: &mut ChaCha8Rng) {
        for bundle in &self.bundles {
            let num = bundle.first().map_or(0, Vec::len);
            for last in (1..num).rev() {
                // The number of rows is far below the range of a u32.
                let other = rng.random_range(0..=last as u32) as usize;
                for rows in bundle {
                    self.performance.swap(rows[last], rows[other]);
                }
            }
        }
    }

    /// Sets the terminal performance of each evaluation by its regime number.
    pub(super) fn set_term_perfs(&self, term_perfs: &mut [f64]) {
        for ((regime, rows), is_one_row_each) in self.regimes.iter().zip(&self.is_one_row_each) {
            let performance = &self.performance[rows.clone()];
            let found = if *is_one_row_each {
                mean(performance)
            } else {
                mean(&mean_per_experience(&regime.exp_nums, performance))
            };
            term_perfs[regime.regime_num] = found.unwrap_or(0.0);
        }
    }
}

/// The rows of each scored task by world; rows of a world in which the task is evaluated only once, or of an unknown world, by
/// their position among such rows of their evaluation.
fn groups<'a>(
    regimes: &[(&'a Regime, Range<usize>)],
    worlds: &[Vec<Option<World>>],
) -> BTreeMap<(&'a str, Unit), Vec<usize>> {
    let mut regimes_of: HashMap<(&str, World), (usize, bool)> = HashMap::new();
    for (number, (regime, _)) in regimes.iter().enumerate() {
        for world in worlds[regime.regime_num].iter().flatten() {
            let (first, recurs) = regimes_of.entry((&regime.task_name, *world)).or_insert((number, false));
            *recurs |= *first != number;
        }
    }
    let mut groups: BTreeMap<(&str, Unit), Vec<usize>> = BTreeMap::new();
    for (regime, rows) in regimes {
        let task = regime.task_name.as_str();
        let mut position = 0;
        for (row, world) in rows.clone().zip(&worlds[regime.regime_num]) {
            let recurring = world.filter(|world| regimes_of.get(&(task, *world)).is_some_and(|(_, recurs)| *recurs));
            let unit = recurring.map_or(Unit::Position(position), Unit::World);
            position += usize::from(recurring.is_none());
            groups.entry((task, unit)).or_default().push(row);
        }
    }
    groups
}

/// Bundles groups of one world, or of one position, that lie in the same blocks: an agent's luck in a world may be the same for
/// several tasks, so these must move together.
fn bundles(groups: BTreeMap<(&str, Unit), Vec<usize>>, regimes: &[(&Regime, Range<usize>)]) -> Vec<Bundle> {
    let mut blocks = Vec::new();
    for (regime, rows) in regimes {
        blocks.extend(std::iter::repeat_n(regime.block_num, rows.len()));
    }
    let mut bundles: BTreeMap<(Unit, Vec<u64>), Bundle> = BTreeMap::new();
    for ((_, unit), rows) in groups {
        let shared = match unit {
            Unit::World(world) => Unit::World(World { task: 0, ..world }),
            Unit::Position(_) => unit,
        };
        let of_rows: Vec<u64> = rows.iter().map(|row| blocks[*row]).collect();
        if rows.len() > 1 {
            bundles.entry((shared, of_rows)).or_default().push(rows);
        }
    }
    bundles.into_values().collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;
    use rand_chacha::rand_core::SeedableRng;

    use super::*;
    use crate::{LogWriter, LoggerInfo, NormalizationMethod, Options, Record, ScenarioInfo, Timestamp, read_log};

    /// A block of one task: whether it is a learning block, and the world and reward of each row.
    type Block = (bool, &'static str, Vec<(Option<u8>, f64)>);

    fn blocks() -> impl Strategy<Value = Vec<Block>> {
        let world = prop_oneof![4 => (0_u8..4).prop_map(Some), 1 => Just(None)];
        let rows = prop::collection::vec((world, -100.0..100.0), 1..8);
        let block = (
            prop::bool::weighted(0.3),
            prop::sample::select(vec!["a_1", "b_1"]),
            rows,
        );
        prop::collection::vec(block, 1..9)
    }

    fn options() -> Options {
        Options {
            normalization_method: NormalizationMethod::Off,
            ..Options::default()
        }
    }

    fn log_of(blocks: &[Block]) -> Log {
        let base = tempfile::tempdir().expect("a folder");
        let dir = base.path().join("life");
        let info = LoggerInfo::new(["reward", "world_index"]).expect("two columns");
        let mut writer = LogWriter::create(&dir, &info, &ScenarioInfo::default()).expect("a new log");
        let mut number = 0;
        for (block, (learns, task, rows)) in (0..).zip(blocks) {
            let block_type = if *learns { BlockType::Train } else { BlockType::Test };
            for (world, reward) in rows {
                let when = Timestamp::from_unix_micros(number as i64).expect("a time");
                let record = Record::new(block, number, block_type, *task, when).with_metric("reward", *reward);
                let index = world.map_or(f64::NAN, f64::from);
                writer.write(&record.with_metric("world_index", index)).expect("a row");
                number += 1;
            }
        }
        drop(writer);
        read_log(&dir).expect("a log")
    }

    /// The sorted performances of each task in each world, or in no recurring world; the worlds are those of the original rows.
    fn by_world(blocks: &[Block], performance: &[f64]) -> BTreeMap<(&'static str, Option<u8>), Vec<f64>> {
        let evaluations = blocks.iter().filter(|(learns, ..)| !learns);
        let rows = evaluations.flat_map(|(_, task, rows)| rows.iter().map(|(world, _)| (*task, *world)));
        let once = |task: &str, world: Option<u8>| {
            let has = |block: &&Block| !block.0 && block.1 == task && block.2.iter().any(|row| row.0 == world);
            blocks.iter().filter(has).count() < 2
        };
        let mut found: BTreeMap<_, Vec<f64>> = BTreeMap::new();
        for ((task, world), value) in rows.zip(performance) {
            // Rows of worlds that occur in only one evaluation are exchanged with each other.
            let world = world.filter(|world| !once(task, Some(*world)));
            found.entry((task, world)).or_default().push(*value);
        }
        for values in found.values_mut() {
            values.sort_by(f64::total_cmp);
        }
        found
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 60)))]

        #[test]
        fn permuting_keeps_rewards_within_each_world(blocks in blocks(), seed in any::<u64>()) {
            let log = log_of(&blocks);
            let lifetime = Lifetime::prepare(&log, &[], &options()).expect("some rows are kept");
            let mut evaluations = Evaluations::of(&log, &lifetime);
            let before = evaluations.performance.clone();
            let evaluated = blocks.iter().filter(|(learns, ..)| !learns).map(|(_, _, rows)| rows.len());
            // Consecutive blocks of one task are separate regimes.
            let lengths: Vec<usize> = evaluations.regimes.iter().map(|(_, rows)| rows.len()).collect();
            prop_assert_eq!(lengths, evaluated.collect::<Vec<_>>());
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut moved = false;
            for _ in 0..30 {
                evaluations.permute(&mut rng);
                prop_assert_eq!(by_world(&blocks, &before), by_world(&blocks, &evaluations.performance));
                moved |= evaluations.performance != before;
            }
            prop_assert_eq!(moved, !evaluations.bundles.is_empty());
        }

        #[test]
        fn unpermuted_evaluations_give_the_lifetimes_terminal_performance(blocks in blocks()) {
            let log = log_of(&blocks);
            let lifetime = Lifetime::prepare(&log, &[], &options()).expect("some rows are kept");
            let scores = crate::score(&log, &[], &options()).expect("scores");
            let mut term_perfs = vec![f64::NAN; lifetime.regimes().len()];
            let evaluations = Evaluations::of(&log, &lifetime);
            evaluations.set_term_perfs(&mut term_perfs);
            for (regime, values) in lifetime.regimes().iter().zip(&scores.regimes) {
                let number = values.values.number("term_perf").expect("every regime ends");
                let expected = if regime.block_type == BlockType::Test { number } else { f64::NAN };
                prop_assert_eq!(term_perfs[regime.regime_num].to_bits(), expected.to_bits());
            }
        }
    }
}
