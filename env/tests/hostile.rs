//! Malicious or broken files: each is refused with its own message, within the limits, without a panic.
//!
//! The corpus is in `tests/hostile/`: each file, and its message in a file next to it. It is generated here;
//! `DRIFTWORLD_UPDATE_HOSTILE=1` rewrites it. A file that is no longer generated, or differs, fails the test.
#![cfg(feature = "gltf")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use driftworld_env::{
    ColliderKind, EnvError, ImportOptions, ImportSize, ImportWarning, Imported, LibraryModel, MAX_NAME_BYTES,
};
use proptest::prelude::*;
use serde_json::{Value, json};

fn options() -> ImportOptions {
    ImportOptions {
        class: "thing".into(),
        name: "1".into(),
        size: ImportSize::Scale(1.0),
        collider: ColliderKind::Auto,
        main: None,
    }
}

fn import(bytes: &[u8]) -> Result<Imported, EnvError> {
    LibraryModel::from_gltf(bytes, &options(), &mut |path| {
        assert!(!path.contains("..") && !path.starts_with('/'), "{path:?} was requested");
        Err("there is no such file".to_owned())
    })
}

/// A tetrahedron of 1 m in glTF's axes; every case is a broken variant of it.
fn valid_document() -> Value {
    let corners: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let indices: [u16; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    document(&corners, &indices)
}

fn document(corners: &[[f32; 3]], indices: &[u16]) -> Value {
    let mut bytes: Vec<u8> = corners
        .as_flattened()
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let positions = bytes.len();
    bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1.0]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": corners.len(), "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": indices.len(), "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": positions},
            {"buffer": 0, "byteOffset": positions, "byteLength": bytes.len() - positions}
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": data_uri(&bytes)}]
    })
}

fn data_uri(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut uri = "data:application/octet-stream;base64,".to_owned();
    for three in bytes.chunks(3) {
        let at = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k)) as usize & 63];
            uri.push(if k <= three.len() { char::from(letter) } else { '=' });
        }
    }
    uri
}

/// The valid document with one value changed.
fn with(pointer: &str, value: Value) -> Vec<u8> {
    changed(&[(pointer, value)])
}

/// The valid document with several values changed; missing ones are created.
fn changed(changes: &[(&str, Value)]) -> Vec<u8> {
    let mut document = valid_document();
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer has a slash");
        match document.pointer_mut(parent).expect("the parent exists") {
            Value::Array(list) => {
                let at: usize = key.parse().expect("list items are addressed by number");
                if at < list.len() {
                    list[at] = value.clone();
                } else {
                    list.push(value.clone());
                }
            }
            parent => parent[key] = value.clone(),
        }
    }
    text(&document)
}

fn text(document: &Value) -> Vec<u8> {
    let mut text = serde_json::to_string_pretty(document).expect("the document is JSON");
    text.push('\n');
    text.into_bytes()
}

fn glb(version: u32, json: &[u8], length_more: i64) -> Vec<u8> {
    let mut bytes = b"glTF".to_vec();
    let length = (20 + json.len()) as i64 + length_more;
    for number in [version, length as u32, json.len() as u32] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes
}

/// A PNG file that ends after its header, which gives this size.
fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    drop(encoder.write_header().expect("a header can be written"));
    bytes.truncate(8 + 25);
    bytes
}

fn textured(png: &[u8]) -> Vec<u8> {
    let places = vec![0_u8; 4 * 8];
    changed(&[
        ("/images", json!([{"uri": data_uri(png)}])),
        ("/textures", json!([{"source": 0}])),
        (
            "/materials/0/pbrMetallicRoughness/baseColorTexture",
            json!({"index": 0}),
        ),
        (
            "/buffers/1",
            json!({"byteLength": places.len(), "uri": data_uri(&places)}),
        ),
        ("/bufferViews/2", json!({"buffer": 1, "byteLength": places.len()})),
        (
            "/accessors/2",
            json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"}),
        ),
        ("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(2)),
    ])
}

/// The valid document with texture 1, which repeats as specified by sampler 0, and with one value changed.
fn textured_with(pointer: &str, value: Value) -> Vec<u8> {
    changed(&[
        (
            "/materials/0/pbrMetallicRoughness/baseColorTexture",
            json!({"index": 1}),
        ),
        ("/images", json!([{"uri": "lamp.png"}])),
        ("/samplers", json!([{}])),
        ("/textures", json!([{"source": 0}, {"source": 0, "sampler": 0}])),
        (pointer, value),
    ])
}

/// Valid documents with changed values: each line has the file's name, then the pointer and the new value of each change.
const CHANGED: &str = r#"version_1_names.gltf | /meshes {"box": {"primitives": []}}
version_1.gltf | /asset/version "1.0"
extension_unknown.gltf | /extensionsRequired ["VENDOR_secret_sauce"]
extension_draco.gltf | /extensionsRequired ["KHR_draco_mesh_compression"]
extension_meshopt.gltf | /extensionsRequired ["EXT_meshopt_compression"]
no_scene_content.gltf | /scenes/0/nodes []
no_mesh.gltf | /meshes [] | /nodes [{}]
points_only.gltf | /meshes/0/primitives/0/mode 0
mode_unknown.gltf | /meshes/0/primitives/0/mode 77
missing_scene.gltf | /scene 9
missing_node.gltf | /scenes/0/nodes [9]
missing_mesh.gltf | /nodes/0/mesh 9
missing_positions.gltf | /meshes/0/primitives/0/attributes/POSITION 9
missing_indices.gltf | /meshes/0/primitives/0/indices 9
missing_material.gltf | /meshes/0/primitives/0/material 9
missing_view.gltf | /accessors/0/bufferView 4000000000
missing_buffer.gltf | /bufferViews/0/buffer 9
missing_texture.gltf | /materials/0/pbrMetallicRoughness/baseColorTexture {"index": 9} | /meshes/0/primitives/0/attributes/TEXCOORD_0 9
no_positions.gltf | /meshes/0/primitives/0/attributes {}
no_view.gltf | /accessors/0 {"componentType": 5126, "count": 3, "type": "VEC3"}
cycle_of_nodes.gltf | /nodes [{"children": [1]}, {"children": [2]}, {"children": [0]}]
own_child.gltf | /nodes [{"mesh": 0, "children": [0]}]
cycle_without_root.gltf | /nodes [{"children": [1]}, {"children": [0]}] | /scene 0 | /scenes []
two_parents.gltf | /nodes [{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}]
sparse.gltf | /accessors/0/sparse {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}
count_huge.gltf | /accessors/0/count 4000000000
count_largest.gltf | /accessors/1/count 18446744073709551615
count_one_too_many.gltf | /accessors/0/count 5
count_negative.gltf | /accessors/0/count -1
offset_overflow.gltf | /accessors/0/byteOffset 18446744073709551615
offset_beyond.gltf | /accessors/1/byteOffset 2
view_overflow.gltf | /bufferViews/0/byteOffset 18446744073709551615 | /bufferViews/0/byteLength 2
view_beyond.gltf | /bufferViews/1/byteLength 1000
stride_zero.gltf | /bufferViews/0/byteStride 0
stride_odd.gltf | /bufferViews/0/byteStride 13
stride_large.gltf | /bufferViews/0/byteStride 1000000
stride_overlaps.gltf | /bufferViews/0/byteStride 4
stride_beyond.gltf | /bufferViews/0/byteStride 16
buffer_longer_than_data.gltf | /buffers/0/byteLength 1000000
positions_of_two.gltf | /accessors/0/type "VEC2"
positions_of_bytes.gltf | /accessors/0/componentType 5120
indices_of_floats.gltf | /accessors/1/componentType 5126
component_unknown.gltf | /accessors/0/componentType 1
uri_above.gltf | /buffers/0/uri "../../etc/passwd"
uri_above_escaped.gltf | /buffers/0/uri "%2e%2e/%2E%2E/etc/passwd"
uri_above_backslash.gltf | /buffers/0/uri "..\\..\\boot.ini"
uri_absolute.gltf | /buffers/0/uri "/etc/passwd"
uri_drive.gltf | /buffers/0/uri "C:/boot.ini"
uri_file.gltf | /buffers/0/uri "file:///etc/passwd"
uri_http.gltf | /buffers/0/uri "http://example.org/lamp.bin"
uri_share.gltf | /buffers/0/uri "//server/share/lamp.bin"
uri_absent.gltf | /buffers/0/uri "lamp.bin"
uri_not_base64.gltf | /buffers/0/uri "data:application/octet-stream;base64,####"
uri_plain_data.gltf | /buffers/0/uri "data:text/plain,hello"
image_above.gltf | /images [{"uri": "../secret.png"}] | /textures [{"source": 0}] | /materials/0/pbrMetallicRoughness/baseColorTexture {"index": 0, "texCoord": 7}
too_small.gltf | /nodes/0/scale [1e-5, 1e-5, 1e-5]
scaled_to_nothing.gltf | /nodes/0/scale [0, 0, 0]
scaled_beyond.gltf | /nodes/0/scale [1e38, 1e38, 1e38]
color_above_1.gltf | /materials/0/pbrMetallicRoughness/baseColorFactor [2.0, 0.0, 0.0, 1.0]"#;

fn changed_values(row: &'static str) -> (&'static str, Vec<u8>) {
    let mut parts = row.split(" | ");
    let name = parts.next().expect("a row has a name");
    let change = |part: &'static str| {
        let (pointer, value) = part.split_once(' ').expect("every pointer has a new value");
        (pointer, value.parse().expect("the value is JSON"))
    };
    (name, changed(&parts.map(change).collect::<Vec<_>>()))
}

/// All cases: file name and bytes.
fn cases() -> Vec<(&'static str, Vec<u8>)> {
    let changed = CHANGED.lines().map(changed_values).collect();
    [changed, containers(), documents(), triangles()].concat()
}

fn containers() -> Vec<(&'static str, Vec<u8>)> {
    let json = text(&valid_document());
    let mut overrun = glb(2, &json, 0);
    overrun[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut binary_first = glb(2, &json, 0);
    binary_first[16..20].copy_from_slice(b"BIN\0");
    vec![
        ("empty.gltf", Vec::new()),
        ("words.gltf", b"a lamp, please\n".to_vec()),
        ("latin1.gltf", b"{\"asset\": \"L\xE4mp\"}".to_vec()),
        ("glb_header_cut.glb", b"glTF\x02\0\0\0".to_vec()),
        ("glb_version_1.glb", glb(1, &json, 0)),
        ("glb_longer_than_file.glb", glb(2, &json, 4096)),
        ("glb_shorter_than_file.glb", glb(2, &json, -4)),
        ("glb_without_chunks.glb", b"glTF\x02\0\0\0\x0C\0\0\0".to_vec()),
        (
            "glb_chunk_header_cut.glb",
            b"glTF\x02\0\0\0\x10\0\0\0\x04\0\0\0".to_vec(),
        ),
        ("glb_chunk_overrun.glb", overrun),
        ("glb_binary_first.glb", binary_first),
        ("glb_json_not_utf8.glb", glb(2, b"{\"\xFF\": 1}  ", 0)),
        (
            "glb_without_binary.glb",
            glb(2, &with("/buffers", json!([{"byteLength": 72}])), 0),
        ),
    ]
}

fn documents() -> Vec<(&'static str, Vec<u8>)> {
    let chain = (1..=70).map(|next| json!({"children": [next]}));
    let valid_document = String::from_utf8(with("/nodes/0/scale", json!([123, 1, 1]))).expect("JSON is UTF-8");
    let other_source = |texture: Value| textured_with("/textures", json!([{"source": 0}, texture]));
    vec![
        ("json_cut.gltf", text(&self::valid_document())[..300].to_vec()),
        ("json_nested.gltf", [b"[".repeat(2000), b"]".repeat(2000)].concat()),
        ("json_other.gltf", b"{\"task\": \"find_objects\"}\n".to_vec()),
        ("json_long_text.gltf", with("/nodes", json!("x".repeat(2000)))),
        ("missing_base_texture.gltf", textured_with("/textures", json!([]))),
        ("missing_image.gltf", other_source(json!({"source": 9}))),
        ("missing_sampler.gltf", other_source(json!({"source": 0, "sampler": 9}))),
        ("wrap_unknown.gltf", textured_with("/samplers", json!([{"wrapT": 1}]))),
        (
            "deep_nodes.gltf",
            with("/nodes", chain.chain([json!({"mesh": 0})]).collect()),
        ),
        ("png_huge.gltf", textured(&png_header(100_000, 100_000))),
        ("png_cut.gltf", textured(&png_header(8, 8))),
        ("matrix_overflow.gltf", with("/nodes/0/matrix", json!(vec![1e30; 16]))),
        (
            "number_too_large.gltf",
            valid_document.replace("123", "1e999").into_bytes(),
        ),
    ]
}

fn triangles() -> Vec<(&'static str, Vec<u8>)> {
    let triangle =
        |corner: [f32; 3], indices: [u16; 3]| text(&document(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], corner], &indices));
    vec![
        ("index_beyond.gltf", triangle([0.0, 1.0, 0.0], [0, 1, 65_535])),
        ("position_nan.gltf", triangle([0.0, f32::NAN, 0.0], [0, 1, 2])),
        (
            "position_infinite.gltf",
            triangle([f32::NEG_INFINITY, 1.0, 0.0], [0, 1, 2]),
        ),
        ("position_far.gltf", triangle([0.0, 1e30, 0.0], [0, 1, 2])),
        ("no_area.gltf", triangle([0.5, 0.0, 0.0], [0, 1, 2])),
        ("too_large.gltf", triangle([0.0, 5000.0, 0.0], [0, 1, 2])),
    ]
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hostile")
}

#[test]
fn every_hostile_file_is_refused_with_its_message() {
    let update = std::env::var_os("DRIFTWORLD_UPDATE_HOSTILE").is_some();
    let mut known = BTreeSet::new();
    for (name, bytes) in cases() {
        let error = import(&bytes).err().unwrap_or_else(|| panic!("{name} was accepted"));
        assert!(matches!(error, EnvError::BadModel { .. }), "{name}: {error}");
        let said = format!("{error}\n");
        let (file, message) = (folder().join(name), folder().join(format!("{name}.txt")));
        if update {
            fs::create_dir_all(folder()).expect("the folder can be created");
            fs::write(&file, &bytes).expect("the file can be written");
            fs::write(&message, &said).expect("the message can be written");
        }
        assert_eq!(fs::read(&file).expect(name), bytes, "{name} is outdated");
        assert_eq!(fs::read_to_string(&message).expect(name), said, "{name}");
        assert!(
            known.insert(name.to_owned()) && known.insert(format!("{name}.txt")),
            "{name} is generated twice"
        );
    }
    let entries = fs::read_dir(folder()).expect("the corpus is committed");
    let files = entries.map(|entry| entry.expect("the folder can be read").file_name());
    let found: BTreeSet<String> = files.map(|name| name.to_string_lossy().into_owned()).collect();
    assert_eq!(found, known, "the folder holds the corpus and nothing else");
}

#[test]
fn unbroken_document_is_valid() {
    let model = import(&text(&valid_document())).expect("the base of all cases is valid");
    assert_eq!(model.warnings, []);
    assert_eq!(model.model.level(0), Some((4, 0.0)));
    let pixels = [[255, 0, 0], [0, 255, 0]].concat();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 2, 1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("the header can be written");
    writer.write_image_data(&pixels).expect("the pixels can be written");
    writer.finish().expect("the picture can be finished");
    assert!(import(&textured(&png)).is_ok());
    let jpeg = import(&textured(b"\xFF\xD8\xFF")).expect("the plain colour is used instead");
    assert!(matches!(
        jpeg.warnings[..],
        [ImportWarning::TextureFormat { image: 0, .. }]
    ));
}

#[test]
fn large_input_is_refused_before_allocating() {
    #[track_caller]
    fn check(bytes: &[u8], expected: &str) {
        let error = import(bytes).expect_err("the file is too large").to_string();
        assert!(error.contains(expected), "{error}");
    }
    let many = format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"nodes\": [{}{{}}]}}",
        "{},".repeat(250_000)
    );
    check(many.as_bytes(), "at most 200000 objects and lists");
    let nodes: Vec<Value> = vec![json!({}); 10_001];
    check(
        &with("/nodes", json!(nodes)),
        "/nodes: found 10001 nodes, expected at most 10000",
    );
    check(&vec![b' '; (64 << 20) + 1], "expected at most 67108864");
    // A mesh of 900 triangles with 2,000 instances in the scene.
    let corners: Vec<[f32; 3]> = (0..902).map(|k| [k as f32, (k % 2) as f32, 0.0]).collect();
    let indices: Vec<u16> = (0..900).flat_map(|k| [k, k + 1, k + 2]).collect();
    let mut crowd = document(&corners, &indices);
    crowd["nodes"] = json!(vec![json!({"mesh": 0}); 2000]);
    crowd["scenes"][0]["nodes"] = (0..2000).collect();
    check(&text(&crowd), "expected at most 1000000 in the whole scene");
}

#[test]
fn invalid_options_are_refused() {
    let long = "x".repeat(MAX_NAME_BYTES + 1);
    for (change, expected) in [
        (
            &(|o: &mut ImportOptions| o.size = ImportSize::Scale(0.0)) as &dyn Fn(&mut ImportOptions),
            "scale: found 0",
        ),
        (&|o| o.size = ImportSize::Height(f32::NAN), "height: found NaN"),
        (&|o| o.size = ImportSize::Height(5000.0), "height: found 5000 m"),
        (&|o| o.size = ImportSize::Scale(1e6), "model: found a size of"),
        (
            &|o| o.main = Some("paint".into()),
            "/materials: found none named \"paint\"",
        ),
        (&|o| o.class = String::new(), "model: found a class of 0 bytes"),
        (&|o| o.class.clone_from(&long), "model: found a class of 201 bytes"),
    ] {
        let mut options = options();
        change(&mut options);
        let error = LibraryModel::from_gltf(&text(&valid_document()), &options, &mut |_| Err(String::new()));
        let error = error.expect_err(expected).to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 512)))]

    /// Any bytes of a valid file are replaced with random ones.
    #[test]
    fn changed_bytes_never_panic(changes in proptest::collection::vec((any::<usize>(), any::<u8>()), 1..12)) {
        let mut bytes = text(&valid_document());
        for (at, byte) in changes {
            let at = at % bytes.len();
            bytes[at] = byte;
        }
        let _ = import(&bytes);
    }

    /// The same for a GLB file, which also has binary lengths and numbers.
    #[test]
    fn changed_bytes_of_a_glb_never_panic(
        changes in proptest::collection::vec((any::<usize>(), any::<u8>()), 1..8),
        cut in any::<usize>(),
    ) {
        let mut bytes = glb(2, &text(&valid_document()), 0);
        for (at, byte) in changes {
            // Half of the changes are in the headers.
            let at = if at % 2 == 0 { at / 2 % 20 } else { at % bytes.len() };
            bytes[at] = byte;
        }
        if cut % 4 == 0 {
            bytes.truncate(cut / 4 % bytes.len());
        }
        let _ = import(&bytes);
    }

    /// Any number of a valid file is replaced with another one.
    #[test]
    fn changed_numbers_never_panic(
        at in any::<prop::sample::Index>(),
        number in prop_oneof![Just(0_i64), Just(-1), Just(1), Just(i64::MAX), Just(65_536), any::<i64>(), 0_i64..200],
    ) {
        let text = serde_json::to_string(&valid_document()).expect("the document is JSON");
        let digits: Vec<(usize, usize)> = {
            let bytes = text.as_bytes();
            let is_digit = |k: usize| bytes.get(k).is_some_and(u8::is_ascii_digit);
            let starts = (1..bytes.len()).filter(|k| is_digit(*k) && matches!(bytes[k - 1], b':' | b',' | b'['));
            starts.map(|start| (start, (start..bytes.len()).find(|k| !is_digit(*k)).unwrap_or(start))).collect()
        };
        let (start, end) = digits[at.index(digits.len())];
        let _ = import(format!("{}{number}{}", &text[..start], &text[end..]).as_bytes());
    }
}
