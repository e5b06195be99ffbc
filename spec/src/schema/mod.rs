//! The JSON Schemas of the documents, generated from the Rust types, and explanations of their errors.

mod advice;
mod color;
pub(crate) mod document;
mod explain;
mod forms;
pub(crate) mod part;
pub(crate) mod wording;

pub use document::DocumentSchema;

use crate::maps::MapsDocument;
use crate::scenario::Scenario;
use crate::task::TaskDocument;
use crate::world::World;

/// The schemas of all document types, each with its file name.
pub fn all() -> [(&'static str, &'static DocumentSchema); 4] {
    [
        ("world.schema.json", World::schema()),
        ("task.schema.json", TaskDocument::schema()),
        ("scenario.schema.json", Scenario::schema()),
        ("maps.schema.json", MapsDocument::schema()),
    ]
}
