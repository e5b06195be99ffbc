//! What came of the faults: counts, and every failure in words.

use std::fmt;
use std::time::Duration;

/// What came of one kind of fault.
#[derive(Debug, Default)]
pub(super) struct Figures {
    /// How often something was tried to its end.
    pub(super) tries: u64,
    /// Faults that were met on the way.
    pub(super) faults: u64,
    /// Logs or files whose bytes are others than those of an undisturbed run.
    pub(super) differing: u64,
    /// What went wrong, that among it.
    pub(super) failures: u64,
    /// Figures of this kind alone.
    pub(super) notes: Vec<String>,
}

impl Figures {
    /// Nothing was tried, and why.
    pub(super) fn skipped(reason: &str) -> Self {
        println!("skipped: {reason}");
        Self {
            notes: vec![format!("skipped: {reason}")],
            ..Self::default()
        }
    }

    /// Something went wrong.
    pub(super) fn failed(&mut self, what: impl AsRef<str>) {
        self.failures += 1;
        println!("FAILED: {}", what.as_ref());
    }

    /// The end of a try; says what differs, if something does.
    pub(super) fn compared(&mut self, difference: Option<String>, what: &str) {
        self.tries += 1;
        if let Some(difference) = difference {
            self.differing += 1;
            self.failed(format!("{what}: {difference}"));
        }
    }

    /// Adds another's counts.
    pub(super) fn add(&mut self, other: Self) {
        self.tries += other.tries;
        self.faults += other.faults;
        self.differing += other.differing;
        self.failures += other.failures;
        self.notes.extend(other.notes);
    }
}

/// The figures of all kinds, as a table of Markdown.
#[derive(Debug, Default)]
pub(super) struct Table(Vec<(&'static str, Figures, Duration)>);

impl Table {
    pub(super) fn add(&mut self, name: &'static str, figures: Figures, took: Duration) {
        self.0.push((name, figures, took));
        let line = self.0.iter().next_back().map(row).unwrap_or_default();
        println!("{line}");
    }

    pub(super) fn num_failures(&self) -> usize {
        self.0.iter().map(|(_, figures, _)| figures.failures as usize).sum()
    }
}

fn row((name, figures, took): &(&'static str, Figures, Duration)) -> String {
    format!(
        "| {name} | {} | {} | {} | {} | {:.0} | {} |",
        figures.tries,
        figures.faults,
        figures.differing,
        figures.failures,
        took.as_secs_f64(),
        figures.notes.join("; ")
    )
}

impl fmt::Display for Table {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "| kind | tries | faults | differing | failures | seconds | notes |"
        )?;
        writeln!(formatter, "|---|---:|---:|---:|---:|---:|---|")?;
        self.0.iter().try_for_each(|line| writeln!(formatter, "{}", row(line)))
    }
}
