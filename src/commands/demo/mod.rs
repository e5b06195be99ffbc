//! `driftworld demo`: runs the whole pipeline once on `find_objects`, and keeps all output. Each step is also available as a
//! subcommand.

mod effects;

use std::path::{Path, PathBuf};

use crate::curriculum::{Design, Summary, Undrawable, design};
use crate::distances::{Sample, labelled_matrix};
use crate::env::Catalogue;
use crate::generator::Sampler;
use crate::lifetime_report::{ReportRequest, write_report};
use crate::scenarios;
use crate::scoring::{ScoringRequest, score};
use crate::similarity::{DistanceMatrix, Method, OrderOptions, Ordering, order};
use crate::spec::{Scenario, Variant};
use crate::tasks;
use clap::Args;
use driftworld_text::ShownPath;

use super::agent::AgentArg;
use super::curriculum::choices;
use effects::effects_table;

use super::output;
use super::run::{LifetimeRun, processors};
use crate::Failure;
use crate::contact_sheet::{self, paths};
use crate::report::picture::heat_map;
use crate::table::table;
use crate::views::Views;

/// The demo's task.
const TASK: &str = "find_objects";

/// The demo's variants.
const VARIANTS: [&str; 3] = ["blue", "huddle", "turned"];

/// Number of episodes in each learning block.
const LEARN: u32 = 150;

/// What the output folder contains, as printed at the end.
const CONTENTS: &str = "  report.html        the lifetime on one page: metrics, curves, worlds
  contact-sheet.png  each variant as the agent sees it and from above; single maps and worlds are in maps/ and worlds/
  distances.png      how far apart the variants are; the numbers in distances.csv
  scenario.json      the curriculum: driftworld run FILE runs it
  log/, beside/      every experience of the learner and of the others, in l2logger's format
  scores/            the metrics: driftworld metrics on the log prints them";

/// Run the whole pipeline once, from worlds to scores.
///
/// Draws worlds and pictures, measures distances, designs a curriculum, runs a small learner through it and scores it.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld demo -o demo-out")]
pub(crate) struct Demo {
    /// Output folder. Replaces what an earlier demo left there.
    #[arg(short, long, default_value = "demo-out", value_name = "DIR")]
    output: PathBuf,
    /// Seed of the worlds.
    #[arg(long, default_value_t = 7, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
}

impl Demo {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let folder = &self.output;
        let task = tasks::task(TASK)?;
        let variant = |name| Ok::<_, Failure>((TASK.to_owned(), task.variant(name)?));
        let variants: Vec<(String, Variant)> = VARIANTS.into_iter().map(variant).collect::<Result<_, _>>()?;
        self.pictures(&variants)?;
        let matrix = labelled_matrix(&variants, &Sample::default(), Ok)?;
        let ordering = order(&matrix, Method::Exact, &OrderOptions::default().with_first(0))?;
        output::write(&folder.join("distances.csv"), matrix.to_csv().as_bytes())?;
        let title = "Distances between the variants of find_objects";
        let picture = heat_map(title, &VARIANTS.map(str::to_owned), |a, b| matrix.get(a, b));
        output::write_picture(&folder.join("distances.png"), &picture)?;
        let scenario = self.scenario(&variants, &ordering)?;

        let logs = folder.join("log");
        let lifetime = run_lifetime(&scenario, &AgentArg::Sarsa, &logs)?;
        let first = Scenario {
            blocks: scenario.blocks.iter().take(1).cloned().collect(),
            ..scenario.clone()
        };
        let mut beside = Vec::new();
        for (name, agent) in [("random", AgentArg::Random), ("planner", AgentArg::Onrails)] {
            let summary = run_lifetime(&first, &agent, &folder.join("beside").join(name))?;
            beside.push((name.to_owned(), summary));
        }
        let warn = |text| output::warning(text);
        let page = write_report(
            &ReportRequest {
                title: Some("A small learner: linear Sarsa(λ)".to_owned()),
                ..ReportRequest::of([&logs])
            },
            &warn,
        )?;
        output::write(&folder.join("report.html"), page.html.as_bytes())?;
        score(&ScoringRequest::of([&logs]), &warn)?.save(&folder.join("scores"), Some("demo"))?;

        output::line(format!(
            "A small learner meets three variants of {TASK}, {LEARN} episodes each, in the order of their distances.\n\
             Mean reward in the evaluations of each variant, with two other agents for comparison:\n\n{}",
            effects_table(&lifetime, &beside)
        ))?;
        output::line(format!("\n{}", variants_table(&variants, &matrix, &ordering)))?;
        output::line(
            "\nThe learner (--agent sarsa) sees a small picture as 169 numbers, and no map. docs/curricula.md shows how \
             to run your own from Python or Rust.",
        )?;
        output::line(format!("\nEverything is in {}\n\n{CONTENTS}", folder.shown()))
    }

    /// Writes one world of each variant, its map, and a contact sheet of all variants, from the agent's view and from above.
    fn pictures(&self, variants: &[(String, Variant)]) -> Result<(), Failure> {
        let mut cells = Vec::new();
        for (_, variant) in variants {
            let name = variant.name();
            let world = Sampler::new(variant, self.seed).world(0)?;
            let path = self.output.join("worlds").join(format!("{name}.json"));
            output::write(&path, world.to_json_pretty().as_bytes())?;
            let map = Views::new(&world, 480, 0.0).map_with_legend(&paths(&world)?);
            output::write_picture(&self.output.join("maps").join(format!("{name}.png")), &map)?;
            cells.push(contact_sheet::Item::declared(variant.clone(), self.seed));
        }
        let look = contact_sheet::Options {
            index: None,
            turn: None,
            size: 240,
            columns: 2,
        };
        let drawing = contact_sheet::contact_sheet(&cells, look, &|| ())?;
        output::write_picture(&self.output.join("contact-sheet.png"), &drawing)
    }

    fn scenario(&self, variants: &[(String, Variant)], ordering: &Ordering) -> Result<Scenario, Failure> {
        let options = Design {
            name: "demo".to_owned(),
            learn: LEARN,
            evaluate: 10,
            seed: self.seed,
            ..Design::default()
        };
        let scenario = design(&choices(variants, &ordering.indices), &options)?;
        output::write(&self.output.join("scenario.json"), scenario.to_json_pretty().as_bytes())?;
        Ok(scenario)
    }
}

/// The variants in order, each with its distance from the one before it.
fn variants_table(variants: &[(String, Variant)], matrix: &DistanceMatrix, ordering: &Ordering) -> String {
    let mut previous = None;
    let rows = ordering.indices.iter().map(|&index| {
        let variant = &variants[index].1;
        let step = previous.replace(index).map(|previous| matrix.get(previous, index));
        let description = variant.task().variant_description(variant.name()).unwrap_or_default();
        let step = step.map_or_else(String::new, |step| format!("{step:.2}"));
        vec![variant.name().to_owned(), step, description.to_owned()]
    });
    table(["variant", "distance", "what it is"], rows.collect::<Vec<_>>(), &[1])
}

/// Runs a scenario into a folder, replacing the log of an earlier demo.
fn run_lifetime(scenario: &Scenario, agent: &AgentArg, logs: &Path) -> Result<Summary, Failure> {
    remove_old_log(logs)?;
    let mut plan = scenarios::plan(scenario, Undrawable::Refused)?;
    let agent = agent.agent()?;
    if let Some((what, fingerprint)) = &agent.fingerprint {
        plan.add_fingerprint(what, fingerprint.as_str());
    }
    let run = LifetimeRun {
        plan: &plan,
        agent,
        logs,
        resumes: false,
        jobs: processors(),
        catalogue: Catalogue::default(),
        records: false,
    };
    run.run()
}

/// Removes the log of an earlier demo; refuses to remove anything else.
fn remove_old_log(logs: &Path) -> Result<(), Failure> {
    let failed = |error| Failure::in_file(logs, format!("cannot be removed: {error}"));
    if !logs.exists() {
        return Ok(());
    }
    if !logs.join("logger_info.json").exists() {
        return Err(Failure::in_file(
            logs,
            "is not a log of an earlier demo; choose another folder with -o",
        ));
    }
    std::fs::remove_dir_all(logs).map_err(failed)
}
