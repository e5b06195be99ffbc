//! Templates of worlds and objects: whether each hole is one that may vary, and takes every value that it can be given.

use serde_json::Value as Json;

use super::super::template::{Hole, Opening, Template, openings};
use super::Check;
use crate::describe::{describe, pointer_of};
use crate::error::Problem;
use crate::value::Value;
use crate::world::{Object, WorldDraft};

impl Check<'_> {
    /// The world's template and those of the objects it holds.
    pub(super) fn world(&mut self, json: &Json) -> (Option<Template<WorldDraft>>, Vec<Option<Template<Object>>>) {
        let mut json = if json.is_null() {
            Json::Object(serde_json::Map::new())
        } else {
            json.clone()
        };
        let objects = json.as_object_mut().and_then(|map| map.shift_remove("objects"));
        let fixtures = objects
            .as_ref()
            .and_then(Json::as_array)
            .into_iter()
            .flatten()
            .enumerate();
        let fixtures = fixtures
            .map(|(index, object)| self.object(&format!("/world/objects/{index}"), object))
            .collect();
        let world = self.template("/world", &json, Template::<WorldDraft>::hole);
        if let Some(world) = &world {
            for mut problem in world.base.problems() {
                problem.pointer.insert_str(0, "/world");
                self.report(problem);
            }
        }
        (world, fixtures)
    }

    pub(super) fn object(&mut self, pointer: &str, json: &Json) -> Option<Template<Object>> {
        let template = self.template(pointer, json, Template::<Object>::hole)?;
        self.known_class(pointer, &template);
        Some(template)
    }

    /// Whether the classes that an object can be of are known.
    fn known_class(&mut self, root: &str, template: &Template<Object>) {
        let Some(classes) = self.classes else { return };
        let pointer = format!("{root}/class");
        let hole = template.holes.iter().find(|hole| hole.pointer == "/class");
        let found = match hole {
            None => classes.problem(&pointer, &template.base.class),
            Some(hole) => self
                .candidates(&hole.source, hole.kind)
                .iter()
                .find_map(|value| match value {
                    Value::Text(class) => classes.problem(&pointer, class),
                    _ => None,
                }),
        };
        self.problems.extend(found);
    }

    /// A template: each hole checked, and the rest read with an example in each hole.
    fn template<T: serde::de::DeserializeOwned + Clone>(
        &mut self,
        root: &str,
        json: &Json,
        hole_at: fn(&Opening) -> Option<Hole<T>>,
    ) -> Option<Template<T>> {
        let before = self.problems.len();
        let mut example = json.clone();
        let mut holes = Vec::new();
        let mut is_known = true;
        for opening in openings(json) {
            let pointer = format!("{root}{}", opening.0);
            let Some(hole) = hole_at(&opening) else {
                let found = "a parameter or distribution";
                let expected = "a plain value; this place cannot vary";
                self.report(Problem::new("spec/value", pointer, found, expected));
                continue;
            };
            if self.is_unsound(&hole.source) {
                is_known = false;
            } else if self.is_json(&hole.source, hole.kind) {
                let candidates = self.json_candidates(&pointer, &hole);
                if let (Some(value), Some(place)) = (candidates.first(), example.pointer_mut(&opening.0)) {
                    *place = hole.written(value);
                    holes.push((hole, candidates));
                }
            } else if self.source(&pointer, &hole.source, hole.kind) {
                let candidates = self.candidates(&hole.source, hole.kind);
                if self.in_range(&pointer, &candidates, hole.range)
                    && let (Some(value), Some(place)) = (candidates.first(), example.pointer_mut(&opening.0))
                {
                    *place = hole.written(value);
                    holes.push((hole, candidates));
                }
            }
        }
        if self.problems.len() > before || !is_known {
            return None;
        }
        let base: T = match serde_path_to_error::deserialize(&example) {
            Ok(base) => base,
            Err(error) => {
                let pointer = format!("{root}{}", pointer_of(error.path()));
                let found = example
                    .pointer(&pointer_of(error.path()))
                    .map_or_else(|| "nothing".to_owned(), describe);
                let text = error.inner().to_string();
                // «invalid length 2, expected an array of length 3»: the first half is what was found.
                let expected = text
                    .split_once(", expected ")
                    .map_or(text.as_str(), |(_, expected)| expected);
                self.report(Problem::new("spec/value", pointer, found, expected));
                return None;
            }
        };
        self.fillable(root, &base, &holes);
        (self.problems.len() == before).then(|| Template {
            base,
            holes: holes.into_iter().map(|(hole, _)| hole).collect(),
        })
    }

    /// Whether each hole takes each value that it may be given, as a text that must name something.
    fn fillable<T: Clone>(&mut self, root: &str, base: &T, holes: &[(Hole<T>, Vec<Value>)]) {
        for (hole, candidates) in holes {
            let mut trial = base.clone();
            if let Some(value) = candidates.iter().find(|value| hole.fill(&mut trial, value).is_none()) {
                let pointer = format!("{root}{}", hole.pointer);
                let found = format!("a source that can give {value}");
                self.report(Problem::new(
                    "spec/value",
                    pointer,
                    found,
                    "only values that can stand here",
                ));
            }
        }
    }
}
