//! The rule about third-party crates: a fenced crate is imported only inside its rooms, neither directly nor by way of
//! some other third-party crate. Imports between our own crates are judged in `rooms.rs`.

use std::collections::{BTreeMap, VecDeque};

use super::graph::{Graph, Import, Kind, Member};
use super::table::Fence;
use crate::finding::Finding;

/// Every way that leads from a room to a crate which is fenced into another one.
pub(super) fn check(graph: &Graph, fences: &[Fence]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for member in &graph.members {
        for fence in fences
            .iter()
            .filter(|fence| !fence.rooms.contains(&member.name.as_str()))
        {
            for import in &member.imports {
                findings.extend(trespass(graph, member, import, fence));
            }
        }
    }
    findings
}

fn trespass(graph: &Graph, member: &Member, import: &Import, fence: &Fence) -> Option<Finding> {
    if import.kind == Kind::Dev && fence.test_rooms.contains(&member.name.as_str()) {
        return None;
    }
    // Our own crates answer for what they import; a test tool may use whatever it likes inside.
    let path = if graph.is_member(&import.name) || import.kind == Kind::Dev {
        fence
            .crates
            .contains(&import.name.as_str())
            .then(|| vec![import.name.clone()])
    } else {
        shortest_path(&graph.third_party, &import.name, fence.crates)
    }?;
    let fenced = path.last().map_or("", String::as_str);
    let found = format!("{} → {} ({})", member.name, path.join(" → "), import.kind.name());
    let expected = format!(
        "{fenced} only in {}, where {}",
        fence.rooms.join(" and "),
        fence.purpose
    );
    let advice = "move the code into that room, do without, or switch off the feature that brings it";
    Some(Finding::new(&member.manifest, import.line, found, expected, advice))
}

/// The shortest chain of crates from `start` to one of `goals`, both ends included.
fn shortest_path(edges: &BTreeMap<String, Vec<String>>, start: &str, goals: &[&str]) -> Option<Vec<String>> {
    let mut came_from = BTreeMap::from([(start, None)]);
    let mut queue = VecDeque::from([start]);
    while let Some(name) = queue.pop_front() {
        if goals.contains(&name) {
            return Some(walk_back(&came_from, name));
        }
        for next in edges.get(name).into_iter().flatten() {
            came_from.entry(next.as_str()).or_insert_with(|| {
                queue.push_back(next.as_str());
                Some(name)
            });
        }
    }
    None
}

/// The crates on the way, from the start to the goal.
fn walk_back(came_from: &BTreeMap<&str, Option<&str>>, goal: &str) -> Vec<String> {
    let mut path = vec![goal.to_owned()];
    let mut name = goal;
    while let Some(before) = came_from.get(name).copied().flatten() {
        path.push(before.to_owned());
        name = before;
    }
    path.reverse();
    path
}

#[cfg(test)]
mod tests {
    use super::super::graph::fixture;
    use super::super::table::FENCES;
    use super::*;

    fn check_import(from: &str, import: (&str, Kind), third_party: &[(&str, &[&str])], expected: Option<&str>) {
        let graph = fixture(&[(from, &[import])], third_party);
        let findings = check(&graph, FENCES);
        let found: Vec<&str> = findings.iter().map(|finding| finding.found.as_str()).collect();
        assert_eq!(found, expected.into_iter().collect::<Vec<_>>(), "{from} → {import:?}");
    }

    #[test]
    fn a_fenced_crate_is_welcome_in_its_room() {
        check_import("driftworld-spec", ("schemars", Kind::Normal), &[], None);
        check_import("driftworld-env", ("rapier3d", Kind::Normal), &[], None);
        check_import("driftworld-env", ("rand_chacha", Kind::Normal), &[], None);
        check_import("driftworld", ("clap", Kind::Normal), &[], None);
    }

    #[test]
    fn a_fenced_crate_is_refused_elsewhere_even_in_tests() {
        let found = "driftworld-curriculum → rand (dev dependency)";
        check_import("driftworld-curriculum", ("rand", Kind::Dev), &[], Some(found));
        let found = "driftworld-generator → rapier3d (normal dependency)";
        check_import("driftworld-generator", ("rapier3d", Kind::Normal), &[], Some(found));
        let found = "xtask → clap (normal dependency)";
        check_import("xtask", ("clap", Kind::Normal), &[], Some(found));
    }

    #[test]
    fn the_facade_may_check_schemas_in_its_tests_only() {
        check_import("driftworld", ("jsonschema", Kind::Dev), &[], None);
        let found = "driftworld → jsonschema (normal dependency)";
        check_import("driftworld", ("jsonschema", Kind::Normal), &[], Some(found));
    }

    #[test]
    fn a_way_through_third_party_crates_is_printed_whole() {
        let third_party: &[(&str, &[&str])] = &[("plot", &["table", "draw"]), ("draw", &["csv"]), ("table", &[])];
        let found = "driftworld-similarity → plot → draw → csv (normal dependency)";
        check_import(
            "driftworld-similarity",
            ("plot", Kind::Normal),
            third_party,
            Some(found),
        );
    }

    #[test]
    fn test_tools_may_use_fenced_crates_inside() {
        check_import(
            "driftworld-spec",
            ("proptest", Kind::Dev),
            &[("proptest", &["rand"])],
            None,
        );
    }

    #[test]
    fn circles_among_third_party_crates_end() {
        check_import(
            "driftworld-spec",
            ("a", Kind::Normal),
            &[("a", &["b"]), ("b", &["a"])],
            None,
        );
    }
}
