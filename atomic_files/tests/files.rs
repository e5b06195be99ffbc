//! At every moment, a file that is being written is missing, unchanged or complete.

use std::fs;
use std::io::Write;
use std::path::Path;

use driftworld_atomic_files::{AtomicFile, ScratchFolder, is_unfinished, remove_leftovers, write};

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder can be created")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder exists").flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn file_appears_whole_or_not_at_all() {
    let folder = scratch();
    let path = folder.path().join("made/for/it/a.txt");
    let mut file = AtomicFile::create(&path).expect("the folder can be created");
    file.write_all(b"half").expect("the file can be written");
    assert!(!path.exists());
    drop(file);
    let parent = path.parent().expect("the path has a parent");
    assert_eq!(names(parent), [""; 0], "a dropped file is removed");
    write(&path, b"whole").expect("the file can be written");
    let mut file = AtomicFile::create(&path).expect("the folder is writable");
    file.write_all(b"other").expect("the file can be written");
    assert_eq!(fs::read(&path).expect("it is there"), b"whole");
    file.commit().expect("the folder is writable");
    assert_eq!(fs::read(&path).expect("it is there"), b"other");
    assert_eq!(names(parent), ["a.txt"]);
}

#[test]
fn long_names_are_shortened_and_folders_are_refused() {
    let folder = scratch();
    drop(AtomicFile::create(&folder.path().join("ä".repeat(120))).expect("long names are shortened"));
    assert!(names(folder.path()).is_empty());
    let error = AtomicFile::create(folder.path()).expect_err("a folder is refused");
    assert_eq!(error.kind(), std::io::ErrorKind::IsADirectory);
}

#[test]
fn leftovers_are_removed_and_files_being_written_stay() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    let mut file = AtomicFile::create(&at("a.jsonl")).expect("the folder is writable");
    file.write_all(b"half").expect("the file can be written");
    for name in ".a.jsonl.1.driftworld-part .b.1.driftworld-part .a.jsonl.swp c.driftworld-part".split(' ') {
        fs::write(at(name), "half").expect("the folder is writable");
    }
    remove_leftovers(folder.path());
    let left = names(folder.path());
    assert_eq!(left.len(), 3, "{left:?}");
    assert!(left.contains(&".a.jsonl.swp".to_owned()) && left.contains(&"c.driftworld-part".to_owned()));
    assert!(left.iter().any(|name| is_unfinished(name)));
    file.commit().expect("the folder is writable");
    assert!(at("a.jsonl").exists());
}

#[test]
fn abandoned_scratch_folders_are_removed_and_those_in_use_stay() {
    let folder = scratch();
    fs::create_dir_all(folder.path().join(".work-killed/deep")).expect("the folder is writable");
    let first = ScratchFolder::new(".work-", folder.path()).expect("the folder is writable");
    assert!(!folder.path().join(".work-killed").exists());
    let second = ScratchFolder::new(".work-", folder.path()).expect("the folder is writable");
    assert!(first.path().is_dir() && second.path().is_dir());
    first.close().expect("the folder can be removed");
    drop(second);
    assert!(names(folder.path()).is_empty());
}

#[cfg(unix)]
mod unix {
    use std::io::Read;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    use super::*;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).expect("it is there").permissions().mode() & 0o777
    }

    #[test]
    fn replaced_file_keeps_its_mode_and_new_file_follows_the_umask() {
        let folder = scratch();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("plain"), "").expect("the folder is writable");
        write(&at("new"), b"x").expect("the file can be written");
        assert_eq!(mode(&at("new")), mode(&at("plain")), "a new file follows the umask");
        for kept in [0o600, 0o640, 0o666, 0o644, 0o755, 0o400] {
            let path = at(&format!("{kept:o}"));
            fs::write(&path, "before").expect("the folder is writable");
            fs::set_permissions(&path, fs::Permissions::from_mode(kept)).expect("it is ours");
            let mut file = AtomicFile::create(&path).expect("the folder is writable");
            file.write_all(b"after").expect("the file can be written");
            let part = names(folder.path()).into_iter().find(|name| is_unfinished(name));
            let part = mode(&at(&part.expect("an unfinished file is in the folder")));
            assert_eq!(
                part & !kept,
                0,
                "the unfinished file is never more permissive than the final one: {part:o}, {kept:o}"
            );
            file.commit().expect("the folder is writable");
            assert_eq!(mode(&path), kept, "{:o}, expected {kept:o}", mode(&path));
        }
    }

    /// Only root may change a file's owner; for other users the test checks nothing.
    #[test]
    fn replaced_file_keeps_its_owner_where_permitted() {
        let folder = scratch();
        let path = folder.path().join("theirs");
        fs::write(&path, "before").expect("the folder is writable");
        if std::os::unix::fs::chown(&path, Some(12_345), Some(23_456)).is_err() {
            return;
        }
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("it is ours");
        write(&path, b"after").expect("the folder is writable");
        let found = fs::metadata(&path).expect("it is there");
        assert_eq!((found.uid(), found.gid(), mode(&path)), (12_345, 23_456, 0o640));
    }

    #[test]
    fn links_stay_and_their_targets_are_written() {
        let folder = scratch();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("far")).expect("the folder is writable");
        for (link, to) in [("first", "far/a"), ("second", "first"), ("nowhere", "far/new")] {
            symlink(to, at(link)).expect("links can be created");
        }
        write(&at("second"), b"1").expect("the file can be written");
        write(&at("nowhere"), b"2").expect("the file can be written");
        assert!(at("first").is_symlink() && at("second").is_symlink() && at("nowhere").is_symlink());
        assert_eq!(fs::read(at("far/a")).expect("it is there"), b"1");
        assert_eq!(fs::read(at("far/new")).expect("it is there"), b"2");
        assert_eq!(names(&at("far")), ["a", "new"]);
        let file = AtomicFile::create_in_place_of_links(&at("second")).expect("the folder is writable");
        file.commit().expect("the folder is writable");
        assert!(!at("second").is_symlink());
        assert_eq!(fs::read(at("far/a")).expect("it is there"), b"1");
    }

    #[test]
    fn writing_to_circular_links_terminates() {
        let folder = scratch();
        let at = |name: &str| folder.path().join(name);
        symlink("b", at("a")).expect("links can be created");
        symlink("a", at("b")).expect("links can be created");
        // The link may be replaced or refused, but the call returns.
        let _ = write(&at("a"), b"x");
    }

    #[test]
    fn devices_and_pipes_are_written_directly() {
        let folder = scratch();
        let mut null = AtomicFile::create(Path::new("/dev/null")).expect("/dev/null exists");
        assert!(null.is_straight());
        null.write_all(b"gone").expect("/dev/null accepts any output");
        null.commit().expect("commit only flushes");
        let pipe = folder.path().join("pipe");
        let mkfifo = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(mkfifo.is_ok_and(|mkfifo| mkfifo.success()));
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || {
                let mut file = fs::File::open(pipe).expect("it is there");
                let mut first = [0; 5];
                file.read_exact(&mut first).expect("the writer sends five bytes");
                let mut rest = String::new();
                file.read_to_string(&mut rest).expect("the writer closes the pipe");
                (first, rest)
            })
        };
        let mut file = AtomicFile::create(&pipe).expect("the pipe has a reader");
        file.write_all(b"first").expect("the pipe has a reader");
        file.write_all(b"second").expect("the pipe has a reader");
        assert!(file.is_straight());
        file.commit().expect("commit only flushes");
        drop(
            reader
                .join()
                .map(|found| assert_eq!(found, (*b"first", "second".to_owned()))),
        );
        assert_eq!(names(folder.path()), ["pipe"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn open_descriptors_are_appended_to() {
        use std::os::fd::AsRawFd;
        let folder = scratch();
        let path = folder.path().join("open");
        fs::write(&path, "before ").expect("the folder is writable");
        let open = fs::File::open(&path).expect("it is there");
        let name = format!("/dev/fd/{}", open.as_raw_fd());
        let link = folder.path().join("link");
        symlink(&name, &link).expect("links can be created");
        for place in [Path::new(&name), &link] {
            write(place, b"after ").expect("the descriptor is open");
        }
        assert_eq!(fs::read_to_string(&path).expect("it is there"), "before after after ");
        assert!(driftworld_atomic_files::is_own_stdout(Path::new("/dev/stdout")));
        assert!(!driftworld_atomic_files::is_own_stdout(Path::new("/dev/stderr")));
        assert!(!driftworld_atomic_files::is_own_stdout(&path));
    }
}

/// A folder that was just created is not removed as a leftover, even if others are created next to it at the same time.
#[test]
fn scratch_folders_created_concurrently_do_not_remove_each_other() {
    let base = tempfile::tempdir().expect("a temporary folder can be created");
    std::thread::scope(|threads| {
        for _ in 0..8 {
            threads.spawn(|| {
                for _ in 0..200 {
                    let folder = ScratchFolder::new(".scratch-", base.path()).expect("the folder is writable");
                    assert!(folder.path().is_dir(), "another thread removed it");
                    fs::write(folder.path().join("file"), "text").expect("the folder is writable");
                }
            });
        }
    });
    let left = fs::read_dir(base.path()).expect("the folder exists").count();
    assert_eq!(left, 0);
}
