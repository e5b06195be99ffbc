//! Pairs the objects of two worlds, and compares the worlds' initial states.

use std::collections::BTreeMap;

use driftworld_spec::{Object, World, WorldDraft};

use super::space::{Kind, StateSpace, count, display_name, kind};
use crate::sim::Difference;

/// Two worlds, each reduced to the objects that have a counterpart. Objects with the same index are counterparts, in the order
/// of the first world.
pub(super) struct Paired {
    pub(super) worlds: [World; 2],
    /// Number of objects of each kind.
    counts: [BTreeMap<Kind, usize>; 2],
}

impl Paired {
    /// Pairs objects with the same unique name, and other objects of the same kind in order.
    pub(super) fn new(a: &World, b: &World) -> Self {
        let counts = [a, b].map(count);
        let names: Vec<&String> = b
            .objects
            .iter()
            .filter_map(|object| object.unique_name.as_ref())
            .collect();
        let in_both = |object: &Object| {
            let own = object.unique_name.as_ref()?;
            let has = a.objects.iter().any(|other| other.unique_name.as_ref() == Some(own));
            (has && names.contains(&own)).then(|| own.clone())
        };
        let keys = |world: &World| {
            let mut counts_so_far: BTreeMap<Kind, usize> = BTreeMap::new();
            let mut key = |object: &Object| {
                if let Some(name) = in_both(object) {
                    return (Some(name), None, 0);
                }
                let own = kind(object);
                let number = counts_so_far.entry(own.clone()).or_insert(0);
                *number += 1;
                (None, Some(own), *number)
            };
            world.objects.iter().map(&mut key).collect::<Vec<_>>()
        };
        let (keys_a, keys_b) = (keys(a), keys(b));
        let indices: BTreeMap<_, usize> = keys_b.iter().enumerate().map(|(index, key)| (key, index)).collect();
        let (mut first, mut second) = (a.clone().into_draft(), b.clone().into_draft());
        (first.objects, second.objects) = (Vec::new(), Vec::new());
        for (index, key) in keys_a.iter().enumerate() {
            if let Some(other) = indices.get(key) {
                first.objects.push(a.objects[index].clone());
                second.objects.push(b.objects[*other].clone());
            }
        }
        // Both worlds start from the beginning.
        (first.progress, second.progress) = (None, None);
        let checked = |draft: WorldDraft| draft.check_in_range().expect("a world with fewer objects is valid");
        Self {
            worlds: [first, second].map(checked),
            counts,
        }
    }

    /// A kind whose number of objects differs between the worlds although the state spaces allow both numbers. Then the initial
    /// states differ, not the spaces.
    pub(super) fn count_difference(&self, [a, b]: [&StateSpace; 2]) -> Option<Difference> {
        let [own, other] = &self.counts;
        let kinds = own.keys().chain(other.keys());
        let number = |counts: &BTreeMap<Kind, usize>, kind: &Kind| counts.get(kind).copied().unwrap_or(0);
        let differs = |kind: &&Kind| number(own, kind) != number(other, kind) && a.shares_counts(b, kind);
        let found = kinds.into_iter().find(differs)?;
        let what = format!("the number of {} objects at the start", display_name(found));
        Some(Difference::new(what, number(own, found), number(other, found)))
    }

    /// A difference between the initial states of the agents or of paired objects.
    pub(super) fn start_difference(&self) -> Option<Difference> {
        let [a, b] = &self.worlds;
        let (own, other) = (&a.agent_params, &b.agent_params);
        let agent = Difference::of(
            "the agent's start position in metres",
            &own.coordinates,
            &other.coordinates,
        )
        .or_else(|| Difference::of("the agent's start heading in degrees", &own.heading, &other.heading));
        let object_difference = |(index, (own, other)): (usize, (&Object, &Object))| {
            let of = |what: &str| format!("{what} of object {index} ({}) at the start", display_name(&kind(own)));
            Difference::of(of("the position in metres"), &own.coordinates, &other.coordinates)
                .or_else(|| Difference::of(of("the heading in degrees"), &own.heading, &other.heading))
                .or_else(|| {
                    let [own, other] = [own, other].map(|object| object.door.as_ref().is_some_and(|door| door.open));
                    Difference::of(of("the open state"), &own, &other)
                })
        };
        let energy = || {
            let [own, other] =
                [own, other].map(|agent| agent.energy.as_ref().map(|energy| energy.start.min(energy.most)));
            Difference::of("the agent's energy at the start", &own, &other)
        };
        agent
            .or_else(energy)
            .or_else(|| a.objects.iter().zip(&b.objects).enumerate().find_map(object_difference))
    }
}
