//! `driftworld logs aggregate`: the rows of logs as one table in a file. Which rows and columns it has is `metrics`'s business.

use std::io::{BufWriter, Write};
use std::path::PathBuf;

#[cfg(feature = "parquet")]
use crate::columns;
use crate::metrics::{Delimiter, KeptRows, LogTable, read_log_with_texts};
use clap::{Args, ValueEnum};
use driftworld_text::Cells;

use super::super::{Failure, log_folders, output, overwrite};
use super::count;
use crate::table::cells;

/// Write the rows of one or several logs as one table.
///
/// The columns are those of l2logger's aggregate: `block_num`, `regime_num`, `exp_num` and the other standard ones,
/// then the log's own in alphabetical order. With several logs, `run_id` comes first: the name of the log's folder,
/// preceded by parent folders if names repeat. A regime is a run of rows with one block, subtype and task. Task names
/// are in lower case, as for scoring. Rows of incomplete experiences are left out unless --incomplete is given.
///
/// Parquet and Feather keep types: integers, dictionaries for repeated strings, time stamps in microseconds, floats,
/// and null for missing values. Feather is the Arrow file format, which pandas, polars and pyarrow read.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld logs aggregate demo-out/log -o demo.tsv
  driftworld logs aggregate logs --recursive -o all.parquet
  driftworld logs aggregate demo-out/log --format csv -o - | head")]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct Aggregate {
    /// Folders of logs.
    #[arg(required = true, value_name = "DIR")]
    logs: Vec<PathBuf>,
    /// File to write: .tsv, .csv, .parquet, .feather or .arrow, or - for standard output.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Format, if the file name does not tell it.
    #[arg(long, value_enum, value_name = "FORMAT")]
    format: Option<Format>,
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

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Tab-separated values.
    Tsv,
    /// Comma-separated values.
    Csv,
    /// Apache Parquet.
    Parquet,
    /// Feather version 2, the Arrow file format.
    Feather,
}

impl Aggregate {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let format = self.format()?;
        #[cfg(not(feature = "parquet"))]
        if matches!(format, Format::Parquet | Format::Feather) {
            return Err(lacks_parquet());
        }
        let logs = if self.recursive {
            log_folders::below(&self.logs)?
        } else {
            log_folders::named(&self.logs)?
        };
        overwrite::refuse_log_files(&self.output)?;
        let mut table = LogTable::new(if self.incomplete {
            KeptRows::All
        } else {
            KeptRows::Complete
        });
        for (log, name) in logs.iter().zip(log_folders::names(&logs)) {
            // Warnings are the business of `logs validate`: nothing of a row is lost for them.
            let mut log = read_log_with_texts(log)?;
            log.run_id = name;
            table.add(&log)?;
        }
        if output::is_stdout(&self.output) {
            return self.print(&table, format);
        }
        self.write(&table, format)?;
        let (rows, logs) = (table.len() as u64, logs.len() as u64);
        let what = format!("{} of {}", count(rows, "row", "rows"), count(logs, "log", "logs"));
        output::wrote(&self.output, what);
        if self.json {
            return output::json_of_what_was_written();
        }
        Ok(())
    }

    fn format(&self) -> Result<Format, Failure> {
        let ending = self
            .output
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or_default();
        let by_name = match ending {
            "tsv" => Some(Format::Tsv),
            "csv" => Some(Format::Csv),
            "parquet" => Some(Format::Parquet),
            "feather" | "arrow" => Some(Format::Feather),
            _ => None,
        };
        let found = self.output.display().to_string();
        match (self.format, by_name) {
            (Some(format), Some(by_name)) if format != by_name => Err(Failure::usage(format!(
                "--format: found a format that differs from the ending of {found:?}, expected the same; leave one of \
                 them out"
            ))),
            (Some(format), _) | (None, Some(format)) => Ok(format),
            (None, None) => Err(Failure::usage(format!(
                "--output: found {found:?}, expected a name ending in .tsv, .csv, .parquet, .feather or .arrow, or \
                 the format as \
                 --format tsv"
            ))),
        }
    }

    fn write(&self, table: &LogTable, format: Format) -> Result<(), Failure> {
        let failed = |error: &dyn std::fmt::Display| output::unwritable(&self.output, error);
        let file = output::create(&self.output)?;
        let file =
            written(table, format, cells(self.raw_cells), BufWriter::new(file)).map_err(|error| failed(&error))?;
        let file = file.into_inner().map_err(|error| failed(&error.into_error()))?;
        file.commit().map_err(|error| failed(&error))
    }

    fn print(&self, table: &LogTable, format: Format) -> Result<(), Failure> {
        if matches!(format, Format::Parquet | Format::Feather) {
            return Err(Failure::usage(
                "--output: found - for Parquet or Feather, which are not text, expected the name of a file",
            ));
        }
        let failed = |error: &dyn std::fmt::Display| Failure::input(format!("standard output: {error}"));
        let bytes = written(table, format, cells(self.raw_cells), Vec::new()).map_err(|error| failed(&error))?;
        let text = String::from_utf8(bytes).map_err(|error| failed(&error))?;
        output::carries_data();
        if self.raw_cells {
            output::print_data(&text)
        } else {
            output::print(&text)
        }
    }
}

#[cfg(not(feature = "parquet"))]
fn lacks_parquet() -> Failure {
    super::super::optional::missing("parquet", "writing Parquet and Feather", ", or write .tsv or .csv")
}

/// Writes the table and hands back what it was written to.
fn written<W: Write + Send>(
    table: &LogTable,
    format: Format,
    cells: Cells,
    mut to: W,
) -> Result<W, Box<dyn std::error::Error>> {
    match format {
        Format::Tsv => table.write(&mut to, Delimiter::Tab, cells)?,
        Format::Csv => table.write(&mut to, Delimiter::Comma, cells)?,
        #[cfg(feature = "parquet")]
        Format::Parquet => return Ok(columns::write_log_table(table, to, columns::Format::Parquet)?),
        #[cfg(feature = "parquet")]
        Format::Feather => return Ok(columns::write_log_table(table, to, columns::Format::Arrow)?),
        #[cfg(not(feature = "parquet"))]
        Format::Parquet | Format::Feather => return Err("the feature `parquet` is missing".into()),
    }
    Ok(to)
}
