//! Imports of valid glTF files: the models are upright, have the right size and colours, and can be used in worlds.
#![cfg(feature = "gltf")]

use std::path::Path;
use std::sync::Arc;

use driftworld_env::{
    Action, Asset, Batch, BatchOptions, Catalogue, ColliderKind, ColliderShape, Environment, ImportOptions, ImportSize,
    ImportWarning, Imported, Library, LibraryModel, Paint,
};
use driftworld_spec::{Model, Object, WorldDraft};
use serde_json::{Value, json};

fn options(class: &str) -> ImportOptions {
    ImportOptions {
        class: class.into(),
        name: "1".into(),
        size: ImportSize::Scale(1.0),
        collider: ColliderKind::Auto,
        main: None,
    }
}

/// A GLB file with one mesh: a quad from (0, 0, 0) to (2, 1, 0) in glTF's axes, with its front towards +z.
struct Quad {
    json: Value,
    binary: Vec<u8>,
}

impl Quad {
    fn new() -> Self {
        let corners: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.0, 0.0]];
        let indices: [u8; 8] = [0, 1, 3, 0, 3, 2, 0, 0];
        let mut quad = Self {
            json: json!({
                "asset": {"version": "2.0"},
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
                "materials": [{"name": "paint"}],
                "buffers": [{}],
                "bufferViews": [],
                "accessors": []
            }),
            binary: Vec::new(),
        };
        let positions: Vec<u8> = corners
            .as_flattened()
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        quad.add(&positions, json!({"componentType": 5126, "count": 4, "type": "VEC3"}));
        quad.add(&indices, json!({"componentType": 5121, "count": 6, "type": "SCALAR"}));
        quad
    }

    /// Adds an accessor for these bytes; returns its index.
    fn add(&mut self, bytes: &[u8], mut accessor: Value) -> usize {
        let views = self.json["bufferViews"].as_array_mut().expect("views are a list");
        views.push(json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()}));
        accessor["bufferView"] = json!(views.len() - 1);
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let accessors = self.json["accessors"].as_array_mut().expect("accessors are a list");
        accessors.push(accessor);
        accessors.len() - 1
    }

    fn set(mut self, pointer: &str, value: Value) -> Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer has a slash");
        self.json.pointer_mut(parent).expect("the parent exists")[key] = value;
        self
    }

    fn bytes(mut self) -> Vec<u8> {
        self.json["buffers"][0]["byteLength"] = json!(self.binary.len());
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bytes = b"glTF".to_vec();
        let whole = 28 + text.len() + self.binary.len();
        for number in [2, whole as u32, text.len() as u32] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(text);
        bytes.extend((self.binary.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(self.binary);
        bytes
    }

    #[track_caller]
    fn import(self, options: &ImportOptions) -> Imported {
        let nothing_beside = &mut |_: &str| Err("nothing lies beside it".to_owned());
        LibraryModel::from_gltf(&self.bytes(), options, nothing_beside).unwrap_or_else(|error| panic!("{error}"))
    }

    #[track_caller]
    fn asset(self) -> Asset {
        self.import(&options("quad")).model.asset()
    }
}

fn colors(asset: &Asset) -> Vec<[i32; 3]> {
    let color = |paint: &Paint| match paint {
        Paint::Main(color) | Paint::Fixed(color) => color.map(|channel| (channel * 255.0).round() as i32),
    };
    asset.parts.iter().map(|part| color(&part.paint)).collect()
}

/// Directions of an asset's triangles.
fn facing(asset: &Asset) -> Vec<[i32; 3]> {
    let normals = asset.parts.iter().flat_map(|part| &part.normals);
    normals.map(|normal| normal.map(|part| part.round() as i32)).collect()
}

#[test]
fn imported_models_are_upright_and_face_north() {
    let asset = Quad::new().asset();
    assert_eq!(facing(&asset), [[0, 1, 0]; 2]);
    let mut corners = asset.parts[0].mesh.corners.clone();
    corners.sort_by(|a, b| a.partial_cmp(b).expect("corners are numbers"));
    assert_eq!(
        corners,
        [[-1.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]
    );
    assert_eq!((asset.height, asset.radius), (1.0, 1.0));
    let ColliderShape::Box { half } = asset.collider else {
        panic!("expected a box collider: {:?}", asset.collider);
    };
    assert_eq!(half, [1.0, 0.01, 0.5]);
}

#[test]
fn mirrored_nodes_still_show_their_front() {
    let mirrored = |scale: [f32; 3]| facing(&Quad::new().set("/nodes/0/scale", json!(scale)).asset());
    assert_eq!(mirrored([-1.0, 1.0, 1.0]), [[0, 1, 0]; 2]);
    assert_eq!(mirrored([1.0, 1.0, -1.0]), [[0, -1, 0]; 2]);
    let back = Quad::new().set("/materials/0/doubleSided", json!(true)).asset();
    assert_eq!(facing(&back), [[0, 1, 0], [0, 1, 0], [0, -1, 0], [0, -1, 0]]);
}

#[test]
fn strips_and_fans_are_wound_like_lists() {
    for (mode, indices) in [(5, [0_u8, 1, 2, 3]), (6, [0, 1, 3, 2])] {
        let mut quad = Quad::new();
        let number = quad.add(&indices, json!({"componentType": 5121, "count": 4, "type": "SCALAR"}));
        let primitive = json!({"attributes": {"POSITION": 0}, "indices": number, "mode": mode});
        let quad = quad.set(
            "/meshes/0/primitives",
            json!([primitive, {"attributes": {"POSITION": 0}, "mode": 1}]),
        );
        let imported = quad.import(&options("quad"));
        assert_eq!(facing(&imported.model.asset()), [[0, 1, 0]; 2], "mode {mode}");
        assert_eq!(imported.warnings, [ImportWarning::PointsOrLines]);
    }
}

#[test]
fn nested_nodes_multiply_and_height_is_kept() {
    let nodes = json!([{"scale": [2, 2, 2], "children": [1]}, {"translation": [5, 3, 0], "mesh": 0}]);
    let imported = Quad::new().set("/nodes", nodes.clone()).asset();
    assert_eq!(
        (imported.height, imported.radius),
        (2.0, 2.0),
        "on the ground and centred, regardless of its original position"
    );
    let tall = ImportOptions {
        size: ImportSize::Height(3.0),
        collider: ColliderKind::Cylinder,
        ..options("quad")
    };
    let model = Quad::new().set("/nodes", nodes).import(&tall).model;
    assert_eq!(model.asset().height, 3.0);
    assert!(matches!(
        model.collider(),
        ColliderShape::Cylinder { half_height: 1.5, .. }
    ));
}

#[test]
fn colours_combine_factor_and_corners_in_linear_light() {
    let factor = "/materials/0/pbrMetallicRoughness";
    let plain = Quad::new()
        .set(factor, json!({"baseColorFactor": [1.0, 0.5, 0.0, 1.0]}))
        .asset();
    assert_eq!(
        colors(&plain),
        [[255, 188, 0]],
        "half of the light is 188 of 255 in sRGB"
    );
    let mut quad = Quad::new();
    let red_or_blue = [[255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 255, 255], [255, 0, 0, 255]].concat();
    let accessor = json!({"componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"});
    let number = quad.add(&red_or_blue, accessor);
    let asset = quad
        .set("/meshes/0/primitives/0/attributes/COLOR_0", json!(number))
        .asset();
    // A triangle with red corners, and one with a third of linear blue.
    assert_eq!(colors(&asset), [[213, 0, 156], [255, 0, 0]]);
}

/// An image of two pixels side by side.
fn two_pixels() -> Vec<u8> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 2, 1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("the header can be written");
    writer
        .write_image_data(&[10, 200, 30, 200, 20, 30])
        .expect("the pixels can be written");
    writer.finish().expect("the picture can be finished");
    png
}

/// A quad with a texture of two pixels. The first triangle is in the left half, the second in the right half, with corners 0
/// and 3 on the border; all are shifted to the right by `pictures` images.
fn textured(pictures: f32) -> Quad {
    let mut quad = Quad::new();
    let places: Vec<u8> = [[0.5_f32, 0.0], [0.0, 0.5], [1.0, 0.5], [0.5, 1.0]]
        .iter()
        .flat_map(|[u, v]| [u + pictures, *v])
        .flat_map(f32::to_le_bytes)
        .collect();
    let number = quad.add(&places, json!({"componentType": 5126, "count": 4, "type": "VEC2"}));
    quad.add(
        &two_pixels(),
        json!({"componentType": 5121, "count": 0, "type": "SCALAR"}),
    );
    let image = json!([{"bufferView": 3, "mimeType": "image/png"}]);
    quad.set("/images", image)
        .set("/textures", json!([{"source": 0}]))
        .set(
            "/materials/0/pbrMetallicRoughness",
            json!({"baseColorTexture": {"index": 0}}),
        )
        .set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(number))
}

#[test]
fn triangles_take_their_colour_from_the_texture() {
    assert_eq!(colors(&textured(0.0).asset()), [[10, 200, 30], [200, 20, 30]]);
}

#[test]
fn textures_wrap_as_specified_by_their_sampler() {
    /// Expects the colours of the first triangle, which is the only one with glTF's corner (2, 0, 0), and of the second.
    #[track_caller]
    fn check(wrap: u32, expected: [[i32; 3]; 2]) {
        let quad = textured(1.0)
            .set("/textures", json!([{"source": 0, "sampler": 0}]))
            .set("/samplers", json!([{"wrapS": wrap}]));
        let imported = quad.import(&options("quad"));
        assert_eq!(imported.warnings, []);
        let asset = imported.model.asset();
        let color_at = |corner: [f32; 3]| {
            let part = asset.parts.iter().position(|part| part.mesh.corners.contains(&corner));
            part.map(|part| colors(&asset)[part])
        };
        let found = [color_at([-1.0, 0.0, 0.0]), color_at([1.0, 0.0, 1.0])];
        assert_eq!(found, expected.map(Some), "wrapS {wrap}");
    }
    let (left, right) = ([10, 200, 30], [200, 20, 30]);
    check(10_497, [left, right]);
    check(33_071, [right, right]);
    check(33_648, [right, left]);
}

#[test]
fn unsupported_textures_give_a_warning() {
    #[track_caller]
    fn check(quad: Quad, warning: ImportWarning, place: &str, expected: &[[i32; 3]]) {
        let imported = quad.import(&options("quad"));
        assert!(warning.to_string().starts_with(place), "{warning}");
        assert_eq!(imported.warnings, [warning]);
        assert_eq!(colors(&imported.model.asset()), expected);
    }
    let white = [[255; 3]];
    check(
        textured(0.0).set("/textures", json!([{}])),
        ImportWarning::TextureWithoutImage { texture: 0 },
        "/textures/0: ",
        &white,
    );
    check(
        textured(0.0).set("/meshes/0/primitives/0/attributes", json!({"POSITION": 0})),
        ImportWarning::NoTexturePlaces,
        "/meshes: ",
        &white,
    );
    check(
        textured(0.0).set("/extensionsUsed", json!(["KHR_texture_transform"])),
        ImportWarning::TextureTransform,
        "/extensionsUsed: ",
        &[[10, 200, 30], [200, 20, 30]],
    );
}

#[test]
fn main_material_takes_the_objects_colour() {
    let is_main = |quad: Quad, main: Option<&str>| {
        let main = main.map(str::to_owned);
        let asset = quad
            .import(&ImportOptions {
                main,
                ..options("quad")
            })
            .model
            .asset();
        matches!(asset.parts[0].paint, Paint::Main(_))
    };
    assert!(!is_main(Quad::new(), None));
    assert!(is_main(Quad::new(), Some("Paint")));
    assert!(is_main(Quad::new().set("/materials/0/name", json!("main")), None));
}

/// A library with a quad of this class, and a catalogue that includes it.
fn catalogue(class: &str) -> (Library, Catalogue) {
    let mut library = Library::default();
    let model = Quad::new().import(&options(class)).model;
    library.insert(model).expect("the library is empty");
    let catalogue = Catalogue::default().with_library(&library);
    (library, catalogue)
}

#[test]
fn libraries_override_built_in_models() {
    let (mut library, catalogue) = catalogue("Tree");
    let again = library.insert(Quad::new().import(&options("tree")).model);
    let said = again.expect_err("class names are not case-sensitive").to_string();
    assert!(said.contains("found one that the library already has"), "{said}");
    let triangles = |class: &str, model: &str| {
        let asset = catalogue.asset(class, &Model(model.into()));
        (asset.known, asset.levels().next().map(|(triangles, _)| triangles))
    };
    assert_eq!(triangles("tree", "1"), (true, Some(2)), "its own");
    assert_eq!(triangles("TREE", " 01 "), (true, Some(2)));
    assert_eq!(triangles("tree", "2"), (true, Some(230)), "the built-in one");
    assert!(
        !triangles("tree", "oak").0 && !triangles("dragon", "1").0,
        "a placeholder"
    );
    let read = Library::from_bytes(&library.to_bytes()).expect("the bytes are a valid library");
    assert_eq!(read, library);
}

#[test]
fn batches_and_spawned_objects_use_the_library() {
    let (_, catalogue) = catalogue("screen");
    let world = WorldDraft::with_objects(vec![Object::new("screen", [0.0, 5.0])]);
    let world = world.check().expect("the world is valid");
    let mut alone = Environment::with_catalogue(world.clone(), catalogue.clone());
    let index = alone.spawn(Object::new("screen", [3.0, 3.0])).expect("there is room");
    assert!(alone.scene().items[index].asset.known);
    alone.reset(world.clone());
    let source = Arc::new(move |_| Ok(world.clone()));
    let options = BatchOptions {
        num_threads: 1,
        ..BatchOptions::default()
    };
    let mut batch = Batch::with_catalogue_while(2, source, options, &catalogue, &|| true).expect("the worlds start");
    // The quad is 2 m wide and blocks the path at 5 m: the agent stops half a metre plus a skin in front of it.
    for _ in 0..20 {
        let ahead = Action::Continuous([10.0, 0.0, 0.0]);
        batch.step(&[ahead; 2]).expect("the episodes continue");
        alone.step(ahead).expect("the episode continues");
    }
    let seen = batch.environment(1).expect("the batch has two environments");
    assert_eq!(seen.agent().position, alone.agent().position);
    assert!(
        (4.4..4.5).contains(&alone.agent().position[1]),
        "{:?}",
        alone.agent().position
    );
}

#[test]
fn built_in_model_files_are_imported_without_warnings() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/models");
    let files = std::fs::read_dir(folder).expect("the folder is part of the repository");
    let paths: Vec<_> = files
        .map(|file| file.expect("the folder can be listed").path())
        .collect();
    assert_eq!(paths.len(), 35);
    for path in paths {
        let bytes = std::fs::read(&path).expect("the file can be read");
        let imported = LibraryModel::from_gltf(&bytes, &options("row"), &mut |_| Err("one file".into()));
        let imported = imported.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(imported.warnings, [], "{}", path.display());
    }
}
