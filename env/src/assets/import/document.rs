//! Parses the JSON of a glTF file. Checks its extent before parsing, and its version and extensions afterwards. Indices are
//! checked later, where they are used.

use std::collections::BTreeMap;

use driftworld_text::{first_of, shortened};
use gltf_json::Root;
use serde::Deserialize;
use serde::de::IgnoredAny;

use super::limits::{MAX_IMPORT_DEPTH, MAX_IMPORT_NODES};
use super::refusal::{at_most, quoted, refuse};
use crate::EnvError;

/// Maximum number of objects and lists: each may take several hundred bytes of memory for two bytes of JSON.
const MAX_ITEMS: usize = 200_000;

/// Maximum number of characters to show of the parser's message, which may quote a string as long as the file.
const MAX_MESSAGE_CHARS: usize = 200;

/// Extensions that may be ignored even if a file requires them: they change no triangle.
const HARMLESS: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
];

pub(super) fn parse(json: &str) -> Result<Root, EnvError> {
    check_extent(json)?;
    let root: Root = gltf_json::deserialize::from_str(json).map_err(|error| {
        if is_version_1(json) {
            return refuse("file", "glTF 1.0", "glTF 2.0; export it in that version");
        }
        // Cuts the position from the parser's message, because it is reported separately.
        let message = error.to_string();
        let words = message.split(" at line ").next().unwrap_or(&message);
        let place = format!("line {}, column {}", error.line(), error.column());
        refuse(
            place,
            format!("a fault: {}", shortened(words, MAX_MESSAGE_CHARS)),
            "glTF 2.0 JSON",
        )
    })?;
    if !root.asset.version.starts_with("2.") {
        let found = quoted(&root.asset.version);
        return Err(refuse("/asset/version", found, "\"2.0\"; export as glTF 2.0"));
    }
    for (index, name) in root.extensions_required.iter().enumerate() {
        if !HARMLESS.contains(&name.as_str()) {
            let place = format!("/extensionsRequired/{index}");
            let expected = if is_compression(name) {
                "no compression; export without it"
            } else {
                "an extension that can be left out; export without it"
            };
            return Err(refuse(place, quoted(name), expected));
        }
    }
    at_most(MAX_IMPORT_NODES, root.nodes.len(), "nodes", "/nodes")?;
    Ok(root)
}

/// Whether JSON that is not glTF 2.0 is version 1, in which `meshes` is an object instead of a list.
fn is_version_1(json: &str) -> bool {
    gltf_json::deserialize::from_str::<Version1>(json).is_ok()
}

#[derive(Deserialize)]
#[expect(clippy::zero_sized_map_values, reason = "only that it is an object matters")]
struct Version1 {
    #[serde(rename = "meshes")]
    _meshes: BTreeMap<String, IgnoredAny>,
}

fn is_compression(extension: &str) -> bool {
    ["draco", "meshopt", "quantization", "basisu"]
        .iter()
        .any(|word| extension.to_lowercase().contains(word))
}

/// Refuses JSON that is nested too deeply, or would need many times its length in memory.
fn check_extent(json: &str) -> Result<(), EnvError> {
    let (mut depth, mut items) = (0_usize, 0_usize);
    let (mut quoted, mut escaped) = (false, false);
    for (at, byte) in json.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if quoted => escaped = true,
            b'"' => quoted = !quoted,
            b'{' | b'[' if !quoted => (depth, items) = (depth + 1, items + 1),
            b'}' | b']' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_IMPORT_DEPTH {
            let expected = format!("at most {MAX_IMPORT_DEPTH}");
            return Err(refuse(
                format!("byte {at}"),
                format!("JSON nested {depth} deep"),
                expected,
            ));
        }
        if items > MAX_ITEMS {
            let expected = format!("at most {MAX_ITEMS} objects and lists");
            return Err(refuse(format!("byte {at}"), format!("the {items}th"), expected));
        }
    }
    Ok(())
}

/// Index of the material that takes the object's colour: the one with the given name, by default `main`.
pub(super) fn main_material(root: &Root, wanted: Option<&str>) -> Result<Option<usize>, EnvError> {
    let named = |name: &str| {
        let is_it = |material: &gltf_json::Material| {
            let own = material.name.as_deref();
            own.is_some_and(|own| own.eq_ignore_ascii_case(name))
        };
        root.materials.iter().position(is_it)
    };
    let Some(name) = wanted else { return Ok(named("main")) };
    let found = named(name);
    if found.is_none() {
        let names = root.materials.iter().filter_map(|material| material.name.as_deref());
        let names: Vec<String> = names.map(quoted).collect();
        let names = match names.len() {
            0 => "a file with named materials".to_owned(),
            _ => format!("one of {}", first_of(&names, 10)),
        };
        return Err(refuse("/materials", format!("none named {name:?}"), names));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_1_is_recognised_by_its_meshes() {
        #[track_caller]
        fn check(json: &str, expected: bool) {
            assert_eq!(is_version_1(json), expected, "{json}");
        }
        check(
            r#"{"meshes": {"box": {"primitives": [0, {}]}, "lid": 1}, "nodes": {}}"#,
            true,
        );
        check(r#"{"asset": {}, "meshes": {}}"#, true);
        check(r#"{"meshes": []}"#, false);
        check(r#"{"nodes": {}}"#, false);
        check("[0, 0, 0]", false);
        check(r#"{"meshes": {}"#, false);
    }

    #[test]
    fn quoted_strings_are_limited_to_one_line() {
        assert_eq!(quoted("é"), "\"é\"");
        assert_eq!(quoted(&"é".repeat(100)).chars().count(), 2 + 61);
    }
}
