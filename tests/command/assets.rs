//! Tests models of a library: they are packed from files, listed, drawn in worlds, and agents collide with them.

use std::path::{Path, PathBuf};

use driftworld::env::{Action, Catalogue, Environment, Library, Warning};
use driftworld::spec::World;

use super::terminal::{Says, driftworld, fail, output, root, scratch, succeed, text};

const MODEL: &str = "examples/assets/lighthouse.gltf";
const WORLD: &str = "examples/assets/harbour.json";

/// Standard error of the command, however it ends.
fn warnings(arguments: &[&str]) -> String {
    let output = output(&mut driftworld(arguments));
    String::from_utf8(output.stderr).expect("the command prints UTF-8")
}

/// A library that contains only the lighthouse.
fn packed(folder: &tempfile::TempDir) -> PathBuf {
    let library = folder.path().join("harbour.assets");
    succeed(&["assets", "pack", MODEL, "-o", text(&library)]);
    library
}

fn world() -> World {
    let json = std::fs::read_to_string(root().join(WORLD)).expect("the example is committed");
    World::from_json(WORLD, &json).expect("the example is a valid world")
}

#[test]
fn packed_model_can_be_used_in_worlds() {
    let folder = scratch();
    let bytes = std::fs::read(packed(&folder)).expect("the library was written");
    let library = Library::from_bytes(&bytes).expect("the packed library can be read");
    let model = &library.models()[0];
    assert_eq!((model.class(), model.name()), ("lighthouse", "1"));
    let (whole, _) = model.level(0).expect("every model has a full level");
    let (coarse, error) = model.level(1).expect("835 triangles are worth simplifying");
    assert!(
        whole == 803 && coarse < whole / 2 && error > 0.0,
        "{whole}, {coarse}, {error}"
    );
    assert!((model.asset().height - 10.2).abs() < 1e-3, "{} m", model.asset().height);

    let catalogue = Catalogue::default().with_library(&library);
    let mut environment = Environment::with_catalogue(world(), catalogue);
    assert_eq!(environment.warnings(), [], "its class is known");
    // Straight ahead, 18 m away, is a tower 4 m wide.
    for _ in 0..60 {
        environment
            .step(Action::Continuous([10.0, 0.0, 0.0]))
            .expect("the episode continues");
    }
    let [x, y] = environment.agent().position;
    assert!(
        x.abs() < 1.6 && (1.3..1.6).contains(&y),
        "the agent stops in front of the tower: {x}, {y}"
    );
    let class = environment.scene().items[0].class_id;
    let seen = environment
        .observe()
        .class
        .iter()
        .filter(|other| **other == class)
        .count();
    assert!(seen > 84 * 84 / 4, "the agent sees {seen} pixels of the tower");

    let moment = environment.snapshot();
    let mut other = Environment::new(World::default());
    other.restore(&moment);
    assert_eq!(
        other.observe().rgb,
        environment.observe().rgb,
        "a snapshot keeps its library"
    );
    environment.reset(world());
    assert_eq!(environment.warnings(), [], "a reset keeps the library, too");
    let unknown = |warning: &Warning| matches!(warning, Warning::UnknownAsset { .. });
    let without = Environment::new(world()).warnings();
    assert_eq!(without.len(), 3);
    assert!(without.iter().all(unknown), "without the library: {without:?}");
}

#[test]
fn packing_is_deterministic_and_adding_continues_the_numbers() {
    let folder = scratch();
    let library = packed(&folder);
    let first = std::fs::read(&library).expect("the library was written");
    packed(&folder);
    assert_eq!(std::fs::read(&library).expect("it was written again"), first);
    let arguments = [
        "assets",
        "pack",
        MODEL,
        "-o",
        text(&library),
        "--add",
        "--height",
        "3",
        "--collider",
        "hull",
    ];
    let stdout = succeed(&arguments);
    stdout.says("lighthouse  2");
    stdout.says("3.00 m");
    stdout.says("hull of");
    let listed = succeed(&["assets", "list", text(&library)]);
    assert_eq!(
        listed.lines().filter(|line| line.starts_with("lighthouse")).count(),
        2,
        "{listed}"
    );
}

#[test]
fn run_with_other_libraries_cannot_be_resumed() {
    let folder = scratch();
    let library = packed(&folder);
    let scenario = folder.path().join("scenario.json");
    let regime = r#"{ "task": "get_to_goal", "variant": "default", "count": 1, "max_steps": 3 }"#;
    let json = format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#);
    std::fs::write(&scenario, json).expect("the scratch folder can be written");
    let log = folder.path().join("log");
    let resume = ["run", text(&scenario), "--output", text(&log), "--resume"];
    let with = [&resume[..], &["--assets", text(&library)]].concat();
    succeed(&with);
    succeed(&with);
    let error = fail(1, &resume);
    assert!(error.contains("/made_from/assets: found"), "{error}");
    succeed(&["assets", "pack", MODEL, "--class", "beacon", "-o", text(&library)]);
    let error = fail(1, &with);
    assert!(error.contains("/made_from/assets/0/sha256: found"), "{error}");
}

#[test]
fn models_are_listed_and_drawn() {
    let folder = scratch();
    let library = packed(&folder);
    let built_in = succeed(&["assets", "list"]);
    assert!(
        built_in
            .lines()
            .any(|line| line.starts_with("tree") && line.contains("1–49")),
        "{built_in}"
    );
    let picture = folder.path().join("picture.png");
    let output = text(&picture);
    for (arguments, expected) in [
        (["assets", "show", "lighthouse", "1"].as_slice(), "940 × "),
        (&["assets", "show", "lighthouse"], "244 × "),
        (&["assets", "show", "tent"], "708 × "),
    ] {
        let arguments = [arguments, &["--assets", text(&library), "-o", output]].concat();
        let stdout = succeed(&arguments);
        assert!(stdout.contains(expected), "{stdout}");
        assert!(picture.exists());
    }
    let drawn = ["render", WORLD, "--view", "rgb", "--size", "64", "-o", output];
    let warned = warnings(&drawn);
    assert_eq!(warned.matches("a placeholder is shown").count(), 3, "{warned}");
    let placeholder = std::fs::read(&picture).expect("the picture was written");
    let silent = warnings(&[drawn.as_slice(), &["--assets", text(&library)]].concat());
    assert_eq!(silent, "");
    assert!(std::fs::read(&picture).expect("the picture was written") != placeholder);
}

#[test]
fn unpackable_files_are_refused_and_leave_no_library() {
    #[track_caller]
    fn check(model: &Path, library: &Path, expected: &str) {
        let error = fail(1, &["assets", "pack", text(model), "-o", text(library)]);
        assert!(error.contains(expected), "{error}");
        assert!(!library.exists(), "no partial file is left");
    }
    let folder = scratch();
    let library = folder.path().join("harbour.assets");
    check(
        &folder.path().join("absent.glb"),
        &library,
        "absent.glb: cannot be read",
    );
    check(folder.path(), &library, "found a folder, expected a regular file");
    let hostile = root().join("env/tests/hostile");
    check(
        &hostile.join("uri_above.gltf"),
        &library,
        "/buffers/0/uri: found \"../../etc/passwd\"",
    );
    check(&hostile.join("cycle_of_nodes.gltf"), &library, "a tree of nodes");
    let broken = folder.path().join("broken.assets");
    std::fs::write(&broken, b"DRIFTLIB and nothing more").expect("the scratch folder can be written");
    let error = fail(1, &["assets", "list", text(&broken)]);
    assert!(error.contains("broken.assets: library, byte"), "{error}");
    assert!(fail(1, &["assets", "show", "dragon"]).contains("\"dragon\" is not known"));
}

#[test]
fn only_libraries_are_overwritten() {
    let folder = scratch();
    let model = folder.path().join("tower.gltf");
    std::fs::copy(root().join(MODEL), &model).expect("the example is committed");
    let before = std::fs::read(&model).expect("it was copied");
    for add in [["--class", "tower"].as_slice(), &["--add"]] {
        let error = fail(
            1,
            &[["assets", "pack", text(&model), "-o", text(&model)].as_slice(), add].concat(),
        );
        let expected = "tower.gltf: found a file that is not a library, expected a new name or a library";
        assert!(error.contains(expected), "{error}");
        assert_eq!(std::fs::read(&model).expect("it is still there"), before);
    }
    let library = folder.path().join("town.assets");
    std::fs::write(&library, b"").expect("the scratch folder can be written");
    for _ in 0..2 {
        succeed(&["assets", "pack", text(&model), "-o", text(&library)]);
    }
}

#[test]
fn model_options_are_parsed_strictly() {
    let folder = scratch();
    let library = folder.path().join("town.assets");
    let pack = ["assets", "pack", MODEL, "-o", text(&library)];
    let stdout = succeed(&[pack.as_slice(), &["--class", " Lamp "]].concat());
    assert!(stdout.lines().any(|line| line.starts_with("lamp  ")), "{stdout}");
    let error = fail(1, &[pack.as_slice(), &["--scale", "-1"]].concat());
    assert!(error.contains("scale: found -1, expected a number above 0"), "{error}");
    let error = fail(1, &[pack.as_slice(), &["--height", "-2.5"]].concat());
    error.says("height: found -2.5, expected a number above 0");
}

/// A link in the model's folder must not lead to files elsewhere.
#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_not_followed() {
    let folder = scratch();
    let inside = folder.path().join("models");
    std::fs::create_dir(&inside).expect("the scratch folder can be written");
    std::fs::write(folder.path().join("secret.bin"), [0; 36]).expect("the scratch folder can be written");
    std::os::unix::fs::symlink("../secret.bin", inside.join("lamp.bin")).expect("links can be created");
    let json = r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "lamp.bin"}]}"#;
    let model = inside.join("lamp.gltf");
    std::fs::write(&model, json).expect("the scratch folder can be written");
    let library = folder.path().join("x.assets");
    let pack = ["assets", "pack", text(&model), "-o", text(&library)];
    let error = fail(1, &pack);
    assert!(error.contains("it leads out of the model's folder"), "{error}");
    std::fs::remove_file(inside.join("lamp.bin")).expect("the link exists");
    std::fs::write(inside.join("lamp.bin"), [0; 36]).expect("the scratch folder can be written");
    let error = fail(1, &pack);
    assert!(error.contains("nothing to draw"), "now the file is read: {error}");
}
