//! `driftworld sheet`: one picture of many variants, or of a curriculum. Pictures of one world are `render`'s.

use std::path::PathBuf;

use clap::Args;
use driftworld::generator::Sampler;
use driftworld::spec::{BlockKind, Regime, Scenario, Variant};
use driftworld::tasks;

use super::pictures::{SheetRow, sheet};
use super::render::Views;
use super::{Failure, input, output};

/// The most variants that one picture shows.
const MOST_VARIANTS: usize = 60;

/// Draw one world of each of many variants: what the agent sees, and the world from above.
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
    /// The variants that a scenario learns, in its order, in place of variants.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// The seed of the worlds.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The number of each variant's world.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// Turn the first-person cameras this many degrees clockwise from the agent's heading.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    turn: f64,
    /// Height of each picture in pixels.
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(32..=480))]
    size: u32,
    /// How many variants stand side by side.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=8))]
    columns: u8,
    /// The PNG file.
    #[arg(short, long, default_value = "sheet.png", value_name = "FILE")]
    output: PathBuf,
}

impl Sheet {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let variants = match &self.scenario {
            Some(file) => {
                let scenario = Scenario::from_json(&file.display().to_string(), &input::text(file)?)?;
                learned(&scenario)?
            }
            None => input::variants(&self.tasks)?
                .into_iter()
                .map(|(_, variant)| variant)
                .collect(),
        };
        if variants.is_empty() || variants.len() > MOST_VARIANTS {
            return Err(Failure::input(format!(
                "found {} variants, expected 1 to {MOST_VARIANTS} for one picture; name some as TASK#VARIANT",
                variants.len()
            )));
        }
        let bar = output::progress(variants.len() as u64, "drawing");
        let row = |variant: &Variant| {
            bar.inc(1);
            self.row(variant)
        };
        let rows = variants.iter().map(row).collect::<Result<Vec<_>, _>>()?;
        bar.finish_and_clear();
        sheet(&rows, usize::from(self.columns))?.write_and_tell(&self.output)
    }

    fn row(&self, variant: &Variant) -> Result<SheetRow, Failure> {
        let world = Sampler::new(variant, self.seed).world(self.index)?;
        let views = Views::new(&world, self.size, self.turn as f32);
        Ok(SheetRow {
            title: variant.id(),
            words: variant
                .task()
                .variant_description(variant.name())
                .unwrap_or_default()
                .to_owned(),
            pictures: vec![views.first_person()?.rgb, views.top_down()],
        })
    }
}

/// The variants that a scenario learns, each as often as it comes.
fn learned(scenario: &Scenario) -> Result<Vec<Variant>, Failure> {
    let learning = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    let regimes = learning.flat_map(|block| &block.regimes);
    let variant = |regime: &Regime| Ok(regime.resolve(&tasks::task(&regime.task)?)?);
    regimes.map(variant).collect()
}
