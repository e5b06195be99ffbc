//! [`TaskSpec`]: typed parameters, a world template that refers to them, and named variants. Drawing worlds is the generator's job.

mod check;
mod distribution;
mod group;
mod parameter;
mod slots;
mod template;
mod value;
mod variant;

use std::sync::Arc;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

pub use distribution::{Distribution, Number, ParamRef};
pub use group::Group;
pub use parameter::{Domain, Element, Parameter, Role};
pub use template::{Hole, Source, Template};
pub use value::{ParameterType, Value};
pub use variant::{DEFAULT_VARIANT, Variant, VariantSpec};

use crate::document::Document;
use crate::error::SpecError;
use crate::schema;
use crate::world::{Object, World};

/// The variants that a document declares, by name.
pub(crate) type VariantDocument = IndexMap<String, VariantSpec>;

/// A task spec as its document has it, before anything but the schema has been checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TaskDocument {
    /// Where the JSON Schema of this document is, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub(crate) schema: Option<String>,
    /// The task's name: lower-case letters, digits and underscores.
    #[schemars(length(max = 100), regex(pattern = "^[a-z][a-z0-9_]*$"))]
    pub(crate) name: String,
    /// What the task is, in a sentence or two.
    #[serde(default)]
    pub(crate) description: String,
    /// The parameters by name.
    #[serde(default)]
    #[schemars(schema_with = "parameters_schema")]
    pub(crate) parameters: IndexMap<String, Parameter>,
    /// The world, but for its groups. Any leaf may be a value, a parameter, or a distribution.
    #[serde(default)]
    #[schemars(schema_with = "template::world_schema")]
    pub(crate) world: Json,
    /// Groups of objects, placed one after the other.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub(crate) groups: Vec<Group>,
    /// Named variants: each sets some of the variant parameters, over another variant's values or the defaults.
    #[serde(default)]
    pub(crate) variants: VariantDocument,
}

fn parameters_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
    let mut schema = generator.subschema_for::<IndexMap<String, Parameter>>();
    schema.insert(
        "propertyNames".to_owned(),
        serde_json::json!({ "pattern": "^[a-z][a-z0-9_]*$", "maxLength": 100 }),
    );
    schema
}

/// A task: what its worlds have in common, and exactly what varies between them.
///
/// Loading checks everything that can be checked before a world is drawn: types, domains, references, distributions of
/// every variant, the chain of every `extends`.
///
/// # Example
/// ```
/// use driftworld_spec::TaskSpec;
/// let text = r#"{
///   "name": "light_and_dark",
///   "parameters": { "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 } },
///   "world": { "max_steps": 100, "environment_params": { "light_intensity": { "param": "light" } } },
///   "variants": { "day": {}, "dusk": { "light": 0.3 } }
/// }"#;
/// let task = TaskSpec::from_json("inline", text)?;
/// assert_eq!(task.variant("dusk")?.value("light").and_then(|light| light.as_number()), Some(0.3));
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
#[derive(Debug)]
pub struct TaskSpec {
    document: TaskDocument,
    world: Template<World>,
    fixtures: Vec<Template<Object>>,
    groups: Vec<PlacedGroup>,
}

/// A group of a checked task: its declaration, and its count and object as templates.
#[derive(Debug)]
pub struct PlacedGroup {
    /// The group as declared.
    pub spec: Group,
    /// How many objects.
    pub count: Count,
    /// What each object is.
    pub object: Template<Object>,
}

/// How many objects a group has.
#[derive(Clone, Debug, PartialEq)]
pub enum Count {
    /// As many.
    Fixed(u32),
    /// As many as a parameter or a draw says.
    Drawn(Source),
}

impl TaskSpec {
    /// Reads and checks a task spec. `name` is what messages call the document, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with every problem of the text at once, sorted by place.
    pub fn from_json(name: &str, text: &str) -> Result<Arc<Self>, SpecError> {
        let document = Document::parse(name, text)?;
        document.check_schema(schema::task())?;
        let spec: TaskDocument = document.deserialize()?;
        match check::compile(spec) {
            Ok(task) => Ok(Arc::new(task)),
            Err(problems) => {
                document.fail_on(problems)?;
                unreachable!("a task that does not compile has problems")
            }
        }
    }

    /// The task's name.
    pub fn name(&self) -> &str {
        &self.document.name
    }

    /// What the task is.
    pub fn description(&self) -> &str {
        &self.document.description
    }

    /// The parameters in the order of the document.
    pub fn parameters(&self) -> &IndexMap<String, Parameter> {
        &self.document.parameters
    }

    /// The world's template; its objects are [`TaskSpec::fixtures`].
    pub fn world(&self) -> &Template<World> {
        &self.world
    }

    /// The templates of objects that stand at places of their own.
    pub fn fixtures(&self) -> &[Template<Object>] {
        &self.fixtures
    }

    /// The groups in the order in which they are placed.
    pub fn groups(&self) -> &[PlacedGroup] {
        &self.groups
    }

    /// The names of the declared variants in the order of the document; [`DEFAULT_VARIANT`] alone if there are none.
    pub fn variant_names(&self) -> Vec<&str> {
        let declared: Vec<&str> = self.document.variants.keys().map(String::as_str).collect();
        if declared.is_empty() {
            vec![DEFAULT_VARIANT]
        } else {
            declared
        }
    }

    /// What a variant's author says of it.
    pub fn variant_description(&self, name: &str) -> Option<&str> {
        self.document.variants.get(name)?.description.as_deref()
    }

    /// The variant of this name. [`DEFAULT_VARIANT`], with every parameter at its default, is always there.
    ///
    /// # Errors
    /// [`SpecError::UnknownVariant`] with the names there are.
    pub fn variant(self: &Arc<Self>, name: &str) -> Result<Variant, SpecError> {
        if !self.document.variants.contains_key(name) && name != DEFAULT_VARIANT {
            return Err(SpecError::UnknownVariant {
                task: self.name().to_owned(),
                found: name.to_owned(),
                known: self.variant_names().into_iter().map(str::to_owned).collect(),
            });
        }
        let values = variant::values_of(&self.document.parameters, &self.document.variants, name)
            .expect("loading the task checked every chain of extends");
        Ok(Variant::new(Arc::clone(self), name, values))
    }

    /// All declared variants.
    pub fn all_variants(self: &Arc<Self>) -> Vec<Variant> {
        let names = self.variant_names();
        names
            .into_iter()
            .map(|name| self.variant(name).expect("the name is one of the task's own"))
            .collect()
    }
}
