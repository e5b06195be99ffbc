//! Reads the log of a lifetime from files given to a page: the data of its learning curve, and the episodes with
//! recorded actions. It neither checks nor scores the log.

use std::collections::BTreeSet;
use std::io::Cursor;

use driftworld::env::{Recording, RecordingReader};
use driftworld::metrics::STANDARD_COLUMNS;
use serde_json::{Value, json};

use crate::call::File;
use crate::fault::Fault;

/// Maximum number of rows of a log.
const MAX_ROWS: usize = 1_000_000;

/// The recordings of the log that was read last.
#[derive(Default)]
pub(crate) struct Log {
    recordings: Vec<Vec<u8>>,
}

impl Log {
    /// Reads the files of a log; `bytes` holds the contents of all files, one after the other.
    pub(crate) fn read(files: &[File], mut bytes: &[u8]) -> Result<(Self, Value), Fault> {
        let mut log = Self::default();
        let (mut rows, mut warnings): (Vec<Value>, Vec<String>) = (Vec::new(), Vec::new());
        let (mut tasks, mut metrics): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
        let mut recorded = BTreeSet::new();
        for file in files {
            let (contents, rest) = bytes
                .split_at_checked(file.length)
                .ok_or_else(|| Fault::request(format!("{}: found fewer bytes than stated, expected all", file.path)))?;
            bytes = rest;
            let name = file.path.rsplit('/').next().unwrap_or_default();
            if name == "data-log.tsv" {
                read_rows(&file.path, contents, &mut rows, &mut tasks, &mut metrics, &mut warnings)?;
            } else if name.rsplit_once('.').is_some_and(|(_, ending)| ending == "jsonl") {
                match RecordingReader::new(Cursor::new(contents)) {
                    Ok(mut reader) => loop {
                        match reader.next_episode() {
                            Ok(Some(episode)) => recorded.extend([episode.origin.experience]),
                            Ok(None) => break,
                            Err(error) => warnings.push(format!("{}: {error}", file.path)),
                        }
                    },
                    Err(error) => warnings.push(format!("{}: {error}", file.path)),
                }
                log.recordings.push(contents.to_vec());
            }
        }
        if rows.is_empty() && log.recordings.is_empty() {
            return Err(Fault::new(
                "log/empty",
                "log: found no data-log.tsv and no actions.jsonl, expected the folder that `driftworld run --log` wrote",
            ));
        }
        rows.sort_by_key(|row| (row["experience"].as_u64(), row["block"].as_u64()));
        for row in &mut rows {
            row["recorded"] = json!(
                row["experience"]
                    .as_u64()
                    .is_some_and(|number| recorded.contains(&number))
            );
        }
        Ok((
            log,
            json!({ "tasks": tasks, "metrics": metrics, "episodes": rows, "warnings": warnings }),
        ))
    }

    /// A recorded episode by its number.
    pub(crate) fn recording(&self, experience: u64) -> Result<Recording, Fault> {
        for bytes in &self.recordings {
            let Ok(mut reader) = RecordingReader::new(Cursor::new(&bytes[..])) else {
                continue;
            };
            loop {
                match reader.next_episode() {
                    Ok(Some(episode)) if episode.origin.experience == experience => {
                        return Ok(reader.recording(&episode)?);
                    }
                    Ok(Some(_)) | Err(_) => {}
                    Ok(None) => break,
                }
            }
        }
        Err(Fault::request(format!(
            "experience: found {experience}, expected one whose actions were recorded; record with `driftworld run --record`"
        )))
    }
}

fn read_rows(
    path: &str,
    bytes: &[u8],
    rows: &mut Vec<Value>,
    tasks: &mut Vec<String>,
    metrics: &mut Vec<String>,
    warnings: &mut Vec<String>,
) -> Result<(), Fault> {
    let text = String::from_utf8_lossy(bytes);
    let mut table = csv::ReaderBuilder::new();
    let mut table = table.delimiter(b'\t').flexible(true).from_reader(text.as_bytes());
    let unreadable = |error: csv::Error| Fault::new("log/header", format!("{path}: {error}"));
    let header = table.headers().map_err(unreadable)?.clone();
    let find = |name: &str| header.iter().position(|column| column == name);
    let needed = ["block_num", "exp_num", "block_type", "task_name"].map(find);
    let [Some(block), Some(experience), Some(kind), Some(task)] = needed else {
        return Err(Fault::new(
            "log/header",
            format!(
                "{path}:1: found the columns {}, expected those of a log",
                header.iter().collect::<Vec<_>>().join(", ")
            ),
        ));
    };
    for name in header.iter().filter(|name| !STANDARD_COLUMNS.contains(name)) {
        if !metrics.iter().any(|known| known == name) {
            metrics.push(name.to_owned());
        }
    }
    let (reward, steps) = (find("reward"), find("steps").or_else(|| find("episode_step_count")));
    for (number, cells) in (2..).zip(table.records()) {
        let cells = cells.map_err(unreadable)?;
        if cells.len() != header.len() {
            warnings.push(format!(
                "{path}:{number}: found {} cells, expected {}; left out",
                cells.len(),
                header.len()
            ));
            continue;
        }
        if rows.len() == MAX_ROWS {
            return Err(Fault::new(
                "log/too-long",
                format!("{path}:{number}: found more than {MAX_ROWS} rows, expected at most that many"),
            ));
        }
        let whole = |index: usize| cells[index].parse::<u64>().unwrap_or_default();
        let number = |index: Option<usize>| index.and_then(|index| cells[index].parse::<f64>().ok());
        if !tasks.iter().any(|known| *known == cells[task]) {
            tasks.push(cells[task].to_owned());
        }
        rows.push(json!({
            "block": whole(block), "experience": whole(experience), "block_type": cells[kind], "task": cells[task],
            "reward": number(reward), "steps": number(steps),
        }));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_cells_are_read_and_short_rows_are_left_out() {
        let text = "block_num\texp_num\tblock_type\ttask_name\treward\r\n0\t7\ttrain\t\"a\t\"\"b\"\"\"\t2.5\r\n0\t8\ttrain\r\n";
        let file = File {
            path: "log/data-log.tsv".to_owned(),
            length: text.len(),
        };
        let (_, found) = Log::read(&[file], text.as_bytes()).expect("the log is valid");
        assert_eq!(
            (&found["tasks"], &found["metrics"]),
            (&json!(["a\t\"b\""]), &json!(["reward"]))
        );
        let episode = &found["episodes"][0];
        assert_eq!((&episode["experience"], &episode["reward"]), (&json!(7), &json!(2.5)));
        assert_eq!(
            found["warnings"],
            json!(["log/data-log.tsv:3: found 3 cells, expected 5; left out"])
        );
    }
}
