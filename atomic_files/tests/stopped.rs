//! A process that is stopped removes what it has not finished. In a program of its own: afterwards nothing can be
//! begun.

use std::fs;
use std::io::Write;

use driftworld_atomic_files::{AtomicFile, ScratchFolder, remove_unfinished, write};

#[test]
fn what_is_not_finished_goes_and_what_is_stays() {
    let base = tempfile::tempdir().expect("the machine has a folder for temporary files");
    let at = |name: &str| base.path().join(name);
    write(&at("done"), b"whole").expect("there is room");
    fs::write(at("before"), "before").expect("the folder is ours");
    let folder = ScratchFolder::new(".work-", base.path()).expect("the folder is ours");
    fs::write(folder.path().join("inside"), "half").expect("the folder is ours");
    let files = ["before", "new"].map(|name| {
        let mut file = AtomicFile::create(&at(name)).expect("the folder is ours");
        file.write_all(b"half").expect("there is room");
        file
    });
    let dropped = AtomicFile::create(&at("dropped")).expect("the folder is ours");
    drop(dropped);
    remove_unfinished();
    let mut names: Vec<String> = fs::read_dir(base.path())
        .expect("the folder is there")
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["before", "done"]);
    assert_eq!(fs::read_to_string(at("before")).expect("it is there"), "before");
    // Dropping what is unfinished would wait for ever, as would beginning anything.
    std::mem::forget((files, folder));
}
