//! [`VariantSpec`]: a variant as declared in a document. Applies its values on top of those of the variants that it extends,
//! and checks them.

use driftworld_text::IDENTIFIER_PATTERN;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DEFAULT_VARIANT;
use super::family::{Sweep, Variants};
use super::parameter::{Parameter, Role};
use crate::describe::escape;
use crate::error::{MAX_PROBLEMS, Problem, first_of};
use crate::suggest::nearest;
use crate::value::Value;

/// A variant, or a family of them, as a document declares it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(transform = values_of_parameters)]
#[schemars(extend("examples" = [
    { "extends": "day", "description": "Red cubes at dusk.", "light": 0.6 },
    { "name": "{target_color}-{light}", "grid": { "target_color": ["red", "green"], "light": [0.6, 2.3] } },
    { "sweep": { "light": { "from": 0.2, "to": 4, "steps": 5 } } },
]))]
pub struct VariantSpec {
    /// The variant that it extends, overriding its values; the defaults if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 200))]
    pub extends: Option<String>,
    /// The variant in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// For a family: the name pattern of its members, with a parameter in braces for each value, such as
    /// `{target_color}-{light}`. If absent, members are named after the family and its values, such as `look-red-0.5`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 200))]
    pub name: Option<String>,
    /// Makes it a family: lists values for each parameter; one variant for every combination, named by `name`.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(schema_with = "grid_schema")]
    pub grid: IndexMap<String, Vec<Value>>,
    /// Makes it a family: evenly spaced values for each parameter, combined with the grid and with each other.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(length(min = 1, max = 20))]
    pub sweep: IndexMap<String, Sweep>,
    /// Values of variant parameters.
    #[serde(flatten)]
    #[schemars(with = "IndexMap<String, serde_json::Value>")]
    pub values: IndexMap<String, Value>,
}

/// The keys of a variant that are not names of parameters.
pub(crate) const RESERVED: [&str; 5] = ["extends", "description", "name", "grid", "sweep"];

fn values_of_parameters(schema: &mut schemars::Schema) {
    schema.insert(
        "propertyNames".to_owned(),
        serde_json::json!({ "pattern": IDENTIFIER_PATTERN, "maxLength": 100 }),
    );
    if let Some(map) = schema
        .pointer_mut("/properties/sweep")
        .and_then(serde_json::Value::as_object_mut)
    {
        map.insert("minProperties".to_owned(), serde_json::json!(1));
        map.insert("maxProperties".to_owned(), serde_json::json!(20));
    }
}

/// For each parameter, a list of values; the parameter's type determines what is allowed.
fn grid_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({
        "type": "object",
        "additionalProperties": { "type": "array", "items": true, "minItems": 1, "maxItems": 1000 },
        "minProperties": 1,
        "maxProperties": 20
    })
}

/// Maximum length of a chain of variants that extend each other.
pub(crate) const MAX_EXTENDED: usize = 100;

/// The values of a variant: its own, then those of the variants that it extends, then the defaults.
///
/// Fails if the chain of `extends` is broken, cyclic or too long; [`problems`] finds invalid values.
pub(crate) fn values_of(
    parameters: &IndexMap<String, Parameter>,
    variants: &Variants,
    name: &str,
) -> Result<IndexMap<String, Value>, Problem> {
    let mut chain: Vec<&str> = Vec::new();
    let mut next = variants.get(name).map(|variant| (name, variant));
    while let Some((name, variant)) = next {
        let pointer = |start: &str| format!("/variants/{}/extends", escape(&variants[start].origin));
        if let Some(first) = chain.iter().position(|known| *known == name) {
            let found = format!("a cycle: {} extends {name}", chain[first..].join(" extends "));
            let expected = "a chain of extends that ends";
            return Err(Problem::new("spec/extends-cycle", pointer(chain[0]), found, expected));
        }
        chain.push(name);
        if chain.len() > MAX_EXTENDED {
            let found = format!("a chain of more than {MAX_EXTENDED} variants that extend each other");
            let expected = format!("at most {MAX_EXTENDED}");
            let problem = Problem::new("spec/length", pointer(chain[0]), found, expected);
            return Err(problem.advise("extend a variant further up"));
        }
        next = match &variant.extends {
            None => None,
            Some(parent) if parent == DEFAULT_VARIANT && !variants.contains_key(parent) => None,
            Some(parent) => Some((
                parent,
                variants
                    .get(parent)
                    .ok_or_else(|| unknown_parent(&variant.origin, parent, variants))?,
            )),
        };
    }
    let mut values = IndexMap::new();
    for (parameter, declared) in parameters
        .iter()
        .filter(|(_, declared)| declared.role != Role::Randomized)
    {
        let own = chain.iter().find_map(|name| variants[*name].values.get(parameter));
        let value = own.or(declared.default.as_ref()).or(declared.value.as_ref());
        if let Some(typed) = value.and_then(|value| declared.typed(value)) {
            values.insert(parameter.clone(), typed);
        }
    }
    Ok(values)
}

fn unknown_parent(origin: &str, parent: &str, variants: &Variants) -> Problem {
    let known: Vec<&str> = variants.keys().map(String::as_str).chain([DEFAULT_VARIANT]).collect();
    let shown = first_of(&known);
    Problem::new(
        "spec/unknown-variant",
        format!("/variants/{}/extends", escape(origin)),
        format!("{parent:?}"),
        format!("one of {shown}"),
    )
    .suggest(parent, known)
}

/// All problems of variants, except those of values of unsound parameters.
pub(crate) fn problems(
    parameters: &IndexMap<String, Parameter>,
    document: &IndexMap<String, VariantSpec>,
    variants: &Variants,
    is_unsound: impl Fn(&str) -> bool,
) -> Vec<Problem> {
    let mut problems: Vec<Problem> = variants
        .keys()
        .filter_map(|name| values_of(parameters, variants, name).err())
        .take(MAX_PROBLEMS + 1)
        .collect();
    problems.dedup();
    let check = |pointer: &str, parameter: &str, value: &Value| {
        if is_unsound(parameter) {
            return Vec::new();
        }
        problems_of(parameters, pointer, parameter, value)
    };
    for (name, variant) in document {
        for (parameter, value) in &variant.values {
            if problems.len() > MAX_PROBLEMS {
                return problems;
            }
            problems.extend(check(
                &format!("/variants/{}/{}", escape(name), escape(parameter)),
                parameter,
                value,
            ));
        }
        problems.extend(super::family::problems(parameters, name, variant, check));
    }
    problems
}

/// The parameters that variants may set, and the expectation to report if a different name is found.
pub(super) fn variant_parameters(parameters: &IndexMap<String, Parameter>) -> (Vec<&String>, String) {
    let settable = parameters
        .iter()
        .filter(|(_, parameter)| parameter.role == Role::Variant);
    let known: Vec<&String> = settable.map(|(name, _)| name).collect();
    let expected = format!("a variant parameter, one of {}", first_of(&known));
    (known, expected)
}

fn problems_of(parameters: &IndexMap<String, Parameter>, pointer: &str, name: &str, value: &Value) -> Vec<Problem> {
    let Some(parameter) = parameters.get(name) else {
        let (known, expected) = variant_parameters(parameters);
        let found = format!("the unknown parameter {name:?}");
        let near = nearest(name, &known).or_else(|| nearest(name, RESERVED));
        return vec![Problem {
            advice: near.map(|near| format!("did you mean {near:?}?")),
            ..Problem::new("spec/unknown-key", pointer, found, expected)
        }];
    };
    if parameter.role != Role::Variant {
        let role = if parameter.role == Role::Fixed {
            "fixed"
        } else {
            "randomized"
        };
        let found = format!("a value for the {role} parameter {name:?}");
        let problem = Problem::new("spec/role", pointer, found, "values for variant parameters only");
        return vec![problem.advise(format!("give {name:?} the role variant, or leave it out here"))];
    }
    parameter.value_problems(pointer, value)
}
