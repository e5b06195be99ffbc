//! Fuzz target for glTF models. Input after [`MARK`](crate::edited::MARK): a length, that many bytes of edits to a known file,
//! then edits to the bytes of its buffer.

use std::sync::OnceLock;

use arbitrary::Unstructured;
use driftworld_env::{ColliderKind, ImportOptions, ImportSize, Library, LibraryModel};
use serde_json::{Value, json};

use crate::edited::{Known, MARK, byte};
use crate::{refusal, world};

fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let lighthouse = world::json(include_str!("../../examples/assets/lighthouse.gltf"));
        let words = json!({ "words": ["KHR_materials_unlit", "KHR_texture_transform", "COLOR_0", "TEXCOORD_0", "mode", "matrix",
            "translation", "rotation", "scale", "children", "doubleSided", "sparse", "normalized", "byteStride", "BLEND", "MASK"] });
        Known::new(vec![tetrahedron(), lighthouse], &words.to_string())
    })
}

const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const INDICES: [u16; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

/// The buffer file next to the glTF file.
fn buffer() -> Vec<u8> {
    let corners = CORNERS.as_flattened().iter().flat_map(|number| number.to_le_bytes());
    corners
        .chain(INDICES.iter().flat_map(|index| index.to_le_bytes()))
        .collect()
}

fn tetrahedron() -> Value {
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "children": [2]}, {"mesh": 0, "scale": [2, 2, 2]}, {"translation": [1, 0, 0], "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 0}, "indices": 1, "material": 0, "mode": 4}]}],
        "materials": [{"name": "paint", "doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1.0]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 24}
        ],
        "buffers": [{"byteLength": 72, "uri": "b.bin"}]
    })
}

/// An imported model is valid in a library, and its bytes round-trip.
pub(crate) fn check(bytes: &[u8]) {
    let mut buffer_bytes = buffer();
    let mut file = bytes.to_vec();
    if let Some((&MARK, rest)) = bytes.split_first() {
        let (length, rest) = rest
            .split_first()
            .map_or((0, rest), |(length, rest)| (usize::from(*length), rest));
        let (changes, numbers) = rest.split_at(length.min(rest.len()));
        file = known().edited(&mut Unstructured::new(changes)).to_string().into_bytes();
        let mut numbers = Unstructured::new(numbers);
        while !numbers.is_empty() {
            let at = usize::from(byte(&mut numbers)) % buffer_bytes.len();
            buffer_bytes[at] = byte(&mut numbers);
        }
    }
    let options = ImportOptions {
        class: "thing".into(),
        name: "1".into(),
        size: ImportSize::Scale(1.0),
        collider: ColliderKind::Auto,
        main: None,
    };
    let read = LibraryModel::from_gltf(&file, &options, &mut |path| {
        assert!(!path.contains("..") && !path.starts_with('/'), "{path:?} was requested");
        Ok(buffer_bytes.clone())
    });
    let imported = match read {
        Ok(imported) => imported,
        Err(error) => return refusal::message(&error.to_string()),
    };
    refusal::messages(imported.warnings);
    let mut library = Library::default();
    library.insert(imported.model).expect("one model fits");
    let reread = Library::from_bytes(&library.to_bytes()).expect("our own output is valid");
    assert!(reread == library, "a model round-trips");
}
