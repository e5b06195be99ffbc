//! If the reader of the output or the messages has gone, as with `| head`, every command ends silently and without a panic.

use std::process::Stdio;

use super::terminal::{driftworld_in, output, root, scratch, subcommands, succeed_in};
use crate::tier::quick_or_full;

/// Every subcommand with arguments that make it print results, messages, or both.
const COMMANDS: [&str; 42] = [
    "--help",
    "run --help",
    "nonsense",
    "demo --help",
    "tasks",
    "tasks show find_objects",
    "validate scenario.json missing.json",
    "validate scenario.json --json",
    "sample find_objects --count 50 --jsonl",
    "sample nowhere",
    "vary find_objects#red --element R --distance 0.1",
    "elements blue_red_green --worlds 1",
    "convert find_objects",
    "render find_objects --size 32 -o a.png",
    "sheet find_objects#red --size 32 -o b.png",
    "assets list",
    "assets show nothing",
    "photograph world.json -o photographs",
    "console find_objects",
    "distance find_objects#red find_objects#dusk --explain",
    "order find_objects#red dusk",
    "curriculum find_objects#red dusk --worlds 0",
    "run scenario.json --agent random -o new",
    "audit scenario.json --lifetimes 1 --repeats 2",
    "scales find_objects#red --worlds 2",
    "film find_objects#red --agent still --size 32 -o f.gif",
    "replay log",
    "play find_objects",
    "studio nowhere",
    "logs validate log",
    "logs aggregate log --format csv -o -",
    "metrics log",
    "report log -o page.html",
    "transfer-report log --distances matrix.json",
    "transfer-report nowhere --distances matrix.json",
    "schema task",
    "new closed_pipe --force",
    "export find_objects -o -",
    "completions zsh",
    "bench nothing",
    "doctor",
    "doctor --json",
];

/// Commands whose exit code is a result and must stay the same even if nobody reads the output.
const ANSWERS: [&str; 5] = ["validate", "logs validate", "audit", "replay", "doctor"];

/// A pipe whose reading end is closed.
fn closed() -> Stdio {
    let (reader, writer) = std::io::pipe().expect("the machine has pipes");
    drop(reader);
    writer.into()
}

#[test]
fn every_command_ends_quietly_without_a_reader() {
    let folder = scratch();
    let path = folder.path();
    let design = "curriculum find_objects#red find_objects#blue -o scenario.json --learn 1 --eval-episodes 1";
    succeed_in(path, design);
    succeed_in(path, "run scenario.json --agent random --output log");
    succeed_in(path, "order find_objects#red dusk --matrix matrix.json");
    // A world with one object, so that its photographs take little time.
    let world = r#"{ "objects": [{ "class": "cube", "coordinates": [3, 4] }] }"#;
    std::fs::write(path.join("world.json"), world).expect("the folder is writable");
    for command in COMMANDS.into_iter().step_by(quick_or_full(3, 1)) {
        let arguments: Vec<&str> = command.split(' ').collect();
        let run = |output: Stdio, errors: Stdio| {
            let _ = std::fs::remove_dir_all(path.join("new"));
            let mut command = driftworld_in(path, &arguments);
            let child = command.stdin(Stdio::null()).stdout(output).stderr(errors).spawn();
            let done = child
                .and_then(std::process::Child::wait_with_output)
                .expect("the command starts");
            (done.status.code(), String::from_utf8_lossy(&done.stderr).into_owned())
        };
        let (expected, _) = run(Stdio::null(), Stdio::piped());
        let (code, stderr) = run(closed(), Stdio::piped());
        let is_answer = ANSWERS.iter().any(|answer| command.starts_with(answer));
        assert!(
            code == expected || (code == Some(0) && !is_answer),
            "{command}, output closed: {code:?}\n{stderr}"
        );
        assert!(
            !stderr.contains("panicked") && !stderr.contains("Broken pipe"),
            "{command}: {stderr}"
        );
        if quick_or_full(true, false) {
            continue;
        }
        let (code, _) = run(Stdio::null(), closed());
        assert_eq!(code, expected, "{command}, messages closed");
        let (code, _) = run(closed(), closed());
        assert!(code == Some(0) || code == expected, "{command}, both closed: {code:?}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn help_that_cannot_be_written_is_an_error() {
    for command in ["--help", "--version", "run --help", "logs validate -h"] {
        let full = std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .expect("Linux has it");
        let done = output(driftworld_in(root(), command).stdout(full));
        let stderr = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(
            done.status.code() == Some(1) && stderr.contains("standard output:"),
            "{command}: {stderr}"
        );
    }
}

#[test]
fn no_subcommand_is_left_out() {
    for name in subcommands() {
        let is_tried = COMMANDS
            .iter()
            .any(|command| command.split(' ').next() == Some(name.as_str()));
        assert!(
            is_tried,
            "{name}: add a line that prints something; see {}",
            root().join(file!()).display()
        );
    }
}
