//! `driftworld demo`: the whole way once, on `find_objects`, with every product kept. Each step is a subcommand of its own. What
//! the lifetime shows is read off in `effects.rs`.

mod effects;

use std::path::{Path, PathBuf};

use crate::curriculum::{Design, Summary, Undrawable, design};
use crate::distances::{By, Sample, labelled_matrix};
use crate::env::Catalogue;
use crate::generator::Sampler;
use crate::lifetime_report::{ReportRequest, write_report};
use crate::scenarios;
use crate::scoring::{ScoringRequest, score};
use crate::similarity::{DistanceMatrix, Method, OrderOptions, Ordering, order};
use crate::spec::{BlockKind, Scenario, Variant};
use crate::tasks;
use clap::Args;
use driftworld_text::{ShownPath, when};

use super::agent::AgentArg;
use super::curriculum::{blocks, choices};
use super::metrics::summary;
use super::order::path_table;
use effects::effects_table;

use super::run::{LifetimeRun, processors};
use super::{Failure, output};
use crate::contact_sheet::{self, ways};
use crate::report::picture::heat_map;
use crate::table::table;
use crate::variant_names::VariantNames;
use crate::views::Views;

/// The task that the demo is about.
const TASK: &str = "find_objects";

/// Its variants that the demo shows.
const VARIANTS: [&str; 3] = ["blue", "huddle", "penalty"];

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

        heading(
            "1",
            "One world of each variant under one seed: they differ only in what the variants set",
        )?;
        self.pictures(&variants)?;

        heading(
            "2",
            "How far apart the variants are: 1 is one parameter moved over its whole range",
        )?;
        let matrix = labelled_matrix(&variants, &Sample::default(), Ok)?;
        let ordering = order(&matrix, Method::Exact, &OrderOptions::default().with_first(0))?;
        output::write(&folder.join("distances.csv"), matrix.to_csv().as_bytes())?;
        let short: Vec<String> = variants.iter().map(|(_, variant)| variant.name().to_owned()).collect();
        let picture = heat_map("Distances between the variants of find_objects", &short, |a, b| {
            matrix.get(a, b)
        });
        output::write_picture(&folder.join("distances.png"), &picture)?;
        output::line(path_table(&matrix, &ordering))?;

        heading(
            "3",
            "A curriculum: the shortest path through them, with an evaluation before and after each block",
        )?;
        let scenario = self.scenario(&variants, &matrix, &ordering)?;

        heading(
            "4",
            "A lifetime: a small learner runs it (--agent sarsa), beside an agent at random and a planner that knows the map",
        )?;
        let logs = folder.join("log");
        let outcome = run_lifetime(&scenario, &AgentArg::Sarsa, &logs)?;
        let first = Scenario {
            blocks: scenario.blocks.iter().take(1).cloned().collect(),
            ..scenario.clone()
        };
        let mut beside = Vec::new();
        for agent in [AgentArg::Random, AgentArg::Onrails] {
            let name = agent.name();
            let summary = run_lifetime(&first, &agent, &folder.join("beside").join(&name))?;
            beside.push((name, summary));
        }
        output::line(block_table(&outcome, &beside))?;

        heading("5", "The lifelong-learning metrics of the lifetime")?;
        let warn = |text| output::warning(text);
        let page = write_report(
            &ReportRequest {
                title: Some("A small learner: linear Sarsa(λ)".to_owned()),
                ..ReportRequest::of([&logs])
            },
            &warn,
        )?;
        output::write(&folder.join("report.html"), page.html.as_bytes())?;
        let scores = score(&ScoringRequest::of([&logs]), &warn)?;
        scores.save(&folder.join("scores"), Some("demo"))?;
        let names = VariantNames::of_logs(&[&logs]);
        let lifetimes = scores.lifetimes.iter().map(|lifetime| summary(lifetime, &names));
        output::line(lifetimes.collect::<String>())?;
        heading(
            "6",
            "In short: what was learned, transferred and forgotten, in mean reward",
        )?;
        output::line(effects_table(&outcome))?;
        output::line(
            "\nThe learner sees 169 numbers of a small picture, and knows no map. Yours takes its place from Python or \
             Rust: docs/curricula.md says how.",
        )?;

        heading("", &format!("Everything is in {}", folder.shown()))?;
        output::line(contents())
    }

    /// One world of each variant and its map, each in a file; and all side by side, as the agent sees them and from above.
    fn pictures(&self, variants: &[(String, Variant)]) -> Result<(), Failure> {
        let mut cells = Vec::new();
        for (_, variant) in variants {
            let name = variant.name();
            let world = Sampler::new(variant, self.seed).world(0)?;
            let path = self.output.join("worlds").join(format!("{name}.json"));
            output::write(&path, world.to_json_pretty().as_bytes())?;
            let map = Views::new(&world, 480, 0.0).map_with_legend(&ways(&world)?);
            output::write_picture(&self.output.join("maps").join(format!("{name}.png")), &map)?;
            let said = variant.task().variant_description(name).unwrap_or_default();
            output::line(format!("{name:<10} {said}"))?;
            cells.push(contact_sheet::Shown::declared(variant.clone(), self.seed));
        }
        let look = contact_sheet::Look {
            index: None,
            turn: None,
            size: 240,
            columns: 2,
        };
        let drawing = contact_sheet::contact_sheet(&cells, look, &|| ())?;
        output::write_picture(&self.output.join("contact-sheet.png"), &drawing)
    }

    fn scenario(
        &self,
        variants: &[(String, Variant)],
        matrix: &DistanceMatrix,
        ordering: &Ordering,
    ) -> Result<Scenario, Failure> {
        let options = Design {
            name: "demo".to_owned(),
            learn: 150,
            evaluate: 10,
            seed: self.seed,
            ..Design::default()
        };
        let scenario = design(&choices(variants, &ordering.indices), &options)?;
        output::write(&self.output.join("scenario.json"), scenario.to_json_pretty().as_bytes())?;
        output::line(blocks(&scenario, Some((matrix, By::Parameters))))?;
        Ok(scenario)
    }
}

fn heading(number: &str, text: &str) -> Result<(), Failure> {
    let number = when(!number.is_empty(), || format!("{number}. "));
    output::line(format!("\n{number}{text}\n"))
}

/// Runs a scenario into a folder, in place of what an earlier demo left there.
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

/// One row for each block: what was learned, and the mean reward of every variant in the evaluation after it. Then one for each of
/// the agents beside, which do not learn.
fn block_table(summary: &Summary, beside: &[(String, Summary)]) -> String {
    let mut variants: Vec<&str> = Vec::new();
    for regime in summary
        .regimes
        .iter()
        .filter(|regime| regime.kind == BlockKind::Evaluation)
    {
        if !variants.contains(&regime.variant.as_str()) {
            variants.push(&regime.variant);
        }
    }
    let short = |variant: &str| tasks::split(variant).1.unwrap_or(variant).to_owned();
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut learned = "nothing yet".to_owned();
    for regime in &summary.regimes {
        if regime.kind == BlockKind::Learning {
            learned = format!("{} ({:.1})", short(&regime.variant), regime.mean_reward);
            continue;
        }
        if rows.last().is_none_or(|row| row[0] != regime.block.to_string()) {
            rows.push(vec![regime.block.to_string(), std::mem::take(&mut learned)]);
        }
        if let Some(row) = rows.last_mut() {
            row.push(format!("{:.1}", regime.mean_reward));
        }
    }
    for (name, summary) in beside {
        let mut row = vec![String::new(), format!("({name})")];
        let rewards = summary
            .regimes
            .iter()
            .map(|regime| format!("{:.1}", regime.mean_reward));
        row.extend(rewards);
        rows.push(row);
    }
    let mut headings = vec!["block".to_owned(), "learned (reward)".to_owned()];
    headings.extend(variants.into_iter().map(short));
    let numbers: Vec<usize> = (2..headings.len()).collect();
    "Mean reward of each variant in every evaluation:\n\n".to_owned() + &table(headings, rows, &numbers)
}

/// A demo may be run again and again: its own log is replaced, anything else in the way is not.
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

fn contents() -> String {
    let entries = [
        ("contact-sheet.png", "each variant as the agent sees it, and from above"),
        ("maps/", "the maps alone"),
        ("worlds/", "the worlds: driftworld render FILE draws one"),
        ("distances.csv", "the distance matrix"),
        ("distances.png", "the same as a heat map"),
        ("scenario.json", "the curriculum: driftworld run FILE runs it"),
        ("log/", "every experience, in l2logger's format"),
        ("beside/", "the same of the agent at random and the planner"),
        ("report.html", "the lifetime on one page, for a browser"),
        ("scores/", "the metrics: driftworld metrics on the log prints them"),
    ];
    let line = |(name, what): &(&str, &str)| format!("  {name:<18} {what}");
    entries.iter().map(line).collect::<Vec<_>>().join("\n")
}
