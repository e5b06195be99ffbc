//! `driftworld distance`: the distance between two variants or two worlds, element by element.

use crate::distances::{By, Compared, Sample, Scale, Side, between};
use crate::similarity::{Distance as Measured, Part};
use crate::spec::{Element, maps::MapLibrary};
use crate::tasks;
use clap::Args;
use driftworld_text::one_line;

use serde_json::json;

use super::assets::LibraryChoice;
use super::weights::WeightArgs;
use crate::{Failure, worlds};

use super::output;
use crate::table::table;

/// Measure the distance between two variants or two worlds.
///
/// Two variants of one task are compared as the task declares, by default by parameters, with the task's own weights
/// and measures. Variants of different tasks are compared by worlds drawn under one seed, and world files directly:
/// where objects are, what they pay, how they look. --by selects something else to compare by.
///
/// A distance is a sum. By parameters, 1 is one parameter moved over its whole range. By anything else, each part has
/// its own unit. See docs/similarity.md.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld distance find_objects#blue dusk --explain
  driftworld distance find_objects#blue find_objects#dusk --by pictures --explain
  driftworld distance get_to_goal#plain get_to_goal#soft --by rewards
  driftworld distance find_objects#red find_objects#blue --by behavior
  driftworld distance find_objects#blue get_to_goal#plain --explain --worlds 64
  driftworld distance a.json b.json --json")]
pub(crate) struct Distance {
    /// A variant of a task, or a world file.
    a: String,
    /// The other variant or world file. A variant of the same task may be named without it.
    b: String,
    /// What to compare by: parameters, worlds, pictures, occupancy, placements, objects, colors, rewards, dynamics or
    /// behavior.
    ///
    /// Some have several measures, such as occupancy:jaccard or dynamics:bisimulation; docs/similarity.md lists them. The
    /// default is what the task of both variants declares (parameters if it declares nothing), and worlds for anything else.
    #[arg(long, value_parser = By::from_name, value_name = "MEASURE")]
    by: Option<By>,
    /// Show every component with its measure, value, weight and share of the total.
    #[arg(long)]
    explain: bool,
    /// Compare this many worlds of each variant.
    ///
    /// Without it, variants of one task are compared as the task declares, and anything else by 16 worlds of each. By
    /// pictures and dynamics, the default is 4 worlds of each; by placements, 64.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000), num_args = 0..=1, default_missing_value = "16")]
    worlds: Option<u64>,
    /// Seed for drawing worlds from variants.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
    /// Index of the first world drawn.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// Unit of distances by parameters: units (1 is one parameter over its whole range) or share (of the task's diameter).
    #[arg(long, value_parser = Scale::from_name, value_name = "SCALE", default_value = "units")]
    scale: Scale,
    #[command(flatten)]
    libraries: LibraryChoice,
    #[command(flatten)]
    weights: WeightArgs,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Distance {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let Compared {
            distance,
            by,
            description,
        } = self.measure()?;
        if self.json {
            let mut found = serde_json::to_value(&distance)?;
            (found["by"], found["compared"]) = (json!(by), json!(description));
            return output::json(&found);
        }
        output::line(format!(
            "{} to {}, {description}\n",
            one_line(&self.a),
            one_line(&self.other())
        ))?;
        output::line(by_element(&distance))?;
        if self.explain && distance.parts.is_empty() {
            output::line("\nno parts: this distance is of the whole decision process")?;
        } else if self.explain {
            output::line("")?;
            output::line(parts(&distance))?;
        }
        Ok(())
    }

    fn measure(&self) -> Result<Compared, Failure> {
        let sample = Sample {
            worlds: self.worlds,
            seed: self.seed,
            index: self.index,
            by: self.by,
            scale: self.scale,
            catalogue: self.libraries.catalogue()?,
        };
        let (a, b) = (side(&self.a)?, side(&self.other())?);
        Ok(between(&a, &b, &sample, |declared| self.weights.over(declared))?)
    }

    /// The second argument with its task, which may be omitted after a variant.
    fn other(&self) -> String {
        let named = tasks::with_tasks(&[self.a.clone(), self.b.clone()]);
        named.into_iter().next_back().unwrap_or_default()
    }
}

/// Resolves a name: a world file, or a variant.
fn side(name: &str) -> Result<Side, Failure> {
    worlds::expect_world_or_task(name)?;
    if worlds::is_world_file(name) {
        let world = worlds::file(name, false, &MapLibrary::default(), &|text| output::warning(text))?;
        Ok(Side::World(Box::new(world)))
    } else {
        Ok(Side::Variant(tasks::variant(name)?))
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

/// A table of the parts that differ, largest share first, and one line that lists the equal ones.
fn parts(distance: &Measured) -> String {
    let (mut parts, equal): (Vec<&Part>, Vec<&Part>) = distance.parts.iter().partition(|part| part.raw != 0.0);
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let row = |part: &Part| {
        [
            part.name.clone(),
            part.element.letter().to_owned(),
            part.method.map_or_else(
                || part.measure.to_string(),
                |method| format!("{} ({method})", part.measure),
            ),
            format!("{:.4}", part.raw),
            format!("{:.4}", part.normalised),
            format!("{}", part.weight),
            format!("{:.1}%", 100.0 * part.share),
        ]
    };
    let mut names: Vec<&str> = equal.iter().map(|part| part.name.as_str()).collect();
    names.dedup();
    let equal = match names.as_slice() {
        [] => String::new(),
        names => format!("\nequal: {}", names.join(", ")),
    };
    if parts.is_empty() {
        return equal.trim_start().to_owned();
    }
    let shown = table(
        ["what", "element", "measure", "raw", "scaled", "weight", "share"],
        parts.into_iter().map(row),
        &[3, 4, 5, 6],
    );
    shown + &equal
}
