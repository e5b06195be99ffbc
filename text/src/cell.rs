//! Guards table cells against spreadsheets, which run text that starts like a formula. The CSV writer handles commas and quotes.

use std::borrow::Cow;

/// How to write untrusted text into tables for spreadsheets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cells {
    /// Guarded by [`cell`].
    #[default]
    Guarded,
    /// Unchanged.
    Raw,
}

impl Cells {
    /// The cell for this text.
    pub fn cell(self, text: &str) -> Cow<'_, str> {
        match self {
            Self::Guarded => cell(text),
            Self::Raw => Cow::Borrowed(text),
        }
    }
}

/// A cell that no spreadsheet reads as a formula.
///
/// Text that begins with `=`, `+`, `-`, `@`, a tab or a line break, and is not a number, gets an apostrophe in front, as OWASP
/// recommends against CSV injection. So does text that begins with apostrophes before one of these. [`unguarded`] restores the text;
/// [`Cells::Raw`] disables the guard.
///
/// # Example
/// ```
/// use driftworld_text::cell;
/// assert_eq!(cell("=1+2"), "'=1+2");
/// assert_eq!(cell("-0.5"), "-0.5");
/// assert_eq!(cell("red"), "red");
/// ```
pub fn cell(text: &str) -> Cow<'_, str> {
    // Full-width forms of the first four also start formulas in East Asian locales.
    let starts = ['=', '+', '-', '@', '\t', '\n', '\r', '＝', '＋', '－', '＠'];
    // Text that looks guarded gets another guard, so that removing one always restores the original.
    let is_formula = text.trim_start_matches('\'').starts_with(starts);
    if is_formula && text.parse::<f64>().is_err() {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// The text of a [`cell`], without the guarding apostrophe if there is one.
///
/// # Example
/// ```
/// use driftworld_text::{cell, unguarded};
/// assert_eq!(unguarded(&cell("=1+2")), "=1+2");
/// assert_eq!(unguarded("'quoted'"), "'quoted'");
/// ```
pub fn unguarded(guarded: &str) -> &str {
    match guarded.strip_prefix('\'') {
        Some(bare) if cell(bare) == guarded => bare,
        _ => guarded,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn check(text: &str, expected: &str) {
        assert_eq!(cell(text), expected, "{text:?}");
        assert_eq!(Cells::Raw.cell(text), text);
        assert_eq!(Cells::Guarded.cell(text), expected);
    }

    #[test]
    fn formulas_are_guarded_and_numbers_are_not() {
        check("=HYPERLINK(\"http://x\";\"y\")", "'=HYPERLINK(\"http://x\";\"y\")");
        check("+1+cmd|' /C calc'!A0", "'+1+cmd|' /C calc'!A0");
        check("-2+3", "'-2+3");
        check("@SUM(1)", "'@SUM(1)");
        check("\t=1", "'\t=1");
        check("\r=1", "'\r=1");
        check("＝1", "'＝1");
        check("-", "'-");
        for plain in [
            "-1", "+1.5e-3", "-inf", "a=1", "", "it's", "'quoted'", "1-2", "find#red",
        ] {
            check(plain, plain);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn guarded_cells_are_not_formulas_and_round_trip(
            start in "['=+@\t\r\n-]{0,3}", rest in "(?s).{0,8}"
        ) {
            let text = start + &rest;
            let guarded = cell(&text);
            let dangerous = guarded.starts_with(['=', '+', '-', '@', '\t', '\r', '\n']);
            prop_assert!(!dangerous || guarded.parse::<f64>().is_ok(), "{guarded:?}");
            prop_assert_eq!(unguarded(&guarded), text.as_str());
        }
    }
}
