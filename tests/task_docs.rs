//! The tables of `docs/tasks.md` say what the specs of the built-in tasks say. `DRIFTWORLD_UPDATE_GOLDEN=1` writes them anew.

use std::fmt::Write;

use driftworld::spec::{Domain, Element, Parameter, Role, TaskSpec, Value, Variant};
use driftworld::tasks;

const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/tasks.md");

/// The tables of a task: its parameters, and its variants beside the first.
fn tables(task: &std::sync::Arc<TaskSpec>) -> String {
    let mut text = "| parameter | affects | values | default | |\n|---|---|---|---|---|\n".to_owned();
    for (name, parameter) in task.parameters() {
        let said = parameter.description.as_deref().unwrap_or_default();
        let affects: Vec<&str> = parameter.affects.iter().map(|element| element.letter()).collect();
        let (values, default) = (values(parameter), default(parameter));
        let _ = writeln!(
            text,
            "| `{name}` | {} | {values} | {default} | {said} |",
            affects.join(" ")
        );
    }
    let variants = task.all_variants();
    let first = variants.first().map_or("", |variant| variant.name());
    let _ = writeln!(
        text,
        "\n| variant | differs from `{first}` in | values | |\n|---|---|---|---|"
    );
    for variant in &variants {
        let changed = changed(&variants[0], variant);
        let elements = Element::ALL.into_iter().filter(|element| {
            let touched = |(name, _): &(&String, String)| task.parameters()[*name].affects.contains(element);
            changed.iter().any(touched)
        });
        let elements: Vec<&str> = elements.map(Element::letter).collect();
        let values: Vec<String> = changed
            .iter()
            .map(|(name, value)| format!("`{name}` {value}"))
            .collect();
        let said = task.variant_description(variant.name()).unwrap_or_default();
        let (name, elements, values) = (variant.name(), elements.join(" "), values.join(", "));
        let _ = writeln!(text, "| `{name}` | {elements} | {values} | {said} |");
    }
    text
}

fn values(parameter: &Parameter) -> String {
    let unit = parameter
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" {unit}"));
    match (parameter.role, parameter.domain()) {
        (Role::Fixed, _) => "fixed".to_owned(),
        (Role::Randomized, _) => "drawn for every world".to_owned(),
        (_, Some(Domain::Range([low, high]))) => format!("{low} to {high}{unit}"),
        (_, Some(Domain::Choices(choices))) => {
            choices.iter().map(Value::to_string).collect::<Vec<_>>().join(", ") + &unit
        }
        (Role::Variant, None) => String::new(),
    }
}

fn default(parameter: &Parameter) -> String {
    let value = parameter.default.as_ref().or(parameter.value.as_ref());
    value.map_or_else(String::new, Value::to_string)
}

/// The parameters that a variant sets otherwise than another, with their values.
fn changed<'a>(first: &Variant, variant: &'a Variant) -> Vec<(&'a String, String)> {
    let values = variant.task().parameters().keys();
    values
        .filter(|name| first.value(name) != variant.value(name))
        .filter_map(|name| Some((name, variant.value(name)?.to_string())))
        .collect()
}

/// A text with what stands between a task's marks replaced.
fn with_tables(docs: &str) -> String {
    let mut docs = docs.to_owned();
    for name in tasks::built_in_names() {
        let (begin, end) = (
            format!("<!-- tables of {name} -->\n"),
            format!("<!-- end of {name} -->"),
        );
        let from = docs
            .find(&begin)
            .unwrap_or_else(|| panic!("docs/tasks.md has no line {begin:?}"))
            + begin.len();
        let to = docs
            .find(&end)
            .unwrap_or_else(|| panic!("docs/tasks.md has no line {end:?}"));
        let task = tasks::task(name).unwrap_or_else(|error| panic!("{error}"));
        docs.replace_range(from..to, &tables(&task));
    }
    docs
}

#[test]
fn the_tables_of_tasks_are_those_of_the_specs() {
    let found = std::fs::read_to_string(DOCS).expect("the docs are committed");
    let expected = with_tables(&found);
    if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
        std::fs::write(DOCS, &expected).expect("the docs can be written");
        return;
    }
    for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        let line = number + 1;
        assert_eq!(
            found, expected,
            "docs/tasks.md:{line}; DRIFTWORLD_UPDATE_GOLDEN=1 writes the tables anew"
        );
    }
    assert_eq!(
        found, expected,
        "docs/tasks.md; DRIFTWORLD_UPDATE_GOLDEN=1 writes the tables anew"
    );
}
