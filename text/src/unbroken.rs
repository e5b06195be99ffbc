//! Keeps words together on one line, such as a number and its unit: their spaces become no-break spaces until the text is shown.

/// The no-break space, which replaces a space at which a line must not break.
pub const NO_BREAK: char = '\u{a0}';

/// The text with its spaces replaced by no-break spaces.
///
/// # Example
/// ```
/// use driftworld_text::{whole, with_blanks};
/// assert_eq!(whole("8 × 8 m"), "8\u{a0}×\u{a0}8\u{a0}m");
/// assert_eq!(with_blanks(&whole("8 × 8 m")), "8 × 8 m");
/// ```
pub fn whole(text: &str) -> String {
    text.replace(' ', "\u{a0}")
}

/// The text for display, with plain spaces again.
pub fn with_blanks(text: &str) -> String {
    text.replace(NO_BREAK, " ")
}
