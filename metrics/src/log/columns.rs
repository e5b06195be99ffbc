//! The columns of a data file, and their order.

use crate::Record;

/// The standard columns of format 1.1, in order; the metrics follow in alphabetical order.
pub const STANDARD_COLUMNS: [&str; 9] = [
    "block_num",
    "exp_num",
    "worker_id",
    "block_type",
    "block_subtype",
    "task_name",
    "task_params",
    "exp_status",
    "timestamp",
];

/// The one standard column that logs of format 1.0 lack.
pub(super) const SUBTYPE_COLUMN: &str = "block_subtype";

/// Names of a record's metrics and text columns, sorted by code point.
pub(super) fn metric_columns(record: &Record) -> Vec<String> {
    let mut names: Vec<String> = record.metrics.keys().chain(record.texts.keys()).cloned().collect();
    names.sort();
    names
}

/// The whole header of a log with these metrics.
pub(super) fn header(metrics: &[String]) -> Vec<String> {
    STANDARD_COLUMNS
        .iter()
        .map(ToString::to_string)
        .chain(metrics.iter().cloned())
        .collect()
}

/// One line of a data file, with quotes where necessary, and its line ending.
///
/// The crate `csv` quotes a bare carriage return only if lines end with one, so the line is written with a CRLF ending, which is
/// then replaced by a single `\n`, as in l2logger.
pub(crate) fn line(cells: impl IntoIterator<Item = impl AsRef<[u8]>>) -> Vec<u8> {
    delimited(b'\t', cells)
}

/// Like [`line`], with a given separator.
pub(super) fn delimited(delimiter: u8, cells: impl IntoIterator<Item = impl AsRef<[u8]>>) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new()
        .delimiter(delimiter)
        .terminator(csv::Terminator::CRLF)
        .from_writer(Vec::new());
    writer
        .write_record(cells)
        .expect("writing to memory does not fail, and a single record has a consistent length");
    let mut bytes = writer.into_inner().expect("writing to memory does not fail");
    bytes.truncate(bytes.len() - 2);
    bytes.push(b'\n');
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_only_if_necessary() {
        let check = |cells: &[&str], expected: &str| {
            assert_eq!(String::from_utf8(line(cells)).unwrap(), expected);
        };
        check(&["0", r#"{"a": 1}"#, "{}"], "0\t\"{\"\"a\"\": 1}\"\t{}\n");
        check(&["a b", "it's", "a,b", "", "#"], "a b\tit's\ta,b\t\t#\n");
        check(
            &["tab\there", "line\nend", "carriage\rreturn"],
            "\"tab\there\"\t\"line\nend\"\t\"carriage\rreturn\"\n",
        );
    }

    #[test]
    fn metrics_follow_the_standard_columns_alphabetically() {
        let stamp = "20200101T000000.0".parse().unwrap();
        let record = Record::new(0, 0, crate::BlockType::Train, "a_b", stamp);
        let record = record
            .with_metric("reward", 1.0)
            .with_metric("Steps", 2.0)
            .with_metric("done", 0.0);
        assert_eq!(header(&metric_columns(&record))[9..], ["Steps", "done", "reward"]);
    }
}
