//! [`World`]: the reset JSON, which describes one fully concrete world.

mod agent;
mod camera;
mod check;
mod draft;
mod environment;
mod features;
pub(crate) mod fields;
mod hash;
mod lock_remarks;
mod looks;
mod object;
mod progress;
mod region;
mod remarks;
mod rules;
mod stimulus;
mod table;
mod thing_remarks;
mod things;
mod zone;

use std::ops::Deref;
use std::sync::{Arc, LazyLock};

use schemars::JsonSchema;
use serde::Serialize;

pub use agent::{ActionModel, ActionSpace, AgentParams, Energy};
pub use camera::Modality;
pub use draft::{GameMode, ImageParams, WorldDraft};
pub use environment::{Enclosure, EnvironmentParams, Wall};
pub use features::StateFeature;
pub use fields::{Compared, Comparison, Field, FieldPlace};
pub(crate) use fields::{Fields, Place, Setter, places_of};
pub use looks::{Covering, Looks, Style, Surface};
pub use object::{Model, MotionModel, Object, Pushable, Respawn};
pub use progress::{LastEvent, ObjectProgress, Origin, Progress, RailsProgress};
pub use region::Region;
pub use rules::{Delivery, EndCondition, Rules, Shaping};
pub use stimulus::{Stimulus, Trigger};
pub use table::LeafTexts;
pub use things::{Door, Portable, Switch, SwitchAction};
pub use zone::{Disc, Zone, ZoneEnd};

use crate::classes::Classes;
use crate::document::Document;
use crate::error::{Problem, SpecError};
use crate::layout::Plan;
use crate::limits::MAX_WORLD_VALUES;
use crate::schema::document::DocumentSchema;
use crate::version;

/// Maximum number of samples in one image: 4096 × 4096 pixels with 2 × 2 samples each.
pub const MAX_POINTS: u64 = 1 << 26;

/// One fully concrete world, as passed to a reset.
///
/// A superset of L2Explorer's reset payload. Reading is strict: [`World::from_json`] reports all unknown keys, wrong types and
/// values out of range at once, each with its line and column.
///
/// # Example
/// ```
/// use driftworld_spec::World;
/// let world = World::from_json("inline", r#"{ "max_steps": 50, "objects": [{ "class": "tree", "coordinates": [3, 4] }] }"#)?;
/// assert_eq!(world.objects[0].coordinates, [3.0, 4.0]);
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct World {
    draft: WorldDraft,
    /// The plan of its layout.
    #[serde(skip)]
    plan: Option<Arc<Plan>>,
}

/// The plan is not compared: equal fields have equal plans.
impl PartialEq for World {
    fn eq(&self, other: &Self) -> bool {
        self.draft == other.draft
    }
}

/// Gives read access to the fields of the [`WorldDraft`]; they can be changed only through a draft, so that every world is
/// checked.
impl Deref for World {
    type Target = WorldDraft;

    fn deref(&self) -> &WorldDraft {
        &self.draft
    }
}

impl World {
    /// The schema of a world.
    pub fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<World>("world", "Driftworld world"));
        &SCHEMA
    }

    /// Reads a world strictly. `name` is the document's name in messages, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with all problems of the text, sorted by position.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        Self::from_json_with(name, text, None)
    }

    /// Like [`World::from_json`]; if classes are given, also rejects objects with other classes or models.
    ///
    /// # Errors
    /// As [`World::from_json`].
    pub fn from_json_with(name: &str, text: &str, classes: Option<&Classes>) -> Result<Self, SpecError> {
        let mut document = Document::parse(name, text, MAX_WORLD_VALUES)?;
        document.upgrade(&version::WORLD)?;
        document.fail_on(World::schema().problems(&document.value))?;
        let draft: WorldDraft = document.deserialize()?;
        let mut problems = draft.problems();
        problems.extend(classes.into_iter().flat_map(|classes| draft.unknown_classes(classes)));
        document.fail_on(problems)?;
        Ok(Self::planned(draft))
    }

    /// The world as one line of JSON: the same world gives the same bytes on every platform.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a world has string keys and finite numbers only, which always serialise")
    }

    /// The world as indented JSON with a final newline.
    pub fn to_json_pretty(&self) -> String {
        let mut text = serde_json::to_string_pretty(self)
            .expect("a world has string keys and finite numbers only, which always serialise");
        text.push('\n');
        text
    }

    /// The plan of its layout: walls, free cells, doorways. `None` for a world without a layout.
    pub fn plan(&self) -> Option<&Plan> {
        self.plan.as_deref()
    }

    /// The ground that cannot be entered: the regions of the map, the walls, and the walls of the layout, each as a polygon in
    /// metres, in this order.
    pub fn obstacles(&self) -> impl Iterator<Item = &[[f64; 2]]> {
        let environment = &self.environment_params;
        let walls = environment.walls.iter().map(|wall| wall.polygon.as_slice());
        let planned = self.plan().into_iter().flat_map(|plan| &plan.walls);
        let regions = environment.regions().into_iter();
        regions.chain(walls).chain(planned.map(|wall| wall.polygon.as_slice()))
    }

    /// The wall or region that contains a point in metres, as [`EnvironmentParams::enclosure`].
    pub fn enclosure(&self, point: [f64; 2]) -> Option<Enclosure> {
        self.environment_params.enclosure(point, self.plan())
    }
}

impl WorldDraft {
    /// The problems of all objects with an unknown class or model.
    pub fn unknown_classes(&self, classes: &Classes) -> Vec<Problem> {
        let objects = self.objects.iter().enumerate();
        objects
            .flat_map(|(index, object)| classes.problems(&format!("/objects/{index}"), object))
            .collect()
    }
}
