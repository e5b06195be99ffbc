//! Worlds and objects that were built in code, checked by the rules of documents; one object read without a world.
//! Reading worlds is in `mod.rs`.

use std::sync::LazyLock;

use serde::Serialize;

use super::{Object, World};
use crate::document::Document;
use crate::error::{Problem, SpecError};
use crate::limits::MAX_VALUES;
use crate::schema::document::DocumentSchema;

impl Object {
    /// The schema of one object, which a world may be given while it runs.
    pub(crate) fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<Object>("object", "Driftworld object"));
        &SCHEMA
    }

    /// Reads one object, strictly. `name` is what messages call the text.
    ///
    /// # Errors
    /// [`SpecError`] with every problem of the text at once, sorted by place.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        let document = Document::parse(name, text, MAX_VALUES)?;
        document.fail_on(Object::schema().problems(&document.value))?;
        document.deserialize()
    }

    /// Checks an object that was built in code by the rules that objects of a document obey.
    ///
    /// # Errors
    /// [`SpecError::Document`] under the name `object`, with every problem.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Object;
    /// let mut tree = Object::new("tree", [3.0, 4.0]);
    /// assert!(tree.check().is_ok());
    /// tree.scale = 0.0;
    /// let error = tree.check().expect_err("nothing is of no size");
    /// assert_eq!(error.problems()[0].pointer, "/scale");
    /// ```
    pub fn check(&self) -> Result<(), SpecError> {
        check("object", self, Self::schema(), Vec::new())
    }
}

impl World {
    /// Checks a world that was built or changed in code by the rules that documents obey.
    ///
    /// # Errors
    /// [`SpecError::Document`] under the name `world`, with every problem.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let mut world = World::default();
    /// world.environment_params.sun_direction = [0.0; 3];
    /// let error = world.check().expect_err("the sun shines from somewhere");
    /// assert_eq!(error.problems()[0].pointer, "/environment_params/sun_direction");
    /// ```
    pub fn check(&self) -> Result<(), SpecError> {
        check("world", self, Self::schema(), self.problems())
    }

    /// The world after a change, if it obeys the rules of documents then.
    ///
    /// # Errors
    /// As [`World::check`].
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let world = World::default();
    /// assert!(world.clone().edit(|world| world.max_steps = 50).is_ok());
    /// assert!(world.edit(|world| world.agent_params.time_step = 0.0).is_err());
    /// ```
    pub fn edit(mut self, change: impl FnOnce(&mut Self)) -> Result<Self, SpecError> {
        change(&mut self);
        self.check().map(|()| self)
    }
}

/// Checks a value by its schema; `more` is what is wrong with it besides.
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
        let said = object.check().expect_err("the object is not sound").to_string();
        assert!(said.contains(expected), "{said}");
    }

    #[test]
    fn an_object_is_read_alone_as_in_a_world() {
        let tree = Object::from_json("spawn", r#"{ "class": "tree", "coordinates": [3, 4], "color": "red" }"#)
            .expect("the object is sound");
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
    fn an_object_built_in_code_obeys_the_rules_of_documents() {
        check(|object| object.coordinates[0] = 301.0, "(/coordinates/0): found 301");
        check(|object| object.class.clear(), "(/class): found \"\"");
        check(|object| object.reward = f64::NAN, "(/reward): found null");
        Object::new("dragon", [0.0, 0.0])
            .check()
            .expect("a class that is not known is a placeholder");
    }
}
