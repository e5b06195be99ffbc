//! `driftworld new` and `driftworld export`: write a task spec to start from, either a small one or a built-in one.

use std::path::{Path, PathBuf};

use clap::Args;
use driftworld_text::ShownPath;

use super::output;
use crate::spec::TaskSpec;
use crate::tasks;
use crate::{Failure, overwrite};

/// Name and JSON of a small task whose descriptions explain each part.
const SCAFFOLD: (&str, &str) = ("my_task", include_str!("scaffold.json"));

/// Write a small task spec to begin with.
///
/// It can be validated, drawn and run as it is. Its descriptions say what each part is for.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld new my_task
  driftworld new berries -o tasks/berries.json")]
pub(crate) struct New {
    /// Name of the task: lower-case letters, digits and underscores.
    name: String,
    /// File to write, or - for standard output [default: NAME.json].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists.
    #[arg(long)]
    force: bool,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// Write a built-in task as a task spec to edit.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld export find_objects
  driftworld export get_to_goal --name my_goal -o tasks/my_goal.json")]
pub(crate) struct Export {
    /// The built-in task; `driftworld tasks` lists them.
    task: String,
    /// Give the task another name; its worlds then differ, too.
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// File to write, or - for standard output [default: NAME.json].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists.
    #[arg(long)]
    force: bool,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

impl New {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let name = self.name.strip_suffix(".json").unwrap_or(&self.name);
        let text = renamed(SCAFFOLD, name)?;
        let file = self.output.unwrap_or_else(|| format!("{name}.json").into());
        write(&file, &text, self.force, self.json)?;
        if self.json || output::is_stdout(&file) {
            return Ok(());
        }
        output::report_written_files()?;
        let file = file.shown();
        output::line(format!(
            "Try it, change it, try it again:\n  \
             driftworld validate {file} --worlds 20\n  \
             driftworld tasks show {file}\n  \
             driftworld sheet {file} -o sheet.png\n  \
             driftworld distance {file}#plain modest --explain\n  \
             driftworld curriculum {file} --learn 20 --eval-episodes 5 -o s.json\n  \
             driftworld run s.json --agent sarsa -o log"
        ))
    }
}

impl Export {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let (task, _) = tasks::split(&self.task);
        let mut known = tasks::groups().flat_map(|(_, tasks)| tasks);
        let Some(&built_in) = known.find(|(name, _)| *name == task) else {
            let known = tasks::known_tasks(task);
            return Err(Failure::input(format!(
                "found {task:?}, expected a built-in task, {known}"
            )));
        };
        let name = self.name.as_deref().unwrap_or(built_in.0);
        let text = renamed(built_in, name)?;
        let file = self.output.unwrap_or_else(|| format!("{name}.json").into());
        write(&file, &text, self.force, self.json)
    }
}

/// Renames a task in its text, and removes the path of its schema, which would not resolve from the new file.
fn renamed((old, text): (&str, &str), name: &str) -> Result<String, Failure> {
    let lines = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("\"$schema\""));
    let mut text = lines.collect::<Vec<_>>().join("\n");
    text.push('\n');
    let text = text.replacen(&format!("\"name\": \"{old}\""), &format!("\"name\": \"{name}\""), 1);
    // Descriptions mention the file name, too.
    let text = text.replace(&format!("{old}.json#"), &format!("{name}.json#"));
    TaskSpec::from_json(&format!("{name}.json"), &text)?;
    Ok(text)
}

fn write(file: &Path, text: &str, force: bool, json: bool) -> Result<(), Failure> {
    if !force && !output::is_stdout(file) && file.exists() {
        return Err(overwrite::exists(
            file,
            "name another with -o, or replace it with --force",
        ));
    }
    output::write_or_print(file, text)?;
    output::json_of_what_was_written(json && !output::is_stdout(file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaffold_and_built_in_tasks_can_be_renamed() {
        let all = tasks::groups().flat_map(|(_, tasks)| tasks);
        for task in all.copied().chain([SCAFFOLD]) {
            let text = renamed(task, "mine").expect("it is valid");
            let task = TaskSpec::from_json("mine", &text).expect("it is valid");
            assert_eq!(task.name(), "mine");
        }
    }
}
