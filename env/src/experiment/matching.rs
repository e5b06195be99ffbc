//! Pairs the objects of two worlds, and compares the worlds' starts.

use std::collections::BTreeMap;

use driftworld_spec::{Object, World, WorldDraft};

use super::space::{Kind, StateSpace, kind, shown};
use crate::sim::Unlike;

/// Two worlds, each reduced to the objects that have a counterpart, in the order of the first: objects with the same index are
/// counterparts.
pub(super) struct Paired {
    pub(super) worlds: [World; 2],
    /// Number of objects of each kind.
    counts: [BTreeMap<Kind, usize>; 2],
}

impl Paired {
    /// Pairs objects with the same unique name, and the others by kind, in order.
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
            let mut taken: BTreeMap<Kind, usize> = BTreeMap::new();
            let mut key = |object: &Object| {
                if let Some(name) = in_both(object) {
                    return (Some(name), None, 0);
                }
                let own = kind(object);
                let number = taken.entry(own.clone()).or_insert(0);
                *number += 1;
                (None, Some(own), *number)
            };
            world.objects.iter().map(&mut key).collect::<Vec<_>>()
        };
        let (keys_a, keys_b) = (keys(a), keys(b));
        let places: BTreeMap<_, usize> = keys_b.iter().enumerate().map(|(index, key)| (key, index)).collect();
        let (mut first, mut second) = (a.clone().into_draft(), b.clone().into_draft());
        (first.objects, second.objects) = (Vec::new(), Vec::new());
        for (index, key) in keys_a.iter().enumerate() {
            if let Some(place) = places.get(key) {
                first.objects.push(a.objects[index].clone());
                second.objects.push(b.objects[*place].clone());
            }
        }
        // Both start from the beginning.
        (first.progress, second.progress) = (None, None);
        let checked = |draft: WorldDraft| draft.check_in_range().expect("a world with fewer objects is sound");
        Self {
            worlds: [first, second].map(checked),
            counts,
        }
    }

    /// A kind whose number of objects differs between the worlds although both state spaces allow both numbers: then the laws
    /// differ, not the spaces.
    pub(super) fn counts_unlike(&self, [a, b]: [&StateSpace; 2]) -> Option<Unlike> {
        let [own, other] = &self.counts;
        let kinds = own.keys().chain(other.keys());
        let of = |counts: &BTreeMap<Kind, usize>, kind: &Kind| counts.get(kind).copied().unwrap_or(0);
        let differs = |kind: &&Kind| of(own, kind) != of(other, kind) && a.shares_counts(b, kind);
        let found = kinds.into_iter().find(differs)?;
        let what = format!("the number of objects {} at the start", shown(found));
        Some(Unlike::new(what, of(own, found), of(other, found)))
    }

    /// Differences between the initial states of the agents and of paired objects.
    pub(super) fn places_unlike(&self) -> Option<Unlike> {
        let [a, b] = &self.worlds;
        let (own, other) = (&a.agent_params, &b.agent_params);
        let agent =
            Unlike::of("where the agent starts in metres", &own.coordinates, &other.coordinates).or_else(|| {
                Unlike::of(
                    "where the agent looks at the start in degrees",
                    &own.heading,
                    &other.heading,
                )
            });
        let of_object = |(index, (own, other)): (usize, (&Object, &Object))| {
            let of = |what: &str| format!("{what} of object {index} ({}) at the start", shown(&kind(own)));
            Unlike::of(of("the position in metres"), &own.coordinates, &other.coordinates)
                .or_else(|| Unlike::of(of("the heading in degrees"), &own.heading, &other.heading))
                .or_else(|| {
                    let [own, other] = [own, other].map(|object| object.door.as_ref().is_some_and(|door| door.open));
                    Unlike::of(of("whether it is open"), &own, &other)
                })
        };
        let energy = || {
            let [own, other] =
                [own, other].map(|agent| agent.energy.as_ref().map(|energy| energy.start.min(energy.most)));
            Unlike::of("the agent's energy at the start", &own, &other)
        };
        agent
            .or_else(energy)
            .or_else(|| a.objects.iter().zip(&b.objects).enumerate().find_map(of_object))
    }
}

/// Number of objects of each kind in a world.
pub(super) fn count(world: &World) -> BTreeMap<Kind, usize> {
    let mut counts = BTreeMap::new();
    for object in &world.objects {
        *counts.entry(kind(object)).or_insert(0) += 1;
    }
    counts
}
