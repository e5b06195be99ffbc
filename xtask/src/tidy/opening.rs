//! Every Rust file opens with `//!`: what lives here, and what deliberately does not. Whether the sentence is true is
//! left to readers.

use super::tree::Tree;
use crate::finding::Finding;

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let opens_well = |text: &str| text.strip_prefix("//!").is_some_and(|rest| rest.starts_with(' '));
    let finding = |path: &str, text: &str| {
        let found = format!("`{}`", text.lines().next().unwrap_or_default());
        let advice = "write one sentence on what lives here and one on what deliberately does not";
        Finding::new(path, 1, found, "the file to open with `//! …`", advice)
    };
    let wrong = tree.texts(&["rs"]).filter(|(_, text)| !opens_well(text));
    wrong.map(|(path, text)| finding(path, text)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_text(text: &str, expected: usize) {
        assert_eq!(check(&Tree::of(&[("build.rs", text)])).len(), expected, "{text:?}");
    }

    #[test]
    fn a_file_opens_with_its_purpose() {
        check_text("//! Purpose.\nfn main() {}\n", 0);
        check_text("fn main() {}\n", 1);
        check_text("\n//! Late.\n", 1);
        check_text("//!\n", 1);
        check_text("// Not a doc comment.\n", 1);
        check_text("", 1);
    }
}
