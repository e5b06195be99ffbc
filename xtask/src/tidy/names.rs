//! File and folder names that say nothing are refused, for such a room collects what belongs elsewhere. Names inside
//! files are left to readers.

use super::tree::Tree;
use crate::finding::Finding;

const REFUSED: [&str; 5] = ["utils", "helpers", "common", "types", "misc"];

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let sources = tree.texts(&["rs", "py"]).map(|(path, _)| path);
    let refused = sources.filter_map(|path| refused_part(path).map(|part| (path, part)));
    let finding = |(path, part): (&str, &str)| {
        let advice = "name it after the one idea in it, or move its parts to the files they serve";
        Finding::new(
            path,
            1,
            format!("the name `{part}`"),
            "a name that says what lives there",
            advice,
        )
    };
    refused.map(finding).collect()
}

/// The first folder or file name of the path, without its ending, that is refused.
fn refused_part(path: &str) -> Option<&str> {
    let stems = path
        .split('/')
        .map(|part| part.split_once('.').map_or(part, |(stem, _)| stem));
    stems.into_iter().find(|stem| REFUSED.contains(stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_path(path: &str, expected: Option<&str>) {
        assert_eq!(refused_part(path), expected, "{path}");
    }

    #[test]
    fn names_that_say_nothing_are_refused() {
        for name in REFUSED {
            check_path(&format!("spec/src/{name}.rs"), Some(name));
            check_path(&format!("tests/{name}/mod.rs"), Some(name));
        }
    }

    #[test]
    fn names_that_merely_contain_one_pass() {
        check_path("spec/src/common_random_numbers.rs", None);
        check_path("spec/src/poisson_disc.rs", None);
    }

    #[test]
    fn only_sources_are_judged() {
        assert_eq!(check(&Tree::of(&[("docs/common.md", ""), ("a/misc.py", "")])).len(), 1);
    }
}
