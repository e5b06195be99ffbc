//! `driftworld logs aggregate`: exports the rows of logs as one table in a file.

use std::io::BufWriter;
use std::path::PathBuf;

use crate::metrics::{Delimiter, KeptRows, LogTable, read_log_with_texts};
use clap::Args;

use super::super::output;
use super::count;
use crate::numbers::documented;
use crate::table::cells;
use crate::{Failure, log_folders, overwrite};

/// Write the rows of one or several logs as one table.
///
/// The columns are those of l2logger's aggregate: `block_num`, `regime_num`, `exp_num` and the other standard ones,
/// then the log's own in alphabetical order. With several logs, `run_id` comes first: the name of the log's folder,
/// preceded by parent folders if names repeat. A regime is a run of rows with one block, subtype and task. Task names
/// are in lower case, as for scoring. Rows of incomplete experiences are left out unless --incomplete is given.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld logs aggregate demo-out/log -o demo.tsv
  driftworld logs aggregate logs --recursive -o all.csv
  driftworld logs aggregate demo-out/log --format csv -o - | head")]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct Aggregate {
    /// Folders of logs.
    #[arg(required = true, value_name = "DIR")]
    logs: Vec<PathBuf>,
    /// File to write: .tsv or .csv, or - for standard output.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Format, if the file name's ending does not imply it.
    #[arg(long, value_parser = documented::<Delimiter>(&FORMATS), value_name = "FORMAT")]
    format: Option<Delimiter>,
    /// Search the folders for logs, up to four levels deep. Links are not followed.
    #[arg(short = 'R', long)]
    recursive: bool,
    /// Keep rows of incomplete experiences.
    #[arg(long)]
    incomplete: bool,
    /// Do not escape cells that a spreadsheet would read as formulas.
    ///
    /// By default, TSV and CSV cells get an apostrophe if they begin with =, +, -, @, a tab or a line break and are not
    /// numbers.
    #[arg(long)]
    raw_cells: bool,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// The formats by file name extension.
const FORMATS: [&str; 2] = ["tsv: Tab-separated values", "csv: Comma-separated values"];

impl Aggregate {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let delimiter = self.delimiter()?;
        let logs = log_folders::found(&self.logs, self.recursive)?;
        overwrite::refuse_log_files(&self.output)?;
        let mut table = LogTable::new(if self.incomplete {
            KeptRows::All
        } else {
            KeptRows::Complete
        });
        for (folder, name) in logs.iter().zip(log_folders::names(&logs)) {
            let mut log = read_log_with_texts(folder)?;
            for warning in &log.warnings {
                output::warning(log_folders::placed(folder, &warning.to_string()));
            }
            log.run_id = name;
            table.add(log)?;
        }
        if output::is_stdout(&self.output) {
            return self.print(&table, delimiter);
        }
        self.write(&table, delimiter)?;
        let (rows, logs) = (table.len() as u64, logs.len() as u64);
        let what = format!("{} of {}", count(rows, "row"), count(logs, "log"));
        output::wrote(&self.output, what);
        output::json_of_what_was_written(self.json)
    }

    fn delimiter(&self) -> Result<Delimiter, Failure> {
        let ending = self
            .output
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or_default();
        let by_name = match ending {
            "tsv" => Some(Delimiter::Tab),
            "csv" => Some(Delimiter::Comma),
            _ => None,
        };
        output::refuse_removed_ending(&self.output)?;
        let found = self.output.display().to_string();
        match (self.format, by_name) {
            (Some(format), Some(by_name)) if format != by_name => Err(Failure::usage(format!(
                "--format: found a format that differs from the ending of {found:?}, expected the same; leave one of \
                 them out"
            ))),
            (Some(format), _) | (None, Some(format)) => Ok(format),
            (None, None) => Err(Failure::usage(format!(
                "--output: found {found:?}, expected a name ending in .tsv or .csv, or the format as --format tsv"
            ))),
        }
    }

    fn write(&self, table: &LogTable, delimiter: Delimiter) -> Result<(), Failure> {
        let failed = |error: &dyn std::fmt::Display| output::unwritable(&self.output, error);
        let mut file = BufWriter::new(output::create(&self.output)?);
        table
            .write(&mut file, delimiter, cells(self.raw_cells))
            .map_err(|error| failed(&error))?;
        let file = file.into_inner().map_err(|error| failed(&error.into_error()))?;
        file.commit().map_err(|error| failed(&error))
    }

    fn print(&self, table: &LogTable, delimiter: Delimiter) -> Result<(), Failure> {
        let failed = |error: &dyn std::fmt::Display| Failure::input(format!("standard output: {error}"));
        let mut bytes = Vec::new();
        table
            .write(&mut bytes, delimiter, cells(self.raw_cells))
            .map_err(|error| failed(&error))?;
        let text = String::from_utf8(bytes).map_err(|error| failed(&error))?;
        output::carries_data();
        if self.raw_cells {
            output::print_data(&text)
        } else {
            output::print(&text)
        }
    }
}
