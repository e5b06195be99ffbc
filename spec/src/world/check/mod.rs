//! Turns a [`WorldDraft`] into a [`World`] by checking its values against the rules for documents. Also reads and
//! checks single objects.

mod progress;
mod zones;

use std::sync::{Arc, LazyLock};

use serde::Serialize;

use super::{ActionModel, ActionSpace, MAX_POINTS, Object, World, WorldDraft};
use crate::document::Document;
use crate::error::{Problem, SpecError};
use crate::layout::{self, Plan};
use crate::limits::{MAX_OBJECTS, MAX_VALUES};
use crate::maps::MapLibrary;
use crate::schema::document::DocumentSchema;

impl Object {
    /// The schema of one object, which can be added to a running world.
    pub(crate) fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<Object>("object", "Driftworld object"));
        &SCHEMA
    }

    /// Reads one object strictly. `name` is the text's name in messages.
    ///
    /// # Errors
    /// [`SpecError`] with all problems of the text, sorted by position.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        let document = Document::parse(name, text, MAX_VALUES)?;
        document.fail_on(Object::schema().problems(&document.value))?;
        document.deserialize()
    }

    /// Checks an object built in code against the rules for objects in documents.
    ///
    /// # Errors
    /// [`SpecError::Document`] under the name `object`, with all problems.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Object;
    /// let mut tree = Object::new("tree", [3.0, 4.0]);
    /// assert!(tree.check().is_ok());
    /// tree.scale = 0.0;
    /// let error = tree.check().expect_err("a scale of 0 is invalid");
    /// assert_eq!(error.problems()[0].pointer, "/scale");
    /// ```
    pub fn check(&self) -> Result<(), SpecError> {
        check("object", self, Self::schema(), Vec::new())
    }
}

impl WorldDraft {
    /// The world with these fields, if they follow the rules for documents.
    ///
    /// # Errors
    /// [`SpecError::Document`] under the name `world`, with all problems.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::WorldDraft;
    /// let mut draft = WorldDraft::default();
    /// draft.environment_params.sun_direction = [0.0; 3];
    /// let error = draft.check().expect_err("the sun needs a direction");
    /// assert_eq!(error.problems()[0].pointer, "/environment_params/sun_direction");
    /// ```
    pub fn check(self) -> Result<World, SpecError> {
        check("world", &self, World::schema(), self.problems())?;
        Ok(World::planned(self))
    }

    /// Like [`WorldDraft::check`], for fields that are all known to be in range: checks only the rules across fields.
    ///
    /// # Errors
    /// As [`WorldDraft::check`].
    ///
    /// # Panics
    /// With debug assertions, if a value is out of range.
    pub fn check_in_range(self) -> Result<World, SpecError> {
        let plan = self.valid_plan();
        self.check_in_range_with(plan)
    }

    /// The plan of its layout, if there is a valid one.
    pub(super) fn valid_plan(&self) -> Option<Arc<Plan>> {
        self.layout_problems().is_empty().then(|| self.plan()).flatten()
    }

    /// Like [`WorldDraft::check_in_range`], with the plan of the layout that [`WorldDraft::plan`] has already computed.
    ///
    /// # Errors
    /// As [`WorldDraft::check`].
    ///
    /// # Panics
    /// With debug assertions, if a value is out of range, or the plan differs.
    pub fn check_in_range_with(self, plan: Option<Arc<Plan>>) -> Result<World, SpecError> {
        let problems = self.problems();
        if !problems.is_empty() {
            return Err(SpecError::of_document("world", problems));
        }
        if cfg!(debug_assertions) {
            check("world", &self, World::schema(), problems).expect("the caller checked the ranges of all values");
            assert_eq!(plan, self.plan(), "the caller passes the plan of the layout");
        }
        Ok(World { draft: self, plan })
    }

    /// The plan of the layout, computed with the layout's own seed or, if it has none, with the world's; `None` without a
    /// layout.
    ///
    /// The layout must be valid, see [`WorldDraft::layout_problems`].
    pub fn plan(&self) -> Option<Arc<Plan>> {
        let environment = &self.environment_params;
        let (layout, seed) = (environment.layout.as_ref()?, self.seed.unwrap_or(0));
        Some(Arc::new(match &environment.map_regions {
            Some(regions) if layout.predefined.is_some() => layout.plan_with(seed, regions),
            _ => layout.plan(seed),
        }))
    }

    /// The problems of the layout, except values out of range.
    pub fn layout_problems(&self) -> Vec<Problem> {
        let environment = &self.environment_params;
        let Some(layout) = &environment.layout else {
            return Vec::new();
        };
        let mut problems = layout.problems();
        if environment.predefined_map != 0 {
            let found = format!("a layout and map {}", environment.predefined_map);
            let problem = Problem::new("spec/layout-kind", layout::POINTER, found, "one of the two");
            problems.push(problem.advise("remove \"predefined_map\", or the layout"));
        }
        problems
    }

    /// Checks beyond the schema: rules across several values.
    pub(crate) fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.environment_params.sun_direction == [0.0; 3] {
            let pointer = "/environment_params/sun_direction";
            let expected = "a direction, such as [0.4, -0.3, 0.8]";
            problems.push(Problem::new("spec/zero-direction", pointer, "[0, 0, 0]", expected));
        }
        if self.environment_params.arena_size().contains(&0.0) {
            let pointer = "/environment_params/map_size";
            let problem = Problem::new("spec/empty-arena", pointer, "a side of 0 m", "sides above 0 m");
            problems.push(problem.advise("or choose a predefined_map from 1 to 4"));
        }
        let agent = &self.agent_params;
        let [width, height] = agent.picture_size();
        let points = u64::from(width) * u64::from(height) * u64::from(agent.supersampling).pow(2);
        if points > MAX_POINTS {
            let found = format!("{points} points for {width} × {height} pixels");
            let expected = format!("at most {MAX_POINTS} points");
            let problem = Problem::new("spec/too-many-points", "/agent_params/supersampling", found, expected);
            problems.push(problem.advise("use smaller observations or less supersampling"));
        }
        if (agent.action_model, &agent.actions) == (ActionModel::ByWaypoint, &ActionSpace::DefaultDiscrete) {
            let pointer = "/agent_params/actions";
            let found = "default_discrete under bywaypoint, whose actions are positions";
            let expected = "a table, such as {\"discrete\": [[3, 4, 0], [-3, 4, 0]]}";
            problems.push(Problem::new("spec/no-default-actions", pointer, found, expected));
        }
        if let Some(energy) = agent.energy.filter(|energy| energy.start > energy.most) {
            let (pointer, found) = ("/agent_params/energy/start", energy.start.to_string());
            let expected = format!("at most {}, the agent's maximum energy", energy.most);
            problems.push(Problem::new("spec/energy", pointer, found, expected));
        }
        problems.extend(zones::problems(self));
        problems.extend(self.layout_problems());
        problems.extend(progress::problems(self));
        problems.extend(duplicate_names(&self.objects));
        problems
    }
}

impl World {
    /// The world with these valid fields.
    pub(super) fn planned(draft: WorldDraft) -> Self {
        let plan = draft.plan();
        Self { draft, plan }
    }

    /// Its fields, for editing.
    pub fn into_draft(self) -> WorldDraft {
        self.draft
    }

    /// The world after a change, if it still follows the rules for documents.
    ///
    /// # Errors
    /// As [`WorldDraft::check`].
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let world = World::default();
    /// assert!(world.clone().edit(|world| world.max_steps = 50).is_ok());
    /// assert!(world.edit(|world| world.agent_params.time_step = 0.0).is_err());
    /// ```
    pub fn edit(self, change: impl FnOnce(&mut WorldDraft)) -> Result<Self, SpecError> {
        let mut draft = self.into_draft();
        change(&mut draft);
        draft.check()
    }

    /// Writes the layout of the world's predefined map from a library into the world, if the library has one; the world then
    /// needs no library.
    #[must_use]
    pub fn with_maps(mut self, maps: &MapLibrary) -> Self {
        // A library's layouts follow the same rules as a world's own regions, and no other rule depends on them.
        maps.apply(&mut self.draft);
        self.plan = self.draft.plan();
        self
    }

    /// Adds an object after the others, if the world allows it.
    ///
    /// # Errors
    /// [`SpecError::Document`] under the name `object`, with all problems of the object; also if its `unique_name` is taken or
    /// the world already holds [`MAX_OBJECTS`]. The world is then unchanged.
    pub fn push(&mut self, object: Object) -> Result<(), SpecError> {
        let mut more = Vec::new();
        if self.objects.len() >= MAX_OBJECTS {
            let expected = format!("a world of at most {MAX_OBJECTS}");
            more.push(Problem::new("spec/value", "", "one more object", expected));
        }
        if let Some(name) = &object.unique_name
            && let Some(first) = self
                .objects
                .iter()
                .position(|other| other.unique_name.as_ref() == Some(name))
        {
            more.push(name_taken("/unique_name".to_owned(), name, first));
        }
        check("object", &object, Object::schema(), more)?;
        self.draft.objects.push(object);
        Ok(())
    }
}

fn duplicate_names(objects: &[Object]) -> impl Iterator<Item = Problem> {
    let mut seen = std::collections::BTreeMap::new();
    objects.iter().enumerate().filter_map(move |(index, object)| {
        let name = object.unique_name.as_ref()?;
        let first = *seen.entry(name).or_insert(index);
        (first != index).then(|| name_taken(format!("/objects/{index}/unique_name"), name, first))
    })
}

fn name_taken(pointer: String, name: &str, first: usize) -> Problem {
    let found = format!("{name:?}, which object {first} has too");
    Problem::new("spec/duplicate-name", pointer, found, "a name of its own")
}

/// Checks a value against its schema; `more` are its other problems.
fn check(name: &str, value: &impl Serialize, schema: &DocumentSchema, more: Vec<Problem>) -> Result<(), SpecError> {
    let value = serde_json::to_value(value).expect("parts of a world have string keys only, which always serialise");
    let mut found = schema.problems(&value);
    found.problems.extend(more);
    if found.problems.is_empty() {
        Ok(())
    } else {
        Err(SpecError::of_document(name, found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(change: impl FnOnce(&mut Object), expected: &str) {
        let mut object = Object::new("tree", [3.0, 4.0]);
        change(&mut object);
        let error = object.check().expect_err("the object is invalid").to_string();
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn single_object_is_read_like_one_in_a_world() {
        let tree = Object::from_json("spawn", r#"{ "class": "tree", "coordinates": [3, 4], "color": "red" }"#)
            .expect("the object is valid");
        assert_eq!(
            (tree.coordinates, tree.color),
            ([3.0, 4.0], crate::Color::from_name("red"))
        );
        let error = Object::from_json(
            "spawn",
            r#"{ "class": "tree", "coordinates": [3, 4], "colour": "red" }"#,
        )
        .expect_err("the key is not known")
        .to_string();
        assert!(
            error.contains("(/colour)") && error.contains("did you mean \"color\"?"),
            "{error}"
        );
        assert!(Object::from_json("spawn", "3").is_err());
    }

    #[test]
    fn object_built_in_code_follows_the_rules_of_documents() {
        check(|object| object.coordinates[0] = 301.0, "(/coordinates/0): found 301");
        check(|object| object.class.clear(), "(/class): found \"\"");
        check(|object| object.reward = f64::NAN, "(/reward): found null");
        Object::new("dragon", [0.0, 0.0])
            .check()
            .expect("unknown classes are allowed, and shown by a placeholder");
    }
}
