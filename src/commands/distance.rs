//! `driftworld distance`: how far apart two variants or two worlds are, element by element. The measures are `similarity`'s.

mod pictures;

use crate::distances::{Sample, Side, between};
use crate::similarity::{Distance as Measured, Part};
use crate::spec::Element;
use crate::tasks;
use clap::Args;
use driftworld_text::one_line;

use serde_json::json;

use super::weights::WeightArgs;
use crate::{Failure, worlds};

use super::output;
use crate::table::table;

/// Measure how far apart two variants or two worlds are.
///
/// Two variants of one task are compared parameter by parameter, at the weights and by the measures that the task declares.
/// Variants of different tasks are compared by worlds drawn from each under one seed, world files as they are: what stands
/// where, what it pays, how it looks. All distances are in 0 to 1.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld distance find_objects#blue find_objects#dusk --explain
  driftworld distance find_objects#blue find_objects#dusk --pictures
  driftworld distance find_objects#blue get_to_goal#plain --explain --worlds 64
  driftworld distance a.json b.json --json")]
pub(crate) struct Distance {
    /// A task's variant, or a world file.
    a: String,
    /// Another.
    b: String,
    /// Compare how worlds look to an agent in them, by pictures from the same places.
    #[arg(long, conflicts_with_all = ["explain", "worlds", "WeightArgs"])]
    pictures: bool,
    /// Show every part: what was compared, by which measure and how, its number, what it weighs, its share of the whole.
    #[arg(long)]
    explain: bool,
    /// Compare so many worlds of each even where both are variants of one task; 16 of each are compared where they are not.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000), num_args = 0..=1, default_missing_value = "16")]
    worlds: Option<u64>,
    /// The seed, where worlds are drawn from variants.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The number of the first world, where they are drawn from variants.
    #[arg(long, default_value_t = 0)]
    index: u64,
    #[command(flatten)]
    weights: WeightArgs,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Distance {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if self.pictures {
            let world = |name: &str| worlds::world(name, self.seed, self.index, false, &|text| output::warning(text));
            let (a, b) = (world(&self.a)?, world(&self.b)?);
            return pictures::run([&self.a, &self.b], [&a, &b], self.json);
        }
        let (distance, how) = self.measure()?;
        if self.json {
            let mut found = serde_json::to_value(&distance)?;
            found["compared"] = json!(how);
            return output::json(&found);
        }
        output::line(format!("{} to {}, {how}\n", one_line(&self.a), one_line(&self.b)))?;
        output::line(by_element(&distance))?;
        if self.explain {
            output::line("")?;
            output::line(parts(&distance))?;
        }
        Ok(())
    }

    fn measure(&self) -> Result<(Measured, String), Failure> {
        let sample = Sample {
            worlds: self.worlds,
            seed: self.seed,
            index: self.index,
        };
        let (a, b) = (self.side(&self.a)?, self.side(&self.b)?);
        Ok(between(&a, &b, &sample, |declared| self.weights.over(declared))?)
    }

    fn side(&self, name: &str) -> Result<Side, Failure> {
        worlds::expect_world_or_task(name)?;
        if worlds::is_world_file(name) {
            let world = worlds::world(name, self.seed, self.index, false, &|text| output::warning(text))?;
            Ok(Side::World(Box::new(world)))
        } else {
            Ok(Side::Variant(tasks::variant(name)?))
        }
    }
}

fn by_element(distance: &Measured) -> String {
    let mut rows: Vec<[String; 2]> = Element::ALL
        .iter()
        .filter_map(|element| {
            let value = distance.element(*element)?;
            Some([
                format!("{} {}", element.letter(), element.name()),
                format!("{value:.4}"),
            ])
        })
        .collect();
    rows.push(["all together".to_owned(), format!("{:.4}", distance.total)]);
    table(["element", "distance"], rows, &[1])
}

/// Every part, those that matter most first.
fn parts(distance: &Measured) -> String {
    let mut parts: Vec<&Part> = distance.parts.iter().collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let row = |part: &Part| {
        [
            part.name.clone(),
            part.element.letter().to_owned(),
            part.measure.to_string(),
            part.method
                .map_or_else(|| "of the values".to_owned(), |method| method.to_string()),
            format!("{:.4}", part.raw),
            format!("{:.4}", part.normalised),
            format!("{}", part.weight),
            format!("{:.1}%", 100.0 * part.share),
        ]
    };
    table(
        [
            "what",
            "element",
            "measure",
            "found",
            "raw",
            "normalised",
            "weight",
            "share",
        ],
        parts.into_iter().map(row).collect(),
        &[4, 5, 6, 7],
    )
}
