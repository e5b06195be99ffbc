//! Describes tasks for the page: the gallery, a task's parameters for sliders and pickers, and the problems of a text.

use driftworld::documents::{self, Kind};
use driftworld::env::Catalogue;
use driftworld::spec::{Choices, Domain, Parameter, Role, TaskSpec, schema};
use driftworld::tasks;
use serde_json::{Value, json};
use std::sync::Arc;

use crate::fault::{Fault, problems_of};

/// Maximum number of example variants on a card.
const MAX_EXAMPLES: usize = 4;

/// All built-in tasks.
pub(crate) fn cards() -> Result<Value, Fault> {
    let mut cards = Vec::new();
    for (group, names) in tasks::groups() {
        let group = group.replace("the paper's", "the L2Explorer paper");
        for (name, _) in names {
            let task = tasks::task(name)?;
            let example =
                |variant: &&str| Some(json!({ "variant": variant, "description": task.variant_description(variant)? }));
            let variants = task.variant_names();
            cards.push(json!({
                "name": name, "group": group, "description": task.description(), "variants": variants,
                "examples": variants.iter().filter_map(example).take(MAX_EXAMPLES).collect::<Vec<_>>(),
            }));
        }
    }
    Ok(Value::Array(cards))
}

/// A task with its parameters and variants, and the text that it was read from.
pub(crate) fn describe(task: &Arc<TaskSpec>, text: &str) -> Value {
    let variants = task.all_variants().into_iter().map(|variant| {
        let name = variant.name();
        json!({ "name": name, "description": task.variant_description(name), "values": variant.values() })
    });
    let families = task
        .family_names()
        .into_iter()
        .map(|name| json!({ "name": name, "members": task.family(name) }));
    let requirements = task.requirements().iter().map(ToString::to_string);
    json!({
        "name": task.name(), "description": task.description(), "text": text,
        "parameters": task.parameters().iter().map(|(name, parameter)| describe_parameter(name, parameter)).collect::<Vec<_>>(),
        "variants": variants.collect::<Vec<_>>(), "families": families.collect::<Vec<_>>(),
        "requirements": requirements.collect::<Vec<_>>(),
    })
}

fn describe_parameter(name: &str, parameter: &Parameter) -> Value {
    let (mut range, mut choices) = (Value::Null, Value::Null);
    match parameter.domain() {
        Some(Domain::Range(ends)) => range = json!(ends),
        Some(Domain::Choices(values)) => {
            let names = parameter.choices.as_ref().map(Choices::names).unwrap_or_default();
            let choice = |(index, value)| json!({ "value": value, "name": names.get(index) });
            choices = values.iter().enumerate().map(choice).collect();
        }
        None => {}
    }
    let value = match parameter.role {
        Role::Fixed => &parameter.value,
        Role::Variant | Role::Randomized => &parameter.default,
    };
    json!({
        "name": name, "role": parameter.role, "type": parameter.kind, "affects": parameter.affects, "unit": parameter.unit,
        "description": parameter.description, "range": range, "choices": choices, "value": value,
        "distribution": parameter.distribution, "read_if": parameter.read_if,
    })
}

/// The problems and warnings of a text.
pub(crate) fn validate(text: &str) -> Value {
    let kind = Kind::of(text);
    let classes = tasks::classes(&Catalogue::default());
    let checked = documents::check(kind.word(), text, kind, &mut tasks::task, &classes);
    let mut warnings = checked.warnings;
    warnings.extend(checked.missing_tasks);
    warnings.extend(checked.same_log_name.map(|error| error.to_string()));
    json!({
        "kind": kind.word(), "warnings": warnings,
        "problems": checked.error.as_ref().map(problems_of).unwrap_or_default(),
        "more": checked.error.is_some_and(|error| error.has_more()),
    })
}

/// The schema of a kind of document.
pub(crate) fn schema_of(kind: &str) -> Result<Value, Fault> {
    let all = schema::all();
    let kinds = all.map(|(name, _)| name.trim_end_matches(".schema.json"));
    let found = all.iter().zip(kinds).find(|(_, known)| *known == kind);
    found
        .map(|((_, schema), _)| schema.json().clone())
        .ok_or_else(|| Fault::request(format!("schema: found {kind:?}, expected one of {}", kinds.join(", "))))
}
