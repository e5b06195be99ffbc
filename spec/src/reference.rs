//! Writes the reference of every key of a world as Markdown, from the table of fields and the schema. The committed pages are in
//! `docs/reference/`; `cargo xtask schemas` updates them.

use serde_json::Value as Json;

use crate::schema::part;
use crate::world::{Compared, Comparison, FieldPlace, World};

/// The parts of a world, one table each: title and pointer.
const PARTS: [(&str, &str); 7] = [
    ("The world as a whole", ""),
    ("The arena and its light", "/environment_params"),
    ("The agent", "/agent_params"),
    ("How objects are photographed", "/image_params"),
    ("Rewards and endings of the world", "/rules"),
    ("An object", "/objects/*"),
    ("The progress of a world", "/progress"),
];

const KEYS: &str = "# Every key of a world

Keys in bold also exist in L2Explorer. In the `world` of a task, and in the `object` of a group, the value of any key, or any
value inside it, can be a parameter or a distribution: the column *parameter* gives the type that the parameter needs, or the
reason why no parameter can set the key. A parameter of type `json` fits any key whose schema allows each of its values (`null`
if the key may be absent); so does a `choice` or `constant` of such values. The positions of a group's objects are its
`placement`, not `coordinates`; their number is its `count`. The column *compared* names the [part of a
distance](comparison.md) that reads the key. `cargo xtask schemas` generates this page.
";

const COMPARISON: &str = "# How worlds are compared

The distance between two worlds is the sum of these parts. Each part counts for one element of the decision process, in the
unit of the last column: `the larger value` means that the difference of two numbers is divided by the larger of them, so any
number above 0 differs from 0 by 1. Corners of walls and waypoints count by the distance between them, in units of 10 m; one
without a counterpart counts as 1. Parts of objects are sums over objects; surrounding colours are sums over four colours.
Values without any effect do not count, such as the reward of an object without a stimulus. Each key counts once, for its main
element; [the table of keys](world.md) says which parts read it. `driftworld elements` measures its other effects, such as the
effect of `order` on which objects move. `cargo xtask schemas` generates this page.

| part | element | 1 is |
|---|---|---|
";

/// The pages, each with its file name.
pub fn pages() -> Vec<(&'static str, String)> {
    let all = keys();
    let part_of = |key: &FieldPlace| {
        let parts = PARTS.iter().map(|(_, part)| *part);
        parts
            .filter(|part| is_below(&key.pointer, part))
            .max_by_key(|part| part.len())
    };
    let tables = PARTS.map(|(title, part)| {
        let own = all.iter().filter(|key| part_of(key) == Some(part));
        let rows: String = own.map(|key| row(key, part)).collect();
        let place = if part.is_empty() { String::new() } else { format!("At `{part}`:\n\n") };
        format!("\n## {title}\n\n{place}| key | meaning | type | default | parameter | compared |\n|---|---|---|---|---|---|\n{rows}")
    });
    let parts = Comparison::ALL.iter().map(|part| {
        let (element, unit) = (part.element().name(), part.unit());
        format!("| {} | {element} | {unit} |\n", part.name())
    });
    vec![
        ("world.md", format!("{KEYS}{}", tables.concat())),
        ("comparison.md", format!("{COMPARISON}{}", parts.collect::<String>())),
    ]
}

fn is_below(pointer: &str, part: &str) -> bool {
    pointer.strip_prefix(part).is_some_and(|rest| rest.starts_with('/'))
}

/// The keys in table order, including the keys inside progress, which the table lists only as a whole.
fn keys() -> Vec<FieldPlace> {
    let mut keys = Vec::new();
    for place in World::places().iter().filter(|place| place.is_key) {
        keys.push(place.clone());
        if place.pointer == "/progress" {
            add_inside(place, &place.pointer, &mut keys);
        }
    }
    keys
}

/// Adds, from the schema, the keys below a place that the table lists only as a whole.
fn add_inside(place: &FieldPlace, pointer: &str, keys: &mut Vec<FieldPlace>) {
    let root = World::schema().json();
    let part = part::at(root, root, pointer).unwrap_or(&Json::Null);
    if part.get("items").is_some() {
        return add_inside(place, &format!("{pointer}/*"), keys);
    }
    for (key, _) in part["properties"].as_object().into_iter().flatten() {
        let pointer = format!("{pointer}/{key}");
        keys.push(FieldPlace {
            pointer: pointer.clone(),
            ..place.clone()
        });
        add_inside(place, &pointer, keys);
    }
}

fn row(key: &FieldPlace, part: &str) -> String {
    let root = World::schema().json();
    let own = part::property(root, root, &key.pointer).unwrap_or(&Json::Null);
    let value = part::at(root, root, &key.pointer).unwrap_or(&Json::Null);
    let mark = if key.field.is_original { "**" } else { "" };
    let described = own.get("description").or_else(|| value.get("description"));
    let unit = key.field.unit.map(|unit| format!(", in {unit}")).unwrap_or_default();
    let default = own.get("default").filter(|default| !default.is_object());
    let default = match default {
        Some(default) => format!("`{default}`"),
        None if is_required(&key.pointer) => "required".to_owned(),
        None => String::new(),
    };
    let cells = [
        format!("{mark}`{}`{mark}", &key.pointer[part.len() + 1..]),
        described.and_then(Json::as_str).unwrap_or_default().to_owned(),
        format!("{}{unit}", type_of(own, value)),
        default,
        parameter(key),
        compared(key),
    ];
    let cells = cells.map(|cell| {
        cell.split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .replace('|', "\\|")
    });
    format!("| {} |\n", cells.join(" | "))
}

/// Whether a key is required wherever its parent is present.
fn is_required(pointer: &str) -> bool {
    let root = World::schema().json();
    let (part, key) = pointer.rsplit_once('/').unwrap_or_default();
    let required = part::at(root, root, part).and_then(|part| part["required"].as_array());
    required.into_iter().flatten().any(|required| *required == key)
}

/// The allowed types, in words.
fn type_of(own: &Json, value: &Json) -> String {
    let named = own["anyOf"].get(0).unwrap_or(own)["$ref"].as_str();
    if named.is_some_and(|name| name.ends_with("/Color")) {
        return "colour, `[r, g, b]` in 0..1 or a CSS name".to_owned();
    }
    // As `f64`, so that whole limits are printed without a decimal point.
    let limits = |value: &Json| match [value["minimum"].as_f64(), value["maximum"].as_f64()] {
        [Some(low), Some(high)] => format!(" from {low} to {high}"),
        _ => String::new(),
    };
    let name = value["type"].get(0).unwrap_or(&value["type"]).as_str();
    match name {
        Some("number") => format!("number{}", limits(value)),
        Some("integer") => format!("whole number{}", limits(value)),
        Some("boolean") => "true or false".to_owned(),
        Some("string") => "text".to_owned(),
        Some("object") => "object".to_owned(),
        Some("array") if value["minItems"] == value["maxItems"] && value["minItems"].is_u64() => {
            format!("{} numbers{}", value["minItems"], limits(&value["items"]))
        }
        Some("array") => match value["maxItems"].as_u64() {
            Some(max) => format!("list of at most {max}"),
            None => "list".to_owned(),
        },
        _ => forms(value),
    }
}

/// The allowed words, and the keys of other forms.
fn forms(value: &Json) -> String {
    let forms = value["oneOf"].as_array().into_iter().flatten();
    let words = forms.filter_map(|form| {
        let key = form["properties"].as_object().and_then(|keys| keys.keys().next());
        let word = form["const"].as_str().map(|word| format!("`\"{word}\"`"));
        word.or_else(|| Some(format!("an object with `{}`", key?)))
    });
    let words: Vec<String> = words.collect();
    if words.is_empty() {
        "text, or a whole number".to_owned()
    } else {
        words.join(", ")
    }
}

/// The type of parameter that sets the key, or the reason why none can.
fn parameter(key: &FieldPlace) -> String {
    if let Some(reason) = key.field.fixed {
        return format!("none: {reason}");
    }
    if let Some(reason) = key.field.in_parts {
        return format!("in parts: {reason}");
    }
    let inside = World::places()
        .iter()
        .filter(|place| is_below(&place.pointer, &key.pointer));
    let items = inside.take_while(|place| !place.is_key);
    let items = items.filter_map(|item| {
        Some(format!(
            "`{}` a {}",
            &item.pointer[key.pointer.len()..],
            item.kind?.name()
        ))
    });
    let whole = key.kind.map(|kind| kind.name().to_owned());
    whole.into_iter().chain(items).collect::<Vec<_>>().join("; ")
}

fn compared(key: &FieldPlace) -> String {
    let names = key.field.compared.comparisons().iter().map(|part| part.name());
    match key.field.compared {
        Compared::Not(reason) => format!("no: {reason}"),
        Compared::AsPart => "key by key".to_owned(),
        Compared::Leaves(_) | Compared::Measured(_) => names.collect::<Vec<_>>().join(", "),
    }
}
