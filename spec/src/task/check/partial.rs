//! Checks the valid remainder of a task document that the schema rejects, so that all problems are reported at once, without
//! problems that merely follow from others.

use serde_json::{Value as Json, json};

use super::super::TaskDocument;
use super::{Unsound, compile};
use crate::classes::Classes;
use crate::describe::escape;
use crate::error::Problem;

/// All problems of a document that the schema rejects: the schema's, and those that the other checks find in the remainder.
pub(in crate::task) fn problems(document: &Json, refused: Vec<Problem>, classes: Option<&Classes>) -> Vec<Problem> {
    let mut rest = Remainder {
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

/// The valid remainder of a document.
struct Remainder {
    json: Json,
    unsound: Unsound,
    /// Pointers below which nothing more is reported.
    silent: Vec<String>,
}

impl Remainder {
    /// Removes the subject of a problem; `None` if nothing useful would be left.
    fn leave_out(&mut self, problem: &Problem) -> Option<()> {
        let words: Vec<String> = problem.pointer.split('/').skip(1).map(plain).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let is_stray = problem.code == "spec/unknown-key" && words.len() != 2;
        // An invalid value makes its whole variant unsound.
        let is_value_of_variant = matches!(words[..], ["variants", _, _]);
        match words.as_slice() {
            // A missing key: at the top level only the name is required.
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

    /// Replaces a rejected value with a valid one; nothing more is reported below its pointer.
    fn replace(&mut self, pointer: String, valid: Json) -> Option<()> {
        *self.json.pointer_mut(&pointer)? = valid;
        self.silent.push(pointer);
        Some(())
    }

    fn remove(&mut self, parent: &str, key: &str) {
        // Two problems may concern the same part: the second finds it already removed.
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

/// Unescapes a key of a JSON pointer.
fn plain(word: &str) -> String {
    word.replace("~1", "/").replace("~0", "~")
}
