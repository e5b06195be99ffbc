//! Finds public items of the libraries that no library or program uses, not even their own crate.
//!
//! Uses are found by name, so an item counts as used if another item of the same name is. Uses in tests, benches, the fuzzer and
//! developer tools do not count.

use std::collections::{BTreeMap, BTreeSet};

use crate::sources::{Sources, end_of_item, is_name_char, is_test_file, shipped_lines};

/// Unused items that are kept, each with the reason.
const EXCEPTIONS: [(&str, &str); 4] = [
    ("differs_in", "tests say in which elements worlds differ"),
    ("ShownPath", "a trait whose method `shown` is called"),
    (
        "each_instruction_set",
        "tests compare the pictures of all instruction sets",
    ),
    ("with_renderer", "tests compare the pictures of both renderers"),
];

/// Folders whose code is ignored: developer tools.
const IGNORED: [&str; 2] = ["xtask/", "fuzz/"];

/// Folders of programs. The items that they use count as used; their own items are not checked.
const PROGRAMS: [&str; 4] = ["src/commands/", "src/console/", "python/", "examples/"];

/// A public item.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Item<'a> {
    pub(crate) path: &'a str,
    /// From 1.
    pub(crate) line: usize,
    pub(crate) name: &'a str,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Used as `name` or `module::name`, but not after a dot.
    Function,
    /// Used after a dot or two colons.
    Method,
    /// Used after two colons.
    Associated,
    /// A type, a trait or a constant.
    Other,
}

/// A line that contains a name, and the text before the name.
struct Use<'a> {
    file: usize,
    line: usize,
    before: &'a str,
}

/// A file's path and its lines; comments and tests are empty lines.
type File<'a> = (&'a str, Vec<&'a str>);

/// Every unused item that is not kept, sorted by path and line.
pub(crate) fn find(sources: &Sources) -> Vec<Item<'_>> {
    let rust = sources.with_extensions(&["rs"]);
    let shipped = rust.filter(|(path, _)| !is_test_file(path) || path.starts_with("examples/"));
    let shipped = shipped.filter(|(path, _)| !IGNORED.iter().any(|folder| path.starts_with(folder)));
    let files: Vec<File<'_>> = shipped.map(|(path, text)| (path, shipped_lines(text))).collect();
    let uses = uses(&files);
    let mut items: Vec<(Item<'_>, BTreeSet<(usize, usize)>)> = Vec::new();
    for (file, (path, lines)) in files.iter().enumerate() {
        if PROGRAMS.iter().any(|folder| path.starts_with(folder)) {
            continue;
        }
        let found = (0..lines.len()).filter_map(|line| item(path, lines, line));
        let found = found.filter(|item| !EXCEPTIONS.iter().any(|(name, _)| *name == item.name));
        items.extend(found.map(|item| (item, own_lines(&files, file, &item, &uses))));
    }
    let mut dead_lines = BTreeSet::new();
    let mut unreached = Vec::new();
    // Items used only by unused items are unused as well.
    loop {
        let is_reached = |(item, own): &(Item<'_>, BTreeSet<_>)| {
            uses[item.name].iter().any(|place| {
                let at = (place.file, place.line);
                item.kind.is_used(place.before) && !own.contains(&at) && !dead_lines.contains(&at)
            })
        };
        let (reached, dead): (Vec<_>, Vec<_>) = items.into_iter().partition(is_reached);
        if dead.is_empty() {
            break;
        }
        for (item, own) in dead {
            dead_lines.extend(own);
            unreached.push(item);
        }
        items = reached;
    }
    unreached.sort_unstable();
    unreached
}

impl Kind {
    /// Whether a name that follows this text can refer to an item of this kind.
    fn is_used(self, before: &str) -> bool {
        let after_dot = before.ends_with('.') && !before.ends_with("..");
        let after_colons = before.ends_with("::");
        match self {
            Self::Function => !after_dot,
            Self::Method => after_dot || after_colons,
            Self::Associated => after_colons,
            Self::Other => true,
        }
    }
}

/// The public item that starts at a line.
fn item<'a>(path: &'a str, lines: &[&'a str], at: usize) -> Option<Item<'a>> {
    let line = lines[at].trim_start();
    let mut words = line
        .strip_prefix("pub ")?
        .split(' ')
        .skip_while(|word| ["async", "unsafe"].contains(word))
        .peekable();
    let mut word = words.next()?;
    if word == "const" && words.peek() == Some(&"fn") {
        word = words.next()?;
    }
    let is_inside = line.len() < lines[at].len();
    let takes_self = || {
        let signature: String = lines[at..lines.len().min(at + 3)].concat();
        let first = signature.split_once('(').map_or("", |(_, arguments)| arguments);
        let first = first.split([',', ')', ':']).next().unwrap_or(first);
        first.split([' ', '&']).any(|word| word == "self")
    };
    let kind = match word {
        "fn" if !is_inside => Kind::Function,
        "fn" if takes_self() => Kind::Method,
        "fn" => Kind::Associated,
        "const" if is_inside => Kind::Associated,
        "const" | "static" | "struct" | "enum" | "trait" | "type" => Kind::Other,
        _ => return None,
    };
    let name = words.next()?.split(|c| !is_name_char(c)).next()?;
    // In a macro, something other than a name may follow.
    let is_name = name.starts_with(is_name_char);
    is_name.then_some(Item {
        path,
        line: at + 1,
        name,
        kind,
    })
}

/// The lines of an item, as file and line: its definition and, for types and traits, `impl` blocks that name it.
fn own_lines(
    files: &[File<'_>],
    file: usize,
    item: &Item<'_>,
    uses: &BTreeMap<&str, Vec<Use<'_>>>,
) -> BTreeSet<(usize, usize)> {
    let is_impl = |place: &&Use<'_>| {
        let line = files[place.file].1[place.line];
        item.kind == Kind::Other && (line.starts_with("impl") || line.starts_with("unsafe impl"))
    };
    let impls = uses[item.name]
        .iter()
        .filter(is_impl)
        .map(|place| (place.file, place.line));
    let starts = impls.chain([(file, item.line - 1)]);
    starts
        .flat_map(|(file, start)| (start..=end_of_item(&files[file].1, start)).map(move |line| (file, line)))
        .collect()
}

/// The occurrences of each name, except in `use` declarations.
fn uses<'a>(files: &[File<'a>]) -> BTreeMap<&'a str, Vec<Use<'a>>> {
    let mut uses: BTreeMap<&str, Vec<Use<'_>>> = BTreeMap::new();
    for (file, (_, lines)) in files.iter().enumerate() {
        let mut in_use = false;
        for (line, text) in lines.iter().enumerate() {
            in_use |= is_use(text.trim_start());
            if !in_use {
                for (start, name) in names(text) {
                    let before = &text[..start];
                    uses.entry(name).or_default().push(Use { file, line, before });
                }
            }
            in_use &= !text.ends_with(';');
        }
    }
    uses
}

/// Whether a line starts a `use` declaration of any visibility; strings may start the same way, but name no path.
fn is_use(line: &str) -> bool {
    let split = line
        .split_once("use ")
        .filter(|(_, path)| path.contains("::") || path.ends_with(';'));
    split.is_some_and(|(before, _)| before.is_empty() || before.starts_with("pub") && before.ends_with([' ']))
}

/// The words of a line that may be names, each with its position.
fn names(line: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut rest = line;
    while let Some(start) = rest.find(is_name_char) {
        let word = &rest[start..];
        let length = word.find(|c| !is_name_char(c)).unwrap_or(word.len());
        found.push((line.len() - word.len(), &word[..length]));
        rest = &word[length..];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(files: &[(&str, &str)], expected: &[&str]) {
        let sources = Sources::of(files);
        let found: Vec<&str> = find(&sources).into_iter().map(|item| item.name).collect();
        assert_eq!(found, expected, "{files:?}");
    }

    #[test]
    fn used_items_are_reached() {
        let library = (
            "spec/src/a.rs",
            "pub fn draw() {\n    draw()\n}\npub const LIMIT: usize = 3;\n",
        );
        check(&[library], &["draw", "LIMIT"]);
        check(
            &[library, ("src/commands/a.rs", "fn f() {\n    draw();\n}\n")],
            &["LIMIT"],
        );
        check(
            &[library, ("spec/src/b.rs", "fn f() -> usize {\n    draw()[LIMIT]\n}\n")],
            &[],
        );
    }

    #[test]
    fn tests_comments_and_declarations_do_not_count() {
        let library = (
            "spec/src/a.rs",
            "pub fn draw() {}\n#[cfg(test)]\nmod tests {\n    fn f() {\n        draw();\n    }\n}\n",
        );
        check(&[library], &["draw"]);
        for (path, text) in [
            ("spec/src/lib.rs", "pub use a::draw;\npub use a::{\n    draw,\n};\n"),
            ("spec/src/b.rs", "// draw();\nfn f() {} // draw()\n"),
            ("spec/tests/a.rs", "fn f() {\n    draw();\n}\n"),
            ("fuzz/src/a.rs", "fn f() {\n    draw();\n}\n"),
            ("src/b.rs", "fn f() {\n    a.draw();\n}\n"),
        ] {
            check(&[library, (path, text)], &["draw"]);
        }
    }

    #[test]
    fn items_used_only_by_unused_code_are_unreached() {
        let text = "pub struct Map;\nimpl Map {\n    pub fn new() -> Map {\n        Map\n    }\n}\npub fn chart() -> Map {\n    Map::new()\n}\n";
        check(&[("spec/src/a.rs", text)], &["Map", "new", "chart"]);
        check(
            &[
                ("spec/src/a.rs", text),
                ("examples/a.rs", "fn main() {\n    chart();\n}\n"),
            ],
            &[],
        );
    }

    #[test]
    fn methods_are_distinguished_from_functions() {
        let text = "impl Map {\n    pub fn of(\n        &self,\n    ) {\n    }\n    pub const fn empty() {}\n}\n";
        check(
            &[("spec/src/a.rs", text), ("src/b.rs", "fn f() {\n    of(empty());\n}\n")],
            &["of", "empty"],
        );
        check(
            &[
                ("spec/src/a.rs", text),
                ("src/b.rs", "fn f() {\n    map.of(Map::empty());\n}\n"),
            ],
            &[],
        );
    }
}
