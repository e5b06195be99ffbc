//! What belongs together in a line, such as a number and its unit: until it is shown, its blanks are no-break spaces. Where lines
//! are broken is the business of those who lay texts out.

/// Stands for a blank at which no line is broken.
pub const NO_BREAK: char = '\u{a0}';

/// A text that belongs together.
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

/// A text as it is shown: with a blank for each no-break space.
pub fn with_blanks(text: &str) -> String {
    text.replace(NO_BREAK, " ")
}
