//! Computes the distance columns of a log: how far a regime's variant is from the one learned last.

use std::collections::BTreeMap;

use driftworld_generator::Sampler;
use driftworld_similarity::{Distance, Weights, variant_distance, world_distance};
use driftworld_spec::{Element, Variant, World};

/// Number of worlds per variant when comparing variants of different tasks.
const WORLDS: u64 = 16;

/// Maximum number of cached gaps: a drift has a new variant for each experience.
const MAX_CACHED_GAPS: usize = 4096;

/// Maximum number of cached subjects, each with its worlds.
const MAX_CACHED_SUBJECTS: usize = 256;

/// A distance in total, and in each element: state, action, transition, reward, observation.
pub(super) type Gap = [f64; 6];

/// The gap before anything was learned: NaN, the log format's missing value.
pub(super) const UNKNOWN: Gap = [f64::NAN; 6];

/// Converts a distance to a gap; an element in which nothing could differ counts as equal.
fn gap_of(distance: &Distance) -> Gap {
    std::array::from_fn(|index| distance.within(index.checked_sub(1).map(|element| Element::ALL[element])))
}

/// One side of a gap: a variant, or a single world.
#[derive(Clone, Copy)]
pub(super) enum Subject<'a> {
    Variant(&'a Variant),
    World(&'a World),
}

/// Measures gaps, and caches them by pair of names.
#[derive(Debug, Default)]
pub(super) struct Gaps {
    known: BTreeMap<(String, String), Gap>,
    drawn: BTreeMap<String, Vec<Option<World>>>,
}

impl Gaps {
    /// The gap between two subjects; equal names mean equal subjects.
    ///
    /// Variants of one task are compared by what they declare, with the task's own weights. Others are compared by their first 16
    /// worlds under seed 0, in pairs; a single world is compared with each world of the other. Worlds that cannot be drawn are
    /// left out; if none remain, the gap is unknown.
    pub(super) fn between(&mut self, a: (&str, Subject), b: (&str, Subject)) -> Gap {
        if a.0 == b.0 {
            return [0.0; 6];
        }
        let key = (a.0.to_owned(), b.0.to_owned());
        if let Some(gap) = self.known.get(&key) {
            return *gap;
        }
        let gap = self.measure(a, b);
        if self.known.len() == MAX_CACHED_GAPS {
            self.known.clear();
        }
        self.known.insert(key, gap);
        gap
    }

    fn measure(&mut self, a: (&str, Subject), b: (&str, Subject)) -> Gap {
        // Subjects whose declarations cannot be compared, such as variants of two tasks, are compared by worlds.
        if let (Subject::Variant(a), Subject::Variant(b)) = (a.1, b.1)
            && let Ok(distance) = variant_distance(a, b, &Weights::of_task(a.task()))
        {
            return gap_of(&distance);
        }
        if self.drawn.len() + 2 > MAX_CACHED_SUBJECTS {
            self.drawn.clear();
        }
        self.draw(a);
        self.draw(b);
        let (a, b) = (&self.drawn[a.0], &self.drawn[b.0]);
        let (weights, pairs) = (Weights::default(), a.len().max(b.len()));
        // A single world is paired with every world of the other.
        let pair = |index: usize| (&a[index % a.len()], &b[index % b.len()]);
        let gaps: Vec<Gap> = (0..pairs)
            .filter_map(|index| {
                let (a, b) = pair(index);
                Some(gap_of(&world_distance(a.as_ref()?, b.as_ref()?, &weights)))
            })
            .collect();
        // Their mean; NaN if there are none.
        std::array::from_fn(|index| gaps.iter().map(|gap| gap[index]).sum::<f64>() / gaps.len() as f64)
    }

    fn draw(&mut self, (name, subject): (&str, Subject)) {
        if !self.drawn.contains_key(name) {
            let worlds = match subject {
                Subject::World(world) => vec![Some(world.clone())],
                Subject::Variant(variant) => {
                    let sampler = Sampler::new(variant, 0);
                    (0..WORLDS).map(|index| sampler.world(index).ok()).collect()
                }
            };
            self.drawn.insert(name.to_owned(), worlds);
        }
    }
}

#[cfg(test)]
mod tests {
    use driftworld_spec::TaskSpec;

    use super::*;

    fn variant(task: &str, name: &str) -> Variant {
        let text = format!(
            r#"{{ "name": "{task}", "variants": {{ "plain": {{}}, "poor": {{ "pay": 0 }} }}, "parameters": {{
            "pay": {{ "role": "variant", "type": "number", "affects": ["R"], "range": [0, 10], "default": 10 }} }},
            "groups": [{{ "name": "cubes", "count": 2, "placement": {{ "disc": {{ "center": [0, 0], "radius": 20 }} }},
                "object": {{ "class": "cube", "reward": {{ "param": "pay" }}, "reward_stimulus": ["AgentCollide"] }} }}] }}"#
        );
        TaskSpec::from_json("t", &text).unwrap().variant(name).unwrap()
    }

    fn gap(a: Subject, b: Subject) -> Gap {
        Gaps::default().between(("a", a), ("b", b))
    }

    #[test]
    fn variants_of_one_task_differ_in_what_they_declare() {
        let (plain, poor) = (variant("t", "plain"), variant("t", "poor"));
        let found = gap(Subject::Variant(&plain), Subject::Variant(&poor));
        let [total, state, action, transition, reward, observation] = found;
        assert!(total > 0.0 && reward > 0.0, "{found:?}");
        assert_eq!([state, action, transition, observation], [0.0; 4]);
        let same = Subject::Variant(&plain);
        assert_eq!(Gaps::default().between(("a", same), ("a", same)), [0.0; 6]);
    }

    #[test]
    fn variants_of_two_tasks_and_single_worlds_are_compared_by_worlds() {
        let (here, there) = (variant("t", "plain"), variant("u", "poor"));
        let distance = gap(Subject::Variant(&here), Subject::Variant(&there));
        assert!(distance[0] > 0.0 && distance[4] > 0.0, "{distance:?}");
        let world = Sampler::new(&here, 0).world(0).unwrap();
        assert_eq!(gap(Subject::World(&world), Subject::World(&world))[0], 0.0);
        let mixed = gap(Subject::World(&world), Subject::Variant(&here));
        assert!(mixed[0] > 0.0 && mixed[4] == 0.0, "{mixed:?}");
    }
}
