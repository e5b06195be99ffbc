//! The table of fields of a whole world: its places, and the texts of what of it is compared leaf by leaf. The rows stand
//! beside the fields.

use std::sync::LazyLock;

use super::fields::{Compared, Comparison, FieldPlace, Fields, places_of};
use super::{Object, World, WorldDraft};

impl World {
    /// Every place of a world, in the order of the table; those of its objects once.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{ParameterType, World};
    /// let heading = World::places().iter().find(|place| place.pointer == "/objects/*/heading").expect("objects have one");
    /// assert_eq!((heading.kind, heading.field.unit), (Some(ParameterType::Heading), Some("degrees")));
    /// ```
    pub fn places() -> &'static [FieldPlace] {
        static PLACES: LazyLock<Vec<FieldPlace>> = LazyLock::new(places_of::<WorldDraft>);
        &PLACES
    }
}

/// The fields of a world or an object that are compared leaf by leaf: for each comparison a text that has, field by field
/// in the order of the table, a line of JSON. Equal fields have equal texts.
#[derive(Debug, Default)]
pub struct LeafTexts([Vec<u8>; Comparison::ALL.len()]);

impl LeafTexts {
    /// The texts of a world, but for its objects, in place of those before.
    pub fn read_world(&mut self, world: &World) {
        self.0.iter_mut().for_each(Vec::clear);
        self.add::<WorldDraft>(world);
        self.add(&world.environment_params);
        self.add(&world.agent_params);
        self.add(&world.rules);
    }

    /// The texts of an object in place of those before.
    pub fn read_object(&mut self, object: &Object) {
        self.0.iter_mut().for_each(Vec::clear);
        self.add(object);
    }

    fn add<T: Fields>(&mut self, part: &T) {
        for row in T::ROWS {
            if let Compared::Leaves(comparison) = row.field.compared {
                let text = &mut self.0[comparison as usize];
                (row.write)(part, text);
                text.push(b'\n');
            }
        }
    }

    /// The text of a comparison.
    pub fn of(&self, comparison: Comparison) -> &[u8] {
        &self.0[comparison as usize]
    }
}
