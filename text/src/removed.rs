//! Words that earlier releases accepted, with their replacements.

use WordKind::{By, Command, Format, Measure, Option as Flag, Order};

/// What kind of word the user typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// A command, with its parent commands: `bench metrics`.
    Command,
    /// An option, after its command: `convert --to`.
    Option,
    /// A file extension, or the name of a format.
    Format,
    /// A way to compare variants and worlds: `--by`, `compare_by`, `by=`.
    By,
    /// A way to compare the values of a parameter: `compare.measure` of a task spec.
    Measure,
    /// A way to order variants: `--order`, `method=`.
    Order,
}

const TABLES: &str = ".jsonl for worlds, .tsv or .csv for logs; docs/how-to/interoperate.md converts either to Parquet";

/// Every removed word: its kind, the word, what to use instead.
const REMOVED: &[(WordKind, &str, &str)] = &[
    (Command, "bench generator", "cargo bench -p driftworld-generator"),
    (Command, "bench metrics", "cargo bench -p driftworld-metrics"),
    (Command, "bench similarity", "cargo bench -p driftworld-similarity"),
    (
        Command,
        "unity",
        "cp target/release/driftworld-unity DIR/l2explorer.x86_64, as docs/l2explorer.md shows",
    ),
    (Format, "arrow", TABLES),
    (Format, "feather", TABLES),
    (Format, "npy", ".csv or .json for distances"),
    (Format, "parquet", TABLES),
    (Flag, "console --out", "--output"),
    (Flag, "convert --from", "examples/python/text_maps.py"),
    (
        Flag,
        "convert --to",
        "convert without --to, which writes worlds and scenarios in Driftworld's own format",
    ),
    (Flag, "curriculum --method", "--order"),
    (Flag, "order --method", "--order"),
    (Flag, "run --logs", "--output"),
    (Flag, "transfer-report --output", "--plot"),
    (Flag, "transfer-report -o", "--plot"),
    (By, "occupancy:dice", "occupancy:jaccard"),
    (By, "occupancy:earth_movers_hat", "occupancy or objects"),
    (By, "occupancy:hamming", "occupancy:jaccard"),
    (By, "occupancy:hausdorff_95", "occupancy:hausdorff or occupancy:chamfer"),
    (By, "occupancy:ruzicka", "occupancy:jaccard"),
    (By, "occupancy:sinkhorn", "occupancy"),
    (By, "occupancy:sliced_wasserstein", "occupancy"),
    (Measure, "jeffreys", "jensen_shannon"),
    (Measure, "maximum_mean_discrepancy", "energy"),
    (Order, "bottleneck", "gradual"),
    (Order, "contrast", "abrupt"),
    (Order, "farthest-first", "farthest"),
    (Order, "leaf", "two-opt"),
    (Order, "spectral", "two-opt"),
    (Order, "tree", "two-opt"),
    (Order, "typical-last", "given, with the most typical variant named last"),
];

/// The message for a removed word, `removed in 0.3; use …`; `None` for any other word.
///
/// ```
/// # use driftworld_text::{WordKind, removed};
/// let message = removed(WordKind::Option, "run --logs");
/// assert_eq!(message.as_deref(), Some("removed in 0.3; use --output"));
/// ```
pub fn removed(kind: WordKind, word: &str) -> Option<String> {
    let mut rows = removed_words().filter(|(of, known, _)| *of == kind && *known == word);
    rows.next()
        .map(|(_, _, instead)| format!("removed in 0.3; use {instead}"))
}

/// Every removed word: its kind, the word, what to use instead.
pub fn removed_words() -> impl Iterator<Item = (WordKind, &'static str, &'static str)> {
    REMOVED.iter().copied()
}
