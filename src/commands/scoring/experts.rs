//! The single-task experts that lifetimes are compared with: logs that were named, and those kept in a folder, read when they are needed.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::metrics::{Log, MetricsError, Options, SteLog, StoredTask, VariantMode, find_ste, read_ste_log};

use crate::commands::{Failure, log_folders};

/// Experts of any number of tasks.
#[derive(Default)]
pub(crate) struct Experts {
    named: Vec<SteLog>,
    stored: Vec<Stored>,
}

/// The stored experts of one task, and their logs once they were read.
struct Stored {
    task: StoredTask,
    logs: OnceLock<Result<Vec<SteLog>, String>>,
}

impl Experts {
    pub(super) fn new(named: &[PathBuf], data: Option<&Path>) -> Result<Self, Failure> {
        let named = log_folders::named(named)?
            .iter()
            .map(read_ste_log)
            .collect::<Result<Vec<_>, _>>()?;
        let stored = data.map(find_ste).transpose()?.unwrap_or_default().into_iter();
        let stored = stored.map(|task| Stored {
            task,
            logs: OnceLock::new(),
        });
        Ok(Self {
            named,
            stored: stored.collect(),
        })
    }

    /// What is said of experts that were named for a lifetime without their task.
    pub(crate) fn left_aside(&self, log: &Log, options: &Options) -> Vec<String> {
        let tasks = tasks(log, options);
        let strangers = self
            .named
            .iter()
            .filter(|expert| !tasks.contains(&scored(expert.task_name(), options)));
        let told = |expert: &SteLog| {
            let (name, task) = (&expert.log().run_id, expert.task_name());
            format!(
                "the expert {name} of {task} is left aside: the lifetime has no such task, but {}",
                tasks.join(", ")
            )
        };
        strangers.map(told).collect()
    }

    /// The experts of the tasks that a lifetime has.
    pub(crate) fn of(&self, log: &Log, options: &Options) -> Result<Vec<SteLog>, Failure> {
        let tasks = tasks(log, options);
        let scored = |task: &str| scored(task, options);
        let mut experts: Vec<SteLog> = self.named.clone();
        experts.retain(|expert| tasks.contains(&scored(expert.task_name())));
        for stored in self
            .stored
            .iter()
            .filter(|stored| tasks.contains(&scored(&stored.task.task_name)))
        {
            let read = || {
                let logs = stored
                    .task
                    .runs
                    .iter()
                    .map(read_ste_log)
                    .collect::<Result<Vec<_>, MetricsError>>();
                logs.map_err(|error| error.to_string())
            };
            match stored.logs.get_or_init(read) {
                Ok(logs) => experts.extend(logs.iter().cloned()),
                Err(text) => return Err(Failure::input(text.clone())),
            }
        }
        Ok(experts)
    }
}

/// The name under which a task is scored.
fn scored(task: &str, options: &Options) -> String {
    let task = task.to_lowercase();
    match (options.variant_mode, task.split_once('_')) {
        (VariantMode::Agnostic, Some((task, _))) => task.to_owned(),
        _ => task,
    }
}

fn tasks(log: &Log, options: &Options) -> Vec<String> {
    log.rows
        .task_names()
        .values()
        .iter()
        .map(|task| scored(task, options))
        .collect()
}
