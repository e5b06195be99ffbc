//! Whether experts are comparable with the lifetime, by budgets, worlds and agents.

use std::collections::BTreeSet;

use driftworld_metrics::BlockType::{Test, Train};
use driftworld_metrics::{
    BlockType, ExpertFit, Log, LogWriter, LoggerInfo, Options, Record, ScenarioInfo, SteLog, Timestamp, read_log, score,
};
use proptest::prelude::*;

/// A block: its type, its task, the seed and first index of its worlds, its length, and whether it is before deployment.
#[derive(Debug, Clone)]
struct Block {
    kind: BlockType,
    task: &'static str,
    seed: u64,
    first: u32,
    count: u32,
    is_before: bool,
}

fn learning(task: &'static str, seed: u64, first: u32, count: u32) -> Block {
    Block {
        kind: Train,
        task,
        seed,
        first,
        count,
        is_before: false,
    }
}

fn log_of(blocks: &[Block], agent: Option<&str>) -> Log {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("life");
    let columns = LoggerInfo::new(["reward", "world_index"]).unwrap();
    let mut info = ScenarioInfo::default();
    info.extra.extend(agent.map(|agent| ("agent".to_owned(), agent.into())));
    let mut writer = LogWriter::create(&dir, &columns, &info).unwrap();
    let mut number = 0;
    for (place, block) in (0..).zip(blocks) {
        let mut params = serde_json::Map::from_iter([("seed".to_owned(), block.seed.into())]);
        if block.is_before {
            params.insert("phase".to_owned(), "pre_deployment".into());
        }
        for index in block.first..block.first + block.count {
            let when = Timestamp::from_unix_micros(number as i64).unwrap();
            let record = Record::new(place, number, block.kind, block.task, when)
                .with_metric("reward", f64::from(index % 7))
                .with_metric("world_index", f64::from(index))
                .with_task_params(params.clone());
            writer.write(&record).unwrap();
            number += 1;
        }
    }
    read_log(&dir).unwrap()
}

fn fit(life: &[Block], agent: Option<&str>, expert: &[Block], expert_agent: Option<&str>) -> (ExpertFit, Vec<String>) {
    let expert = SteLog::new(log_of(expert, expert_agent)).unwrap();
    let task = expert.task_name().to_owned();
    let scores = score(&log_of(life, agent), &[expert], &Options::default()).unwrap();
    (scores.expert_fits[&task][0].clone(), scores.cautions)
}

#[test]
fn expert_with_equal_worlds_budget_and_agent_is_like_for_like() {
    let life = [
        learning("f_a", 1, 0, 12),
        learning("f_b", 1, 0, 12),
        learning("f_a", 1, 12, 12),
    ];
    let expert = [learning("f_a", 1, 0, 24)];
    let (found, notes) = fit(&life, Some("ppo"), &expert, Some("ppo"));
    assert_eq!((found.learned.lifetime, found.learned.expert), (24, 24));
    assert_eq!(
        (found.shared_worlds, found.differences.len()),
        (Some(24), 0),
        "{found:?}"
    );
    assert!(notes.iter().all(|note| !note.contains("like for like")), "{notes:?}");
}

#[test]
fn differences_are_listed() {
    let before = Block {
        is_before: true,
        ..learning("f_b", 1, 50, 5)
    };
    let life = [
        before.clone(),
        learning("f_a", 1, 0, 12),
        learning("f_b", 1, 0, 12),
        learning("f_a", 1, 12, 12),
    ];
    // The same block before deployment is comparable, whatever its task.
    let same = [before.clone(), learning("f_a", 1, 0, 24)];
    assert!(fit(&life, None, &same, None).0.differences.is_empty());
    let expert_before = Block {
        task: "f_a",
        count: 3,
        ..before
    };
    // One block instead of the lifetime's two, fewer worlds, less learning before deployment, a different agent.
    let expert = [expert_before, learning("f_a", 1, 6, 12)];
    let (found, notes) = fit(&life, Some("replay"), &expert, Some("ppo"));
    assert_eq!(
        found.differences,
        [
            "it had 12 learning experiences, the lifetime 24",
            "it had 3 learning experiences before deployment, the lifetime 5",
            "12 of its 12 worlds are among the lifetime's 24",
            "its agent is \"ppo\", the lifetime's \"replay\"",
        ]
    );
    let found_notes: Vec<&String> = notes.iter().filter(|note| note.contains("like for like")).collect();
    assert!(
        found_notes.len() == 1 && found_notes[0].starts_with("the expert life of f_a is not like for like: it had 12"),
        "{notes:?}"
    );
    // The same index with another seed is a different world.
    let (found, _) = fit(&life, None, &[learning("f_a", 2, 0, 24)], Some("ppo"));
    assert_eq!((found.shared_worlds, found.agent), (Some(0), None));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 40)))]

    /// Compares the counts with sets of pairs computed directly from the blocks.
    #[test]
    fn worlds_and_budgets_are_counted(
        life in prop::collection::vec((prop::bool::ANY, prop::bool::ANY, 0_u64..3, 0_u32..20, 1_u32..15), 1..6),
        expert in prop::collection::vec((0_u64..3, 0_u32..20, 1_u32..15), 1..4),
    ) {
        let mut life: Vec<Block> = (life.into_iter())
            .map(|(is_a, is_test, seed, first, count)| Block {
                kind: if is_test { Test } else { Train },
                ..learning(if is_a { "f_a" } else { "f_b" }, seed, first, count)
            })
            .collect();
        life.push(learning("f_a", 1, 3, 2));
        let expert: Vec<Block> = (expert.into_iter())
            .map(|(seed, first, count)| learning("f_a", seed, first, count))
            .collect();
        let (found, _) = fit(&life, None, &expert, None);
        let rows = |blocks: &[Block]| -> Vec<(u64, u32)> {
            let learned = blocks.iter().filter(|block| block.kind == Train && block.task == "f_a");
            learned.flat_map(|block| (block.first..block.first + block.count).map(|index| (block.seed, index))).collect()
        };
        let (own, other) = (rows(&life), rows(&expert));
        prop_assert_eq!((found.learned.lifetime, found.learned.expert), (own.len(), other.len()));
        let (own, other): (BTreeSet<_>, BTreeSet<_>) = (own.into_iter().collect(), other.into_iter().collect());
        let worlds = found.worlds.unwrap();
        prop_assert_eq!((worlds.lifetime, worlds.expert), (own.len(), other.len()));
        prop_assert_eq!(found.shared_worlds, Some(own.intersection(&other).count()));
    }
}
