//! Templates: worlds or objects with holes that parameters and distributions fill.

use std::borrow::Cow;
use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};

use super::layouts;
use crate::distribution::{Case, Distribution, Number, ParamRef, case};
use crate::error::Problem;
use crate::schema::document::{DocumentSchema, of_type};
use crate::schema::part;
use crate::value::{ParameterType, Value};
use crate::world::{FieldPlace, Object, Place, Setter, World, WorldDraft, places_of};

/// The source of a value: a parameter, a draw, or a look-up by the value of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a distribution, or {\"param\": NAME}")]
pub enum Source {
    /// The value of a parameter of any role, or a draw from a parameter of type distribution.
    Param(ParamRef),
    /// A source selected by the value of a parameter of any role.
    Case(Box<Case<Source>>),
    /// A separate draw.
    Distribution(Box<Distribution<Number>>),
    /// A literal value, as a case of a look-up.
    #[schemars(skip)]
    Value(Value),
}

impl JsonSchema for Case<Source> {
    fn schema_name() -> Cow<'static, str> {
        "Case".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let description = "The value of a parameter selects what is used here: cases are values, parameters, distributions or look-ups.";
        case::schema(generator, description, &Schema::from(true))
    }
}

impl Source {
    /// Reads `{ "param": … }`, a look-up or a distribution; `None` for any other JSON.
    pub(crate) fn read(json: &Json) -> Option<Self> {
        let map = json.as_object()?;
        if map.contains_key("case") {
            return serde_json::from_value(json.clone()).ok().map(Self::Case);
        }
        if map.contains_key("param") {
            return serde_json::from_value(json.clone()).ok().map(Self::Param);
        }
        if map.len() != 1 {
            return None;
        }
        serde_json::from_value(json.clone()).ok().map(Self::Distribution)
    }

    /// All possible results of look-ups, with pointers into the source: the source itself, or each case.
    pub(crate) fn leaves(&self) -> Vec<(String, &Self)> {
        let Self::Case(case) = self else {
            return vec![(String::new(), self)];
        };
        let inside = case.entries().flat_map(|(key, case)| {
            let leaves = case.leaves().into_iter();
            leaves.map(move |(place, leaf)| (format!("/{key}{place}"), leaf))
        });
        inside.collect()
    }

    /// Its look-ups, with pointers into the source.
    pub(crate) fn cases(&self) -> Vec<(String, &Case<Self>)> {
        let Self::Case(own) = self else { return Vec::new() };
        let inside = own.entries().flat_map(|(key, case)| {
            let cases = case.cases().into_iter();
            cases.map(move |(place, case)| (format!("/{key}{place}"), case))
        });
        std::iter::once((String::new(), &**own)).chain(inside).collect()
    }

    /// The parameters that it names, including those in look-ups and numbers.
    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.cases().iter().map(|(_, case)| case.by.param.clone()).collect();
        for (_, leaf) in self.leaves() {
            match leaf {
                Self::Param(reference) => names.push(reference.param.clone()),
                Self::Distribution(distribution) => {
                    let numbers = distribution.numbers();
                    names.extend(numbers.iter().flat_map(Number::names).map(str::to_owned));
                }
                Self::Case(_) | Self::Value(_) => {}
            }
        }
        names
    }
}

/// A hole in a template: a value to be filled in, and its source.
#[derive(Clone, Debug)]
pub struct Hole<T> {
    /// JSON pointer from the template.
    pub pointer: String,
    /// The source of its values.
    pub source: Source,
    /// The type of value expected here.
    pub kind: ParameterType,
    /// The numbers allowed here, both ends included.
    pub range: [f64; 2],
    /// The schema of the hole, without its definitions.
    schema: Option<&'static Json>,
    /// The path to it in a `T`.
    steps: Vec<usize>,
    set: Setter<T>,
}

impl<T> Hole<T> {
    /// A value as JSON in the form that the hole expects: counts are integers.
    pub(crate) fn to_json(&self, value: &Value) -> Json {
        let needs_integers = self.schema.is_some_and(|schema| schema["items"]["type"] == "integer");
        match value.as_vector().filter(|_| needs_integers) {
            Some(numbers) => numbers.iter().map(|number| Json::from(number.round() as i64)).collect(),
            None => value.to_json(),
        }
    }

    /// Returns a function that checks values against the schema of the hole; pointers are relative to the value.
    pub(crate) fn checker(&self) -> impl Fn(&Value) -> Vec<Problem> + use<T> {
        let schema = self.schema.map(|schema| {
            let mut own = schema.clone();
            own["$defs"] = World::schema().json()["$defs"].clone();
            DocumentSchema::new(own)
        });
        let is_layout = self.kind == ParameterType::Layout;
        move |value| {
            let Some(schema) = &schema else { return Vec::new() };
            let json = value.to_json();
            let found = schema.problems(&json).problems;
            if found.is_empty() && is_layout && !json.is_null() {
                return layouts::problems(&json);
            }
            found
        }
    }

    /// Sets the value. `None` if it is not allowed here, such as a string that names nothing.
    pub fn fill(&self, target: &mut T, value: &Value) -> Option<()> {
        (self.set)(target, &self.steps, value)
    }
}

/// A `T` with holes.
#[derive(Clone, Debug)]
pub struct Template<T> {
    /// The `T` with an example in each hole.
    pub base: T,
    /// The holes, in the order of the text.
    pub holes: Vec<Hole<T>>,
}

/// A hole before it is checked: its pointer and source.
pub(crate) type Opening = (String, Source);

/// All `{ "param": … }` and inline distributions in a template, in the order of the text.
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
        pointer.push_str(&crate::describe::escape(key));
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

/// The hole at a pointer into a `T` with this schema.
pub(crate) fn hole<T: Place>((pointer, source): &Opening, schema: &'static Json) -> Option<Hole<T>> {
    let words: Vec<&str> = pointer.split('/').skip(1).collect();
    let mut steps = Vec::new();
    let kind = T::find(&words, &mut steps)?;
    let (set, steps) = T::setter(steps);
    Some(Hole {
        pointer: pointer.clone(),
        source: source.clone(),
        kind,
        range: range_at(schema, pointer),
        schema: part::property(World::schema().json(), schema, pointer),
        steps,
        set,
    })
}

/// The smallest and largest number that the schema of a part of a world allows at a pointer into it.
fn range_at(part: &Json, pointer: &str) -> [f64; 2] {
    let Some(mut leaf) = part::at(World::schema().json(), part, pointer) else {
        return [f64::MIN, f64::MAX];
    };
    if let Some(items) = leaf.get("items") {
        leaf = items;
    }
    let end = |key: &str, otherwise| leaf[key].as_f64().unwrap_or(otherwise);
    [end("minimum", f64::MIN), end("maximum", f64::MAX)]
}

/// The schemas of the two kinds of template, derived from the schemas of the concrete documents: each place that can vary also
/// accepts a parameter or a distribution.
struct TemplateSchemas {
    world: Json,
    object: Json,
    definitions: serde_json::Map<String, Json>,
}

static SCHEMAS: LazyLock<TemplateSchemas> = LazyLock::new(|| {
    let world_schema = of_type::<World>("world-template", "World template");
    let mut object = inline(&world_schema, &world_schema["$defs"]["Object"]);
    open(&mut object, &places_of::<Object>());
    let mut world = inline(
        &world_schema,
        &json!({ "type": "object", "properties": world_schema["properties"] }),
    );
    open(&mut world, &places_of::<WorldDraft>());
    world["additionalProperties"] = json!(false);
    world["properties"]["objects"]["items"] = object.clone();
    world["description"] =
        json!("The world, except for its groups. Any leaf may be a value, a parameter, or a distribution.");
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

/// A copy of a schema with references to structured definitions replaced by the definitions, so that it can be changed.
fn inline(schema: &Json, node: &Json) -> Json {
    let target = part::resolve(schema, node);
    let is_part = |form: &Json| form.get("properties").is_some() || form["type"] == "array";
    let has_parts = is_part(target)
        || target["oneOf"]
            .as_array()
            .is_some_and(|forms| forms.iter().any(is_part));
    let mut copy = if has_parts { target.clone() } else { node.clone() };
    if let (true, Some(description)) = (has_parts, node.get("description")) {
        copy["description"] = description.clone();
    }
    // An example of the whole does not help in a template, and would be repeated everywhere.
    if let Some(map) = copy.as_object_mut() {
        map.shift_remove("examples");
    }
    if let Some(properties) = copy.get_mut("properties").and_then(Json::as_object_mut) {
        for property in properties.values_mut() {
            // The default of a whole struct repeats the defaults of its fields.
            if let Some(map) = property.as_object_mut()
                && map.get("default").is_some_and(Json::is_object)
            {
                map.remove("default");
            }
            *property = inline(schema, property);
        }
    }
    for forms in ["anyOf", "oneOf"] {
        if let Some(forms) = copy.get_mut(forms).and_then(Json::as_array_mut) {
            for form in forms {
                *form = inline(schema, form);
            }
        }
    }
    if let Some(items) = copy.get_mut("items") {
        *items = inline(schema, items);
    }
    copy
}

/// Lets each place that can vary also accept a parameter or a distribution.
fn open(schema: &mut Json, places: &[FieldPlace]) {
    let open = places.iter().filter(|place| place.kind.is_some());
    // Inner places come after outer ones, so in reverse order they are opened first.
    for place in open.rev().filter(|place| !place.pointer.starts_with("/objects/")) {
        let node = place.pointer.split('/').skip(1).fold(&mut *schema, inner);
        let value = node.take();
        let description = value.get("description").cloned();
        *node = json!({ "anyOf": [value, { "$ref": "#/$defs/ParamRef" }, { "$ref": "#/$defs/Case" }, { "$ref": "#/$defs/Distribution" }] });
        if let Some(description) = description {
            node["description"] = description;
        }
    }
}

/// The schema of a key of an object, or of the items of a list.
fn inner<'a>(node: &'a mut Json, key: &str) -> &'a mut Json {
    // An optional struct is `anyOf: [struct, null]`, with the struct first.
    let node = if node.get("anyOf").is_some() {
        &mut node["anyOf"][0]
    } else {
        node
    };
    if key == "*" {
        return &mut node["items"];
    }
    let forms = node.get("oneOf").and_then(Json::as_array);
    match forms.and_then(|forms| forms.iter().position(|form| form["properties"].get(key).is_some())) {
        Some(form) => &mut node["oneOf"][form]["properties"][key],
        None => &mut node["properties"][key],
    }
}

/// Registers the definitions that templates refer to.
fn define(generator: &mut SchemaGenerator) {
    generator.subschema_for::<ParamRef>();
    generator.subschema_for::<Case<Source>>();
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
    Schema::try_from(SCHEMAS.world.clone()).expect("opening leaves keeps a schema valid")
}

/// The schema of the object in a group; the group's placement gives its coordinates.
pub(crate) fn object_schema(generator: &mut SchemaGenerator) -> Schema {
    define(generator);
    let mut schema = SCHEMAS.object.clone();
    schema["required"] = json!(["class"]);
    if let Some(properties) = schema["properties"].as_object_mut() {
        properties.shift_remove("coordinates");
    }
    Schema::try_from(schema).expect("opening leaves keeps a schema valid")
}

/// The schema of a group's count.
pub(crate) fn count_schema(generator: &mut SchemaGenerator) -> Schema {
    define(generator);
    Schema::try_from(json!({
        "description": "Number of objects: a whole number, a parameter, or a distribution.",
        "anyOf": [
            { "type": "integer", "minimum": 0, "maximum": crate::MAX_OBJECTS },
            { "$ref": "#/$defs/ParamRef" },
            { "$ref": "#/$defs/Case" },
            { "$ref": "#/$defs/Distribution" }
        ]
    }))
    .expect("a literal object is a schema")
}
