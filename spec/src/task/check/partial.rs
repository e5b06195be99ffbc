//! What is sound in a task's document beside what the schema refuses, so that all that is wrong is told at once: checks go on with the rest,
//! and say nothing that only follows from what was refused. The checks themselves are in `mod.rs`.

use std::collections::BTreeSet;

use serde_json::{Value as Json, json};

use super::super::TaskDocument;
use super::compile;
use crate::classes::Classes;
use crate::describe::escape;
use crate::error::Problem;

/// Parts of a document that something is wrong with already.
#[derive(Clone, Debug, Default)]
pub(in crate::task) struct Unsound {
    /// Parameters: nothing is known of what refers to them.
    pub(in crate::task) parameters: BTreeSet<String>,
    /// Variants: nothing is known of what extends them.
    pub(in crate::task) variants: BTreeSet<String>,
}

/// All that is wrong with a document that the schema refuses: that, and what the other checks find in the rest.
pub(in crate::task) fn problems(document: &Json, refused: Vec<Problem>, classes: Option<&Classes>) -> Vec<Problem> {
    let mut rest = Rest {
        json: document.clone(),
        unsound: Unsound::default(),
        silent: Vec::new(),
    };
    let is_known = refused.iter().all(|problem| rest.leave_out(problem).is_some());
    if !is_known || !TaskDocument::schema().allows(&rest.json) {
        return refused;
    }
    let Ok(document) = serde_json::from_value::<TaskDocument>(rest.json) else {
        return refused;
    };
    let more = compile(document, classes, rest.unsound).err().unwrap_or_default();
    let lies_in = |pointer: &str, part: &String| pointer == part || pointer.starts_with(&format!("{part}/"));
    let more = more
        .into_iter()
        .filter(|problem| !rest.silent.iter().any(|part| lies_in(&problem.pointer, part)));
    refused.iter().cloned().chain(more).collect()
}

/// What is left of a document.
struct Rest {
    json: Json,
    unsound: Unsound,
    /// The parts of which nothing more is said.
    silent: Vec<String>,
}

impl Rest {
    /// Leaves out what a problem is about; `None` if nothing sensible would be left.
    fn leave_out(&mut self, problem: &Problem) -> Option<()> {
        let words: Vec<String> = problem.pointer.split('/').skip(1).map(plain).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let is_stray = problem.code == "spec/unknown-key" && words.len() != 2;
        // A refused value spoils the variant that gives it to a parameter.
        let is_value_of_variant = matches!(words[..], ["variants", _, _]);
        match words.as_slice() {
            // A key that is not there: of the top ones only the name has to be.
            [] | ["name"] => self.put("", "name", json!("task")),
            ["parameters" | "variants" | "groups" | "world"] => None,
            [.., key] if is_stray && !is_value_of_variant => {
                let parent = problem.pointer.rsplit_once('/')?.0;
                self.remove(parent, key);
                Some(())
            }
            ["parameters", name, ..] => {
                self.silent.push(format!("/parameters/{}", escape(name)));
                self.unsound.parameters.insert((*name).to_owned());
                self.remove("/parameters", name);
                Some(())
            }
            ["variants", name, ..] => {
                self.silent.push(format!("/variants/{}", escape(name)));
                self.unsound.variants.insert((*name).to_owned());
                if problem.code == "spec/name" && words.len() == 2 {
                    self.remove("/variants", name);
                    return Some(());
                }
                self.put("/variants", name, json!({}))
            }
            ["groups", index, ..] => {
                let name = self
                    .json
                    .pointer(&format!("/groups/{index}/name"))
                    .and_then(Json::as_str);
                let name = name
                    .filter(|name| !name.is_empty() && name.len() <= 100)
                    .unwrap_or("refused");
                let group = json!({ "name": name, "count": 0, "object": { "class": "geometric" },
                    "placement": { "disc": { "center": [0, 0], "radius": 1 } } });
                self.replace(format!("/groups/{index}"), group)
            }
            ["world", "objects", index, ..] => {
                let object = json!({ "class": "geometric", "coordinates": [0, 0] });
                self.replace(format!("/world/objects/{index}"), object)
            }
            ["world", key, ..] => {
                self.silent.push(format!("/world/{}", escape(key)));
                self.remove("/world", key);
                Some(())
            }
            ["require", index, ..] => self.replace(format!("/require/{index}"), json!("true")),
            [key, ..] => {
                self.remove("", key);
                Some(())
            }
        }
    }

    /// Puts something sound where something was refused, of which nothing more is said.
    fn replace(&mut self, pointer: String, sound: Json) -> Option<()> {
        *self.json.pointer_mut(&pointer)? = sound;
        self.silent.push(pointer);
        Some(())
    }

    fn remove(&mut self, parent: &str, key: &str) {
        // Two problems may be about one part: the second finds it gone.
        if let Some(map) = self.json.pointer_mut(parent).and_then(Json::as_object_mut) {
            map.shift_remove(key);
        }
    }

    fn put(&mut self, parent: &str, key: &str, value: Json) -> Option<()> {
        self.json
            .pointer_mut(parent)?
            .as_object_mut()?
            .insert(key.to_owned(), value);
        Some(())
    }
}

/// A word of a pointer as it stands in the document.
fn plain(word: &str) -> String {
    word.replace("~1", "/").replace("~0", "~")
}
