//! `driftworld run`: a scenario lived by an agent into a log. Living it is `curriculum`'s; the clock and the files are here.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Args;
use driftworld::curriculum::{Progress, Summary, Surroundings, logger_info, run, scenario_info};
use driftworld::env::Catalogue;
use driftworld::metrics::{LogWriter, MetricsError, Timestamp};
use driftworld::spec::{BlockKind, Scenario, Variant};
use driftworld::tasks;

use super::assets::LibraryChoice;
use super::table::table;
use super::who::Who;
use super::{Failure, input, output};

/// Live a curriculum with an agent and log every experience.
#[derive(Args)]
#[command(after_help = "Example:
  driftworld run scenario.json --agent onrails --logs logs/first
  driftworld run scenario.json --agent scripted:keep_away.txt --logs logs/second
  driftworld metrics logs/first")]
pub(crate) struct Run {
    /// The scenario file.
    scenario: PathBuf,
    #[arg(long, default_value = "onrails", value_name = "AGENT", help = Who::HELP)]
    agent: Who,
    /// A folder for the log; it must not hold anything yet.
    #[arg(long, default_value = "logs/run", value_name = "DIR")]
    logs: PathBuf,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

impl Run {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let text = input::text(&self.scenario)?;
        let scenario = Scenario::from_json(&self.scenario.display().to_string(), &text)?;
        let summary = live(&scenario, &self.agent, &self.logs, self.libraries.catalogue()?)?;
        if self.json {
            return output::json(&summary);
        }
        output::line(regimes(&summary))?;
        output::line(format!(
            "\n{} experiences, {} steps; log in {}",
            summary.experiences,
            summary.steps,
            self.logs.display()
        ))
    }
}

/// Lives a scenario into a new log, with a bar on a terminal.
pub(crate) fn live(scenario: &Scenario, who: &Who, logs: &Path, catalogue: Catalogue) -> Result<Summary, Failure> {
    let mut agent = who.agent()?;
    let mut log =
        LogWriter::create(logs, &logger_info()?, &scenario_info(scenario, &who.name())).map_err(
            |error| match error {
                MetricsError::LogExists { path } => Failure::input(format!(
                    "{}: holds something already; choose a new folder with --logs",
                    path.display()
                )),
                other => other.into(),
            },
        )?;
    let bar = output::progress(scenario.num_experiences(), "living");
    let mut around = Surroundings {
        find: &mut find,
        now: &mut now,
        watch: &mut |progress: &Progress| {
            bar.set_position(progress.done);
            bar.set_message(progress.variant.clone());
            ControlFlow::Continue(())
        },
        catalogue,
    };
    let summary = run(scenario, agent.as_mut(), &mut log, &mut around)?;
    log.finish()?;
    bar.finish_and_clear();
    Ok(summary)
}

fn find(task: &str, variant: &str) -> Result<Variant, String> {
    tasks::variant(&format!("{task}#{variant}")).map_err(|error| error.to_string())
}

fn now() -> Timestamp {
    let micros = jiff::Timestamp::now().as_microsecond();
    Timestamp::from_unix_micros(micros).expect("the clock shows a year from 1 to 9999")
}

/// What each regime came to.
pub(crate) fn regimes(summary: &Summary) -> String {
    let rows = summary.regimes.iter().map(|regime| {
        [
            regime.block.to_string(),
            if regime.kind == BlockKind::Learning {
                "learning"
            } else {
                "evaluation"
            }
            .to_owned(),
            regime.variant.clone(),
            regime.experiences.to_string(),
            format!("{:.1}", regime.mean_reward),
            format!("{:.0}%", 100.0 * regime.success_rate),
        ]
    });
    table(
        ["block", "kind", "variant", "experiences", "mean reward", "success"],
        rows.collect(),
        &[0, 3, 4, 5],
    )
}
