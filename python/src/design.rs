//! Designs curricula from names of tasks.

use std::path::PathBuf;

use driftworld::design::{self, DesignOrder, DesignRequest};
use driftworld::ordering::OrderRequest;
use driftworld_curriculum::{Design, Drifting, Evaluate, Split};
use driftworld_spec::{By, DriftSwitch, Scenario, sound_name};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value as Json;

use crate::errors::{Result, refused};
use crate::interruptible::run_detached;
use crate::options::Options;

const REFUSED: &str = "CurriculumError";

/// Scenarios, by name and text: the designed ones, and their controls.
type Texts = (Vec<(String, String)>, Vec<(String, String)>);

/// Designs scenarios with the options of `Curriculum.design`, or their experts if requested; plots the blocks if a file is given
/// for that.
#[pyfunction]
pub(crate) fn design_curriculum(py: Python<'_>, tasks: Vec<String>, options: Bound<'_, PyDict>) -> Result<Texts> {
    let options = Options::new(options, REFUSED);
    let request = request(tasks, &options)?;
    let plot: Option<PathBuf> = options.path("plot")?;
    if request.is_of_several() && plot.is_some() {
        return Err(
            options.refuse("plot: found it for several scenarios, expected it for one; leave it out".to_owned())
        );
    }
    let experts = request.experts;
    let designed = run_detached(py, move || {
        let designed = design::design(&request)?;
        if let Some(path) = plot {
            designed.write_plot(&path)?;
        }
        Ok(designed)
    })?;
    let designed = designed.map_err(|failure| refused(REFUSED, &failure))?;
    let texts = |scenarios: Vec<Scenario>| {
        let text = |scenario: Scenario| (scenario.name.clone(), scenario.to_json_pretty());
        scenarios.into_iter().map(text).collect()
    };
    let scenarios = if experts { designed.experts } else { designed.scenarios };
    Ok((texts(scenarios), texts(designed.controls)))
}

fn request(tasks: Vec<String>, options: &Options<'_>) -> Result<DesignRequest> {
    let usual = DesignRequest::of(tasks);
    Ok(DesignRequest {
        ordering: OrderRequest {
            method: options.word("method")?,
            start: options.text("start")?,
            end: options.text("end")?,
            target_step: options.number("target_step")?,
        },
        order: options.choice("order", &DesignOrder::WORDS)?,
        by: options.read("by", By::from_name)?,
        probe: options.read("probe", design::element)?,
        modalities: options
            .json("modalities")?
            .map(serde_json::from_value)
            .transpose()
            .map_err(|error| {
                options.refuse(format!(
                    "modalities: {error}, expected a list of kinds of images, such as [\"rgb\"]"
                ))
            })?,
        variants: options.whole("variants")?,
        step_distance: options.number("step_distance")?,
        tolerance: options.number("tolerance")?,
        steps: options.whole("steps")?,
        lifetimes: options.whole("lifetimes")?,
        hold_out: options
            .list("hold_out", "a list of names of variants")?
            .unwrap_or_default(),
        experts: options.flag("experts")?,
        controls: options.path("controls")?.is_some(),
        worlds: options.whole("worlds")?.unwrap_or(usual.worlds),
        libraries: options.path("assets")?.into_iter().collect(),
        design: blocks(options)?,
        ..usual
    })
}

fn blocks(options: &Options<'_>) -> Result<Design> {
    let usual = Design::default();
    let after = options.list("evaluate_after", "a list of whole numbers, such as [0, 2]")?;
    let evaluation = options.choice("evaluate", &[("every", Evaluate::Every), ("ends", Evaluate::Ends)])?;
    if after.is_some() && evaluation.is_some() {
        return Err(
            options.refuse("evaluate_after: found together with evaluate, expected only one of the two".to_owned())
        );
    }
    let schedule = options.read("drift", design::schedule)?;
    let switch = match options.json("mix")? {
        None | Some(Json::Null | Json::Bool(false)) => DriftSwitch::AtPoint,
        Some(Json::Bool(true)) => DriftSwitch::Mixture,
        Some(Json::String(word)) if word == "task" => DriftSwitch::Task,
        Some(other) => {
            return Err(options.refuse(format!("mix: found {other}, expected True, False or \"task\"")));
        }
    };
    if switch != DriftSwitch::AtPoint && schedule.is_none() {
        return Err(options.refuse("options: found no drift, expected it beside mix".to_owned()));
    }
    let name = |name: &str| sound_name(name).map(|()| name.to_owned());
    Ok(Design {
        name: options.read("name", name)?.unwrap_or_else(|| "curriculum".to_owned()),
        learn: options.whole("learn")?.unwrap_or(usual.learn),
        evaluate: options.whole("eval_episodes")?.unwrap_or(usual.evaluate),
        evaluation: after.map(Evaluate::After).or(evaluation).unwrap_or(usual.evaluation),
        form: options.named("form")?,
        blocks: options.whole("blocks")?,
        lifetime: options.whole("lifetime")?.unwrap_or(usual.lifetime),
        fixed_evaluation: options.flag("fixed_evaluation")?,
        split: options
            .choice("split", &[("validation", Split::Validation), ("test", Split::Test)])?
            .unwrap_or(usual.split),
        paired_learning: options.flag("paired_learning")?,
        drifting: schedule.map(|schedule| Drifting { schedule, switch }),
        pre_deployment: options.whole("pre_deployment")?.unwrap_or(usual.pre_deployment),
        task_label: options.named("task_label")?.unwrap_or(usual.task_label),
        complexity: options.named("complexity")?,
        difficulty: options.named("difficulty")?,
        seed: options.whole("seed")?.unwrap_or(usual.seed),
        ..usual
    })
}
