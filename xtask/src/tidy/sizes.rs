//! Sizes of Rust files: reported, never enforced, but that a very long file says why in its first line.

use super::tree::Tree;
use crate::finding::Finding;

/// A longer file says in its first line why it is `long because …`.
pub(super) const WANTS_A_REASON: usize = 700;

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let reasonless = |text: &str| !text.lines().next().is_some_and(|line| line.contains("long because"));
    let sources = tree
        .texts(&["rs", "py"])
        .map(|(path, text)| (path, text, text.lines().count()));
    let long = sources.filter(|(_, text, lines)| *lines > WANTS_A_REASON && reasonless(text));
    let finding = |path: &str, lines: usize| {
        let expected = format!("line one of a file over {WANTS_A_REASON} lines to say `long because …`");
        Finding::new(
            path,
            1,
            format!("{lines} lines"),
            expected,
            "move the second idea out, or give the reason",
        )
    };
    long.map(|(path, _, lines)| finding(path, lines)).collect()
}

/// Median and 90th percentile beside what we aim at.
pub(super) fn summary(tree: &Tree) -> String {
    let mut lines: Vec<usize> = tree.texts(&["rs"]).map(|(_, text)| text.lines().count()).collect();
    lines.sort_unstable();
    let [median, most] = [50, 90].map(|percent| percentile(&lines, percent));
    format!(
        "{} Rust files, median {median} lines (aim 200), 90th percentile {most} (aim 400)",
        lines.len()
    )
}

/// The smallest value that `percent` of the sorted values do not exceed (nearest rank); 0 for no values.
fn percentile(sorted: &[usize], percent: usize) -> usize {
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_nearest_ranks() {
        let sorted: Vec<usize> = (1..=10).collect();
        assert_eq!(
            [0, 10, 50, 90, 100].map(|percent| percentile(&sorted, percent)),
            [1, 1, 5, 9, 10]
        );
        assert_eq!(percentile(&[7], 50), 7);
        assert_eq!(percentile(&[], 90), 0);
    }

    #[test]
    fn only_a_very_long_file_gives_its_reason() {
        let check_file = |first: &str, lines: usize, expected: usize| {
            let text = format!("{first}\n") + &"\n".repeat(lines - 1);
            assert_eq!(
                check(&Tree::of(&[("a.rs", &text)])).len(),
                expected,
                "{first}, {lines} lines"
            );
        };
        check_file("//! Table.", WANTS_A_REASON, 0);
        check_file("//! Table.", WANTS_A_REASON + 1, 1);
        check_file("//! Table, long because it lists every color.", WANTS_A_REASON + 1, 0);
    }

    #[test]
    fn sizes_are_reported() {
        let tree = Tree::of(&[("a.rs", "1\n2\n"), ("b.rs", "1\n"), ("c.py", "1\n2\n3\n")]);
        assert_eq!(
            summary(&tree),
            "2 Rust files, median 1 lines (aim 200), 90th percentile 2 (aim 400)"
        );
    }
}
