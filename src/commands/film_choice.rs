//! The options that say how an episode is filmed, and the file that it is written to. What a frame shows is `film`'s.

use std::path::Path;

use crate::Failure;
use crate::env::{Catalogue, Recording, RendererKind};
use crate::film::{FilmModality, FilmOptions, FilmSummary, FilmView, MAX_FILM_SIZE, write_film};
use clap::Args;
use driftworld_text::{ShownPath, amount};

use super::output;

/// How an episode is filmed.
#[derive(Args)]
pub(crate) struct FilmChoice {
    /// What is shown: what the agent sees, the map from above, or both side by side.
    #[arg(long, value_enum, default_value_t = FilmView::Both)]
    view: FilmView,
    /// Height of the pictures in pixels.
    #[arg(long, default_value_t = 240, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FILM_SIZE)))]
    size: u32,
    /// What the agent's view shows; the map has no modalities.
    #[arg(long, value_enum, default_value_t = FilmModality::Rgb)]
    modality: FilmModality,
    /// Frames per second [default: the world's own time].
    ///
    /// At most 50 in a GIF, 100 in an APNG: viewers show no more.
    #[arg(long, value_name = "RATE", value_parser = rate)]
    fps: Option<f64>,
    /// One frame for so many steps.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    every: u32,
    /// Leave out the line above the pictures: time, return, what is carried, what happened.
    #[arg(long)]
    no_captions: bool,
    /// Where to render: cpu, gpu, or auto (gpu if there is one).
    ///
    /// Natural looks are always drawn on the CPU.
    #[arg(long, default_value_t, value_name = "RENDERER")]
    renderer: RendererKind,
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| (0.01..=1000.0).contains(rate));
    rate.ok_or_else(|| format!("found {text:?}, expected 0.01 to 1000 frames per second"))
}

impl FilmChoice {
    fn options(&self) -> FilmOptions {
        FilmOptions {
            view: self.view,
            modality: self.modality,
            size: self.size,
            every: self.every,
            captions: !self.no_captions,
            renderer: self.renderer,
        }
    }

    /// Refuses options of which one means nothing beside another.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.options().check()
    }

    /// Writes the film, with a bar on a terminal.
    pub(crate) fn write(
        &self,
        path: &Path,
        recording: &Recording,
        catalogue: &Catalogue,
    ) -> Result<FilmSummary, Failure> {
        let options = self.options();
        let bar = output::progress(options.num_frames(recording.actions.len()) as u64, "filming");
        let written = write_film(path, recording, catalogue, &options, self.fps, &mut |done| {
            bar.set_position(done);
        });
        bar.finish_and_clear();
        written
    }
}

/// Says which file was written, and what it is.
pub(crate) fn tell(path: &Path, film: &FilmSummary) -> Result<(), Failure> {
    let FilmSummary {
        frames,
        width,
        height,
        seconds,
        sheet,
    } = film;
    let more = match sheet {
        Some([wide, high]) => format!(", on a sheet of {wide} × {high}"),
        None => format!(", {seconds:.1} s"),
    };
    output::line(format!(
        "wrote {}: {frames} frames of {width} × {height} pixels{more}",
        path.shown()
    ))
}

/// What an episode came to.
pub(crate) fn summary(recording: &Recording) -> String {
    let origin = &recording.origin;
    let world = match (&origin.task, &origin.variant, origin.seed, origin.index) {
        (Some(task), Some(variant), Some(seed), Some(index)) => {
            format!("{task}#{variant}, world {index} under seed {seed}: ")
        }
        (Some(task), Some(variant), ..) => format!("{task}#{variant}: "),
        (Some(world), None, ..) => format!("{world}: "),
        _ => String::new(),
    };
    let ended = recording
        .ended_by
        .map_or_else(|| "no end".to_owned(), |word| format!("ended by {}", word.word()));
    let steps = match recording.actions.len() {
        1 => "1 step".to_owned(),
        steps => format!("{steps} steps"),
    };
    format!("{world}{steps}, reward {}, {ended}", amount(recording.reward))
}
