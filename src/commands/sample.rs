//! `driftworld sample`: draws one or many worlds of a variant, or a shard of them.

use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;

use crate::design::Mix;
use crate::generator::{Drift, GeneratorError, Sampler, Sequence, Switch};
use crate::spec::{DriftSchedule, Variant, World};
use crate::tasks;
use clap::{Args, ValueEnum};
use driftworld_atomic_files::AtomicFile;
use driftworld_text::counted;
use rayon::prelude::*;

use super::assets::LibraryChoice;
use super::interrupt::Interrupt;
use crate::{Failure, worlds};

use super::output;
use crate::overwrite;

/// Maximum number of worlds drawn at once while streaming.
const MAX_CHUNK: u64 = 1024;

/// Approximate maximum number of objects per chunk: worlds with many objects are drawn in smaller chunks.
const MAX_CHUNK_OBJECTS: u64 = 100_000;

/// Draw worlds from a variant of a task.
///
/// World INDEX under a seed is always the same, on every machine and in every order. Write worlds to standard output, a
/// file, a folder (one file each), or JSON lines (--jsonl).
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld sample find_objects#red --seed 7 --index 12345 -o -
  driftworld sample find_objects#red --seed 7 --count 1000 --jsonl -o worlds.jsonl
  driftworld sample find_objects#red --count 100000 --shard 2/8 --jsonl -o worlds-2.jsonl
  driftworld sample find_objects#red --count 256 --sequence sobol -o worlds/
  driftworld sample find_objects#blue --drift-to red --schedule cosine --count 50 -o drift/
  driftworld sample my_task.json#night --maps my_maps.json --count 10 -o worlds/")]
pub(crate) struct Sample {
    /// The variant: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    task: String,
    /// Seed of the worlds.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
    /// Index of the first world.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// Number of worlds, starting at INDEX.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    count: Option<u64>,
    /// Draw only the I-th of N equal parts, 1/4 to 4/4.
    ///
    /// All parts together equal a single run.
    #[arg(long, value_name = "I/N", requires = "count")]
    shard: Option<Shard>,
    /// How random numbers are spread over the worlds.
    #[arg(long, alias = "sampler", value_enum, default_value_t = SequenceName::Independent)]
    sequence: SequenceName,
    /// Drift to this variant of the task.
    ///
    /// The first world is of the given variant, the last of this one.
    #[arg(long, value_name = "VARIANT", requires = "count")]
    drift_to: Option<String>,
    /// Shape of the drift: linear, cosine, step:N or sawtooth:N.
    #[arg(long, value_parser = crate::design::schedule, default_value = "linear", requires = "drift_to")]
    schedule: DriftSchedule,
    /// Switch at random, not at a fixed point: each value that cannot be interpolated, or the whole variant with `task`.
    ///
    /// The switch becomes more likely as the drift proceeds. With `task`, each world is of one of the two variants,
    /// which may belong to different tasks.
    #[arg(long, requires = "drift_to", num_args = 0..=1, require_equals = true, default_missing_value = "parameter", value_name = "WHAT")]
    mix: Option<Mix>,
    /// Use the layouts in this maps file, or folder of them, instead of the built-in maps.
    #[arg(long, value_name = "PATH")]
    maps: Option<PathBuf>,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Write one world per line instead of indented files.
    #[arg(long)]
    jsonl: bool,
    /// File, folder for several worlds, or - for standard output. A name that ends in .json or .jsonl is a file's.
    #[arg(short, long, default_value = "-", value_name = "PATH")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// The names of [`Sequence`].
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SequenceName {
    /// Each world is drawn independently.
    Independent,
    /// A Sobol sequence over world indices, scrambled by the seed.
    Sobol,
    /// A Latin hypercube over indices INDEX to INDEX + COUNT.
    #[value(alias = "latin-hypercube")]
    Lhs,
}

/// One of several equal parts of a range, numbered from 1.
#[derive(Clone, Copy)]
struct Shard {
    part: u64,
    parts: u64,
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once('/')
            .and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
        match numbers {
            Some((part, parts)) if 1 <= part && part <= parts => Ok(Self { part, parts }),
            _ => Err("expected a part and the number of parts, counted from 1, such as 1/4".to_owned()),
        }
    }
}

impl Shard {
    /// The shard's part of `first..first + count`; some parts are longer by one if `count` does not divide evenly.
    fn of(self, first: u64, count: u64) -> std::ops::Range<u64> {
        let start = |part: u64| first + (u128::from(count) * u128::from(part) / u128::from(self.parts)) as u64;
        start(self.part - 1)..start(self.part)
    }
}

/// Draws the world with a given index.
type Draw = Box<dyn Fn(u64) -> Result<World, GeneratorError> + Sync>;

impl Sample {
    pub(crate) fn run(self) -> Result<(), Failure> {
        self.draw()?;
        output::json_of_what_was_written(self.json && !output::is_stdout(&self.output))
    }

    fn draw(&self) -> Result<(), Failure> {
        let count = self.count.unwrap_or(1);
        if self.index.checked_add(count).is_none() {
            return Err(Failure::usage(format!(
                "--index {} leaves no room for --count {count}",
                self.index
            )));
        }
        overwrite::refuse_inputs(&self.output, [self.task.as_str()])?;
        output::refuse_removed_ending(&self.output)?;
        let variant = tasks::variant(&self.task)?;
        let draw = self.source(&variant, count)?;
        let range = self
            .shard
            .map_or(self.index..self.index + count, |shard| shard.of(self.index, count));
        if self.jsonl {
            return self.stream(&draw, range);
        }
        let is_json = |ending| ending == "json" || ending == "jsonl";
        let is_one_file = output::is_stdout(&self.output) || self.output.extension().is_some_and(is_json);
        if self.count.is_none() || (is_one_file && count == 1 && self.shard.is_none()) {
            return output::write_or_print(&self.output, &(draw(self.index)?.to_json() + "\n"));
        }
        if is_one_file {
            return Err(Failure::usage(
                "found several worlds for one document, expected a folder (-o DIR), or one world per line (--jsonl)",
            ));
        }
        self.files(&draw, range)
    }

    /// The function that draws the worlds.
    fn source(&self, variant: &Variant, count: u64) -> Result<Draw, Failure> {
        let sequence = match self.sequence {
            SequenceName::Independent => Sequence::Independent,
            SequenceName::Sobol => Sequence::Sobol,
            SequenceName::Lhs => Sequence::LatinHypercube {
                first: self.index,
                count,
            },
        };
        let catalogue = self.libraries.catalogue()?;
        tasks::check_variants([variant], &catalogue)?;
        let maps = self.maps.as_deref().map(worlds::maps).transpose()?.map(Arc::new);
        let (seed, first) = (self.seed, self.index);
        let sampler = move |variant: &Variant| {
            let sampler = Sampler::new(variant, seed).with_sequence(sequence);
            match &maps {
                Some(maps) => sampler.with_maps(Arc::clone(maps)),
                None => sampler,
            }
        };
        let Some(name) = &self.drift_to else {
            let sampler = sampler(variant);
            return Ok(Box::new(move |index| sampler.world(index)));
        };
        // A target variant named without a task belongs to the same task.
        let (_, own) = tasks::split(name);
        let to = match own {
            Some(_) => tasks::variant(name)?,
            None => variant.task().variant(name)?,
        };
        tasks::check_variants([&to], &catalogue)?;
        let drift = match self.mix {
            None => Drift::new(variant.clone(), to)?,
            Some(Mix::Parameter) => Drift::new(variant.clone(), to)?.with_switch(Switch::Mixture { seed: self.seed }),
            Some(Mix::Task) => Drift::mixing(variant.clone(), to, self.seed),
        };
        let drift = drift.with_schedule(self.schedule);
        Ok(Box::new(move |index| {
            let progress = (index - first) as f64 / (count.saturating_sub(1).max(1)) as f64;
            sampler(&drift.at(progress, index)?).world(index)
        }))
    }

    fn failed(&self, error: &dyn std::fmt::Display) -> Failure {
        output::unwritable(&self.output, error)
    }

    fn commit(&self, file: BufWriter<AtomicFile>) -> Result<(), Failure> {
        let file = file.into_inner().map_err(|error| self.failed(&error.into_error()))?;
        file.commit().map_err(|error| self.failed(&error))
    }

    fn stream(&self, draw: &Draw, range: std::ops::Range<u64>) -> Result<(), Failure> {
        let count = range.end - range.start;
        if output::is_stdout(&self.output) {
            output::carries_data();
            return for_each_world(draw, range, OUTPUT_REMOVED, |_, world| {
                output::print_json(&(world.to_json() + "\n"))
            });
        }
        let file = output::create(&self.output)?;
        let is_pipe_or_device = file.is_straight();
        let mut file = BufWriter::new(file);
        for_each_world(draw, range, OUTPUT_REMOVED, |_, world| {
            let written = file.write_all((world.to_json() + "\n").as_bytes());
            let written = written.and_then(|()| if is_pipe_or_device { file.flush() } else { Ok(()) });
            written.map_err(|error| self.failed(&error))
        })?;
        self.commit(file)?;
        output::wrote(&self.output, counted(count as usize, "world"));
        Ok(())
    }

    fn files(&self, draw: &Draw, range: std::ops::Range<u64>) -> Result<(), Failure> {
        let count = range.end - range.start;
        for_each_world(draw, range, "the files written so far are complete", |index, world| {
            let path = self.output.join(format!("{index:08}.json"));
            output::write(&path, world.to_json_pretty().as_bytes())
        })?;
        output::wrote(&self.output, counted(count as usize, "world"));
        Ok(())
    }
}

const OUTPUT_REMOVED: &str = "incomplete output was removed";

/// Passes each world with its index to `take`, in order; draws a chunk at a time on all cores. `left` describes what remains
/// after an interrupt.
fn for_each_world(
    draw: &Draw,
    range: std::ops::Range<u64>,
    left: &str,
    mut take: impl FnMut(u64, World) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen(format!("interrupted; {left}"));
    let bar = output::progress(range.end - range.start, "sampling");
    let mut first = range.start;
    let mut chunk = 16;
    while first < range.end {
        let next = range.end.min(first.saturating_add(chunk));
        let mut objects = 0;
        let worlds: Vec<_> = (first..next).into_par_iter().map(draw).collect();
        for (index, world) in (first..next).zip(worlds) {
            let world = world?;
            objects += world.objects.len() as u64;
            take(index, world)?;
            if interrupt.is_cancelled() && index + 1 < range.end {
                let done = index + 1 - range.start;
                return Err(interrupt.failure(format!(
                    "interrupted after {done} of {} worlds; {left}",
                    range.end - range.start
                )));
            }
        }
        bar.inc(next - first);
        let objects_per_world = (objects / (next - first)).max(1);
        chunk = (MAX_CHUNK_OBJECTS / objects_per_world).clamp(4, MAX_CHUNK);
        first = next;
    }
    bar.finish_and_clear();
    Ok(())
}
