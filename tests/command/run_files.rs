//! Reads the files of a log without timestamps, so that logs of equal runs are equal.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::files_below::files_below;

/// Whether this is the name of a log's table.
pub(crate) fn is_table(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending == "tsv")
}

pub(crate) fn write(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("the scratch folder can be written");
    fs::write(path, text).expect("the scratch folder can be written");
}

/// All files of a log by path, without the timestamps of rows.
pub(crate) fn files(log: &Path) -> BTreeMap<String, String> {
    let file = |(name, bytes): (String, Vec<u8>)| {
        let text = String::from_utf8(bytes).expect("logs are text");
        let text = if is_table(&name) { timeless(&text) } else { text };
        (name, text)
    };
    assert!(log.is_dir(), "{}: there is no log", log.display());
    files_below(log).into_iter().map(file).collect()
}

pub(crate) fn timeless(table: &str) -> String {
    let header: Vec<&str> = table.lines().next().unwrap_or_default().split('\t').collect();
    let column = header
        .iter()
        .position(|name| *name == "timestamp")
        .expect("the table has timestamps");
    let row = |line: &str| {
        let mut cells: Vec<&str> = line.split('\t').collect();
        cells.remove(column);
        cells.join("\t") + "\n"
    };
    table.lines().map(row).collect()
}

/// Number of rows in a log.
pub(crate) fn num_rows(log: &Path) -> usize {
    let tables = files(log).into_iter().filter(|(name, _)| is_table(name));
    tables.map(|(_, text)| text.lines().count() - 1).sum()
}
