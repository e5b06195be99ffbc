//! `driftworld order`: orders variants by their distances.

mod compare;

use std::path::PathBuf;

use crate::distances::{By, Sample, Scale, fitting, variant_matrix};
use crate::ordering::{OrderRequest, OrderWord};
use crate::report::picture::path_map;
use crate::similarity::{DistanceMatrix, Method, NUM_RANDOM_ORDERS, Ordering, share_of_shorter_orders};
use crate::tasks;
use clap::Args;
use serde_json::{Value, json};

use compare::Comparison;

use super::assets::LibraryChoice;
use super::output;
use super::weights::WeightArgs;
use crate::table::{cells, table};
use crate::{Failure, matrix_file, overwrite};

/// Order variants by their distances.
///
/// Variants of one task are compared as the task declares, by default by parameters. --by selects something else to
/// compare by, as variants of several tasks require.
///
/// The order starts with the variant named first, unless --start names another. If you name one whole task, it starts
/// with the best choice.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld order find_objects
  driftworld order find_objects --start find_objects#blue --end find_objects#dusk --plot path.png
  driftworld order find_objects get_to_goal#plain --by worlds --matrix matrix.csv
  driftworld order --from-matrix matrix.csv --compare")]
pub(crate) struct Order {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required_unless_present = "from_matrix", value_name = "TASK")]
    tasks: Vec<String>,
    /// Read distances from this file (.csv or .json) instead of measuring.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["tasks", "weight"])]
    from_matrix: Option<PathBuf>,
    #[command(flatten)]
    ordering: OrderRequest,
    /// What to compare variants by: parameters, worlds, rewards, and so on, as for `driftworld distance`.
    ///
    /// The default is what the task declares, or parameters if it declares nothing. Variants of several tasks need a
    /// measure other than parameters.
    #[arg(long, value_parser = By::from_name, value_name = "MEASURE", conflicts_with = "from_matrix")]
    by: Option<By>,
    /// Compare this many worlds of each variant, drawn under seed 0 [default: 16; 4 by pictures and
    /// dynamics, 64 by placements]. Without --by, never by parameters.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000), conflicts_with = "from_matrix")]
    worlds: Option<u64>,
    /// Unit of distances by parameters: units (1 is one parameter over its whole range) or share (of the task's diameter).
    #[arg(long, value_parser = Scale::from_name, value_name = "SCALE", default_value = "units")]
    scale: Scale,
    #[command(flatten)]
    libraries: LibraryChoice,
    #[command(flatten)]
    weights: WeightArgs,
    /// Seed of the method random, and of the random orders that the length is compared with.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
    /// Compare all methods.
    #[arg(long, conflicts_with_all = ["order", "plot"])]
    compare: bool,
    /// Also write the distance matrix (.csv or .json).
    #[arg(long, value_name = "FILE")]
    matrix: Option<PathBuf>,
    /// Do not escape CSV labels that a spreadsheet would read as formulas.
    ///
    /// By default they get an apostrophe.
    #[arg(long, requires = "matrix")]
    raw_cells: bool,
    /// Draw the path on a map of the distances into this PNG file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Order {
    pub(crate) fn run(self) -> Result<(), Failure> {
        for target in [&self.matrix, &self.plot].into_iter().flatten() {
            overwrite::refuse_inputs(target, self.tasks.iter().map(String::as_str))?;
        }
        if let Some(path) = &self.matrix {
            matrix_file::expect_name("matrix", path)?;
        }
        let (matrix, by) = self.measure()?;
        if let Some(path) = &self.matrix {
            matrix_file::write("matrix", path, &matrix, cells(self.raw_cells))?;
            output::wrote(path, format!("{0} × {0} distances", matrix.len()));
        }
        if self.compare {
            return self.compare(&matrix);
        }
        let (method, ordering) = self.ordering.labelled().order_from(&matrix, self.seed, &self.tasks)?;
        if let Some(path) = &self.plot {
            output::write_and_report_picture(path, &path_map(&matrix, method, &ordering))?;
        }
        if self.json {
            let mut found = json_of(&matrix, method, &ordering, self.seed);
            found["matrix"] = json!(matrix);
            if let Some(by) = by {
                found["by"] = json!(by);
            }
            return output::json(&found);
        }
        output::line(path_table(&matrix, &ordering))?;
        let by = by.map_or_else(String::new, |by| format!(" by {}", by.name()));
        let correlation = ordering.anchor_correlation.map_or_else(String::new, |rho| {
            format!(", correlation with the distance from the first {rho:.2}")
        });
        output::line(format!(
            "\n{}{by}: length {:.4}, largest step {:.4}, mean step {:.4}{correlation}",
            method.name(),
            ordering.length,
            ordering.largest_step(),
            ordering.mean_step()
        ))?;
        output::line(format!(
            "{:.1} % of {NUM_RANDOM_ORDERS} random orders are shorter",
            100.0 * share_of_shorter_orders(&matrix, &ordering, self.seed)
        ))
    }

    /// All distances, and the measure; `None` instead of a measure if the distances come from a file.
    fn measure(&self) -> Result<(DistanceMatrix, Option<By>), Failure> {
        if let Some(path) = &self.from_matrix {
            return Ok((matrix_file::read("from_matrix", path)?, None));
        }
        let variants = tasks::variants_of(&self.tasks)?;
        let sample = Sample {
            by: self.by,
            scale: self.scale,
            worlds: self.worlds,
            catalogue: self.libraries.catalogue()?,
            ..Sample::default()
        };
        let labels = tasks::labels_of(&variants);
        let labelled: Vec<_> = labels
            .into_iter()
            .zip(variants.iter().map(|(_, variant)| variant.clone()))
            .collect();
        let matrix = variant_matrix(&labelled, &sample, |declared| self.weights.over(declared))?;
        let by = sample.measure(fitting(variants.iter().map(|(_, variant)| variant)));
        Ok((matrix, Some(by)))
    }

    fn compare(&self, matrix: &DistanceMatrix) -> Result<(), Failure> {
        let asked = self.ordering.labelled();
        // A wrong --start or --end is an error of the command, not of each method.
        asked.options(matrix, self.seed)?;
        let comparison = Comparison::new(asked.target_step.is_some(), |method| {
            let request = OrderRequest {
                order: Some(OrderWord::Method(method)),
                target_step: asked.target_step.filter(|_| method == Method::TargetStep),
                ..asked.clone()
            };
            let found = request.order_from(matrix, self.seed, &self.tasks);
            found.map(|(_, ordering)| ordering).map_err(|error| error.for_command())
        });
        if self.json {
            return output::json(&comparison.json(matrix, self.seed));
        }
        output::line(comparison.table())
    }
}

/// An order as JSON.
fn json_of(matrix: &DistanceMatrix, method: Method, ordering: &Ordering, seed: u64) -> Value {
    let names: Vec<&String> = ordering.indices.iter().map(|index| &matrix.labels()[*index]).collect();
    json!({
        "method": method, "order": names, "steps": ordering.steps, "length": ordering.length,
        "largest_step": ordering.largest_step(), "mean_step": ordering.mean_step(),
        "anchor_correlation": ordering.anchor_correlation,
        "share_of_shorter_random_orders": share_of_shorter_orders(matrix, ordering, seed),
    })
}

/// The items of an order, each with the step that leads to it.
fn path_table(matrix: &DistanceMatrix, ordering: &Ordering) -> String {
    let rows = ordering.indices.iter().enumerate().map(|(position, index)| {
        let step = position
            .checked_sub(1)
            .map_or_else(String::new, |step| format!("{:.4}", ordering.steps[step]));
        [(position + 1).to_string(), matrix.labels()[*index].clone(), step]
    });
    table(["", "variant", "distance from the one before"], rows, &[0, 2])
}
