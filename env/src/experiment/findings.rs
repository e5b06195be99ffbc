//! Results of an experiment: a witness for each element that differs, and the amount of testing.

use driftworld_spec::Element;
use serde::{Deserialize, Serialize};

use super::policy::Policy;
use crate::sim::Difference;

/// The first case in which an element was found to differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Witness {
    /// Index of the pair of worlds, from 0; absent if the difference appears only across all pairs together.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub world: Option<usize>,
    /// The policy; absent if the difference appears without running one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub policy: Option<Policy>,
    /// The step, from 0.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub step: Option<u32>,
    /// What differs, in words.
    pub what: String,
    /// The value in the first world.
    pub a: String,
    /// The value in the second world.
    pub b: String,
}

impl Witness {
    pub(super) fn of(world: Option<usize>, policy: Option<Policy>, step: Option<u32>, difference: Difference) -> Self {
        Self {
            world,
            policy,
            step,
            what: difference.what,
            a: difference.own,
            b: difference.other,
        }
    }
}

/// The amount of testing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Proof {
    /// Pairs of worlds.
    pub worlds: u64,
    /// Episodes over all policies, each led by one of the two worlds.
    pub runs: u64,
    /// Steps that both worlds took from the same state with the same command.
    pub steps: u64,
    /// States in which both observations were compared.
    pub observations: u64,
    /// States of one world without a counterpart in the other, such as positions inside its walls; nothing is compared there.
    pub without_counterpart: u64,
}

/// The differences between two tasks, and the amount of testing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// The elements that differ with their first witnesses, in the order of [`Element::WITH_FINE`].
    pub differences: Vec<(Element, Witness)>,
    /// The amount of testing.
    pub proof: Proof,
}

impl Findings {
    /// The elements that differ, in the order of [`Element::WITH_FINE`].
    pub fn elements(&self) -> Vec<Element> {
        self.differences.iter().map(|(element, _)| *element).collect()
    }

    /// The first witness of an element, if it differs.
    pub fn witness(&self, element: Element) -> Option<&Witness> {
        let mut found = self.differences.iter();
        found.find(|(own, _)| *own == element).map(|(_, witness)| witness)
    }

    pub(super) fn differs(&self, element: Element) -> bool {
        self.witness(element).is_some()
    }

    /// Records that an element differs, unless it has a witness already.
    pub(super) fn record(&mut self, element: Element, witness: Witness) {
        if !self.differs(element) {
            self.differences.push((element, witness));
            let rank = |element: &Element| Element::WITH_FINE.iter().position(|other| other == element);
            self.differences.sort_by_key(|(element, _)| rank(element));
        }
    }

    /// Adds the findings of later pairs.
    pub(super) fn add(&mut self, later: Self) {
        for (element, witness) in later.differences {
            self.record(element, witness);
        }
        let (own, more) = (&mut self.proof, later.proof);
        own.worlds += more.worlds;
        own.runs += more.runs;
        own.steps += more.steps;
        own.observations += more.observations;
        own.without_counterpart += more.without_counterpart;
    }
}
