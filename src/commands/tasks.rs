//! `driftworld tasks`: lists the built-in tasks, or shows what varies in one.

use std::sync::Arc;

use crate::spec::{Domain, Parameter, ParameterType, Role, TaskSpec, Value, Variant};
use crate::tasks;
use clap::{Args, Subcommand};
use driftworld_text::{NO_BREAK, first_of, one_line, printable, whole};
use serde_json::json;

use super::output;
use crate::Failure;
use crate::table::table;
use crate::value_words::short;

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
    /// Show a task's parameters, and what every variant changes.
    #[command(
        after_help = "Examples:\n  driftworld tasks show find_objects\n  driftworld tasks show find_objects#dusk"
    )]
    Show {
        /// A built-in task, or the path of a task spec; with #variant, that variant or family alone.
        task: String,
        /// Print the table as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Anything else.
    #[command(external_subcommand)]
    Other(Vec<String>),
}

impl Tasks {
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self.action {
            None => list(self.json),
            Some(Action::Show { task, json }) => {
                let own = tasks::split(&task).1;
                show(&tasks::task(&task)?, own, json || self.json)
            }
            Some(Action::Other(words)) => Err(Failure::usage(format!(
                "found {:?}, expected show; `driftworld tasks show NAME` describes a task",
                words[0]
            ))),
        }
    }
}

/// Maximum number of variants per task in the list of tasks.
const MAX_LISTED: usize = 6;

fn list(as_json: bool) -> Result<(), Failure> {
    if as_json {
        let mut list = Vec::new();
        for (group, names) in tasks::groups() {
            for (name, _) in names {
                let task = tasks::task(name)?;
                let (description, variants) = (task.description(), task.variant_names());
                list.push(json!({ "task": name, "group": group, "description": description, "variants": variants }));
            }
        }
        return output::json(&list);
    }
    let tasks = tasks::built_in_names()
        .into_iter()
        .map(tasks::task)
        .collect::<Result<Vec<_>, _>>()?;
    let rows = tasks.iter().map(|task| {
        let names = task.variant_names();
        [
            task.name().to_owned(),
            first_sentence(task.description()).to_owned(),
            first_of(&names, MAX_LISTED),
        ]
    });
    output::line(table(["task", "what it is", "variants"], rows, &[]))?;
    let rows = tasks::FAMILIES.map(|(group, tasks)| {
        let names: Vec<&str> = tasks.iter().map(|(name, _)| *name).collect();
        [group.to_owned(), names.join(", ")]
    });
    output::line(format!("\n{}", table(["more", "tasks"], rows, &[])))?;
    output::line("\n`driftworld tasks show TASK` shows what varies in a task, and what each of its variants changes.")
}

/// The text up to its first full stop; the whole text if there is none.
fn first_sentence(text: &str) -> &str {
    text.find(". ").map_or(text, |end| &text[..=end])
}

fn show(task: &Arc<TaskSpec>, own: Option<&str>, as_json: bool) -> Result<(), Failure> {
    let variants = match own {
        Some(name) => tasks::variants_called(task, name)?,
        None => task.all_variants(),
    };
    if as_json {
        let values: serde_json::Map<_, _> = variants
            .iter()
            .map(|variant| (variant.name().to_owned(), json!(variant.values())))
            .collect();
        let description = |variant: &Variant| {
            Some((
                variant.name().to_owned(),
                json!(task.variant_description(variant.name())?),
            ))
        };
        let descriptions: serde_json::Map<_, _> = variants.iter().filter_map(description).collect();
        return output::json(&json!({
            "task": task.name(), "description": task.description(), "parameters": task.parameters(), "variants": values,
            "descriptions": descriptions,
        }));
    }
    output::line(format!("{}: {}", task.name(), printable(task.description())))?;
    for requirement in task.requirements() {
        output::line(format!("require: {}", one_line(requirement)))?;
    }
    if !task.parameters().is_empty() {
        let rows = task.parameters().iter().map(|(name, parameter)| {
            let affects: Vec<&str> = parameter.affects.iter().map(|element| element.letter()).collect();
            let domain = parameter
                .domain()
                .map_or_else(String::new, |domain| domain_caption(&domain, parameter));
            [
                name.clone(),
                <&str>::from(parameter.role).to_owned(),
                affects.join(" "),
                default_value(variants.first(), name, parameter),
                domain,
            ]
        });
        let headings = ["parameter", "role", "affects", "default", "range or choices"];
        output::line(format!("\n{}", table(headings, rows, &[])))?;
    }
    let rows = variants.iter().map(|variant| {
        let description = task.variant_description(variant.name()).unwrap_or_default();
        [variant.name().to_owned(), differing(variant), description.to_owned()]
    });
    output::line(format!(
        "\n{}",
        table(["variant", "differs from the defaults in", "what it is"], rows, &[])
    ))
}

/// A parameter's usual value: its default, its fixed value, or its distribution.
fn default_value(variant: Option<&Variant>, name: &str, parameter: &Parameter) -> String {
    let value = parameter.default.as_ref().or(parameter.value.as_ref());
    let drawn = variant.and_then(|variant| variant.distribution(name));
    match (value, drawn) {
        (Some(value), _) => value_caption(value, parameter),
        (None, Some(distribution)) => distribution.to_string(),
        (None, None) => String::new(),
    }
}

/// The values in which a variant differs from the defaults.
fn differing(variant: &Variant) -> String {
    let parameters = variant.task().parameters().iter();
    let differing = parameters.filter_map(|(name, parameter)| {
        let default = parameter.default.as_ref().and_then(|default| parameter.typed(default));
        let own = variant.value(name).filter(|own| default.as_ref() != Some(*own))?;
        (parameter.role == Role::Variant).then(|| whole(&format!("{name} = ")) + &value_caption(own, parameter))
    });
    differing.collect::<Vec<_>>().join(", ")
}

/// A value as in captions. Lines do not break beside its numbers or after the commas of a list.
fn value_caption(value: &Value, parameter: &Parameter) -> String {
    let typed = parameter.typed(value);
    let value = typed.as_ref().unwrap_or(value);
    let words = parameter.name_of(value).map_or_else(|| short(value), str::to_owned);
    if words.starts_with('[') {
        return whole(&words);
    }
    let numeric = |c: char| c.is_ascii_digit() || "×%-".contains(c);
    let mut caption = String::new();
    for word in words.split(' ') {
        if !caption.is_empty() {
            let is_kept = caption.ends_with(numeric) || (word.starts_with(numeric) && !caption.ends_with(','));
            caption.push(if is_kept { NO_BREAK } else { ' ' });
        }
        caption.push_str(word);
    }
    caption
}

/// Maximum number of choices listed per parameter.
const MAX_CHOICES: usize = 8;

/// Short description of a parameter's domain.
fn domain_caption(domain: &Domain, parameter: &Parameter) -> String {
    let unit = parameter
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" {unit}"));
    match domain {
        Domain::Range([low, high]) => whole(&format!("{low} to {high}{unit}")),
        Domain::Choices(choices)
            if parameter.kind == ParameterType::Distribution
                && choices.first().is_none_or(|one| parameter.name_of(one).is_none()) =>
        {
            format!("{} distributions", choices.len())
        }
        Domain::Choices(choices) => {
            let words: Vec<String> = choices.iter().map(|choice| value_caption(choice, parameter)).collect();
            // Words that contain commas need another separator.
            let separator = if words.iter().any(|words| words.contains(',')) {
                "; "
            } else {
                ", "
            };
            let more = match words.get(MAX_CHOICES..) {
                Some(more) if !more.is_empty() => format!("{separator}and {} more", more.len()),
                _ => String::new(),
            };
            let listed = words.iter().take(MAX_CHOICES).map(String::as_str).collect::<Vec<_>>();
            listed.join(separator) + &more + &whole(&unit)
        }
    }
}
