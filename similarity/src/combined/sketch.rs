//! [`Sketch`]: a world reduced to the features that a comparison needs, computed once and compared often.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{self, AtomicU64};

use driftworld_spec::{Comparison, Layout, LeafTexts, Object, Plan, RoomDoors, World};

use crate::Oklab;
use crate::combined::leaves::{LeafReader, Leaves};
use crate::combined::read::as_read;
use crate::layout_shape::LayoutShape;

/// The next unused kind id. 0 means none.
static NEXT_KIND: AtomicU64 = AtomicU64::new(1);

/// Makes sketches; only sketches from the same sketcher can be compared.
#[derive(Debug, Default)]
pub(super) struct Sketcher {
    texts: LeafTexts,
    reader: LeafReader,
    kinds: BTreeMap<[u64; 10], u64>,
    /// Cache of the last layout, with its arena and shape.
    layout: Option<(Plan, [f64; 3], Arc<LayoutShape>)>,
}

/// A world prepared for comparison.
#[derive(Clone, Debug)]
pub(super) struct Sketch {
    /// Objects by class; within a class in an order that does not depend on the order of the document.
    pub(super) objects: Vec<ObjectFeatures>,
    /// For each class its name in lower case, and the end of its objects in `objects`; sorted by name.
    pub(super) classes: Vec<(String, usize)>,
    pub(super) start: [f64; 2],
    /// In degrees, in `0..360` like all headings here.
    pub(super) heading: f64,
    pub(super) action_model: Arc<Leaves>,
    pub(super) action_space: Arc<Leaves>,
    pub(super) linear_speed: f64,
    pub(super) angular_speed: f64,
    pub(super) time_step: f64,
    pub(super) agent_width: f64,
    pub(super) energy: Arc<Leaves>,
    pub(super) map: u8,
    pub(super) walls: Arc<Leaves>,
    /// The walls of the arena; `None` without a layout.
    pub(super) layout: Option<Arc<LayoutShape>>,
    /// The doors of its rooms.
    pub(super) doors: RoomDoors,
    pub(super) arena: [f64; 2],
    /// Zones that affect motion, that pay, and that are visible.
    pub(super) zones: [Arc<Leaves>; 3],
    /// Reward per second.
    pub(super) step_reward: f64,
    pub(super) rules: Arc<Leaves>,
    /// Maximum length of an episode in seconds; `None` without a limit.
    pub(super) limit: Option<f64>,
    pub(super) light: f64,
    /// Wall, sky, ground, sunlight, ceiling.
    pub(super) surroundings: [Oklab; 5],
    /// Columns and rows.
    pub(super) picture: [f64; 2],
    pub(super) camera: Arc<Leaves>,
}

/// An object prepared for comparison.
#[derive(Clone, Debug)]
pub(super) struct ObjectFeatures {
    /// Its index in the document, which is not compared.
    pub(super) index: usize,
    pub(super) position: [f64; 2],
    pub(super) heading: f64,
    pub(super) scale: f64,
    /// The reciprocal of the scale, which saves a division per pair of objects.
    pub(super) per_scale: f64,
    pub(super) reward: f64,
    pub(super) odds: f64,
    pub(super) color: Option<Oklab>,
    pub(super) motion: Arc<Leaves>,
    pub(super) body: Arc<Leaves>,
    pub(super) paid_for: Arc<Leaves>,
    pub(super) model: Arc<Leaves>,
    /// Equal for objects that differ only in position, heading and size.
    pub(super) kind: u64,
}

impl Sketcher {
    /// Makes the sketch of a world.
    pub(super) fn sketch(&mut self, world: &World) -> Sketch {
        let (agent, environment, rules) = (&world.agent_params, &world.environment_params, &world.rules);
        let mut by_class: BTreeMap<String, Vec<ObjectFeatures>> = BTreeMap::new();
        for (index, object) in world.objects.iter().enumerate() {
            let features = self.features(index, &as_read(object, environment.looks.style));
            by_class.entry(object.class.to_lowercase()).or_default().push(features);
        }
        let mut objects = Vec::with_capacity(world.objects.len());
        let mut classes = Vec::with_capacity(by_class.len());
        for (class, mut group) in by_class {
            group.sort_by(ObjectFeatures::order);
            objects.extend(group);
            classes.push((class, objects.len()));
        }
        let step_seconds = agent.time_step * f64::from(agent.frame_skip);
        let limits = [world.max_seconds, f64::from(world.max_steps) * step_seconds];
        self.texts.read_world(world);
        Sketch {
            objects,
            classes,
            start: agent.coordinates,
            heading: agent.heading.rem_euclid(360.0),
            action_model: self.leaves(Comparison::ModelOfActions),
            action_space: self.leaves(Comparison::SpaceOfActions),
            linear_speed: agent.max_linear_speed,
            angular_speed: agent.max_angular_speed,
            time_step: step_seconds,
            agent_width: agent.agent_width,
            energy: self.leaves(Comparison::EnergyOfAgent),
            map: environment.predefined_map,
            walls: self.leaves(Comparison::MapAndWalls),
            layout: self.shape(world),
            doors: doors(environment.layout.as_ref()),
            arena: environment.arena_size(),
            zones: [Comparison::Zones, Comparison::ZonePay, Comparison::ZoneLooks].map(|part| self.leaves(part)),
            step_reward: rules.step_reward / step_seconds + rules.reward_per_second,
            rules: self.leaves(Comparison::ShapingAndEndings),
            // Rounded to the microsecond, so that 100 steps of 0.3 s equal 300 of 0.1 s.
            limit: limits
                .into_iter()
                .filter(|seconds| *seconds > 0.0)
                .reduce(f64::min)
                .map(|seconds| (seconds * 1e6).round() / 1e6),
            light: environment.light_intensity,
            surroundings: [
                environment.bounding_wall_color,
                environment.sky_color,
                environment.ground_color,
                environment.light_color,
                environment.looks.ceiling_color_seen(environment.layout.as_ref()),
            ]
            .map(Oklab::from),
            picture: agent.picture_size().map(f64::from),
            camera: self.leaves(Comparison::CameraAndWeather),
        }
    }

    /// The shape of the world's layout, cached because worlds with the same layout often come in a row.
    fn shape(&mut self, world: &World) -> Option<Arc<LayoutShape>> {
        let environment = &world.environment_params;
        let (plan, arena, height) = (world.plan()?, environment.arena_size(), environment.wall_height);
        let size = [arena[0], arena[1], height];
        if let Some((known, known_size, shape)) = &self.layout
            && (known, *known_size) == (plan, size)
        {
            return Some(Arc::clone(shape));
        }
        let shape = Arc::new(LayoutShape::of(plan, arena, height));
        self.layout = Some((plan.clone(), size, Arc::clone(&shape)));
        Some(shape)
    }

    fn features(&mut self, index: usize, object: &Object) -> ObjectFeatures {
        self.texts.read_object(object);
        let mut features = ObjectFeatures {
            index,
            position: object.coordinates,
            heading: object.heading.rem_euclid(360.0),
            scale: object.scale,
            // Finite, so that two objects of size 0 are at distance 0 in size.
            per_scale: (1.0 / object.scale.abs()).min(f64::MAX),
            reward: object.reward,
            odds: object.reward_probability,
            color: object.color.map(Oklab::from),
            motion: self.leaves(Comparison::Motion),
            body: self.leaves(Comparison::Bodies),
            paid_for: self.leaves(Comparison::PaidFor),
            model: self.leaves(Comparison::ModelsOfObjects),
            kind: 0,
        };
        features.kind = self.kind(&features);
        features
    }

    /// An id for everything about an object except position, heading and size.
    fn kind(&mut self, object: &ObjectFeatures) -> u64 {
        let [l, a, b] = object.color.map_or([0.0; 3], |color| color.0);
        let numbers = [object.reward, object.odds, l, a, b].map(f64::to_bits);
        // Equal leaves are one allocation, which the reader keeps alive.
        let leaves = [&object.motion, &object.body, &object.paid_for, &object.model];
        let leaves = leaves.map(|leaves| Arc::as_ptr(leaves).addr() as u64);
        let mut key = [u64::from(object.color.is_some()); 10];
        key[1..6].copy_from_slice(&numbers);
        key[6..].copy_from_slice(&leaves);
        // All sketchers share the ids, so equal ids mean equal kinds wherever they come from.
        *self
            .kinds
            .entry(key)
            .or_insert_with(|| NEXT_KIND.fetch_add(1, atomic::Ordering::Relaxed))
    }

    /// The leaves of a comparison in the world or object that was read last.
    fn leaves(&mut self, comparison: Comparison) -> Arc<Leaves> {
        self.reader.read(self.texts.of(comparison))
    }
}

impl ObjectFeatures {
    /// Orders objects by their features, so that ties between matchings are broken by the objects alone.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let color = |object: &Self| object.color.map_or([-1.0; 3], |color| color.0);
        let numbers = |object: &Self| {
            let ([x, y], [l, a, b]) = (object.position, color(object));
            [x, y, object.heading, object.scale, object.reward, object.odds, l, a, b]
        };
        let (mine, theirs) = (numbers(self), numbers(other));
        let by_number = mine.iter().zip(&theirs).map(|(a, b)| a.total_cmp(b));
        let texts = |object: &Self| [&object.motion, &object.body, &object.paid_for, &object.model].map(Arc::clone);
        by_number.fold(Ordering::Equal, Ordering::then).then_with(|| {
            let (mine, theirs) = (texts(self), texts(other));
            let by_text = mine.iter().zip(&theirs).map(|(a, b)| a.text.cmp(&b.text));
            by_text.fold(Ordering::Equal, Ordering::then)
        })
    }
}

impl Sketch {
    /// For each class in either sketch, its objects in both, sorted by class.
    pub(super) fn classes_of_both<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = (&'a [ObjectFeatures], &'a [ObjectFeatures])> + 'a {
        let (mut i, mut j) = (0, 0);
        std::iter::from_fn(move || {
            let (mine, theirs) = (self.classes.get(i), other.classes.get(j));
            let class = match (mine, theirs) {
                (None, None) => return None,
                (Some(mine), None) => &mine.0,
                (None, Some(theirs)) => &theirs.0,
                (Some(mine), Some(theirs)) => (&mine.0).min(&theirs.0),
            };
            let objects_of = |sketch: &'a Self, at: &mut usize| -> &'a [ObjectFeatures] {
                let Some((_, end)) = sketch.classes.get(*at).filter(|entry| &entry.0 == class) else {
                    return &[];
                };
                let start = at.checked_sub(1).map_or(0, |before| sketch.classes[before].1);
                *at += 1;
                &sketch.objects[start..*end]
            };
            Some((objects_of(self, &mut i), objects_of(other, &mut j)))
        })
    }
}

/// The doors of a layout's rooms; none if it has no rooms.
pub(super) fn doors(layout: Option<&Layout>) -> RoomDoors {
    let rooms = layout.and_then(|layout| layout.rooms.as_ref());
    rooms.map_or_else(RoomDoors::default, |rooms| rooms.doors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_match_by_name_and_objects_have_a_canonical_order() {
        let world = |classes: &[(&str, f64)]| {
            let objects = classes.iter().map(|(class, x)| Object::new(*class, [*x, 0.0]));
            World::default().edit(|world| world.objects.extend(objects)).unwrap()
        };
        let mut sketcher = Sketcher::default();
        let a = sketcher.sketch(&world(&[("tree", 3.0), ("Rock", 2.0), ("tree", 1.0)]));
        let b = sketcher.sketch(&world(&[("pot", 4.0), ("rock", 5.0)]));
        let xs = |group: &[ObjectFeatures]| group.iter().map(|object| object.position[0]).collect::<Vec<_>>();
        let mut pairs: Vec<(Vec<f64>, Vec<f64>)> = a.classes_of_both(&b).map(|(a, b)| (xs(a), xs(b))).collect();
        pairs.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(
            pairs,
            [(vec![], vec![4.0]), (vec![1.0, 3.0], vec![]), (vec![2.0], vec![5.0])]
        );
    }
}
