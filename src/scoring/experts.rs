//! The single-task experts that lifetimes are compared with: given logs, and logs in a store, which are read on demand.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use driftworld_metrics::{
    Log, MetricsError, Options, SteLog, StoredTask, VariantMode, experts_serving, find_ste, read_ste_log,
};

use crate::{Failure, log_folders};

/// Experts of any number of tasks.
#[derive(Default)]
pub(crate) struct Experts {
    named: Vec<SteLog>,
    stored: Vec<Stored>,
}

/// The stored experts of one task, and their logs once read.
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

    /// Warnings about given experts whose task the lifetime does not have.
    pub(crate) fn unused_warnings(&self, log: &Log, options: &Options) -> Vec<String> {
        let tasks = tasks(log, options);
        let trained: Vec<&str> = self.trained().collect();
        let used = serving(&tasks, &trained);
        let unused = self.named.iter().enumerate().filter(|(index, _)| !used.contains(index));
        let warning = |(_, expert): (usize, &SteLog)| {
            let (name, task) = (&expert.log().run_id, expert.task_name());
            format!(
                "the expert {name} of {task} is ignored: the lifetime has no such task, only {}",
                tasks.join(", ")
            )
        };
        unused.map(warning).collect()
    }

    /// The experts of a lifetime's tasks.
    pub(crate) fn of(&self, log: &Log, options: &Options) -> Result<Vec<SteLog>, Failure> {
        let trained: Vec<&str> = self.trained().collect();
        let used = serving(&tasks(log, options), &trained);
        let mut experts = Vec::new();
        for index in used {
            let Some(number) = index.checked_sub(self.named.len()) else {
                experts.push(self.named[index].clone());
                continue;
            };
            // Indices beyond the given experts refer to stored ones.
            let stored = &self.stored[number];
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
        Ok(prefer_own(log, experts))
    }

    /// The tasks on which the experts were trained: first those of given experts, then those of stored ones.
    fn trained(&self) -> impl Iterator<Item = &str> {
        let stored = self.stored.iter().map(|stored| stored.task.task_name.as_str());
        self.named.iter().map(SteLog::task_name).chain(stored)
    }
}

/// For each task, keeps only the lifetime's own experts if there are any. The name of an own expert's scenario begins
/// with the name of the lifetime's scenario. Several lifetimes may be scored together, with the experts of all of them.
fn prefer_own(log: &Log, experts: Vec<SteLog>) -> Vec<SteLog> {
    let Some(own) = scenario_name(log).map(|name| format!("{name}-")) else {
        return experts;
    };
    let is_own = |expert: &SteLog| scenario_name(expert.log()).is_some_and(|name| name.starts_with(&own));
    let with_own: BTreeSet<String> = experts
        .iter()
        .filter(|expert| is_own(expert))
        .map(|expert| expert.task_name().to_owned())
        .collect();
    let serves = |expert: &SteLog| is_own(expert) || !with_own.contains(expert.task_name());
    experts.into_iter().filter(serves).collect()
}

/// The name of the scenario that a log was run from, if logged.
fn scenario_name(log: &Log) -> Option<&str> {
    log.scenario_info.extra.get("scenario")?.get("name")?.as_str()
}

/// Indices of the experts that serve some of the tasks.
fn serving(tasks: &[String], trained: &[&str]) -> BTreeSet<usize> {
    tasks.iter().flat_map(|task| experts_serving(task, trained)).collect()
}

/// The names under which a lifetime's tasks are scored.
pub(super) fn tasks(log: &Log, options: &Options) -> Vec<String> {
    let names = log.rows.task_names().values().iter();
    names.map(|task| scored_name(task, options)).collect()
}

/// The name under which a task is scored.
pub(super) fn scored_name(task: &str, options: &Options) -> String {
    let task = task.to_lowercase();
    match (options.variant_mode, task.split_once('_')) {
        (VariantMode::Agnostic, Some((task, _))) => task.to_owned(),
        _ => task,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_metrics::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log};

    fn log_of(scenario: &str, task: &str) -> Log {
        let base = tempfile::tempdir().expect("there is a folder for temporary files");
        let folder = base.path().join(scenario);
        let mut info = ScenarioInfo::default();
        info.extra
            .insert("scenario".to_owned(), serde_json::json!({ "name": scenario }));
        let columns = LoggerInfo::new(["reward"]).expect("the columns are valid");
        let mut writer = LogWriter::create(&folder, &columns, &info).expect("the folder is new");
        let when = Timestamp::from_unix_micros(0).expect("the epoch is a valid time");
        let record = Record::new(0, 0, BlockType::Train, task, when).with_metric("reward", 1.0);
        writer.write(&record).expect("there is disk space");
        writer.finish().expect("there is disk space");
        read_log(&folder).expect("it was written")
    }

    #[test]
    fn each_lifetime_uses_its_own_experts_or_else_all() {
        let expert = |scenario, task| SteLog::new(log_of(scenario, task)).expect("the log has one task");
        let experts = vec![
            expert("c-1-red", "f_red"),
            expert("c-11-red", "f_red"),
            expert("c-2-red", "f_red"),
            expert("c-2-blue", "f_blue"),
        ];
        let of = |lifetime| -> Vec<String> {
            let own = prefer_own(&log_of(lifetime, "f_red"), experts.clone());
            own.iter().map(|expert| expert.log().run_id.clone()).collect()
        };
        assert_eq!(of("c-1"), ["c-1-red", "c-2-blue"]);
        assert_eq!(of("c-2"), ["c-2-red", "c-2-blue"]);
        assert_eq!(of("another").len(), 4);
    }
}
