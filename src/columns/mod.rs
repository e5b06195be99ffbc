//! Worlds and logs as Parquet and Arrow files, for use at scale. Writing them needs the feature `parquet`: what it links takes longer to
//! build than most of the rest.

#[cfg(feature = "parquet")]
mod logs;
#[cfg(feature = "parquet")]
mod sink;
#[cfg(feature = "parquet")]
mod worlds;

use std::path::Path;

#[cfg(feature = "parquet")]
pub use logs::write_log_table;
#[cfg(feature = "parquet")]
pub use sink::ColumnsError;
#[cfg(feature = "parquet")]
pub use worlds::{Row, WorldTable};

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Apache Parquet, compressed by Snappy.
    Parquet,
    /// The Arrow IPC file format, which is also Feather's second version.
    Arrow,
}

impl Format {
    /// The format that a file's ending names: `.parquet`, `.arrow`, `.feather`; `None` for any other.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "parquet" => Some(Self::Parquet),
            "arrow" | "feather" => Some(Self::Arrow),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_is_known_by_its_ending() {
        assert_eq!(Format::of(Path::new("a/b.parquet")), Some(Format::Parquet));
        assert_eq!(Format::of(Path::new("b.feather")), Some(Format::Arrow));
        assert_eq!(Format::of(Path::new("b.jsonl")), None);
    }
}
