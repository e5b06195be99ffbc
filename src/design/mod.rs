//! [`design`]: builds curricula from the names of tasks. It chooses variants, orders them, arranges them in blocks, and checks
//! that their worlds can be drawn.

mod choose;
mod drawable;
mod notes;
mod optima;
mod proof;
mod request;
mod words;

use driftworld_curriculum::{
    Control, Design, Tried, control, design as lay_out, design_control, experts as single_task,
};
use driftworld_report::picture;
use driftworld_spec::{Scenario, ScenarioForm};
use std::path::Path;

pub use choose::{Chosen, DEFAULT_STEPS, DEFAULT_TOLERANCE, Evidence};
pub use optima::PairOptimum;
pub use request::{DesignRequest, MAX_LIFETIMES, MAX_TRIED};
pub use words::{Mix, element, schedule};

use crate::{Failure, output_file, tasks};
use drawable::check_drawable;

/// The result of a request.
#[derive(Debug)]
#[non_exhaustive]
pub struct Designed {
    /// The scenario; one per expert or lifetime if several are requested.
    pub scenarios: Vec<Scenario>,
    /// The same variants, worlds and counts in other orders, if requested.
    pub controls: Vec<Scenario>,
    /// Single-task experts of each lifetime, if requested.
    pub experts: Vec<Scenario>,
    /// The variants and their order.
    pub chosen: Chosen,
    /// Notes on what may be unexpected.
    pub notes: Vec<String>,
}

impl Designed {
    /// Plots the blocks of the first scenario against its experiences, as a PNG file.
    ///
    /// # Errors
    /// [`Failure`] if it cannot be written.
    pub fn write_plot(&self, path: &Path) -> Result<(), Failure> {
        let Some(scenario) = self.scenarios.first() else {
            return Ok(());
        };
        output_file::write_picture(path, &picture::blocks(scenario))
    }
}

/// Maximum number of regimes of all lifetimes designed together.
const MAX_REGIMES: usize = 4_000_000;

/// Refuses lifetimes that would not fit in memory, judging by the scenarios of the first lifetime.
fn refuse_too_many<'a>(lifetimes: usize, first: impl Iterator<Item = &'a Scenario>) -> Result<(), Failure> {
    let regimes: usize = first
        .flat_map(|scenario| &scenario.blocks)
        .map(|block| block.regimes.len())
        .sum();
    if regimes.saturating_mul(lifetimes) <= MAX_REGIMES {
        return Ok(());
    }
    Err(Failure::input(format!(
        "lifetimes: found {lifetimes} of {regimes} regimes each, expected at most {MAX_REGIMES} regimes together; use fewer \
         lifetimes, variants or evaluations"
    )))
}

/// Designs a curriculum. Draws a few worlds of each regime, and checks that every experience of a drift has a variant:
/// a design that could not be run is refused.
///
/// # Errors
/// [`Failure`] if a task is missing or invalid, the design is impossible, or the request contradicts itself.
///
/// # Example
/// ```
/// use driftworld::design::{DesignRequest, design};
/// let designed = design(&DesignRequest::of(["find_objects#blue", "find_objects#dusk"])).unwrap();
/// assert_eq!(designed.scenarios[0].blocks.len(), 5);
/// ```
pub fn design(request: &DesignRequest) -> Result<Designed, Failure> {
    request.check()?;
    let chosen = request.choose()?;
    let proof = request.prove(&chosen)?;
    let classes = tasks::classes(&request.catalogue()?);
    let (options, picked) = (&request.design()?, chosen.in_order(&chosen.order));
    let (mut scenarios, mut experts) = (Vec::new(), Vec::new());
    let lifetimes = match request.lifetimes {
        None => vec![options.clone()],
        Some(lifetimes) => (0..lifetimes)
            .map(|lifetime| Design {
                name: format!("{}-{}", options.name, lifetime + 1),
                lifetime,
                ..options.clone()
            })
            .collect(),
    };
    for lifetime in &lifetimes {
        if request.form() == Some(ScenarioForm::Expert) {
            scenarios.extend(single_task(&picked, lifetime)?);
        } else {
            scenarios.push(lay_out(&picked, lifetime)?);
        }
        if request.experts {
            experts.extend(single_task(&picked, lifetime)?);
        }
        if lifetime.lifetime == 0 {
            refuse_too_many(lifetimes.len(), scenarios.iter().chain(&experts))?;
        }
    }
    let mut controls = Vec::new();
    for &kind in Control::ALL.iter().filter(|_| request.controls) {
        let order = control(&chosen.matrix, &chosen.order, kind, options.seed)?;
        let name = format!("{}-{}", options.name, kind.name());
        // Expressed as positions in the design's own order.
        let position = |index: &usize| chosen.order.iter().position(|own| own == index);
        let order: Vec<usize> = order.iter().filter_map(position).collect();
        controls.push(design_control(
            &picked,
            &order,
            &Design {
                name,
                ..options.clone()
            },
        )?);
    }
    for scenario in scenarios.iter_mut().chain(&mut controls).chain(&mut experts) {
        scenario.proof.clone_from(&proof);
    }
    let mut tried = Tried::default();
    for scenario in scenarios.iter().chain(&controls).chain(&experts) {
        check_drawable(scenario, request.worlds, &classes, &mut tried)?;
        // Catch whatever the schema refuses, such as a name that no folder can have.
        Scenario::from_json("scenario", &scenario.to_json_pretty())?;
    }
    Ok(Designed {
        notes: request.notes(&chosen)?,
        scenarios,
        controls,
        experts,
        chosen,
    })
}
