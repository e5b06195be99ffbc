//! Figures as files, PNG and SVG, under the reference's names. What they show is `report`'s.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use driftworld::metrics::Lifetime;
use driftworld::report::{ChapterOptions, Figures};

use crate::commands::{Failure, output};

/// A folder of figures, and what is in it already.
pub(super) struct Files {
    folder: PathBuf,
    names: BTreeSet<String>,
    count: usize,
    bytes: usize,
}

impl Files {
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            names: BTreeSet::new(),
            count: 0,
            bytes: 0,
        }
    }

    /// Writes a lifetime's figures, each twice. Lifetimes of one name are numbered from the second on.
    pub(super) fn write(&mut self, lifetime: &Lifetime, column: &str, options: &ChapterOptions) -> Result<(), Failure> {
        let numbered = |number: usize| match number {
            1 => lifetime.run_id().to_owned(),
            number => format!("{}_{number}", lifetime.run_id()),
        };
        let free = (1..).map(numbered).find(|name| !self.names.contains(name));
        let name = free.unwrap_or_default();
        self.names.insert(name.clone());
        let figures = Figures::of(lifetime, column, &options.figures)?;
        for figure in options.shown.iter().copied().filter(|figure| figures.has(*figure)) {
            let stem = format!("{name}_{}", figure.name());
            self.put(&format!("{stem}.png"), &figures.png(figure)?)?;
            self.put(&format!("{stem}.svg"), figures.svg(figure)?.as_bytes())?;
        }
        Ok(())
    }

    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        output::write(&self.folder.join(name), bytes)?;
        self.count += 1;
        self.bytes += bytes.len();
        Ok(())
    }

    /// What was written, in words.
    pub(super) fn told(&self) -> String {
        let (folder, kilobytes) = (self.folder.display(), self.bytes.div_ceil(1000));
        format!("{folder}: {} figures, {kilobytes} kB", self.count)
    }
}
