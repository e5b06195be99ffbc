//! A Parquet or Arrow file that takes batches of rows, and why it cannot be written. What the rows are is said by the others.

use std::io::Write;

use arrow_array::RecordBatch;
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;

use super::Format;

/// Why a table could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnsError {
    /// Writing Parquet failed.
    #[error("the Parquet file cannot be written: {0}; is the disk full?")]
    Parquet(#[from] ParquetError),
    /// Writing Arrow failed.
    #[error("the Arrow file cannot be written: {0}; is the disk full?")]
    Arrow(#[from] ArrowError),
    /// A whole number is larger than the columns of a table of logs hold.
    #[error(
        "column {column}: found {found}, expected at most {} in Parquet and Arrow; write it as .tsv or .csv",
        i64::MAX
    )]
    Number {
        /// The column.
        column: String,
        /// The number.
        found: u64,
    },
}

/// A file of either format, which takes batches.
pub(super) enum Sink<W: Write + Send> {
    Parquet(Box<ArrowWriter<W>>),
    Arrow(Box<FileWriter<W>>),
}

impl<W: Write + Send> Sink<W> {
    pub(super) fn new(writer: W, schema: SchemaRef, format: Format) -> Result<Self, ColumnsError> {
        Ok(match format {
            Format::Parquet => {
                let properties = WriterProperties::builder()
                    .set_compression(Compression::SNAPPY)
                    .set_created_by(format!("driftworld {}", env!("CARGO_PKG_VERSION")))
                    .build();
                Self::Parquet(Box::new(ArrowWriter::try_new(writer, schema, Some(properties))?))
            }
            Format::Arrow => Self::Arrow(Box::new(FileWriter::try_new(writer, &schema)?)),
        })
    }

    /// Adds a batch; in Parquet it is a row group, so that readers skip to those they want and memory stays bounded.
    pub(super) fn write(&mut self, batch: &RecordBatch) -> Result<(), ColumnsError> {
        match self {
            Self::Parquet(writer) => writer.write(batch).and_then(|()| writer.flush())?,
            Self::Arrow(writer) => writer.write(batch)?,
        }
        Ok(())
    }

    /// Ends the file and hands back what it was written to.
    pub(super) fn finish(self) -> Result<W, ColumnsError> {
        Ok(match self {
            Self::Parquet(writer) => writer.into_inner()?,
            Self::Arrow(mut writer) => {
                writer.finish()?;
                writer.into_inner()?
            }
        })
    }
}
