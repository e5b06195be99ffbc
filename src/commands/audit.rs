//! `driftworld audit`: checks a scenario's protocol with agents whose scores are known.

use std::path::PathBuf;

use crate::curriculum::{AuditOptions, AuditRow, Undrawable, audit};
use crate::scenarios::ScenarioFile;
use crate::table::table;
use clap::Args;
use driftworld_atomic_files::ScratchFolder;
use driftworld_text::{ShownPath, counted};
use serde_json::json;

use super::output;
use crate::Failure;

/// Test a curriculum with agents whose scores are known.
///
/// Five simulated agents run the scenario: one that never learns, one that learns while it is evaluated, one that only
/// remembers what paid best in the experience with the same number, one that learns every variant like its own expert,
/// and one that forgets. The audit prints what the metrics, experts and checks say of each. It fails if they can be
/// fooled: if luck counts as transfer, if repeated worlds reward memory, if experts have a different budget, or if
/// forgetting goes unnoticed. It also fails if the scenario cannot test one of the agents.
///
/// Only rewards are simulated, so no world is rendered. 11,000 experiences take about half a minute. Reward is 100
/// times a skill from 0 to 1, plus luck of the layout (standard deviation 10) and of the episode (20).
#[derive(Args)]
#[command(after_help = "Example:
  driftworld audit scenario.json examples/curricula/reward.json")]
pub(crate) struct Audit {
    /// Scenario files.
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Lifetimes of the agent that never learns.
    #[arg(long, default_value_t = AuditOptions::default().lifetimes, value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=100_000))]
    lifetimes: u32,
    /// Lifetimes of each other agent; a small number reveals only gross faults.
    #[arg(long, default_value_t = AuditOptions::default().repeats, value_name = "N",
        value_parser = clap::value_parser!(u32).range(2..=100_000))]
    repeats: u32,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Audit {
    pub(crate) fn run(self) -> Result<(), Failure> {
        output::run_to_end_for_exit_code();
        let options = AuditOptions {
            lifetimes: self.lifetimes,
            repeats: self.repeats,
        };
        let (mut failed, mut untested) = (0, 0);
        let mut reports = Vec::new();
        for path in &self.scenarios {
            let file = ScenarioFile::read(path, &mut output::warning)?;
            let folder = ScratchFolder::new(".driftworld-audit-", &std::env::temp_dir())?;
            let mut plan = |scenario: &_| {
                file.with_scenario(scenario)
                    .plan(true, Undrawable::Refused, &mut output::warning)
            };
            let rows = audit(&file.scenario, &mut plan, folder.path(), options)?;
            let count = |passed| rows.iter().filter(|row| row.passed == passed).count();
            failed += count(Some(false));
            untested += count(None);
            if self.json {
                reports.push(json!({ "scenario": path, "agents": rows }));
            } else {
                output::line(format!("{}\n{}\n", path.shown(), verdict_table(&rows)))?;
            }
        }
        if self.json {
            output::json(&reports)?;
        }
        if failed > 0 {
            return Err(Failure::input(format!(
                "found {} whose scores are not as the protocol promises, expected none",
                counted(failed, "agent")
            )));
        }
        if untested > 0 {
            return Err(Failure::input(format!(
                "found {} that the scenario cannot test, for the reasons above, expected none: not tested is not passed",
                counted(untested, "agent")
            )));
        }
        Ok(())
    }
}

fn verdict_table(rows: &[AuditRow]) -> String {
    let verdict = |row: &AuditRow| match row.passed {
        Some(true) => "ok",
        Some(false) => "FAILED",
        None => "not tested",
    };
    let row = |row: &AuditRow| {
        [
            row.agent.to_owned(),
            row.expected.to_owned(),
            row.found.clone(),
            verdict(row).to_owned(),
        ]
    };
    table(["agent", "expected", "found", ""], rows.iter().map(row), &[])
}
