//! `driftworld play`: lets the user walk through a world with the keys of a terminal.

mod cells;
mod game;
mod keys;
mod terminal;

use std::fmt::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::env::{Renderer, RendererKind};
use crate::worlds::WorldRequest;
use clap::Args;
use driftworld_text::{ShownPath, printable};

use self::cells::Cells;
use self::game::Game;
use self::keys::Key;
use self::terminal::RawTerminal;
use super::assets::LibraryChoice;
use super::film_choice::{self, summary};
use super::interrupt::Interrupt;
use super::output;
use crate::Failure;

/// Interval for polling the keyboard and drawing.
const FRAME: Duration = Duration::from_millis(50);

/// Text of the last line.
const HELP: &str = "arrows or wasd: walk · space: use · v: view · r: restart · q: quit";

/// Walk through a world with the keys, in a terminal.
///
/// Arrows or wasd walk and turn, the space bar uses the object ahead, v changes the view, r restarts, q quits. The
/// world runs in real time; if none of its actions does nothing, it waits for keys.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld play find_objects#red
  driftworld play examples/worlds/key_corridor.json --seed 3 --record mine.jsonl
  driftworld replay mine.jsonl --episode 0 -o mine.gif")]
pub(crate) struct Play {
    #[command(flatten)]
    choice: WorldRequest,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Steps per second, at most 20 [default: real time].
    #[arg(long, value_name = "RATE", value_parser = rate)]
    fps: Option<f64>,
    /// Save the played episodes to this file, for `driftworld replay`.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Where to render: cpu, gpu, or auto (gpu if there is one).
    ///
    /// Natural looks are always drawn on the CPU.
    #[arg(long, default_value_t, value_name = "RENDERER")]
    renderer: RendererKind,
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| (0.1..=20.0).contains(rate));
    rate.ok_or_else(|| format!("found {text:?}, expected 0.1 to 20 steps per second"))
}

impl Play {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let world = self.choice.world(&|text| output::warning(text))?;
        let agent = &world.agent_params;
        let own = agent.time_step * f64::from(agent.frame_skip.max(1));
        let pace = self.fps.map_or(own, |rate| 1.0 / rate);
        let renderer = Renderer::new(self.renderer)?;
        let mut game = Game::new(world, self.choice.origin(), self.libraries.catalogue()?, renderer, pace);
        let interrupt = Interrupt::listen("interrupted");
        let terminal = RawTerminal::open()?;
        let played = play(&mut game, &terminal, &interrupt);
        drop(terminal);
        played?;
        let recordings = game.into_recordings();
        for recording in &recordings {
            output::line(summary(recording))?;
        }
        if let Some(path) = &self.record {
            film_choice::record(path, &recordings)?;
            output::line(format!("wrote {}", path.shown()))?;
        }
        Ok(())
    }
}

/// Plays until the user quits.
fn play(game: &mut Game, terminal: &RawTerminal, interrupt: &Interrupt) -> Result<(), Failure> {
    let start = Instant::now();
    let (mut before, mut status): (Option<Cells>, String) = (None, String::new());
    let mut size = None;
    let mut needs_drawing = true;
    for frame in 1.. {
        let now = start.elapsed().as_secs_f64();
        let Some(typed) = terminal.typed() else { return Ok(()) };
        for key in Key::all(&typed) {
            if key == Key::Quit {
                return Ok(());
            }
            needs_drawing |= game.press(key, now);
        }
        if interrupt.is_cancelled() {
            return Ok(());
        }
        needs_drawing |= game.advance(now)?;
        let dimensions = terminal_size::terminal_size().map_or((80, 24), |(columns, rows)| (columns.0, rows.0));
        if size.replace(dimensions) != Some(dimensions) {
            terminal.show("\x1b[0m\x1b[2J")?;
            (before, status, needs_drawing) = (None, String::new(), true);
        }
        if needs_drawing {
            // The last two lines are for text.
            let (columns, rows) = (
                usize::from(dimensions.0.clamp(2, 1000)),
                usize::from(dimensions.1.clamp(3, 500)) - 2,
            );
            let cells = Cells::new(&game.picture(columns as u32, 2 * rows as u32)?, columns, rows);
            let mut sent = cells.draw_over(before.as_ref());
            let new_status = game.status();
            if new_status != status {
                let line = |text: &str| printable(text).chars().take(columns).collect::<String>();
                let (first, second) = (rows + 1, rows + 2);
                // Writing into a string cannot fail.
                let _ = write!(
                    sent,
                    "\x1b[{first};1H\x1b[K{}\x1b[{second};1H\x1b[K\x1b[2m{}\x1b[0m",
                    line(&new_status),
                    line(HELP)
                );
                status = new_status;
            }
            terminal.show(&sent)?;
            (before, needs_drawing) = (Some(cells), false);
        }
        std::thread::sleep((FRAME * frame).saturating_sub(start.elapsed()));
    }
    Ok(())
}
