//! `driftworld curriculum`: learning and evaluation blocks of variants in the order of their distances.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use driftworld::curriculum::{Choice, Design, Evaluate, design};
use driftworld::similarity::DistanceMatrix;
use driftworld::spec::{BlockKind, Scenario, Variant};

use super::order::{OrderArgs, matrix};
use super::table::table;
use super::{Failure, input, output};

/// Design learning and evaluation blocks from variants and their distances.
#[derive(Args)]
#[command(after_help = "Example:
  driftworld curriculum find_objects --start find_objects#blue -o scenario.json
  driftworld run scenario.json --agent random --logs log")]
pub(crate) struct Curriculum {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required = true, value_name = "TASK")]
    tasks: Vec<String>,
    #[command(flatten)]
    ordering: OrderArgs,
    /// The scenario's name.
    #[arg(long, default_value = "curriculum")]
    name: String,
    /// Experiences of each learning block.
    #[arg(long, default_value_t = 20, value_name = "N")]
    learn: u32,
    /// Experiences of each variant in each evaluation block.
    #[arg(long, default_value_t = 5, value_name = "N")]
    evaluate_with: u32,
    /// When the agent is evaluated.
    #[arg(long, value_enum, default_value_t = When::Every)]
    evaluate: When,
    /// What all worlds of the scenario follow from.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The scenario file, or - for standard output.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
}

/// When the agent is evaluated.
#[derive(Clone, Copy, ValueEnum)]
enum When {
    /// Before the first learning block and after each.
    Every,
    /// Before the first and after the last.
    Ends,
}

impl Curriculum {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let variants = input::variants(&self.tasks)?;
        let matrix = matrix(&variants)?;
        let (_, ordering) = self.ordering.order(&matrix, self.seed)?;
        let options = Design {
            name: self.name,
            learn: self.learn,
            evaluate: self.evaluate_with,
            evaluation: match self.evaluate {
                When::Every => Evaluate::Every,
                When::Ends => Evaluate::Ends,
            },
            seed: self.seed,
        };
        let scenario = design(&choices(&variants, &ordering.indices), &options)?;
        // What the schema refuses, such as a name that no folder can have, is refused before it is written.
        let text = scenario.to_json_pretty();
        Scenario::from_json("scenario", &text)?;
        output::write_or_print(&self.output, &text)?;
        if self.output.as_os_str() != "-" {
            output::line(blocks(&scenario, Some(&matrix)))?;
        }
        Ok(())
    }
}

/// Variants in an order, as a scenario names them.
pub(crate) fn choices(variants: &[(String, Variant)], order: &[usize]) -> Vec<Choice> {
    let choice = |index: &usize| {
        let (task, variant) = &variants[*index];
        Choice {
            task: task.clone(),
            variant: variant.name().to_owned(),
        }
    };
    order.iter().map(choice).collect()
}

/// The blocks of a scenario as a table, with the distance of each learning block from the one before.
pub(crate) fn blocks(scenario: &Scenario, matrix: Option<&DistanceMatrix>) -> String {
    let mut before: Option<usize> = None;
    let rows = scenario.blocks.iter().enumerate().map(|(index, block)| {
        let names: Vec<String> = block
            .regimes
            .iter()
            .map(|r| format!("{}#{}", r.task, r.variant))
            .collect();
        let experiences: u64 = block.regimes.iter().map(|regime| u64::from(regime.count)).sum();
        let mut step = String::new();
        if block.kind == BlockKind::Learning
            && let Some(matrix) = matrix
        {
            let here = matrix.labels().iter().position(|label| names.first() == Some(label));
            if let (Some(a), Some(b)) = (before, here) {
                step = format!("{:.4}", matrix.get(a, b));
            }
            before = here.or(before);
        }
        let kind = if block.kind == BlockKind::Learning {
            "learning"
        } else {
            "evaluation"
        };
        let what = if names.len() > 2 {
            format!("all {} variants", names.len())
        } else {
            names.join(", ")
        };
        [index.to_string(), kind.to_owned(), what, experiences.to_string(), step]
    });
    table(
        [
            "block",
            "kind",
            "variants",
            "experiences",
            "distance from the last learned",
        ],
        rows.collect(),
        &[0, 3, 4],
    )
}
