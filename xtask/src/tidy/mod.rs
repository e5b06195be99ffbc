//! The `tidy` stage: rules about files which neither rustfmt nor clippy knows. Each rule has its own file; who imports
//! whom is the business of `layers`.

mod architecture;
mod book;
mod links;
mod marks;
mod names;
mod opening;
mod paths;
mod reading;
mod retired;
mod shown;
mod sizes;
mod tree;
mod unsafety;

use crate::error::XtaskError;
use crate::finding::{self, Finding};
use crate::sources::Sources;
use crate::unreached;
use crate::workspace::Workspace;
use tree::Tree;

/// Checks the checkout; returns the sizes of its files for the summary.
pub(crate) fn stage(workspace: &Workspace) -> Result<String, XtaskError> {
    let tree = Tree::read(&workspace.root)?;
    let sizes = sizes::summary(&tree);
    println!("{sizes}");
    let mut findings = check(&tree, &workspace.members());
    let sources = Sources::read(&workspace.root)?;
    findings.extend(unreached::find(&sources).into_iter().map(|item| {
        let found = format!("the public item `{}`", item.name);
        let expected = "other code outside tests to name it";
        let advice = "remove it, make it private, or give a reason in xtask/src/unreached.rs";
        Finding::new(item.path, item.line, found, expected, advice)
    }));
    finding::report(findings)?;
    Ok(sizes)
}

/// Every broken rule; `members` are the crates' names and folders.
fn check(tree: &Tree, members: &[(String, String)]) -> Vec<Finding> {
    let mut findings = opening::check(tree);
    findings.extend(names::check(tree));
    findings.extend(marks::check(tree));
    findings.extend(links::check(tree));
    findings.extend(paths::check(tree));
    findings.extend(reading::check(tree));
    findings.extend(retired::check(tree));
    findings.extend(shown::check(tree));
    findings.extend(architecture::check(tree, members));
    findings.extend(book::check(tree));
    findings.extend(unsafety::check(tree));
    findings.extend(sizes::check(tree));
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let members = [("driftworld-spec".to_owned(), "spec".to_owned())];
        check(&Tree::of(files), &members)
            .into_iter()
            .map(|finding| format!("{}:{}", finding.file, finding.line))
            .collect()
    }

    #[test]
    fn a_tidy_tree_passes() {
        let files = [
            ("ARCHITECTURE.md", "`spec/` [spec](spec/lib.rs)\n"),
            ("spec/lib.rs", "//! Documents.\n"),
        ];
        assert_eq!(found(&files), [""; 0]);
    }

    #[test]
    fn every_rule_is_asked() {
        let long = format!("fn f() {{ {}!() }}\n", "todo") + &"\n".repeat(sizes::WANTS_A_REASON);
        let files = [("spec/utils.rs", long.as_str()), ("README.md", "[gone](gone.md)\n")];
        let mut places = found(&files);
        places.sort();
        let expected = [
            "ARCHITECTURE.md:1",
            "README.md:1",
            "spec/utils.rs:1",
            "spec/utils.rs:1",
            "spec/utils.rs:1",
            "spec/utils.rs:1",
        ];
        assert_eq!(places, expected);
    }
}
