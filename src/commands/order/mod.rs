//! `driftworld order`: variants in an order by their distances. Distances and orders are `similarity`'s.

mod arguments;
mod compare;

use std::path::PathBuf;

use crate::distances::labelled_matrix;
use crate::report::picture::path_map;
use crate::similarity::{DistanceMatrix, Method, Ordering};
use crate::tasks;
use clap::Args;
use serde_json::{Value, json};

pub(crate) use arguments::OrderArgs;
use compare::Comparison;

use super::weights::WeightArgs;
use super::{Failure, matrix_file, output, overwrite};
use crate::table::{cells, table};

/// Put variants into an order by their distances.
///
/// Variants of one task are compared parameter by parameter, at the weights that the task declares, those of several tasks by
/// 16 worlds each.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld order find_objects
  driftworld order find_objects --start find_objects#blue --end find_objects#dusk --plot path.png
  driftworld order find_objects get_to_goal#plain --matrix matrix.npy
  driftworld order --from-matrix matrix.npy --compare")]
pub(crate) struct Order {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required_unless_present = "from_matrix", value_name = "TASK")]
    tasks: Vec<String>,
    /// Take the distances from this file (.csv, .json or .npy) instead of measuring variants.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["tasks", "weight"])]
    from_matrix: Option<PathBuf>,
    #[command(flatten)]
    ordering: OrderArgs,
    #[command(flatten)]
    weights: WeightArgs,
    /// What the method random draws from.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Show every method side by side.
    #[arg(long, conflicts_with_all = ["method", "plot"])]
    compare: bool,
    /// Write the distance matrix into this file: .csv, .json, or .npy with the labels in a .labels.json beside it.
    #[arg(long, value_name = "FILE")]
    matrix: Option<PathBuf>,
    /// Write labels into CSV as they are, also what a spreadsheet would take for a formula; by default an apostrophe
    /// guards it.
    #[arg(long, requires = "matrix")]
    raw_cells: bool,
    /// Draw the path over a map of the distances into this PNG file.
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
        let matrix = if let Some(path) = &self.from_matrix {
            matrix_file::read("from_matrix", path)?
        } else {
            let variants = tasks::variants_of(&self.tasks)?;
            labelled_matrix(&variants, |declared| self.weights.over(declared))?
        };
        if let Some(path) = &self.matrix {
            matrix_file::write("matrix", path, &matrix, cells(self.raw_cells))?;
        }
        if self.compare {
            return self.compare(&matrix);
        }
        let (method, ordering) = self.ordering.request().order(&matrix, self.seed)?;
        if let Some(path) = &self.plot {
            output::write_picture(path, &path_map(&matrix, method, &ordering)?)?;
        }
        if self.json {
            let mut found = json_of(&matrix, method, &ordering);
            found["matrix"] = json!(matrix);
            return output::json(&found);
        }
        output::line(path_table(&matrix, &ordering))?;
        let steadily = ordering.anchor_correlation.map_or_else(String::new, |rho| {
            format!(", correlation with the distance from the first {rho:.2}")
        });
        output::line(format!(
            "\n{}: length {:.4}, largest step {:.4}, mean step {:.4}{steadily}",
            method.name(),
            ordering.length,
            ordering.largest_step(),
            ordering.mean_step()
        ))
    }

    fn compare(&self, matrix: &DistanceMatrix) -> Result<(), Failure> {
        let comparison = Comparison::new(matrix, &self.ordering.request().options(matrix, self.seed)?);
        if self.json {
            return output::json(&comparison.json(matrix));
        }
        output::line(comparison.table())
    }
}

/// An order as JSON.
fn json_of(matrix: &DistanceMatrix, method: Method, ordering: &Ordering) -> Value {
    let names: Vec<&String> = ordering.indices.iter().map(|index| &matrix.labels()[*index]).collect();
    json!({
        "method": method, "order": names, "steps": ordering.steps, "length": ordering.length,
        "largest_step": ordering.largest_step(), "mean_step": ordering.mean_step(),
        "anchor_correlation": ordering.anchor_correlation,
    })
}

/// The items of an order with the step that leads to each.
pub(crate) fn path_table(matrix: &DistanceMatrix, ordering: &Ordering) -> String {
    let rows = ordering.indices.iter().enumerate().map(|(place, index)| {
        let step = place
            .checked_sub(1)
            .map_or_else(String::new, |before| format!("{:.4}", ordering.steps[before]));
        [(place + 1).to_string(), matrix.labels()[*index].clone(), step]
    });
    table(["", "variant", "distance from the one before"], rows.collect(), &[0, 2])
}
