//! Where logs are: the folders named, or all below them. Reading one is `metrics`'s.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf, absolute};

use super::Failure;
use crate::contents::{Contents, OtherContents};
use crate::documents;
use driftworld_text::ShownPath;

/// How deep logs are looked for below a folder that is none itself.
const MOST_LEVELS: usize = 4;

/// The most logs that are taken together.
const MOST_LOGS: usize = 10_000;

/// Every log that the arguments name, in order, those below a folder by name; each once.
pub(crate) fn below(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for argument in arguments {
        is_folder(argument)?;
        let before = found.len();
        collect(argument, MOST_LEVELS, &mut found)?;
        if found.len() == before {
            return Err(Failure::input(format!(
                "{}: found no log, expected a folder with logger_info.json, or folders of such up to {MOST_LEVELS} levels \
                 below; `driftworld run … --logs DIR` writes them",
                argument.shown()
            )));
        }
    }
    Ok(each_once(found))
}

/// Every log that the arguments name, in order, each once. A folder that is no log, but has logs below, is refused with advice.
pub(crate) fn named(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    if let Some(argument) = arguments.iter().find(|argument| !is_log(argument)) {
        is_folder(argument)?;
        let mut below = Vec::new();
        collect(argument, MOST_LEVELS, &mut below)?;
        let path = argument.shown();
        return Err(Failure::input(match below.first() {
            Some(first) => format!(
                "{path}: found a folder of {} logs such as {}, expected one log; name that, or take all with --recursive",
                below.len(),
                first.shown()
            ),
            None => format!(
                "{path}: found no log, expected a folder with logger_info.json and WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv; \
                 `driftworld run … --logs DIR` writes such"
            ),
        }));
    }
    Ok(each_once(arguments.to_vec()))
}

/// What each of several logs is called: its folder's name, with as many of the folders above in front as tell it from the others,
/// such as `a/log` and `b/log`.
pub(crate) fn names(logs: &[PathBuf]) -> Vec<String> {
    let paths: Vec<Vec<String>> = logs.iter().map(|log| folders_to(log)).collect();
    let end = |path: &[String], length: usize| path[path.len().saturating_sub(length)..].join("/");
    let mut names = vec![String::new(); logs.len()];
    let mut alike: Vec<usize> = (0..logs.len()).collect();
    for length in 1.. {
        let mut called: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for log in alike {
            called.entry(end(&paths[log], length)).or_default().push(log);
        }
        alike = Vec::new();
        for (name, logs) in called {
            for &log in &logs {
                names[log].clone_from(&name);
                if logs.len() > 1 && length < paths[log].len() {
                    alike.push(log);
                }
            }
        }
        if alike.is_empty() {
            break;
        }
    }
    names
}

/// The names on the way from the root to a log, as it was named unless that leads back up.
fn folders_to(log: &Path) -> Vec<String> {
    let mut path = absolute(log).unwrap_or_else(|_| log.to_owned());
    if path.components().any(|part| part == Component::ParentDir) {
        path = path.canonicalize().unwrap_or(path);
    }
    path.components()
        .filter_map(|part| match part {
            Component::Normal(name) => Some(name.to_string_lossy().into_owned()),
            _ => None,
        })
        .collect()
}

fn is_folder(argument: &Path) -> Result<(), Failure> {
    let found = match fs::metadata(argument) {
        Ok(kind) if kind.is_dir() => return Ok(()),
        Ok(_) => {
            let shown = documents::text(argument).ok().and_then(|text| Contents::of_text(&text));
            if let Some(other) = OtherContents::check(argument, shown, &[Contents::Log]) {
                return Err(other.into());
            }
            "a file".to_owned()
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => "nothing".to_owned(),
        Err(error) => error.to_string(),
    };
    let path = argument.shown();
    Err(Failure::input(format!(
        "{path}: found {found}, expected the folder of a log, which holds logger_info.json"
    )))
}

fn each_once(mut logs: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut seen = std::collections::BTreeSet::new();
    logs.retain(|log| seen.insert(log.canonicalize().unwrap_or_else(|_| log.clone())));
    logs
}

fn collect(folder: &Path, levels: usize, found: &mut Vec<PathBuf>) -> Result<(), Failure> {
    if is_log(folder) {
        if found.len() == MOST_LOGS {
            let path = folder.shown();
            return Err(Failure::input(format!(
                "{path}: found more than {MOST_LOGS} logs, expected at most that; name fewer folders"
            )));
        }
        found.push(folder.to_owned());
        return Ok(());
    }
    if levels > 0 {
        for folder in folders(folder)? {
            collect(&folder, levels - 1, found)?;
        }
    }
    Ok(())
}

/// Whether a folder is a log, be it one that lacks something.
fn is_log(folder: &Path) -> bool {
    let has_info = ["logger_info.json", "scenario_info.json"]
        .iter()
        .any(|name| folder.join(name).is_file());
    let below = |folder: &Path| folders(folder).unwrap_or_default();
    has_info
        || below(folder)
            .iter()
            .flat_map(|worker| below(worker))
            .any(|block| block.join("data-log.tsv").is_file())
}

/// The folders in a folder, by name.
fn folders(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |error| Failure::input(format!("{}: cannot be read: {error}", folder.shown()));
    let mut below = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_dir() {
            below.push(path);
        }
    }
    below.sort();
    Ok(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_of_one_name_are_told_apart_by_the_folders_above() {
        let check = |logs: &[&str], expected: &[&str]| {
            let logs: Vec<PathBuf> = logs.iter().map(PathBuf::from).collect();
            assert_eq!(names(&logs), expected, "{logs:?}");
        };
        check(&[], &[]);
        check(&["col/x/log"], &["log"]);
        check(&["col/x/log", "col/y/run/"], &["log", "run"]);
        check(
            &["col/x/log", "other", "col/y/./log", "z/y/log"],
            &["x/log", "other", "col/y/log", "z/y/log"],
        );
        // One path is the end of another.
        check(
            &["/log", "/deep/log", "/deep/deep/log"],
            &["log", "deep/log", "deep/deep/log"],
        );
        let here = std::env::current_dir().unwrap();
        let name = here.file_name().unwrap().to_str().unwrap();
        check(&[".", "x/log"], &[name, "log"]);
        check(&["src/.."], &[name]);
    }

    #[test]
    fn logs_are_found_even_where_they_lack_something() {
        let base = tempfile::tempdir().unwrap();
        let file = |path: &str| {
            let path = base.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        };
        file("deep/b/logger_info.json");
        file("deep/a/scenario_info.json");
        file("deep/c/worker/0-train/data-log.tsv");
        file("other/notes.txt");
        let root = base.path().to_owned();
        let names = |found: Vec<PathBuf>| {
            let name = |path: &PathBuf| path.strip_prefix(base.path()).unwrap().to_str().unwrap().to_owned();
            found.iter().map(name).collect::<Vec<_>>()
        };
        assert_eq!(
            names(below(std::slice::from_ref(&root)).unwrap()),
            ["deep/a", "deep/b", "deep/c"]
        );
        assert_eq!(
            names(below(&[root.join("deep/b"), root.join("deep")]).unwrap()),
            ["deep/b", "deep/a", "deep/c"]
        );
        assert_eq!(
            names(named(&[root.join("deep/c"), root.join("deep/c")]).unwrap()),
            ["deep/c"]
        );
        let message = named(&[root.join("deep")]).unwrap_err();
        assert!(message.text().contains("3 logs such as") && message.text().contains("--recursive"));
        assert!(
            named(&[root.join("other")])
                .unwrap_err()
                .text()
                .contains("found no log")
        );
        assert!(below(&[root.join("other")]).unwrap_err().text().contains("4 levels"));
        assert!(
            named(&[root.join("absent")])
                .unwrap_err()
                .text()
                .contains("found nothing")
        );
        assert!(
            below(&[root.join("other/notes.txt")])
                .unwrap_err()
                .text()
                .contains("found a file")
        );
    }
}
