//! Checks values that only the schema at their place of use can validate: parameters of type JSON, and draws from lists that
//! contain objects, lists or `null`.

use super::super::layouts;
use super::super::template::{Hole, Source};
use super::Check;
use crate::describe::escape;
use crate::distribution::{Distribution, Number};
use crate::value::{ParameterType, Value};

impl Check<'_> {
    /// Whether a source's values can be validated only by the schema where it is used.
    pub(super) fn is_json(&self, source: &Source, place: ParameterType) -> bool {
        match source {
            Source::Case(_) => source.leaves().iter().any(|(_, leaf)| self.is_json(leaf, place)),
            Source::Value(value) => is_for_schema(&Distribution::Constant { value: value.clone() }, place),
            Source::Param(reference) => {
                let parameter = self.parameters.get(&reference.param);
                reference.index.is_none()
                    && parameter.is_some_and(|parameter| match parameter.kind {
                        ParameterType::Json => true,
                        ParameterType::Distribution => {
                            let all = self.distributions_of(source);
                            !all.is_empty() && all.iter().all(|own| is_for_schema(own, place))
                        }
                        _ => false,
                    })
            }
            Source::Distribution(distribution) => is_for_schema(distribution, place),
        }
    }

    /// Every value that such a source can produce; reports values that are not allowed where it is used.
    pub(super) fn json_candidates<T>(&mut self, place: &str, source: &Source, hole: &Hole<T>) -> Vec<Value> {
        let mut candidates = Vec::new();
        let problems = hole.checker();
        for (pointer, value) in self.json_values(place, source) {
            let Some(value) = value.cast(ParameterType::Json) else {
                continue;
            };
            let found = problems(&value);
            for mut problem in found.into_iter().map(|problem| problem.within(&pointer)) {
                if pointer != place && !pointer.starts_with(&format!("{place}/")) {
                    let where_used = format!("the parameter is used at {place}");
                    let advice = problem.advice.take();
                    problem.advice = Some(advice.map_or(where_used.clone(), |advice| {
                        let end = if advice.ends_with('?') { "" } else { ";" };
                        format!("{advice}{end} {where_used}")
                    }));
                }
                self.report(problem);
            }
            candidates.push(value);
        }
        candidates
    }

    /// Reports the problems of layouts that a source draws.
    pub(super) fn drawn_layouts(&mut self, place: &str, source: &Source) {
        for (pointer, value) in self.json_values(place, source) {
            let found = layouts::problems(&value.to_json());
            self.problems
                .extend(found.into_iter().map(|problem| problem.within(&pointer)));
        }
    }

    /// The values that a source can produce, with their pointers in the document.
    fn json_values(&self, place: &str, source: &Source) -> Vec<(String, Value)> {
        let mut found = Vec::new();
        match source {
            Source::Case(_) => {
                for (inside, leaf) in source.leaves() {
                    found.extend(self.json_values(&format!("{place}{inside}"), leaf));
                }
            }
            Source::Value(value) => found.push((place.to_owned(), value.clone())),
            Source::Distribution(distribution) => listed(distribution, place, &mut found),
            Source::Param(reference) => {
                let Some(parameter) = self.parameters.get(&reference.param) else {
                    return found;
                };
                let pointer = format!("/parameters/{}", escape(&reference.param));
                for (key, value) in parameter.entries() {
                    let pointer = format!("{pointer}/{key}");
                    let is_choice = key.starts_with("choices/");
                    match value {
                        // Skips the name of a choice, because the choice itself is listed.
                        _ if !is_choice && parameter.choices.iter().any(|choices| choices.named(value).is_some()) => {}
                        Value::Distribution(own) if parameter.kind == ParameterType::Distribution => {
                            listed(own, &pointer, &mut found);
                        }
                        // Skips a default that is one of the choices.
                        _ if key == "default" && found.iter().any(|(_, known)| known == value) => {}
                        _ => found.push((pointer, value.clone())),
                    }
                }
                let drawn = format!("{pointer}/distribution");
                if let Some(own) = &parameter.distribution {
                    found.extend(self.json_values(&drawn, own));
                }
            }
        }
        found
    }
}

/// Whether a distribution's draws can be validated only by the schema where it is used: the distribution lists them, and either
/// the key is of type JSON or some of them are not plain values.
fn is_for_schema(distribution: &Distribution<Number>, place: ParameterType) -> bool {
    let mut values = Vec::new();
    listed(distribution, "", &mut values);
    distribution.yields(ParameterType::Json)
        && (place == ParameterType::Json || values.iter().any(|(_, value)| value.is_json()))
}

/// The values that a distribution lists, with their pointers.
fn listed(distribution: &Distribution<Number>, pointer: &str, found: &mut Vec<(String, Value)>) {
    match distribution {
        Distribution::Constant { value } => found.push((format!("{pointer}/constant/value"), value.clone())),
        Distribution::Choice { values, .. } => {
            let values = values.iter().enumerate();
            found.extend(values.map(|(index, value)| (format!("{pointer}/choice/values/{index}"), value.clone())));
        }
        Distribution::Mixture { parts, .. } => {
            for (index, part) in parts.iter().enumerate() {
                listed(part, &format!("{pointer}/mixture/parts/{index}"), found);
            }
        }
        _ => {}
    }
}
