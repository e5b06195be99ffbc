//! Arguments that clap would not take as they are: options as they were called in version 0.2, which work on with a note until the
//! next release, and variants of standard input. Today's names stand with the commands.

use std::ffi::OsString;

/// A command's option, the old spelling and the one that took its place.
const OLD: &[(&str, &str, &str)] = &[
    ("console", "--out", "--output"),
    ("run", "--logs", "--output"),
    ("order", "--method", "--order"),
    ("curriculum", "--method", "--order"),
    ("transfer-report", "--output", "--plot"),
    ("transfer-report", "-o", "--plot"),
];

/// The arguments in today's spelling, and what is said of those that were spelt otherwise.
pub(super) fn translated(args: Vec<OsString>) -> (Vec<OsString>, Vec<String>) {
    // To clap a variant of standard input, `-#red`, looks like an option.
    let from_stdin = |arg: OsString| match arg.to_str().and_then(|arg| arg.strip_prefix("-#")) {
        Some(variant) => format!("/dev/stdin#{variant}").into(),
        None => arg,
    };
    let args: Vec<OsString> = args.into_iter().map(from_stdin).collect();
    let command = args
        .iter()
        .skip(1)
        .filter_map(|arg| arg.to_str())
        .find(|arg| !arg.starts_with('-'));
    let old: Vec<_> = OLD.iter().filter(|(of, ..)| Some(*of) == command).copied().collect();
    let mut notes = Vec::new();
    if old.is_empty() {
        return (args, notes);
    }
    let mut options = true;
    let translate = |arg: OsString| {
        options = options && arg != "--";
        let Some(text) = arg.to_str().filter(|_| options) else {
            return arg;
        };
        let (name, value) = match text.split_once('=') {
            Some((name, value)) => (name, Some(value)),
            None => (text, None),
        };
        let Some((of, name, new)) = old.iter().find(|(_, old, _)| *old == name) else {
            return arg;
        };
        notes.push(format!(
            "{name} of `driftworld {of}` is called {new} now; the old spelling works until the next release"
        ));
        value
            .map_or_else(|| new.to_string(), |value| format!("{new}={value}"))
            .into()
    };
    let args = args.into_iter().map(translate).collect();
    notes.dedup();
    (args, notes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(args: &str, expected: &str, notes: usize) {
        let (found, said) = translated(args.split(' ').map(OsString::from).collect());
        let found: Vec<String> = found
            .into_iter()
            .map(|arg| arg.into_string().unwrap_or_default())
            .collect();
        assert_eq!((found.join(" ").as_str(), said.len()), (expected, notes), "{said:?}");
    }

    #[test]
    fn old_options_are_translated_with_a_note_and_others_are_left_alone() {
        check("driftworld run s.json --logs a", "driftworld run s.json --output a", 1);
        check("driftworld run s.json --logs=a", "driftworld run s.json --output=a", 1);
        check("driftworld run s.json -o a", "driftworld run s.json -o a", 0);
        check("driftworld run -- --logs", "driftworld run -- --logs", 0);
        check("driftworld report --out a", "driftworld report --out a", 0);
        check("driftworld", "driftworld", 0);
        check(
            "driftworld sample -#red -o -",
            "driftworld sample /dev/stdin#red -o -",
            0,
        );
    }
}
