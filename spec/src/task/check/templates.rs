//! Checks templates of worlds and objects: each hole is allowed to vary, and accepts every value that it may receive.

use indexmap::IndexMap;
use serde_json::Value as Json;

use super::super::scope::Scope;
use super::super::template::{Hole, Source, Template, hole, openings};
use super::Check;
use crate::distribution::Distribution;
use crate::document::typed;
use crate::error::Problem;
use crate::value::Value;
use crate::world::{Model, Object, Place, World, WorldDraft};

/// The strings among the values.
fn texts(values: &[Value]) -> Vec<String> {
    values.iter().filter_map(Value::as_text).map(str::to_owned).collect()
}

impl Check<'_> {
    /// Checks the templates of the world and of its objects.
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
        let world = self.template::<WorldDraft>("/world", &json, World::schema().json());
        if let Some(world) = &world {
            let found = world.base.problems().into_iter();
            self.problems.extend(found.map(|problem| problem.within("/world")));
        }
        (world, fixtures)
    }

    pub(super) fn object(&mut self, pointer: &str, json: &Json) -> Option<Template<Object>> {
        let template = self.template(pointer, json, &World::schema().json()["$defs"]["Object"])?;
        self.known_class(pointer, &template);
        Some(template)
    }

    /// Checks that all possible classes of an object are known, and that they have all its models.
    fn known_class(&mut self, root: &str, template: &Template<Object>) {
        let Some(classes) = self.classes else { return };
        let hole_at = |key: &str| template.holes.iter().find(|hole| hole.pointer == key);
        let texts = |hole: &Hole<Object>| texts(&self.candidates(&hole.source, hole.kind));
        let pointer = format!("{root}/class");
        let class_hole = hole_at("/class");
        let all = class_hole.map_or_else(|| vec![template.base.class.clone()], texts);
        let mut found: Vec<Problem> = all
            .iter()
            .find_map(|class| classes.problem(&pointer, class))
            .into_iter()
            .collect();
        for (key, base) in [
            ("/model", Some(&template.base.model)),
            ("/body_model", template.base.body_model.as_ref()),
        ] {
            let pointer = format!("{root}{key}");
            let unknown =
                |class: &String, model: &String| classes.model_problem(&pointer, class, &Model(model.clone()));
            let of_any = |classes: &[String], models: &[String]| {
                let mut of_class = classes
                    .iter()
                    .flat_map(|class| models.iter().map(move |model| (class, model)));
                of_class.find_map(|(class, model)| unknown(class, model))
            };
            let models = hole_at(key).map_or_else(|| Vec::from_iter(base.map(|model| model.0.clone())), texts);
            let (Some(class), Some(model)) = (class_hole, hole_at(key)) else {
                found.extend(of_any(&all, &models));
                continue;
            };
            // Variants decide which models are combined with which classes, but each model must exist in at least one class.
            let unknown_everywhere = |model: &&String| all.iter().all(|class| unknown(class, model).is_some());
            let unknown_everywhere = models
                .iter()
                .find(unknown_everywhere)
                .and_then(|model| unknown(all.first()?, model));
            found.extend(unknown_everywhere.or_else(|| {
                let mut combinations = self
                    .variants
                    .iter()
                    .map(|(_, values)| [class, model].map(|hole| self.texts_in(values, &hole.source)));
                combinations.find_map(|[classes, models]| of_any(&classes, &models))
            }));
        }
        self.problems.extend(found);
    }

    /// The strings that a source can produce in a variant with these values.
    fn texts_in(&self, values: &IndexMap<String, Value>, source: &Source) -> Vec<String> {
        let outcomes = Scope::new(self.parameters, values).outcomes(source).unwrap_or_default();
        let drawn = |(law, _): &(Distribution, f64)| law.support().unwrap_or_else(|| vec![law.example()]);
        texts(&outcomes.iter().flat_map(drawn).collect::<Vec<_>>())
    }

    /// Builds a template: checks each hole, and reads the rest with an example in each hole.
    fn template<T: Place + Clone>(&mut self, root: &str, json: &Json, schema: &'static Json) -> Option<Template<T>> {
        let before = self.problems.len();
        let mut example = json.clone();
        let mut holes = Vec::new();
        let mut is_known = true;
        for opening in openings(json) {
            let pointer = format!("{root}{}", opening.0);
            let Some(hole) = hole(&opening, schema) else {
                let found = "a parameter or distribution";
                let expected = "a plain value; this value cannot vary";
                self.report(Problem::new("spec/value", pointer, found, expected));
                continue;
            };
            if self.is_unsound(&hole.source) {
                is_known = false;
                continue;
            }
            let is_case = matches!(hole.source, Source::Case(_));
            let mut sound = !is_case || self.cases(&pointer, &hole.source);
            let mut candidates = Vec::new();
            for (place, leaf) in hole.source.leaves() {
                let pointer = format!("{pointer}{place}");
                if self.is_json(leaf, hole.kind) {
                    candidates.extend(self.json_candidates(&pointer, leaf, &hole));
                } else if self.source(&pointer, leaf, hole.kind) {
                    let own = self.candidates(leaf, hole.kind);
                    sound &= self.in_range(&pointer, &own, hole.range);
                    candidates.extend(own);
                } else {
                    sound = false;
                }
            }
            if sound
                && (!is_case || self.has_outcomes(&pointer, &hole.source))
                && let (Some(value), Some(place)) = (candidates.first(), example.pointer_mut(&opening.0))
            {
                *place = hole.to_json(value);
                holes.push((hole, candidates));
            }
        }
        if self.problems.len() > before || !is_known {
            return None;
        }
        let base: T = match typed(&example) {
            Ok(base) => base,
            Err(mut problem) => {
                // "invalid length 2, expected an array of length 3": the first half says what was found.
                let expected = problem.expected.split_once(", expected ");
                let expected = expected.map(|(_, expected)| expected.to_owned());
                problem.expected = expected.unwrap_or(problem.expected);
                self.report(problem.within(root));
                return None;
            }
        };
        self.fillable(root, &base, &holes);
        (self.problems.len() == before).then(|| Template {
            base,
            holes: holes.into_iter().map(|(hole, _)| hole).collect(),
        })
    }

    /// Checks that each hole accepts every value that it may receive, such as strings that must name something.
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
                    "only values that are allowed here",
                ));
            }
        }
    }
}
