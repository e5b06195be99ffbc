//! Tests that the tables of `docs/tasks.md` and `docs/curricula.md` match the built-in tasks and the curricula in
//! `examples/curricula/`. `DRIFTWORLD_UPDATE_GOLDEN=1` updates the tables.

use std::fmt::Write;

use driftworld::elements::Optimum;
use driftworld::env::{Agent, Catalogue, Environment, OnRailsAgent, StillAgent};
use driftworld::generator::Sampler;
use driftworld::spec::{BlockKind, Domain, Element, Parameter, Role, Scenario, TaskSpec, Value, Variant};
use driftworld::tasks;

/// Worlds per variant in which agents are measured.
const WORLDS: u64 = 8;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The tables of a task: its parameters, and its variants compared with the first.
fn tables(task: &std::sync::Arc<TaskSpec>) -> String {
    let mut text = "| parameter | affects | values | default | |\n|---|---|---|---|---|\n".to_owned();
    for (name, parameter) in task.parameters() {
        let description = parameter.description.as_deref().unwrap_or_default();
        let affects: Vec<&str> = parameter.affects.iter().map(|element| element.letter()).collect();
        let (values, default) = (values(parameter), default(parameter));
        let _ = writeln!(
            text,
            "| `{name}` | {} | {values} | {default} | {description} |",
            affects.join(" ")
        );
    }
    let variants = task.all_variants();
    let first = variants.first().map_or("", |variant| variant.name());
    let _ = writeln!(
        text,
        "\n| variant | differs from `{first}` in | best changes | values | |\n|---|---|---|---|---|"
    );
    for variant in &variants {
        let changed = changed(&variants[0], variant);
        let elements = Element::WITH_FINE.into_iter().filter(|element| {
            let affects = |(name, _): &(&String, String)| task.parameters()[*name].affects.contains(element);
            changed.iter().any(affects)
        });
        let elements: Vec<Element> = elements.collect();
        let turned = turned(&variants[0], variant, &elements);
        let elements: Vec<&str> = elements.into_iter().map(Element::letter).collect();
        let values: Vec<String> = changed
            .iter()
            .map(|(name, value)| format!("`{name}` {value}"))
            .collect();
        let description = task.variant_description(variant.name()).unwrap_or_default();
        let (name, elements, values) = (variant.name(), elements.join(" "), values.join(", "));
        let _ = writeln!(text, "| `{name}` | {elements} | {turned} | {values} | {description} |");
    }
    text
}

/// Whether a variant that changes the reward also changes the first variant's optimum, and the regret of the first's expert.
fn turned(first: &Variant, variant: &Variant, elements: &[Element]) -> String {
    if !elements.contains(&Element::R) {
        return String::new();
    }
    let optimum = Optimum::measure(first, variant, 0, WORLDS, &Catalogue::default());
    let optimum = optimum.unwrap_or_else(|error| panic!("{error}"));
    if optimum.turned {
        format!("yes, {:.0} points", optimum.regret)
    } else {
        "no".to_owned()
    }
}

/// The mean reward of an agent in the first worlds of a variant.
fn earned(variant: &Variant, mut agent: impl Agent) -> f64 {
    let sampler = Sampler::new(variant, 0);
    let each = (0..WORLDS).map(|index| {
        let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
        let mut environment = Environment::new(world);
        agent.begin(index);
        while !environment.ended() {
            let action = agent.act(&environment);
            environment.step(action).unwrap_or_else(|error| panic!("{error}"));
        }
        environment.episode_return()
    });
    each.sum::<f64>() / WORLDS as f64
}

/// The variants in which standing still earns at least as much as the planner, or nearly so.
fn still() -> String {
    let mut text = "| variant | standing still | `onrails` | |\n|---|---|---|---|\n".to_owned();
    for variant in tasks::built_in_names()
        .into_iter()
        .flat_map(|name| tasks::variants(name).unwrap_or_else(|error| panic!("{error}")))
    {
        let (still, rails) = (earned(&variant, StillAgent), earned(&variant, OnRailsAgent::new()));
        let remark = match still {
            still if still >= rails => "standing still is best",
            still if still > 0.0 && still >= 0.9 * rails => "standing still is nearly best",
            _ => continue,
        };
        let _ = writeln!(text, "| `{}` | {still:.1} | {rails:.1} | {remark} |", variant.id());
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

/// The parameters that a variant sets differently from another, with their values.
fn changed<'a>(first: &Variant, variant: &'a Variant) -> Vec<(&'a String, String)> {
    let values = variant.task().parameters().keys();
    values
        .filter(|name| first.value(name) != variant.value(name))
        .filter_map(|name| Some((name, variant.value(name)?.to_string())))
        .collect()
}

/// Replaces the text between two marks.
fn replaced(docs: &mut String, name: &str, text: &str) {
    let (begin, end) = (
        format!("<!-- tables of {name} -->\n"),
        format!("<!-- end of {name} -->"),
    );
    let from = docs
        .find(&begin)
        .unwrap_or_else(|| panic!("the docs have no line {begin:?}"))
        + begin.len();
    let to = docs
        .find(&end)
        .unwrap_or_else(|| panic!("the docs have no line {end:?}"));
    docs.replace_range(from..to, text);
}

/// Compares a page with its expected tables, or updates it.
fn check(page: &str, write: impl Fn(&mut String)) {
    let path = format!("{ROOT}/{page}");
    let found = std::fs::read_to_string(&path).expect("the docs are committed");
    let mut expected = found.clone();
    write(&mut expected);
    if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
        std::fs::write(path, &expected).expect("the docs can be written");
        return;
    }
    for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        let line = number + 1;
        assert_eq!(
            found, expected,
            "{page}:{line}; DRIFTWORLD_UPDATE_GOLDEN=1 rewrites the tables"
        );
    }
    assert_eq!(
        found, expected,
        "{page}; DRIFTWORLD_UPDATE_GOLDEN=1 rewrites the tables"
    );
}

#[test]
fn task_tables_match_the_specs() {
    check("docs/tasks.md", |docs| {
        for name in tasks::built_in_names() {
            let task = tasks::task(name).unwrap_or_else(|error| panic!("{error}"));
            replaced(docs, name, &tables(&task));
        }
        replaced(docs, "still", &still());
    });
}

/// The curricula, one row each: what each learns, and its number of experiences.
fn curricula() -> String {
    let mut text = "| file | learned, in this order | experiences | |\n|---|---|---|---|\n".to_owned();
    for name in "reward state transition observation action blue_red_green map modality interaction drift \
         across_tasks families_abrupt families_gradual families_drifting families_modality families_interaction"
        .split(' ')
    {
        let path = format!("{ROOT}/examples/curricula/{name}.json");
        let document = std::fs::read_to_string(path).expect("the curricula are committed");
        let scenario = Scenario::from_json(name, &document).unwrap_or_else(|error| panic!("{error}"));
        let learning = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
        let regimes: Vec<_> = learning.flat_map(|block| &block.regimes).collect();
        let mut tasks: Vec<&str> = regimes.iter().map(|regime| regime.task.as_str()).collect();
        tasks.dedup();
        let of = |task: &str| {
            let own = regimes.iter().filter(|regime| regime.task == task);
            let variants: Vec<String> = own.map(|regime| format!("`{}`", regime.variant)).collect();
            format!("`{task}`: {}", variants.join(", "))
        };
        let learned: Vec<String> = tasks.into_iter().map(of).collect();
        let (learned, count, description) = (learned.join("; "), scenario.num_experiences(), &scenario.description);
        let file = format!("[{name}.json](../examples/curricula/{name}.json)");
        let _ = writeln!(text, "| {file} | {learned} | {count} | {description} |");
    }
    text
}

#[test]
fn curricula_table_matches_the_files() {
    check("docs/curricula.md", |docs| replaced(docs, "curricula", &curricula()));
}
