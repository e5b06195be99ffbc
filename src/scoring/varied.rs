//! [`Varied`]: which properties differ between aggregated lifetimes, and hence what their intervals cover.

use std::array;
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use driftworld_metrics::{BlockType, Log};
use serde::{Serialize, Serializer};

/// The properties that lifetimes may share: the order in which tasks are learned, the worlds, the agent's name in logs, and the
/// run seed or the learner's own seed, which determine the agent's random numbers. If the evaluation worlds are the same, an
/// interval does not cover other worlds.
const PROPERTIES: [&str; 5] = ["order", "learning worlds", "evaluation worlds", "agent", "run seed"];

/// The value of each property for one lifetime; `None` if it is not logged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Makeup([Option<String>; PROPERTIES.len()]);

/// Whether each property differs between lifetimes; `None` if it is not logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Varied([Option<bool>; PROPERTIES.len()]);

impl Serialize for Varied {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let keys = PROPERTIES.map(|name| name.replace(' ', "_"));
        serializer.collect_map(keys.into_iter().zip(self.0))
    }
}

impl Makeup {
    pub(super) fn of(log: &Log) -> Self {
        let rows = &log.rows;
        let mut order: Vec<String> = Vec::new();
        for (kind, task) in rows.block_types().iter().zip(rows.task_names().ids()) {
            let task = &rows.task_names().values()[*task as usize];
            if *kind == BlockType::Train && order.last() != Some(task) {
                order.push(task.clone());
            }
        }
        let logged = |key: &str| log.scenario_info.extra.get(key);
        let text = |value: Option<&serde_json::Value>| value.map_or_else(String::new, ToString::to_string);
        let seeds = ["/run_seed", "/agent/seed"]
            .map(|place| text(logged("made_from").and_then(|fingerprints| fingerprints.pointer(place))));
        Self([
            Some(format!("{order:?}")),
            worlds(log, BlockType::Train),
            worlds(log, BlockType::Test),
            Some(text(logged("agent"))),
            Some(seeds.join(" ")),
        ])
    }
}

/// A hash of the worlds in one kind of block: their seeds or files, with their indices, in any order; `None` if
/// they are not logged.
fn worlds(log: &Log, kind: BlockType) -> Option<String> {
    let rows = &log.rows;
    let indices = rows.metric("world_index")?;
    let params = rows.task_params();
    let sources: Option<Vec<String>> = params
        .values()
        .iter()
        .map(|params| {
            let source = params.get("seed").or_else(|| params.get("world"))?;
            Some(source.to_string())
        })
        .collect();
    let sources = sources?;
    let mut found = BTreeSet::new();
    for (row, own) in rows.block_types().iter().enumerate() {
        if *own == kind {
            found.insert((&sources[params.ids()[row] as usize], indices[row].to_bits()));
        }
    }
    let mut hash = DefaultHasher::new();
    found.hash(&mut hash);
    Some(hash.finish().to_string())
}

impl Varied {
    /// The differences between at least two lifetimes.
    pub(super) fn between(lifetimes: &[Makeup]) -> Option<Self> {
        let [first, others @ ..] = lifetimes else { return None };
        if others.is_empty() {
            return None;
        }
        Some(Self(array::from_fn(|k| {
            let is_logged = lifetimes.iter().all(|lifetime| lifetime.0[k].is_some());
            is_logged.then(|| others.iter().any(|other| other.0[k] != first.0[k]))
        })))
    }

    /// The differences in one or two sentences.
    pub fn sentence(self) -> String {
        let of = |wanted: Option<bool>| {
            let properties = PROPERTIES.into_iter().zip(self.0);
            let names = properties.filter_map(|(name, differs)| (differs == wanted).then_some(name));
            names.collect::<Vec<_>>().join(", ")
        };
        let mut parts = Vec::new();
        for (what, names) in [
            ("these vary", of(Some(true))),
            ("these are fixed", of(Some(false))),
            ("these are not logged", of(None)),
        ] {
            if !names.is_empty() {
                parts.push(format!("{what}: {names}"));
            }
        }
        format!("Between lifetimes, {}.", parts.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn makeup(order: &[&str], learned: u64, evaluated: Option<u64>) -> Makeup {
        let worlds = [Some(learned), evaluated].map(|hash| hash.map(|hash| hash.to_string()));
        let [learned, evaluated] = worlds;
        let others = ["random", ""].map(|text| Some(text.to_owned()));
        let [agent, run_seed] = others;
        Makeup([Some(format!("{order:?}")), learned, evaluated, agent, run_seed])
    }

    #[test]
    fn one_differing_lifetime_is_a_difference() {
        let lifetimes = [
            makeup(&["a", "b"], 1, Some(5)),
            makeup(&["a", "b"], 1, Some(5)),
            makeup(&["b", "a"], 2, Some(5)),
        ];
        let varied = Varied::between(&lifetimes).expect("there are several");
        assert_eq!(
            varied.sentence(),
            "Between lifetimes, these vary: order, learning worlds; these are fixed: evaluation worlds, \
             agent, run seed."
        );
        assert_eq!(Varied::between(&lifetimes[..1]), None);
        let silent = [makeup(&["a"], 1, None), makeup(&["a"], 1, Some(5))];
        let text = Varied::between(&silent).expect("there are several").sentence();
        assert!(text.ends_with("these are not logged: evaluation worlds."), "{text}");
    }
}
