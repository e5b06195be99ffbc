//! Special files in place of every file that a command line can name: an endless device, a link to it, a pipe that nobody
//! writes to, a socket, a folder. Each command ends at once and reports what it found.

#![cfg(unix)]

use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::terminal::{output, root, scratch, subcommands, succeed_in, text};
use crate::is_turn;

/// Placeholder for the special file in a command line.
const FILE: &str = "SPECIAL";

/// Command lines that have the special file in place of each file or folder that can be read.
fn command_lines() -> Vec<Vec<&'static str>> {
    let lines = [
        "tasks show SPECIAL",
        "validate SPECIAL",
        "validate --l2explorer SPECIAL",
        "validate SPECIAL.json task.json",
        "validate task.json --assets SPECIAL",
        "validate names_task.json --worlds 1",
        "sample SPECIAL",
        "sample SPECIAL#day",
        "sample find_objects#red --maps SPECIAL",
        "vary SPECIAL#day --distance 0.1 --element observation",
        "elements SPECIAL --worlds 1",
        "convert SPECIAL",
        "convert find_objects#red --maps SPECIAL",
        "render SPECIAL -o out.png",
        "render find_objects#red --maps SPECIAL -o out.png",
        "render find_objects#red --assets SPECIAL -o out.png",
        "sheet SPECIAL -o out.png",
        "sheet --scenario SPECIAL -o out.png",
        "assets list SPECIAL",
        "assets show tree --assets SPECIAL -o out.png",
        "console SPECIAL",
        "console find_objects#red --maps SPECIAL",
        "console find_objects#red --script SPECIAL",
        "console find_objects#red --script sends.txt",
        "photograph SPECIAL -o out",
        "distance SPECIAL find_objects#red",
        "distance find_objects#red SPECIAL",
        "order SPECIAL",
        "order --from-matrix SPECIAL.csv",
        "order --from-matrix SPECIAL.json",
        "curriculum SPECIAL -o out.json",
        "curriculum find_objects --assets SPECIAL -o out.json",
        "run SPECIAL --agent random -o out",
        "audit SPECIAL",
        "film SPECIAL -o out.gif",
        "replay SPECIAL",
        "play SPECIAL",
        "scales SPECIAL --worlds 2",
        "metrics log --scales SPECIAL",
        "run scenario.json --agent scripted:SPECIAL -o out",
        "run scenario.json --agent net:SPECIAL -o out",
        "run scenario.json --agent random --assets SPECIAL -o out",
        "run names_task.json --agent random -o out",
        "run names_world.json --agent random -o out",
        "logs validate SPECIAL",
        "logs validate SPECIAL --recursive",
        "logs validate info_log",
        "logs validate rows_log",
        "logs aggregate SPECIAL -o out.csv",
        "logs aggregate rows_log -o out.csv",
        "metrics SPECIAL",
        "metrics log --against SPECIAL",
        "metrics log --ste SPECIAL",
        "metrics log -c SPECIAL",
        "metrics log -d SPECIAL",
        "metrics rows_log",
        "report SPECIAL",
        "report log --against SPECIAL",
        "report log --distances SPECIAL.csv",
        "report log --task SPECIAL",
        "report log -c SPECIAL",
        "report log -d SPECIAL",
        "report info_log",
        "transfer-report SPECIAL --distances matrix.csv",
        "transfer-report log --distances SPECIAL.csv",
        "schema --check schemas",
        "studio SPECIAL --no-open",
    ];
    #[cfg(feature = "gltf")]
    let lines = lines.into_iter().chain([
        "assets pack SPECIAL -o out.assets",
        "assets pack lamp.gltf -o out.assets",
    ]);
    lines.into_iter().map(|line| line.split(' ').collect()).collect()
}

/// Subcommands that read no file named by an argument.
const WITHOUT_FILES: [&str; 6] = ["demo", "bench", "doctor", "new", "export", "completions"];

#[test]
fn every_subcommand_that_reads_files_is_tested() {
    let lines = command_lines();
    for command in subcommands() {
        let is_tested = lines.iter().any(|line| line[0] == command);
        assert_eq!(is_tested, !WITHOUT_FILES.contains(&command.as_str()), "{command}");
    }
}

#[test]
fn endless_device_is_not_read() {
    everywhere(0, "a device", |path| {
        symlink("/dev/zero", path).expect("a link can be created");
    });
}

#[test]
fn pipe_without_a_writer_is_not_waited_for() {
    everywhere(1, "a named pipe", |path| {
        let status = Command::new("mkfifo").arg(path).status();
        assert!(status.expect("every unix has mkfifo").success());
    });
}

#[test]
fn socket_is_not_read() {
    everywhere(2, "a socket", |path| {
        // The socket file remains after its listener is closed.
        drop(UnixListener::bind(path).expect("a socket can be bound"));
    });
}

#[test]
fn folder_is_not_read_as_a_file() {
    everywhere(3, "folder", |path| {
        fs::create_dir(path).expect("a folder can be created");
    });
}

/// Runs every command line with such a file in place of its own; in the quick tier, every fourth command line, a different
/// selection for each `kind`.
fn everywhere(kind: usize, found: &str, make: impl Fn(&Path)) {
    let scratch = scratch();
    let folder = scratch.path();
    prepare(folder);
    for name in "SPECIAL SPECIAL.csv SPECIAL.json info_log/scenario_info.json rows_log/w/0-train/data-log.tsv \
         schemas/world.schema.json lamp.bin"
        .split(' ')
    {
        make(&folder.join(name));
    }
    for (number, line) in command_lines().into_iter().enumerate() {
        if !is_turn(number + kind, 4) {
            continue;
        }
        let (code, error) = ended(folder, &line);
        assert_eq!(code, Some(1), "{line:?}: {error}");
        assert!(error.contains("error: "), "{line:?}: {error}");
        let names_it = line.iter().any(|argument| argument.contains(FILE));
        // For folders of logs and of maps, the message names what is missing in them.
        let is_folder_in_place = found == "folder" && !error.contains(found);
        if names_it && !is_folder_in_place {
            assert!(error.contains(FILE), "{line:?}: {error}");
            assert!(error.contains(found) || error.contains("found no"), "{line:?}: {error}");
        }
    }
}

/// Writes the valid files that the command lines name besides the special ones.
fn prepare(folder: &Path) {
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().expect("it lies in a folder")).expect("the folder is writable");
        fs::write(path, text).expect("the folder is writable");
    };
    let scenario = |regime: &str| {
        format!(
            r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{{ {regime}, "count": 1, "max_steps": 3 }}] }}] }}"#
        )
    };
    write("task.json", &read_task());
    write(
        "scenario.json",
        &scenario(r#""task": "find_objects", "variant": "red""#),
    );
    write("names_task.json", &scenario(r#""task": "SPECIAL", "variant": "red""#));
    write(
        "names_world.json",
        &scenario(r#""task": "t", "variant": "v", "world": "SPECIAL""#),
    );
    write("sends.txt", "send_message SPECIAL\n");
    write("matrix.csv", ",a,b\na,0,1\nb,1,0\n");
    succeed_in(
        folder,
        &["run", "scenario.json", "--agent", "random", "--output", "log"],
    );
    write("info_log/logger_info.json", r#"{"metrics_columns": ["reward"]}"#);
    write("rows_log/logger_info.json", r#"{"metrics_columns": ["reward"]}"#);
    fs::create_dir_all(folder.join("rows_log/w/0-train")).expect("the folder is writable");
    succeed_in(folder, &["schema", "-o", "schemas"]);
    fs::remove_file(folder.join("schemas/world.schema.json")).expect("it was written");
    write(
        "lamp.gltf",
        r#"{ "asset": { "version": "2.0" }, "buffers": [{ "uri": "lamp.bin", "byteLength": 12 }] }"#,
    );
}

fn read_task() -> String {
    super::terminal::read(root().join("examples/tasks/find_objects.json"))
}

/// The exit code and the standard error of a command line. More than ten seconds or four gigabytes fail the test.
fn ended(folder: &Path, line: &[&str]) -> (Option<i32>, String) {
    let messages = folder.join("said.txt");
    let mut child = Command::new("sh")
        .args([
            "-c",
            "ulimit -v 4000000; exec \"$0\" \"$@\"",
            env!("CARGO_BIN_EXE_driftworld"),
        ])
        .args(line)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(&messages).expect("the folder is writable"))
        .spawn()
        .expect("every unix has sh");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("the process is a child of the test") {
            break status;
        }
        if start.elapsed() > Duration::from_secs(10) {
            child.kill().expect("the process is a child of the test");
            panic!("{line:?} did not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    (status.code(), super::terminal::read(messages))
}

#[test]
fn unrecognised_file_does_not_suppress_other_verdicts() {
    let scratch = scratch();
    let folder = scratch.path();
    let all = folder.join("all");
    fs::create_dir(&all).expect("the folder is writable");
    fs::write(all.join("d_task.json"), read_task()).expect("the folder is writable");
    symlink("/dev/zero", all.join("a.json")).expect("a link can be created");
    symlink("nowhere", all.join("b.json")).expect("a link can be created");
    fs::write(all.join("c.json"), b"{\"name\": \"\xff\"}").expect("the folder is writable");
    fs::create_dir(all.join("e.json")).expect("the folder is writable");
    let status = Command::new("mkfifo").arg(all.join("f.json")).status();
    assert!(status.expect("every unix has mkfifo").success());
    let (code, _) = ended(folder, &["validate", "all"]);
    assert_eq!(code, Some(1));
    let judged = output(&mut super::terminal::driftworld(&["validate", "--json", text(&all)]));
    assert_eq!(judged.status.code(), Some(1));
    let verdicts: serde_json::Value = serde_json::from_slice(&judged.stdout).expect("it is JSON");
    let verdicts: Vec<(bool, String)> = verdicts
        .as_array()
        .into_iter()
        .flatten()
        .map(|verdict| (verdict["valid"] == true, verdict["problems"][0]["message"].to_string()))
        .collect();
    let valid: Vec<bool> = verdicts.iter().map(|(valid, _)| *valid).collect();
    assert_eq!(valid, [false, false, false, true, false, false]);
    for ((_, message), found) in verdicts.iter().zip([
        "a device",
        "a link that leads nowhere",
        "byte 10 (line 1)",
        "null",
        "a folder",
        "a named pipe",
    ]) {
        assert!(message.contains(found), "{message}");
    }
}
