//! Distance between two concrete worlds. Which properties are compared is in `parts.rs`, how a world is reduced to them in `sketch.rs`;
//! distances of variants are in `variant.rs`.

use driftworld_spec::World;

use crate::SimilarityError;
use crate::combined::distance::{Distance, Weights};
use crate::combined::parts::{Parts, Sums, compare};
use crate::combined::sketch::{Sketch, Sketcher};
use crate::distribution::Method;

/// Side of the cells in which places are compared, in metres: what the original's placement grid has.
const CELL: f64 = 2.0;

/// How far apart two worlds are.
///
/// | element | parts |
/// |---|---|
/// | state | places of objects (OSPA within each class, cut off at 10 m), cells of 2 m taken (Jaccard), numbers of objects of each class (Jaccard of counts), their headings, the agent's start and heading |
/// | action | action model, action space, greatest speeds |
/// | transition | how things move, how solid they are, time step, the agent's width, map and walls, size of the arena |
/// | reward | what objects pay, for what, at which odds; step reward, rules, limit of steps |
/// | observation | colours of objects and surroundings (Oklab), models, light, camera |
///
/// Places are matched as is cheapest. All else about objects is compared with that of the same class and number within it in
/// the other world, which worlds of one task drawn under one seed have in common; what has no counterpart counts in the
/// state only, so that more trees are no other reward. All parts weigh 1 within their element, and what a part is divided by
/// is the same for all worlds.
///
/// Each part is 0 on equal worlds, symmetric and in 0..=1, and so is the whole. Among worlds that have the same classes in
/// the same numbers it is a metric up to worlds that differ in what is not compared (names, tags, the mode of the game, what has happened so far); among others the triangle
/// inequality may fail, because what has no counterpart is passed over. Time: some microseconds for 20 objects, growing with
/// the cube of the objects of one class.
pub fn world_distance(a: &World, b: &World, weights: &Weights) -> Distance {
    let mut sketcher = Sketcher::default();
    let (a, b) = (sketcher.sketch(a, CELL), sketcher.sketch(b, CELL));
    explained(&a, &b, weights)
}

/// How far apart two sets of worlds are: the mean over pairs, the first with the first and so on; worlds without a partner are left
/// out. Each part's numbers are means, too.
///
/// Draw both sets under the same seed and indices: then pairs share their random numbers, and what differs is what differs between
/// the variants.
///
/// # Errors
/// [`SimilarityError::Empty`] if there is no pair.
pub fn world_sets_distance(a: &[World], b: &[World], weights: &Weights) -> Result<Distance, SimilarityError> {
    let mut sketcher = Sketcher::default();
    let mut sums = Parts(Vec::new());
    for (a, b) in a.iter().zip(b) {
        let mut parts = Parts(Vec::new());
        compare(&sketcher.sketch(a, CELL), &sketcher.sketch(b, CELL), &mut parts);
        if sums.0.is_empty() {
            sums = parts;
        } else {
            for (sum, part) in sums.0.iter_mut().zip(parts.0) {
                (sum.raw, sum.normalised) = (sum.raw + part.raw, sum.normalised + part.normalised);
            }
        }
    }
    let count = a.len().min(b.len());
    if count == 0 {
        return Err(SimilarityError::Empty);
    }
    for part in &mut sums.0 {
        (part.raw, part.normalised) = (part.raw / count as f64, part.normalised / count as f64);
        part.method = Some(Method::Samples { count });
    }
    Ok(Distance::new(sums.0, weights))
}

/// Many worlds, prepared so that comparing each with each is fast: the same numbers as [`world_distance`].
///
/// # Example
/// ```
/// use driftworld_similarity::{DistanceMatrix, SimilarityError, Weights, Worlds};
/// use driftworld_spec::{Object, World};
/// let world = |x: f64| World { objects: vec![Object::new("tree", [x, 0.0])], ..World::default() };
/// let worlds = Worlds::new(&[world(0.0), world(5.0), world(0.0)], Weights::default());
/// assert_eq!(worlds.distance(0, 2), 0.0);
/// let names = ["a", "b", "c"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>(worlds.distance(a, b)))?;
/// assert_eq!(matrix.get(0, 1), worlds.explain(0, 1).total);
/// # Ok::<(), SimilarityError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Worlds {
    sketches: Vec<Sketch>,
    weights: Weights,
}

impl Worlds {
    /// Prepares worlds; their numbers are their places in the list.
    pub fn new(worlds: &[World], weights: Weights) -> Self {
        let mut sketcher = Sketcher::default();
        let sketches = worlds.iter().map(|world| sketcher.sketch(world, CELL)).collect();
        Self { sketches, weights }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.sketches.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.sketches.is_empty()
    }

    /// How far two of them are apart, in 0..=1.
    ///
    /// # Panics
    /// When there is no world of one of the numbers.
    pub fn distance(&self, a: usize, b: usize) -> f64 {
        total(&self.sketches[a], &self.sketches[b], &self.weights)
    }

    /// How far two of them are apart, part by part.
    ///
    /// # Panics
    /// When there is no world of one of the numbers.
    pub fn explain(&self, a: usize, b: usize) -> Distance {
        explained(&self.sketches[a], &self.sketches[b], &self.weights)
    }
}

fn explained(a: &Sketch, b: &Sketch, weights: &Weights) -> Distance {
    let mut parts = Parts(Vec::new());
    compare(a, b, &mut parts);
    Distance::new(parts.0, weights)
}

fn total(a: &Sketch, b: &Sketch, weights: &Weights) -> f64 {
    let mut sums = Sums::default();
    compare(a, b, &mut sums);
    weights.mean(&sums.0.map(|(sum, count)| (count > 0.0).then(|| sum / count)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::{Color, Element, Object};
    use proptest::prelude::*;

    fn world(color: &str, reward: f64) -> World {
        let mut object = Object::new("cube", [3.0, 4.0]);
        object.color = Color::from_name(color);
        object.reward = reward;
        World {
            objects: vec![object, Object::new("tree", [-5.0, 1.0])],
            ..World::default()
        }
    }

    #[test]
    fn equal_worlds_are_0_apart_in_every_part() {
        let distance = world_distance(&world("red", 1.0), &world("red", 1.0), &Weights::default());
        assert!(
            distance
                .parts
                .iter()
                .all(|part| part.normalised == 0.0 && part.raw == 0.0)
        );
        assert_eq!(distance.total, 0.0);
    }

    #[test]
    fn a_change_of_reward_shows_in_the_reward_only_and_one_of_colour_in_the_observation_only() {
        let base = world("red", 1.0);
        let paid = world_distance(&base, &world("red", -1.0), &Weights::default());
        let changed = |d: &Distance| Element::ALL.map(|element| d.element(element).is_some_and(|x| x > 0.0));
        assert_eq!(changed(&paid), [false, false, false, true, false]);
        let seen = world_distance(&base, &world("blue", 1.0), &Weights::default());
        assert_eq!(changed(&seen), [false, false, false, false, true]);
    }

    #[test]
    fn it_is_as_far_there_as_back_and_never_beyond_1() {
        let mut other = world("blue", 1e9);
        other.objects.push(Object::new("rock", [100.0, 100.0]));
        other.agent_params.heading = 350.0;
        other.environment_params.light_intensity = 0.0;
        other.agent_params.time_step = 9.0;
        let (a, b) = (world("red", -5.0), other);
        let (there, back) = (
            world_distance(&a, &b, &Weights::default()),
            world_distance(&b, &a, &Weights::default()),
        );
        assert_eq!(there, back);
        assert!(there.parts.iter().all(|part| (0.0..=1.0).contains(&part.normalised)));
        assert!(
            there
                .parts
                .iter()
                .any(|part| part.name == "agent's heading" && part.raw == 10.0)
        );
    }

    #[test]
    fn what_has_no_counterpart_counts_in_the_state_alone() {
        let mut more = world("red", 1.0);
        more.objects.push(Object::new("tree", [20.0, 20.0]));
        let distance = world_distance(&world("red", 1.0), &more, &Weights::default());
        assert_eq!(distance.differs_in(), [Element::S]);
        let part = |name: &str| distance.parts.iter().find(|part| part.name == name).unwrap().normalised;
        assert!((part("numbers of objects") - 1.0 / 3.0).abs() < 1e-12);
        assert!((part("places of objects") - 1.0 / 3.0).abs() < 1e-12);
        assert!((part("cells taken") - 1.0 / 3.0).abs() < 1e-12);
    }

    fn worlds() -> impl Strategy<Value = World> {
        let place = || prop::array::uniform2(-20.0..20.0_f64);
        let color = prop::sample::select(vec!["red", "blue", "tan"]);
        let objects = prop::collection::vec((place(), color, -100.0..100.0_f64, 0.0..=1.0_f64), 4);
        (objects, place(), 0.0..360.0_f64, -1.0..1.0_f64, 0.0..4.0_f64).prop_map(
            |(objects, start, heading, step_reward, light)| {
                let mut world = World::default();
                for (index, (place, color, reward, odds)) in objects.into_iter().enumerate() {
                    let mut object = Object::new(if index == 0 { "tree" } else { "pot" }, place);
                    object.color = Color::from_name(color);
                    (object.reward, object.reward_probability) = (reward, odds);
                    world.objects.push(object);
                }
                (world.agent_params.coordinates, world.agent_params.heading) = (start, heading);
                world.rules.step_reward = step_reward;
                world.environment_params.light_intensity = light;
                world
            },
        )
    }

    proptest! {
        #[test]
        fn among_worlds_with_the_same_classes_in_the_same_numbers_it_is_a_metric(a in worlds(), b in worlds(), c in worlds()) {
            let d = |a, b| world_distance(a, b, &Weights::default());
            prop_assert_eq!(d(&a, &a).total, 0.0);
            prop_assert!((d(&a, &b).total - d(&b, &a).total).abs() < 1e-12);
            prop_assert!((0.0..=1.0).contains(&d(&a, &b).total));
            let (direct, first, second) = (d(&a, &c), d(&a, &b), d(&b, &c));
            for (part, (first, second)) in direct.parts.iter().zip(first.parts.iter().zip(&second.parts)) {
                prop_assert!(part.normalised <= first.normalised + second.normalised + 1e-9, "{}", part.name);
            }
        }

        #[test]
        fn the_fast_way_gives_the_same_number_to_the_bit(a in worlds(), b in worlds(), all in any::<bool>()) {
            let mut b = b;
            if all {
                b.objects.truncate(2);
            }
            let prepared = Worlds::new(&[a.clone(), b.clone()], Weights::default());
            prop_assert_eq!(prepared.distance(0, 1), world_distance(&a, &b, &Weights::default()).total);
            prop_assert_eq!(prepared.explain(0, 1), world_distance(&a, &b, &Weights::default()));
            let alone = world_sets_distance(std::slice::from_ref(&a), std::slice::from_ref(&b), &Weights::default()).unwrap();
            prop_assert_eq!(prepared.distance(0, 1), alone.total);
        }
    }
}
