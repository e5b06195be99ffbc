//! `driftworld sheet`: one picture of many variants, or of a curriculum.

use std::path::{Path, PathBuf};

use crate::spec::{BlockKind, Regime, Scenario, Value, Variant};
use crate::tasks;
use clap::Args;
use driftworld_text::ShownPath;

use super::output;
use crate::Failure;
use crate::contact_sheet::{Item, Options, contact_sheet};
use crate::contents::Contents;
use crate::documents;
use crate::scenarios::is_original;
use crate::sheet_words::Worlds;

/// Maximum number of variants in one picture.
const MAX_VARIANTS: usize = 60;

/// Draw a world of each of several variants in one picture.
///
/// Each is seen from the agent's view and from above.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld sheet get_to_goal -o goal.png
  driftworld sheet find_objects#blue find_objects#dusk --seed 7 --columns 1 -o two.png
  driftworld sheet --scenario examples/curricula/reward.json -o reward.png")]
pub(crate) struct Sheet {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(
        value_name = "TASK",
        required_unless_present = "scenario",
        conflicts_with = "scenario"
    )]
    tasks: Vec<String>,
    /// Draw the variants that this scenario learns, in order.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Seed of the worlds [default: 0; in a scenario, each block's own].
    #[arg(long, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: Option<u64>,
    /// Index of each variant's world [default: whichever of the first few shows most of what the variants are about].
    #[arg(long)]
    index: Option<u64>,
    /// Turn the first-person cameras clockwise from the agent's heading, in degrees [default: whichever shows most].
    #[arg(long, allow_negative_numbers = true, value_parser = crate::numbers::degrees)]
    turn: Option<f64>,
    /// Height of each picture in pixels.
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(32..=480))]
    size: u32,
    /// Number of variants per row.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=8))]
    columns: u8,
    /// PNG or SVG file to write.
    #[arg(short, long, default_value = "sheet.png", value_name = "FILE")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

impl Sheet {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let mut variants = match &self.scenario {
            Some(file) => learned(file)?,
            None => tasks::variants_of(&self.tasks)?
                .into_iter()
                .map(|(_, variant)| Item::declared(variant, 0))
                .collect(),
        };
        if let Some(seed) = self.seed {
            for shown in &mut variants {
                shown.seed = seed;
            }
        }
        if variants.is_empty() || variants.len() > MAX_VARIANTS {
            return Err(Failure::input(format!(
                "found {} variants, expected 1 to {MAX_VARIANTS} in one picture; name some as TASK#VARIANT",
                variants.len()
            )));
        }
        let look = Options {
            index: self.index,
            turn: self.turn.map(|degrees| degrees as f32),
            size: self.size,
            columns: usize::from(self.columns),
        };
        let bar = output::progress(variants.len() as u64, "drawing");
        let drawing = contact_sheet(&variants, look, &|| bar.inc(1))?;
        bar.finish_and_clear();
        output::write_and_report_picture(&self.output, &drawing)?;
        output::json_of_what_was_written(self.json)
    }
}

/// A regime's variant with its caption: the description of a declared variant, or the values of one that the scenario defines.
fn shown_regime<'a>(
    variant: Variant,
    values: impl IntoIterator<Item = (&'a String, &'a Value)>,
    regime: &Regime,
    index: u64,
) -> Item {
    let listed: Vec<String> = values
        .into_iter()
        .map(|(name, value)| format!("{name} {value}"))
        .collect();
    let declared = Item::declared(variant, regime.seed);
    Item {
        words: if listed.is_empty() {
            declared.words
        } else {
            listed.join(", ")
        },
        index,
        count: u64::from(regime.count),
        worlds: Worlds::OfScenario,
        ..declared
    }
}

/// The variants learned in a scenario, in order and including repeats; both ends of a drift.
fn learned(file: &Path) -> Result<Vec<Item>, Failure> {
    let text = documents::text_of(file, &[Contents::Scenario])?;
    if is_original(&text) {
        return Err(Failure::input(format!(
            "{}: found a scenario of L2Explorer, which uses map files, expected one of Driftworld; draw its maps with \
             driftworld render --l2explorer",
            file.shown()
        )));
    }
    let scenario = Scenario::from_json(&file.display().to_string(), &text)?;
    let mut shown = Vec::new();
    for (number, block) in scenario.blocks.iter().enumerate() {
        if block.kind != BlockKind::Learning {
            continue;
        }
        for regime in &block.regimes {
            if let Some(world) = &regime.world {
                return Err(Failure::input(format!(
                    "{}: block {number}: found the world file {world}, expected variants of tasks; draw it with \
                     driftworld render",
                    file.shown()
                )));
            }
            let task = tasks::task(&regime.task)?;
            shown.push(shown_regime(
                regime.resolve(&task)?,
                &regime.values,
                regime,
                regime.first_index,
            ));
            let end_task = tasks::task(regime.end_task())?;
            if let (Some(end), Some(drift)) = (regime.resolve_end(&end_task)?, &regime.drift) {
                let last = regime.first_index + u64::from(regime.count) - 1;
                shown.push(Item {
                    count: 1,
                    worlds: Worlds::EndOfDrift,
                    ..shown_regime(end, &drift.values, regime, last)
                });
            }
        }
    }
    Ok(shown)
}
