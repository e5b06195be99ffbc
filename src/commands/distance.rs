//! `driftworld distance`: how far apart two variants or two worlds are, element by element. The measures are `similarity`'s.

mod pictures;

use clap::Args;
use driftworld::similarity::{Distance as Measured, Weights, variant_distance, world_distance};
use driftworld::spec::Element;
use driftworld::tasks;

use super::table::table;
use super::{Failure, input, output};

/// Measure how far apart two variants or two worlds are.
///
/// Two variants of one task are compared parameter by parameter; world files, and variants of different tasks, are
/// compared as worlds: what stands where, what it pays, how it looks.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld distance find_objects#blue find_objects#dusk --explain
  driftworld distance find_objects#blue find_objects#dusk --pictures
  driftworld distance a.json b.json --json")]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub(crate) struct Distance {
    /// A task's variant, or a world file.
    a: String,
    /// Another.
    b: String,
    /// Compare how worlds look to an agent in them, by pictures from the same places.
    #[arg(long, conflicts_with = "explain")]
    pictures: bool,
    /// Show every part: what was compared, how, and its share.
    #[arg(long)]
    explain: bool,
    /// Compare worlds even where both are variants of one task.
    #[arg(long)]
    worlds: bool,
    /// The seed, where worlds are drawn from variants.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The number of the worlds, where they are drawn from variants.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Distance {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if self.pictures {
            let world = |name: &str| input::world(name, self.seed, self.index, false);
            let (a, b) = (world(&self.a)?, world(&self.b)?);
            return pictures::run([&self.a, &self.b], [&a, &b], self.json);
        }
        let (distance, how) = self.measure()?;
        if self.json {
            return output::json(&distance);
        }
        output::line(format!("{} to {}, {how}\n", self.a, self.b))?;
        output::line(by_element(&distance))?;
        if self.explain {
            output::line("")?;
            output::line(parts(&distance))?;
        }
        Ok(())
    }

    fn measure(&self) -> Result<(Measured, &'static str), Failure> {
        let weights = Weights::default();
        let is_world = [&self.a, &self.b].map(|name| input::is_world_file(name));
        if is_world == [false, false] && !self.worlds {
            let (a, b) = (tasks::variant(&self.a)?, tasks::variant(&self.b)?);
            if a.task().name() == b.task().name() {
                return Ok((variant_distance(&a, &b, &weights)?, "parameter by parameter"));
            }
        }
        let world = |name: &str| input::world(name, self.seed, self.index, false);
        Ok((
            world_distance(&world(&self.a)?, &world(&self.b)?, &weights),
            "world to world",
        ))
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

fn parts(distance: &Measured) -> String {
    let rows = distance.parts.iter().map(|part| {
        [
            part.name.clone(),
            part.element.letter().to_owned(),
            part.measure.to_string(),
            format!("{:.4}", part.raw),
            format!("{:.4}", part.normalised),
            format!("{}", part.weight),
        ]
    });
    table(
        ["what", "element", "measure", "raw", "normalised", "weight"],
        rows.collect(),
        &[3, 4, 5],
    )
}
