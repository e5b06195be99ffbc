//! `driftworld console` in scripts and pipes: whole transcripts, exit codes, and files that stay in their folder.

use std::path::Path;
use std::process::Output;

use driftworld::spec::World;

use super::terminal::{Says, driftworld, fed, root, scratch};
use crate::reference_data::reference;

const WORLD: &str = "examples/console/world.json";

/// Runs the console with lines on its standard input, and `--output` in the test's own folder.
fn console(arguments: &[&str], out: &Path, lines: impl AsRef<[u8]>) -> Output {
    let mut command = driftworld(&["console"]);
    command.args(arguments).arg("--output").arg(out);
    fed(command, lines.as_ref())
}

/// The output, without the folder's name.
fn stdout_of(output: &Output, out: &Path) -> String {
    String::from_utf8_lossy(&output.stdout).replace(&out.display().to_string(), "OUT")
}

/// A transcript without the world's hash, which changes as soon as worlds get a new key.
fn without_hash(transcript: &str) -> String {
    let path = root().join(WORLD);
    let text = std::fs::read_to_string(path).expect("the example is committed");
    let hash = World::from_json(WORLD, &text).expect("the example is valid").hash();
    let token = format!("{}-{}-8{}-8{}-", &hash[..8], &hash[8..12], &hash[12..15], &hash[15..18]);
    transcript
        .replace(&hash, "HASH")
        .replace(&hash[..12], "HASH")
        .replace(&token, "TOKEN-")
}

/// The transcript of a session that must succeed.
#[track_caller]
fn transcript(lines: &str) -> String {
    let folder = scratch();
    let out = folder.path().join("out");
    let output = console(&[WORLD], &out, lines);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{error}{}", stdout_of(&output, &out));
    stdout_of(&output, &out)
}

/// The console's answers to lines that it must refuse, none of which may write anything.
#[track_caller]
fn refused(lines: &str) -> String {
    let folder = scratch();
    let out = folder.path().join("out");
    let output = console(&[WORLD, "--keep-going"], &out, lines);
    assert_eq!(output.status.code(), Some(1), "{}", stdout_of(&output, &out));
    let error = String::from_utf8_lossy(&output.stderr);
    let count = lines.lines().count();
    assert_eq!(error, format!("error: standard input: {count} commands failed\n"));
    assert!(!out.exists(), "nothing was written");
    stdout_of(&output, &out)
}

#[test]
fn tour_transcript_is_unchanged() {
    let folder = scratch();
    let out = folder.path().join("out");
    let output = console(&[WORLD, "--script", "examples/console/tour.txt"], &out, "");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    insta::assert_snapshot!("tour", without_hash(&stdout_of(&output, &out)));
    let mut files: Vec<_> = std::fs::read_dir(&out)
        .expect("the tour wrote files")
        .map(|entry| entry.expect("the folder can be listed").file_name())
        .collect();
    files.sort();
    assert_eq!(files, ["map.png", "now.json", "view.png"]);
    let state = std::fs::read_to_string(out.join("now.json")).expect("the state was written");
    assert!(state.contains("\"food\""), "the state contains the spawned object");
}

#[test]
fn pipe_prints_the_same_as_a_script() {
    let folder = scratch();
    let out = folder.path().join("out");
    let script = std::fs::read_to_string("examples/console/tour.txt").expect("the tour is committed");
    let by_script = console(&[WORLD, "--script", "examples/console/tour.txt"], &out, "");
    let by_pipe = console(&[WORLD], &out, &script);
    assert_eq!(stdout_of(&by_script, &out), stdout_of(&by_pipe, &out));
}

#[test]
fn every_command_has_help() {
    insta::assert_snapshot!("help", without_hash(&transcript("help\nhelp spawn\n")));
}

#[test]
fn wrong_lines_are_refused_with_the_expected_form() {
    let lines = [
        "telport 1 2",
        "xyzzy",
        "objects please",
        "step many",
        "step 5 1 2",
        "action -a 3",
        "action -a 1 2 inf",
        "teleport 1000 0",
        "teleport 5 2",
        "spawn tree 1",
        "spawn tree 1 2 colour=red",
        "spawn tree 1 2 scale=-1",
        "spawn tree 1 2 unique_name=coin",
        "spawn { \"class\": }",
        "destroy 99",
        "destroy coni",
        "restore start",
        "reset 5",
        "reset no_such_file.json",
        "show smell",
        "log everything on",
        "screenshot ../out.png",
        "screenshot /etc/motd",
        "screenshot a.txt",
        "screenshot a.png 5000x5",
        "state ../../state.json",
        "send_message { \"action\": \"dance\" }",
        "send_message { \"action\": \"get_observer\" }",
        "send_message { \"action\": \"save_screenshot\", \"payload\": { \"filename\": \"../../a.png\" } }",
        "destroy 'coin",
    ];
    insta::assert_snapshot!("refused", without_hash(&refused(&lines.join("\n"))));
    assert!(refused("send_message no_such_file.json").contains("no_such_file.json: cannot be read"));
}

#[test]
fn first_error_ends_a_script_with_its_line() {
    let folder = scratch();
    let script = folder.path().join("bad.txt");
    std::fs::write(&script, "# nothing\n\nstep 3\nstap\nstep 3\n").expect("the scratch folder can be written");
    let script = script.to_str().expect("temporary paths are UTF-8");
    let output = console(&[WORLD, "--script", script], folder.path(), "");
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(
        error,
        format!("error: {script}:4: found command \"stap\", expected one listed by help; did you mean \"step\"?\n")
    );
    assert_eq!(stdout_of(&output, folder.path()).matches("> step 3").count(), 1);
}

#[test]
fn ended_episode_needs_a_reset() {
    let ended = transcript("step 1000\n");
    ended.says("60 steps, reward 0;");
    ended.says(": its last step");
    let folder = scratch();
    let output = console(&[WORLD], folder.path(), "step 60\nstep\n");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    error.says("standard input:2: step: the episode has ended, expected a reset first");
    transcript("step 60\nreset\nstep\n");
}

#[test]
fn variant_has_numbered_worlds() {
    let folder = scratch();
    let lines = "reset 5\ninfo\nreset 0\ninfo\nreset\ninfo\nreset examples/console/world.json\ninfo\n";
    let output = console(&["find_objects#red", "--seed", "7"], folder.path(), lines);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let transcript = stdout_of(&output, folder.path());
    let hashes: Vec<&str> = transcript
        .lines()
        .filter_map(|line| line.strip_prefix("world      "))
        .collect();
    assert_eq!(hashes.len(), 4, "{transcript}");
    assert!(
        hashes[0] != hashes[1] && hashes[1] == hashes[2] && hashes[2] != hashes[3],
        "{hashes:?}"
    );
}

#[test]
fn l2explorer_messages_run_completely() {
    let Some(messages) = reference("l2explorer/channel_messages.json") else {
        return;
    };
    let folder = scratch();
    let out = folder.path().join("out");
    let lines = format!("send_message '{}'\nstep 2 1 0 0\nobjects\n", messages.display());
    let output = console(&[WORLD], &out, &lines);
    let transcript = stdout_of(&output, &out);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}{transcript}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(transcript.matches("\"action\":\"state\"").count(), 2, "{transcript}");
    assert!(transcript.contains("thing"), "{transcript}");
    assert!(out.join("l2explorer_screenshot.png").is_file());
}

#[test]
fn binary_lines_are_an_error_and_not_a_panic() {
    let folder = scratch();
    let output = console(&["find_objects"], folder.path(), b"info\n\xff\xfe\n");
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    error.says("standard input:2: the line is not UTF-8 text");
}
