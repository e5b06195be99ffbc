//! Explains values that match none of several allowed forms: names the form that the author meant, or lists the forms.

use jsonschema::ValidationError;
use jsonschema::error::ValidationErrorKind;
use serde_json::{Map, Value};

use super::explain::{Explainer, Finding, missing_key};
use super::wording::{article, both, either, list, object, quoted, words_of};
use super::{advice, color};
use crate::describe::describe;
use crate::error::Problem;
use crate::suggest::nearest;

/// Definitions that messages name rather than describe.
const NAMED: [&str; 5] = ["Color", "ParamRef", "Case", "NumberCase", "Distribution"];

/// One allowed form of a value, and the errors of this value against it.
struct Form<'a, 'e> {
    /// Its schema, with references resolved.
    schema: &'a Value,
    /// The name of its definition, if messages use it.
    name: Option<&'a str>,
    /// Its description if it is a list.
    list: String,
    /// The allowed words, if it is a list of words.
    listed: Vec<&'a str>,
    errors: Vec<&'e ValidationError<'static>>,
}

impl Form<'_, '_> {
    fn is(&self, name: &str) -> bool {
        self.name == Some(name)
    }

    fn has_type(&self, name: &str) -> bool {
        match &self.schema["type"] {
            Value::String(kind) => kind == name,
            Value::Array(kinds) => kinds.iter().any(|kind| kind == name),
            _ => false,
        }
    }

    /// Whether the value has a different JSON type.
    fn has_wrong_type(&self, own: &str) -> bool {
        let wrong = |kind: &ValidationErrorKind| matches!(kind, ValidationErrorKind::Type { .. });
        self.errors_at(own).any(|error| wrong(error.kind()))
    }

    /// Whether the value is a word that this form does not allow.
    fn is_wrong_word(&self, own: &str) -> bool {
        use ValidationErrorKind as Kind;
        let wrong = |kind: &Kind| matches!(kind, Kind::Constant { .. } | Kind::Enum { .. });
        self.errors_at(own).any(|error| wrong(error.kind()))
    }

    fn errors_at(&self, own: &str) -> impl Iterator<Item = &ValidationError<'static>> {
        self.errors
            .iter()
            .copied()
            .filter(move |error| error.instance_path().as_str() == own)
    }

    fn properties(&self) -> Option<&Map<String, Value>> {
        self.schema["properties"].as_object()
    }

    /// The single key that distinguishes this object form from others: `uniform` of `{ "uniform": … }`.
    fn tag(&self) -> Option<&str> {
        if self.is_case() {
            return Some("case");
        }
        let alone = self.is("ParamRef") || self.properties().is_some_and(|properties| properties.len() == 1);
        match self.schema["required"].as_array().map(Vec::as_slice) {
            Some([key]) if alone => key.as_str(),
            _ => None,
        }
    }

    /// Whether it is a look-up, which messages do not list in addition to the forms of its cases.
    fn is_case(&self) -> bool {
        self.is("Case") || self.is("NumberCase")
    }

    /// Whether it is a list of three: a colour with parameters as channels, or one number per channel.
    fn is_a_triple(&self) -> bool {
        let of_words = !self.listed.is_empty();
        self.name.is_none() && self.has_type("array") && self.schema["maxItems"] == 3 && !of_words
    }

    /// The words that this form allows.
    fn words(&self) -> Vec<&str> {
        let options = self.schema["enum"].as_array().into_iter().flatten();
        options
            .chain(self.schema.get("const"))
            .filter_map(Value::as_str)
            .collect()
    }

    /// Its rank and label in a list of forms; `None` if it need not be mentioned.
    fn label(&self, beside_text: bool) -> Option<(usize, String)> {
        let of_numbers = self.schema.pointer("/items/type").is_some_and(|kind| kind == "number");
        let label = match self.name {
            Some("Color") if beside_text => (6, "a colour".to_owned()),
            Some("Color") => (6, color::EXPECTED.to_owned()),
            _ if self.is_case() => return None,
            Some("ParamRef") => (9, "a parameter ({\"param\": …})".to_owned()),
            Some(_) => (10, "a distribution".to_owned()),
            None if self.has_type("null") => return None,
            None if self.has_type("number") => (0, article("number")),
            None if self.has_type("integer") => (1, article("integer")),
            None if self.has_type("string") => (2, article("string")),
            None if self.has_type("boolean") => (3, article("boolean")),
            None if self.has_type("array") && of_numbers && self.schema["maxItems"] == 2 => {
                (5, "a point [x, y]".to_owned())
            }
            None if self.has_type("array") && of_numbers => (7, "a list of numbers".to_owned()),
            None if self.is_a_triple() => (7, "a list of three numbers or parameters".to_owned()),
            None if self.has_type("array") => (7, self.list.clone()),
            None => match self.tag() {
                Some(tag) => (8, format!("{{{tag:?}: …}}")),
                None if self.has_type("object") => (8, object(self.schema)),
                None => (8, article(self.schema["type"].as_str().unwrap_or("value"))),
            },
        };
        Some(label)
    }
}

impl Explainer<'_> {
    /// The findings for a value that matches none of several forms, or more than one.
    pub(super) fn alternatives(
        &self,
        error: &ValidationError,
        context: &[Vec<ValidationError<'static>>],
    ) -> Vec<Finding> {
        let place = error.schema_path().as_str();
        let branches = self
            .schema
            .pointer(place)
            .and_then(Value::as_array)
            .map_or(&[][..], Vec::as_slice);
        if let Some(findings) = self.one_of_the_keys(error, branches, context) {
            return findings;
        }
        let name = place.rsplit('/').nth(1).filter(|name| NAMED.contains(name));
        let name = name.and_then(|name| NAMED.into_iter().find(|known| *known == name));
        let own = error.instance_path().as_str();
        let mut forms = Vec::new();
        self.unfold(own, branches, context, name, &mut forms);
        let value = self.instance(error);
        let same_type: Vec<&Form> = forms.iter().filter(|form| !form.has_wrong_type(own)).collect();
        if !same_type.is_empty()
            && same_type.iter().any(|form| form.is("Color"))
            && same_type.iter().all(|form| form.is("Color") || form.is_a_triple())
            && let Some(problem) = color::problem(own, value)
        {
            return vec![Finding { problem, forms: 1 }];
        }
        let intended = match value {
            Value::Object(map) => match intended_object(own, map, &forms) {
                Ok(intended) => intended,
                Err(problem) => return vec![problem.into()],
            },
            _ => intended_value(own, &same_type),
        };
        match intended {
            Some(form) => form.errors.iter().flat_map(|error| self.explain(error)).collect(),
            None => vec![none_of(own, value, &forms)],
        }
    }

    /// The finding for an object that needs exactly one of several keys and has none or more.
    fn one_of_the_keys(
        &self,
        error: &ValidationError,
        branches: &[Value],
        context: &[Vec<ValidationError<'static>>],
    ) -> Option<Vec<Finding>> {
        let key = |branch: &Value| {
            let key = branch.pointer("/required/0")?.as_str()?.to_owned();
            branch.get("type").is_none().then_some(key)
        };
        let keys: Vec<String> = branches.iter().map(key).collect::<Option<_>>()?;
        let (pointer, object) = (error.instance_path().as_str(), self.instance(error).as_object()?);
        let mut present = keys.iter().enumerate().filter(|(_, key)| object.contains_key(*key));
        let problem = match (present.next(), present.next()) {
            (None, _) if keys.len() == 1 => missing_key(pointer, &format!("{:?}", keys[0])),
            (None, _) => {
                let found = format!("neither {}", keys.join(" nor "));
                Problem::new("spec/missing-key", pointer, found, "one of the two")
            }
            (Some((index, _)), None) => {
                return Some(
                    context
                        .get(index)?
                        .iter()
                        .flat_map(|error| self.explain(error))
                        .collect(),
                );
            }
            (Some(_), Some(_)) => {
                let found = format!("both {}", keys.join(" and "));
                Problem::new("spec/value", pointer, found, "one of the two").advise("remove one")
            }
        };
        Some(vec![problem.into()])
    }

    /// Collects the forms of all branches, including nested choices.
    fn unfold<'a, 'e>(
        &'a self,
        own: &str,
        branches: &'a [Value],
        context: &'e [Vec<ValidationError<'static>>],
        name: Option<&'a str>,
        forms: &mut Vec<Form<'a, 'e>>,
    ) {
        for (branch, errors) in branches.iter().zip(context) {
            let (mut schema, mut name) = (branch, name);
            while let Some(reference) = schema.get("$ref").and_then(Value::as_str) {
                let definition = reference.rsplit('/').next().unwrap_or_default();
                name = name.or_else(|| NAMED.contains(&definition).then_some(definition));
                let Some(target) = self.schema.pointer(reference.trim_start_matches('#')) else {
                    break;
                };
                schema = target;
            }
            let inner = schema
                .get("anyOf")
                .or_else(|| schema.get("oneOf"))
                .and_then(Value::as_array);
            let nested = errors.iter().find_map(|error| match error.kind() {
                ValidationErrorKind::AnyOf { context } | ValidationErrorKind::OneOfNotValid { context } => {
                    (error.instance_path().as_str() == own).then_some(context)
                }
                _ => None,
            });
            match (inner, nested) {
                (Some(inner), Some(nested)) => self.unfold(own, inner, nested, name, forms),
                _ => forms.push(Form {
                    schema,
                    name,
                    list: list(self.schema, schema),
                    listed: words_of(self.schema, &schema["items"]),
                    errors: errors.iter().collect(),
                }),
            }
        }
    }
}

/// The form intended by a value that is not an object: the one of its type with the fewest errors.
fn intended_value<'f, 'a, 'e>(own: &str, same_type: &[&'f Form<'a, 'e>]) -> Option<&'f Form<'a, 'e>> {
    let fitting: Vec<_> = same_type
        .iter()
        .copied()
        .filter(|form| !form.is_wrong_word(own))
        .collect();
    let best = fitting
        .iter()
        .copied()
        .min_by_key(|form| (form.errors_at(own).count(), form.errors.len()))?;
    // A list whose length fits none of several forms matches none in particular.
    (fitting.len() == 1 || best.errors_at(own).count() == 0).then_some(best)
}

/// The form intended by an object, judging by its keys; an error if it has keys of several forms.
fn intended_object<'f, 'a, 'e>(
    own: &str,
    object: &Map<String, Value>,
    forms: &'f [Form<'a, 'e>],
) -> Result<Option<&'f Form<'a, 'e>>, Problem> {
    let tagged = |key: &String| forms.iter().find(|form| form.tag() == Some(key));
    let present: Vec<_> = object
        .keys()
        .filter_map(|key| Some((key.as_str(), tagged(key)?)))
        .collect();
    let structs = || {
        forms
            .iter()
            .filter(|form| form.has_type("object") && form.tag().is_none())
    };
    // A key of a plain object can also be the tag of another form, such as `grid`.
    let plain = |key: &str| structs().find(|form| form.properties().is_some_and(|known| known.contains_key(key)));
    match &present[..] {
        [(key, form)] => Ok(Some(plain(key).unwrap_or(form))),
        [] => {
            let mut structs = structs();
            Ok(structs.next().filter(|_| structs.next().is_none()))
        }
        several => {
            let keys: Vec<&str> = several.iter().map(|(key, _)| *key).collect();
            let (count, advice) = match keys.len() {
                2 => ("two", "remove one"),
                3 => ("three", "remove two"),
                _ => ("several", "remove all but one"),
            };
            let found = format!("{count} forms, {}", both(&keys));
            Err(Problem::new("spec/value", own, found, "one").advise(advice))
        }
    }
}

/// The problem that lists all forms, for a value that matches none.
fn none_of(own: &str, value: &Value, forms: &[Form]) -> Finding {
    let words: Vec<&str> = forms
        .iter()
        .filter(|form| form.name.is_none())
        .flat_map(Form::words)
        .collect();
    let beside_text = forms
        .iter()
        .any(|form| form.name.is_none() && form.has_type("string") && form.words().is_empty());
    let mut labels: Vec<(usize, String)> = forms
        .iter()
        .filter(|form| form.words().is_empty() || form.name.is_some())
        .filter_map(|form| form.label(beside_text))
        .collect();
    labels.sort_by_key(|(rank, _)| *rank);
    labels.dedup();
    if labels.first().is_some_and(|(rank, _)| *rank == 0) {
        labels.retain(|(rank, _)| *rank != 1);
    }
    let expected = if labels.is_empty() && words.len() > 1 {
        format!("one of {}", quoted(&words).join(", "))
    } else {
        let labels = labels.iter().map(|(_, label)| label.clone());
        either(quoted(&words).into_iter().chain(labels).collect())
    };
    let families: Vec<&str> = forms
        .iter()
        .filter(|form| form.is("Distribution"))
        .filter_map(Form::tag)
        .collect();
    let expected = if value.is_object() && !families.is_empty() {
        format!("{expected} ({})", families.join(", "))
    } else {
        expected
    };
    let problem = Problem::new("spec/value", own, describe(value), expected);
    let advice = advice::for_removed(own, value).or_else(|| advice_for(value, forms, &words));
    Finding {
        problem: Problem { advice, ..problem },
        forms: labels.len().max(1),
    }
}

/// Advice for a value that matches none of these forms, if the intention is clear.
fn advice_for(value: &Value, forms: &[Form], words: &[&str]) -> Option<String> {
    let tags: Vec<&str> = forms.iter().filter_map(Form::tag).collect();
    match value {
        Value::String(text) => {
            if let Some(near) = nearest(text, words) {
                return Some(format!("did you mean {near:?}?"));
            }
            if words.contains(&"phi") {
                return advice::for_element(value);
            }
            if let Some(parameter) = text.strip_prefix('$').filter(|_| tags.contains(&"param")) {
                return Some(format!("write {{\"param\": {parameter:?}}}"));
            }
            if tags.contains(&text.as_str()) {
                return Some(format!("write {{{text:?}: …}}"));
            }
            if let Some(near) = nearest(text, &tags) {
                return Some(format!("did you mean {{{near:?}: …}}?"));
            }
            let listed = forms
                .iter()
                .find_map(|form| advice::for_word_of_list(value, &form.listed));
            listed.or_else(|| advice::for_types(value, |name| forms.iter().any(|form| form.has_type(name))))
        }
        Value::Object(object) => {
            let named = ["type", "kind", "name", "distribution"]
                .iter()
                .find_map(|key| object.get(*key)?.as_str());
            if let Some(tag) = named.filter(|tag| tags.contains(tag)) {
                return Some(format!("write {{{tag:?}: {{…}}}}"));
            }
            let key = object.keys().next()?;
            let near = nearest(key, &tags).or_else(|| advice::shares_beginning(key, &tags).map(str::to_owned));
            if let Some(near) = near {
                return Some(format!("did you mean {near:?}?"));
            }
            let tag = forms.iter().find_map(|form| tag_of_contents(form, object))?;
            Some(format!("name it, as in {{{tag:?}: {{…}}}}"))
        }
        _ => None,
    }
}

/// The tag of a form whose inner object has exactly these keys.
fn tag_of_contents<'f>(form: &'f Form, object: &Map<String, Value>) -> Option<&'f str> {
    let tag = form.tag()?;
    let inside = form.properties()?.get(tag)?;
    let known = inside.get("properties")?.as_object()?;
    let required = inside.get("required")?.as_array()?;
    let has_all_required = required
        .iter()
        .filter_map(Value::as_str)
        .all(|key| object.contains_key(key));
    (has_all_required && object.keys().all(|key| known.contains_key(key))).then_some(tag)
}
