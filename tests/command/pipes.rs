//! Tests of output to devices and pipes: it is written directly and continuously, without a folder for temporary files.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};

use super::terminal::{driftworld_in, output, scratch, succeed_in, text};

fn make_pipe(folder: &Path, name: &str) {
    let status = Command::new("mkfifo").arg(folder.join(name)).status();
    assert!(status.is_ok_and(|status| status.success()));
}

/// More worlds than can be drawn during this test.
const MANY: &str = "100000000";

#[test]
fn pipe_reader_gets_the_first_world_before_the_last_is_drawn() {
    let folder = scratch();
    make_pipe(folder.path(), "pipe");
    let first = succeed_in(folder.path(), &["sample", "find_objects", "-o", "-"]);
    let arguments = ["sample", "find_objects", "--count", MANY, "--jsonl", "-o", "pipe"];
    let mut child = driftworld_in(folder.path(), &arguments)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut reader = BufReader::new(fs::File::open(folder.path().join("pipe")).expect("the command writes it"));
    let mut line = String::new();
    reader.read_line(&mut line).expect("a world arrives");
    assert_eq!(line, first);
    assert!(
        child.try_wait().expect("it has a status").is_none(),
        "it is still drawing"
    );
    // The reader has gone, which is reported.
    drop(reader);
    let ended = child.wait_with_output().expect("the command ends");
    let error = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(1), "{error}");
    assert!(error.contains("pipe: cannot be written: Broken pipe"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).expect("it exists").count(), 1);
}

#[test]
fn every_format_works_in_a_pipe() {
    let folder = scratch();
    let path = folder.path();
    let cases = [
        ("worlds.jsonl", "sample find_objects#red --count 30 --jsonl"),
        ("world.json", "sample find_objects#red"),
        ("sheet.png", "sheet find_objects#red --size 32"),
    ];
    for (name, command) in cases {
        let arguments: Vec<&str> = command.split(' ').collect();
        let file = format!("file-{name}");
        succeed_in(path, &[&arguments[..], &["-o", &file]].concat());
        let expected = fs::read(path.join(&file)).expect("it was written");
        let pipe = format!("pipe-{name}");
        make_pipe(path, &pipe);
        let reader = {
            let pipe = path.join(&pipe);
            std::thread::spawn(move || {
                let mut bytes = Vec::new();
                let mut file = fs::File::open(pipe).expect("the command writes to the pipe");
                file.read_to_end(&mut bytes).expect("the command ends");
                bytes
            })
        };
        succeed_in(path, &[&arguments[..], &["-o", &pipe]].concat());
        let found = reader.join().expect("the reader does not panic");
        assert_eq!(found, expected, "{name}: {} and {} bytes", found.len(), expected.len());
    }
}

#[test]
fn no_folder_for_temporary_files_is_needed() {
    let folder = scratch();
    let path = folder.path();
    let expected = succeed_in(path, &["sample", "find_objects", "--count", "3", "--jsonl", "-o", "-"]);
    let through = |target: &str, redirected: &str| {
        let script = format!("exec \"$0\" sample find_objects --count 3 --jsonl -o {target} {redirected}");
        let mut shell = Command::new("sh");
        shell
            .args(["-c", &script, env!("CARGO_BIN_EXE_driftworld")])
            .current_dir(path)
            .env("TMPDIR", path.join("absent"));
        let ended = output(&mut shell);
        let error = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert!(ended.status.success(), "{target} {redirected}: {error}");
        String::from_utf8(ended.stdout).expect("worlds are text")
    };
    assert_eq!(through("/dev/null", ""), "");
    assert_eq!(through("/dev/stdout", ""), expected);
    assert_eq!(through("/dev/fd/1", ""), expected);
    assert_eq!(through("/dev/fd/3", "3>&1"), expected);
    assert_eq!(through("/dev/stdout", "| cat"), expected);
    // A file opened by another process is appended to, and stays the same file.
    fs::write(path.join("open"), "before\n").expect("the folder is writable");
    for redirected in [
        "/dev/stdout >>open",
        "/dev/fd/1 >>open",
        "/dev/fd/3 3>>open",
        "/dev/stderr 2>>open",
    ] {
        assert_eq!(through(redirected, ""), "");
    }
    let found = fs::read_to_string(path.join("open")).expect("it exists");
    assert_eq!(found, format!("before\n{}", expected.repeat(4)));
    assert_eq!(fs::read_dir(path).expect("it exists").count(), 1, "in {}", text(path));
}
