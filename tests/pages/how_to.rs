//! The how-to index lists every question in order, and there are at least 40 short answers, each with something that can be run.

use super::blocks::blocks;
use super::{all_pages, read};

const FOLDER: &str = "docs/how-to/";
const MIN_ANSWERS: usize = 40;

/// The anchor of a heading in links: lower case, hyphens for spaces, no punctuation.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase();
    let kept: String = kept
        .chars()
        .filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter))
        .collect();
    kept.trim().replace(' ', "-")
}

#[test]
fn index_has_every_question() {
    let index = read(&format!("{FOLDER}README.md"));
    let mut listed = index.lines().filter(|line| line.starts_with("- ["));
    for section in index.split("\n## [").skip(1) {
        let name = section
            .split("](")
            .nth(1)
            .and_then(|rest| rest.split(')').next())
            .unwrap_or_default();
        for line in read(&format!("{FOLDER}{name}")).lines() {
            if let Some(question) = line.strip_prefix("## ") {
                let expected = format!("- [{question}]({name}#{})", anchor(question));
                assert_eq!(
                    listed.next(),
                    Some(expected.as_str()),
                    "{FOLDER}README.md lists the questions in order"
                );
            }
        }
    }
    assert_eq!(listed.next(), None, "{FOLDER}README.md");
}

#[test]
fn every_answer_has_a_runnable_block() {
    let mut answers = 0;
    for page in all_pages()
        .into_iter()
        .filter(|page| page.starts_with(FOLDER) && !page.ends_with("README.md"))
    {
        let text = read(&page);
        let (_, sections) = text
            .split_once("\n## ")
            .unwrap_or_else(|| panic!("{page} has no answer"));
        for section in sections.split("\n## ") {
            let question = section.lines().next().unwrap_or_default();
            assert!(question.ends_with('?'), "{page}: {question:?} is not a question");
            let runs = blocks(section)
                .iter()
                .any(|block| ["sh", "python", "rust"].contains(&block.language.as_str()));
            assert!(runs, "{page}: {question}: nothing in the answer runs");
            assert!(
                section.lines().count() <= 60,
                "{page}: {question}: the answer is not short"
            );
            answers += 1;
        }
    }
    assert!(answers >= MIN_ANSWERS, "found only {answers} answers");
}
