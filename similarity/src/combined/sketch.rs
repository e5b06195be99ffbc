//! [`Sketches`]: worlds reduced to the numbers that comparing them needs, made once and compared often. The parts of a
//! distance are in `world.rs`.

use std::collections::BTreeMap;

use driftworld_spec::{Comparison, Object, SameTexts, World};
use serde::Serialize;

use crate::Oklab;

/// Worlds reduced alike: what is the same has the same number in each.
#[derive(Debug, Default)]
pub(super) struct Sketcher {
    numbers: BTreeMap<Vec<u8>, u32>,
    same: SameTexts,
    key: Vec<u8>,
}

/// A world as it is compared.
#[derive(Clone, Debug)]
pub(super) struct Sketch {
    /// Objects by class, those of one class in the order of the world.
    pub(super) objects: Vec<ObjectFeatures>,
    /// For each class its number, and where its objects end in `objects`; by number.
    pub(super) classes: Vec<(u32, usize)>,
    /// Cells in which something stands, in rising order.
    pub(super) cells: Vec<(i32, i32)>,
    pub(super) start: [f64; 2],
    pub(super) heading: f64,
    pub(super) action_model: u32,
    pub(super) action_space: u32,
    pub(super) linear_speed: f64,
    pub(super) angular_speed: f64,
    pub(super) time_step: f64,
    pub(super) agent_width: f64,
    pub(super) walls: u32,
    pub(super) area: f64,
    /// What time pays, in a second.
    pub(super) step_reward: f64,
    pub(super) rules: u32,
    /// The limit of steps, by how long it lets an episode last.
    pub(super) limit: u32,
    pub(super) light: f64,
    /// Wall, sky, ground, sunlight.
    pub(super) surroundings: [Oklab; 4],
    pub(super) camera: u32,
}

/// An object as it is compared.
#[derive(Clone, Debug)]
pub(super) struct ObjectFeatures {
    pub(super) place: [f64; 2],
    /// In degrees.
    pub(super) heading: f64,
    pub(super) motion: u32,
    pub(super) body: u32,
    pub(super) reward: f64,
    pub(super) paid_for: u32,
    pub(super) odds: f64,
    pub(super) color: Option<Oklab>,
    pub(super) look: u32,
}

impl Sketcher {
    /// The number of what a comparison finds the same or not in the world or object that was read last: that of equal
    /// fields and of equal `more`, which are not in the table as they are compared.
    fn number(&mut self, comparison: Comparison, more: impl Serialize) -> u32 {
        self.key.clear();
        self.key.push(comparison as u8);
        self.key.extend_from_slice(self.same.of(comparison));
        serde_json::to_writer(&mut self.key, &more).expect("parts of documents serialise, and memory takes them");
        if let Some(number) = self.numbers.get(&self.key) {
            return *number;
        }
        let next = u32::try_from(self.numbers.len()).unwrap_or(u32::MAX);
        self.numbers.insert(self.key.clone(), next);
        next
    }

    /// The sketch of a world, with cells of `cell` metres.
    pub(super) fn sketch(&mut self, world: &World, cell: f64) -> Sketch {
        let mut by_class: BTreeMap<u32, Vec<ObjectFeatures>> = BTreeMap::new();
        for object in &world.objects {
            self.same.read_object(object);
            let class = self.number(Comparison::NumbersOfObjects, object.class.to_lowercase());
            let features = self.features(object);
            by_class.entry(class).or_default().push(features);
        }
        let mut objects = Vec::with_capacity(world.objects.len());
        let mut classes = Vec::with_capacity(by_class.len());
        for (class, group) in by_class {
            objects.extend(group);
            classes.push((class, objects.len()));
        }
        let index = |metres: f64| (metres / cell).floor() as i32;
        let mut cells: Vec<(i32, i32)> = objects
            .iter()
            .map(|object| (index(object.place[0]), index(object.place[1])))
            .collect();
        cells.sort_unstable();
        cells.dedup();
        let (agent, around, rules) = (&world.agent_params, &world.environment_params, &world.rules);
        let [width, depth] = around.arena_size();
        let step_seconds = agent.time_step * f64::from(agent.frame_skip);
        let limits = [world.max_seconds, f64::from(world.max_steps) * step_seconds];
        let least = limits.into_iter().filter(|seconds| *seconds > 0.0).reduce(f64::min);
        // To the microsecond: 100 steps of 0.3 s are 300 of 0.1 s.
        let limit = least.map(|seconds| (seconds * 1e6).round() as u64);
        self.same.read_world(world);
        Sketch {
            objects,
            classes,
            cells,
            start: agent.coordinates,
            heading: agent.heading,
            action_model: self.number(Comparison::ModelOfActions, ()),
            action_space: self.number(Comparison::SpaceOfActions, ()),
            linear_speed: agent.max_linear_speed,
            angular_speed: agent.max_angular_speed,
            time_step: step_seconds,
            agent_width: agent.agent_width,
            walls: self.number(Comparison::MapAndWalls, around.predefined_map),
            area: width * depth,
            step_reward: rules.step_reward / step_seconds + rules.reward_per_second,
            rules: self.number(Comparison::ShapingAndEndings, ()),
            limit: self.number(Comparison::Limit, limit),
            light: around.light_intensity,
            surroundings: [
                around.bounding_wall_color,
                around.sky_color,
                around.ground_color,
                around.light_color,
            ]
            .map(Oklab::from),
            camera: self.number(Comparison::CameraAndWeather, agent.picture_size()),
        }
    }

    /// An object that was read last.
    fn features(&mut self, object: &Object) -> ObjectFeatures {
        ObjectFeatures {
            place: object.coordinates,
            heading: object.heading,
            motion: self.number(Comparison::Motion, ()),
            body: self.number(Comparison::Bodies, ()),
            reward: object.reward,
            paid_for: self.number(Comparison::PaidFor, ()),
            odds: object.reward_probability,
            color: object.color.map(Oklab::from),
            look: self.number(Comparison::ModelsOfObjects, ()),
        }
    }
}

impl Sketch {
    /// For each class that either has, where its objects are in each: `(class, range in a, range in b)`, by class.
    pub(super) fn classes_of_both<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = (&'a [ObjectFeatures], &'a [ObjectFeatures])> + 'a {
        let (mut i, mut j) = (0, 0);
        std::iter::from_fn(move || {
            let (mine, theirs) = (self.classes.get(i), other.classes.get(j));
            let class = match (mine, theirs) {
                (None, None) => return None,
                (Some(mine), None) => mine.0,
                (None, Some(theirs)) => theirs.0,
                (Some(mine), Some(theirs)) => mine.0.min(theirs.0),
            };
            let take = |sketch: &'a Self, at: &mut usize| -> &'a [ObjectFeatures] {
                let Some(&(_, end)) = sketch.classes.get(*at).filter(|entry| entry.0 == class) else {
                    return &[];
                };
                let start = at.checked_sub(1).map_or(0, |before| sketch.classes[before].1);
                *at += 1;
                &sketch.objects[start..end]
            };
            Some((take(self, &mut i), take(other, &mut j)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_meet_by_name_and_keep_their_order() {
        let world = |classes: &[(&str, f64)]| World {
            objects: classes
                .iter()
                .map(|(class, x)| Object::new(*class, [*x, 0.0]))
                .collect(),
            ..World::default()
        };
        let mut sketcher = Sketcher::default();
        let a = sketcher.sketch(&world(&[("tree", 1.0), ("Rock", 2.0), ("tree", 3.0)]), 2.0);
        let b = sketcher.sketch(&world(&[("pot", 4.0), ("rock", 5.0)]), 2.0);
        let xs = |group: &[ObjectFeatures]| group.iter().map(|object| object.place[0]).collect::<Vec<_>>();
        let mut met: Vec<(Vec<f64>, Vec<f64>)> = a.classes_of_both(&b).map(|(a, b)| (xs(a), xs(b))).collect();
        met.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(
            met,
            [(vec![], vec![4.0]), (vec![1.0, 3.0], vec![]), (vec![2.0], vec![5.0])]
        );
    }
}
