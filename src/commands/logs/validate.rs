//! `driftworld logs validate`: lists every problem of a log with its location.

use std::path::PathBuf;

use crate::metrics::{Validation, begun_log, validate_log};
use clap::Args;
use driftworld_text::{ShownPath, printable};
use serde_json::{Value, json};

use super::super::output;
use super::{count, grouped};
use crate::{Failure, log_folders};

/// Report every problem of logs with its file and line.
///
/// Checks everything that scoring needs, and what only the log's writer could have ensured: numbers that never
/// decrease, exactly one complete row per experience, the same columns in every file. A log without problems can be
/// read. Warnings report oddities. Problems and warnings go to standard error, one line per log to standard output. The
/// exit code is 1 if there is a problem.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld logs validate demo-out/log
  driftworld logs validate logs --recursive --json")]
pub(crate) struct Validate {
    /// Folders of logs.
    #[arg(required = true, value_name = "DIR")]
    logs: Vec<PathBuf>,
    /// Search the folders for logs, up to four levels deep. Links are not followed.
    #[arg(short = 'R', long)]
    recursive: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// The result for one log.
struct Verdict {
    log: PathBuf,
    found: Validation,
    /// Metrics columns and format version; `None` if `logger_info.json` cannot be read.
    info: Option<(Vec<String>, String)>,
}

impl Validate {
    pub(crate) fn run(self) -> Result<(), Failure> {
        output::run_to_end_for_exit_code();
        let logs = log_folders::found(&self.logs, self.recursive)?;
        let (mut wrong, total) = (0, logs.len());
        let mut verdicts = Vec::new();
        for log in logs {
            let verdict = Verdict::of(log);
            wrong += usize::from(!verdict.found.is_valid());
            if self.json {
                verdicts.push(verdict.to_json());
            } else {
                verdict.print()?;
            }
        }
        if self.json {
            output::json(&verdicts)?;
        }
        match (wrong, total) {
            (0, _) => Ok(()),
            (_, 1) => Err(Failure::input("the log has problems")),
            _ => Err(Failure::input(format!("{wrong} of {total} logs have problems"))),
        }
    }
}

impl Verdict {
    fn of(log: PathBuf) -> Self {
        let info = begun_log(&log).ok().flatten().map(|(info, _)| {
            let columns = info.metrics_columns().to_vec();
            (columns, info.log_format_version().to_owned())
        });
        Self {
            found: validate_log(&log),
            log,
            info,
        }
    }

    fn print(&self) -> Result<(), Failure> {
        let (found, log) = (&self.found, self.log.shown());
        for problem in &found.problems {
            output::note(log_folders::placed(&self.log, &problem.to_string()));
        }
        if found.more_problems > 0 {
            output::note(format!("{log}: and {}", count(found.more_problems, "more problem")));
        }
        for warning in &found.warnings {
            output::note(format!(
                "warning: {}",
                log_folders::placed(&self.log, &warning.to_string())
            ));
        }
        if found.more_warnings > 0 {
            output::note(format!("{log}: and {}", count(found.more_warnings, "more warning")));
        }
        output::line(self.summary())
    }

    fn summary(&self) -> String {
        let counts = &self.found.counts;
        let problems = self.found.problems.len() as u64 + self.found.more_problems;
        let verdict = match problems {
            0 => "valid".to_owned(),
            problems => count(problems, "problem"),
        };
        let incomplete = match (counts.rows - counts.complete_rows) as u64 {
            0 => String::new(),
            rows => format!(" ({} incomplete)", grouped(rows)),
        };
        let mut text = format!(
            "{}: {verdict}; {}{incomplete} in {}, {}, {}, {}",
            self.log.shown(),
            count(counts.rows as u64, "row"),
            count(counts.files as u64, "file"),
            count(counts.workers as u64, "worker"),
            count(counts.blocks as u64, "block"),
            count(counts.tasks as u64, "task"),
        );
        if let Some((columns, version)) = &self.info {
            let columns = columns.join(", ");
            text.extend(["; metrics ", &printable(&columns), "; format ", &printable(version)]);
        }
        text
    }

    fn to_json(&self) -> Value {
        let found = &self.found;
        let problem = |problem: &crate::metrics::MetricsError| json!({ "code": problem.code(), "message": log_folders::placed(&self.log, &problem.to_string()) });
        json!({
            "log": self.log,
            "valid": found.is_valid(),
            "problems": found.problems.iter().map(problem).collect::<Vec<_>>(),
            "more_problems": found.more_problems,
            "warnings": found.warnings.iter().map(|warning| log_folders::placed(&self.log, &warning.to_string())).collect::<Vec<_>>(),
            "more_warnings": found.more_warnings,
            "rows": found.counts.rows,
            "complete_rows": found.counts.complete_rows,
            "experiences": found.counts.experiences,
            "files": found.counts.files,
            "workers": found.counts.workers,
            "blocks": found.counts.blocks,
            "tasks": found.counts.tasks,
            "metrics_columns": self.info.as_ref().map(|(columns, _)| columns),
            "log_format_version": self.info.as_ref().map(|(_, version)| version),
        })
    }
}
