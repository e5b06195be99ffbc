//! [`film`]: plays a recorded episode as a sequence of pictures. [`write_film`] writes it to a file.

use std::path::Path;

use clap::{ArgAction, Args, ValueEnum};
use driftworld_env::{Catalogue, Environment, Recording, Renderer, RendererKind, Replay};
use driftworld_report::film::{Film, FilmKind};
use driftworld_report::picture::{Picture, caption_lines, sheet};
use driftworld_text::ShownPath;
use serde::Serialize;

use crate::episode_frames::{events_of, facts, first_person, map_of, rows};
use crate::map_drawing::map_size;
use crate::{Failure, argument, output_file};

/// Largest width and height of the agent's view, and of the map, in pixels.
pub const MAX_FILM_SIZE: u32 = 2048;

/// Narrower frames have no captions, which would be cut off and taller than the picture.
const MIN_CAPTIONED_WIDTH: u32 = 100;

/// Rows of a sheet.
const SHEET_ROWS: usize = 12;

/// The viewpoint of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilmView {
    /// What the agent sees.
    #[value(alias = "rgb")]
    Agent,
    /// The map, with the path so far.
    #[value(alias = "top-down")]
    Above,
    /// Both, side by side.
    Both,
}

/// The modality of the agent's view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilmModality {
    /// Colours.
    Rgb,
    /// Distance, white at 100 m.
    Depth,
    /// Reward categories.
    Segmentation,
}

/// Parses a word.
///
/// # Errors
/// If the word is unknown; the message lists the expected words.
pub fn named<T: ValueEnum>(word: &str) -> Result<T, String> {
    T::from_str(word, false).map_err(|_| {
        let words = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        let words: Vec<String> = words.map(|word| word.get_name().to_owned()).collect();
        format!("found {word:?}, expected one of {}", words.join(", "))
    })
}

/// How an episode is filmed.
#[derive(Clone, Debug, Args)]
pub struct FilmOptions {
    /// What is shown: what the agent sees, the map from above, or both side by side.
    #[arg(long, value_enum, default_value_t = FilmView::Both)]
    pub view: FilmView,
    /// Height of the pictures in pixels.
    // 1 to MAX_FILM_SIZE. The map has its arena's aspect ratio.
    #[arg(long, default_value_t = 240, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FILM_SIZE)))]
    pub size: u32,
    /// What the agent's view shows; the map has no modalities.
    #[arg(long, value_enum, default_value_t = FilmModality::Rgb)]
    pub modality: FilmModality,
    /// Frames per second [default: the film plays in simulated time].
    ///
    /// At most 50 in a GIF, 100 in an APNG: viewers show no more.
    #[arg(long, value_name = "RATE", value_parser = rate)]
    pub fps: Option<f64>,
    /// Number of steps per frame.
    // At least 1. The start and the end are always shown.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub every: u32,
    /// Leave out the line above the pictures: time, return, carried objects, events.
    // Without captions, a sheet shows only the step. Frames of a film that are narrower than 100 pixels have none.
    #[arg(long = "no-captions", action = ArgAction::SetFalse)]
    pub captions: bool,
    /// Where to render: cpu, gpu, or auto (gpu if there is one).
    ///
    /// Natural looks are always drawn on the CPU.
    #[arg(long, default_value_t, value_name = "RENDERER")]
    pub renderer: RendererKind,
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| (0.01..=1000.0).contains(rate));
    rate.ok_or_else(|| format!("found {text:?}, expected 0.01 to 1000 frames per second"))
}

/// A summary of a film.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FilmSummary {
    /// Frames.
    pub frames: u32,
    /// Frame width in pixels.
    pub width: u32,
    /// Frame height in pixels.
    pub height: u32,
    /// Duration in seconds; 0 for a sheet.
    pub seconds: f64,
    /// Width and height of the sheet in pixels, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheet: Option<[u32; 2]>,
}

impl FilmOptions {
    /// Number of frames for an episode with this number of steps.
    pub fn num_frames(&self, steps: usize) -> usize {
        1 + steps.div_ceil(self.every.max(1) as usize)
    }

    /// Whether there is a frame after `number` steps of an episode with `last` steps.
    fn shows(&self, number: usize, last: usize) -> bool {
        number.is_multiple_of(self.every as usize) || number == last
    }

    /// Width of a frame in pixels.
    fn width(&self, environment: &Environment) -> u32 {
        let map = map_size(environment.scene(), self.size)[0];
        match self.view {
            FilmView::Agent => self.size,
            FilmView::Above => map,
            FilmView::Both => self.size + map,
        }
    }

    /// Refuses impossible or meaningless combinations of options.
    ///
    /// # Errors
    /// [`Failure`] that names the option and says what to do.
    pub fn check(&self) -> Result<(), Failure> {
        if !(1..=MAX_FILM_SIZE).contains(&self.size) || self.every < 1 {
            return Err(Failure::usage(format!(
                "film: found size {} and every {}, expected a size of 1 to {MAX_FILM_SIZE} pixels, and every at least 1",
                self.size, self.every
            )));
        }
        if self.view == FilmView::Above && self.modality != FilmModality::Rgb {
            let word = self.modality.to_possible_value();
            return Err(Failure::usage(format!(
                "{modality}: found {} for the view from above, expected a view that includes the agent's, as maps have no \
                 modalities; leave {modality} out, or set {view} to agent or both",
                word.as_ref().map_or("one", |word| word.get_name()),
                modality = argument("modality"),
                view = argument("view"),
            )));
        }
        Ok(())
    }

    /// Pictures of the current state of an episode: the agent's view, rendered only if shown, and the map with the path.
    pub(crate) fn pictures(
        &self,
        environment: &mut Environment,
        path: &[[f32; 2]],
        seen: &mut dyn FnMut(&mut Environment) -> Result<Picture, Failure>,
    ) -> Result<Vec<Picture>, Failure> {
        let mut pictures = Vec::new();
        if self.view != FilmView::Above {
            pictures.push(seen(environment)?);
        }
        if self.view != FilmView::Agent {
            pictures.push(map_of(environment, map_size(environment.scene(), self.size), path));
        }
        Ok(pictures)
    }
}

/// Replays an episode and passes each frame to `take`, with the number of steps before it; then checks that the result
/// is as recorded.
///
/// # Errors
/// [`Failure`] if a step is no longer possible, the reward or ending differs from the recording, or `take` fails.
pub fn film(
    recording: &Recording,
    catalogue: &Catalogue,
    options: &FilmOptions,
    take: &mut dyn FnMut(Picture, usize) -> Result<(), Failure>,
) -> Result<(), Failure> {
    options.check()?;
    let mut replay = Replay::new(recording, catalogue);
    let captions = if options.captions && options.width(replay.environment()) >= MIN_CAPTIONED_WIDTH {
        Captions::of(&mut replay, recording, options)?
    } else {
        Captions::default()
    };
    replay.restart();
    replay.environment().set_renderer(Renderer::new(options.renderer)?);
    let mut path = vec![replay.environment().agent().position];
    let mut captioned = |replay: &mut Replay<'_>, path: &[[f32; 2]], number: usize| {
        let frame = frame(replay.environment(), options, path)?;
        take(captions.above(frame, number), number)
    };
    captioned(&mut replay, &path, 0)?;
    while replay.step()?.is_some() {
        let number = replay.num_steps();
        path.push(replay.environment().agent().position);
        if options.shows(number, recording.actions.len()) {
            captioned(&mut replay, &path, number)?;
        }
    }
    Ok(replay.check()?)
}

/// The captions above the frames of a film. They are computed before the first frame, because every frame leaves room for the
/// longest.
#[derive(Default)]
struct Captions {
    /// By the number of steps before the frame, ascending.
    of_frames: Vec<(usize, Vec<String>)>,
    num_lines: usize,
}

impl Captions {
    /// Replays an episode from its start, without pictures, to collect its captions.
    fn of(replay: &mut Replay<'_>, recording: &Recording, options: &FilmOptions) -> Result<Self, Failure> {
        let last = recording.actions.len();
        let steps_per_second = (1.0 / recording.seconds_per_step()).ceil() as usize;
        let mut of_frames = vec![(0, facts(replay.environment(), None))];
        // The last step with events, and its number.
        let mut last_event: Option<(Vec<String>, usize)> = None;
        while let Some(step) = replay.step()? {
            let number = replay.num_steps();
            let environment = replay.environment();
            let events = events_of(environment.world(), &step).words;
            if !events.is_empty() {
                last_event = Some((events, number));
            }
            if options.shows(number, last) {
                let mut caption = facts(environment, (number == last).then_some(&step));
                if let Some((events, when)) = &last_event
                    && number - when <= steps_per_second
                {
                    caption.extend(events.iter().cloned());
                }
                of_frames.push((number, caption));
            }
        }
        let width = options.width(replay.environment());
        let lines = of_frames.iter().map(|(_, caption)| caption_lines(caption, width).len());
        Ok(Self {
            num_lines: lines.max().unwrap_or(0),
            of_frames,
        })
    }

    /// The frame after this number of steps, with its caption.
    fn above(&self, frame: Picture, number: usize) -> Picture {
        match self.of_frames.binary_search_by_key(&number, |(number, _)| *number) {
            Ok(place) => frame.captioned(&self.of_frames[place].1, self.num_lines),
            Err(_) => frame,
        }
    }
}

fn frame(environment: &mut Environment, options: &FilmOptions, path: &[[f32; 2]]) -> Result<Picture, Failure> {
    let pictures = options.pictures(environment, path, &mut |environment| first_person(environment, options))?;
    let mut frame = Picture::blank(options.width(environment), options.size);
    let mut left = 0;
    for picture in &pictures {
        frame.paste(picture, left, 0);
        left += picture.width;
    }
    Ok(frame)
}

/// The kind of film by the file's extension; `None` for a single picture of the important frames.
fn film_kind(path: &Path) -> Result<Option<FilmKind>, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let kind = FilmKind::of_ending(ending);
    if kind.is_some() || ending.eq_ignore_ascii_case("png") {
        return Ok(kind);
    }
    let advice = if ["mp4", "webm", "mkv", "mov"]
        .iter()
        .any(|video| ending.eq_ignore_ascii_case(video))
    {
        format!("; write an .apng, and make a video of it: ffmpeg -i e.apng -pix_fmt yuv420p e.{ending}")
    } else {
        String::new()
    };
    Err(Failure::usage(format!(
        "{}: found a name that ends in {ending:?}, expected .gif or .apng for a film, or .png for a sheet of its frames{advice}",
        path.shown()
    )))
}

/// Refuses a file name without the extension of a film or a sheet.
///
/// # Errors
/// [`Failure`] that lists the accepted extensions.
pub fn expect_film(path: &Path) -> Result<(), Failure> {
    film_kind(path).map(drop)
}

/// Writes an episode as a film (`.gif`, `.apng`), or as one picture of the important frames (`.png`). Without `fps` it plays in
/// simulated time, but no faster than viewers show. `watch` gets the number of finished frames.
///
/// # Errors
/// As [`film`], and if the file cannot be written. No file is left after an error.
pub fn write_film(
    path: &Path,
    recording: &Recording,
    catalogue: &Catalogue,
    options: &FilmOptions,
    watch: &mut dyn FnMut(u64),
) -> Result<FilmSummary, Failure> {
    options.check()?;
    let Some(kind) = film_kind(path)? else {
        return write_sheet(path, recording, catalogue, options);
    };
    let num_frames = options.num_frames(recording.actions.len()) as u32;
    let own = recording.seconds_per_step() * f64::from(options.every);
    let seconds = options.fps.map_or(own, |rate| 1.0 / rate).max(kind.shortest());
    let mut file = output_file::create(path)?;
    let mut writer = None;
    let mut summary = FilmSummary::default();
    let last = recording.actions.len();
    let mut to = Some(&mut file);
    film(recording, catalogue, options, &mut |picture, number| {
        let size = [picture.width, picture.height];
        if let Some(to) = to.take() {
            (summary.width, summary.height) = (size[0], size[1]);
            writer = Some(Film::new(kind, std::io::BufWriter::new(to), size, num_frames)?);
        }
        // The last frame is shown for longer.
        let shown = if number == last { seconds.max(1.0) } else { seconds };
        if let Some(writer) = &mut writer {
            writer.add(&picture, shown)?;
        }
        summary.frames += 1;
        summary.seconds += shown;
        watch(u64::from(summary.frames));
        Ok(())
    })?;
    writer.map_or(Ok(()), Film::finish)?;
    file.commit().map_err(|error| output_file::unwritable(path, &error))?;
    Ok(summary)
}

fn write_sheet(
    path: &Path,
    recording: &Recording,
    catalogue: &Catalogue,
    options: &FilmOptions,
) -> Result<FilmSummary, Failure> {
    let rows = rows(recording, catalogue, options, SHEET_ROWS)?;
    let mut replay = Replay::new(recording, catalogue);
    while replay.step()?.is_some() {}
    replay.check()?;
    let picture = sheet(&rows, 2);
    output_file::write_picture(path, &picture)?;
    Ok(FilmSummary {
        frames: rows.len() as u32,
        width: options.width(replay.environment()),
        height: options.size,
        seconds: 0.0,
        sheet: Some([picture.width, picture.height]),
    })
}
