//! `driftworld curriculum` as its users meet it: probes with their proof, forms, drifts, even steps, controls, pictures, errors.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::LazyLock;

use driftworld::design::{DEFAULT_STEPS, DEFAULT_TOLERANCE};
use serde_json::Value;

use super::terminal::{driftworld, fail, output, scratch, text};

/// A task that stays as it is when the built-in ones grow.
static PARK: LazyLock<String> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("park.json");
    let task = r#"{ "version": 2, "name": "park", "parameters": {
        "color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["blue", "red", "green"], "default": "blue" },
        "reward": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 },
        "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 },
        "spread": { "role": "variant", "type": "number", "affects": ["S"], "range": [2, 40], "default": 20 } },
      "variants": { "blue": {}, "red": { "color": "red" }, "green": { "color": "green" }, "dusk": { "extends": "red", "light": 0.6 },
        "huddle": { "spread": 6 }, "penalty": { "extends": "red", "reward": -100 } } }"#;
    // Tests run in processes of their own: one must not read what another is writing.
    let mut file = tempfile::NamedTempFile::new_in(folder).expect("cargo has made the folder");
    file.write_all(task.as_bytes()).expect("there is room for a task");
    file.persist(&path).expect("a file can be put in place of another");
    text(&path).to_owned()
});

/// The park, or one of its variants: `#red`.
fn park(variant: &str) -> &'static str {
    format!("{}{variant}", *PARK).leak()
}

/// `driftworld curriculum` with these arguments, to its end.
fn curriculum(arguments: &[&str]) -> Output {
    output(driftworld(&["curriculum"]).args(arguments))
}

/// What it says when it ends with this exit code.
#[track_caller]
fn refused(code: i32, arguments: &[&str]) -> String {
    fail(code, &[&["curriculum"], arguments].concat())
}

/// The scenario on standard output, and what is said beside it.
#[track_caller]
fn designed(arguments: &[&str]) -> (Value, String) {
    let output = curriculum(arguments);
    let beside = String::from_utf8(output.stderr).expect("the command prints UTF-8");
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {beside}");
    let scenario =
        serde_json::from_slice(&output.stdout).expect("a scenario is JSON, and nothing else is printed with it");
    (scenario, beside)
}

fn read(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("a scenario is JSON")
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().expect("the document has a list there")
}

/// The regimes of the learning blocks, or of the others.
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

/// The cells of the rows of a table below the line that begins with `heading`.
fn rows(beside: &str, heading: &str) -> Vec<Vec<String>> {
    let below = beside
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
fn a_probe_of_each_element_proves_that_nothing_else_differs() {
    for (element, column) in [("state", 2), ("reward", 5), ("observation", 6)] {
        let (scenario, beside) = designed(&[park(""), "--probe", element]);
        let rows = rows(&beside, "variant");
        assert!(rows.len() >= 4, "{beside}");
        assert!(
            rows[0][0].ends_with("#blue"),
            "the default variant comes first: {beside}"
        );
        for (index, row) in rows.iter().enumerate() {
            for (place, cell) in row.iter().enumerate().skip(2) {
                let expected_zero = place != column || index == 0;
                assert_eq!(cell == "0" || cell == "-", expected_zero, "{beside}");
            }
        }
        let distances: Vec<f64> = rows.iter().map(|row| row[column].parse().expect("a number")).collect();
        assert!(distances.is_sorted(), "outward is by growing distance: {distances:?}");
        let shown: Vec<String> = rows
            .iter()
            .filter_map(|row| Some(row[0].rsplit_once('#')?.1.to_owned()))
            .collect();
        assert_eq!(learned(&scenario), shown);
        for row in rows.iter().filter(|row| row[1] == "made") {
            assert!(
                beside.contains(&format!("\n{} sets ", row[0])),
                "its values are printed: {beside}"
            );
        }
    }
}

#[test]
fn every_element_of_the_five_tasks_can_be_probed() {
    for task in [
        "find_objects",
        "get_to_goal",
        "select_object",
        "moving_object",
        "scavenger_hunt",
    ] {
        for (place, element) in ["state", "action", "transition", "reward", "observation"]
            .iter()
            .enumerate()
        {
            let (_, beside) = designed(&[task, "--probe", element, "--variants", "5"]);
            let rows = rows(&beside, "variant");
            assert_eq!(rows.len(), 5, "{beside}");
            for row in &rows[1..] {
                let others = (2..7).filter(|column| *column != place + 2);
                assert!(
                    others
                        .into_iter()
                        .all(|column| row[column] == "0" || row[column] == "-"),
                    "{beside}"
                );
                assert!(row[place + 2].parse::<f64>().is_ok_and(|apart| apart > 0.0), "{beside}");
            }
        }
    }
}

#[test]
fn what_a_probe_makes_is_in_the_scenario_and_as_far_as_the_table_says() {
    let folder = scratch();
    let path = folder.path().join("reward.json");
    let said = curriculum(&[park(""), "--probe", "reward", "--variants", "5", "-o", text(&path)]);
    assert_eq!(said.status.code(), Some(0));
    let table = String::from_utf8(said.stdout).expect("the command prints UTF-8");
    let scenario = read(&path);
    let first = &regimes(&scenario, "learning")[0];
    assert_eq!((name(first).as_str(), first.get("values")), ("blue", None));
    for (row, regime) in rows(&table, "variant").iter().zip(regimes(&scenario, "learning")) {
        let pays = regime["values"]["reward"].as_f64().unwrap_or(100.0);
        let shown: f64 = row[5].parse().expect("a number");
        assert!((shown - (100.0 - pays) / 200.0).abs() < 1e-4, "{row:?}: {pays}");
        assert_eq!(row[1] == "made", regime.get("values").is_some());
    }
}

#[test]
fn orders_differ_and_controls_are_matched_in_everything_else() {
    let folder = scratch();
    let design = |order: &str| {
        let (scenario, _) = designed(&[park(""), "--probe", "reward", "--order", order, "--seed", "4"]);
        learned(&scenario)
    };
    let orders = ["outward", "abrupt", "path", "farthest"].map(design);
    assert!(orders.iter().all(|order| order[0] == "blue"));
    assert_ne!(orders[0], orders[1]);
    assert_ne!(orders[0], orders[3]);
    let at = |name: &str| folder.path().join(name);
    let controls = at("controls");
    let main = at("main.json");
    let status = curriculum(&[
        park(""),
        "--probe",
        "reward",
        "--name",
        "pay",
        "--controls",
        text(&controls),
        "-o",
        text(&main),
    ]);
    assert_eq!(status.status.code(), Some(0));
    let main = read(&main);
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
        let control = read(&controls.join(format!("pay-{kind}.json")));
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
fn controls_learn_as_often_and_before_deployment_the_same() {
    let folder = scratch();
    let main = folder.path().join("main.json");
    let controls = folder.path().join("controls");
    let said = curriculum(&[
        park("#blue"),
        park("#red"),
        park("#dusk"),
        "--blocks",
        "5",
        "--pre-deployment",
        "4",
        "--controls",
        text(&controls),
        "-o",
        text(&main),
    ]);
    assert_eq!(said.status.code(), Some(0));
    let table = String::from_utf8(said.stdout).expect("the command prints UTF-8");
    let main = read(&main);
    let worlds = |scenario: &Value| {
        let mut worlds: Vec<String> = regimes(scenario, "learning").iter().map(ToString::to_string).collect();
        worlds.sort();
        worlds
    };
    for kind in ["reversed", "random", "contrast"] {
        let control = read(&controls.join(format!("curriculum-{kind}.json")));
        assert_eq!(worlds(&control), worlds(&main), "{kind}");
        assert_eq!(control["blocks"][0], main["blocks"][0]);
        let written = learned(&control)[1..].join(", ");
        assert!(
            table.contains(&format!("curriculum-{kind}.json ({written}; length")),
            "{table}"
        );
    }
    let permuted = refused(2, &[park(""), "--form", "permuted", "--controls", text(&controls)]);
    assert!(permuted.contains("leave one of them out"), "{permuted}");
}

#[test]
fn experts_of_two_tasks_are_written_side_by_side() {
    let folder = scratch();
    let output = curriculum(&[
        "find_objects#dusk",
        "get_to_goal#dusk",
        "--form",
        "expert",
        "-o",
        text(folder.path()),
    ]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for task in ["find_objects", "get_to_goal"] {
        let expert = read(&folder.path().join(format!("curriculum-{task}-dusk.json")));
        assert!(regimes(&expert, "learning").iter().all(|regime| regime["task"] == task));
    }
}

#[test]
fn a_probe_ends_where_it_is_asked_to() {
    let (scenario, _) = designed(&[park(""), "--probe", "observation", "--end", park("#blue")]);
    assert_eq!(learned(&scenario).last().map(String::as_str), Some("blue"));
    let error = refused(1, &[park(""), "--probe", "observation", "--end", park("#bleu")]);
    assert!(error.contains("--end: found"), "{error}");
    for wanted in ["0", "1", "201"] {
        let error = refused(1, &[park(""), "--probe", "reward", "--variants", wanted]);
        assert!(error.contains("variants wanted, expected 2 to 200"), "{error}");
    }
}

#[test]
fn evaluation_never_draws_what_is_learned_and_stands_where_it_is_wanted() {
    let three = [park("#blue"), park("#red"), park("#green"), "--order", "given"];
    let with = |more: &[&str]| designed(&[&three[..], more].concat()).0;
    assert_eq!(kinds(&with(&[])), "ELELELE");
    assert_eq!(kinds(&with(&["--evaluate", "ends", "--pre-deployment", "7"])), "PELLLE");
    let places = with(&["--evaluate-after", "0,2", "--eval-episodes", "3", "--seed", "6"]);
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
    assert!(
        refused(1, &[&three[..], &["--evaluate-after", "4"]].concat())
            .contains("after learning block 4, expected 0 to 3")
    );
}

#[test]
fn the_forms_arrange_the_blocks_and_say_so() {
    let two = [park("#blue"), park("#red"), "--order", "given", "--form"];
    let with = |form: &str, more: &[&str]| designed(&[&two[..], &[form], more].concat()).0;
    let condensed = with("condensed", &[]);
    assert_eq!(
        (learned(&condensed).join(" "), &condensed["form"]),
        ("blue red".into(), &Value::from("condensed"))
    );
    assert_eq!(learned(&with("dispersed", &[])).join(" "), "blue red blue red blue red");
    assert_eq!(
        learned(&with("alternating", &["--blocks", "3"])).join(" "),
        "blue red blue"
    );
    assert_eq!(
        learned(&with("custom", &["--blocks", "5"])).join(" "),
        "blue red blue red blue"
    );
    let indices = |scenario: &Value| -> Vec<String> {
        regimes(scenario, "learning")
            .iter()
            .map(|regime| regime["first_index"].to_string())
            .collect()
    };
    assert_eq!(
        indices(&with("dispersed", &["--learn", "10"])),
        ["0", "100000000000", "10", "100000000010", "20", "100000000020"]
    );
    assert_eq!(
        indices(&with("dispersed", &["--learn", "10", "--paired-learning"])),
        ["0", "0", "10", "10", "20", "20"]
    );
    assert_eq!(with("condensed", &["--task-label", "info"])["task_label"], "info");

    let folder = scratch();
    let several = |arguments: &[&str], file: &str| {
        let output = folder.path().join("several");
        let output = curriculum(&[&[park(""), "--force", "-o", text(&output)], arguments].concat());
        assert_eq!(
            output.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        read(&folder.path().join("several").join(file))
    };
    let expert = several(&["--form", "expert", "--name", "alone"], "alone-dusk.json");
    assert_eq!(
        (learned(&expert).join(" "), &expert["form"]),
        ("dusk".into(), &Value::from("expert"))
    );
    let lifetimes = ["--form", "permuted", "--lifetimes", "3"];
    let orders =
        ["curriculum-1.json", "curriculum-2.json", "curriculum-3.json"].map(|file| learned(&several(&lifetimes, file)));
    assert!(orders[0] != orders[1] || orders[1] != orders[2], "{orders:?}");
}

#[test]
fn lifetimes_have_their_own_worlds_and_experts_what_their_lifetime_has() {
    let folder = scratch();
    let into = |name: &str| folder.path().join(name);
    let (lifetimes, experts) = (into("lifetimes"), into("experts"));
    let arguments = [
        "--hold-out",
        park("#dusk"),
        "--learn",
        "4",
        "--form",
        "dispersed",
        "--lifetimes",
        "2",
    ];
    let folders = ["--experts", text(&experts), "-o", text(&lifetimes)];
    let two = [park("#blue"), park("#red"), park("#dusk")];
    let output = curriculum(&[&two[..], &arguments, &folders].concat());
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let lives = ["curriculum-1", "curriculum-2"].map(|name| read(&lifetimes.join(format!("{name}.json"))));
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
    let red = read(&experts.join("curriculum-2-red.json"));
    assert_eq!(learned(&red), ["red"; 3]);
    assert!(worlds(&lives[1], "learning").is_superset(&worlds(&red, "learning")));
    assert!(worlds(&lives[1], "evaluation").is_superset(&worlds(&red, "evaluation")));
    assert!(
        !experts.join("curriculum-1-dusk.json").exists(),
        "what is not learned has no expert"
    );
}

#[test]
fn drifts_lead_from_variant_to_variant_across_blocks() {
    let drift = |more: &[&str]| {
        let two = [park("#blue"), park("#dusk"), "--order", "given", "--drift", "cosine"];
        let (scenario, _) = designed(&[&two[..], more].concat());
        let said = |regime: &&Value| {
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
        regimes(&scenario, "learning").iter().map(said).collect::<Vec<_>>()
    };
    assert_eq!(drift(&[]), ["blue>dusk 0-1"]);
    assert_eq!(drift(&["--blocks", "2"]), ["blue>dusk 0-0.5", "blue>dusk 0.5-1"]);
    let error = refused(1, &[park("#blue"), "get_to_goal#plain", "--drift", "linear"]);
    assert!(error.contains("expected two variants of one task"), "{error}");
}

#[test]
fn even_steps_are_made_and_proven_or_it_is_said_how_far_they_reach() {
    let steps = [
        park("#blue"),
        "--probe",
        "reward",
        "--step-distance",
        "0.2",
        "--tolerance",
        "0.01",
    ];
    let (scenario, beside) = designed(&[&steps[..], &["--steps", "5"]].concat());
    let rows = rows(&beside, "variant");
    assert_eq!(rows.len(), 6, "{beside}");
    for row in &rows[1..] {
        let reward: f64 = row[5].parse().expect("a number");
        assert!((reward - 0.2).abs() <= 0.01, "{beside}");
        assert!(
            [2, 3, 4, 6]
                .iter()
                .all(|place| row[*place] == "0" || row[*place] == "-"),
            "{beside}"
        );
    }
    assert_eq!(learned(&scenario).len(), 6);
    let error = refused(1, &[&steps[..], &["--steps", "6"]].concat());
    assert!(
        error.contains("found at most 5 of 0.2 ± 0.01, expected 6; the farthest variant is 1.0000 away"),
        "{error}"
    );
    let whole = [
        park(""),
        "--step-distance",
        "0.05",
        "--tolerance",
        "0.005",
        "--steps",
        "6",
    ];
    assert_eq!(learned(&designed(&whole).0).len(), 7);
}

#[test]
fn a_scenario_is_drawn_as_bars_over_its_experiences() {
    let folder = scratch();
    let picture = folder.path().join("timeline.png");
    designed(&[park(""), "--probe", "reward", "--plot", text(&picture)]);
    let bytes = std::fs::read(&picture).expect("the picture was written");
    assert!(
        bytes.starts_with(b"\x89PNG") && bytes.len() > 4000,
        "{} bytes",
        bytes.len()
    );
}

#[test]
fn a_scenario_is_validated_against_the_tasks_it_names() {
    let folder = scratch();
    let path = folder.path().join("scenario.json");
    let validate = |regime: &str| {
        let text = format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#);
        std::fs::write(&path, text).expect("the folder can be written to");
        let output = Command::new(env!("CARGO_BIN_EXE_driftworld"))
            .arg("validate")
            .arg(&path)
            .output();
        let output = output.expect("the command was built by cargo and starts");
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    let (code, said) =
        validate(r#"{ "task": "find_objects", "variant": "blue", "drift": { "to": "duks" }, "count": 1 }"#);
    assert_eq!(code, Some(1));
    assert!(
        said.contains("(/blocks/0/regimes/0/drift/to): found \"duks\"") && said.contains("did you mean \"dusk\"?"),
        "{said}"
    );
    let (code, said) = validate(r#"{ "task": "elsewhere.json", "variant": "blue", "count": 1 }"#);
    assert_eq!(code, Some(0));
    assert!(
        said.contains("the variants of elsewhere.json were not checked"),
        "{said}"
    );
}

#[test]
fn what_is_asked_for_wrongly_is_answered_with_what_is_possible() {
    let none = refused(1, &[park(""), "--probe", "transition"]);
    assert!(
        none.contains("park#blue: found no parameters that affect T alone"),
        "{none}"
    );
    let few = refused(1, &[park(""), "--probe", "reward", "--start", park("#bleu")]);
    assert!(few.contains(&format!("expected one of {}", park("#blue"))), "{few}");
    let mixed = refused(1, &[park(""), "get_to_goal", "--probe", "reward"]);
    assert!(mixed.contains("measure within a task"), "{mixed}");
    let word = refused(2, &[park(""), "--probe", "colour"]);
    assert!(
        word.contains("expected state, action, transition, reward or observation"),
        "{word}"
    );
    let form = refused(1, &[park(""), "--form", "alternating"]);
    assert!(
        form.contains("the form alternating: found 6 variants, expected 2 variants"),
        "{form}"
    );
    assert!(refused(2, &[park(""), "--form", "expert"]).contains("--output"));
    for option in ["--lifetimes", "--experts"] {
        let both = refused(2, &[park(""), "--form", "expert", option, "2"]);
        assert!(both.contains(&format!("{option}: found with --form expert")), "{both}");
    }
    assert!(refused(1, &[park(""), "--hold-out", park("")]).contains("found every variant held out"));
    assert!(refused(2, &[park(""), "--steps", "3"]).contains("--step-distance"));
    let both = refused(2, &[park(""), "--order", "path", "--order", "exact"]);
    assert!(both.contains("cannot be used multiple times"), "{both}");
    let long = refused(2, &[park(""), "--lifetimes", "0", "--form", "permuted"]);
    assert!(
        long.contains("--lifetimes: found 0, expected a whole number in 1..=10000"),
        "{long}"
    );
    assert!(refused(1, &[park(""), "--blocks", "0"]).contains("expected 1 to 10000"));
    assert!(refused(1, &[park(""), "--step-distance", "2"]).contains("a distance above 0 and at most 1"));
}

#[test]
fn help_states_the_defaults_of_the_library() {
    let help = String::from_utf8(curriculum(&["--help"]).stdout).expect("help is text");
    for default in [DEFAULT_TOLERANCE.to_string(), DEFAULT_STEPS.to_string()] {
        assert!(
            help.contains(&format!("distance [default: {default}]"))
                || help.contains(&format!("variants [default: {default}]")),
            "{default}: {help}"
        );
    }
}
