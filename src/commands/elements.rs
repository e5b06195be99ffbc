//! `driftworld elements`: measures which elements of the decision process each variant changes, next to the declared ones.

use clap::Args;
use driftworld_text::joined_or;

use crate::elements::{ElementsOutcome, ElementsRequest, VariantElements, elements};
use crate::spec::Element;
use crate::table::without_empty;

use super::output;
use crate::Failure;

/// Test what variants change: state, action, reward and so on.
///
/// Prints the measured elements beside those that the task declares.
///
/// Worlds of two variants are drawn in pairs and run side by side, with the same actions from the same states. S is
/// what can exist, p where things are at the start, A what actions do to the body, T what follows, R what is paid and
/// what ends an episode, O the form of observations, and phi how a state looks. Each variant is compared with the first
/// one that the task declares, or A with B.
///
/// For a variant that changes the reward, the table also says whether the best behaviour changes: whether the first
/// variant's planner loses reward in its worlds, as with `distance --by behavior`. If not, nothing has to be forgotten.
///
/// A variant is contradicted if an element differs that none of its changed parameters `affects`; S covers p, and O covers phi. It
/// is idle if it sets a parameter that made no difference within --steps. The exit code is 1 if a variant is contradicted.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld elements find_objects
  driftworld elements find_objects red penalty --modalities rgb,depth
  driftworld elements my_task.json --worlds 100 --json")]
pub(crate) struct Elements {
    #[command(flatten)]
    request: ElementsRequest,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Elements {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let found = elements(&self.request)?;
        if self.json {
            output::json(&found)?;
        } else {
            output::line(shown(&found))?;
        }
        found.warnings().for_each(output::warning);
        let wrong: Vec<&str> = found.contradictions().collect();
        if wrong.is_empty() {
            return Ok(());
        }
        Err(Failure::input(wrong.join("\n")))
    }
}

/// Whether the optimal behaviour changes, for variants that change the reward.
fn optimum(variant: &VariantElements) -> String {
    let said = variant.optimum.map(|optimum| if optimum.turned { "yes" } else { "no" });
    said.unwrap_or("-").to_owned()
}

/// A row per variant: declared and measured elements.
pub(crate) fn shown(found: &ElementsOutcome) -> String {
    let letters = |elements: &[Element]| {
        let letters: Vec<&str> = elements.iter().map(|element| element.letter()).collect();
        joined_or(&letters, " ", "-")
    };
    let has_optima = found.variants.iter().any(|variant| variant.optimum.is_some());
    let row = |variant: &VariantElements| {
        let proof = &variant.proof;
        let best_changes = if has_optima { optimum(variant) } else { String::new() };
        vec![
            variant.variant.clone(),
            letters(&variant.declared),
            letters(&variant.elements()),
            best_changes,
            proof.worlds.to_string(),
            proof.runs.to_string(),
            proof.steps.to_string(),
            proof.observations.to_string(),
            variant.verdict.name().to_owned(),
        ]
    };
    let headings = [
        "variant",
        "declared",
        "measured",
        "best changes",
        "worlds",
        "episodes",
        "steps",
        "looks",
        "verdict",
    ];
    let rows: Vec<Vec<String>> = found.variants.iter().map(row).collect();
    format!(
        "{}, compared with {}:\n{}",
        found.task,
        found.base,
        without_empty(&headings, &rows, &[4, 5, 6, 7])
    )
}
