//! Finds the positions of values in a JSON text in one pass that stores no values, so that reporting problems in a large
//! document needs little extra memory.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt::Write;

use jsonc_parser::tokens::Token;
use jsonc_parser::{Scanner, ScannerOptions};

/// Escapes a key for a JSON pointer.
pub fn escape(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

/// The last key of a JSON pointer.
pub fn last_key(pointer: &str) -> String {
    let key = pointer.rsplit('/').next().unwrap_or_default();
    key.replace("~1", "/").replace("~0", "~")
}

/// A pointer to locate.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'p> {
    /// The pointer.
    pub pointer: &'p str,
    /// Whether to locate the key instead of the value.
    pub at_key: bool,
}

/// Offsets of the values at these pointers. A missing value gets the offset of its nearest existing ancestor.
pub fn offsets(text: &str, wanted: &[Wanted]) -> Vec<usize> {
    let mut tree = Tree::default();
    let paths: Vec<Vec<usize>> = wanted.iter().map(|wanted| tree.path(wanted.pointer)).collect();
    walk(text, |event| {
        tree.see(event);
        true
    });
    let offset = |(wanted, path): (&Wanted, &Vec<usize>)| {
        let there = path.iter().map_while(|node| tree.nodes[*node].place).last();
        there.map_or(0, |place| if wanted.at_key { place.key } else { place.value })
    };
    wanted.iter().zip(&paths).map(offset).collect()
}

/// Pointers to keys that are repeated within an object, in the order of the text, up to `limit` of them.
pub fn repeated(text: &str, limit: usize) -> Vec<String> {
    let mut open: Vec<Level> = Vec::new();
    let mut found = Vec::new();
    walk(text, |event| {
        match event {
            Event::Key(key, _) => {
                if let Some(Level::Object(keys, last)) = open.last_mut() {
                    let is_new = keys.insert(key.clone());
                    *last = key;
                    if !is_new {
                        found.push(pointer(&open));
                    }
                }
            }
            Event::Value(_, kind) => {
                if let Some(Level::List(items)) = open.last_mut() {
                    *items += 1;
                }
                open.extend(kind.map(|kind| match kind {
                    Kind::Object => Level::Object(HashSet::new(), Cow::Borrowed("")),
                    Kind::List => Level::List(0),
                }));
            }
            Event::Close => {
                open.pop();
            }
        }
        found.len() < limit
    });
    found
}

/// An open object with its keys so far and the last one, or an open list with the number of items so far.
enum Level<'t> {
    Object(HashSet<Cow<'t, str>>, Cow<'t, str>),
    List(usize),
}

fn pointer(open: &[Level]) -> String {
    open.iter().fold(String::new(), |mut pointer, level| {
        match level {
            Level::Object(_, key) => pointer.extend(["/", &escape(key)]),
            // Includes the item being read.
            Level::List(items) => {
                write!(pointer, "/{}", items.saturating_sub(1)).expect("writing to a String does not fail");
            }
        }
        pointer
    })
}

/// A step of [`walk`] through a text.
enum Event<'t> {
    /// A key and its offset.
    Key(Cow<'t, str>, usize),
    /// The start of a value; objects and lists last until they are closed.
    Value(usize, Option<Kind>),
    /// The end of the innermost open value.
    Close,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Object,
    List,
}

/// Walks through a text that is valid JSON, until `handle` returns false.
fn walk<'t>(text: &'t str, mut handle: impl FnMut(Event<'t>) -> bool) {
    let mut scanner = Scanner::new(text, &ScannerOptions::default());
    let mut open: Vec<Kind> = Vec::new();
    let mut key_is_next = false;
    while let Ok(Some(token)) = scanner.scan() {
        let start = scanner.token_start();
        let is_wanted = match token {
            Token::String(key) if key_is_next => {
                key_is_next = false;
                handle(Event::Key(key, start))
            }
            Token::Colon => true,
            Token::Comma => {
                key_is_next = open.last() == Some(&Kind::Object);
                true
            }
            Token::CloseBrace | Token::CloseBracket => {
                open.pop();
                key_is_next = false;
                handle(Event::Close)
            }
            Token::OpenBrace => {
                open.push(Kind::Object);
                key_is_next = true;
                handle(Event::Value(start, Some(Kind::Object)))
            }
            Token::OpenBracket => {
                open.push(Kind::List);
                handle(Event::Value(start, Some(Kind::List)))
            }
            _ => handle(Event::Value(start, None)),
        };
        if !is_wanted {
            return;
        }
    }
}

/// Offsets of a value and of its key; a list item has the same offset for both.
#[derive(Clone, Copy)]
struct Place {
    key: usize,
    value: usize,
}

/// The wanted pointers as a tree of their keys, and the position of the walk in it.
struct Tree {
    nodes: Vec<Node>,
    open: Vec<Branch>,
    /// For the next value in an object: its node, if it leads to a wanted pointer, and the offset of its key.
    keyed: (Option<usize>, usize),
}

#[derive(Default)]
struct Node {
    keys: HashMap<String, usize>,
    /// Like `keys`, but by index, for items of lists.
    items: HashMap<usize, usize>,
    place: Option<Place>,
}

/// An open value.
struct Branch {
    /// Its node, if it leads to a wanted pointer.
    node: Option<usize>,
    /// For a list, the index of the next item.
    item: Option<usize>,
}

impl Default for Tree {
    fn default() -> Self {
        Self {
            nodes: vec![Node::default()],
            open: Vec::new(),
            keyed: (None, 0),
        }
    }
}

impl Tree {
    /// The nodes along a pointer; creates missing ones.
    fn path(&mut self, pointer: &str) -> Vec<usize> {
        let mut path = vec![0];
        let mut node = 0;
        for step in pointer.split('/').skip(1) {
            let step = step.replace("~1", "/").replace("~0", "~");
            node = if let Some(child) = self.nodes[node].keys.get(&step) {
                *child
            } else {
                let child = self.nodes.len();
                self.nodes.push(Node::default());
                if let Ok(index) = step.parse() {
                    self.nodes[node].items.insert(index, child);
                }
                self.nodes[node].keys.insert(step, child);
                child
            };
            path.push(node);
        }
        path
    }

    /// Handles an event.
    fn see(&mut self, event: Event) {
        match event {
            Event::Key(key, start) => {
                let parent = self.open.last().and_then(|branch| branch.node);
                let child = parent.and_then(|node| self.nodes[node].keys.get(&*key).copied());
                if let Some(child) = child {
                    self.forget(child);
                }
                self.keyed = (child, start);
            }
            Event::Value(start, kind) => {
                let (node, key) = match self.open.last_mut() {
                    None => (Some(0), start),
                    Some(Branch { item: None, .. }) => self.keyed,
                    Some(Branch { item: Some(item), node }) => {
                        let child = node.and_then(|node| self.nodes[node].items.get(item).copied());
                        *item += 1;
                        (child, start)
                    }
                };
                if let Some(node) = node {
                    self.nodes[node].place = Some(Place { key, value: start });
                }
                self.open.extend(kind.map(|kind| Branch {
                    node,
                    item: (kind == Kind::List).then_some(0),
                }));
            }
            Event::Close => {
                self.open.pop();
            }
        }
    }

    /// Forgets a value and everything below it: if a key is repeated, its last value counts.
    fn forget(&mut self, node: usize) {
        if self.nodes[node].place.take().is_some() {
            let below: Vec<usize> = self.nodes[node].keys.values().copied().collect();
            for child in below {
                self.forget(child);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, pointer: &str, at_key: bool) -> usize {
        offsets(text, &[Wanted { pointer, at_key }])[0]
    }

    #[test]
    fn values_and_keys_are_found_by_pointer() {
        let text = r#" {"a": [10, {"b/c": true, "d": []}], "e": "}", "f~": 1}"#;
        let check = |pointer: &str, at_key: bool, rest: &str| {
            assert!(text[at(text, pointer, at_key)..].starts_with(rest), "{pointer}");
        };
        check("", false, "{\"a\"");
        check("/a", true, "\"a\": [");
        check("/a", false, "[10");
        check("/a/0", true, "10,");
        check("/a/1/b~1c", false, "true");
        check("/a/1/d", true, "\"d\"");
        check("/e", false, "\"}\"");
        check("/f~0", false, "1}");
        // A missing value is reported at its nearest ancestor.
        check("/a/1/d/7", false, "[]}");
        check("/a/x", false, "[10");
        check("/nothing", false, "{\"a\"");
    }

    #[test]
    fn last_of_repeated_keys_counts() {
        let text = r#"{"a": {"b": 1}, "a": [2]}"#;
        assert_eq!(at(text, "/a", false), text.find("[2]").unwrap());
        assert_eq!(at(text, "/a/b", false), text.find("[2]").unwrap());
    }

    #[test]
    fn repeated_keys_are_listed_in_text_order() {
        let text = r#"{"a": {"b": [0, {"c": 1, "c": 2}], "b": 3}, "x": {"c": 1}, "a": 4, "a": 5}"#;
        assert_eq!(repeated(text, 9), ["/a/b/1/c", "/a/b", "/a", "/a"]);
        assert_eq!(repeated(text, 2), ["/a/b/1/c", "/a/b"]);
        assert!(repeated(r#"[{"a": 1}, {"a": 1}, "a", "a"]"#, 9).is_empty());
    }
}
