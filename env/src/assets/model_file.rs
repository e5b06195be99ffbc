//! Reads the glTF files of built-in models, which `docs/assets.md` describes. `import/` reads and checks users' files.

use std::sync::Arc;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use driftworld_spec::srgb_from_linear;
use serde_json::Value;

use super::{Asset, ColliderShape, Mesh, Paint, Part};

/// A file embedded in the program. Tests read all of them completely, so reading cannot fail.
struct File {
    json: Value,
    buffers: Vec<Vec<u8>>,
}

/// The levels of a model, each with its error in metres.
type Levels = Vec<(f32, Vec<Part>)>;

/// The models of a file with their names, in the order of their nodes.
pub(super) fn read(text: &str) -> Vec<(String, Arc<Asset>)> {
    let json: Value = serde_json::from_str(text).expect("a model file is valid JSON");
    let buffers = list(&json["buffers"]).iter().map(decoded).collect();
    let file = File { json, buffers };
    let mut models: Vec<(&Value, Levels)> = Vec::new();
    for node in list(&file.json["nodes"]) {
        let parts = file.parts(node);
        match (node["extras"]["error"].as_f64(), models.last_mut()) {
            (Some(error), Some((_, levels))) => levels.push((error as f32, parts)),
            _ => models.push((node, vec![(0.0, parts)])),
        }
    }
    let with_name = |(node, levels): (&Value, Levels)| {
        let name = node["name"].as_str().unwrap_or_default();
        (name.to_owned(), Arc::new(Asset::of_levels(levels, body(node))))
    };
    models.into_iter().map(with_name).collect()
}

impl File {
    fn parts(&self, node: &Value) -> Vec<Part> {
        let mesh = &self.json["meshes"][index(&node["mesh"])];
        let parts = list(&mesh["primitives"]).iter();
        parts.map(|primitive| self.part(primitive)).collect()
    }

    fn part(&self, primitive: &Value) -> Part {
        let positions = self.bytes(&primitive["attributes"]["POSITION"], 12);
        let indices = self.bytes(&primitive["indices"], 2);
        let corner = |bytes: &[u8; 12]| {
            let [x, y, z] = [0, 4, 8].map(|k| f32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]));
            // Converts axes: glTF's up (+y) is our +z, its front (+z) our +y (north), and its +x our −x (west).
            [-x, z, y]
        };
        let triangle = |bytes: &[u8; 6]| [0, 2, 4].map(|k| u32::from(u16::from_le_bytes([bytes[k], bytes[k + 1]])));
        let mesh = Mesh {
            corners: positions.as_chunks().0.iter().map(corner).collect(),
            triangles: indices.as_chunks().0.iter().map(triangle).collect(),
        };
        Part::new(mesh, paint(&self.json["materials"][index(&primitive["material"])]))
    }

    /// The bytes of an accessor whose elements have `size` bytes.
    fn bytes(&self, accessor: &Value, size: usize) -> &[u8] {
        let accessor = &self.json["accessors"][index(accessor)];
        let view = &self.json["bufferViews"][index(&accessor["bufferView"])];
        let start = index(&view["byteOffset"]) + index(&accessor["byteOffset"]);
        &self.buffers[index(&view["buffer"])][start..start + size * index(&accessor["count"])]
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// A whole number; 0 if absent.
fn index(value: &Value) -> usize {
    value.as_u64().unwrap_or_default() as usize
}

fn decoded(buffer: &Value) -> Vec<u8> {
    let uri = buffer["uri"].as_str().and_then(|uri| uri.split_once(','));
    let (_, data) = uri.expect("buffers are embedded in the model file");
    BASE64_STANDARD.decode(data).expect("buffers are valid base64")
}

fn body(node: &Value) -> ColliderShape {
    serde_json::from_value(node["extras"]["body"].clone()).expect("every model has a body")
}

fn paint(material: &Value) -> Paint {
    let factor = &material["pbrMetallicRoughness"]["baseColorFactor"];
    let color = [0, 1, 2].map(|k| srgb_from_linear(factor[k].as_f64().unwrap_or(1.0)) as f32);
    match material["name"].as_str() {
        Some(name) if name.starts_with("main") => Paint::Main(color),
        _ => Paint::Fixed(color),
    }
}
