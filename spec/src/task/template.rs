//! Templates: a world or an object with holes that parameters and distributions fill. Filling them is the generator's job.

use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};

use super::slots::{self, Slot};
use super::value::{ParameterType, Value};
use crate::distribution::{Distribution, Number, ParamRef};
use crate::schema;
use crate::world::{Object, World};

/// Where a value comes from: a parameter, or a draw.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a distribution, or {\"param\": NAME}")]
pub enum Source {
    /// The value of a parameter of any role, or a draw from one of type distribution.
    Param(ParamRef),
    /// A draw of its own.
    Distribution(Box<Distribution<Number>>),
}

impl Source {
    /// Reads `{ "param": … }` or a distribution; `None` if the JSON is neither.
    pub(crate) fn read(json: &Json) -> Option<Self> {
        let map = json.as_object()?;
        if map.contains_key("param") {
            return serde_json::from_value(json.clone()).ok().map(Self::Param);
        }
        if map.len() != 1 {
            return None;
        }
        serde_json::from_value(json.clone()).ok().map(Self::Distribution)
    }
}

/// A place to be filled, and with what.
pub struct Hole<T: 'static> {
    /// JSON pointer from the template.
    pub pointer: String,
    /// What fills it.
    pub source: Source,
    /// The type of value that goes there.
    pub kind: ParameterType,
    /// The numbers that may stand there, both ends included.
    pub range: [f64; 2],
    index: usize,
    slot: &'static Slot<T>,
}

impl<T> Clone for Hole<T> {
    fn clone(&self) -> Self {
        Self {
            pointer: self.pointer.clone(),
            source: self.source.clone(),
            ..*self
        }
    }
}

impl<T> std::fmt::Debug for Hole<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "Hole({} ← {:?})", self.pointer, self.source)
    }
}

impl<T> Hole<T> {
    /// Puts a value there. `None` if a value of its type cannot stand there, as a text that names nothing.
    pub fn fill(&self, target: &mut T, value: &Value) -> Option<()> {
        (self.slot.set)(target, self.index, value)
    }
}

/// A `T` with holes.
#[derive(Clone, Debug)]
pub struct Template<T: 'static> {
    /// The `T` with an example in each hole.
    pub base: T,
    /// The holes, in the order of the text.
    pub holes: Vec<Hole<T>>,
}

/// A hole before it is known to fit: its pointer and what it holds.
pub(crate) type Opening = (String, Source);

/// Every `{ "param": … }` and inline distribution in a template, in the order of the text.
pub(crate) fn openings(template: &Json) -> Vec<Opening> {
    let mut found = Vec::new();
    walk(template, &mut String::new(), &mut found);
    found
}

fn walk(json: &Json, pointer: &mut String, found: &mut Vec<Opening>) {
    if let Some(source) = Source::read(json) {
        found.push((pointer.clone(), source));
        return;
    }
    let length = pointer.len();
    let mut visit = |key: &str, child: &Json| {
        pointer.push('/');
        pointer.push_str(&crate::document::escape(key));
        walk(child, pointer, found);
        pointer.truncate(length);
    };
    match json {
        Json::Object(map) => map.iter().for_each(|(key, child)| visit(key, child)),
        Json::Array(list) => list
            .iter()
            .enumerate()
            .for_each(|(index, child)| visit(&index.to_string(), child)),
        _ => {}
    }
}

impl Template<World> {
    /// The hole of a world's template at a pointer, if a world can vary there.
    pub(crate) fn hole((pointer, source): &Opening) -> Option<Hole<World>> {
        let (slot, index) = Slot::find(slots::WORLD, pointer)?;
        Some(Hole {
            pointer: pointer.clone(),
            source: source.clone(),
            kind: slot.kind,
            range: range_of(schema::world().json(), None, slot.pointer),
            index,
            slot,
        })
    }
}

impl Template<Object> {
    /// The hole of an object's template at a pointer, if an object can vary there.
    pub(crate) fn hole((pointer, source): &Opening) -> Option<Hole<Object>> {
        let (slot, index) = Slot::find(slots::OBJECT, pointer)?;
        Some(Hole {
            pointer: pointer.clone(),
            source: source.clone(),
            kind: slot.kind,
            range: range_of(schema::world().json(), Some("Object"), slot.pointer),
            index,
            slot,
        })
    }
}

/// The least and greatest number that a schema allows at a pointer.
fn range_of(schema: &Json, definition: Option<&str>, pointer: &str) -> [f64; 2] {
    let root = definition.map_or(schema, |name| &schema["$defs"][name]);
    let leaf = pointer.split('/').skip(1).fold(root, |node, key| {
        let node = resolve(schema, node);
        if key == "*" {
            &node["items"]
        } else {
            &node["properties"][key]
        }
    });
    let leaf = resolve(schema, leaf);
    let end = |key: &str, otherwise| leaf[key].as_f64().unwrap_or(otherwise);
    let items = |key: &str, otherwise| leaf["items"][key].as_f64().unwrap_or(otherwise);
    if leaf.get("items").is_some() {
        [items("minimum", f64::MIN), items("maximum", f64::MAX)]
    } else {
        [end("minimum", f64::MIN), end("maximum", f64::MAX)]
    }
}

fn resolve<'a>(schema: &'a Json, node: &'a Json) -> &'a Json {
    match node.get("$ref").and_then(Json::as_str) {
        Some(reference) => schema.pointer(reference.trim_start_matches('#')).unwrap_or(node),
        None => node,
    }
}

/// The schemas of the two kinds of template, made from those of the concrete documents: at each slot the value may also
/// be a parameter or a distribution.
struct TemplateSchemas {
    world: Json,
    object: Json,
    definitions: serde_json::Map<String, Json>,
}

static SCHEMAS: LazyLock<TemplateSchemas> = LazyLock::new(|| {
    let world_schema = schema::of_type::<World>("world-template", "World template");
    let mut object = inline(&world_schema, &world_schema["$defs"]["Object"]);
    open(
        &mut object,
        &slots::OBJECT.iter().map(|slot| slot.pointer).collect::<Vec<_>>(),
    );
    let mut world = inline(
        &world_schema,
        &json!({ "type": "object", "properties": world_schema["properties"] }),
    );
    open(
        &mut world,
        &slots::WORLD.iter().map(|slot| slot.pointer).collect::<Vec<_>>(),
    );
    world["additionalProperties"] = json!(false);
    world["properties"]["objects"]["items"] = object.clone();
    world["description"] =
        json!("The world, but for its groups. Any leaf may be a value, a parameter, or a distribution.");
    if let Some(properties) = world["properties"].as_object_mut() {
        for key in ["$schema", "version", "seed", "progress"] {
            properties.shift_remove(key);
        }
    }
    let definitions = world_schema["$defs"].as_object().cloned().unwrap_or_default();
    TemplateSchemas {
        world,
        object,
        definitions,
    }
});

/// A copy of a schema in which references to objects are replaced by what they refer to, so that it can be changed.
fn inline(schema: &Json, node: &Json) -> Json {
    let target = resolve(schema, node);
    let mut copy = if target.get("properties").is_some() {
        let mut copy = target.clone();
        if let Some(description) = node.get("description") {
            copy["description"] = description.clone();
        }
        copy
    } else {
        node.clone()
    };
    // An example of the whole says nothing of a template, and would be repeated at every place.
    if let Some(map) = copy.as_object_mut() {
        map.shift_remove("examples");
    }
    if let Some(properties) = copy.get_mut("properties").and_then(Json::as_object_mut) {
        for property in properties.values_mut() {
            *property = inline(schema, &strip_default(property));
        }
    }
    if let Some(forms) = copy.get_mut("anyOf").and_then(Json::as_array_mut) {
        for form in forms {
            *form = inline(schema, form);
        }
    }
    copy
}

/// A default that spells out a whole struct says nothing beside the defaults of its fields.
fn strip_default(property: &Json) -> Json {
    let mut property = property.clone();
    if property.get("default").is_some_and(Json::is_object)
        && let Some(map) = property.as_object_mut()
    {
        map.remove("default");
    }
    property
}

/// Lets each of the pointers' places also be a parameter or a distribution.
fn open(schema: &mut Json, pointers: &[&str]) {
    // Places inside a list first, so that the list is opened around its opened items.
    let (inner, outer): (Vec<&str>, Vec<&str>) = pointers.iter().partition(|pointer| pointer.ends_with("/*"));
    for pointer in inner.into_iter().chain(outer) {
        let mut node = &mut *schema;
        for key in pointer.split('/').skip(1) {
            // An optional struct is `anyOf: [struct, null]`: the struct comes first.
            if node.get("anyOf").is_some() {
                node = &mut node["anyOf"][0];
            }
            node = if key == "*" {
                &mut node["items"]
            } else {
                &mut node["properties"][key]
            };
        }
        let value = node.take();
        let description = value.get("description").cloned();
        *node = json!({ "anyOf": [value, { "$ref": "#/$defs/ParamRef" }, { "$ref": "#/$defs/Distribution" }] });
        if let Some(description) = description {
            node["description"] = description;
        }
    }
}

/// Makes the definitions that templates refer to known to a generator.
fn define(generator: &mut SchemaGenerator) {
    generator.subschema_for::<ParamRef>();
    generator.subschema_for::<Distribution<Number>>();
    generator.subschema_for::<crate::Color>();
    for (name, definition) in &SCHEMAS.definitions {
        generator
            .definitions_mut()
            .entry(name.clone())
            .or_insert_with(|| definition.clone());
    }
}

/// The schema of the world in a task spec.
pub(crate) fn world_schema(generator: &mut SchemaGenerator) -> Schema {
    define(generator);
    Schema::try_from(SCHEMAS.world.clone()).expect("a schema stays one when leaves are opened")
}

/// The schema of the object in a group: where it stands is the placement's to say.
pub(crate) fn object_schema(generator: &mut SchemaGenerator) -> Schema {
    define(generator);
    let mut schema = SCHEMAS.object.clone();
    schema["required"] = json!(["class"]);
    if let Some(properties) = schema["properties"].as_object_mut() {
        properties.shift_remove("coordinates");
    }
    Schema::try_from(schema).expect("a schema stays one when leaves are opened")
}

/// The schema of a group's count.
pub(crate) fn count_schema(generator: &mut SchemaGenerator) -> Schema {
    define(generator);
    Schema::try_from(json!({
        "description": "How many objects: a whole number, a parameter, or a distribution.",
        "anyOf": [
            { "type": "integer", "minimum": 0, "maximum": crate::MAX_OBJECTS },
            { "$ref": "#/$defs/ParamRef" },
            { "$ref": "#/$defs/Distribution" }
        ]
    }))
    .expect("a literal object is a schema")
}
