//! [`Varied`]: which properties differ between aggregated lifetimes, and hence what their intervals cover.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use driftworld_metrics::{BlockType, Log};
use serde::Serialize;

/// The properties of a lifetime that other lifetimes may share.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Makeup {
    order: Vec<String>,
    /// A hash of the worlds, independent of their order; `None` if they are not logged.
    learned: Option<u64>,
    evaluated: Option<u64>,
    agent: String,
    run_seed: String,
}

/// Whether each property differs between lifetimes; `None` if it is not logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Varied {
    /// The order in which tasks are learned.
    pub order: bool,
    /// The worlds used for learning.
    pub learning_worlds: Option<bool>,
    /// The worlds used for evaluation. If they are the same, an interval does not cover other worlds.
    pub evaluation_worlds: Option<bool>,
    /// The agent, by its name in logs.
    pub agent: bool,
    /// The run seed or the learner's own seed, which determine the agent's random numbers.
    pub run_seed: bool,
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
        Self {
            order,
            learned: worlds(log, BlockType::Train),
            evaluated: worlds(log, BlockType::Test),
            agent: text(logged("agent")),
            run_seed: ["/run_seed", "/agent/seed"]
                .map(|place| text(logged("made_from").and_then(|fingerprints| fingerprints.pointer(place))))
                .join(" "),
        }
    }
}

/// A hash of the worlds in one kind of block: their seeds or files, with their indices.
fn worlds(log: &Log, kind: BlockType) -> Option<u64> {
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
    Some(hash.finish())
}

impl Varied {
    /// The differences between at least two lifetimes.
    pub(super) fn between(lifetimes: &[Makeup]) -> Option<Self> {
        let [first, others @ ..] = lifetimes else { return None };
        if others.is_empty() {
            return None;
        }
        let differs = |is_same: &dyn Fn(&Makeup) -> bool| !others.iter().all(is_same);
        let worlds = |of: &dyn Fn(&Makeup) -> Option<u64>| {
            let is_logged = lifetimes.iter().all(|lifetime| of(lifetime).is_some());
            is_logged.then(|| differs(&|other| of(other) == of(first)))
        };
        Some(Self {
            order: differs(&|other| other.order == first.order),
            learning_worlds: worlds(&|lifetime| lifetime.learned),
            evaluation_worlds: worlds(&|lifetime| lifetime.evaluated),
            agent: differs(&|other| other.agent == first.agent),
            run_seed: differs(&|other| other.run_seed == first.run_seed),
        })
    }

    /// The differences in one or two sentences.
    pub fn sentence(self) -> String {
        let properties = [
            ("order", Some(self.order)),
            ("learning worlds", self.learning_worlds),
            ("evaluation worlds", self.evaluation_worlds),
            ("agent", Some(self.agent)),
            ("run seed", Some(self.run_seed)),
        ];
        let of = |wanted: Option<bool>| {
            let names = properties
                .iter()
                .filter(|(_, differs)| *differs == wanted)
                .map(|(name, _)| *name);
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
        Makeup {
            order: order.iter().map(|task| (*task).to_owned()).collect(),
            learned: Some(learned),
            evaluated,
            agent: "random".to_owned(),
            run_seed: String::new(),
        }
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
