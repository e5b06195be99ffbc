//! `driftworld tasks`: which tasks are built in, and what varies in one.

use crate::spec::{Domain, Parameter, ParameterType, Role, TaskSpec, Value, Variant};
use crate::tasks;
use clap::{Args, Subcommand};
use driftworld_text::{one_line, printable};
use serde_json::json;

use super::{Failure, output};
use crate::table::wide_table;

/// List the built-in tasks, or show what varies in a task.
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
    /// Show a task's parameters, and their values in every variant.
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
        output::line(format!("{}: {}", task.name(), printable(task.description())))?;
        for name in task.variant_names() {
            let said = printable(task.variant_description(name).unwrap_or_default());
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
    output::line(format!("{}: {}", task.name(), printable(task.description())))?;
    for requirement in task.requirements() {
        output::line(format!("require: {}", one_line(requirement)))?;
    }
    let own: Vec<Vec<String>> = std::iter::once(["parameter", "role", "affects", "domain"].map(str::to_owned).to_vec())
        .chain(task.parameters().iter().map(|(name, parameter)| {
            let affects: Vec<&str> = parameter.affects.iter().map(|element| element.letter()).collect();
            let domain = parameter
                .domain()
                .map_or_else(String::new, |domain| in_words(&domain, parameter));
            vec![name.clone(), role(parameter.role).to_owned(), affects.join(" "), domain]
        }))
        .collect();
    let columns: Vec<Vec<String>> = variants
        .iter()
        .map(|variant| {
            let values = task.parameters().keys().map(|name| value(variant, name));
            std::iter::once(variant.name().to_owned()).chain(values).collect()
        })
        .collect();
    for group in across(&own, &columns) {
        output::line("")?;
        let row = |number: usize| -> Vec<String> {
            own[number]
                .iter()
                .cloned()
                .chain(group.iter().map(|column| column[number].clone()))
                .collect()
        };
        output::line(wide_table(row(0), (1..own.len()).map(row).collect(), &[]))?;
    }
    Ok(())
}

/// Widest table in characters: what does not fit goes into a further table, each whole in itself.
const WIDTH: usize = 160;

/// The columns of the variants in groups that fit beside a task's own columns.
fn across<'a>(own: &[Vec<String>], columns: &'a [Vec<String>]) -> Vec<&'a [Vec<String>]> {
    let widest =
        |texts: &mut dyn Iterator<Item = &String>| texts.map(|text| text.chars().count() + 2).max().unwrap_or(0);
    let left: usize = (0..own[0].len())
        .map(|column| widest(&mut own.iter().map(|row| &row[column])))
        .sum();
    let (mut groups, mut start, mut width) = (Vec::new(), 0, left);
    for (index, column) in columns.iter().enumerate() {
        let more = widest(&mut column.iter());
        if index > start && width + more > WIDTH {
            groups.push(&columns[start..index]);
            (start, width) = (index, left);
        }
        width += more;
    }
    groups.push(&columns[start..]);
    groups
}

/// What a parameter is in a variant: its value, or how it is drawn.
fn value(variant: &Variant, name: &str) -> String {
    match (variant.value(name), variant.distribution(name)) {
        (_, Some(distribution)) => short(&distribution.to_string()),
        (Some(value), None) => short(&value.to_string()),
        (None, None) => String::new(),
    }
}

/// A text cut to what a column has room for.
fn short(text: &str) -> String {
    const MOST: usize = 44;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST - 1).chain(['…']).collect()
}

fn role(role: Role) -> &'static str {
    match role {
        Role::Fixed => "fixed",
        Role::Variant => "variant",
        Role::Randomized => "randomized",
    }
}

/// What a parameter may be, in a few words.
fn in_words(domain: &Domain, parameter: &Parameter) -> String {
    let unit = parameter
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" {unit}"));
    let text = match domain {
        Domain::Range([low, high]) => format!("{low} to {high}"),
        Domain::Choices(choices) if parameter.kind == ParameterType::Distribution => {
            format!("{} distributions", choices.len())
        }
        Domain::Choices(choices) => choices.iter().map(Value::to_string).collect::<Vec<_>>().join(", "),
    };
    short(&text) + &unit
}
