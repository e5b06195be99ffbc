//! Turns errors of a schema into problems that an author can fix. Values with several allowed forms are explained in `forms.rs`.

use std::collections::BTreeMap;

use jsonschema::ValidationError;
use jsonschema::error::ValidationErrorKind;
use serde_json::Value;

use super::advice;
use super::part;
use super::wording::{TEXT_PATTERN, code_of, either, expected, types, words_of};
use crate::describe::{describe, escape};
use crate::error::{MAX_PROBLEMS, Problem};
use crate::version;

/// A problem, with a measure of how specific it is.
pub(super) struct Finding {
    pub(super) problem: Problem,
    /// The number of allowed forms, if the value matches none of them; 0 for every other problem.
    pub(super) forms: usize,
}

impl Finding {
    /// Rank among findings about one value, of which the lowest is kept; `None` for findings that are always kept.
    fn rank(&self) -> Option<usize> {
        match (self.problem.code, self.forms) {
            ("spec/name" | "spec/missing-key", _) => None,
            ("spec/unknown-key", _) => Some(0),
            // A wrong type matters more than a value outside its limits.
            (_, 1) => Some(1),
            (_, 0) => Some(2),
            (_, forms) => Some(forms + 1),
        }
    }
}

impl From<Problem> for Finding {
    fn from(problem: Problem) -> Self {
        Self { problem, forms: 0 }
    }
}

/// The problems behind the schema's errors, without duplicates; if several concern one value, only the most specific one.
pub(super) fn problems<'a>(
    schema: &Value,
    document: &Value,
    errors: impl Iterator<Item = ValidationError<'a>>,
) -> Vec<Problem> {
    let explainer = Explainer { schema, document };
    let findings: Vec<Finding> = errors.flat_map(|error| explainer.explain(&error)).collect();
    let mut best: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for (index, finding) in findings.iter().enumerate() {
        if let Some(rank) = finding.rank() {
            let lowest = best.entry(&finding.problem.pointer).or_insert((rank, index));
            *lowest = (*lowest).min((rank, index));
        }
    }
    let kept = findings.iter().enumerate().filter(|(index, finding)| {
        let pointer = finding.problem.pointer.as_str();
        let is_most_specific = finding.rank().is_none_or(|rank| {
            // Two rules may forbid the same key; report it once.
            best.get(pointer)
                .is_none_or(|(lowest, first)| rank == *lowest && (rank > 0 || first == index))
        });
        // Problems inside a value of the wrong type, or under an unknown key, do not matter.
        is_most_specific && !parents(pointer).any(|parent| best.get(parent).is_some_and(|(lowest, _)| *lowest <= 1))
    });
    kept.map(|(_, finding)| finding.problem.clone()).collect()
}

/// The pointers of all parents of a value.
fn parents(pointer: &str) -> impl Iterator<Item = &str> {
    pointer.match_indices('/').map(|(slash, _)| &pointer[..slash])
}

/// Explains a schema's errors about a document.
pub(super) struct Explainer<'a> {
    pub(super) schema: &'a Value,
    pub(super) document: &'a Value,
}

impl Explainer<'_> {
    pub(super) fn explain(&self, error: &ValidationError) -> Vec<Finding> {
        let pointer = error.instance_path().as_str();
        match error.kind() {
            ValidationErrorKind::AdditionalProperties { unexpected } => {
                let known = self.known_keys(error);
                unexpected
                    .iter()
                    .take(MAX_PROBLEMS + 1)
                    .map(|key| {
                        let problem = unknown_key(pointer, key, &known);
                        let within = self.part_with(error, key);
                        let advice = within.map(|part| format!("did you mean {part:?}: {{ {key:?}: … }}?"));
                        advice.map_or(problem.clone(), |advice| problem.advise(advice)).into()
                    })
                    .collect()
            }
            ValidationErrorKind::Required { property } => {
                vec![missing_key(pointer, &property.to_string()).into()]
            }
            ValidationErrorKind::FalseSchema => vec![self.forbidden_key(error).into()],
            ValidationErrorKind::AnyOf { context }
            | ValidationErrorKind::OneOfNotValid { context }
            | ValidationErrorKind::OneOfMultipleValid { context } => self.alternatives(error, context),
            ValidationErrorKind::PropertyNames { error: name } => vec![self.name(pointer, name).into()],
            // An empty string has already been reported where `minLength` requires characters.
            ValidationErrorKind::Pattern { .. }
                if self.instance(error).as_str() == Some("") && self.parent(error).get("minLength").is_some() =>
            {
                Vec::new()
            }
            _ => vec![self.plain(error)],
        }
    }

    /// The value that an error is about; the error itself does not store it.
    pub(super) fn instance(&self, error: &ValidationError) -> &Value {
        let place = error.instance_path();
        self.document.pointer(place.as_str()).unwrap_or(&Value::Null)
    }

    /// The part of the schema that contains the violated keyword.
    pub(super) fn parent(&self, error: &ValidationError) -> &Value {
        let place = error.schema_path().as_str();
        let parent = place.rfind('/').map_or("", |slash| &place[..slash]);
        self.schema.pointer(parent).unwrap_or(&Value::Null)
    }

    /// The problem for an error that concerns only the value.
    fn plain(&self, error: &ValidationError) -> Finding {
        let value = self.instance(error);
        let problem = Problem::new(
            code_of(error.kind()),
            error.instance_path().as_str(),
            describe(value),
            self.expected(error),
        );
        let advice = match error.kind() {
            ValidationErrorKind::Type { kind } => {
                let words = words_of(self.schema, &self.parent(error)["items"]);
                advice::for_word_of_list(value, &words)
                    .or_else(|| advice::for_types(value, |name| types(kind).iter().any(|kind| kind == name)))
            }
            ValidationErrorKind::Pattern { pattern } if pattern == TEXT_PATTERN => advice_for_sign_text(value),
            ValidationErrorKind::Pattern { .. } => advice_for_name(value),
            _ => None,
        };
        Finding {
            forms: usize::from(matches!(error.kind(), ValidationErrorKind::Type { .. })),
            problem: Problem { advice, ..problem },
        }
    }

    fn expected(&self, error: &ValidationError) -> String {
        match error.kind() {
            ValidationErrorKind::Enum { options } => {
                let words = options.as_array().into_iter().flatten().map(describe);
                format!("one of {}", words.collect::<Vec<_>>().join(", "))
            }
            _ => expected(error, self.schema, self.parent(error)),
        }
    }

    /// The problem for an invalid name used as a key.
    fn name(&self, pointer: &str, error: &ValidationError) -> Problem {
        let name = error.instance().as_str().unwrap_or_default();
        let place = format!("{pointer}/{}", escape(name));
        let problem = Problem::new("spec/name", place, format!("the name {name:?}"), self.expected(error));
        let advice = advice_for_name(error.instance());
        Problem { advice, ..problem }
    }

    /// The keys allowed in the object.
    fn known_keys(&self, error: &ValidationError) -> Vec<String> {
        let keys = self.parent(error).get("properties").and_then(Value::as_object);
        keys.into_iter()
            .flatten()
            .map(|(key, _)| key.clone())
            .filter(|key| key != "$schema")
            .collect()
    }

    /// The sibling part of a world that has this key.
    fn part_with(&self, error: &ValidationError, key: &str) -> Option<&'static str> {
        let parts = ["environment_params", "agent_params", "image_params", "rules"];
        let has = |part: &&str| {
            let part = part::at(self.schema, self.parent(error), &format!("/{part}"));
            part.is_some_and(|part| part["properties"].get(key).is_some())
        };
        parts.into_iter().find(has)
    }

    /// The problem for a key that is not allowed together with another key, or with that key's value.
    fn forbidden_key(&self, error: &ValidationError) -> Problem {
        let pointer = error.instance_path().as_str();
        let (parent, key) = pointer.rsplit_once('/').unwrap_or(("", pointer));
        let place = error.schema_path().as_str();
        let rule = place.rsplit_once("/properties/").map_or("", |(rule, _)| rule);
        let problem = |expected: String, advice: String| {
            Problem::new("spec/unknown-key", pointer, format!("the key {key:?}"), expected).advise(advice)
        };
        let condition = rule.strip_suffix("/then").and_then(|rule| {
            let conditions = self.schema.pointer(&format!("{rule}/if/properties"))?;
            conditions.as_object()?.keys().next()
        });
        let Some(condition) = condition else {
            let beside = self
                .schema
                .pointer(&format!("{rule}/required/0"))
                .and_then(Value::as_str);
            let beside = beside.unwrap_or("the other key");
            return problem(
                format!("no such key with {beside:?}"),
                "remove one of the two".to_owned(),
            );
        };
        let found = self.document.pointer(parent).and_then(|object| object.get(condition));
        let found = found.unwrap_or(&Value::Null);
        if condition == "role" {
            let roles = self.roles_with(rule, key);
            let advice = format!("remove it, or make the role {}", either(roles));
            let expected = format!("no such key in a {} parameter", found.as_str().unwrap_or_default());
            return problem(expected, advice);
        }
        let advice = if key == "range" {
            "list the values under \"choices\" instead"
        } else {
            "remove it"
        };
        problem(format!("no such key with {condition:?}: {found}"), advice.to_owned())
    }

    /// The roles whose parameters may have a key, according to the rules next to the one that forbids it.
    fn roles_with(&self, rule: &str, key: &str) -> Vec<String> {
        let rules = rule
            .split("/allOf/")
            .next()
            .and_then(|node| self.schema.pointer(node)?.get("allOf")?.as_array());
        let allowing = rules.into_iter().flatten().filter_map(|rule| {
            let role = rule.pointer("/if/properties/role/const")?.as_str()?;
            let forbidden = rule.pointer(&format!("/then/properties/{key}")) == Some(&Value::Bool(false));
            (!forbidden).then(|| role.to_owned())
        });
        allowing.collect()
    }
}

/// The problem for a missing key; `key` includes quotes.
pub(super) fn missing_key(pointer: &str, key: &str) -> Problem {
    Problem::new("spec/missing-key", pointer, "nothing", format!("the key {key}"))
}

fn unknown_key(pointer: &str, key: &str, known: &[String]) -> Problem {
    let expected = match known {
        [] => "no further keys".to_owned(),
        [only] => format!("only the key {only:?}"),
        _ => format!("one of {}", known.join(", ")),
    };
    let problem = Problem::new(
        "spec/unknown-key",
        format!("{pointer}/{}", escape(key)),
        format!("the unknown key {key:?}"),
        expected,
    );
    // Keys of version 1 in a task spec that declares version 2.
    let replacement = version::OLD_MARGINS.iter().find(|(old, _)| *old == key);
    match replacement.filter(|_| known.iter().any(|key| key == "keep_out")) {
        Some((_, new)) => problem.advise(format!("write \"keep_out\": {{ {new:?}: … }}")),
        None => problem.suggest(key, known),
    }
}

/// Advice for text that a sign cannot show.
fn advice_for_sign_text(value: &Value) -> Option<String> {
    let text = value.as_str()?;
    let capitals = text.to_uppercase();
    (capitals != text).then(|| format!("write {capitals:?}"))
}

/// Advice for a name that does not match its pattern.
fn advice_for_name(value: &Value) -> Option<String> {
    let near = advice::snake_case(value.as_str()?)?;
    Some(format!("did you mean {near:?}?"))
}
