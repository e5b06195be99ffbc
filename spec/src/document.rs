//! A JSON text with a memory of where each value stands. What is wrong with a value is said by `schema.rs` and the types.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

use jsonc_parser::ast;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use serde::de::{DeserializeOwned, Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};

use crate::error::{Problem, SpecError};
use crate::schema::DocumentSchema;
use crate::version::Format;

/// The longest text that is read, in bytes.
pub const MAX_BYTES: usize = 64 << 20;

/// A parsed JSON text.
pub(crate) struct Document<'a> {
    pub(crate) name: &'a str,
    text: &'a str,
    pub(crate) value: Value,
}

impl<'a> Document<'a> {
    /// Parses a text: refuses what is not JSON, and keys that stand twice in one object.
    pub(crate) fn parse(name: &'a str, text: &'a str) -> Result<Self, SpecError> {
        let (document, repeated) = Self::parse_with_repeats(name, text)?;
        document.fail_on(repeated)?;
        Ok(document)
    }

    /// Parses a text as most programs do: of keys that stand twice in one object the last counts. Hands back the pointers of
    /// those that do.
    pub(crate) fn parse_leniently(name: &'a str, text: &'a str) -> Result<(Self, Vec<String>), SpecError> {
        let (document, repeated) = Self::parse_with_repeats(name, text)?;
        let pointers = repeated.into_iter().map(|problem| problem.pointer);
        Ok((document, pointers.collect()))
    }

    fn parse_with_repeats(name: &'a str, text: &'a str) -> Result<(Self, Vec<Problem>), SpecError> {
        // A byte order mark, which some editors put in front, is no part of the document.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.len() > MAX_BYTES {
            return Err(SpecError::TooLarge {
                name: name.to_owned(),
                bytes: text.len(),
                limit: MAX_BYTES,
            });
        }
        // One pass builds the value and finds out whether a key stands twice; only then are the places looked for.
        let parsed: Result<Unrepeated, _> = serde_json::from_str(text);
        if let Ok(Unrepeated(value)) = parsed {
            return Ok((Self { name, text, value }, Vec::new()));
        }
        let value = serde_json::from_str(text).map_err(|error| syntax_error(name, text, &error))?;
        let document = Self { name, text, value };
        let repeated = document.with_ast(|root| {
            let mut problems = Vec::new();
            duplicate_keys(root, &mut String::new(), &mut problems);
            problems
        });
        Ok((document, repeated))
    }

    /// Brings the document to the current version of its form; fails if it is of a newer one.
    pub(crate) fn upgrade(&mut self, format: &Format) -> Result<(), SpecError> {
        let problem = format.upgrade(&mut self.value);
        self.fail_on(problem.into_iter().collect())
    }

    /// Fails with every violation of the schema.
    pub(crate) fn check_schema(&self, schema: &DocumentSchema) -> Result<(), SpecError> {
        self.fail_on(schema.problems(&self.value))
    }

    /// The typed value; a value that the schema lets pass and the type does not is a problem like any other.
    pub(crate) fn deserialize<T: DeserializeOwned>(&self) -> Result<T, SpecError> {
        // The plain way is twice as fast as the one that knows where it fails.
        if let Ok(typed) = T::deserialize(&self.value) {
            return Ok(typed);
        }
        serde_path_to_error::deserialize(&self.value).map_err(|error| {
            let pointer = pointer_of(error.path());
            let found = self
                .value
                .pointer(&pointer)
                .map_or_else(|| "nothing".to_owned(), describe);
            let expected = match error.into_inner().to_string() {
                text if text.contains("floating point") => "a whole number, written without a decimal point".to_owned(),
                text => text,
            };
            let problem = Problem::new("spec/value", pointer, found, expected);
            self.error(vec![problem])
        })
    }

    /// Fails if there are any problems, after finding the place of each.
    pub(crate) fn fail_on(&self, problems: Vec<Problem>) -> Result<(), SpecError> {
        if problems.is_empty() {
            Ok(())
        } else {
            Err(self.error(problems))
        }
    }

    fn error(&self, mut problems: Vec<Problem>) -> SpecError {
        let offsets = self.with_ast(|root| {
            let at_key = |problem: &Problem| matches!(problem.code, "spec/unknown-key" | "spec/name");
            let mut offsets = Offsets::new(root);
            let offset = |problem: &Problem| offsets.of(&problem.pointer, at_key(problem));
            problems.iter().map(offset).collect::<Vec<usize>>()
        });
        for (problem, place) in problems.iter_mut().zip(lines_and_columns(self.text, &offsets)) {
            (problem.line, problem.column) = place;
        }
        problems.sort_by(|a, b| (a.line, a.column, &a.pointer).cmp(&(b.line, b.column, &b.pointer)));
        problems.dedup();
        SpecError::Document {
            name: self.name.to_owned(),
            problems,
        }
    }

    /// Lines and columns of the values of pointers, or of their nearest parents that are there.
    pub(crate) fn places(&self, pointers: &[&str]) -> Vec<(usize, usize)> {
        let mut offsets = self.with_ast(|root| {
            let mut offsets = Offsets::new(root);
            let offset = |pointer: &&str| offsets.of(pointer, false);
            pointers.iter().map(offset).collect::<Vec<usize>>()
        });
        offsets.resize(pointers.len(), 0);
        lines_and_columns(self.text, &offsets)
    }

    /// Hands over the syntax tree with ranges. The text has been parsed before, so there is one.
    fn with_ast<T: Default>(&self, job: impl FnOnce(&ast::Value) -> T) -> T {
        let parsed = parse_to_ast(self.text, &CollectOptions::default(), &ParseOptions::default());
        parsed
            .ok()
            .and_then(|result| result.value.map(|root| job(&root)))
            .unwrap_or_default()
    }
}

/// A JSON value in which no object has a key twice.
struct Unrepeated(Value);

impl<'de> Deserialize<'de> for Unrepeated {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(UnrepeatedVisitor).map(Self)
    }
}

struct UnrepeatedVisitor;

impl<'de> Visitor<'de> for UnrepeatedVisitor {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_bool<E>(self, truth: bool) -> Result<Value, E> {
        Ok(Value::Bool(truth))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_string<E>(self, text: String) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Unrepeated(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(list.into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        // Objects of worlds have a dozen keys: room for them at once is a third faster than growing.
        let mut map = Map::with_capacity(14);
        while let Some((key, Unrepeated(value))) = entries.next_entry::<String, _>()? {
            if map.insert(key, value).is_some() {
                return Err(A::Error::custom("a key stands twice"));
            }
        }
        Ok(map.into())
    }
}

/// A value in the few words that a message has room for.
pub(crate) fn describe(value: &Value) -> String {
    match value {
        Value::String(text) if text.chars().count() > 40 => {
            format!("{:?}…", text.chars().take(40).collect::<String>())
        }
        Value::Array(items) if items.len() > 4 => format!("a list of {} values", items.len()),
        Value::Object(map) if map.len() > 2 => format!("an object with {} keys", map.len()),
        other => {
            let text = other.to_string();
            match other {
                Value::Object(_) if text.chars().count() > 60 => "an object".to_owned(),
                Value::Array(_) if text.chars().count() > 60 => "a list".to_owned(),
                _ => text,
            }
        }
    }
}

/// A number as people read it: very large and very small ones with an exponent.
pub(crate) fn plain_number(number: f64) -> String {
    if number != 0.0 && !(1e-6..1e15).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        number.to_string()
    }
}

/// Escapes a key for a JSON pointer.
pub(crate) fn escape(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

fn syntax_error(name: &str, text: &str, error: &serde_json::Error) -> SpecError {
    let message = error.to_string();
    let mut reason = message.split(" at line ").next().unwrap_or_default().to_owned();
    let line_text = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let start = line_text.floor_char_boundary(error.column().saturating_sub(1));
    let rest = line_text[start..].trim_start();
    if rest.starts_with("NaN") || rest.starts_with("Infinity") || rest.starts_with("-Infinity") {
        "JSON has no NaN or Infinity; numbers are finite".clone_into(&mut reason);
    } else if reason == "trailing comma" {
        reason.push_str("; remove the comma before the closing bracket");
    } else if rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#') {
        reason.push_str("; JSON has no comments, write a \"description\" instead");
    } else if reason.starts_with("EOF") {
        reason.push_str("; the document ends too early, is it cut off?");
    }
    SpecError::Syntax {
        name: name.to_owned(),
        line: error.line().max(1),
        column: error.column().max(1),
        reason,
    }
}

fn duplicate_keys(value: &ast::Value, pointer: &mut String, problems: &mut Vec<Problem>) {
    let length = pointer.len();
    match value {
        ast::Value::Object(object) => {
            let mut seen = std::collections::BTreeSet::new();
            for property in &object.properties {
                let key = property.name.as_str();
                *pointer += "/";
                *pointer += &escape(key);
                if !seen.insert(key) {
                    problems.push(Problem::new(
                        "spec/duplicate-key",
                        pointer.clone(),
                        format!("the key {key:?} twice"),
                        "each key once; remove one of the two",
                    ));
                }
                duplicate_keys(&property.value, pointer, problems);
                pointer.truncate(length);
            }
        }
        ast::Value::Array(array) => {
            for (index, element) in array.elements.iter().enumerate() {
                *pointer += "/";
                *pointer += &index.to_string();
                duplicate_keys(element, pointer, problems);
                pointer.truncate(length);
            }
        }
        _ => {}
    }
}

/// The most keys of an object that are looked through one by one; those of a wider one are listed once.
const WIDE: usize = 32;

/// Where the values of pointers begin.
struct Offsets<'r, 't> {
    root: &'r ast::Value<'t>,
    /// The properties of wide objects by their keys: of two of one key the last.
    wide: HashMap<*const ast::Object<'t>, HashMap<&'r str, &'r ast::ObjectProp<'t>>>,
}

impl<'r, 't> Offsets<'r, 't> {
    fn new(root: &'r ast::Value<'t>) -> Self {
        let wide = HashMap::new();
        Self { root, wide }
    }

    /// Of the value of a pointer, or of its nearest parent that is there; of the key before it if wished.
    fn of(&mut self, pointer: &str, at_key: bool) -> usize {
        let mut value = self.root;
        let mut offset = range_of(value).start;
        for token in pointer.split('/').skip(1) {
            let token = token.replace("~1", "/").replace("~0", "~");
            let next = match value {
                ast::Value::Object(object) => self.property(object, &token).map(|property| {
                    let start = if at_key {
                        property.range.start
                    } else {
                        range_of(&property.value).start
                    };
                    (start, &property.value)
                }),
                ast::Value::Array(array) => token
                    .parse::<usize>()
                    .ok()
                    .and_then(|index| array.elements.get(index))
                    .map(|element| (range_of(element).start, element)),
                _ => None,
            };
            let Some(next) = next else { break };
            (offset, value) = next;
        }
        offset
    }

    fn property(&mut self, object: &'r ast::Object<'t>, key: &str) -> Option<&'r ast::ObjectProp<'t>> {
        let properties = &object.properties;
        if properties.len() <= WIDE {
            return properties.iter().rev().find(|property| property.name.as_str() == key);
        }
        let listed = || {
            properties
                .iter()
                .map(|property| (property.name.as_str(), property))
                .collect()
        };
        self.wide
            .entry(std::ptr::from_ref(object))
            .or_insert_with(listed)
            .get(key)
            .copied()
    }
}

fn range_of(value: &ast::Value) -> Range<usize> {
    use jsonc_parser::common::Ranged;
    let range = value.range();
    range.start..range.end
}

/// Lines and columns of offsets, in one walk through the text however many they are.
fn lines_and_columns(text: &str, offsets: &[usize]) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..offsets.len()).collect();
    order.sort_by_key(|index| offsets[*index]);
    let mut places = vec![(1, 1); offsets.len()];
    let (mut at, mut line, mut column) = (0, 1, 1);
    for index in order {
        let offset = text.floor_char_boundary(offsets[index]);
        for letter in text[at..offset].chars() {
            (line, column) = if letter == '\n' {
                (line + 1, 1)
            } else {
                (line, column + 1)
            };
        }
        at = offset;
        places[index] = (line, column);
    }
    places
}

pub(crate) fn pointer_of(path: &serde_path_to_error::Path) -> String {
    use serde_path_to_error::Segment;
    path.iter().fold(String::new(), |pointer, segment| match segment {
        Segment::Seq { index } => format!("{pointer}/{index}"),
        Segment::Map { key } => format!("{pointer}/{}", escape(key)),
        Segment::Enum { variant } => format!("{pointer}/{}", escape(variant)),
        Segment::Unknown => pointer,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let error = Document::parse("d.json", text).err().map(|error| error.to_string());
        assert_eq!(error.as_deref(), Some(expected), "{text}");
    }

    #[test]
    fn keys_of_wide_objects_are_found_as_those_of_narrow_ones_are() {
        for width in [1, WIDE, WIDE + 1, 1000] {
            let keys: Vec<String> = (0..width).map(|key| format!("\"k{key}\": 1")).collect();
            let text = format!("{{\n{}\n}}", keys.join(",\n"));
            let document = Document::parse("wide.json", &text).expect("it is JSON");
            let last = format!("/k{}", width - 1);
            let column = format!("\"k{}\": ", width - 1).len() + 1;
            assert_eq!(
                document.places(&["/k0", &last, "/none"]),
                [(2, 7), (width + 1, column), (1, 1)]
            );
        }
    }

    #[test]
    fn what_is_not_json_is_refused_with_its_place() {
        check(
            "{\n  \"a\": 1,\n}",
            "d.json:3:1: not valid JSON: trailing comma; remove the comma before the closing bracket",
        );
        check(
            "{\"a\": NaN}",
            "d.json:1:7: not valid JSON: JSON has no NaN or Infinity; numbers are finite",
        );
        check(
            "{\"a\": [1, 2",
            "d.json:1:11: not valid JSON: EOF while parsing a list; the document ends too early, is it cut off?",
        );
        check(
            "",
            "d.json:1:1: not valid JSON: EOF while parsing a value; the document ends too early, is it cut off?",
        );
        check("{\"a\": 1e999}", "d.json:1:11: not valid JSON: number out of range");
        check(
            &"[".repeat(1000),
            "d.json:1:128: not valid JSON: recursion limit exceeded",
        );
    }

    #[test]
    fn a_key_that_stands_twice_is_refused() {
        check(
            "{\"a\": {\"b\": 1,\n \"b\": 2}}",
            "d.json:2:7 (/a/b): found the key \"b\" twice, expected each key once; remove one of the two",
        );
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(lines_and_columns("\"ä\": x", &["\"ä\": ".len()]), [(1, 6)]);
        assert_eq!(
            lines_and_columns("a\nbc\n\nd", &[7, 0, 3, 3, 99, 1]),
            [(4, 2), (1, 1), (2, 2), (2, 2), (4, 2), (1, 2)]
        );
    }
}
