//! Reads a task spec, and checks it against the schema, then against the rules that no schema can state.

use std::sync::Arc;

use serde_json::Value as Json;

use super::check::{Unsound, compile, partial};
use super::{TaskDocument, TaskSpec};
use crate::classes::Classes;
use crate::describe::escape;
use crate::document::Document;
use crate::error::{Listed, Problem, SpecError};
use crate::limits::{MAX_TASK_DEPTH, MAX_VALUES};
use crate::version;

/// Maximum size in bytes of a document that is searched for further problems after the schema has rejected it.
const MAX_COPIED_BYTES: usize = 1 << 17;

impl TaskSpec {
    /// Reads and checks a task spec. `name` is the document's name in messages, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with all problems of the text, sorted by position.
    pub fn from_json(name: &str, text: &str) -> Result<Arc<Self>, SpecError> {
        Self::from_json_with(name, text, None)
    }

    /// Like [`TaskSpec::from_json`]; if classes are given, also rejects objects with other classes or models.
    ///
    /// # Errors
    /// As [`TaskSpec::from_json`].
    pub fn from_json_with(name: &str, text: &str, classes: Option<&Classes>) -> Result<Arc<Self>, SpecError> {
        let mut document = Document::parse(name, text, MAX_VALUES)?;
        let too_deep = too_deep(&document.value, 0).map(|pointer| {
            let found = format!("more than {MAX_TASK_DEPTH} nested lists and objects");
            let expected = format!("at most {MAX_TASK_DEPTH}; is a bracket missing?");
            Problem::new("spec/value", pointer, found, expected)
        });
        document.fail_on(Vec::from_iter(too_deep))?;
        document.upgrade(&version::TASK)?;
        let listed = TaskDocument::schema().problems(&document.value);
        if !listed.problems.is_empty() {
            // The search for other problems needs a copy, which would take too much memory for a large document.
            let Listed { mut problems, more } = listed;
            if text.len() <= MAX_COPIED_BYTES {
                problems = partial::problems(&document.value, problems, classes);
            }
            document.fail_on(Listed { problems, more })?;
        }
        let spec: TaskDocument = document.deserialize()?;
        let task = compile(spec, classes, Unsound::default());
        task.map(Arc::new).map_err(|problems| {
            debug_assert!(!problems.is_empty(), "a task without problems compiles");
            document.error(problems)
        })
    }

    /// The problems of all objects that have, or can have, an unknown class or model.
    pub fn unknown_classes(&self, classes: &Classes) -> Vec<Problem> {
        // Everything else was already valid when the task was loaded.
        compile(self.document.clone(), Some(classes), Unsound::default())
            .err()
            .unwrap_or_default()
    }
}

/// The pointer of the first list or object nested too deeply.
fn too_deep(json: &Json, depth: usize) -> Option<String> {
    let inside = |child| too_deep(child, depth + 1);
    match json {
        Json::Array(_) | Json::Object(_) if depth > MAX_TASK_DEPTH => Some(String::new()),
        Json::Array(list) => (0..)
            .zip(list)
            .find_map(|(index, child)| Some(format!("/{index}{}", inside(child)?))),
        Json::Object(map) => map
            .iter()
            .find_map(|(key, child)| Some(format!("/{}{}", escape(key), inside(child)?))),
        _ => None,
    }
}
