//! `driftworld vary`: a variant at a wanted distance from another. The search is the generator's, the distance `similarity`'s.

use crate::generator::{Subject, at_distance};
use crate::similarity::{VariantMeasure, Weights};
use crate::spec::{DEFAULT_VARIANT, Element, Variant, sound_name};
use crate::tasks;
use clap::Args;
use serde_json::{Map, json};

use super::{Failure, output};

/// Find a variant at a wanted distance from another.
///
/// One element of the decision process is changed, or some parameters.
///
/// Prints what the variant sets, ready to be pasted among the variants of the task spec.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld vary find_objects#red --element R --distance 0.5
  driftworld vary find_objects#red --parameters light,spread --distance 0.2 --name dim --json")]
pub(crate) struct Vary {
    /// A task's variant: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    variant: String,
    /// Change the parameters that affect this element alone, and measure in it: S, A, T, R or O.
    #[arg(long, value_parser = element, required_unless_present = "parameters", conflicts_with = "parameters")]
    element: Option<Element>,
    /// Change these parameters, and measure the whole distance.
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    parameters: Vec<String>,
    /// The wanted distance, 0 to 1.
    #[arg(long, value_parser = distance)]
    distance: f64,
    /// How far off the distance may be.
    #[arg(long, default_value = "0.001", value_parser = distance, allow_negative_numbers = true)]
    tolerance: f64,
    /// The new variant's name.
    #[arg(long, default_value = "found", value_parser = name)]
    name: String,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

fn element(text: &str) -> Result<Element, String> {
    Element::ALL
        .into_iter()
        .find(|element| element.letter().eq_ignore_ascii_case(text) || element.name() == text)
        .ok_or_else(|| "expected S, A, T, R or O".to_owned())
}

fn distance(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|distance| (0.0..=1.0).contains(distance))
        .ok_or_else(|| "expected a number in 0..1".to_owned())
}

fn name(text: &str) -> Result<String, String> {
    sound_name(text).map(|()| text.to_owned())
}

impl Vary {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let from = tasks::variant(&self.variant)?;
        let task = from.task();
        if task.variant_names().contains(&self.name.as_str()) || self.name == DEFAULT_VARIANT {
            return Err(Failure::usage(format!(
                "--name: found {:?}, which {} has already, expected a name that no variant has; pasted, it would take that one's place",
                self.name,
                task.name()
            )));
        }
        let subject = match self.element {
            Some(element) => Subject::Element(element),
            None => Subject::Parameters(self.parameters.clone()),
        };
        let measured = VariantMeasure::new(from.task(), Weights::of_task(from.task()));
        let measure = |other: &Variant| {
            // Distributions of numbers beyond all bounds have no finite distance: farther than any that can be asked for.
            let Ok(distance) = measured.between(&from, other) else {
                return f64::INFINITY;
            };
            match self.element {
                Some(element) => distance.element(element).unwrap_or(0.0),
                None => distance.total,
            }
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
        if self.json {
            return output::json(
                &json!({ "from": from.id(), "distance": found.distance, "variant": { self.name: declared } }),
            );
        }
        output::line(format!("{} from {}:", rounded(found.distance), from.id()))?;
        let entry = serde_json::to_string_pretty(&json!({ self.name: declared }))?;
        // Without the outer braces it can be pasted between two variants.
        let inner: Vec<&str> = entry.lines().skip(1).collect();
        output::print_json(&(inner[..inner.len() - 1].join("\n") + "\n"))
    }
}

fn rounded(distance: f64) -> String {
    format!("{distance:.4}")
}
