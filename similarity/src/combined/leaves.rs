//! [`Leaves`]: fields of a world as the numbers and words that their JSON has, so that a small change of one number is a
//! small distance. Which fields are compared so is said by the table of fields; the sums are made in `parts.rs`.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value as Json;

use crate::scalar::relative_difference;

/// Numbers and words by the paths at which they stand, in the order of the paths' numbers.
#[derive(Debug, PartialEq)]
pub(super) struct Leaves {
    all: Vec<(u32, Leaf)>,
    /// The text that they were read from: equal for equal leaves.
    pub(super) text: Vec<u8>,
}

/// What stands at a path.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Leaf {
    Number(f64),
    /// The number of a word, a truth, or of what is empty.
    Word(u32),
}

/// Reads leaves, and gives each text, path and word a number that is the same whenever it is met.
#[derive(Debug, Default)]
pub(super) struct LeafReader {
    read: BTreeMap<Vec<u8>, Arc<Leaves>>,
    names: BTreeMap<String, u32>,
}

impl LeafReader {
    /// The leaves of a text of lines of JSON, of which each is a field.
    pub(super) fn read(&mut self, text: &[u8]) -> Arc<Leaves> {
        if let Some(known) = self.read.get(text) {
            return Arc::clone(known);
        }
        let mut all = Vec::new();
        for (line, field) in text
            .split(|byte| *byte == b'\n')
            .filter(|line| !line.is_empty())
            .enumerate()
        {
            let json: Json = serde_json::from_slice(field).expect("fields of a world are JSON");
            self.walk(&json, &mut line.to_string(), &mut all);
        }
        all.sort_unstable_by_key(|(path, _)| *path);
        let text = text.to_vec();
        let leaves = Arc::new(Leaves {
            all,
            text: text.clone(),
        });
        self.read.insert(text, Arc::clone(&leaves));
        leaves
    }

    fn walk(&mut self, json: &Json, path: &mut String, all: &mut Vec<(u32, Leaf)>) {
        let length = path.len();
        let leaf = match json {
            // Absent, as a key that a struct leaves out.
            Json::Null => return,
            Json::Object(map) => {
                for (key, child) in map {
                    path.push('/');
                    path.push_str(key);
                    self.walk(child, path, all);
                    path.truncate(length);
                }
                return;
            }
            Json::Array(list) => {
                // A list of words is a set: modalities, stimuli.
                let mut list: Vec<&Json> = list.iter().collect();
                if list.iter().all(|item| item.is_string()) {
                    list.sort_by_key(|word| word.as_str());
                }
                for (index, child) in list.into_iter().enumerate() {
                    path.push('/');
                    path.push_str(&index.to_string());
                    self.walk(child, path, all);
                    path.truncate(length);
                }
                return;
            }
            Json::Number(number) => Leaf::Number(number.as_f64().unwrap_or(f64::MAX)),
            word => Leaf::Word(self.number(word.to_string())),
        };
        let path = self.number(path.clone());
        all.push((path, leaf));
    }

    fn number(&mut self, name: String) -> u32 {
        let next = u32::try_from(self.names.len()).unwrap_or(u32::MAX);
        *self.names.entry(name).or_insert(next)
    }
}

impl Leaves {
    /// How far two are apart: the sum over all paths of the difference of two numbers over the larger in size, 1 for another
    /// word, 1 for what stands in one only. A metric; 0 for equal ones. Both must come from one reader.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let (mut i, mut j, mut sum) = (0, 0, 0.0);
        if std::ptr::eq(self, other) {
            return sum;
        }
        loop {
            match (self.all.get(i), other.all.get(j)) {
                (None, None) => return sum,
                (Some((mine, a)), Some((theirs, b))) if mine == theirs => {
                    sum += a.distance(*b);
                    (i, j) = (i + 1, j + 1);
                }
                (Some((mine, _)), theirs) if theirs.is_none_or(|(theirs, _)| mine < theirs) => {
                    (i, sum) = (i + 1, sum + 1.0);
                }
                _ => (j, sum) = (j + 1, sum + 1.0),
            }
        }
    }
}

impl Leaf {
    fn distance(self, other: Self) -> f64 {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => relative_difference(a, b),
            _ => f64::from(u8::from(self != other)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_graded_and_words_are_not() {
        let mut reader = LeafReader::default();
        let mut d = |a: &str, b: &str| reader.read(a.as_bytes()).distance(&reader.read(b.as_bytes()));
        assert_eq!(d("2\n", "2.0\n"), 0.0);
        assert!((d("2\n", "2.001\n") - 0.001 / 2.001).abs() < 1e-12);
        assert_eq!(d("2\n", "20\n"), 0.9);
        assert_eq!(d("\"a\"\n[1,2]\n", "\"b\"\n[1,2]\n"), 1.0);
        assert_eq!(d("null\n", "{\"x\":1,\"y\":[1,2]}\n"), 3.0);
        assert_eq!(d("[]\n5\n", "[\"a\"]\n10\n"), 1.5);
    }

    fn texts() -> impl Strategy<Value = String> {
        let number = prop_oneof![Just("0".to_owned()), (-9..9).prop_map(|x: i32| x.to_string())];
        let word = prop::sample::select(vec!["\"a\"", "true", "null", "[]"]).prop_map(str::to_owned);
        let leaf = prop_oneof![number, word];
        let list = prop::collection::vec(leaf.clone(), 0..3).prop_map(|items| format!("[{}]", items.join(",")));
        prop::collection::vec(prop_oneof![leaf, list], 2).prop_map(|lines| lines.join("\n"))
    }

    proptest! {
        #[test]
        fn it_is_a_metric(a in texts(), b in texts(), c in texts()) {
            let mut reader = LeafReader::default();
            let [a, b, c] = [a, b, c].map(|text| reader.read(text.as_bytes()));
            prop_assert_eq!(a.distance(&a), 0.0);
            prop_assert_eq!(a.distance(&b), b.distance(&a));
            prop_assert!(a.distance(&c) <= a.distance(&b) + b.distance(&c) + 1e-12);
        }
    }
}
