//! Tests of the permissions of written files: new ones follow the umask, overwritten ones keep their mode.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::terminal::{output, scratch, text};
use crate::tier::quick_or_full;

/// Every command that writes, one after the other: some read what earlier ones wrote. All output is below the folder `out`.
const COMMANDS: [&str; 21] = [
    "demo --output out/demo",
    "sample find_objects#red -o out/world.json",
    "sample find_objects#red --count 3 --jsonl -o out/worlds.jsonl",
    "sample find_objects#red --count 3 -o out/worlds",
    "convert find_objects#red -o out/converted.json",
    "render out/world.json --size 16 -o out/view.png",
    "sheet find_objects#red --size 32 -o out/sheet.png",
    "photograph small.json -o out/photographs",
    "order find_objects#red find_objects#blue --matrix out/matrix.csv --plot out/path.png",
    "order find_objects#red find_objects#blue --matrix out/matrix.json",
    "curriculum find_objects#red find_objects#blue --learn 1 --eval-episodes 1 --force -o out/scenario.json --plot out/plan.png",
    "run out/scenario.json --agent random -o out/log",
    "logs aggregate out/log -o out/rows.tsv",
    "logs aggregate out/log -o out/rows.csv",
    "metrics out/log -O out/results -o scores",
    "metrics out/log -O out/results -o pictured --do-plot",
    "metrics out/expert -s a --ste-data out/experts",
    "report out/log -o out/page.html --plots out/figures",
    "transfer-report out/log --distances out/matrix.csv --plot out/transfer.png",
    "schema -o out/schemas",
    "console out/world.json --script screen.txt",
];

/// Commands that may fail here, because their input does not always exist.
fn may_fail(command: &str) -> bool {
    ["console", "transfer-report"]
        .iter()
        .any(|name| command.starts_with(name))
}

fn below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder exists").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(below(&path));
        }
        found.push(path);
    }
    found.sort();
    found
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).expect("it exists").permissions().mode() & 0o777
}

/// Runs a command with this umask in a folder.
fn under(umask: &str, folder: &Path, command: &str) {
    let mut shell = Command::new("sh");
    let script = format!("umask {umask}; exec \"$0\" {command}");
    shell
        .args(["-c", &script, env!("CARGO_BIN_EXE_driftworld")])
        .current_dir(folder);
    let ended = output(&mut shell);
    let stderr = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success() || may_fail(command), "{command}: {stderr}");
}

fn prepare(folder: &Path) {
    let world = r#"{ "objects": [{ "class": "cube", "coordinates": [3, 4] }] }"#;
    fs::write(folder.join("small.json"), world).expect("the folder is writable");
    let regime = r#"{ "task": "find_objects", "variant": "red", "count": 2, "max_steps": 5 }"#;
    let expert = format!(r#"{{ "name": "e", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#);
    fs::write(folder.join("expert.json"), expert).expect("the folder is writable");
}

/// Runs all commands.
fn write_all(umask: &str, folder: &Path) {
    for command in COMMANDS {
        if command.contains("out/expert ") {
            under("022", folder, "run expert.json --agent random -o out/expert --resume");
        }
        if command.starts_with("demo") || command.starts_with("run") || command.starts_with("curriculum") {
            // Logs are never overwritten.
            let _ = fs::remove_dir_all(folder.join("out/log"));
        }
        under(umask, folder, command);
    }
    // Written with a different umask, to check that copies do not keep its modes.
    let _ = fs::remove_dir_all(folder.join("out/expert"));
}

#[test]
fn new_files_follow_the_umask_and_overwritten_ones_keep_their_mode() {
    let umasks = [("077", 0o600, 0o700), ("022", 0o644, 0o755)];
    for (umask, files, folders) in umasks.into_iter().take(quick_or_full(1, 2)) {
        let folder = scratch();
        prepare(folder.path());
        write_all(umask, folder.path());
        let out = folder.path().join("out");
        let found = below(&out);
        assert!(found.len() > 60, "too few files were written: {found:?}");
        for path in &found {
            let expected = if path.is_dir() { folders } else { files };
            assert_eq!(
                mode(path),
                expected,
                "umask {umask}: {} is {:o}",
                path.display(),
                mode(path)
            );
        }
        if quick_or_full(false, true) {
            write_over(folder.path(), &found);
        }
    }
}

/// Overwrites everything, after setting modes other than the umask's.
fn write_over(folder: &Path, found: &[PathBuf]) {
    let is_kept = |path: &&PathBuf| {
        let inside = text(path.strip_prefix(folder).expect("it lies there")).to_owned();
        // Logs and stored experts are never overwritten.
        let never = ["out/log/", "out/experts/", "out/demo/log/", "out/demo/beside/"];
        path.is_file() && !never.iter().any(|begin| inside.starts_with(begin))
    };
    let kept = || {
        found
            .iter()
            .filter(is_kept)
            .zip([0o600, 0o640, 0o604].into_iter().cycle())
    };
    for (path, mode) in kept() {
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).expect("it is ours");
    }
    write_all("022", folder);
    for (path, expected) in kept() {
        assert_eq!(mode(path), expected, "{} is {:o}", path.display(), mode(path));
    }
}
