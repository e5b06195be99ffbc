//! `driftworld tasks`: which tasks are built in, and what varies in one.

use clap::{Args, Subcommand};
use driftworld::spec::{Domain, Parameter, Role, TaskSpec, Value};
use driftworld::tasks;
use serde_json::json;

use super::table::table;
use super::{Failure, output};

/// List the built-in tasks, or show what varies in one.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld tasks\n  driftworld tasks show find_objects")]
pub(crate) struct Tasks {
    #[command(subcommand)]
    action: Option<Action>,
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Subcommand)]
enum Action {
    /// Show parameter by parameter what a task fixes, varies and draws, and every variant's values.
    #[command(after_help = "Example:\n  driftworld tasks show find_objects")]
    Show {
        /// A built-in task, or the path of a task spec.
        task: String,
        /// Print the table as JSON.
        #[arg(long)]
        json: bool,
    },
}

impl Tasks {
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self.action {
            None => list(self.json),
            Some(Action::Show { task, json }) => show(&tasks::task(&task)?, json || self.json),
        }
    }
}

fn list(as_json: bool) -> Result<(), Failure> {
    let tasks = tasks::built_in_names()
        .into_iter()
        .map(tasks::task)
        .collect::<Result<Vec<_>, _>>()?;
    if as_json {
        let list: Vec<_> = tasks
            .iter()
            .map(|task| json!({ "task": task.name(), "description": task.description(), "variants": task.variant_names() }))
            .collect();
        return output::json(&list);
    }
    for task in tasks {
        output::line(format!("{}: {}", task.name(), task.description()))?;
        for name in task.variant_names() {
            let said = task.variant_description(name).unwrap_or_default();
            output::line(format!("  {}#{name:<12} {said}", task.name()).trim_end())?;
        }
    }
    Ok(())
}

fn show(task: &std::sync::Arc<TaskSpec>, as_json: bool) -> Result<(), Failure> {
    let variants = task.all_variants();
    if as_json {
        let values: serde_json::Map<_, _> = variants
            .iter()
            .map(|variant| (variant.name().to_owned(), json!(variant.values())))
            .collect();
        return output::json(&json!({ "task": task.name(), "parameters": task.parameters(), "variants": values }));
    }
    output::line(format!("{}: {}\n", task.name(), task.description()))?;
    let rows = task.parameters().iter().map(|(name, parameter)| {
        let affects: Vec<&str> = parameter.affects.iter().map(|element| element.letter()).collect();
        [
            name.clone(),
            role(parameter.role).to_owned(),
            affects.join(" "),
            domain(parameter),
        ]
    });
    output::line(table(["parameter", "role", "affects", "domain"], rows.collect(), &[]))?;
    output::line("")?;
    let varying: Vec<&String> = task
        .parameters()
        .iter()
        .filter(|(_, p)| p.role == Role::Variant)
        .map(|(n, _)| n)
        .collect();
    let rows = variants.iter().map(|variant| {
        let values = varying
            .iter()
            .filter_map(|name| Some(format!("{name} {}", variant.value(name)?)));
        [variant.name().to_owned(), values.collect::<Vec<_>>().join(", ")]
    });
    output::line(table(["variant", "values"], rows.collect(), &[]))
}

fn role(role: Role) -> &'static str {
    match role {
        Role::Fixed => "fixed",
        Role::Variant => "variant",
        Role::Randomized => "randomized",
    }
}

/// What a parameter may be, in a few words.
fn domain(parameter: &Parameter) -> String {
    let unit = parameter
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" {unit}"));
    let text = match (parameter.domain(), &parameter.value, &parameter.distribution) {
        (Some(Domain::Range([low, high])), _, _) => format!("{low} to {high}"),
        (Some(Domain::Choices(choices)), _, _) => choices.iter().map(Value::to_string).collect::<Vec<_>>().join(", "),
        (None, Some(value), _) => value.to_string(),
        (None, None, Some(distribution)) => serde_json::to_string(distribution).unwrap_or_default(),
        (None, None, None) => String::new(),
    };
    text + &unit
}
