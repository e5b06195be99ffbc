//! Applies the values of a variant on top of those of the variants that it extends.

use std::collections::BTreeSet;

use indexmap::IndexMap;

use super::family::Variants;
use super::parameter::{Parameter, Role};
use super::variant_spec::DEFAULT_VARIANT;
use crate::describe::escape;
use crate::error::{Problem, first_of};
use crate::value::Value;

/// Maximum length of a chain of variants that extend each other.
const MAX_EXTENDED: usize = 100;

/// The values of a variant: its own, then those of the variants that it extends, then the defaults.
///
/// Fails if the chain of `extends` is broken, cyclic or too long; `check/variants.rs` finds invalid values.
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
            let expected = "a chain of extends without a cycle";
            return Err(Problem::new("spec/extends-cycle", pointer(chain[0]), found, expected));
        }
        chain.push(name);
        if chain.len() > MAX_EXTENDED {
            let found = format!("a chain of more than {MAX_EXTENDED} variants that extend each other");
            let expected = format!("at most {MAX_EXTENDED}");
            let problem = Problem::new("spec/length", pointer(chain[0]), found, expected);
            return Err(problem.advise("extend a variant further up the chain"));
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

/// Whether a variant, or one that it extends, is among these.
pub(crate) fn is_built_on(variants: &Variants, name: &str, unsound: &BTreeSet<String>) -> bool {
    let mut next = Some(name);
    // A cycle also exceeds the longest chain allowed.
    for _ in 0..=MAX_EXTENDED {
        let Some(name) = next else { return false };
        let declared = variants.get(name);
        if unsound.contains(name) || declared.is_some_and(|declared| unsound.contains(&declared.origin)) {
            return true;
        }
        next = declared.and_then(|declared| declared.extends.as_deref());
    }
    next.is_some()
}
