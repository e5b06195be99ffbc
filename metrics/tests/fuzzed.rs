//! The fuzzer's seeds, and what becomes of them by small changes, keep the laws of every log; the fuzzer itself needs a nightly
//! compiler.
//!
//! Not here: the laws, see `fuzz/laws.rs`.

#![expect(clippy::unwrap_used, reason = "a test stops at its first surprise")]

#[path = "../fuzz/laws.rs"]
mod laws;

use std::fs;
use std::path::Path;

use proptest::prelude::*;

/// Every seed in the order of their names.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds");
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// A small change of a text.
#[derive(Debug, Clone)]
enum Change {
    Flip(prop::sample::Index, u8),
    Cut(prop::sample::Index, usize),
    Insert(prop::sample::Index, &'static str),
    /// Puts a piece of the text in at another place.
    Copy(prop::sample::Index, prop::sample::Index, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let place = any::<prop::sample::Index>;
    let words = vec![
        "\t",
        "\n",
        "\r\n",
        "\"",
        "\"\"",
        "\n%%\n",
        "nan",
        "inf",
        "1e99",
        "-0.0",
        "18446744073709551615",
        "complete",
        "sleep",
        "{}",
        "é",
        "99991231T235959.999999",
    ];
    prop_oneof![
        (place(), any::<u8>()).prop_map(|(at, byte)| Change::Flip(at, byte)),
        (place(), 1_usize..40).prop_map(|(at, num)| Change::Cut(at, num)),
        (place(), prop::sample::select(words)).prop_map(|(at, word)| Change::Insert(at, word)),
        (place(), place(), 1_usize..90).prop_map(|(from, to, num)| Change::Copy(from, to, num)),
    ]
}

fn changed(mut text: Vec<u8>, changes: &[Change]) -> Vec<u8> {
    for change in changes {
        // One place more than there are bytes: the end is a place, too.
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

#[test]
fn the_seeds_keep_the_laws() {
    let seeds = seeds();
    assert!(seeds.len() >= 8);
    for seed in seeds {
        laws::check(&seed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]
    #[test]
    fn seeds_with_small_changes_keep_the_laws(
        seed in prop::sample::select(seeds()),
        changes in prop::collection::vec(change(), 1..5),
    ) {
        laws::check(&changed(seed, &changes));
    }
}
