//! The files that a run leaves, and the parts that repeat when it is run again.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Whether this is the name of a log's table.
pub(crate) fn is_table(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending == "tsv")
}

pub(crate) fn write(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("the scratch folder can be written");
    fs::write(path, text).expect("the scratch folder can be written");
}

/// All files of a log by path, without the time stamps of rows.
pub(crate) fn files(log: &Path) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![log.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the log can be listed") {
            let path = entry.expect("the log can be listed").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path
                .strip_prefix(log)
                .expect("it lies in the log")
                .display()
                .to_string();
            let text = fs::read_to_string(&path).expect("logs are text");
            let text = if is_table(&name) { timeless(&text) } else { text };
            found.insert(name, text);
        }
    }
    found
}

pub(crate) fn timeless(table: &str) -> String {
    let header: Vec<&str> = table.lines().next().unwrap_or_default().split('\t').collect();
    let place = header
        .iter()
        .position(|name| *name == "timestamp")
        .expect("rows say when");
    let row = |line: &str| {
        let mut cells: Vec<&str> = line.split('\t').collect();
        cells.remove(place);
        cells.join("\t") + "\n"
    };
    table.lines().map(row).collect()
}

/// Number of rows in a log, all with a line end.
pub(crate) fn num_rows(log: &Path) -> usize {
    let tables = files(log).into_iter().filter(|(name, _)| is_table(name));
    tables.map(|(_, text)| text.lines().count() - 1).sum()
}

/// All files below a folder; none if the folder does not exist.
pub(crate) fn bytes_below(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(bytes) = fs::read(&path) {
                found.insert(
                    path.display().to_string().replace(&folder.display().to_string(), ""),
                    bytes,
                );
            }
        }
    }
    found
}
