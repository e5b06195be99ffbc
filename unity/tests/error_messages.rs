//! Checks the code, exit status and exact message of every error of this crate. The tests in `executable` check that following
//! the advice in them helps.

use std::collections::BTreeSet;
use std::io;

use driftworld_env::EnvError;
use driftworld_spec::World;
use driftworld_unity::{Request, UnityError};
use strum::VariantNames;

fn errors() -> Vec<UnityError> {
    let address = || "127.0.0.1:5005".to_owned();
    let arguments = Request::parse(&["--wait".to_owned(), "soon".to_owned()]);
    let document = World::from_json("world.json", "{ \"max_steps\": -3 }");
    vec![
        arguments.expect_err("soon is not a number"),
        UnityError::Reading {
            option: "--world",
            source: driftworld_files::FileError::Unreadable {
                path: "world.json".into(),
                source: io::Error::new(io::ErrorKind::PermissionDenied, "permission denied"),
            },
        },
        UnityError::Writing {
            option: "-logFile",
            path: "log.txt".into(),
            source: io::Error::new(io::ErrorKind::PermissionDenied, "permission denied"),
        },
        UnityError::Recording {
            path: "episodes.jsonl".into(),
            source: driftworld_env::EnvError::Recording {
                line: 1,
                found: "another line".to_owned(),
                expected: "the first line of a recordings file".to_owned(),
            },
        },
        UnityError::Network(io::Error::new(io::ErrorKind::QuotaExceeded, "too many open files")),
        document.expect_err("the number of steps is not negative").into(),
        UnityError::NoClient {
            address: address(),
            seconds: 60.0,
        },
        UnityError::NoAddress("not a machine:5005".to_owned()),
        UnityError::NotAClient {
            address: address(),
            reason: "silence for 60 s".to_owned(),
        },
        UnityError::ClientVersion("2.0.0".to_owned()),
        UnityError::Unreadable("invalid varint".to_owned()),
        UnityError::Incomplete("a header"),
        UnityError::UnknownCommand(7),
        UnityError::ClientFailed {
            status: 500,
            text: "two\nlines".to_owned(),
        },
        UnityError::WrongAgent {
            behavior: "Walker?team=0".to_owned(),
            found: 2,
        },
        UnityError::ActionLength { found: 2, expected: 3 },
        UnityError::ActionRow {
            found: "7".to_owned(),
            last: 6,
        },
        UnityError::Library {
            path: "town.assets".into(),
            source: EnvError::NoSuchAction { found: 7, last: 6 },
        },
        UnityError::TooLarge(9_437_482),
        UnityError::Picture("out of memory".to_owned()),
        EnvError::NoSuchAction { found: 7, last: 6 }.into(),
    ]
}

#[test]
fn every_error_has_its_message() {
    let errors = errors();
    let line = |error: &UnityError| format!("{} (exit {}): {error}", error.code(), error.exit_code());
    let lines: Vec<String> = errors.iter().map(line).collect();
    insta::assert_snapshot!(lines.join("\n"));
    let covered: BTreeSet<&str> = errors.iter().map(UnityError::code).collect();
    let expected: BTreeSet<&str> = UnityError::VARIANTS.iter().copied().collect();
    assert_eq!(covered, expected, "every code has a case here");
    assert_eq!(covered.len(), errors.len(), "every case has its own code");
}
