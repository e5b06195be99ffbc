//! Tests of `--mix=task`: drifts between two tasks, in which each experience is of one of the two variants.

use serde_json::Value;

use super::terminal::{Says, fail, read, scratch, succeed, succeed_in};

/// A design that drifts through variants of three tasks.
fn design(more: &str) -> String {
    format!(
        "curriculum find_objects#blue get_to_goal#plain moving_object#blue --by worlds --drift linear --learn 12 \
         --eval-episodes 1 --blocks 3 {more}"
    )
}

#[test]
fn mixture_of_two_tasks_is_designed_run_and_logged() {
    let folder = scratch();
    let refused = fail(1, &design(""));
    assert!(refused.contains("expected two variants of one task"), "{refused}");
    succeed_in(folder.path(), &design("--mix=task -o mix.json"));
    let designed: Value = serde_json::from_str(&read(folder.path().join("mix.json"))).expect("it is JSON");
    let blocks = designed["blocks"].as_array().expect("there are blocks");
    let learning = blocks.iter().filter(|block| block["type"] == "learning");
    let regimes: Vec<&Value> = learning
        .flat_map(|block| block["regimes"].as_array().expect("there are regimes"))
        .collect();
    let mut worlds = Vec::new();
    for regime in &regimes {
        assert_eq!(regime["drift"]["switch"], "task");
        assert_ne!(regime["drift"]["task"], regime["task"], "{regime}");
        let (first, count) = (regime["first_index"].as_u64(), regime["count"].as_u64());
        let first = first.unwrap_or(0);
        worlds.extend((first..first + count.expect("it is a number")).map(|index| (regime["seed"].as_u64(), index)));
    }
    let all = worlds.len();
    worlds.sort_unstable();
    worlds.dedup();
    assert_eq!((worlds.len(), all), (36, 36), "no layout is used twice");
    succeed_in(folder.path(), "run mix.json --agent still --output log");
    let info = read(folder.path().join("log/scenario_info.json"));
    info.says("get_to_goal#plain");
    info.says("moving_object#blue");
}

#[test]
fn worlds_of_a_mixture_are_worlds_of_its_ends() {
    let worlds = |what: &str| {
        let stdout = succeed(&format!("sample {what} --seed 4 --count 40 --jsonl"));
        stdout.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let (a, b) = (worlds("find_objects#interact"), worlds("get_to_goal#sphere"));
    let mixed = worlds("find_objects#interact --drift-to get_to_goal#sphere --mix=task");
    let of_second = mixed.iter().zip(&b).filter(|(mixed, own)| mixed == own).count();
    let of_first = mixed.iter().zip(&a).filter(|(mixed, own)| mixed == own).count();
    assert_eq!(of_first + of_second, 40);
    assert!((10..=30).contains(&of_second), "{of_second} of 40");
    assert_eq!((&mixed[0], &mixed[39]), (&a[0], &b[39]));
}
