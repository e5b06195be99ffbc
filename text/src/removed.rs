//! Words that earlier releases took, and what to use instead.

/// What a word that a user types stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// A command, with the commands before it: `bench metrics`.
    Command,
    /// An option, behind its command: `convert --to`.
    Option,
    /// The ending of a file's name, or a format by its own name.
    Format,
    /// What variants and worlds are compared by: `--by`, `compare_by`, `by=`.
    By,
    /// How the values of a parameter are compared: `compare.measure` of a task spec.
    Measure,
    /// How variants are put into an order: `--order`, `method=`.
    Order,
}

const TABLES: &str = ".jsonl for worlds, .tsv or .csv for logs; docs/how-to/interoperate.md makes Parquet of either";

/// Every removed word: its kind, the word, what to use instead.
const REMOVED: &[(WordKind, &str, &str)] = &[
    (
        WordKind::Command,
        "bench generator",
        "cargo bench -p driftworld-generator",
    ),
    (WordKind::Command, "bench metrics", "cargo bench -p driftworld-metrics"),
    (
        WordKind::Command,
        "bench similarity",
        "cargo bench -p driftworld-similarity",
    ),
    (
        WordKind::Command,
        "unity",
        "cp target/release/driftworld-unity DIR/l2explorer.x86_64, as docs/l2explorer.md shows",
    ),
    (WordKind::Format, "arrow", TABLES),
    (WordKind::Format, "feather", TABLES),
    (WordKind::Format, "npy", ".csv or .json for distances"),
    (WordKind::Format, "parquet", TABLES),
    (WordKind::Option, "console --out", "--output"),
    (WordKind::Option, "convert --from", "examples/python/text_maps.py"),
    (
        WordKind::Option,
        "convert --to",
        "no --to: worlds and scenarios are written in Driftworld's form",
    ),
    (WordKind::Option, "curriculum --method", "--order"),
    (WordKind::Option, "order --method", "--order"),
    (WordKind::Option, "run --logs", "--output"),
    (WordKind::Option, "transfer-report --output", "--plot"),
    (WordKind::Option, "transfer-report -o", "--plot"),
    (WordKind::By, "occupancy:dice", "occupancy:jaccard"),
    (
        WordKind::By,
        "occupancy:earth_movers_hat",
        "occupancy, or objects, which counts what is missing",
    ),
    (WordKind::By, "occupancy:hamming", "occupancy:jaccard"),
    (
        WordKind::By,
        "occupancy:hausdorff_95",
        "occupancy:hausdorff or occupancy:chamfer",
    ),
    (WordKind::By, "occupancy:ruzicka", "occupancy:jaccard"),
    (WordKind::By, "occupancy:sinkhorn", "occupancy"),
    (WordKind::By, "occupancy:sliced_wasserstein", "occupancy"),
    (WordKind::Measure, "jeffreys", "jensen_shannon"),
    (WordKind::Measure, "maximum_mean_discrepancy", "energy"),
    (WordKind::Order, "bottleneck", "gradual"),
    (WordKind::Order, "contrast", "abrupt"),
    (WordKind::Order, "farthest-first", "farthest"),
    (WordKind::Order, "leaf", "two-opt"),
    (WordKind::Order, "spectral", "two-opt"),
    (WordKind::Order, "tree", "two-opt"),
    (
        WordKind::Order,
        "typical-last",
        "given, with the most typical variant named last",
    ),
];

/// What a message says of a removed word, `removed in 0.3; use …`; `None` for any other word.
///
/// ```
/// # use driftworld_text::{WordKind, removed};
/// let said = removed(WordKind::Option, "run --logs");
/// assert_eq!(said.as_deref(), Some("removed in 0.3; use --output"));
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
