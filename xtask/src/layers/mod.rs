//! The `layers` stage: who may import whom, checked against every `Cargo.toml`. The rules are data in `table.rs`; how
//! the crates are read stands in `graph.rs`; what source files say is the business of `tidy`.

mod fences;
mod graph;
mod inheritance;
mod rooms;
mod table;

use crate::error::XtaskError;
use crate::finding::{self, Finding};
use graph::Graph;
use table::{FENCES, ROOMS};

/// Checks the workspace; returns a note for the summary.
pub(crate) fn stage() -> Result<String, XtaskError> {
    let graph = graph::read()?;
    finding::report(check(&graph))?;
    Ok(format!("{} crates", graph.members.len()))
}

/// Every broken rule of the graph.
fn check(graph: &Graph) -> Vec<Finding> {
    let mut findings = rooms::check(graph, ROOMS);
    findings.extend(fences::check(graph, FENCES));
    findings.extend(inheritance::check(graph));
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use graph::{Kind, fixture};

    #[test]
    fn the_house_as_designed_passes() {
        let graph = fixture(
            &[
                (
                    "driftworld-spec",
                    &[("schemars", Kind::Normal), ("proptest", Kind::Dev)],
                ),
                (
                    "driftworld-env",
                    &[("driftworld-spec", Kind::Normal), ("rapier3d", Kind::Normal)],
                ),
                (
                    "driftworld",
                    &[("driftworld-env", Kind::Normal), ("jsonschema", Kind::Dev)],
                ),
            ],
            &[("proptest", &["rand"])],
        );
        assert_eq!(check(&graph), []);
    }

    #[test]
    fn every_kind_of_rule_is_asked() {
        let spec: (&str, &[_]) = (
            "driftworld-spec",
            &[("driftworld-env", Kind::Dev), ("csv", Kind::Normal)],
        );
        let mut graph = fixture(&[spec, ("driftworld-env", &[])], &[]);
        graph.members[0].imports[0].inherits = false;
        let found: Vec<String> = check(&graph).into_iter().map(|finding| finding.found).collect();
        assert_eq!(found.len(), 3, "{found:?}");
    }
}
