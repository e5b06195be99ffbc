//! A process that is stopped removes its unfinished files. This test is a program of its own, because afterwards the
//! process cannot start another file.

use std::fs;
use std::io::Write;

use driftworld_atomic_files::{AtomicFile, ScratchFolder, remove_unfinished, write};

#[test]
fn unfinished_files_are_removed_and_finished_ones_stay() {
    let base = tempfile::tempdir().expect("a temporary folder can be created");
    let at = |name: &str| base.path().join(name);
    write(&at("done"), b"whole").expect("the file can be written");
    fs::write(at("before"), "before").expect("the folder is writable");
    let folder = ScratchFolder::new(".work-", base.path()).expect("the folder is writable");
    fs::write(folder.path().join("inside"), "half").expect("the folder is writable");
    let files = ["before", "new"].map(|name| {
        let mut file = AtomicFile::create(&at(name)).expect("the folder is writable");
        file.write_all(b"half").expect("the file can be written");
        file
    });
    let dropped = AtomicFile::create(&at("dropped")).expect("the folder is writable");
    drop(dropped);
    remove_unfinished();
    let mut names: Vec<String> = fs::read_dir(base.path())
        .expect("the folder exists")
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["before", "done"]);
    assert_eq!(fs::read_to_string(at("before")).expect("it is there"), "before");
    // Dropping unfinished files would block forever, as would starting new ones.
    std::mem::forget((files, folder));
}
