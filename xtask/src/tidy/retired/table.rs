//! The retired words as data: each with what stands in its place, and the rooms that still use it. Rooms only leave this
//! list; how words are looked for is in `mod.rs`.

/// Where a word is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Where {
    /// The name of a file without its ending.
    File,
    /// Identifiers of shipped sources: the whole, or a part between underscores.
    Name,
    /// README, `docs/`, the command's help.
    Prose,
}

/// A word that is not used any more.
#[derive(Debug)]
pub(super) struct Retired {
    pub(super) kind: Where,
    pub(super) word: &'static str,
    /// What is said in its place.
    pub(super) instead: &'static str,
    /// Rooms that have not parted with it yet.
    pub(super) still_in: &'static [&'static str],
}

impl Retired {
    pub(super) const fn file(word: &'static str, instead: &'static str, still_in: &'static [&'static str]) -> Self {
        Self {
            kind: Where::File,
            word,
            instead,
            still_in,
        }
    }

    pub(super) const fn name(word: &'static str, instead: &'static str, still_in: &'static [&'static str]) -> Self {
        Self {
            kind: Where::Name,
            word,
            instead,
            still_in,
        }
    }

    pub(super) const fn prose(word: &'static str, instead: &'static str, still_in: &'static [&'static str]) -> Self {
        Self {
            kind: Where::Prose,
            word,
            instead,
            still_in,
        }
    }
}

/// The words, as the house parted with them.
pub(super) const RETIRED: &[Retired] = &[
    Retired::file("answer", "interactions.rs", &[]),
    Retired::file("chance", "rng.rs", &[]),
    Retired::file("judge", "termination.rs", &[]),
    Retired::file("patience", "interruptible.rs", &[]),
    Retired::file("sight", "visibility.rs", &[]),
    Retired::file("regions", "clearance.rs", &[]),
    Retired::file("lived", "scored.rs", &[]),
    Retired::file("yardstick", "comparison_setup.rs", &[]),
    Retired::file("coverage", "sequence.rs", &[]),
    Retired::file("crowd", "spatial_hash.rs", &[]),
    Retired::name("Briefing", "EpisodeContext", &[]),
    Retired::name("Came", "ResumeState", &[]),
    Retired::name("Chance", "Rng", &[]),
    Retired::name("Coat", "Material", &[]),
    Retired::name("Coverage", "Sequence", &[]),
    Retired::name("Crowd", "SpatialHash", &[]),
    Retired::name("Desk", "Worker", &[]),
    Retired::name("Dress", "WorldOverrides", &[]),
    Retired::name("Due", "ExperienceSpec", &[]),
    Retired::name("Ground", "FreeSpace or CollisionWorld", &[]),
    Retired::name("Hired", "NamedAgent", &[]),
    Retired::name("How", "Method", &[]),
    Retired::name("Life", "Run", &[]),
    Retired::name("Lived", "Run or a scored log", &[]),
    Retired::name("Losers", "LossCount", &[]),
    Retired::name("Nature", "MetricProperties", &[]),
    Retired::name("Paintwork", "ShadingParams", &[]),
    Retired::name("Plot", "PlacementContext", &[]),
    Retired::name("Spot", "Node", &[]),
    Retired::name("Surroundings", "RunContext", &[]),
    Retired::name("Thing", "ObjectFeatures", &[]),
    Retired::name("Together", "RepeatSummary", &[]),
    Retired::name("Unsettled", "UnresolvedParams", &[]),
    Retired::name("When", "EvaluationSchedule", &[]),
    Retired::name("Who", "AgentArg", &[]),
    Retired::name("Words", "DictionaryColumn", &[]),
    Retired::name("Yardstick", "ComparisonSetup", &[]),
    Retired::name("bring_back", "respawn", &[]),
    Retired::name("carry_out", "apply_action", &[]),
    Retired::name("chance", "rng, or seed where it is one", &[]),
    Retired::name("how", "method", &[]),
    Retired::name("ink", "packed pixel", &[]),
    Retired::name("lived", "run, scored log", &[]),
    Retired::name("made_from", "add_fingerprint", &[]),
    Retired::name("with_nature", "with_properties", &[]),
    Retired::name("patience", "interruptible", &[]),
    Retired::name("patiently", "run_cancellable", &[]),
    Retired::name("prints", "fingerprints", &[]),
    Retired::name("put_on", "apply", &[]),
    Retired::name("take_stock", "init_contacts", &[]),
    Retired::name("take_up", "resume", &[]),
    Retired::name("told", "set_task_label, to_py, or what it is", &[]),
    Retired::name("yardstick", "comparison setup", &[]),
    Retired::prose("anecdote", "\"proves little\"", &[]),
    Retired::prose("chance", "randomness, a seed, at random", &[]),
    Retired::prose("lived", "run", &[]),
    Retired::prose("lives", "runs", &[]),
    Retired::prose("told", "reported", &[]),
    Retired::prose("yardstick", "baseline", &[]),
];
