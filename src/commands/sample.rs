//! `driftworld sample`: worlds of a variant, one or many, any shard of them. Drawing is the generator's.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use driftworld::generator::Sampler;
use driftworld::tasks;
use rayon::prelude::*;
use tempfile::NamedTempFile;

use super::{Failure, output};

/// How many worlds are drawn at once while streaming; memory is bounded by it.
const CHUNK: u64 = 1024;

/// Draw worlds from a variant of a task.
///
/// World number INDEX under a seed is always the same, whatever was drawn before it and on whatever machine.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld sample find_objects#red --seed 7 --index 12345 -o -
  driftworld sample find_objects#red --seed 7 --count 1000 --jsonl -o worlds.jsonl
  driftworld sample my_task.json#night --count 10 -o worlds/")]
pub(crate) struct Sample {
    /// A task's variant: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    task: String,
    /// The seed.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The number of the first world.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// How many worlds, from INDEX on.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    count: Option<u64>,
    /// One world a line instead of indented files.
    #[arg(long)]
    jsonl: bool,
    /// A file, a folder for several worlds, or - for standard output.
    #[arg(short, long, default_value = "-", value_name = "PATH")]
    output: PathBuf,
}

impl Sample {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let sampler = Sampler::new(&tasks::variant(&self.task)?, self.seed);
        let count = self.count.unwrap_or(1);
        if self.index.checked_add(count).is_none() {
            return Err(Failure::usage(format!(
                "--index {} leaves no room for --count {count}",
                self.index
            )));
        }
        if self.jsonl {
            return self.stream(&sampler, count);
        }
        if self.count.is_none() {
            return output::write_or_print(&self.output, &line_of(&sampler, self.index)?);
        }
        if self.output == Path::new("-") {
            return Err(Failure::usage(
                "several worlds go to a folder (-o DIR), or as one world a line (--jsonl)",
            ));
        }
        self.files(&sampler, count)
    }

    fn stream(&self, sampler: &Sampler, count: u64) -> Result<(), Failure> {
        if self.output == Path::new("-") {
            return self.lines(sampler, count, output::print);
        }
        let folder = self
            .output
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        let failed =
            |error: std::io::Error| Failure::input(format!("{}: cannot be written: {error}", self.output.display()));
        std::fs::create_dir_all(folder).map_err(failed)?;
        let mut file = BufWriter::new(NamedTempFile::new_in(folder).map_err(failed)?);
        self.lines(sampler, count, |text| file.write_all(text.as_bytes()).map_err(failed))?;
        let file = file.into_inner().map_err(|error| failed(error.into_error()))?;
        output::persist(file, &self.output)
    }

    /// Hands over the worlds as lines, in order; draws a chunk at a time on all cores.
    fn lines(
        &self,
        sampler: &Sampler,
        count: u64,
        mut take: impl FnMut(&str) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let bar = output::progress(count, "sampling");
        let end = self.index + count;
        let mut first = self.index;
        while first < end {
            let next = end.min(first.saturating_add(CHUNK));
            let lines: Vec<_> = (first..next)
                .into_par_iter()
                .map(|index| Ok(sampler.world(index)?.to_json() + "\n"))
                .collect();
            for line in lines {
                take(&line.map_err(|error: driftworld::generator::GeneratorError| Failure::from(error))?)?;
            }
            bar.inc(next - first);
            first = next;
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn files(&self, sampler: &Sampler, count: u64) -> Result<(), Failure> {
        let bar = output::progress(count, "sampling");
        for index in self.index..self.index + count {
            let path = self.output.join(format!("{index:08}.json"));
            output::write(&path, sampler.world(index)?.to_json_pretty().as_bytes())?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        output::line(format!("{count} worlds in {}", self.output.display()))
    }
}

/// One world as one line: alone it has the same bytes as in a stream.
fn line_of(sampler: &Sampler, index: u64) -> Result<String, Failure> {
    Ok(sampler.world(index)?.to_json() + "\n")
}
