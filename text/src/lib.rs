//! Prepares untrusted text for terminals, tables and file names: documents, logs, settings and file names may contain anything.
//!
//! One file per task: `printable.rs` escapes characters that a terminal executes or hides, `cell.rs` guards against formulas in
//! spreadsheets, `name.rs` checks names of variants, tasks and groups, `number.rs` rounds numbers for reading, `unbroken.rs`
//! keeps words together on one line, `phrases.rs` builds counts and lists, `plain.rs` rewords serde's errors, `removed.rs` lists
//! removed words, `json/` reads JSON.

mod cell;
pub mod json;
mod name;
mod number;
mod phrases;
mod plain;
mod printable;
mod removed;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;
mod unbroken;

pub use cell::{Cells, cell, unguarded};
pub use name::{IDENTIFIER_PATTERN, MAX_NAME_BYTES, MAX_NAME_CHARACTERS, NAME_PATTERN, NameFault, check_name};
pub use number::{amount, rounded, short};
pub use phrases::{capitalized, counted, first_of, joined_or, shortened, when};
pub use plain::in_plain_words;
pub use printable::{
    OneLine, ShownPath, ascii_json, is_unprintable, one_line, printable, printable_json, printable_lines, quoted,
};
pub use removed::{WordKind, removed, removed_words};
pub use unbroken::{NO_BREAK, whole, with_blanks};
