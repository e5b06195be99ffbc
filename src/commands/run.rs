//! `driftworld run`: runs an agent through a scenario and writes the log.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::clock::Clock;
use crate::curriculum::{
    CurriculumError, Journal, Plan, Progress, REPEATED_EVALUATIONS, RunContext, Summary, Undrawable, relearn, run,
};
use crate::env::Catalogue;
use crate::metrics::MetricsError;
use crate::scenarios::ScenarioFile;
use crate::spec::BlockKind;
use crate::tasks;
use clap::Args;
use driftworld_text::{ShownPath, printable, when};

use super::agent::{AgentArg, NamedAgent};
use super::assets::LibraryChoice;
use super::interrupt::Interrupt;
use super::output;
use crate::Failure;
use crate::table::table;

/// Maximum number of experiences that run in parallel.
const MAX_JOBS: usize = 256;

/// Run an agent through a curriculum, and log every experience.
///
/// The scenario is one of ours or of L2Explorer's. Relative paths of tasks and worlds are first resolved from the
/// scenario's folder.
///
/// An interrupted run continues with --resume at the first experience missing from the log. The log is then the same,
/// byte for byte, as that of an uninterrupted run, except for time stamps. To fix those too, set
/// DRIFTWORLD_CLOCK=2026-01-31T12:00:00Z in the environment.
///
/// On Ctrl-C, SIGTERM or SIGHUP, the run stops at the next step; the exit code is 128 plus the signal's number (130, 143,
/// 129). It also stops if the log is removed, renamed, replaced or truncated, and reports what is lost (exit code 1).
#[derive(Args)]
#[command(after_help = "Example:
  driftworld run scenario.json --agent onrails -o logs/first
  driftworld run scenario.json --agent onrails -o logs/first --resume
  driftworld run scenario.json --agent scripted:keep_away.txt -o logs/second --record
  driftworld metrics logs/first")]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct Run {
    /// The scenario file.
    scenario: PathBuf,
    // Without a clap default, so that a default agent can be reported.
    #[arg(long, value_name = "AGENT", help = format!("{} [default: onrails]", AgentArg::HELP))]
    agent: Option<AgentArg>,
    /// Folder for the log. Must be empty, unless --resume is given.
    #[arg(short, long, default_value = "logs/run", value_name = "DIR")]
    output: PathBuf,
    /// Continue the log in the folder, or start a new one if there is none.
    #[arg(long)]
    resume: bool,
    /// Record the actions of each experience, in an actions.jsonl beside its rows, for `driftworld replay`.
    ///
    /// A log started with `--record` keeps recording when resumed.
    #[arg(long)]
    record: bool,
    /// Number of experiences to run in parallel, 1 to 256 [default: one per processor].
    ///
    /// The log does not depend on it.
    #[arg(long, value_name = "N", value_parser = jobs)]
    jobs: Option<NonZeroUsize>,
    /// Seed of the agent's random numbers: another seed repeats the run in the same worlds.
    ///
    /// It is stated in the log. 0 is the scenario's default run.
    #[arg(long, default_value_t = 0, value_name = "S", allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
    /// Skip experiences whose worlds cannot be drawn.
    ///
    /// Each gets a row without numbers in the log, with the reason, and is counted in the summary. If a run stopped at
    /// such an experience, continue it with this option and --resume.
    #[arg(long)]
    skip_undrawable: bool,
    /// If a world file is missing, use the one with the most similar name.
    ///
    /// The log says so. This is the default for L2Explorer's scenarios.
    #[arg(long)]
    stand_in: bool,
    /// Fail if a world file is missing, also for L2Explorer's scenarios.
    #[arg(long, conflicts_with = "stand_in")]
    no_stand_in: bool,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    let jobs = text.parse().ok().filter(|jobs: &NonZeroUsize| jobs.get() <= MAX_JOBS);
    jobs.ok_or_else(|| format!("found {text:?}, expected a whole number in 1..{MAX_JOBS}"))
}

impl Run {
    /// Refuses the name of a built-in task in place of a scenario file; a task file is recognised when it is read.
    fn refuse_task(&self) -> Result<(), Failure> {
        let name = self.scenario.to_str().unwrap_or_default();
        let is_task = !self.scenario.exists() && tasks::variants(name).is_ok();
        if !is_task {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{name}: found a task, expected a scenario; `driftworld curriculum {name} -o scenario.json` makes one from \
             its variants"
        )))
    }

    pub(crate) fn run(self) -> Result<(), Failure> {
        self.refuse_task()?;
        if output::is_stdout(&self.output) {
            return Err(Failure::usage(
                "--output: found standard output, expected a folder for the log",
            ));
        }
        let file = ScenarioFile::read(&self.scenario, &mut output::warning)?;
        // L2Explorer's own scenario names a map that L2Explorer does not include, and must run unchanged.
        let stand_in = self.stand_in || (file.original && !self.no_stand_in);
        let undrawable = if self.skip_undrawable {
            Undrawable::Skipped
        } else {
            Undrawable::Refused
        };
        let plan = file.plan(stand_in, undrawable, &mut output::warning);
        let mut plan = plan.map_err(|error| match &error {
            CurriculumError::World { .. } => Failure::input(format!(
                "{error}\nnothing was run: fix the task (driftworld validate SCENARIO --worlds 100 finds what cannot \
                 be drawn), or skip such experiences with --skip-undrawable"
            )),
            _ => error.into(),
        })?;
        let classes = tasks::classes(&self.libraries.catalogue()?);
        for (name, task) in plan.tasks() {
            tasks::check_classes(name, task, &classes)?;
        }
        plan.set_run_seed(self.seed);
        let agent = self.agent.as_ref().unwrap_or(&AgentArg::Onrails).agent()?;
        let agent_note = when(self.agent.is_none(), || {
            format!(", by {} because no --agent was given", agent.name)
        });
        if let Some((what, fingerprint)) = &agent.fingerprint {
            plan.add_fingerprint(what, fingerprint.as_str());
        }
        let libraries = self.libraries.fingerprints()?;
        if !libraries.is_empty() {
            plan.add_fingerprint("assets", libraries);
        }
        let run = LifetimeRun {
            plan: &plan,
            agent,
            logs: &self.output,
            resumes: self.resume,
            jobs: self.jobs.unwrap_or_else(processors),
            catalogue: self.libraries.catalogue()?,
            records: self.record,
        };
        let summary = run.run()?;
        output::wrote(
            &self.output,
            format!(
                "a log of {} experiences, {} steps{agent_note}",
                summary.experiences, summary.steps
            ),
        );
        if self.json {
            return output::json(&summary);
        }
        output::line(regimes(&summary))?;
        if let Some(skipped) = skipped(&summary) {
            output::line(format!("\n{skipped}"))?;
        }
        if let Some(endings) = endings(&summary) {
            output::line(format!("\n{endings}"))?;
        }
        output::line("")
    }
}

/// How often experiences ended in each way, the most frequent first; `None` if no experience was run.
fn endings(summary: &Summary) -> Option<String> {
    let mut counts: Vec<(&str, u64)> = summary
        .ended_by
        .iter()
        .map(|(word, count)| (word.as_str(), *count))
        .collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let listed: Vec<String> = counts.iter().map(|(word, count)| format!("{word} {count}")).collect();
    (!listed.is_empty()).then(|| format!("ended by: {}", listed.join(", ")))
}

/// The skipped experiences and why; `None` if all were run.
fn skipped(summary: &Summary) -> Option<String> {
    const MAX_LISTED: usize = 10;
    if summary.skipped == 0 {
        return None;
    }
    let shown = summary.left_out.iter().take(MAX_LISTED).map(|left_out| {
        let progress = when(left_out.progress != 0.0, || {
            format!(" at progress {}", left_out.progress)
        });
        format!(
            "  block {}, experience {}, {}{progress}: {}",
            left_out.block, left_out.experience, left_out.variant, left_out.reason
        )
    });
    let mut lines = vec![format!(
        "left out: {} experiences whose worlds cannot be drawn",
        summary.skipped
    )];
    lines.extend(shown);
    if summary.skipped > MAX_LISTED as u64 {
        lines.push(format!(
            "  and {} more; the log lists them all",
            summary.skipped - MAX_LISTED as u64
        ));
    }
    Some(lines.join("\n"))
}

/// The number of processors, at most [`MAX_JOBS`].
pub(crate) fn processors() -> NonZeroUsize {
    let jobs = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    jobs.min(NonZeroUsize::new(MAX_JOBS).unwrap_or(NonZeroUsize::MIN))
}

/// Advice on an undrawable world, for when a log exists already.
const UNDRAWABLE: &str = "this one cannot be run: to skip such experiences, repeat the command with --resume and \
     --skip-undrawable; or fix the task and start a new log";

/// A lifetime to run.
pub(crate) struct LifetimeRun<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) agent: NamedAgent,
    pub(crate) logs: &'a Path,
    /// Whether to resume the log, if there is one; otherwise its folder must be empty.
    pub(crate) resumes: bool,
    pub(crate) jobs: NonZeroUsize,
    pub(crate) catalogue: Catalogue,
    /// Whether actions are recorded.
    pub(crate) records: bool,
}

impl LifetimeRun<'_> {
    /// Runs the lifetime, with a progress bar on a terminal. If it stops early, the log contains only complete experiences, and
    /// the message says how to continue.
    pub(crate) fn run(mut self) -> Result<Summary, Failure> {
        // Listen before the log exists: another process may send a signal as soon as it sees the log.
        let interrupt = Interrupt::listen(format!(
            "interrupted in the middle of a step\n{}: all experiences in it are complete; continue with the same \
             command and --resume",
            self.logs.shown()
        ));
        let clock = Clock::from_environment()?;
        let mut journal = self.journal()?;
        if self.records {
            if !journal.records() && journal.num_experiences() > 0 {
                output::warning(format!(
                    "{}: found experiences that were not recorded; --record records those from number {} onwards",
                    self.logs.shown(),
                    journal.num_experiences()
                ));
            }
            journal.record();
        }
        let bar = output::progress(self.plan.num_experiences(), "running");
        bar.set_position(journal.num_experiences());
        let mut context = RunContext {
            now: &mut || clock.now(),
            watch: &mut |progress: &Progress| {
                bar.set_position(progress.done);
                bar.set_message(printable(&progress.variant).into_owned());
                // After the last experience there is nothing to stop.
                if interrupt.is_cancelled() && progress.done < progress.total {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
            stop: interrupt.flag(),
            catalogue: self.catalogue.clone(),
            jobs: self.jobs,
            repeated_evaluations: REPEATED_EVALUATIONS,
        };
        let agent = self.agent.agent.as_mut();
        let done = journal.num_experiences();
        // A complete log needs no agent.
        let to_relearn = if done < self.plan.num_experiences() { done } else { 0 };
        let outcome = relearn(self.plan, agent, to_relearn, &mut context).and_then(|flow| match flow {
            ControlFlow::Continue(()) => run(self.plan, agent, &mut journal, &mut context),
            ControlFlow::Break(()) => Ok(journal.summary().clone()),
        });
        bar.finish_and_clear();
        let done = journal.num_experiences();
        let finished = journal.finish();
        if let Err(error) = &finished
            && is_loss(error)
        {
            return Err(Failure::input(error.to_string()));
        }
        match outcome {
            Ok(summary) if summary.finished => finished
                .map(|()| summary)
                .map_err(|error| self.stopped(&error.to_string(), done)),
            Ok(_) => Err(interrupt.failure(self.stopping("interrupted", done))),
            // The same command would stop at the same world again.
            Err(error @ CurriculumError::World { .. }) => Err(Failure::input(format!(
                "{error}\n{}: holds {done} of {} experiences, all complete; {}",
                self.logs.shown(),
                self.plan.num_experiences(),
                UNDRAWABLE
            ))),
            Err(error) => Err(self.stopped(&error.to_string(), done)),
        }
    }

    fn journal(&self) -> Result<Journal, Failure> {
        let open = if self.resumes { Journal::resume } else { Journal::create };
        open(self.logs, self.plan, &self.agent.name).map_err(|error| match error {
            CurriculumError::Log(MetricsError::LogExists(path)) => Failure::input(format!(
                "{}: found a folder that is not empty; choose a new one with --output, or continue its log with --resume",
                path.shown()
            )),
            other => other.into(),
        })
    }

    /// The failure with the reason, the state, and how to continue.
    fn stopped(&self, why: &str, done: u64) -> Failure {
        Failure::input(self.stopping(why, done))
    }

    /// The message with the reason, the state, and how to continue.
    fn stopping(&self, why: &str, done: u64) -> String {
        format!(
            "{why}\n{}: holds {done} of {} experiences, all complete; continue with the same command and --resume",
            self.logs.shown(),
            self.plan.num_experiences()
        )
    }
}

/// Whether the log itself was lost or damaged, so that it cannot be continued.
fn is_loss(error: &CurriculumError) -> bool {
    matches!(
        error,
        CurriculumError::Log(
            MetricsError::FolderLost { .. }
                | MetricsError::FileLost { .. }
                | MetricsError::InfoFileChanged { .. }
                | MetricsError::MissingFile { .. }
        )
    )
}

/// The results of each regime.
pub(crate) fn regimes(summary: &Summary) -> String {
    let rows = summary.regimes.iter().map(|regime| {
        // There are no results if all experiences were skipped.
        let shown = |number: f64, show: fn(f64) -> String| {
            if regime.experiences == 0 {
                "-".to_owned()
            } else {
                show(number)
            }
        };
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
            shown(regime.mean_reward, |reward| format!("{reward:.1}")),
            shown(regime.success_rate, |rate| format!("{:.0}%", 100.0 * rate)),
        ]
    });
    table(
        ["block", "kind", "variant", "experiences", "mean reward", "success"],
        rows,
        &[0, 3, 4, 5],
    )
}
