//! [`Leaves`]: fields of a world flattened into the numbers and words of their JSON, so that a small change in one number is a
//! small distance.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value as Json;

use crate::assignment::{Assignment, MAX_ASSIGNED};
use crate::scalar::relative_difference;

/// Distance between two points, in metres, that counts as 1, as for objects.
const METRES_PER_UNIT: f64 = 10.0;

/// Numbers and words by their paths, in the order of the paths' ids.
#[derive(Debug, PartialEq)]
pub(super) struct Leaves {
    all: Vec<(u32, Leaf)>,
    /// The JSON text that they were read from: equal texts give equal leaves.
    pub(super) text: Vec<u8>,
}

/// A value at a path.
#[derive(Clone, Debug, PartialEq, PartialOrd)]
enum Leaf {
    Number(f64),
    /// A point of a list of points: metres on the ground.
    Point([f64; 2]),
    /// The id of a word, a boolean, or an empty value.
    Word(u32),
    /// A set of words, such as modalities or stimuli: their ids, each once, in ascending order.
    WordSet(Vec<u32>),
    /// An unordered collection of things, such as walls or regions, each made of leaves.
    Things(Vec<Vec<(u32, Leaf)>>),
}

/// Reads leaves, and interns texts, paths and words.
#[derive(Debug, Default)]
pub(super) struct LeafReader {
    read: BTreeMap<Vec<u8>, Arc<Leaves>>,
    names: BTreeMap<String, u32>,
}

impl LeafReader {
    /// Reads leaves from lines of JSON, one field per line.
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
            // Records that a struct is present: an empty struct, such as a key, is `{}`.
            if json.is_object() {
                let leaf = Leaf::Word(self.id("{}".to_owned()));
                all.push((self.id(format!("{line}/")), leaf));
            }
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
            // Absent, like a key that a struct leaves out.
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
            Json::Array(list) if !list.is_empty() && list.iter().all(Json::is_string) => {
                let mut words: Vec<u32> = list.iter().map(|word| self.id(word.to_string())).collect();
                words.sort_unstable();
                words.dedup();
                Leaf::WordSet(words)
            }
            Json::Array(list) if !list.is_empty() && list.iter().all(is_thing) => {
                Leaf::Things(list.iter().map(|thing| self.leaves_of(thing)).collect())
            }
            Json::Array(list) => {
                let are_points = list.iter().all(|child| point(child).is_some());
                for (index, child) in list.iter().enumerate() {
                    path.push('/');
                    path.push_str(&index.to_string());
                    match point(child) {
                        Some(point) if are_points => all.push((self.id(path.clone()), Leaf::Point(point))),
                        _ => self.walk(child, path, all),
                    }
                    path.truncate(length);
                }
                return;
            }
            Json::Number(number) => Leaf::Number(number.as_f64().unwrap_or(f64::MAX)),
            word => Leaf::Word(self.id(word.to_string())),
        };
        let path = self.id(path.clone());
        all.push((path, leaf));
    }

    /// The leaves of one thing in a collection, by their paths within it.
    fn leaves_of(&mut self, thing: &Json) -> Vec<(u32, Leaf)> {
        let mut all = Vec::new();
        self.walk(thing, &mut String::new(), &mut all);
        all.sort_unstable_by_key(|(path, _)| *path);
        all
    }

    fn id(&mut self, name: String) -> u32 {
        let next = u32::try_from(self.names.len()).unwrap_or(u32::MAX);
        *self.names.entry(name).or_insert(next)
    }
}

impl Leaves {
    /// The distance: a sum over all paths. Numbers count by their difference divided by the larger magnitude; points by their
    /// distance in tens of metres, up to 2; a different word, or a path that only one side has, even a struct, counts as 1; sets
    /// of words by the number of words to change, add or remove; things by the cheapest matching, with unmatched ones in full.
    /// A metric; 0 for equal leaves. Both must come from the same reader.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        if std::ptr::eq(self, other) {
            return 0.0;
        }
        list_distance(&self.all, &other.all)
    }
}

/// Whether the position of an item in a list has no meaning: it is a wall, or a region, which is a list of points.
fn is_thing(json: &Json) -> bool {
    let is_point = |json: &Json| json.as_array().is_some_and(|list| list.iter().all(Json::is_number));
    json.is_object()
        || json
            .as_array()
            .is_some_and(|list| !list.is_empty() && list.iter().all(is_point))
}

/// The two coordinates of a point.
fn point(json: &Json) -> Option<[f64; 2]> {
    match json.as_array()?.as_slice() {
        [x, y] => Some([x.as_f64()?, y.as_f64()?]),
        _ => None,
    }
}

/// The sum over all paths of two lists sorted by path.
fn list_distance(a: &[(u32, Leaf)], b: &[(u32, Leaf)]) -> f64 {
    let (mut i, mut j, mut sum) = (0, 0, 0.0);
    loop {
        match (a.get(i), b.get(j)) {
            (None, None) => return sum,
            (Some((mine, a)), Some((theirs, b))) if mine == theirs => {
                sum += a.distance(b);
                (i, j) = (i + 1, j + 1);
            }
            (Some((mine, unmatched)), theirs) if theirs.is_none_or(|(theirs, _)| mine < theirs) => {
                (i, sum) = (i + 1, sum + unmatched.size());
            }
            (_, unmatched) => (j, sum) = (j + 1, sum + unmatched.map_or(0.0, |(_, unmatched)| unmatched.size())),
        }
    }
}

/// The distance of a thing from nothing.
fn size(thing: &[(u32, Leaf)]) -> f64 {
    thing.iter().map(|(_, leaf)| leaf.size()).sum()
}

/// The cheapest matching of things: identical ones are matched with each other, the rest by an assignment. Bit-identical for
/// any order of the things and of the arguments.
fn collection_distance(a: &[Vec<(u32, Leaf)>], b: &[Vec<(u32, Leaf)>]) -> f64 {
    let [mut mine, mut theirs] = [a, b].map(|things| things.iter().collect::<Vec<_>>());
    mine.retain(|thing| match theirs.iter().position(|other| other == thing) {
        Some(index) => {
            theirs.remove(index);
            false
        }
        None => true,
    });
    for things in [&mut mine, &mut theirs] {
        things.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
    }
    let (fewer, more) = if (mine.len(), &mine) <= (theirs.len(), &theirs) {
        (mine, theirs)
    } else {
        (theirs, mine)
    };
    // Unmatched things count in full, so it is cheapest to match all things of the smaller collection.
    let saving = |a: &[(u32, Leaf)], b: &[(u32, Leaf)]| list_distance(a, b) - size(b);
    let total: f64 = more.iter().map(|thing| size(thing)).sum();
    // Collections too large for an assignment are compared in order.
    let in_order = || fewer.iter().zip(&more).map(|(one, other)| saving(one, other)).sum();
    let matched = if more.len() <= MAX_ASSIGNED {
        let costs: Vec<f64> = fewer
            .iter()
            .flat_map(|one| more.iter().map(|other| saving(one, other)))
            .collect();
        Assignment::new()
            .solve(&costs, fewer.len(), more.len())
            .unwrap_or_else(|_| in_order())
    } else {
        in_order()
    };
    (total + matched).max(0.0)
}

impl Leaf {
    fn distance(&self, other: &Self) -> f64 {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => relative_difference(*a, *b),
            // At most the sum of both points' distances from nothing.
            (Self::Point(a), Self::Point(b)) => {
                let [x, y] = [0, 1].map(|axis| a[axis] - b[axis]);
                ((x * x + y * y).sqrt() / METRES_PER_UNIT).min(self.size() + other.size())
            }
            (Self::Things(a), Self::Things(b)) => collection_distance(a, b),
            _ if self == other => 0.0,
            _ => {
                // A word replaces another as long as both sides have words left.
                let shared = self.words().iter().filter(|word| other.words().contains(word)).count();
                self.size().max(other.size()) - shared as f64
            }
        }
    }

    fn words(&self) -> &[u32] {
        match self {
            Self::Number(_) | Self::Point(_) | Self::Things(_) => &[],
            Self::Word(word) => std::slice::from_ref(word),
            Self::WordSet(words) => words,
        }
    }

    /// The distance from nothing.
    fn size(&self) -> f64 {
        match self {
            Self::Number(_) | Self::Point(_) | Self::Word(_) => 1.0,
            Self::WordSet(words) => words.len() as f64,
            Self::Things(things) => things.iter().map(|thing| size(thing)).sum(),
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
        assert_eq!(d("null\n", "{\"x\":1,\"y\":[1,2]}\n"), 4.0);
        assert_eq!(
            (
                d("null\n", "{}\n"),
                d("{}\n", "{\"x\":1}\n"),
                d("null\n", "{\"x\":1}\n")
            ),
            (1.0, 1.0, 2.0)
        );
        assert_eq!(d("[]\n5\n", "[\"a\"]\n10\n"), 1.5);
    }

    #[test]
    fn set_distance_counts_words_equally() {
        let mut reader = LeafReader::default();
        let mut d = |a: &str, b: &str| reader.read(a.as_bytes()).distance(&reader.read(b.as_bytes()));
        let both = r#"["a","b"]"#;
        assert_eq!((d(both, r#"["a"]"#), d(both, r#"["b"]"#)), (1.0, 1.0));
        assert_eq!((d(both, r#"["b","a"]"#), d(both, r#"["c","a"]"#)), (0.0, 1.0));
        assert_eq!((d(both, "[]"), d(r#"["a"]"#, r#"["c"]"#)), (2.0, 1.0));
    }

    #[test]
    fn things_are_matched_in_any_order() {
        let mut reader = LeafReader::default();
        let mut d = |a: &str, b: &str| reader.read(a.as_bytes()).distance(&reader.read(b.as_bytes()));
        let walls = r#"[{"polygon":[[1,1],[2,1],[2,2]]},{"polygon":[[5,5],[6,5],[6,8]],"height":2}]"#;
        let swapped = r#"[{"polygon":[[5,5],[6,5],[6,8]],"height":2},{"polygon":[[1,1],[2,1],[2,2]]}]"#;
        let lower = r#"[{"polygon":[[5,5],[6,5],[6,8]],"height":1},{"polygon":[[1,1],[2,1],[2,2]]}]"#;
        let fewer = r#"[{"polygon":[[5,5],[6,5],[6,8]],"height":1}]"#;
        assert_eq!((d(walls, swapped), d(walls, lower), d(lower, fewer)), (0.0, 0.5, 3.0));
        assert_eq!((d(walls, "[]"), d(walls, fewer)), (7.0, 3.5));
        let regions = [
            "[[[1,1],[2,1],[2,2]],[[5,5],[6,5],[6,8]]]",
            "[[[5,5],[6,5],[6,8]],[[1,1],[2,1],[2,2]]]",
        ];
        assert_eq!(d(regions[0], regions[1]), 0.0);
        // The order of waypoints matters.
        assert!((d("[[1,1],[4,5]]", "[[4,5],[1,1]]") - 1.0).abs() < 1e-12);
    }

    #[test]
    fn points_count_by_their_distance() {
        let mut reader = LeafReader::default();
        let mut d = |a: &str, b: &str| reader.read(a.as_bytes()).distance(&reader.read(b.as_bytes()));
        let (here, near, far) = ("[[0,0],[7,7]]", "[[0.004,0],[7,7]]", "[[4,0],[7,7]]");
        assert!((d(here, near) - 0.0004).abs() < 1e-12 && (d(here, far) - 0.4).abs() < 1e-12);
        assert_eq!((d(here, "[[900,0],[7,7]]"), d(here, "[[0,0]]")), (2.0, 1.0));
    }

    fn texts() -> impl Strategy<Value = String> {
        let number = prop_oneof![Just("0".to_owned()), (-9..9).prop_map(|x: i32| x.to_string())];
        let word = prop::sample::select(vec!["\"a\"", "true", "null", "[]"]).prop_map(str::to_owned);
        let leaf = prop_oneof![number, word];
        let list = prop::collection::vec(leaf.clone(), 0..3).prop_map(|items| format!("[{}]", items.join(",")));
        let set = prop::sample::subsequence(vec!["\"a\"", "\"b\"", "\"c\""], 0..=3)
            .prop_map(|words| format!("[{}]", words.join(",")));
        let thing = (1..4, prop::option::of(1..4)).prop_map(|(x, height)| {
            height.map_or_else(
                || format!("{{\"x\":{x}}}"),
                |height| format!("{{\"x\":{x},\"height\":{height}}}"),
            )
        });
        let things = prop::collection::vec(thing, 0..4).prop_map(|things| format!("[{}]", things.join(",")));
        let points = prop::collection::vec((-30..30, 0..3), 0..3).prop_map(|points| {
            let points: Vec<String> = points.iter().map(|(x, y)| format!("[{x},{y}]")).collect();
            format!("[{}]", points.join(","))
        });
        prop::collection::vec(prop_oneof![leaf, list, set, things, points], 2).prop_map(|lines| lines.join("\n"))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn leaves_distance_is_a_metric(a in texts(), b in texts(), c in texts()) {
            let mut reader = LeafReader::default();
            let [a, b, c] = [a, b, c].map(|text| reader.read(text.as_bytes()));
            prop_assert_eq!(a.distance(&a), 0.0);
            prop_assert_eq!(a.distance(&b), b.distance(&a));
            prop_assert!(a.distance(&c) <= a.distance(&b) + b.distance(&c) + 1e-12);
        }
    }
}
