//! [`Readers`]: who reads a parameter: the worlds of a task, or only the draws of other parameters.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use serde_json::Value as Json;

use super::document::TaskDocument;
use super::parameter::Role;

/// The readers of a parameter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Readers {
    /// Whether a world, a group or the value of a fixed parameter reads it.
    pub worlds: bool,
    /// The randomized parameters whose distributions read it, and parameters of type distribution with a choice that does, in
    /// the task's order.
    pub draws: Vec<String>,
}

impl Readers {
    /// Whether only distributions read it: of randomized parameters, or values of distribution parameters.
    pub fn are_draws_alone(&self) -> bool {
        !self.worlds && !self.draws.is_empty()
    }
}

impl TaskDocument {
    /// The readers of every parameter that has any, by its name.
    pub(super) fn readers(&self) -> BTreeMap<String, Readers> {
        let mut readers: BTreeMap<String, Readers> = BTreeMap::new();
        let mut in_worlds = names_in(&self.world);
        in_worlds.extend(names_in(&self.groups));
        for (name, other) in &self.parameters {
            in_worlds.extend(names_in(&other.value));
            let read = names_in(&(&other.distribution, &other.choices, &other.default));
            // A look-up over another draw depends on that draw, not only on its distribution.
            let is_drawn = |name: &String| {
                self.parameters
                    .get(name)
                    .is_some_and(|own| own.role == Role::Randomized)
            };
            if other.distribution.is_some() && read.iter().any(is_drawn) {
                in_worlds.extend(read.iter().cloned());
            }
            for read in read {
                readers.entry(read).or_default().draws.push(name.clone());
            }
        }
        for read in in_worlds {
            readers.entry(read).or_default().worlds = true;
        }
        readers
    }
}

/// The names that occur anywhere in a part of a document as `{ "param": NAME }`.
fn names_in(part: &impl Serialize) -> BTreeSet<String> {
    fn walk(json: &Json, found: &mut BTreeSet<String>) {
        match json {
            Json::Object(map) => {
                found.extend(map.get("param").and_then(Json::as_str).map(str::to_owned));
                map.values().for_each(|child| walk(child, found));
            }
            Json::Array(list) => list.iter().for_each(|child| walk(child, found)),
            _ => {}
        }
    }
    let mut found = BTreeSet::new();
    let json = serde_json::to_value(part).expect("a document that was read serialises");
    walk(&json, &mut found);
    found
}
