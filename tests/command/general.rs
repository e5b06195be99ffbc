//! The `driftworld` command as its users meet it: output, exit codes, messages, files that are whole or absent.

use super::terminal::{driftworld, fail, output, reference, scratch, succeed, text};

#[test]
fn every_subcommand_has_help_with_an_example() {
    let all = succeed(&["--help"]);
    for name in [
        "demo",
        "tasks",
        "validate",
        "sample",
        "vary",
        "convert",
        "render",
        "sheet",
        "assets",
        "photograph",
        "console",
        "elements",
        "distance",
        "order",
        "curriculum",
        "run",
        "logs",
        "metrics",
        "report",
        "transfer-report",
        "schema",
        "completions",
        "bench",
        "doctor",
    ] {
        assert!(all.contains(&format!("  {name} ")), "{name} is listed");
        let help = succeed(&[name, "--help"]);
        assert!(help.contains("Example"), "{name} shows an example:\n{help}");
    }
}

#[test]
fn the_doctor_says_what_draws_here() {
    assert!(succeed(&["doctor"]).contains("cpu   works: processor ("));
    let report: serde_json::Value = serde_json::from_str(&succeed(&["doctor", "--json"])).expect("JSON");
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
        assert!(
            error.contains("--features gpu") && error.contains("driftworld doctor"),
            "{error}"
        );
    }
    assert!(fail(2, &["render", "find_objects", "--renderer", "crayon"]).contains("expected cpu, gpu or auto"));
}

#[test]
fn usage_errors_exit_with_2() {
    fail(2, &["sampel"]);
    fail(2, &["sample"]);
    fail(2, &["sample", "find_objects", "--count", "0"]);
    assert!(fail(2, &["sample", "find_objects", "--count", "3"]).contains("--jsonl"));
    fail(2, &["schema"]);
}

#[test]
fn validate_accepts_the_examples_and_the_maps_of_the_original() {
    let said = succeed(&["validate", "examples/tasks"]);
    assert_eq!(said.lines().count(), 7, "{said}");
    assert_eq!(succeed(&["validate", "examples/curricula"]).lines().count(), 11);
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
fn a_trailing_comma_is_refused_with_line_and_column() {
    let folder = scratch();
    let path = folder.path().join("world.json");
    std::fs::write(&path, "{\n  \"max_steps\": 3,\n}\n").expect("the scratch folder can be written");
    let error = fail(1, &["validate", text(&path)]);
    assert!(
        error.contains("world.json:3:1: not valid JSON: trailing comma"),
        "{error}"
    );
    let json = output(&mut driftworld(&["validate", "--json", text(&path)]));
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).expect("--json prints JSON also for bad files");
    assert_eq!(json[0]["valid"], false);
}

#[test]
fn a_world_has_the_same_bytes_alone_again_and_in_a_stream() {
    let alone = [
        "sample",
        "find_objects#red",
        "--seed",
        "7",
        "--index",
        "1234",
        "-o",
        "-",
    ];
    let first = succeed(&alone);
    assert_eq!(first, succeed(&alone));
    let stream = succeed(&[
        "sample",
        "find_objects#red",
        "--seed",
        "7",
        "--count",
        "1235",
        "--jsonl",
    ]);
    assert_eq!(stream.lines().count(), 1235);
    assert_eq!(stream.lines().last(), first.strip_suffix('\n'));
    let shard = [
        "sample",
        "find_objects#red",
        "--seed",
        "7",
        "--index",
        "1200",
        "--count",
        "35",
        "--jsonl",
    ];
    assert_eq!(succeed(&shard).lines().last(), first.strip_suffix('\n'));
}

#[test]
fn outputs_are_whole_files_or_none() {
    let folder = scratch();
    let worlds = folder.path().join("worlds");
    succeed(&["sample", "get_to_goal#soft", "--count", "3", "-o", text(&worlds)]);
    let mut names: Vec<_> = std::fs::read_dir(&worlds)
        .expect("the folder was made")
        .map(|entry| entry.expect("the folder can be listed").file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["00000000.json", "00000001.json", "00000002.json"],
        "and no temporary file is left"
    );
    let blocked = folder.path().join("blocked");
    std::fs::write(&blocked, "a file where a folder is wanted").expect("the scratch folder can be written");
    let error = fail(1, &["sample", "find_objects", "-o", text(&blocked.join("world.json"))]);
    assert!(error.contains("cannot be written"), "{error}");
}

#[test]
fn unknown_names_are_answered_with_those_there_are() {
    let error = fail(1, &["sample", "find_objects#rde"]);
    assert!(
        error.contains("expected one of blue, red, green") && error.contains("did you mean \"red\"?"),
        "{error}"
    );
    let error = fail(1, &["tasks", "show", "find_object"]);
    assert!(error.contains("did you mean \"find_objects\"?"), "{error}");
}

#[test]
fn a_group_that_cannot_be_placed_says_which_and_what_to_loosen() {
    let folder = scratch();
    let path = folder.path().join("crowd.json");
    let spec = r#"{ "name": "crowd", "world": { "environment_params": { "map_size": [10, 10] } },
        "groups": [{ "name": "crowd", "count": 100, "object": { "class": "cube" },
                     "placement": { "box": { "low": [-5, -5], "high": [5, 5] } }, "separation": 3 }] }"#;
    std::fs::write(&path, spec).expect("the scratch folder can be written");
    let error = fail(1, &["sample", text(&path)]);
    assert!(error.contains("crowd") && error.contains("separation"), "{error}");
}

#[test]
fn render_draws_a_map_of_the_original() {
    let Some(map) = reference("l2explorer/map_findobjects_0.json") else {
        return;
    };
    let folder = scratch();
    let picture = folder.path().join("map.png");
    succeed(&[
        "render",
        text(&map),
        "--l2explorer",
        "--size",
        "64",
        "-o",
        text(&picture),
    ]);
    let bytes = std::fs::read(&picture).expect("the picture was written");
    assert_eq!(&bytes[1..4], b"PNG");
}

#[test]
fn a_sheet_shows_variants_or_what_a_scenario_learns() {
    let folder = scratch();
    let path = folder.path().join("sheet.svg");
    let small = ["--size", "80", "-o", text(&path)];
    let drawn = || std::fs::read_to_string(&path).expect("the picture was written");
    succeed(&[&["sheet", "find_objects#red", "get_to_goal#soft"], &small[..]].concat());
    let svg = drawn();
    assert!(
        svg.contains(">find_objects#red</text>") && svg.contains(">get_to_goal#soft</text>"),
        "titles are text"
    );
    assert_eq!(svg.matches("<image ").count(), 4, "two views and two maps");
    let scenario = [
        "sheet",
        "--scenario",
        "examples/curricula/reward.json",
        "--columns",
        "1",
    ];
    succeed(&[&scenario[..], &small[..]].concat());
    let svg = drawn();
    assert_eq!(svg.matches("<image ").count(), 8, "four variants");
    assert!(
        svg.contains(" ([-10, 10, -10, -10]).</text>"),
        "values that differ are said, and those in brackets are whole"
    );
    let error = fail(
        1,
        &["sheet", "find_objects", "get_to_goal", "select_object", "moving_object"],
    );
    assert!(error.contains("expected 1 to 60"), "{error}");
    fail(
        2,
        &["sheet", "find_objects", "--scenario", "examples/curricula/reward.json"],
    );
}

#[test]
fn photographs_are_where_their_manifest_says() {
    let folder = scratch();
    let world = folder.path().join("world.json");
    let text_of_world = r#"{ "image_params": { "yaw_subdivisions": 3, "vertical_subdivisions": 2 },
        "objects": [{ "class": "../../out", "coordinates": [0, 0] }, { "class": "Car", "coordinates": [9, 9] }] }"#;
    std::fs::write(&world, text_of_world).expect("the scratch folder can be written");
    let out = folder.path().join("deep/photographs");
    let said = succeed(&[
        "photograph",
        text(&world),
        "-o",
        text(&out),
        "--modalities",
        "rgb,depth",
    ]);
    assert!(said.contains("2 objects in 24 pictures of 84 × 84 pixels"), "{said}");
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
        .expect("the folder is there")
        .count();
    assert_eq!(inside, 1, "nothing was written beside the folder");
    assert!(fail(2, &["photograph", "find_objects", "--modalities", "smell"]).contains("possible values"));
}

#[test]
fn a_matrix_is_the_same_in_every_file_and_gives_the_same_order() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    let ends = ["--start", "find_objects#red", "--end", "find_objects#blue"];
    let plain = succeed(&[&["order", "find_objects"][..], &ends].concat());
    for name in ["matrix.csv", "matrix.json"] {
        let path = at(name);
        succeed(&["order", "find_objects", "--matrix", text(&path)]);
        let again = succeed(&[&["order", "--from-matrix", text(&path)][..], &ends].concat());
        // Where a matrix came from, nobody knows by what it was measured.
        assert_eq!(again, plain.replace(" by parameters", ""), "{name}");
    }
    let picture = at("path.png");
    succeed(&["order", "find_objects", "--plot", text(&picture)]);
    assert!(std::fs::metadata(&picture).is_ok_and(|file| file.len() > 5_000));
    let compared = succeed(&["order", "find_objects", "--compare", "--target-step", "0.1"]);
    for method in [
        "nearest",
        "exact",
        "two-opt",
        "abrupt",
        "farthest",
        "target-step",
        "given",
    ] {
        assert!(compared.contains(&format!("\n{method} ")), "{compared}");
    }

    let refused = fail(2, &["order", "find_objects", "--matrix", text(&at("matrix.txt"))]);
    assert!(refused.contains("ends in .csv or .json"), "{refused}");
    std::fs::write(at("broken.csv"), ",a,b\na,0,1\nb,2,0\n").expect("the scratch folder can be written");
    let refused = fail(1, &["order", "--from-matrix", text(&at("broken.csv"))]);
    assert!(
        refused.contains("broken.csv: matrix, distance of \"a\" to \"b\": found 1 there and 2 back"),
        "{refused}"
    );
    assert!(fail(2, &["order", "find_objects", "--order", "target-step"]).contains("--target-step"));
    assert!(fail(2, &["order", "find_objects", "--order", "shortest"]).contains("two-opt"));
    assert!(
        fail(1, &["order", "find_objects", "--end", "pink"])
            .contains("--end: found \"pink\", expected one of find_objects#")
    );
    fail(2, &["order"]);
}

#[test]
fn from_variants_to_scores_step_by_step() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    succeed(&["distance", "find_objects#blue", "find_objects#dusk", "--explain"]);
    succeed(&["order", "find_objects", "--json"]);
    let scenario = at("scenario.json");
    let few = ["--learn", "2", "--evaluate-with", "1", "--seed", "3"];
    let names = [
        "curriculum",
        "find_objects#blue",
        "find_objects#red",
        "-o",
        text(&scenario),
    ];
    succeed(&[&names[..], &few[..]].concat());
    succeed(&["validate", text(&scenario)]);
    let log = at("log");
    succeed(&["run", text(&scenario), "--agent", "random", "--output", text(&log)]);
    let metrics = succeed(&["metrics", text(&log), "--json"]);
    let metrics: serde_json::Value = serde_json::from_str(&metrics).expect("--json prints JSON");
    assert_eq!(metrics["num_lx"], 4);
    let again = fail(
        1,
        &["run", text(&scenario), "--agent", "random", "--output", text(&log)],
    );
    assert!(again.contains("--output"), "a log is not written over: {again}");
}

#[test]
fn shards_put_together_are_what_one_run_gives() {
    let sample =
        |more: &[&str]| succeed(&[&["sample", "get_to_goal#soft", "--seed", "3", "--count", "100"], more].concat());
    let whole = sample(&["--jsonl"]);
    let parts: String = ["1/3", "2/3", "3/3"]
        .map(|part| sample(&["--jsonl", "--shard", part]))
        .concat();
    assert_eq!(parts, whole);
    let error = fail(2, &["sample", "find_objects", "--count", "3", "--shard", "4/3"]);
    assert!(error.contains("counted from 1, such as 1/4"), "{error}");
    fail(2, &["sample", "find_objects", "--shard", "1/3"]);
}

#[test]
fn a_drift_leads_from_one_variant_to_the_other() {
    let drift = succeed(&[
        "sample",
        "find_objects#blue",
        "--drift-to",
        "red",
        "--count",
        "11",
        "--schedule",
        "cosine",
        "--seed",
        "7",
        "--jsonl",
    ]);
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
    let error = fail(
        1,
        &[
            "sample",
            "find_objects#blue",
            "--drift-to",
            "get_to_goal#soft",
            "--count",
            "3",
            "--jsonl",
        ],
    );
    assert!(error.contains("two variants of one task"), "{error}");
    fail(
        2,
        &[
            "sample",
            "find_objects#blue",
            "--drift-to",
            "red",
            "--count",
            "3",
            "--schedule",
            "wave",
        ],
    );
}

#[test]
fn a_variant_is_found_at_a_distance_and_what_is_printed_can_be_pasted() {
    let found = succeed(&[
        "vary",
        "find_objects#red",
        "--element",
        "R",
        "--distance",
        "0.5",
        "--json",
    ]);
    let found: serde_json::Value = serde_json::from_str(&found).expect("--json prints JSON");
    assert_eq!(
        found["variant"]["found"],
        serde_json::json!({ "extends": "red", "target_reward": 0.0 })
    );
    let settled = "examples/tasks/settlement.json#near";
    let error = fail(1, &["vary", settled, "--element", "T", "--distance", "0.5"]);
    assert!(error.contains("affect T alone"), "{error}");
}

#[test]
fn what_nothing_reads_is_no_answer() {
    let asked = [
        "vary",
        "find_objects#blue",
        "--element",
        "T",
        "--distance",
        "0.5",
        "--json",
    ];
    let found: serde_json::Value = serde_json::from_str(&succeed(&asked)).expect("--json prints JSON");
    let changes = found["variant"]["found"].as_object().expect("values by name");
    let is_range = changes.get("trigger").is_some_and(|trigger| trigger == "AgentInRange");
    assert!(is_range || !changes.contains_key("reach"), "{found}");
    assert!(
        found["held"].as_object().is_some_and(|held| !held.is_empty()),
        "{found}"
    );
}

#[test]
fn a_found_variant_is_appended_to_its_task() {
    let folder = scratch();
    let path = folder.path().join("mine.json");
    let path = path.to_str().expect("scratch folders have plain names");
    let asked = [
        "vary",
        "find_objects#red",
        "--element",
        "O",
        "--distance",
        "0.5",
        "-o",
        path,
    ];
    let told = succeed(&asked);
    assert!(told.contains("\nholds: "), "what stays is printed:\n{told}");
    let distance: serde_json::Value = serde_json::from_str(&succeed(&[
        "distance",
        &format!("{path}#red"),
        &format!("{path}#found"),
        "--json",
    ]))
    .expect("--json prints JSON");
    assert!(
        distance.to_string().contains("0.5") || distance.to_string().contains("0.4999"),
        "{distance}"
    );
    let error = fail(1, &asked);
    assert!(
        error.contains("found a file, expected none") && error.contains("--force"),
        "{error}"
    );
    succeed(&[&asked[..], &["--force"]].concat());
    let error = fail(2, &["vary", "find_objects#red", "--element", "O", "--distance", "-1"]);
    assert!(error.contains("expected a number, 0 or more"), "{error}");
}

#[test]
fn a_variant_that_is_found_has_a_name_of_its_own_that_is_one() {
    let vary = |name: &str| {
        let distance = ["vary", "find_objects#red", "--element", "R", "--distance", "0.5"];
        fail(2, &[&distance[..], &["--name", name]].concat())
    };
    // Under the name that it extends it would extend itself.
    for taken in ["red", "blue", "default"] {
        let error = vary(taken);
        assert!(error.contains("expected a name that no variant has"), "{error}");
    }
    for odd in ["a/b", "..", "con", "extends itself", "\u{202e}"] {
        let error = vary(odd);
        assert!(error.contains("found the name"), "{error}");
    }
    let error = fail(2, &["curriculum", "find_objects", "--name", "a/b"]);
    assert!(error.contains("with the character \"/\""), "{error}");
}

#[test]
fn a_family_of_variants_is_named_as_one() {
    let order = succeed(&["order", "examples/tasks/settlement.json#looks", "--json"]);
    for member in ["looks-red-annulus0", "looks-gold-gaussian1"] {
        assert!(order.contains(member), "{order}");
    }
    let table = succeed(&["tasks", "show", "examples/tasks/settlement.json"]);
    assert!(
        table.contains("woods-20") && table.contains("von_mises(mean 0, kappa 2)"),
        "{table}"
    );
}

#[test]
fn maps_of_the_original_go_into_worlds() {
    let Some(maps) = reference("l2explorer/predefined_maps.json") else {
        return;
    };
    let world = succeed(&["convert", "examples/tasks/settlement.json#near", "--maps", text(&maps)]);
    assert!(world.contains("map_regions"), "the world carries the map");
    succeed(&["validate", text(&maps)]);
}

#[test]
fn devices_and_links_stay_what_they_are() {
    use std::os::unix::fs::FileTypeExt;
    let sample = ["sample", "find_objects#red", "--seed", "7", "-o"];
    let printed = succeed(&[&sample[..], &["-"]].concat());

    // Under `output()` standard output is a pipe.
    assert_eq!(succeed(&[&sample[..], &["/dev/stdout"]].concat()), printed);
    succeed(&[&sample[..], &["/dev/null"]].concat());
    let null = std::fs::metadata("/dev/null").expect("every unix has one");
    assert!(null.file_type().is_char_device());

    let folder = scratch();
    let (file, link) = (folder.path().join("world.json"), folder.path().join("latest.json"));
    std::fs::write(&file, "").expect("the folder is ours");
    std::os::unix::fs::symlink(&file, &link).expect("the folder is ours");
    succeed(&[&sample[..], &[text(&link)]].concat());
    assert!(link.is_symlink());
    let written = std::fs::read_to_string(&file).expect("the link led here");
    assert_eq!(written, printed);
}
