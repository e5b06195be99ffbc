//! Turns fuzzer bytes into JSON: the bytes themselves, or a known document with the edits that the bytes describe, because random
//! bytes rarely get past a parser.

use std::collections::BTreeSet;

use arbitrary::Unstructured;
use serde_json::{Map, Number, Value};

/// First byte of an input that describes edits.
pub(crate) const MARK: u8 = b'~';

/// Maximum number of edits to one document.
const MAX_EDITS: usize = 12;

/// Seed documents, and the words that edits may insert.
pub(crate) struct Known {
    documents: Vec<Value>,
    words: Vec<String>,
}

impl Known {
    /// Uses these documents. Keys and words come from them and from the JSON Schema.
    pub(crate) fn new(documents: Vec<Value>, schema: &str) -> Self {
        let mut words = BTreeSet::new();
        for document in &documents {
            collect_words(document, &mut words);
        }
        let schema: Value = serde_json::from_str(schema).expect("our schemas are valid JSON");
        collect_words(&schema, &mut words);
        words.retain(|word| word.len() <= 40);
        Self {
            documents,
            words: words.into_iter().collect(),
        }
    }

    /// The text that the bytes describe.
    pub(crate) fn text(&self, bytes: &[u8]) -> String {
        match bytes.split_first() {
            Some((&MARK, rest)) => self.edited(&mut Unstructured::new(rest)).to_string(),
            _ => String::from_utf8_lossy(bytes).into_owned(),
        }
    }

    /// A known document with the edits that the bytes describe.
    pub(crate) fn edited(&self, bytes: &mut Unstructured) -> Value {
        let mut document = self.any_document(bytes).clone();
        for _ in 0..MAX_EDITS {
            if bytes.is_empty() {
                break;
            }
            self.change(&mut document, bytes);
        }
        document
    }

    fn any_document(&self, bytes: &mut Unstructured) -> &Value {
        // When the bytes are used up, chooses the first document.
        let at = bytes.choose_index(self.documents.len()).unwrap_or_default();
        &self.documents[at]
    }

    /// Walks to a random position in the document and changes the value there.
    fn change(&self, value: &mut Value, bytes: &mut Unstructured) {
        let stop = byte(bytes).is_multiple_of(4);
        match value {
            Value::Object(map) if !map.is_empty() && !stop => {
                let at = usize::from(byte(bytes)) % map.len();
                if let Some(child) = map.values_mut().nth(at) {
                    return self.change(child, bytes);
                }
            }
            Value::Array(items) if !items.is_empty() && !stop => {
                let at = usize::from(byte(bytes)) % items.len();
                return self.change(&mut items[at], bytes);
            }
            _ => {}
        }
        let other = self.value(bytes);
        match (byte(bytes) % 6, value) {
            (0, Value::Object(map)) => {
                map.insert(self.word(bytes), other);
            }
            (1, Value::Object(map)) if !map.is_empty() => {
                let at = usize::from(byte(bytes)) % map.len();
                if let Some(key) = map.keys().nth(at).cloned() {
                    map.shift_remove(&key);
                }
            }
            (2, Value::Object(map)) if !map.is_empty() => {
                let at = usize::from(byte(bytes)) % map.len();
                let key = map.keys().nth(at).cloned().unwrap_or_default();
                let moved = map.shift_remove(&key).unwrap_or_default();
                map.insert(self.word(bytes), moved);
            }
            (0, Value::Array(items)) => items.push(other),
            (1, Value::Array(items)) if !items.is_empty() => {
                items.remove(usize::from(byte(bytes)) % items.len());
            }
            (2, Value::Array(items)) if !items.is_empty() => {
                let copied = items[usize::from(byte(bytes)) % items.len()].clone();
                items.extend(std::iter::repeat_n(copied, usize::from(byte(bytes) % 8)));
            }
            (3, value) => *value = Value::Array(vec![value.take()]),
            (4, value) => {
                let mut from = self.any_document(bytes);
                for _ in 0..byte(bytes) % 6 {
                    let at = usize::from(byte(bytes));
                    from = match from {
                        Value::Object(map) if !map.is_empty() => map.values().nth(at % map.len()).unwrap_or(from),
                        Value::Array(items) if !items.is_empty() => &items[at % items.len()],
                        _ => break,
                    };
                }
                *value = from.clone();
            }
            (_, value) => *value = other,
        }
    }

    fn value(&self, bytes: &mut Unstructured) -> Value {
        match byte(bytes) % 10 {
            0 => Value::Null,
            1 => Value::Bool(byte(bytes).is_multiple_of(2)),
            2 => Value::from(i64::from(byte(bytes)) - 64),
            3 => number(f64::from(byte(bytes)) / 64.0 - 1.0),
            4 => number(bytes.arbitrary().unwrap_or_default()),
            5 => {
                const EDGES: [f64; 12] = [
                    0.0,
                    -0.0,
                    1e-300,
                    -1e-9,
                    0.5,
                    1.0,
                    360.0,
                    1e6,
                    1e15,
                    9_007_199_254_740_993.0,
                    1e100,
                    -1e308,
                ];
                number(EDGES[usize::from(byte(bytes)) % EDGES.len()])
            }
            6 => Value::Array(Vec::new()),
            7 => Value::Object(Map::new()),
            8 => {
                const TEXTS: [&str; 9] = ["", ".", "..", "a/b", "\u{202e}", "\u{1b}[2J", "ä", "a\nb", "CON"];
                Value::from(TEXTS[usize::from(byte(bytes)) % TEXTS.len()])
            }
            _ => Value::from(self.word(bytes)),
        }
    }

    fn word(&self, bytes: &mut Unstructured) -> String {
        let at = bytes.choose_index(self.words.len()).unwrap_or_default();
        self.words.get(at).cloned().unwrap_or_default()
    }
}

/// The next byte, or 0 when the bytes are used up.
pub(crate) fn byte(bytes: &mut Unstructured) -> u8 {
    bytes.arbitrary().unwrap_or_default()
}

fn number(number: f64) -> Value {
    Number::from_f64(number).map_or(Value::Null, Value::Number)
}

fn collect_words(value: &Value, words: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => {
            words.insert(text.clone());
        }
        Value::Array(items) => items.iter().for_each(|item| collect_words(item, words)),
        Value::Object(map) => {
            for (key, item) in map {
                words.insert(key.clone());
                collect_words(item, words);
            }
        }
        _ => {}
    }
}
