//! Checks the values of variants and families: their parameters, their types and ranges.

use indexmap::IndexMap;

use crate::describe::escape;
use crate::error::{MAX_PROBLEMS, Problem};
use crate::suggest::nearest;
use crate::task::extends::values_of;
use crate::task::family::{Variants, value_of};
use crate::task::parameter::{Parameter, Role};
use crate::task::variant_spec::{RESERVED, VariantSpec, variant_parameters};
use crate::value::{ParameterType, Value};

/// All problems of variants, except those of values of unsound parameters.
pub(super) fn problems(
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
            let pointer = format!("/variants/{}/{}", escape(name), escape(parameter));
            problems.extend(check(&pointer, parameter, value));
        }
        problems.extend(family_problems(parameters, name, variant, check));
    }
    problems
}

/// The problems of the values on a family's axes, with their pointers.
fn family_problems(
    parameters: &IndexMap<String, Parameter>,
    name: &str,
    spec: &VariantSpec,
    problems_of: impl Fn(&str, &str, &Value) -> Vec<Problem>,
) -> Vec<Problem> {
    let pointer = format!("/variants/{}", escape(name));
    let mut found = Vec::new();
    for (parameter, values) in &spec.grid {
        for (index, value) in values.iter().enumerate() {
            let at = format!("{pointer}/grid/{}/{index}", escape(parameter));
            found.extend(problems_of(&at, parameter, value));
        }
    }
    for (parameter, sweep) in &spec.sweep {
        let at = format!("{pointer}/sweep/{}", escape(parameter));
        let known = parameters.get(parameter).filter(|known| known.role == Role::Variant);
        if let Some(known) = known.filter(|known| !known.kind.is_numeric() || known.kind == ParameterType::Vector) {
            let found_type = format!("a sweep over a {}", known.kind.name());
            let advice = "list the values under \"grid\" instead";
            found.push(Problem::new("spec/type", at, found_type, "a number, an integer or a heading").advise(advice));
            continue;
        }
        if known.is_none() {
            // No variant can set it, so one report is enough.
            found.extend(problems_of(&at, parameter, &Value::Number(sweep.from)));
            continue;
        }
        for (end, key) in [(sweep.from, "from"), (sweep.to, "to")] {
            found.extend(problems_of(&format!("{at}/{key}"), parameter, &value_of(known, end)));
        }
    }
    found
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
