//! Checks names of variants, tasks, groups and scenarios against one grammar, which makes them safe as names of files and logs
//! on every system. The document types check that names are unique.

use std::fmt;

use unicode_normalization::char::is_combining_mark;
use unicode_normalization::is_nfc;

use crate::printable::{is_unprintable, quoted};

/// Maximum length of a name in characters.
pub const MAX_NAME_CHARACTERS: usize = 100;

/// Maximum length of a name in bytes of UTF-8: file systems allow 255, and extensions and numbers are appended.
pub const MAX_NAME_BYTES: usize = 200;

/// The part of the grammar that a JSON Schema pattern can express. [`check_name`] checks the rest: length in bytes,
/// normalisation, device names.
///
/// Beyond ASCII it excludes only white space, general punctuation and unprintable characters, so it accepts some
/// symbols that [`check_name`] refuses.
pub const NAME_PATTERN: &str = concat!(
    r"^[^\x00-\x2f\x3a-\x40\x5b-\x5e\x60\x7b-\xa9\u2000-\u206f\u3000-\u3003\ufeff]",
    r"(?:[^\x00-\x2a\x2c\x2f\x3a-\x40\x5b-\x5e\x60\x7b-\xa9\u2000-\u206f\u3000-\u3003\ufeff]*",
    r"[^\x00-\x2a\x2c\x2e\x2f\x3a-\x40\x5b-\x5e\x60\x7b-\xa9\u2000-\u206f\u3000-\u3003\ufeff])?$"
);

/// The narrower form for tasks and parameters, which appear in expressions and in l2logger's `TASK_VARIANT`.
pub const IDENTIFIER_PATTERN: &str = "^[a-z][a-z0-9_]*$";

/// Names that Windows reserves for devices, with any extension and in upper or lower case.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// Why a name is invalid.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NameFault {
    /// The name is empty.
    Empty,
    /// The name has too many characters or bytes.
    TooLong {
        /// Number of characters.
        characters: usize,
        /// Number of bytes in UTF-8.
        bytes: usize,
    },
    /// A character that names may not contain.
    Character(char),
    /// A character that names may not start with.
    Start(char),
    /// The name ends with a dot, which Windows drops.
    EndsWithDot,
    /// The name is not in NFC: characters are decomposed, or their marks are in a non-canonical order, so that two different names
    /// could look the same.
    NotNormalised,
    /// Windows reserves the name for a device, such as `con`.
    Device,
}

impl fmt::Display for NameFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("no characters"),
            Self::TooLong { characters, bytes } => write!(f, "{characters} characters, {bytes} bytes"),
            Self::Character(c) => write!(f, "the character {}", quoted(c.encode_utf8(&mut [0; 4]))),
            Self::Start(c) => write!(f, "{} at its beginning", quoted(c.encode_utf8(&mut [0; 4]))),
            Self::EndsWithDot => f.write_str("a dot at its end"),
            Self::NotNormalised => f.write_str("characters that are not in Unicode's composed form (NFC)"),
            Self::Device => f.write_str("a word that Windows reserves for devices"),
        }
    }
}

impl NameFault {
    /// What was expected instead.
    pub fn expected(&self) -> &'static str {
        match self {
            Self::Empty | Self::TooLong { .. } => "1 to 100 characters, at most 200 bytes",
            Self::Character(_) => "letters and digits of any script, _, -, + and . in a name",
            Self::Start(_) => "a letter, a digit or _ at the beginning of a name",
            Self::EndsWithDot => "a letter, a digit, _, - or + at the end of a name",
            Self::NotNormalised => "a name in NFC, the composed form that keyboards normally produce",
            Self::Device => "a valid file name on every system",
        }
    }
}

/// Checks a name of a variant, a group or a scenario.
///
/// A name has 1 to 100 characters and at most 200 bytes. It begins with a letter, a digit or `_`; then come letters, digits,
/// combining marks, `_`, `-`, `+` and `.`; it does not end with `.`. Letters and digits may be of any script. The name is in NFC.
/// Device names of Windows (`con`, `nul.txt`, `COM1`) are refused.
///
/// # Errors
/// The first fault found.
///
/// # Example
/// ```
/// use driftworld_text::{NameFault, check_name};
/// assert_eq!(check_name("look-red-0.5"), Ok(()));
/// assert_eq!(check_name("größer"), Ok(()));
/// assert_eq!(check_name(".."), Err(NameFault::Start('.')));
/// assert_eq!(check_name("a/b"), Err(NameFault::Character('/')));
/// ```
pub fn check_name(name: &str) -> Result<(), NameFault> {
    let Some(first) = name.chars().next() else {
        return Err(NameFault::Empty);
    };
    let characters = name.chars().count();
    if characters > MAX_NAME_CHARACTERS || name.len() > MAX_NAME_BYTES {
        let bytes = name.len();
        return Err(NameFault::TooLong { characters, bytes });
    }
    if let Some(c) = name.chars().find(|c| !may_follow(*c)) {
        return Err(NameFault::Character(c));
    }
    if !may_begin(first) {
        return Err(NameFault::Start(first));
    }
    if name.ends_with('.') {
        return Err(NameFault::EndsWithDot);
    }
    if !is_nfc(name) {
        return Err(NameFault::NotNormalised);
    }
    if is_device(name) {
        return Err(NameFault::Device);
    }
    Ok(())
}

fn may_begin(c: char) -> bool {
    c == '_' || (c.is_alphanumeric() && !is_unprintable(c) && !is_combining_mark(c))
}

fn may_follow(c: char) -> bool {
    // Variation selectors are zero-width marks that choose a glyph for the character before them.
    let is_selector = matches!(c, '\u{fe00}'..='\u{fe0f}' | '\u{e0100}'..='\u{e01ef}');
    let is_mark = is_combining_mark(c) && !is_unprintable(c) && !is_selector;
    may_begin(c) || matches!(c, '-' | '+' | '.') || is_mark
}

fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_lowercase();
    let numbered = |port: &str| {
        let number = stem.strip_prefix(port);
        number.is_some_and(|number| {
            matches!(
                number,
                "0" | "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9" | "¹" | "²" | "³"
            )
        })
    };
    DEVICES.contains(&stem.as_str()) || numbered("com") || numbered("lpt")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn check(name: &str, expected: &Result<(), NameFault>) {
        assert_eq!(&check_name(name), expected, "{name:?}");
    }

    #[test]
    fn portable_file_names_are_accepted() {
        for name in "red look-red-0.5 1a334d _ a+b a..b größer 日本 हिन्दी Ωmega console com com10 nullable \
             map_1-v2 0 E+1"
            .split(' ')
        {
            check(name, &Ok(()));
        }
        check(&"é".repeat(100), &Ok(()));
    }

    #[test]
    fn names_unsafe_for_terminals_files_or_spreadsheets_are_refused() {
        check("", &Err(NameFault::Empty));
        for c in
            "\0\t\n\r\x1b\x7f\u{9b}\u{202e}\u{200b}\u{feff} \u{a0}/\\:*?\"<>|#%,;=@&$'`~()[]{}!^→😀\u{fe0f}".chars()
        {
            check(&format!("a{c}b"), &Err(NameFault::Character(c)));
        }
        for start in ['.', '-', '+'] {
            check(&format!("{start}a"), &Err(NameFault::Start(start)));
        }
        check(".", &Err(NameFault::Start('.')));
        check("..", &Err(NameFault::Start('.')));
        check("a.", &Err(NameFault::EndsWithDot));
        check("e\u{301}", &Err(NameFault::NotNormalised));
        for device in ["con", "CON", "nul.txt", "Aux", "prn.a.b", "COM1", "lpt9.log", "com²"] {
            check(device, &Err(NameFault::Device));
        }
        let long = |name: String| {
            let (characters, bytes) = (name.chars().count(), name.len());
            check(&name, &Err(NameFault::TooLong { characters, bytes }));
        };
        long("a".repeat(101));
        long("語".repeat(67));
    }

    #[test]
    fn fault_states_found_and_expected() {
        let fault = NameFault::Character('\u{202e}');
        assert_eq!(fault.to_string(), "the character \"\\u{202e}\"");
        assert!(!fault.expected().is_empty());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn accepted_names_work_as_files_logs_and_cells(name in prop_oneof!["[ -~]{0,6}", "\\PC{0,6}", "(?s).{0,6}", "[a-z.+_-]{0,6}"]) {
            if check_name(&name).is_ok() {
                let path = std::path::Path::new(&name);
                prop_assert_eq!(path.components().count(), 1);
                prop_assert_eq!(path.file_name().and_then(|own| own.to_str()), Some(name.as_str()));
                prop_assert!(!name.contains(|c: char| is_unprintable(c) || c.is_whitespace() || "/\\:*?\"<>|#,".contains(c)));
                prop_assert_eq!(crate::cell(&name), name.as_str());
                prop_assert_eq!(crate::printable(&name), name.as_str());
                prop_assert!(!name.starts_with(['-', '.']) && !name.ends_with(['.', ' ']));
            }
        }
    }
}
