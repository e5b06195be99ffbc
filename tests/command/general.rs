//! Tests of the `driftworld` command in general: output, exit codes, messages, and that no file is written partially.

use super::terminal::{
    Says, driftworld_in, fail, fail_in, json, json_in, output, scratch, subcommands, succeed, succeed_in, text,
};
use crate::reference_data::reference;

/// The list itself is a snapshot at two widths in `widths`.
#[test]
fn every_subcommand_has_a_help_page_with_an_example() {
    let names = subcommands();
    assert!(names.len() > 25, "{names:?}");
    for name in names {
        let help = succeed(&[name.as_str(), "--help"]);
        assert!(help.contains("Example"), "{name} shows an example:\n{help}");
        insta::assert_snapshot!(format!("help_{name}"), help);
    }
}

#[test]
fn doctor_lists_the_working_renderers() {
    assert!(succeed(&["doctor"]).contains("cpu   works: processor ("));
    let report = json("doctor --json");
    assert_eq!(report["cpu"]["works"], true);
    for feature in ["gltf", "gpu", "line-editor"] {
        assert!(report["features"][feature].is_boolean(), "{feature}: {report}");
    }
    assert!(
        ["cpu", "gpu"].contains(&report["auto"].as_str().unwrap_or_default()),
        "{report}"
    );
    if report["gpu"]["in_this_build"] == false {
        let missing = report["gpu"]["missing"][0].as_str().unwrap_or_default();
        assert!(missing.contains("--features gpu"), "{report}");
        let error = fail(1, &["render", "find_objects", "--renderer", "gpu"]);
        error.says("--features gpu");
        error.says("driftworld doctor");
    }
}

#[test]
fn validate_accepts_the_examples_and_l2explorer_maps() {
    let stdout = succeed(&["validate", "examples/tasks"]);
    assert_eq!(stdout.lines().count(), 7, "{stdout}");
    let files = std::fs::read_dir("examples/curricula").expect("the folder can be read");
    let count = files
        .filter(|file| {
            file.as_ref()
                .is_ok_and(|file| file.path().extension().is_some_and(|end| end == "json"))
        })
        .count();
    assert_eq!(succeed(&["validate", "examples/curricula"]).lines().count(), count);
    for map in ["map_findobjects_0.json", "map_simple.json", "map_spawning.json"] {
        let Some(path) = reference(&format!("l2explorer/{map}")) else {
            return;
        };
        succeed(&["validate", "--l2explorer", text(&path)]);
        let refused = fail(1, &["validate", text(&path)]);
        assert!(
            refused.contains("pickup_range"),
            "the strict reader names the old key: {refused}"
        );
    }
}

#[test]
fn verdict_on_invalid_json_is_json() {
    let folder = scratch();
    std::fs::write(folder.path().join("world.json"), "{,}").expect("the scratch folder can be written");
    let done = output(&mut driftworld_in(folder.path(), "validate --json world.json"));
    let verdicts: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON also for bad files");
    assert_eq!(verdicts[0]["valid"], false);
}

#[test]
fn world_has_the_same_bytes_alone_repeated_and_in_a_stream() {
    let sample = |more: &str| succeed(&format!("sample find_objects#red --seed 7 {more}"));
    let first = sample("--index 1234 -o -");
    assert_eq!(first, sample("--index 1234 -o -"));
    let stream = sample("--count 1235 --jsonl");
    assert_eq!(stream.lines().count(), 1235);
    assert_eq!(stream.lines().last(), first.strip_suffix('\n'));
    let shard = sample("--index 1200 --count 35 --jsonl");
    assert_eq!(shard.lines().last(), first.strip_suffix('\n'));
}

#[test]
fn folder_of_worlds_has_exactly_one_file_each() {
    let folder = scratch();
    succeed_in(folder.path(), "sample get_to_goal#soft --count 3 -o worlds");
    let mut names: Vec<_> = std::fs::read_dir(folder.path().join("worlds"))
        .expect("the folder was created")
        .map(|entry| entry.expect("the folder can be listed").file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["00000000.json", "00000001.json", "00000002.json"]);
}

#[test]
fn render_draws_an_l2explorer_map() {
    let Some(map) = reference("l2explorer/map_findobjects_0.json") else {
        return;
    };
    let folder = scratch();
    let picture = folder.path().join("map.png");
    succeed(&format!(
        "render {} --l2explorer --size 64 -o {}",
        map.display(),
        picture.display()
    ));
    let bytes = std::fs::read(&picture).expect("the picture was written");
    assert_eq!(&bytes[1..4], b"PNG");
}

#[test]
fn sheet_shows_variants_or_a_scenarios_variants() {
    let folder = scratch();
    let path = folder.path().join("sheet.svg");
    let drawn = |what: &str| {
        succeed(&format!("sheet {what} --size 80 -o {}", path.display()));
        std::fs::read_to_string(&path).expect("the picture was written")
    };
    let svg = drawn("find_objects#red get_to_goal#soft");
    assert!(
        svg.contains(">find_objects#red</text>") && svg.contains(">get_to_goal#soft</text>"),
        "titles are text"
    );
    assert_eq!(svg.matches("<image ").count(), 4, "two views and two maps");
    let svg = drawn("--scenario examples/curricula/reward.json --columns 1");
    assert_eq!(svg.matches("<image ").count(), 8, "four variants");
    assert!(
        svg.contains(" ([-10, 10, -10, -10]).</text>"),
        "differing values are listed, and bracketed values are complete"
    );
}

#[test]
fn photographs_match_their_manifest() {
    let folder = scratch();
    let world = folder.path().join("world.json");
    let text_of_world = r#"{ "image_params": { "yaw_subdivisions": 3, "vertical_subdivisions": 2 },
        "objects": [{ "class": "../../out", "coordinates": [0, 0] }, { "class": "Car", "coordinates": [9, 9] }] }"#;
    std::fs::write(&world, text_of_world).expect("the scratch folder can be written");
    let out = folder.path().join("deep/photographs");
    let stdout = succeed(&format!(
        "photograph {} -o {} --modalities rgb,depth",
        world.display(),
        out.display()
    ));
    stdout.says("2 objects in 24 pictures of 84 × 84 pixels");
    let manifest = std::fs::read_to_string(out.join("manifest.json")).expect("the manifest was written");
    let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("the manifest is JSON");
    let listed = manifest["photographs"].as_array().expect("it lists photographs");
    assert_eq!(listed.len(), 24);
    for entry in listed {
        let file = entry["file"].as_str().expect("each has its file");
        assert!(!file.contains("..") && out.join(file).is_file(), "{file}");
    }
    assert_eq!(manifest["classes"]["Car"], 6);
    assert_eq!(listed[12]["file"], "001_car_1/yaw_000_up_00_rgb.png");
    let inside = std::fs::read_dir(folder.path().join("deep"))
        .expect("the folder exists")
        .count();
    assert_eq!(inside, 1, "nothing was written beside the folder");
}

#[test]
fn matrix_is_the_same_in_every_format_and_gives_the_same_order() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    let ends = ["--start", "find_objects#red", "--end", "find_objects#blue"];
    let plain = succeed(&[&["order", "find_objects"][..], &ends].concat());
    for name in ["matrix.csv", "matrix.json"] {
        let path = at(name);
        succeed(&["order", "find_objects", "--matrix", text(&path)]);
        let reread = succeed(&[&["order", "--from-matrix", text(&path)][..], &ends].concat());
        // The measure of a matrix from a file is unknown.
        assert_eq!(reread, plain.replace(" by parameters", ""), "{name}");
    }
    let picture = at("path.png");
    succeed(&["order", "find_objects", "--plot", text(&picture)]);
    assert!(std::fs::metadata(&picture).is_ok_and(|file| file.len() > 5_000));
    let compared = succeed(&["order", "find_objects", "--compare", "--target-step", "0.1"]);
    for method in "nearest exact two-opt abrupt farthest target-step given".split(' ') {
        assert!(compared.contains(&format!("\n{method} ")), "{compared}");
    }
}

#[test]
fn from_variants_to_scores_step_by_step() {
    let folder = scratch();
    let here = |line: &str| succeed_in(folder.path(), line);
    here("distance find_objects#blue find_objects#dusk --explain");
    here("order find_objects --json");
    here("curriculum find_objects#blue find_objects#red -o scenario.json --learn 2 --evaluate-with 1 --seed 3");
    here("validate scenario.json");
    here("run scenario.json --agent random --output log");
    let metrics: serde_json::Value = serde_json::from_str(&here("metrics log --json")).expect("--json prints JSON");
    assert_eq!(metrics["num_lx"], 4);
}

#[test]
fn shards_together_equal_a_single_run() {
    let sample = |more: &str| succeed(&format!("sample get_to_goal#soft --seed 3 --count 100 --jsonl {more}"));
    let parts = ["1/3", "2/3", "3/3"].map(|part| sample(&format!("--shard {part}")));
    assert_eq!(parts.concat(), sample(""));
}

#[test]
fn drift_leads_from_one_variant_to_the_other() {
    let drift = succeed("sample find_objects#blue --drift-to red --count 11 --schedule cosine --seed 7 --jsonl");
    let worlds: Vec<&str> = drift.lines().collect();
    let alone = |variant: &str, index: &str| {
        succeed(&["sample", variant, "--seed", "7", "--index", index])
            .trim_end()
            .to_owned()
    };
    assert_eq!(worlds[0], alone("find_objects#blue", "0"));
    assert_eq!(worlds[10], alone("find_objects#red", "10"));
    let middle: serde_json::Value = serde_json::from_str(worlds[5]).expect("a world is JSON");
    let red = middle["objects"][0]["color"][0].as_f64().expect("colours are numbers");
    assert!((0.3..0.8).contains(&red), "between blue and red: {red}");
}

#[test]
fn variant_is_found_at_a_distance_and_can_be_pasted() {
    let found = json("vary find_objects#red --element R --distance 0.5 --json");
    let expected = serde_json::json!({ "extends": "red", "target_reward": 0.0 });
    assert_eq!(found["variant"]["found"], expected);
}

#[test]
fn found_variant_is_appended_to_its_task() {
    let folder = scratch();
    let path = folder.path();
    let command = "vary find_objects#red --element O --distance 0.5 -o mine.json";
    let stdout = succeed_in(path, command);
    assert!(stdout.contains("\nholds: "), "unchanged values are printed:\n{stdout}");
    let distance = json_in(path, "distance mine.json#red mine.json#found --json").to_string();
    assert!(distance.contains("0.5") || distance.contains("0.4999"), "{distance}");
    let error = fail_in(path, 1, command);
    error.says("found a file, expected none");
    error.says("--force");
    succeed_in(path, &format!("{command} --force"));
}

#[test]
fn family_of_variants_has_one_name() {
    let order = succeed(&["order", "examples/tasks/settlement.json#looks", "--json"]);
    for member in ["looks-red-annulus0", "looks-gold-gaussian1"] {
        assert!(order.contains(member), "{order}");
    }
    let table = succeed(&["tasks", "show", "examples/tasks/settlement.json"]);
    table.says("woods-20");
    table.says("von_mises(mean 0, kappa 2)");
}

#[test]
fn l2explorer_maps_can_be_used_in_worlds() {
    let Some(maps) = reference("l2explorer/predefined_maps.json") else {
        return;
    };
    let world = succeed(&["convert", "examples/tasks/settlement.json#near", "--maps", text(&maps)]);
    assert!(world.contains("map_regions"), "the world contains the map");
    succeed(&["validate", text(&maps)]);
}

/// Renaming a result over a device would replace the device; over a link, the link.
#[cfg(unix)]
#[test]
fn devices_and_links_are_kept() {
    use std::os::unix::fs::FileTypeExt;
    let sample = |to: &str| succeed(&format!("sample find_objects#red --seed 7 -o {to}"));
    let printed = sample("-");

    // With `output()`, standard output is a pipe.
    assert_eq!(sample("/dev/stdout"), printed);
    sample("/dev/null");
    let null = std::fs::metadata("/dev/null").expect("every unix has one");
    assert!(null.file_type().is_char_device());

    let folder = scratch();
    let (file, link) = (folder.path().join("world.json"), folder.path().join("latest.json"));
    std::fs::write(&file, "").expect("the folder is writable");
    std::os::unix::fs::symlink(&file, &link).expect("the folder is writable");
    sample(text(&link));
    assert!(link.is_symlink());
    let written = std::fs::read_to_string(&file).expect("the link points to this file");
    assert_eq!(written, printed);
}
