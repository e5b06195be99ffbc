//! `driftworld render`: draws pictures of a world, and sheets of several pictures.

use std::path::PathBuf;

use crate::env::{Catalogue, Environment, MAX_EXPERT_STEPS, Renderer, RendererKind};
use crate::spec::{Style, World};
use clap::{Args, ValueEnum};

use super::agent::AgentArg;
use super::assets::LibraryChoice;
use super::output;
use crate::Failure;
use crate::contact_sheet::paths;
use crate::episode_frames::{record_episode, rows};
use crate::film::{FilmModality, FilmOptions, FilmView};
use crate::report::picture::{Drawing, SheetRow, sheet};
use crate::views::Views;
use crate::worlds::WorldRequest;

/// Draw a world: the agent's view, from above, or an episode.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld render find_objects#dusk --seed 7 -o dusk.png
  driftworld render map.json --l2explorer --view overview --size 800 -o map.png
  driftworld render maze.json#small --view episode --frames 6 -o solved.png")]
pub(crate) struct Render {
    #[command(flatten)]
    choice: WorldRequest,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// The picture to draw.
    #[arg(long, value_enum, default_value_t = View::Sheet)]
    view: View,
    /// Height of each picture in pixels.
    #[arg(long, default_value_t = 360, value_parser = clap::value_parser!(u32).range(1..=4096))]
    size: u32,
    /// Turn the first-person camera clockwise from the agent's heading, in degrees.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = crate::numbers::degrees)]
    turn: f64,
    /// Number of frames of `--view episode` [default: 8].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=60))]
    frames: Option<u8>,
    /// The agent of `--view episode` [default: onrails].
    #[arg(long, value_name = "AGENT", help = AgentArg::HELP)]
    agent: Option<AgentArg>,
    /// Where to render: cpu, gpu, or auto (gpu if there is one).
    ///
    /// Maps and natural looks are always drawn on the CPU.
    #[arg(long, default_value_t, value_name = "RENDERER")]
    renderer: RendererKind,
    /// Draw depth, segmentation and the map without their legends, at exactly the requested size.
    #[arg(long)]
    plain: bool,
    /// PNG or SVG file to write.
    #[arg(short, long, default_value = "world.png", value_name = "FILE")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// Maximum number of pixels of all views of `--view episode` together; each takes about fifteen bytes of memory.
const MAX_EPISODE_PIXELS: u64 = 67_108_864;

/// Which picture of a world.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum View {
    /// All pictures, with titles.
    Sheet,
    /// From outside, above a corner.
    Overview,
    /// The map, north on top; also called above.
    #[value(alias = "above")]
    TopDown,
    /// The agent's view in colour.
    #[value(alias = "agent")]
    Rgb,
    /// The agent's view as distance, with a scale; white at 100 m with `--plain`.
    Depth,
    /// The agent's view as reward categories.
    Segmentation,
    /// The agent's view in plain and in natural looks, at 84, 160 and 640 pixels.
    Looks,
    /// An agent's episode, frame by frame: start, end, and what happened in between.
    Episode,
}

impl Render {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if self.view != View::Episode && (self.frames.is_some() || self.agent.is_some()) {
            return Err(Failure::usage(
                "--frames and --agent: found another view, expected --view episode",
            ));
        }
        let world = self.choice.world(&|text| output::warning(text))?;
        let catalogue = self.libraries.catalogue()?;
        warn(&world, &catalogue);
        output::write_and_report_picture(&self.output, &self.picture(&world, &catalogue)?)?;
        output::json_of_what_was_written(self.json)
    }

    fn picture(&self, world: &World, catalogue: &Catalogue) -> Result<Drawing, Failure> {
        let views = Views::with_catalogue(world, catalogue, self.size, self.turn as f32)
            .with_renderer(Renderer::new(self.renderer)?);
        Ok(match self.view {
            View::Overview => views.overview((self.size * 16 / 9).min(4096))?.into(),
            View::TopDown if self.plain => views.top_down().into(),
            View::TopDown => views.map_with_legend(&paths(world)?),
            View::Rgb => views.first_person()?.rgb.into(),
            View::Depth if self.plain => views.first_person()?.depth.into(),
            View::Depth => views.first_person()?.depth_with_legend(),
            View::Segmentation if self.plain => views.first_person()?.segmentation.into(),
            View::Segmentation => views.first_person()?.segmentation_with_legend(),
            View::Sheet => self.sheet(world, &views)?,
            View::Looks => self.looks(world, catalogue)?,
            View::Episode => self.episode(world, catalogue)?,
        })
    }

    /// The agent's view in both styles: large with smooth edges, and at the resolution of learners.
    fn looks(&self, world: &World, catalogue: &Catalogue) -> Result<Drawing, Failure> {
        let row = |style: Style, title: &str| -> Result<SheetRow, Failure> {
            let world = world.clone().edit(|draft| {
                let looks = &mut draft.environment_params.looks;
                looks.style = style;
            })?;
            let views = Views::with_catalogue(&world, catalogue, self.size, self.turn as f32)
                .with_renderer(Renderer::new(self.renderer)?);
            let large = views.smoothly([640, 360])?;
            let mut small = Drawing::blank(160, large.height);
            let mut top = 0;
            for side in [160, 84] {
                small.put(views.as_learners_see(side)?, [0, top]);
                top += side + 12;
            }
            let pictures: Vec<Drawing> = vec![large.into(), small];
            Ok(SheetRow::new(
                title,
                "640 × 360 pixels with smooth edges; 160 × 160 and 84 × 84 as learners see it",
                pictures,
            ))
        };
        let rows = [row(Style::Plain, "Plain")?, row(Style::Natural, "Natural")?];
        Ok(sheet(&rows, 1))
    }

    /// Frames of an agent's episode, two per row.
    fn episode(&self, world: &World, catalogue: &Catalogue) -> Result<Drawing, Failure> {
        let frames = u64::from(self.frames.unwrap_or(8));
        if frames * u64::from(self.size).pow(2) > MAX_EPISODE_PIXELS {
            return Err(Failure::usage(format!(
                "--frames {frames}: found {frames} views of {0} × {0} pixels, expected at most {MAX_EPISODE_PIXELS} pixels in all; \
                 give --size {1} or fewer --frames",
                self.size,
                (MAX_EPISODE_PIXELS / frames).isqrt()
            )));
        }
        let mut agent = self.agent.as_ref().unwrap_or(&AgentArg::Onrails).agent()?.agent;
        let recording = record_episode(world, catalogue, agent.as_mut(), 0, MAX_EXPERT_STEPS)?;
        let max_rows = usize::from(self.frames.unwrap_or(8));
        let options = FilmOptions {
            view: FilmView::Both,
            size: self.size,
            modality: FilmModality::Rgb,
            fps: None,
            every: 1,
            captions: true,
            renderer: self.renderer,
        };
        Ok(sheet(&rows(&recording, catalogue, &options, max_rows)?, 2))
    }

    fn sheet(&self, world: &World, views: &Views) -> Result<Drawing, Failure> {
        let small = views.with_size((self.size * 2 / 3).max(1));
        let seen = views.first_person()?;
        let close_ups = small.close_ups(5)?;
        let (classes, close_ups): (Vec<String>, Vec<Drawing>) = close_ups
            .into_iter()
            .map(|(class, picture)| (class, picture.into()))
            .unzip();
        let mut rows = vec![
            SheetRow::new(
                "The world",
                "from outside, and from above: the arrow is the agent, small things are drawn larger",
                vec![
                    views.overview((self.size * 16 / 9).min(4096))?.into(),
                    views.map_with_legend(&paths(world)?),
                ],
            ),
            SheetRow::new(
                "What the agent sees",
                "colour, depth, reward category",
                vec![
                    seen.rgb.clone().into(),
                    seen.depth_with_legend(),
                    seen.segmentation_with_legend(),
                ],
            ),
            SheetRow::new(
                "All around the agent",
                "ahead, right, behind, left; 90° each",
                small.all_around()?.into_iter().map(Into::into).collect(),
            ),
        ];
        if !close_ups.is_empty() {
            rows.push(SheetRow::new("Objects in the world", classes.join(", "), close_ups));
        }
        Ok(sheet(&rows, 1))
    }
}

/// Maximum number of warnings that are printed.
const MAX_WARNINGS: usize = 10;

/// Warns about parts of the world that may surprise its author.
fn warn(world: &World, catalogue: &Catalogue) {
    let warnings = Environment::with_catalogue(world.clone(), catalogue.clone()).warnings();
    for warning in warnings.iter().take(MAX_WARNINGS) {
        output::warning(warning.to_string());
    }
    if warnings.len() > MAX_WARNINGS {
        output::note(format!("warning: and {} more", warnings.len() - MAX_WARNINGS));
    }
}
