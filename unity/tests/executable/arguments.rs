//! The executable's arguments: their effects, and its messages about them.

use std::fs;
use std::path::Path;
#[cfg(target_os = "linux")]
use std::process::Command;

use driftworld_spec::World;
use driftworld_unity::protocol::CommandProto;
use driftworld_unity::protocol::ObservationData;
use driftworld_unity::{BEHAVIOR, HELP, MARK};
use prost::Message;

use super::played::{Client, command, who};
use super::process::{Ended, Executable};
use super::start;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder can be created")
}

fn run(arguments: &[&str]) -> Ended {
    Executable::start(arguments, folder().path()).ended()
}

/// A client's view of a world at its start.
#[derive(Debug, PartialEq)]
struct Observed {
    shape: Vec<i32>,
    picture: Vec<u8>,
    state: Vec<f32>,
}

/// Runs a client that observes a world once and quits.
fn observe_once(arguments: &[&str], folder: &Path) -> (Ended, Option<Observed>) {
    let client = Client::new([who("1.0.0"), command(CommandProto::Reset), command(CommandProto::Quit)]);
    let ended = start(&client, arguments, folder).ended();
    let output = client.calls().pop().and_then(|call| call.unity_output?.rl_output);
    let seen = output.map(|output| {
        let seen = &output.agent_infos[BEHAVIOR].value[0].observations;
        let bytes = |data: &ObservationData| match data {
            ObservationData::CompressedData(bytes) => bytes.clone(),
            ObservationData::FloatData(floats) => floats.encode_to_vec(),
        };
        let Some(ObservationData::FloatData(state)) = &seen[3].observation_data else {
            panic!("the state is a list of numbers")
        };
        Observed {
            shape: seen[1].shape.clone(),
            picture: seen[1].observation_data.as_ref().map(bytes).unwrap_or_default(),
            state: state.data.clone(),
        }
    });
    (ended, seen)
}

#[test]
fn help_and_version_go_to_standard_output() {
    for option in ["--help", "-h"] {
        let help = run(&["--wait", "1", option]);
        assert_eq!(
            (help.code, help.stdout, help.stderr),
            (Some(0), format!("{HELP}\n"), String::new())
        );
    }
    let version = run(&["--version"]);
    assert_eq!(version.stdout, format!("{MARK}, {}\n", env!("CARGO_PKG_VERSION")));
    assert_eq!((version.code, version.stderr), (Some(0), String::new()));
}

#[test]
fn invalid_values_exit_with_2_and_mention_help() {
    for (arguments, expected) in [
        (
            ["--mlagents-port", "65536"].as_slice(),
            "--mlagents-port: found \"65536\", expected a port from 1 to 65535",
        ),
        (
            &["--wait", "soon"],
            "--wait: found \"soon\", expected seconds from 0.1 to 86400",
        ),
        (&["--world"], "--world: found no value, expected a file"),
        (
            &["--world", "--wait", "5"],
            "--world: found the option --wait, expected a file",
        ),
        (
            &["--raw-observations=no"],
            "--raw-observations: found the value \"no\", expected none",
        ),
    ] {
        let ended = run(arguments);
        assert_eq!(ended.code, Some(2), "{ended:?}");
        assert_eq!(
            ended.stderr,
            format!("driftworld-unity: {expected}\n`driftworld-unity --help` lists the options\n")
        );
        assert_eq!(ended.stdout, "");
    }
}

#[test]
fn unity_options_are_ignored_and_unknown_ones_give_a_remark() {
    let folder = folder();
    let arguments = "-nographics -batchmode -screen-width 84 -adapter 1 --raw-observation";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let (ended, seen) = observe_once(&arguments, folder.path());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert_eq!(seen.expect("the client observed the world").shape, [84, 84, 3]);
    let lines: Vec<&str> = ended.stderr.lines().collect();
    assert_eq!(
        lines[..2],
        [
            "driftworld-unity: \"-adapter\" is not known here and is ignored",
            "driftworld-unity: \"--raw-observation\" is not known here and is ignored; did you mean --raw-observations?",
        ]
    );
    // Follow the advice in the message.
    let (ended, _) = observe_once(&["--raw-observations"], folder.path());
    assert!(!ended.stderr.contains("not known"), "{ended:?}");
}

#[test]
fn world_file_of_either_format_is_the_initial_world() {
    let folder = folder();
    let ours = World::default().edit(|world| {
        world.agent_params.observation_size = 16;
        world.agent_params.coordinates = [3.0, 4.0];
    });
    let ours = ours.expect("the world is valid");
    fs::write(folder.path().join("ours.json"), ours.to_json()).expect("the folder can be written");
    let theirs = r#"{
        "game_mode": "Learn", "max_steps": "100",
        "environment_params": { "bounding_wall_color": [0, 100, 255], "predefined_map": "0" },
        "agent_params": { "action_model": "ByVelocity", "observation_size": 16, "initial_coordinates": [3, 4] }
    }"#;
    assert!(
        World::from_json("theirs", theirs).is_err(),
        "this world is valid only in the original's format"
    );
    fs::write(folder.path().join("theirs.json"), theirs).expect("the folder can be written");
    for file in ["ours.json", "theirs.json"] {
        let (ended, seen) = observe_once(&["--world", file], folder.path());
        assert_eq!(ended.code, Some(0), "{ended:?}");
        let seen = seen.expect("the client observed the world");
        assert_eq!(
            (seen.shape, seen.state),
            (vec![16, 16, 3], vec![0.0, 3.0, 4.0, 0.0, 0.0, 0.0]),
            "{file}"
        );
    }
}

#[test]
fn unusable_files_are_reported_before_connecting() {
    let folder = folder();
    let broken = "{\n  \"max_steps\": -3\n}";
    fs::write(folder.path().join("broken.json"), broken).expect("the folder can be written");
    for (arguments, expected) in [
        (
            ["--world", "none.json"],
            "driftworld-unity: --world none.json: cannot be read: No such file or directory (os error 2)\n",
        ),
        (
            ["--maps", "none.json"],
            "driftworld-unity: --maps none.json: cannot be read: No such file or directory (os error 2)\n",
        ),
        (
            ["--world", "broken.json"],
            "driftworld-unity: broken.json:2:16 (/max_steps): found -3, expected at least 0\n",
        ),
        (["--maps", "broken.json"], "driftworld-unity: broken.json:"),
    ] {
        let ended = Executable::start(&arguments, folder.path()).ended();
        assert_eq!(ended.code, Some(1), "{ended:?}");
        assert!(ended.stderr.starts_with(expected), "{ended:?}");
    }
}

/// Neither an endless device nor an unused pipe blocks the executable.
#[cfg(unix)]
#[test]
fn devices_and_pipes_are_reported_without_blocking() {
    let folder = folder();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("zeros")).expect("the folder can be written");
    let mkfifo = std::process::Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status();
    assert!(mkfifo.expect("every unix has mkfifo").success());
    for option in ["--world", "--maps", "--assets"] {
        for (file, found) in [("zeros", "a device"), ("pipe", "a named pipe")] {
            let ended = Executable::start(&[option, file], folder.path()).ended();
            assert_eq!(ended.code, Some(1), "{ended:?}");
            let expected = format!("driftworld-unity: {option} {file}: found {found}, expected a regular file");
            assert!(ended.stderr.starts_with(&expected), "{ended:?}");
        }
    }
    let ended = Executable::start(&["-logFile", "pipe"], folder.path()).ended();
    assert_eq!(ended.code, Some(1), "{ended:?}");
    let expected = "driftworld-unity: -logFile pipe: cannot be written: ";
    assert!(ended.stderr.starts_with(expected), "{ended:?}");
}

#[test]
fn key_that_only_the_original_accepts_gives_a_remark() {
    let folder = folder();
    let broken = "{\n  \"max_stepz\": 3\n}";
    fs::write(folder.path().join("world.json"), broken).expect("the folder can be written");
    let (ended, _) = observe_once(&["--world", "world.json"], folder.path());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let lines: Vec<&str> = ended.stderr.lines().collect();
    assert_eq!(
        lines[..2],
        [
            "driftworld-unity: world.json: read as a reset file of L2Explorer",
            "driftworld-unity: world.json:2:16 (/max_stepz): the key \"max_stepz\" has no meaning here and is left out"
        ]
    );
    fs::write(folder.path().join("world.json"), broken.replace("stepz", "steps")).expect("the folder can be written");
    let (ended, _) = observe_once(&["--world", "world.json"], folder.path());
    assert!(!ended.stderr.contains("world.json"), "{ended:?}");
}

#[test]
fn untrusted_text_does_not_control_the_terminal() {
    const HOSTILE: &str = "\u{1b}]0;owned\u{7}\u{202e}\u{9b}2J\r\ndriftworld-unity: FAKE\u{200b}";
    let folder = folder();
    let json = serde_json::json!({ "max_steps": HOSTILE, HOSTILE: 1, "objects": [{ HOSTILE: HOSTILE }] }).to_string();
    fs::write(folder.path().join("broken.json"), &json).expect("the folder can be written");
    let lenient = serde_json::json!({ HOSTILE: 1, "max_steps": 3 }).to_string();
    fs::write(folder.path().join("lenient.json"), &lenient).expect("the folder can be written");
    let mut output = vec![observe_once(&["--world", "lenient.json"], folder.path()).0];
    // Such names are not allowed on Windows.
    if cfg!(unix) {
        fs::write(folder.path().join(HOSTILE), json).expect("the folder can be written");
        output.push(observe_once(&["--world", HOSTILE], folder.path()).0);
    }
    for arguments in [
        ["--world", "broken.json"],
        ["--maps", "broken.json"],
        ["--world", &format!("{HOSTILE}-none")],
        ["--assets", HOSTILE],
        ["--wait", HOSTILE],
        ["--mlagents-port", HOSTILE],
        [HOSTILE, HOSTILE],
    ] {
        output.push(Executable::start(&[&["--wait", "1"], &arguments[..]].concat(), folder.path()).ended());
    }
    for ended in output {
        let hostile = |c: char| driftworld_text::is_unprintable(c) && c != '\n';
        assert!(!ended.stderr.contains(hostile), "{ended:?}");
        assert!(ended.stderr.contains("owned"), "{ended:?}");
        assert!(
            !ended
                .stderr
                .lines()
                .any(|line| line.starts_with("driftworld-unity: FAKE")),
            "{ended:?}"
        );
    }
}

#[test]
fn maps_file_replaces_the_built_in_layouts() {
    let folder = folder();
    let world = World::default().edit(|world| world.environment_params.predefined_map = 1);
    let world = world.expect("map 1 is built in");
    fs::write(folder.path().join("world.json"), world.to_json()).expect("the folder can be written");
    // A block directly in front of the agent.
    let maps = r#"{ "maps": [{ "id": 1, "name": "block", "x_limits": [-100, 100], "y_limits": [-100, 100],
        "excluded_regions": [[[-9, 5], [9, 5], [9, 8], [-9, 8]]] }] }"#;
    fs::write(folder.path().join("maps.json"), maps).expect("the folder can be written");
    let (ended, built_in) = observe_once(&["--world", "world.json"], folder.path());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let (ended, own) = observe_once(&["--world=world.json", "--maps=maps.json"], folder.path());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let (built_in, own) = (
        built_in.expect("the client observed the world"),
        own.expect("the client observed the world"),
    );
    assert_eq!(built_in.state, own.state);
    assert_ne!(built_in.picture, own.picture);
}

#[test]
fn remarks_are_appended_to_the_log_file() {
    let folder = folder();
    let log = folder.path().join("run.log");
    fs::write(&log, "before\n").expect("the folder can be written");
    let (ended, _) = observe_once(&["-logFile", "run.log", "-adapter"], folder.path());
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let output = fs::read_to_string(&log).expect("the log file exists");
    let lines: Vec<&str> = output.lines().collect();
    assert_eq!(
        lines[..2],
        [
            "before",
            "driftworld-unity: \"-adapter\" is not known here and is ignored"
        ]
    );
    assert!(
        lines[2].starts_with("driftworld-unity: a client at 127.0.0.1:"),
        "{output}"
    );
    // Errors go to the log file as well.
    let ended = Executable::start(&["-logFile", "run.log", "--world", "none.json"], folder.path()).ended();
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(1), ""));
    let output = fs::read_to_string(&log).expect("the log file exists");
    assert!(
        output
            .ends_with("driftworld-unity: --world none.json: cannot be read: No such file or directory (os error 2)\n"),
        "{output}"
    );
}

#[test]
fn log_file_in_a_missing_folder_is_an_error() {
    let ended = run(&["-logFile", "none/run.log"]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert_eq!(
        ended.stderr,
        "driftworld-unity: -logFile none/run.log: cannot be written: No such file or directory (os error 2)\n"
    );
}

#[test]
fn log_file_without_a_name_is_the_terminal() {
    let (ended, seen) = observe_once(&["-logFile", "-nographics"], folder().path());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert!(seen.is_some());
    assert!(
        ended.stderr.starts_with("driftworld-unity: a client at 127.0.0.1:"),
        "{ended:?}"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn broken_terminal_does_not_change_the_exit_status() {
    for (argument, expected) in [
        ("--help", 0),
        ("--version", 0),
        ("--wait=soon", 2),
        ("--world=none.json", 1),
    ] {
        let full = || {
            fs::File::options()
                .write(true)
                .open("/dev/full")
                .expect("Linux has /dev/full")
        };
        let mut child = Command::new(env!("CARGO_BIN_EXE_driftworld-unity"))
            .arg(argument)
            .stdout(full())
            .stderr(full())
            .spawn()
            .expect("the executable has been built");
        let status = child.wait().expect("the process can be waited for");
        assert_eq!(status.code(), Some(expected), "{argument}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_redirects_remarks_to_the_terminal() {
    let (ended, seen) = observe_once(&["-logFile", "/dev/full"], folder().path());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert!(seen.is_some());
    assert!(
        ended.stderr.starts_with("driftworld-unity: a client at 127.0.0.1:"),
        "{ended:?}"
    );
}
