//! Tests of recorded episodes, replays and films: `run --record`, `replay`, `film`.

use std::fs;
use std::path::Path;

use super::run_files::{files, write};
use super::terminal::{Says, driftworld_in, fail, fail_in, output, read, root, scratch, succeed, succeed_in, text};

/// A lifetime of 3 blocks and 14 experiences in two tasks, the last block shuffled.
fn scenario(folder: &Path) -> std::path::PathBuf {
    scenario_with(folder, "examples/worlds/key_corridor.json")
}

/// The same with a different second task, which must have a variant `red`.
fn scenario_with(folder: &Path, second: &str) -> std::path::PathBuf {
    let path = folder.join("scenario.json");
    let regime = |task: &str, variant: &str, count: u32| {
        format!(r#"{{ "task": "{task}", "variant": "{variant}", "count": {count}, "seed": 5, "max_steps": 30 }}"#)
    };
    let (red, doors) = (regime("find_objects", "red", 3), regime(second, "red", 2));
    let drift = r#"{ "task": "find_objects", "variant": "red", "drift": { "to": "blue" }, "count": 4, "seed": 1, "max_steps": 25 }"#;
    let text = format!(
        r#"{{ "name": "watched", "blocks": [
            {{ "type": "evaluation", "regimes": [{red}, {doors}] }},
            {{ "type": "learning", "regimes": [{drift}] }},
            {{ "type": "evaluation", "mix": "shuffled", "regimes": [{red}, {doors}] }} ] }}"#
    );
    write(&path, &text);
    path
}

/// The log's file of recordings for a block.
fn recordings(log: &Path, block: &str) -> std::path::PathBuf {
    log.join("worker-default").join(block).join("actions.jsonl")
}

#[test]
fn recorded_run_is_unchanged_and_each_episode_can_be_replayed() {
    let folder = scratch();
    let scenario = scenario(folder.path());
    let (plain, kept) = (folder.path().join("plain"), folder.path().join("kept"));
    for agent in ["random", "onrails", "sarsa"] {
        let run = |log: &Path, more: &[&str]| {
            succeed(
                &[
                    &[
                        "run",
                        text(&scenario),
                        "--agent",
                        agent,
                        "--json",
                        "--output",
                        text(log),
                    ],
                    more,
                ]
                .concat(),
            )
        };
        assert_eq!(run(&plain, &[]), run(&kept, &["--record", "--jobs", "2"]), "{agent}");
        let mut found = files(&kept);
        found.retain(|name, _| !name.ends_with("actions.jsonl"));
        assert_eq!(found, files(&plain), "{agent}: recording changes no row");
        let stdout = succeed(&["replay", text(&kept)]);
        assert!(
            stdout.contains("14 episodes of") && stdout.ends_with("replay as recorded\n"),
            "{stdout}"
        );
        fs::remove_dir_all(&plain).unwrap();
        fs::remove_dir_all(&kept).unwrap();
    }
}

#[test]
fn killed_recorded_run_resumes_and_keeps_every_byte() {
    let folder = scratch();
    let scenario = scenario_with(folder.path(), "find_objects");
    let whole = folder.path().join("whole");
    let all = ["run", text(&scenario), "--agent", "random"];
    succeed(&[&all[..], &["--record", "--output", text(&whole)]].concat());
    let expected = files(&whole);
    // A killed run may leave a complete or partial recording of the next experience, but no row for it.
    let table = |log: &Path, block: &str| log.join("worker-default").join(block).join("data-log.tsv");
    for (rows, cut) in [(0, 3), (2, 700), (5, 0)] {
        let log = folder.path().join(format!("killed-{rows}-{cut}"));
        succeed(&[&all[..], &["--record", "--output", text(&log)]].concat());
        for block in ["1-train", "2-test"] {
            fs::remove_dir_all(log.join("worker-default").join(block)).unwrap();
        }
        let rows_kept = fs::read_to_string(table(&log, "0-test")).unwrap();
        let rows_kept = rows_kept.split_inclusive('\n').take(1 + rows).collect::<String>();
        fs::write(table(&log, "0-test"), rows_kept).unwrap();
        let done = fs::read(recordings(&log, "0-test")).unwrap();
        fs::write(recordings(&log, "0-test"), &done[..done.len() - cut]).unwrap();
        // A log that was started with `--record` keeps recording even if it is resumed without the option.
        succeed(&[&all[..], &["--resume", "--output", text(&log)]].concat());
        assert_eq!(files(&log), expected, "{rows} rows, cut by {cut} bytes");
    }
    // The next block has just started.
    let log = folder.path().join("begun");
    succeed(&[&all[..], &["--record", "--output", text(&log)]].concat());
    fs::remove_dir_all(log.join("worker-default/2-test")).unwrap();
    fs::remove_file(table(&log, "1-train")).unwrap();
    fs::write(recordings(&log, "1-train"), "{\"recording_fo").unwrap();
    succeed(&[&all[..], &["--resume", "--output", text(&log)]].concat());
    assert_eq!(files(&log), expected);
}

#[test]
fn log_without_recordings_gets_them_from_then_on() {
    let folder = scratch();
    let scenario = scenario_with(folder.path(), "find_objects");
    let log = folder.path().join("log");
    let all = ["run", text(&scenario), "--agent", "random", "--output", text(&log)];
    succeed(&all);
    for block in ["1-train", "2-test"] {
        fs::remove_dir_all(log.join("worker-default").join(block)).unwrap();
    }
    let none = fail(1, &["replay", text(&log)]);
    assert!(none.contains("run with --record"), "{none}");
    succeed(&[&all[..], &["--resume", "--record"]].concat());
    let stdout = succeed(&["replay", text(&log)]);
    stdout.says("9 episodes of");
    stdout.says("; 5 were not recorded");
    let error = fail(1, &["replay", text(&log), "--episode", "4"]);
    assert!(error.contains("no recording of episode 4"), "{error}");
}

#[test]
fn damaged_recording_is_located_and_others_are_readable() {
    let folder = scratch();
    let scenario = scenario_with(folder.path(), "find_objects");
    let log = folder.path().join("log");
    succeed(&format!(
        "run {} --agent random --output {} --record",
        scenario.display(),
        log.display()
    ));
    let path = recordings(&log, "0-test");
    let whole = fs::read_to_string(&path).unwrap();
    // The line of the first episode: after the header and its world.
    let damaged = whole.replacen("\"experience\":0", "\"experience\":7", 1);
    fs::write(&path, damaged).unwrap();
    let error = fail(1, &["replay", text(&log), "--episode", "0"]);
    assert!(error.contains("actions.jsonl: line 3: found the checksum"), "{error}");
    succeed(&["replay", text(&log), "--episode", "1"]);
    let error = fail(1, &["replay", text(&log)]);
    assert!(error.contains("13 episodes replay as recorded, 1 do not"), "{error}");
    fs::write(&path, &whole[..whole.len() - 20]).unwrap();
    let error = fail(1, &["replay", text(&log), "--episode", "4"]);
    assert!(error.contains("found the end of the file"), "{error}");
    succeed(&["replay", text(&log), "--episode", "3"]);
    // Rows that contradict the recording.
    fs::write(&path, &whole).unwrap();
    let table = log.join("worker-default/0-test/data-log.tsv");
    let rows = fs::read_to_string(&table).unwrap();
    let steps = rows
        .lines()
        .nth(1)
        .unwrap()
        .split('\t')
        .position(|cell| cell == "30.0")
        .expect("30 steps");
    let changed: Vec<String> = (rows.lines().enumerate())
        .map(|(number, line)| {
            let cell = |(place, cell): (usize, &str)| {
                if number == 1 && place == steps {
                    "29.0".to_owned()
                } else {
                    cell.to_owned()
                }
            };
            line.split('\t').enumerate().map(cell).collect::<Vec<_>>().join("\t")
        })
        .collect();
    fs::write(&table, changed.join("\n") + "\n").unwrap();
    let error = fail(1, &["replay", text(&log), "--episode", "0"]);
    error.says("experience 0, steps: found 30 in its recording, expected 29");
}

#[test]
fn episode_becomes_a_film_or_a_sheet() {
    let folder = scratch();
    scenario_with(folder.path(), "find_objects");
    succeed_in(folder.path(), "run scenario.json --agent random --output log --record");
    let at = |name: &str| folder.path().join(name);
    let first_bytes = |name: &str| fs::read(at(name)).unwrap()[..4].to_vec();
    let replay = |name: &str, more: &str| {
        let line = format!("replay log --episode 1 -o {name} {more}");
        succeed_in(folder.path(), &line)
    };
    let stdout = replay("e.gif", "--size 48");
    stdout.says("episode 1: find_objects#red, world 1 under seed 5: 30 steps");
    assert!(stdout.contains(": 31 frames of 96 × 48 pixels, 4.0 s"), "{stdout}");
    let stdout = replay("wide.gif", "--size 50 --every 30");
    assert!(stdout.contains(": 2 frames of 100 × 83 pixels"), "{stdout}");
    assert_eq!(first_bytes("e.gif"), b"GIF8");
    let stdout = replay(
        "e.apng",
        "--size 48 --view agent --no-captions --every 7 --fps 4 --modality depth",
    );
    assert!(stdout.contains(": 6 frames of 48 × 48 pixels, 2.2 s"), "{stdout}");
    assert_eq!(&first_bytes("e.apng")[1..], b"PNG");
    let stdout = replay("e.png", "--size 48 --json");
    stdout.says("\"frames\": 12");
    stdout.says("\"width\": 96");
    let stdout = replay("e.png", "--size 48 --view above");
    stdout.says(": 12 frames of 48 × 48 pixels, on a sheet of ");
    assert_eq!(&first_bytes("e.png")[1..], b"PNG");
    // Drawing again gives the same bytes.
    let before = fs::read(at("e.gif")).unwrap();
    replay("e.gif", "--size 48");
    assert!(fs::read(at("e.gif")).unwrap() == before);
    let error = fail_in(folder.path(), 2, "replay log --episode 1 -o e.mp4");
    error.says("expected .gif or .apng");
    error.says("ffmpeg -i");
    assert!(!at("e.mp4").exists());
    let error = fail_in(folder.path(), 1, "replay log --episode 99");
    error.says("found no episode 99, expected one of episodes 0 to 13");
}

/// A drawing of an episode depends on the options, not on the file's extension: different options give different pictures,
/// equal ones equal pictures.
#[test]
fn each_view_and_modality_gives_a_different_picture() {
    let folder = scratch();
    let kept = folder.path().join("kept.jsonl");
    let first = folder.path().join("first.png");
    let agent = ["film", "find_objects#red", "--max-steps", "9", "--size", "24", "-o"];
    succeed(&[&agent[..], &[text(&first), "--record", text(&kept)]].concat());
    for ending in ["png", "gif", "apng"] {
        let mut drawn: Vec<(String, Vec<u8>)> = Vec::new();
        for (view, modalities) in [
            ("agent", &["rgb", "depth", "segmentation"][..]),
            ("above", &["rgb"]),
            ("both", &["rgb", "depth", "segmentation"]),
        ] {
            for modality in modalities {
                let file = folder.path().join(format!("{view}-{modality}.{ending}"));
                let replay = || {
                    let options = ["--episode", "0", "--size", "24", "--view", view, "--modality", modality];
                    succeed(&[&["replay", text(&kept)], &options[..], &["-o", text(&file)]].concat());
                    fs::read(&file).unwrap()
                };
                let bytes = replay();
                assert!(
                    view != "both" || bytes == replay(),
                    "{modality} {ending}: another picture the second time"
                );
                for (other, theirs) in &drawn {
                    assert!(&bytes != theirs, "{ending}: {view} {modality} equals {other}");
                }
                drawn.push((format!("{view} {modality}"), bytes));
            }
        }
        let refused = folder.path().join(format!("refused.{ending}"));
        let wrong = ["--view", "above", "--modality", "depth", "-o", text(&refused)];
        for command in [
            &["replay", text(&kept), "--episode", "0"][..],
            &["film", "find_objects"],
        ] {
            let error = fail(2, &[command, &wrong].concat());
            error.says("--modality: found depth for the view from above");
            assert!(!refused.exists());
        }
    }
}

#[test]
fn agent_is_filmed_and_recorded() {
    let folder = scratch();
    let world = root().join("examples/worlds/key_corridor.json");
    let film = "--size 32 --every 20 -o";
    let line = format!(
        "film {}#red --agent onrails {film} a.gif --record a.jsonl",
        world.display()
    );
    let stdout = succeed_in(folder.path(), &line);
    assert!(stdout.contains("wrote ") && stdout.contains("a.jsonl"), "{stdout}");
    succeed_in(folder.path(), &format!("replay a.jsonl --episode 0 {film} b.gif"));
    let [film, replayed] = ["a.gif", "b.gif"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(film == replayed, "the same film");
}

/// Every episode names its world, whether its variant was named or not, or the world came from a file.
#[test]
fn world_of_an_episode_is_named() {
    let folder = scratch();
    let world = folder.path().join("meadow.json");
    write(&world, r#"{ "agent_params": { "observation_size": 8 } }"#);
    let sheet = folder.path().join("sheet.png");
    for (name, message) in [
        (
            "moving_object",
            "onrails in moving_object#default, world 0 under seed 0: 2 steps",
        ),
        (
            "moving_object#fast",
            "onrails in moving_object#fast, world 0 under seed 0: 2 steps",
        ),
        (text(&world), "meadow.json: 2 steps"),
    ] {
        let arguments = ["film", name, "--max-steps", "2", "--size", "16", "-o", text(&sheet)];
        let found = succeed(&arguments);
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn commands_of_the_page_work() {
    let page = read(root().join("docs/watch.md"));
    let folder = scratch();
    let commands: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("    $ driftworld "))
        .collect();
    for command in &commands {
        let words: Vec<&str> = command.split(' ').collect();
        let stdout = succeed_in(folder.path(), &words);
        if let Some(place) = words.iter().position(|word| *word == "-o") {
            let file = folder.path().join(words[place + 1]);
            assert!(file.is_file(), "{command}: {stdout}");
            if words[0] != "curriculum" {
                assert!(
                    stdout.contains(&format!("wrote {}", words[place + 1])),
                    "{command}: {stdout}"
                );
            }
        }
    }
    assert_eq!(commands.len(), 6, "{commands:?}");
}

#[test]
fn film_of_a_world_without_a_limit_ends() {
    let folder = scratch();
    write(
        &folder.path().join("endless.json"),
        r#"{ "agent_params": { "observation_size": 8 } }"#,
    );
    let film = |more: &str| {
        let line = format!("film endless.json --agent still --size 32 --json -o sheet.png {more}");
        let done = output(&mut driftworld_in(folder.path(), &line));
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let json: serde_json::Value = serde_json::from_slice(&done.stdout).expect("it is JSON");
        let stderr = String::from_utf8_lossy(&done.stderr).into_owned();
        (json["steps"].as_u64(), stderr)
    };
    let (steps, stderr) = film("");
    assert_eq!(steps, Some(3000));
    stderr.says("no step limit");
    stderr.says("--max-steps");
    assert_eq!(film("--max-steps 7"), (Some(7), String::new()));
}
