//! Families of variants: a grid or a sweep declares many variants at once, with stable names.

use indexmap::IndexMap;

use super::parameter::Parameter;
use super::variant_spec::VariantSpec;
use crate::describe::escape;
use crate::error::Problem;
use crate::names;
use crate::value::{ParameterType, Value};

/// Maximum number of variants of one task, after unfolding families.
const MAX_VARIANTS: usize = 10_000;

/// Maximum total number of values in the variants of a task: variants times parameters.
const MAX_VARIANT_VALUES: usize = 400_000;

/// Maximum length of a variant's name in characters, as in scenarios.
const MAX_NAME: usize = 100;

/// A single variant or a member of a family, ready to be resolved.
#[derive(Clone, Debug)]
pub(crate) struct Declared {
    pub(crate) extends: Option<String>,
    pub(crate) description: Option<String>,
    pub(crate) values: IndexMap<String, Value>,
    /// The key that declares it: its own name, or its family's.
    pub(crate) origin: String,
}

/// All variants of a task by name, with families unfolded.
pub(crate) type Variants = IndexMap<String, Declared>;

/// One axis of a family: a parameter with its values in order.
type Axis<'a> = (&'a String, Vec<Value>);

/// Describes what was found and expected if a task has too many variants, or too many values in them.
fn too_many(variants: usize, parameters: usize) -> Option<(String, String)> {
    if variants > MAX_VARIANTS {
        return Some((format!("{variants} variants"), format!("at most {MAX_VARIANTS} in all")));
    }
    (variants.saturating_mul(parameters) > MAX_VARIANT_VALUES).then(|| {
        let found = format!("{variants} variants of {parameters} parameters");
        (found, format!("at most {MAX_VARIANT_VALUES} values in all"))
    })
}

/// Fails if a document has too many variants, or too many values in them.
pub(crate) fn fits(variants: usize, parameters: usize) -> Result<(), Vec<Problem>> {
    too_many(variants, parameters).map_or(Ok(()), |(found, expected)| {
        let problem = Problem::new("spec/length", "/variants", found, expected);
        Err(vec![problem.advise("split the task")])
    })
}

/// Unfolds the families of a document.
pub(crate) fn unfold(
    parameters: &IndexMap<String, Parameter>,
    document: &IndexMap<String, VariantSpec>,
) -> (Variants, Vec<Problem>) {
    let mut variants = Variants::new();
    let mut problems = Vec::new();
    for (name, spec) in document {
        let pointer = format!("/variants/{}", escape(name));
        let family = axes_of(parameters, spec, &pointer).and_then(|axes| {
            Ok((
                pattern_of(spec, &axes, &pointer).map_err(|problem| vec![problem])?,
                axes,
            ))
        });
        let (pattern, axes) = match family {
            Ok(family) => family,
            Err(found) => {
                problems.extend(found);
                continue;
            }
        };
        let size = axes
            .iter()
            .fold(1_usize, |size, axis| size.saturating_mul(axis.1.len()));
        let total = variants.len().saturating_add(size);
        if let Some((found, expected)) = too_many(total, parameters.len()) {
            problems.push(Problem::new("spec/length", pointer, found, expected));
            continue;
        }
        for member in 0..size {
            let declared = member_of(name, pattern.as_deref(), spec, &axes, member);
            let characters = declared.0.chars().count();
            if characters > MAX_NAME {
                let found = format!("the variant name {:?} with {characters} characters", declared.0);
                let problem = Problem::new("spec/length", &pointer, found, format!("at most {MAX_NAME}"));
                problems.push(problem.advise("shorten the family's name, or list fewer parameters in it"));
                break;
            }
            if declared.0 != *name
                && let Some(problem) = names::problem(&pointer, &declared.0)
            {
                problems.push(problem);
                break;
            }
            if variants.insert(declared.0.clone(), declared.1).is_some() {
                let found = format!("two variants named {:?}", declared.0);
                problems.push(Problem::new(
                    "spec/duplicate-name",
                    &pointer,
                    found,
                    "a unique name for each variant",
                ));
            }
        }
    }
    (variants, problems)
}

/// A number of a sweep as a value of its parameter.
pub(super) fn value_of(parameter: Option<&Parameter>, number: f64) -> Value {
    match parameter {
        Some(known) if known.kind == ParameterType::Integer => Value::Integer(number.round() as i64),
        _ => Value::Number(number),
    }
}

/// The axes of a family, or its problems.
fn axes_of<'a>(
    parameters: &IndexMap<String, Parameter>,
    spec: &'a VariantSpec,
    pointer: &str,
) -> Result<Vec<Axis<'a>>, Vec<Problem>> {
    let mut axes: Vec<Axis> = Vec::new();
    let mut problems = Vec::new();
    for (name, values) in &spec.grid {
        axes.push((name, values.clone()));
    }
    for (name, sweep) in &spec.sweep {
        let at = format!("{pointer}/sweep/{}", escape(name));
        if let Some(values) = sweep.values() {
            let values = values.into_iter().map(|value| value_of(parameters.get(name), value));
            let mut values: Vec<Value> = values.collect();
            values.dedup();
            axes.push((name, values));
        } else {
            let found = format!("a logarithmic sweep from {} to {}", sweep.from, sweep.to);
            let expected = "both ends above 0, or linear spacing";
            problems.push(Problem::new("spec/value", at, found, expected));
        }
    }
    for (index, (name, _)) in axes.iter().enumerate() {
        if spec.values.contains_key(*name) || axes[..index].iter().any(|(other, _)| other == name) {
            let found = format!("{name:?} set twice in one family");
            problems.push(Problem::new(
                "spec/duplicate-name",
                pointer,
                found,
                "each parameter once",
            ));
        }
    }
    if problems.is_empty() { Ok(axes) } else { Err(problems) }
}

/// A piece of the name pattern of a family's members.
enum Piece<'a> {
    Text(&'a str),
    /// The value on the axis with this index.
    Value(usize),
}

/// The name pattern of a family's members, in pieces; `None` if the family gives none. Fails if it is invalid.
fn pattern_of<'a>(spec: &'a VariantSpec, axes: &[Axis], pointer: &str) -> Result<Option<Vec<Piece<'a>>>, Problem> {
    let Some(name) = spec.name.as_deref() else {
        return Ok(None);
    };
    let at = format!("{pointer}/name");
    let known: Vec<String> = axes.iter().map(|(parameter, _)| format!("{{{parameter}}}")).collect();
    let refused = |found: String, expected: String| Problem::new("spec/name", at.clone(), found, expected);
    if axes.is_empty() {
        let problem = refused(
            "a name pattern".to_owned(),
            "one in a family, with a grid or a sweep".to_owned(),
        );
        return Err(problem.advise("a single variant is named by its key"));
    }
    let mut pieces = Vec::new();
    let mut rest = name;
    while let Some((before, after)) = rest.split_once('{') {
        let Some((parameter, after)) = after.split_once('}') else {
            return Err(refused(format!("{name:?}"), "a } after every {".to_owned()));
        };
        let Some(axis) = axes.iter().position(|(known, _)| *known == parameter) else {
            let found = format!("{{{parameter}}}");
            let problem = refused(found.clone(), format!("one of {}", known.join(", ")));
            return Err(problem.suggest(&found, &known));
        };
        pieces.extend([Piece::Text(before), Piece::Value(axis)]);
        rest = after;
    }
    pieces.push(Piece::Text(rest));
    let is_named = |axis: usize| {
        pieces
            .iter()
            .any(|piece| matches!(piece, Piece::Value(named) if *named == axis))
    };
    match (0..axes.len()).find(|axis| axes[*axis].1.len() > 1 && !is_named(*axis)) {
        None => Ok(Some(pieces)),
        Some(axis) => Err(refused(
            format!("{name:?}"),
            format!("{} in it, so that every member has its own name", known[axis]),
        )),
    }
}

/// Member number `member` of a family, with the last axis varying fastest: its name and its declaration.
fn member_of(
    name: &str,
    pattern: Option<&[Piece]>,
    spec: &VariantSpec,
    axes: &[Axis],
    member: usize,
) -> (String, Declared) {
    let mut words = Vec::with_capacity(axes.len());
    let mut values = spec.values.clone();
    let mut stride: usize = axes.iter().map(|axis| axis.1.len()).product();
    for (parameter, options) in axes {
        stride /= options.len().max(1);
        let index = member / stride % options.len();
        words.push(word(&options[index], index));
        values.insert((*parameter).clone(), options[index].clone());
    }
    let own = match pattern {
        _ if axes.is_empty() => name.to_owned(),
        None => format!("{name}-{}", words.join("-")),
        Some(pieces) => pieces
            .iter()
            .map(|piece| match piece {
                Piece::Text(text) => text,
                Piece::Value(axis) => words[*axis].as_str(),
            })
            .collect(),
    };
    let declared = Declared {
        extends: spec.extends.clone(),
        description: spec.description.clone(),
        values,
        origin: name.to_owned(),
    };
    (own, declared)
}

/// A value as part of a name, made of letters, digits, `.`, `+`, `_` and the minus sign of a number.
fn word(value: &Value, index: usize) -> String {
    let numbers = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join("_");
    match value {
        Value::Distribution(distribution) => format!("{}{index}", distribution.name()),
        Value::Color(color) if color.describe().starts_with('[') => color.hex(),
        Value::Point(point) => numbers(point),
        Value::Vector(vector) => numbers(vector),
        Value::Number(number) => number.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Json(json) => word_of_json(json, index),
        Value::Layout(_) => word_of_json(&value.to_json(), index),
        other => {
            let plain = |c: char| {
                if c.is_alphanumeric() || matches!(c, '.' | '+' | '_') {
                    c
                } else {
                    '_'
                }
            };
            other.to_string().chars().map(plain).take(40).collect()
        }
    }
}

/// JSON as part of a name: words, numbers and short lists of words unchanged, anything else with an index.
fn word_of_json(json: &serde_json::Value, index: usize) -> String {
    use serde_json::Value as Json;
    match json {
        Json::Null => "none".to_owned(),
        Json::String(text) => word(&Value::Text(text.clone()), index),
        Json::Bool(_) | Json::Number(_) => json.to_string(),
        Json::Array(list) if !list.is_empty() && list.iter().all(Json::is_string) && list.len() <= 4 => {
            let words: Vec<String> = list.iter().map(|item| word_of_json(item, index)).collect();
            words.join("_")
        }
        Json::Array(_) => format!("list{index}"),
        Json::Object(map) => {
            let key = map.keys().next().map_or("object", String::as_str);
            format!("{}{index}", word(&Value::Text(key.to_owned()), index))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::task::{Spacing, Sweep};

    fn family(json: &str) -> Vec<String> {
        let spec: IndexMap<String, VariantSpec> = serde_json::from_str(json).unwrap();
        unfold(&IndexMap::new(), &spec).0.into_keys().collect()
    }

    fn refused(json: &str) -> String {
        let spec: IndexMap<String, VariantSpec> = serde_json::from_str(json).unwrap();
        let (_, problems) = unfold(&IndexMap::new(), &spec);
        let messages = problems
            .iter()
            .map(|problem| format!("{}: {}, {}", problem.pointer, problem.found, problem.expected));
        messages.collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn family_may_give_a_name_pattern() {
        let named = |name: &str| {
            format!(r#"{{ "look": {{ "name": "{name}", "grid": {{ "color": ["red", "blue"], "light": [0.5] }} }} }}"#)
        };
        assert_eq!(family(&named("{color}-{light}")), ["red-0.5", "blue-0.5"]);
        assert_eq!(family(&named("in_{color}")), ["in_red", "in_blue"]);
        assert_eq!(
            refused(&named("{colour}")),
            "/variants/look/name: {colour}, one of {color}, {light}"
        );
        assert!(refused(&named("{light}")).contains("{color} in it"));
        assert!(refused(&named("{color")).contains("a } after every {"));
        assert!(refused(r#"{ "red": { "name": "rot" } }"#).contains("a grid or a sweep"));
    }

    #[test]
    fn grid_unfolds_into_all_combinations_with_the_last_axis_fastest() {
        assert_eq!(
            family(r#"{ "look": { "grid": { "color": ["red", [0.1, 0.2, 0.3]], "light": [0.5, -2] } } }"#),
            ["look-red-0.5", "look-red--2", "look-1a334d-0.5", "look-1a334d--2"]
        );
    }

    #[test]
    fn sweep_includes_both_ends_and_rounds_numbers() {
        assert_eq!(
            family(r#"{ "dim": { "sweep": { "light": { "from": 0.1, "to": 0.5, "steps": 5 } } } }"#),
            ["dim-0.1", "dim-0.2", "dim-0.3", "dim-0.4", "dim-0.5"]
        );
        let decades = Sweep {
            from: 0.01,
            to: 100.0,
            steps: 5,
            spacing: Spacing::Logarithmic,
        };
        assert_eq!(decades.values(), Some(vec![0.01, 0.1, 1.0, 10.0, 100.0]));
    }
}
