//! The rule between our own crates: a member imports only what its line in the table allows. Third-party crates are
//! judged in `fences.rs`.

use super::graph::{Graph, Member};
use super::table::Room;
use crate::finding::Finding;

/// Members that the table does not know, and imports that it does not allow.
pub(super) fn check(graph: &Graph, rooms: &[Room]) -> Vec<Finding> {
    let judge = |member: &Member| match rooms.iter().find(|room| room.package == member.name) {
        Some(room) => forbidden_imports(graph, member, room),
        None => vec![unknown(member)],
    };
    graph.members.iter().flat_map(judge).collect()
}

fn forbidden_imports(graph: &Graph, member: &Member, room: &Room) -> Vec<Finding> {
    let ours = member.imports.iter().filter(|import| graph.is_member(&import.name));
    let forbidden = ours.filter(|import| !room.may_import.contains(&import.name.as_str()));
    let expected = match room.may_import {
        [] => format!("{} (floor {}) to import no crate of ours", member.name, room.floor),
        allowed => format!(
            "{} (floor {}) to import only {}",
            member.name,
            room.floor,
            allowed.join(", ")
        ),
    };
    let finding = |import: &super::graph::Import| {
        let found = format!("{} → {} ({})", member.name, import.name, import.kind.name());
        let advice = "move what both need down a floor, or hand it in as a value or a function";
        Finding::new(&member.manifest, import.line, found, expected.clone(), advice)
    };
    forbidden.map(finding).collect()
}

fn unknown(member: &Member) -> Finding {
    let found = format!("the crate `{}`, which stands on no floor", member.name);
    let advice = "add it to xtask/src/layers/table.rs and to the table of the design";
    Finding::new(
        &member.manifest,
        1,
        found,
        "every member to have a floor and a list of imports",
        advice,
    )
}

#[cfg(test)]
mod tests {
    use super::super::graph::{Kind, fixture};
    use super::super::table::ROOMS;
    use super::*;

    fn check_import(from: &str, to: &str, kind: Kind, expected: Option<&str>) {
        let graph = fixture(&[(from, &[(to, kind)]), (to, &[])], &[]);
        let findings = check(&graph, ROOMS);
        let found: Vec<&str> = findings.iter().map(|finding| finding.found.as_str()).collect();
        assert_eq!(found, expected.into_iter().collect::<Vec<_>>(), "{from} → {to}");
    }

    #[test]
    fn lower_floors_may_be_imported() {
        check_import("driftworld-env", "driftworld-spec", Kind::Normal, None);
        check_import("driftworld-curriculum", "driftworld-metrics", Kind::Normal, None);
        check_import("driftworld", "driftworld-curriculum", Kind::Normal, None);
        check_import("driftworld-unity", "driftworld-env", Kind::Normal, None);
        check_import("driftworld-python", "driftworld", Kind::Normal, None);
    }

    #[test]
    fn floor_two_never_imports_floor_two_in_any_kind() {
        for (kind, name) in [(Kind::Normal, "normal"), (Kind::Dev, "dev"), (Kind::Build, "build")] {
            let found = format!("driftworld-similarity → driftworld-generator ({name} dependency)");
            check_import("driftworld-similarity", "driftworld-generator", kind, Some(&found));
        }
    }

    #[test]
    fn higher_floors_and_the_facade_are_never_imported() {
        let found = "driftworld-spec → driftworld-env (normal dependency)";
        check_import("driftworld-spec", "driftworld-env", Kind::Normal, Some(found));
        let found = "driftworld-unity → driftworld (normal dependency)";
        check_import("driftworld-unity", "driftworld", Kind::Normal, Some(found));
        let found = "xtask → driftworld-spec (normal dependency)";
        check_import("xtask", "driftworld-spec", Kind::Normal, Some(found));
    }

    #[test]
    fn metrics_imports_none_of_ours() {
        let found = "driftworld-metrics → driftworld-spec (dev dependency)";
        check_import("driftworld-metrics", "driftworld-spec", Kind::Dev, Some(found));
    }

    #[test]
    fn an_unknown_member_asks_for_its_line() {
        let graph = fixture(&[("driftworld-sound", &[])], &[]);
        let findings = check(&graph, ROOMS);
        assert_eq!(findings.len(), 1);
        assert!(
            findings[0].to_string().contains("add it to xtask/src/layers/table.rs"),
            "{}",
            findings[0]
        );
    }
}
