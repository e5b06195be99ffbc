//! `driftworld curriculum`: probes and the distances that prove them, forms, drifts, even steps, controls, pictures, errors.

use std::path::Path;

use driftworld::design::{DEFAULT_STEPS, DEFAULT_TOLERANCE};
use serde_json::Value;

use super::refused::PARK;
use super::run_files::write;
use super::terminal::{Says, driftworld_in, fail_in, output, read, scratch, succeed, succeed_in};
use crate::tier::quick_or_full;

/// A folder with `park.json`.
fn with_park() -> tempfile::TempDir {
    let folder = scratch();
    write(&folder.path().join("park.json"), PARK);
    folder
}

/// The scenario printed by `driftworld curriculum`, and standard error.
#[track_caller]
fn designed(arguments: &str) -> (Value, String) {
    let folder = with_park();
    let output = output(&mut driftworld_in(folder.path(), &format!("curriculum {arguments}")));
    let stderr = String::from_utf8(output.stderr).expect("the command prints UTF-8");
    assert_eq!(output.status.code(), Some(0), "{arguments}: {stderr}");
    let scenario =
        serde_json::from_slice(&output.stdout).expect("a scenario is JSON, and nothing else is printed with it");
    (scenario, stderr)
}

fn scenario(path: &Path) -> Value {
    serde_json::from_str(&read(path)).expect("a scenario is JSON")
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().expect("the document has a list there")
}

/// The regimes of the learning blocks, or of the evaluation blocks.
fn regimes<'a>(scenario: &'a Value, kind: &str) -> Vec<&'a Value> {
    let blocks = list(&scenario["blocks"]).iter().filter(|block| block["type"] == kind);
    blocks.flat_map(|block| list(&block["regimes"])).collect()
}

fn name(regime: &Value) -> String {
    let name = regime.get("name").unwrap_or(&regime["variant"]);
    name.as_str().expect("names are texts").to_owned()
}

fn learned(scenario: &Value) -> Vec<String> {
    regimes(scenario, "learning").into_iter().map(name).collect()
}

/// One letter for each block.
fn kinds(scenario: &Value) -> String {
    let letter = |block: &Value| match (block["phase"].as_str(), block["type"].as_str()) {
        (Some("pre_deployment"), _) => 'P',
        (_, Some("learning")) => 'L',
        _ => 'E',
    };
    list(&scenario["blocks"]).iter().map(letter).collect()
}

/// The cells of a table's rows below the line that begins with `heading`.
fn rows(stderr: &str, heading: &str) -> Vec<Vec<String>> {
    let below = stderr
        .lines()
        .skip_while(|line| !line.trim_start().starts_with(heading));
    let cells = |line: &str| line.split_whitespace().map(str::to_owned).collect();
    below
        .skip(1)
        .take_while(|line| !line.trim().is_empty())
        .map(cells)
        .collect()
}

#[test]
fn probe_of_each_element_proves_that_nothing_else_differs() {
    for (element, column) in [("state", 2), ("reward", 5), ("observation", 6)] {
        let (scenario, stderr) = designed(&format!("park.json --probe {element}"));
        let rows = rows(&stderr, "variant");
        assert!(rows.len() >= 4, "{stderr}");
        assert!(
            rows[0][0].ends_with("#blue"),
            "the default variant comes first: {stderr}"
        );
        for (index, row) in rows.iter().enumerate() {
            for (cell_column, cell) in row.iter().enumerate().skip(2) {
                let expected_zero = cell_column != column || index == 0;
                assert_eq!(cell == "0" || cell == "-", expected_zero, "{stderr}");
            }
        }
        let distances: Vec<f64> = rows.iter().map(|row| row[column].parse().expect("a number")).collect();
        assert!(distances.is_sorted(), "outward means growing distance: {distances:?}");
        let shown: Vec<String> = rows
            .iter()
            .filter_map(|row| Some(row[0].rsplit_once('#')?.1.to_owned()))
            .collect();
        assert_eq!(learned(&scenario), shown);
        for row in rows.iter().filter(|row| row[1] == "made") {
            assert!(
                stderr.contains(&format!("\n{} sets ", row[0])),
                "its values are printed: {stderr}"
            );
        }
    }
}

#[test]
fn every_element_of_the_five_tasks_can_be_probed() {
    let elements = ["state", "action", "transition", "reward", "observation"];
    for (number, task) in crate::looks_alone::TASKS.split(' ').enumerate() {
        for (own_column, element) in elements.into_iter().enumerate() {
            // The quick tier tests each task and each element once.
            if quick_or_full(own_column != number, false) {
                continue;
            }
            let (_, stderr) = designed(&format!("{task} --probe {element} --variants 5"));
            let rows = rows(&stderr, "variant");
            assert_eq!(rows.len(), 5, "{stderr}");
            for row in &rows[1..] {
                for (column, cell) in row[2..7].iter().enumerate() {
                    if column == own_column {
                        assert!(cell.parse::<f64>().is_ok_and(|distance| distance > 0.0), "{stderr}");
                    } else {
                        assert!(cell == "0" || cell == "-", "{stderr}");
                    }
                }
            }
        }
    }
}

#[test]
fn generated_variants_are_in_the_scenario_at_the_stated_distances() {
    let folder = with_park();
    let table = succeed_in(
        folder.path(),
        "curriculum park.json --probe reward --variants 5 -o reward.json",
    );
    table.says("distance in reward from the last learned");
    let scenario = scenario(&folder.path().join("reward.json"));
    let first = &regimes(&scenario, "learning")[0];
    assert_eq!((name(first).as_str(), first.get("values")), ("blue", None));
    for (row, regime) in rows(&table, "variant").iter().zip(regimes(&scenario, "learning")) {
        let pays = regime["values"]["reward"].as_f64().unwrap_or(100.0);
        let shown: f64 = row[5].parse().expect("it is a number");
        assert!((shown - (100.0 - pays) / 200.0).abs() < 1e-4, "{row:?}: {pays}");
        assert_eq!(row[1] == "made", regime.get("values").is_some());
    }
}

#[test]
fn orders_differ_and_controls_match_in_everything_else() {
    let folder = with_park();
    let design = |order: &str| {
        let (scenario, _) = designed(&format!("park.json --probe reward --order {order} --seed 4"));
        learned(&scenario)
    };
    let orders = ["outward", "abrupt", "path", "farthest"].map(design);
    assert!(orders.iter().all(|order| order[0] == "blue"));
    assert_ne!(orders[0], orders[1]);
    assert_ne!(orders[0], orders[3]);
    succeed_in(
        folder.path(),
        "curriculum park.json --probe reward --name pay --controls controls -o main.json",
    );
    let main = scenario(&folder.path().join("main.json"));
    let worlds = |scenario: &Value| {
        let of = |regime: &&Value| {
            format!(
                "{} {} {} {}",
                name(regime),
                regime["count"],
                regime["seed"],
                regime["first_index"]
            )
        };
        let mut worlds: Vec<String> = regimes(scenario, "learning").iter().map(of).collect();
        worlds.sort();
        worlds
    };
    for kind in ["reversed", "random", "contrast"] {
        let control = scenario(&folder.path().join(format!("controls/pay-{kind}.json")));
        assert_eq!(control["name"], format!("pay-{kind}"));
        assert_eq!(worlds(&control), worlds(&main), "{kind}");
        assert_eq!(kinds(&control), kinds(&main));
        if kind == "reversed" {
            let mut order = learned(&control);
            order.reverse();
            assert_eq!(order, learned(&main));
        }
    }
}

#[test]
fn controls_learn_equally_often_with_equal_pre_deployment() {
    let folder = with_park();
    let design = "curriculum park.json#blue red dusk --blocks 5 --pre-deployment 4 --controls controls -o main.json";
    let table = succeed_in(folder.path(), design);
    let main = scenario(&folder.path().join("main.json"));
    let worlds = |scenario: &Value| {
        let mut worlds: Vec<String> = regimes(scenario, "learning").iter().map(ToString::to_string).collect();
        worlds.sort();
        worlds
    };
    for kind in ["reversed", "random", "contrast"] {
        let control = scenario(&folder.path().join(format!("controls/curriculum-{kind}.json")));
        assert_eq!(worlds(&control), worlds(&main), "{kind}");
        assert_eq!(control["blocks"][0], main["blocks"][0]);
        let written = learned(&control)[1..].join(", ");
        assert!(
            table.contains(&format!("curriculum-{kind}.json ({written}; length")),
            "{table}"
        );
    }
}

#[test]
fn experts_of_two_tasks_are_written_side_by_side() {
    let folder = scratch();
    succeed_in(
        folder.path(),
        "curriculum find_objects#dusk get_to_goal#dusk --form expert -o .",
    );
    for task in ["find_objects", "get_to_goal"] {
        let expert = scenario(&folder.path().join(format!("curriculum-{task}-dusk.json")));
        assert!(regimes(&expert, "learning").iter().all(|regime| regime["task"] == task));
    }
}

#[test]
fn probe_ends_at_the_requested_variant() {
    let (scenario, _) = designed("park.json --probe observation --end park.json#blue");
    assert_eq!(learned(&scenario).last().map(String::as_str), Some("blue"));
}

#[test]
fn evaluation_worlds_are_separate_and_blocks_are_placed_as_requested() {
    let with = |more: &str| designed(&format!("park.json#blue red green --order given {more}")).0;
    assert_eq!(kinds(&with("")), "ELELELE");
    assert_eq!(kinds(&with("--evaluate ends --pre-deployment 7")), "PELLLE");
    let places = with("--evaluate-after 0,2 --eval-episodes 3 --seed 6");
    assert_eq!(kinds(&places), "ELLEL");
    let seeds = |kind: &str| {
        regimes(&places, kind)
            .iter()
            .map(|r| r["seed"].to_string())
            .collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!((seeds("learning").len(), seeds("evaluation").len()), (1, 1));
    assert!(seeds("learning").is_disjoint(&seeds("evaluation")));
    assert!(regimes(&places, "evaluation").iter().all(|regime| regime["count"] == 3));
}

#[test]
fn forms_arrange_the_blocks_and_say_so() {
    let with = |form: &str| designed(&format!("park.json#blue red --order given --form {form}")).0;
    let condensed = with("condensed");
    assert_eq!(
        (learned(&condensed).join(" "), &condensed["form"]),
        ("blue red".into(), &Value::from("condensed"))
    );
    assert_eq!(learned(&with("dispersed")).join(" "), "blue red blue red blue red");
    assert_eq!(learned(&with("alternating --blocks 3")).join(" "), "blue red blue");
    assert_eq!(learned(&with("custom --blocks 5")).join(" "), "blue red blue red blue");
    let indices = |scenario: &Value| -> Vec<String> {
        regimes(scenario, "learning")
            .iter()
            .map(|regime| regime["first_index"].to_string())
            .collect()
    };
    assert_eq!(
        indices(&with("dispersed --learn 10")),
        ["0", "100000000000", "10", "100000000010", "20", "100000000020"]
    );
    assert_eq!(
        indices(&with("dispersed --learn 10 --paired-learning")),
        ["0", "0", "10", "10", "20", "20"]
    );
    assert_eq!(with("condensed --task-label info")["task_label"], "info");

    let folder = with_park();
    let several = |arguments: &str, file: &str| {
        succeed_in(
            folder.path(),
            &format!("curriculum park.json --force -o several {arguments}"),
        );
        scenario(&folder.path().join("several").join(file))
    };
    let expert = several("--form expert --name alone", "alone-dusk.json");
    assert_eq!(
        (learned(&expert).join(" "), &expert["form"]),
        ("dusk".into(), &Value::from("expert"))
    );
    let lifetimes = |number: u32| {
        let file = format!("curriculum-{number}.json");
        learned(&several("--form permuted --lifetimes 3", &file))
    };
    let orders = [1, 2, 3].map(lifetimes);
    assert!(orders[0] != orders[1] || orders[1] != orders[2], "{orders:?}");
}

#[test]
fn lifetimes_have_their_own_worlds_and_matching_experts() {
    let folder = with_park();
    let design = "curriculum park.json#blue red dusk --hold-out dusk --learn 4 --form dispersed --lifetimes 2 \
                  --experts experts -o lifetimes";
    succeed_in(folder.path(), design);
    let (lifetimes, experts) = (folder.path().join("lifetimes"), folder.path().join("experts"));
    let lives = ["curriculum-1", "curriculum-2"].map(|name| scenario(&lifetimes.join(format!("{name}.json"))));
    let worlds = |scenario: &Value, kind: &str| -> std::collections::BTreeSet<String> {
        let world = |regime: &&Value| format!("{} {} {}", name(regime), regime["seed"], regime["first_index"]);
        regimes(scenario, kind).iter().map(world).collect()
    };
    for kind in ["learning", "evaluation"] {
        assert!(worlds(&lives[0], kind).is_disjoint(&worlds(&lives[1], kind)), "{kind}");
    }
    assert!(!learned(&lives[0]).contains(&"dusk".to_owned()));
    assert!(
        regimes(&lives[0], "evaluation")
            .iter()
            .any(|regime| name(regime) == "dusk")
    );
    let red = scenario(&experts.join("curriculum-2-red.json"));
    assert_eq!(learned(&red), ["red"; 3]);
    assert!(worlds(&lives[1], "learning").is_superset(&worlds(&red, "learning")));
    assert!(worlds(&lives[1], "evaluation").is_superset(&worlds(&red, "evaluation")));
    assert!(
        !experts.join("curriculum-1-dusk.json").exists(),
        "a held-out variant has no expert"
    );
}

#[test]
fn drifts_lead_from_variant_to_variant_across_blocks() {
    let drift = |more: &str| {
        let (scenario, _) = designed(&format!("park.json#blue dusk --order given --drift cosine {more}"));
        let describe = |regime: &&Value| {
            let drift = &regime["drift"];
            let or = |key: &str, default: f64| drift[key].as_f64().unwrap_or(default);
            assert_eq!(drift["schedule"], "cosine");
            let (from, until) = (or("from", 0.0), or("until", 1.0));
            format!(
                "{}>{} {from}-{until}",
                name(regime),
                drift["to"].as_str().unwrap_or_default()
            )
        };
        regimes(&scenario, "learning").iter().map(describe).collect::<Vec<_>>()
    };
    assert_eq!(drift(""), ["blue>dusk 0-1"]);
    assert_eq!(drift("--blocks 2"), ["blue>dusk 0-0.5", "blue>dusk 0.5-1"]);
}

#[test]
fn even_steps_are_generated_and_proven_or_the_reachable_distance_is_reported() {
    let steps = "park.json#blue --probe reward --step-distance 0.2 --tolerance 0.01 --steps";
    let (scenario, stderr) = designed(&format!("{steps} 5"));
    let rows = rows(&stderr, "variant");
    assert_eq!(rows.len(), 6, "{stderr}");
    for row in &rows[1..] {
        let reward: f64 = row[5].parse().expect("it is a number");
        assert!((reward - 0.2).abs() <= 0.01, "{stderr}");
        assert!(
            [2, 3, 4, 6]
                .iter()
                .all(|column| row[*column] == "0" || row[*column] == "-"),
            "{stderr}"
        );
    }
    assert_eq!(learned(&scenario).len(), 6);
    let error = fail_in(with_park().path(), 1, &format!("curriculum {steps} 6"));
    error.says("found at most 5 steps of 0.2 ± 0.01, expected 6; the farthest variant is 1.0000 away");
    let (whole, _) = designed("park.json --step-distance 0.05 --tolerance 0.005 --steps 6");
    assert_eq!(learned(&whole).len(), 7);
}

#[test]
fn scenario_is_drawn_as_bars_over_its_experiences() {
    let folder = with_park();
    succeed_in(
        folder.path(),
        "curriculum park.json --probe reward --plot timeline.png -o s.json",
    );
    let bytes = std::fs::read(folder.path().join("timeline.png")).expect("the picture was written");
    assert!(
        bytes.starts_with(b"\x89PNG") && bytes.len() > 4000,
        "{} bytes",
        bytes.len()
    );
}

#[test]
fn scenario_is_validated_against_its_tasks() {
    let folder = scratch();
    let validate = |regime: &str| {
        let text = format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#);
        write(&folder.path().join("scenario.json"), &text);
        let output = output(&mut driftworld_in(folder.path(), "validate scenario.json"));
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    let (code, stderr) =
        validate(r#"{ "task": "find_objects", "variant": "blue", "drift": { "to": "duks" }, "count": 1 }"#);
    assert_eq!(code, Some(1));
    stderr.says("(/blocks/0/regimes/0/drift/to): found \"duks\"");
    stderr.says("did you mean \"dusk\"?");
    let (code, stderr) = validate(r#"{ "task": "elsewhere.json", "variant": "blue", "count": 1 }"#);
    let expected = "the variants of elsewhere.json were not checked";
    assert!(code == Some(1) && stderr.contains(expected), "{stderr}");
}

#[test]
fn help_shows_the_library_defaults() {
    let help = succeed("curriculum --help");
    for default in [DEFAULT_TOLERANCE.to_string(), DEFAULT_STEPS.to_string()] {
        assert!(
            help.contains(&format!("distance [default: {default}]"))
                || help.contains(&format!("variants [default: {default}]")),
            "{default}: {help}"
        );
    }
}

#[test]
fn lifetimes_have_different_orders_unless_one_was_chosen() {
    let orders = |arguments: &str| -> Vec<String> {
        let folder = with_park();
        let design = "curriculum select_object --learn 2 --eval-episodes 1 --worlds 0 --lifetimes 4 -o lives";
        succeed_in(folder.path(), &format!("{design} {arguments}"));
        let order = |number: u32| {
            let path = std::fs::read_dir(folder.path().join("lives")).expect("it was written");
            let paths = path.map(|entry| entry.expect("it can be listed").path());
            let ending = format!("-{number}.json");
            let path = paths.into_iter().find(|path| path.to_string_lossy().ends_with(&ending));
            let life = scenario(&path.expect("each lifetime has a file"));
            let blocks = list(&life["blocks"]).iter().filter(|block| block["type"] == "learning");
            blocks.map(|block| block["regimes"][0]["variant"].to_string()).collect()
        };
        (1..=4).map(order).collect()
    };
    let distinct = |orders: Vec<String>| orders.into_iter().collect::<std::collections::BTreeSet<_>>().len();
    assert_eq!(distinct(orders("")), 4);
    assert_eq!(distinct(orders("--form permuted")), 4);
    assert_eq!(distinct(orders("--order named")), 1);
}

/// The shared library counts requests to sync to disk.
#[test]
#[cfg(target_os = "linux")]
fn audit_syncs_nothing_and_fails_if_it_cannot_test() {
    let folder = scratch();
    let source = "#include <fcntl.h>\n#include <stdlib.h>\n#include <unistd.h>\n\
        static int note(void) { int f = open(getenv(\"SYNCED\"), O_WRONLY | O_APPEND | O_CREAT, 0600);\n\
        if (write(f, \"s\", 1) < 0) abort(); return close(f); }\n\
        int fsync(int f) { (void)f; return note(); }\nint fdatasync(int f) { (void)f; return note(); }\n";
    write(&folder.path().join("count.c"), source);
    let mut cc = std::process::Command::new("cc");
    cc.args(["-shared", "-fPIC", "-o", "count.so", "count.c"])
        .current_dir(folder.path());
    assert!(output(&mut cc).status.success());
    let synced = |arguments: &str, code: i32| {
        let mut command = driftworld_in(folder.path(), arguments);
        let (library, notes) = (folder.path().join("count.so"), folder.path().join("synced"));
        let run = output(command.env("LD_PRELOAD", library).env("SYNCED", &notes));
        let text = String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(code), "{arguments}: {text}");
        let count = std::fs::metadata(&notes).map_or(0, |found| found.len());
        std::fs::remove_file(&notes).ok();
        (count, text)
    };
    let design = "curriculum find_objects#blue find_objects#red --learn 4 --eval-episodes 2 -o";
    assert!(
        synced(&format!("{design} one.json"), 0).0 > 0,
        "written files are synced to disk"
    );
    assert!(synced(&format!("{design} drift.json --drift linear"), 0).0 > 0);
    let (count, text) = synced("audit drift.json --lifetimes 2 --repeats 2", 1);
    assert_eq!(count, 0, "{text}");
    text.says("not tested");
    text.says("not tested is not passed");
}
