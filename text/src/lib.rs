//! Text that others wrote, on its way to a terminal, a table or a file name: documents, logs, settings and names of
//! files may say anything.
//!
//! Seven ideas, a file each: `printable.rs` shows characters that a terminal obeys or hides, `cell.rs` guards what a
//! spreadsheet would take for a formula, `name.rs` says what variants, tasks and groups may be called, `number.rs`
//! leaves the noise of rounding out of numbers, `unbroken.rs` keeps together what no line breaks, `phrases.rs` counts and lists things,
//! `removed.rs` lists the words that are no longer taken, `json/` reads JSON. Files and printing are not here.

mod cell;
pub mod json;
mod name;
mod number;
mod phrases;
mod plain;
mod printable;
mod removed;
mod unbroken;

pub use cell::{Cells, cell, unguarded};
pub use name::{IDENTIFIER_PATTERN, MAX_NAME_BYTES, MAX_NAME_CHARACTERS, NAME_PATTERN, NameFault, check_name};
pub use number::amount;
pub use phrases::{counted, first_of, joined_or, shortened, when};
pub use plain::in_plain_words;
pub use printable::{OneLine, ShownPath, is_unprintable, one_line, printable, printable_json, printable_lines, quoted};
pub use removed::{WordKind, removed, removed_words};
pub use unbroken::{NO_BREAK, whole, with_blanks};
