//! `driftworld vary`: finds a variant at a given distance from another.

use std::path::PathBuf;

use crate::generator::{Subject, at_distance};
use crate::similarity::{VariantMeasure, Weights};
use crate::spec::{DEFAULT_VARIANT, Element, TaskSpec, Variant};
use crate::{numbers, tasks};
use clap::Args;
use serde_json::{Map, Value, json};

use super::output;
use crate::{Failure, overwrite};

/// Find a variant at a given distance from another.
///
/// Changes one element of the decision process, or the parameters that you name, as few of them as will do. Prints the
/// values that the variant sets, ready to paste into the task spec, and those that stay unchanged.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld vary find_objects#red --element reward --distance 0.5
  driftworld vary find_objects#red --parameters light,spread --distance 0.2 --name dim --json
  driftworld vary find_objects#red --element observation --distance 1.5 -o my_task.json")]
pub(crate) struct Vary {
    /// The variant to start from: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    variant: String,
    /// Change the parameters of this element, and measure the distance in it: state, action, transition, reward or observation.
    #[arg(long, value_parser = crate::design::element, required_unless_present = "parameters", conflicts_with = "parameters")]
    element: Option<Element>,
    /// Change these parameters, and measure the total distance.
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    parameters: Vec<String>,
    /// The distance to reach: 0 or more, where 1 is one parameter moved over its whole range.
    #[arg(long, value_parser = numbers::distance, allow_negative_numbers = true)]
    distance: f64,
    /// How far the result may be from that distance.
    #[arg(long, default_value = "0.001", value_parser = numbers::distance, allow_negative_numbers = true)]
    tolerance: f64,
    /// Name of the new variant.
    #[arg(long, default_value = "found", value_parser = numbers::name)]
    name: String,
    /// Also write the task spec with the new variant at its end to this file.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists.
    #[arg(long, requires = "output")]
    force: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Vary {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let from = tasks::variant(&self.variant)?;
        let task = from.task();
        if task.variant_names().contains(&self.name.as_str()) || self.name == DEFAULT_VARIANT {
            return Err(Failure::usage(format!(
                "--name: found {:?}, which {} already has, expected a name that no variant has; if pasted, it would \
                 replace that one",
                self.name,
                task.name()
            )));
        }
        if let Some(path) = self.output.as_ref().filter(|_| !self.force)
            && !output::is_stdout(path)
            && path.is_file()
        {
            return Err(overwrite::exists(path, "name another file, or replace it with --force"));
        }
        let subject = match self.element {
            Some(element) => Subject::Element(element),
            None => Subject::Parameters(self.parameters.clone()),
        };
        let measured = VariantMeasure::new(from.task(), Weights::of_task(from.task()));
        let measure = |other: &Variant| {
            // Distributions of unbounded numbers have no finite distance: they count as infinitely far.
            let distance = measured.between(&from, other);
            distance.map_or(f64::INFINITY, |distance| distance.within(self.element))
        };
        let found = at_distance(&from, &subject, self.distance, self.tolerance, measure)?;
        let changed = found
            .variant
            .values()
            .iter()
            .filter(|(name, value)| from.value(name) != Some(*value));
        let values: Map<_, _> = changed.map(|(name, value)| (name.clone(), value.to_json())).collect();
        let mut declared = Map::new();
        if from.task().variant_names().contains(&from.name()) {
            declared.insert("extends".to_owned(), json!(from.name()));
        }
        declared.extend(values);
        if let Some(path) = &self.output {
            output::write_or_print(path, &with_variant(&found.variant, &self.name, &declared)?)?;
        }
        let held = subject.parameters(&from).into_iter().filter_map(|name| {
            let value = from
                .value(name)
                .filter(|value| found.variant.value(name) == Some(value))?;
            Some((name, value))
        });
        let held: Vec<_> = held.collect();
        if self.json {
            let held: Map<_, _> = held
                .into_iter()
                .map(|(name, value)| (name.to_owned(), value.to_json()))
                .collect();
            return output::json(&json!({
                "from": from.id(), "distance": found.distance, "variant": { self.name: declared }, "held": held,
            }));
        }
        output::line(format!("{} from {}:", rounded(found.distance), from.id()))?;
        let entry = serde_json::to_string_pretty(&json!({ self.name: declared }))?;
        // Without the outer braces, the entry can be pasted between two variants.
        let inner: Vec<&str> = entry.lines().skip(1).collect();
        output::print_json(&(inner[..inner.len() - 1].join("\n") + "\n"))?;
        if held.is_empty() {
            return Ok(());
        }
        let held: Vec<String> = held
            .into_iter()
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        output::line(format!("holds: {}", held.join(", ")))
    }
}

/// The task's document with a new variant appended, declared so that it equals `found`.
fn with_variant(found: &Variant, name: &str, declared: &Map<String, Value>) -> Result<String, Failure> {
    let mut document: Value = serde_json::from_str(&found.task().to_json())?;
    document["variants"][name] = Value::Object(declared.clone());
    let text = serde_json::to_string_pretty(&document)? + "\n";
    let parsed = TaskSpec::from_json(name, &text)?.variant(name)?;
    debug_assert_eq!(parsed.values(), found.values(), "same values");
    Ok(text)
}

fn rounded(distance: f64) -> String {
    format!("{distance:.4}")
}
