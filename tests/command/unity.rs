//! `driftworld unity install` with files that stand for the executable: what is copied, what is printed, what is left alone. The
//! executable itself is tested in `unity/`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::terminal::{driftworld_in, fail_in, output, read, scratch, text};

/// What the executable of `unity/` holds, and nothing else does.
const MARKER: &str = "driftworld-unity: a stand-in for the L2Explorer executable";

/// A program for the shell that says which one it is, and holds the marker.
fn executable(folder: &Path, says: &str) -> PathBuf {
    let path = folder.join("driftworld-unity");
    fs::write(&path, format!("#!/bin/sh\n# {MARKER}\necho {says}\n")).expect("the folder can be written");
    path
}

/// Runs `unity install` in a folder, with an empty PATH.
fn install(folder: &Path, arguments: &[&str]) -> Output {
    let arguments = [&["unity", "install"], arguments].concat();
    output(driftworld_in(folder, &arguments).env("PATH", ""))
}

#[track_caller]
fn installed(folder: &Path, arguments: &[&str]) -> (String, String) {
    let Output { status, stdout, stderr } = install(folder, arguments);
    let said = |bytes| String::from_utf8(bytes).expect("the command prints UTF-8");
    let (stdout, stderr) = (said(stdout), said(stderr));
    assert_eq!(status.code(), Some(0), "{arguments:?}: {stderr}");
    (stdout, stderr)
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let error = fail_in(folder, 1, &[&["unity", "install"], arguments].concat());
    error.replace(text(folder), "FOLDER")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be listed");
    let mut names: Vec<String> = entries
        .map(|entry| {
            let entry = entry.expect("the folder can be listed");
            entry.file_name().to_string_lossy().into_owned()
        })
        .collect();
    names.sort();
    names
}

#[cfg(unix)]
#[test]
fn two_lines_for_eval_lead_to_a_program_that_starts() {
    let folder = scratch();
    executable(folder.path(), "'the first'");
    let strange = "it's $HOME, `here` \"and\" \\ there";
    let (lines, notes) = installed(folder.path(), &[strange, "--executable", "driftworld-unity"]);
    assert_eq!(lines.lines().count(), 2, "{lines}");
    assert!(lines.ends_with("\nexport L2EXPLORER_WORKER_ID=0\n"), "{lines}");
    assert!(
        notes.contains("l2explorer.x86_64 (a copy of driftworld-unity"),
        "{notes}"
    );
    assert!(!notes.contains("warning"), "{notes}");
    let mut shell = Command::new("sh");
    let script = format!("{lines}\"$L2EXPLORER_APP\"; printf '%s %s' \"$L2EXPLORER_WORKER_ID\" \"$L2EXPLORER_APP\"");
    let said = output(shell.args(["-c", &script]).current_dir("/"));
    let target = folder.path().join(strange).join("l2explorer.x86_64");
    assert_eq!(
        String::from_utf8_lossy(&said.stdout),
        format!("the first\n0 {}", text(&target))
    );
    assert_eq!(names(target.parent().expect("it has a folder")), ["l2explorer.x86_64"]);
}

#[cfg(unix)]
#[test]
fn all_may_start_the_copy_whatever_the_original_was() {
    use std::os::unix::fs::PermissionsExt;
    let folder = scratch();
    let file = executable(folder.path(), "hello");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).expect("it is ours");
    installed(folder.path(), &["deep/er", "--executable", text(&file)]);
    let mode = fs::metadata(folder.path().join("deep/er/l2explorer.x86_64")).expect("it was installed");
    assert_eq!(mode.permissions().mode() & 0o7777, 0o755);
}

#[test]
fn an_earlier_copy_is_replaced() {
    let folder = scratch();
    for says in ["older", "newer"] {
        let file = executable(folder.path(), says);
        let (_, notes) = installed(folder.path(), &["app", "--executable", text(&file)]);
        assert_eq!(notes.lines().count(), 1, "{notes}");
    }
    assert!(read(folder.path().join("app/l2explorer.x86_64")).contains("newer"));
    assert_eq!(names(&folder.path().join("app")), ["l2explorer.x86_64"]);
}

#[test]
fn a_program_of_another_is_left_alone_unless_forced() {
    let folder = scratch();
    executable(folder.path(), "ours");
    fs::create_dir(folder.path().join("app")).expect("the scratch folder can be written");
    let build = folder.path().join("app/l2explorer.x86_64");
    fs::write(&build, "a Unity build").expect("the scratch folder can be written");
    let arguments = ["app", "--executable", "driftworld-unity"];
    insta::assert_snapshot!("another_program", refused(folder.path(), &arguments));
    assert_eq!(read(&build), "a Unity build");
    installed(folder.path(), &[&arguments[..], &["--force"]].concat());
    assert!(read(&build).contains("ours"));
}

#[cfg(unix)]
#[test]
fn a_link_is_replaced_and_never_written_through() {
    let folder = scratch();
    let file = executable(folder.path(), "ours");
    let link = folder.path().join("l2explorer.x86_64");
    std::os::unix::fs::symlink(&file, &link).expect("the scratch folder can be written");
    installed(folder.path(), &[".", "--executable", "driftworld-unity"]);
    assert!(!fs::symlink_metadata(&link).expect("it was installed").is_symlink());
    fs::remove_file(&link).expect("it is ours");
    std::os::unix::fs::symlink("a disk that is not there", &link).expect("the scratch folder can be written");
    assert!(refused(folder.path(), &[".", "--executable", "driftworld-unity"]).contains("--force"));
    assert!(fs::symlink_metadata(&link).expect("it was left alone").is_symlink());
}

#[cfg(unix)]
#[test]
fn without_an_executable_it_says_where_it_looked() {
    let folder = scratch();
    // A copy of the command, so that nothing stands beside it. Made by another process: a program that is still open for writing in
    // a child of ours, started at this moment by another test, cannot be started.
    let alone = folder.path().join("driftworld-alone");
    let mut cp = Command::new("cp");
    assert!(
        output(cp.arg(env!("CARGO_BIN_EXE_driftworld")).arg(&alone))
            .status
            .success()
    );
    let mut command = Command::new(&alone);
    let command = command.args(["unity", "install", "app"]).current_dir(folder.path());
    let error = output(command.env("PATH", folder.path().join("bin")));
    assert_eq!(error.status.code(), Some(1));
    let error = String::from_utf8_lossy(&error.stderr).replace(text(folder.path()), "FOLDER");
    insta::assert_snapshot!("no_executable", error);
    assert!(!folder.path().join("app").exists(), "nothing was made");
    // The advice is good: in PATH or beside the command it is found.
    fs::create_dir(folder.path().join("bin")).expect("the scratch folder can be written");
    executable(&folder.path().join("bin"), "in PATH");
    let found = output(command);
    assert_eq!(
        found.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&found.stderr)
    );
    assert!(read(folder.path().join("app/l2explorer.x86_64")).contains("in PATH"));
    executable(folder.path(), "beside");
    output(command);
    assert!(read(folder.path().join("app/l2explorer.x86_64")).contains("beside"));
}

#[test]
fn what_is_not_the_executable_is_not_installed() {
    let folder = scratch();
    fs::write(folder.path().join("other"), "MZ").expect("the scratch folder can be written");
    insta::assert_snapshot!("not_ours", refused(folder.path(), &["app", "--executable", "other"]));
    assert!(refused(folder.path(), &["app", "--executable", "."]).contains("found no file, expected the executable"));
    assert!(refused(folder.path(), &["app", "--executable", "gone"]).contains("gone: cannot be read: "));
    let command = env!("CARGO_BIN_EXE_driftworld");
    assert!(
        refused(folder.path(), &["app", "--executable", command]).contains("found another file"),
        "the command is not taken for the executable"
    );
    assert_eq!(names(folder.path()), ["other"], "nothing was made");
}

#[test]
fn a_folder_that_cannot_be_one_is_refused() {
    let folder = scratch();
    executable(folder.path(), "ours");
    fs::write(folder.path().join("file"), "").expect("the scratch folder can be written");
    fs::create_dir_all(folder.path().join("taken/l2explorer.x86_64")).expect("the scratch folder can be written");
    let refused = |name| refused(folder.path(), &[name, "--force", "--executable", "driftworld-unity"]);
    insta::assert_snapshot!("folders", ["file", "file/below", "taken"].map(refused).concat());
    assert_eq!(names(folder.path()), ["driftworld-unity", "file", "taken"]);
}

#[test]
fn a_path_that_the_client_breaks_is_warned_of() {
    let folder = scratch();
    executable(folder.path(), "ours");
    let notes = |name| installed(folder.path(), &[name, "--executable", "driftworld-unity"]).1;
    let said = ["my.app", "l2.x86_64/bin", "old [2022]"].map(notes).concat();
    insta::assert_snapshot!("odd_paths", said.replace(text(folder.path()), "FOLDER"));
}

#[test]
fn programs_get_json() {
    let folder = scratch();
    executable(folder.path(), "ours");
    let (said, _) = installed(folder.path(), &["app", "--json", "--executable", "driftworld-unity"]);
    let said: serde_json::Value = serde_json::from_str(&said).expect("--json prints JSON");
    let target = folder.path().join("app/l2explorer.x86_64");
    assert_eq!(said["installed"], text(&target));
    assert_eq!(said["copied_from"], "driftworld-unity");
    assert_eq!(said["environment"]["L2EXPLORER_APP"], text(&target));
    assert_eq!(said["environment"]["L2EXPLORER_WORKER_ID"], "0");
}
