//! Runs every target's check on the fuzzer's seeds and on small changes to them. The fuzzer itself needs a nightly compiler.

use std::fs;
use std::path::Path;

use driftworld_fuzz::{TARGETS, Target};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// Every seed of a target, ordered by name.
fn seeds(target: &Target) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("seeds").join(target.name);
    let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("the seeds are readable").path())
        .collect();
    paths.sort();
    paths
        .iter()
        .map(|path| fs::read(path).expect("the seeds are readable"))
        .collect()
}

/// A small change to a text.
#[derive(Debug, Clone)]
enum Change {
    Flip(prop::sample::Index, u8),
    Cut(prop::sample::Index, usize),
    Insert(prop::sample::Index, &'static str),
    /// Copies a piece of the text to any position.
    Copy(prop::sample::Index, prop::sample::Index, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let place = any::<prop::sample::Index>;
    let words =
        "\t|\n|\r\n|\"|\"\"|\n%%\n|nan|inf|1e99|-0.0|18446744073709551615|complete|sleep|{}|é|99991231T235959.999999";
    let words: Vec<&str> = words.split('|').collect();
    prop_oneof![
        (place(), any::<u8>()).prop_map(|(at, byte)| Change::Flip(at, byte)),
        (place(), 1_usize..40).prop_map(|(at, num)| Change::Cut(at, num)),
        (place(), prop::sample::select(words)).prop_map(|(at, word)| Change::Insert(at, word)),
        (place(), place(), 1_usize..90).prop_map(|(from, to, num)| Change::Copy(from, to, num)),
    ]
}

fn apply_changes(mut text: Vec<u8>, changes: &[Change]) -> Vec<u8> {
    for change in changes {
        // The end is a position as well, so there is one more position than there are bytes.
        let at = |index: &prop::sample::Index| index.index(text.len() + 1);
        match change {
            Change::Flip(index, byte) => {
                let at = at(index);
                if let Some(old) = text.get_mut(at) {
                    *old = *byte;
                }
            }
            Change::Cut(index, num) => {
                let at = at(index);
                let end = (at + num).min(text.len());
                text.drain(at..end);
            }
            Change::Insert(index, word) => {
                let at = at(index);
                text.splice(at..at, word.bytes());
            }
            Change::Copy(from, to, num) => {
                let (from, to) = (at(from), at(to));
                let piece = text[from..(from + num).min(text.len())].to_vec();
                text.splice(to..to, piece);
            }
        }
    }
    text
}

/// Runs one target's check on its seeds and on small changes to them.
fn check(name: &str, cases: u32) {
    let target = TARGETS
        .iter()
        .find(|target| target.name == name)
        .expect("the target is one of ours");
    let seeds = seeds(target);
    assert!(seeds.len() >= 2, "{} seeds", seeds.len());
    for seed in &seeds {
        (target.law)(seed);
    }
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let inputs = (prop::sample::select(seeds), prop::collection::vec(change(), 1..5));
    let result = TestRunner::new(config).run(&inputs, |(seed, changes)| {
        (target.law)(&apply_changes(seed, &changes));
        Ok(())
    });
    result.unwrap_or_else(|broken| panic!("{name}: {broken}"));
}

macro_rules! targets {
    ($($name:ident: $cases:literal,)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name), $cases);
            }
        )*

        #[test]
        fn every_target_is_replayed() {
            let replayed = [$(stringify!($name)),*];
            assert_eq!(replayed.to_vec(), TARGETS.map(|target| target.name).to_vec());
        }
    };
}

targets! {
    agent_script: 256,
    episode: 256,
    gltf: 512,
    library: 256,
    log: 512,
    maps: 512,
    matrix: 256,
    network: 256,
    protocol: 256,
    recording: 256,
    scenario: 256,
    settings: 256,
    task: 256,
    world: 256,
}
