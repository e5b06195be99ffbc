//! One broken rule: where, what was found, what was expected, what to do. Which rules there are stands in `layers`
//! and `tidy`.

use std::fmt;

use crate::error::XtaskError;

/// A broken house rule, in the order in which findings are printed: by file, then line.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Finding {
    /// Relative to the repository root, `/` between folders.
    pub(crate) file: String,
    /// From 1; the rule's best guess where a whole file is at fault is 1.
    pub(crate) line: usize,
    /// What stands there.
    pub(crate) found: String,
    /// What the rule wants.
    pub(crate) expected: String,
    /// What to do about it.
    pub(crate) advice: String,
}

impl Finding {
    /// The four parts of a message; see the fields.
    pub(crate) fn new(
        file: &str,
        line: usize,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self {
            file: file.to_owned(),
            line,
            found: found.into(),
            expected: expected.into(),
            advice: advice.into(),
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            found,
            expected,
            advice,
        } = self;
        write!(formatter, "{file}:{line}: found {found}, expected {expected}; {advice}")
    }
}

/// Prints the findings, sorted by place, and fails when there is any.
pub(crate) fn report(mut findings: Vec<Finding>) -> Result<(), XtaskError> {
    findings.sort();
    for finding in &findings {
        eprintln!("{finding}");
    }
    if findings.is_empty() {
        Ok(())
    } else {
        Err(XtaskError::Findings { count: findings.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_reads_where_found_expected_do() {
        let finding = Finding::new("a/b.rs", 7, "x", "y", "write y");
        assert_eq!(finding.to_string(), "a/b.rs:7: found x, expected y; write y");
    }

    #[test]
    fn findings_fail_and_their_absence_passes() {
        assert!(report(Vec::new()).is_ok());
        let error = report(vec![Finding::new("a", 1, "x", "y", "z")]).unwrap_err();
        assert_eq!(error.to_string(), "1 finding, listed above");
    }
}
