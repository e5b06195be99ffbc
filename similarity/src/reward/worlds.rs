//! Distance between the rewards of two worlds, by EPIC over random states and choices.

use driftworld_spec::{Object, World};

use super::epic::RewardSamples;
use crate::SimilarityError;
use crate::combined::match_objects;
use crate::split_mix::SplitMix64;

/// The discount if neither world's shaping gives one.
const DISCOUNT: f64 = 0.99;

/// Number of transitions at which rewards are compared.
const TRANSITIONS: usize = 256;

/// Number of pairs of a choice and a state over which means are taken.
const DRAWS: usize = 96;

/// The distance between the rewards of two worlds, in `0..=1`: EPIC, which ignores rewards that no choice affects.
///
/// A state is the agent's position and the set of used-up objects; an action triggers one object, or none. For an action, a
/// world pays the object's reward (times its probability), or `order_penalty` if out of turn, plus its shaping. Both worlds'
/// rewards are evaluated on the same 256 transitions, each of which may lead anywhere; objects are matched as in
/// [`world_distance`](crate::world_distance), and an object that only one world has pays nothing in the other. So 0 means the
/// same reward up to a constant, a factor above 0 and potential shaping, about 0.7 (√½) unrelated rewards, and 1 the reverse.
///
/// It ignores the reward per second, which is a constant, and how hard a reward is to reach. The discount is the larger
/// of the discounts of the worlds' shaping, by default 0.99. A pseudometric among worlds whose objects match in the same way.
/// Deterministic. Takes a few milliseconds.
///
/// Source: Gleave, Dennis, Legg, Russell and Leike 2021, "Quantifying differences in reward functions".
///
/// # Errors
/// [`SimilarityError::BadReward`] for rewards beyond ±1e100.
///
/// # Example
/// ```
/// use driftworld_similarity::world_rewards_distance;
/// use driftworld_spec::{Object, Stimulus, World};
/// let world = |near: f64, far: f64| {
///     let object = |reward: f64, y: f64| Object {
///         reward,
///         reward_once_stimulus: vec![Stimulus::AgentCollide],
///         ..Object::new("cube", [0.0, y])
///     };
///     World::default().edit(|world| world.objects = vec![object(near, 2.0), object(far, 20.0)])
/// };
/// let d = |a: &World, b: &World| world_rewards_distance(a, b);
/// assert_eq!(d(&world(1.0, 5.0)?, &world(10.0, 50.0)?)?, 0.0);
/// assert_eq!(d(&world(1.0, 5.0)?, &world(-1.0, -5.0)?)?, 1.0);
/// assert!(d(&world(1.0, 5.0)?, &world(5.0, 1.0)?)? > 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn world_rewards_distance(a: &World, b: &World) -> Result<f64, SimilarityError> {
    let matches = match_objects(a, b);
    let of_a: Vec<Option<usize>> = matches.iter().map(|(a, _)| *a).collect();
    let of_b: Vec<Option<usize>> = matches.iter().map(|(_, b)| *b).collect();
    let (a, b) = (Rewards::new(a, &of_a), Rewards::new(b, &of_b));
    let shaped = [&a, &b].into_iter().filter_map(|own| own.world.rules.shaping.as_ref());
    let discounts = shaped.map(|shaping| shaping.discount);
    let discount = discounts.reduce(f64::max).unwrap_or(DISCOUNT);
    let samples = draw(matches.len(), [0, 1].map(|axis| a.reach(axis).max(b.reach(axis))))?;
    let measure = |own: &Rewards| samples.measure(|state, action, next| own.pays(state, *action, next));
    measure(&a)?.distance(&measure(&b)?, discount)
}

/// The agent's position, and which objects are used up.
#[derive(Clone, Debug)]
struct State {
    position: [f64; 2],
    used: Vec<bool>,
}

/// The object that is triggered.
type Choice = Option<usize>;

/// Random transitions between any states, for this number of objects and a field of this half-extent in metres.
fn draw(objects: usize, reach: [f64; 2]) -> Result<RewardSamples<State, Choice>, SimilarityError> {
    let mut rng = SplitMix64::keyed(0, objects as u64);
    let state = |rng: &mut SplitMix64| State {
        position: reach.map(|reach| (2.0 * rng.unit() - 1.0) * reach),
        used: (0..objects).map(|_| rng.below(2) == 1).collect(),
    };
    // Each object is as likely as no object at all.
    let choice = |rng: &mut SplitMix64| {
        let drawn = rng.below(objects as u64 + 1) as usize;
        (drawn < objects).then_some(drawn)
    };
    let transitions = (0..TRANSITIONS).map(|_| {
        let (from, action) = (state(&mut rng), choice(&mut rng));
        let mut to = state(&mut rng);
        to.used.clone_from(&from.used);
        if let Some(object) = action {
            to.used[object] = true;
        }
        (from, action, to)
    });
    let transitions = transitions.collect();
    let draws = (0..DRAWS).map(|_| (choice(&mut rng), state(&mut rng))).collect();
    RewardSamples::new(transitions, draws)
}

/// The rewards of a world, its objects in the order of the matching.
struct Rewards<'a> {
    world: &'a World,
    objects: Vec<Option<&'a Object>>,
}

impl<'a> Rewards<'a> {
    fn new(world: &'a World, indices: &[Option<usize>]) -> Self {
        let objects = indices.iter().map(|index| index.map(|index| &world.objects[index]));
        Self {
            world,
            objects: objects.collect(),
        }
    }

    fn reach(&self, axis: usize) -> f64 {
        self.world.environment_params.arena_size()[axis] / 2.0
    }

    /// The reward, in points, of a step between two states that triggers an object.
    fn pays(&self, from: &State, action: Choice, to: &State) -> f64 {
        let triggered = action.and_then(|index| Some((index, self.objects[index]?)));
        let shaped = self.world.rules.shaping.as_ref().map_or(0.0, |shaping| {
            shaping.discount * self.potential(to) - self.potential(from)
        });
        shaped + triggered.map_or(0.0, |(index, object)| self.worth(from, index, object))
    }

    /// The value of triggering an object in a state.
    fn worth(&self, state: &State, index: usize, object: &Object) -> f64 {
        let repeats = !object.reward_stimulus.is_empty();
        let pays = repeats || !object.reward_once_stimulus.is_empty();
        let stays = repeats && object.destroy_stimulus.is_empty();
        if !pays || (state.used[index] && !stays) {
            0.0
        } else if self.is_due(state, object) {
            object.reward * object.reward_probability
        } else {
            self.world.rules.order_penalty
        }
    }

    /// Whether all earlier objects of the sequence are used up.
    fn is_due(&self, state: &State, object: &Object) -> bool {
        let before = |other: &&Object| other.order.zip(object.order).is_some_and(|(other, own)| other < own);
        let open = self.objects.iter().zip(&state.used).filter(|(_, used)| !**used);
        !open.filter_map(|(other, _)| other.as_ref()).any(before)
    }

    /// The potential of the world's shaping, as in the simulator.
    fn potential(&self, state: &State) -> f64 {
        let Some(shaping) = &self.world.rules.shaping else {
            return 0.0;
        };
        let attracts = |object: &Object| match &shaping.toward {
            Some(tag) => object.tag.as_ref() == Some(tag),
            None => object.is_target() && object.reward > 0.0 && self.is_due(state, object),
        };
        let open = self.objects.iter().zip(&state.used).filter(|(_, used)| !**used);
        let near = open
            .filter_map(|(object, _)| *object)
            .filter(|object| attracts(object))
            .map(|object| {
                let [x, y] = [0, 1].map(|axis| object.coordinates[axis] - state.position[axis]);
                (x * x + y * y).sqrt()
            });
        -shaping.scale * near.reduce(f64::min).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::{Shaping, Stimulus};
    use proptest::prelude::*;

    fn world(pays: &[f64]) -> World {
        let object = |(index, pays): (usize, &f64)| Object {
            reward: *pays,
            reward_once_stimulus: vec![Stimulus::AgentCollide],
            destroy_stimulus: vec![Stimulus::AgentCollide],
            ..Object::new("cube", [7.0 * index as f64 - 10.0, 3.0])
        };
        World::default()
            .edit(|world| world.objects.extend(pays.iter().enumerate().map(object)))
            .unwrap()
    }

    fn distance(a: &World, b: &World) -> f64 {
        world_rewards_distance(a, b).unwrap()
    }

    #[test]
    fn added_costs_increase_the_distance() {
        let plain = world(&[10.0, 10.0]);
        let with_barrels = |pays: f64| {
            let mut world = plain.clone().into_draft();
            for index in 0..4 {
                let mut barrel = Object::new("barrel", [f64::from(index), -9.0]);
                (barrel.reward, barrel.reward_stimulus) = (pays, vec![Stimulus::AgentCollide]);
                world.objects.push(barrel);
            }
            world.check().unwrap()
        };
        assert_eq!(distance(&plain, &with_barrels(0.0)), 0.0);
        let (little, much) = (
            distance(&plain, &with_barrels(-1.0)),
            distance(&plain, &with_barrels(-50.0)),
        );
        assert!(0.0 < little && little < much && much < 0.8, "{little} {much}");
    }

    #[test]
    fn reward_per_second_does_not_matter() {
        let plain = world(&[10.0, -5.0]);
        let hasty = plain
            .clone()
            .edit(|world| world.rules.reward_per_second = -3.0)
            .unwrap();
        assert_eq!(distance(&plain, &hasty), 0.0);
    }

    #[test]
    fn sequence_differs_from_any_order() {
        let any = world(&[10.0, 10.0, 10.0]);
        let mut sequence = any.clone().into_draft();
        for (order, object) in (1..).zip(&mut sequence.objects) {
            object.order = Some(order);
        }
        assert!(distance(&any, &sequence.check().unwrap()) > 0.05);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn equivalent_rewards_are_0_apart_and_the_reverse_is_1(
            pays in prop::collection::vec(-100.0..100.0_f64, 1..6),
            factor in 0.01..100.0_f64,
            scale in 0.0..5.0_f64,
        ) {
            let times = |factor: f64| world(&pays.iter().map(|pays| pays * factor).collect::<Vec<_>>());
            let plain = times(1.0);
            prop_assert_eq!(distance(&plain, &times(factor)), 0.0);
            prop_assert!(distance(&plain, &times(-factor)) > 1.0 - 1e-9);
            let shaping = Shaping { toward: None, scale, discount: 1.0 };
            let soft = plain.clone().edit(|world| world.rules.shaping = Some(shaping)).unwrap();
            prop_assert_eq!(distance(&plain, &soft), 0.0);
        }

        #[test]
        fn reward_distance_is_a_pseudometric_for_worlds_that_differ_in_pay(
            pays in prop::array::uniform3(prop::array::uniform4(-100.0..100.0_f64)),
        ) {
            let [a, b, c] = pays.map(|pays| world(&pays));
            prop_assert_eq!(distance(&a, &a), 0.0);
            prop_assert!((distance(&a, &b) - distance(&b, &a)).abs() < 1e-9);
            prop_assert!(distance(&a, &c) <= distance(&a, &b) + distance(&b, &c) + 1e-9);
        }
    }
}
