//! Writes the figures of lifetimes into a folder, with l2metrics' file names.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use driftworld_metrics::Lifetime;
use driftworld_report::{Figure, FigureOptions, Figures};

use crate::{Failure, output_file};

/// A folder of figures, with the names used so far.
pub(crate) struct Files {
    folder: PathBuf,
    names: BTreeSet<String>,
    count: usize,
    bytes: usize,
}

impl Files {
    pub(crate) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            names: BTreeSet::new(),
            count: 0,
            bytes: 0,
        }
    }

    /// Writes the figures of a lifetime. If several lifetimes have the same name, a number is added from the second onwards.
    pub(crate) fn write(&mut self, drawn: &Drawn) -> Result<(), Failure> {
        let numbered = |number: usize| match number {
            1 => drawn.run_id.clone(),
            number => format!("{}_{number}", drawn.run_id),
        };
        // One of these candidates is free: there is one more than names in use.
        let mut names = (1..=self.names.len() + 1).map(numbered);
        let name = names.find(|name| !self.names.contains(name)).unwrap_or_default();
        for (ending, bytes) in &drawn.files {
            output_file::write(&self.folder.join(format!("{name}_{ending}")), bytes)?;
            self.count += 1;
            self.bytes += bytes.len();
        }
        self.names.insert(name);
        Ok(())
    }

    /// Number and total size of the written figures, as text.
    pub(crate) fn what(&self) -> String {
        format!("{} figures, {} kB", self.count, self.bytes.div_ceil(1000))
    }
}

/// The figures of one lifetime as file contents.
pub(crate) struct Drawn {
    run_id: String,
    /// The end of each name, such as `raw.png`, and the bytes.
    files: Vec<(String, Vec<u8>)>,
}

/// Draws a lifetime's figures, each as PNG and as SVG.
pub(crate) fn drawn(
    lifetime: &Lifetime,
    column: &str,
    shown: &[Figure],
    options: &FigureOptions,
) -> Result<Drawn, Failure> {
    let figures = Figures::of(lifetime, column, options)?;
    let mut files = Vec::new();
    for figure in shown.iter().copied().filter(|figure| figures.has(*figure)) {
        files.push((format!("{}.png", figure.name()), figures.png(figure)?));
        files.push((format!("{}.svg", figure.name()), figures.svg(figure)?.into_bytes()));
    }
    // If there are several logs, a lifetime's name may be a path.
    let run_id = lifetime.run_id().replace(['/', '\\'], "_");
    Ok(Drawn { run_id, files })
}
