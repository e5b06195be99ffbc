//! `driftworld order`: variants in an order by their distances. Distances and orders are `similarity`'s.

mod arguments;

use std::path::PathBuf;

use clap::Args;
use driftworld::generator::Sampler;
use driftworld::similarity::{
    DistanceMatrix, Ordering, SimilarityError, Weights, variant_distance, world_sets_distance,
};
use driftworld::spec::Variant;
use serde_json::json;

pub(crate) use arguments::OrderArgs;

use super::table::table;
use super::{Failure, input, output};

/// How many worlds of each variant are compared where variants of different tasks meet.
const WORLDS: u64 = 16;

/// Put variants into an order by their distances.
///
/// Variants of one task are compared parameter by parameter, those of several tasks by 16 worlds each.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld order find_objects
  driftworld order find_objects get_to_goal#plain --start find_objects#blue --matrix matrix.csv")]
pub(crate) struct Order {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required = true, value_name = "TASK")]
    tasks: Vec<String>,
    #[command(flatten)]
    ordering: OrderArgs,
    /// Write the distance matrix into this CSV file.
    #[arg(long, value_name = "FILE")]
    matrix: Option<PathBuf>,
    /// What the method random draws from.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Order {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let variants = input::variants(&self.tasks)?;
        let matrix = matrix(&variants)?;
        let (method, ordering) = self.ordering.order(&matrix, self.seed)?;
        if let Some(path) = &self.matrix {
            output::write(path, matrix.to_csv().as_bytes())?;
        }
        let names: Vec<&String> = ordering.indices.iter().map(|index| &matrix.labels()[*index]).collect();
        if self.json {
            return output::json(&json!({
                "method": method, "order": names, "steps": ordering.steps, "length": ordering.length,
                "largest_step": ordering.largest_step(), "mean_step": ordering.mean_step(), "matrix": matrix,
            }));
        }
        output::line(path_table(&matrix, &ordering))?;
        output::line(format!(
            "\n{}: length {:.4}, largest step {:.4}, mean step {:.4}",
            method.name(),
            ordering.length,
            ordering.largest_step(),
            ordering.mean_step()
        ))
    }
}

/// Every distance among variants: parameter by parameter within one task, by sampled worlds otherwise.
pub(crate) fn matrix(variants: &[(String, Variant)]) -> Result<DistanceMatrix, Failure> {
    let labels = variants
        .iter()
        .map(|(task, variant)| format!("{task}#{}", variant.name()))
        .collect();
    let weights = Weights::default();
    let one_task = variants
        .windows(2)
        .all(|pair| pair[0].1.task().name() == pair[1].1.task().name());
    if one_task {
        let measure = |a: usize, b: usize| Ok(variant_distance(&variants[a].1, &variants[b].1, &weights)?.total);
        return Ok(DistanceMatrix::measure(labels, measure).map_err(|error: SimilarityError| error)?);
    }
    let mut worlds = Vec::with_capacity(variants.len());
    for (_, variant) in variants {
        let sampler = Sampler::new(variant, 0);
        worlds.push(
            (0..WORLDS)
                .map(|index| sampler.world(index))
                .collect::<Result<Vec<_>, _>>()?,
        );
    }
    let measure = |a: usize, b: usize| Ok(world_sets_distance(&worlds[a], &worlds[b], &weights).unwrap_or(0.0));
    Ok(DistanceMatrix::measure(labels, measure).map_err(|error: SimilarityError| error)?)
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
