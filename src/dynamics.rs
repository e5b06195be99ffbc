//! How differently two worlds answer to what an agent does, by the Wasserstein MDP distance and by bisimulation. A world as tables is
//! `env`'s, the distances are `similarity`'s.

use driftworld_env::{Abstraction, Catalogue, EnvError, WorldAbstraction};
use driftworld_similarity::{Bisimulation, Mdp, SimilarityError};
use driftworld_spec::World;

/// How many points count 1.
const POINTS: f64 = 100.0;

/// How many metres count 1.
const METRES: f64 = 10.0;

/// What the next action counts of this one in the bisimulation.
const DISCOUNT: f64 = 0.9;

/// How many pairs of states the bisimulation looks at. With fewer than there are its bounds are apart.
const MAX_PAIRS: usize = 1 << 17;

/// The sides of the area that both arenas lie in, around the origin.
pub(crate) fn common_area(a: &World, b: &World) -> [f64; 2] {
    let sides = [a, b].map(|world| world.environment_params.arena_size());
    [0, 1].map(|axis| sides[0][axis].max(sides[1][axis]))
}

/// A world as tables over the cells of an area.
pub(crate) fn tables(world: &World, area: [f64; 2], catalogue: &Catalogue) -> Result<WorldAbstraction, EnvError> {
    let abstraction = Abstraction {
        area: Some(area),
        catalogue: catalogue.clone(),
        ..Abstraction::default()
    };
    abstraction.of(world)
}

/// How differently one action ends in two worlds that are tables over the same cells, on average: 1 is 100 points, 10 m, half a
/// turn, or an end of the episode in one world alone. What of it is in what actions pay, and what in where they lead.
///
/// The mean is over all actions and over the states that actions lead to from the start of either world. Where the agent stands
/// after an action is compared by the place itself and not by its cell, so that small changes count little and not nothing.
/// Where it has no room in one world, it stays there, unpaid. Shorter time steps with as long a hold change no straight way; a
/// curve they change by some centimetres, for an agent turns before it goes in each time step.
///
/// Symmetric and 0 for equal worlds. The states of the mean depend on the pair, so a detour may be shorter. What tables do not
/// hold is not seen: looks, limits of time, what comes of taking or pushing things beyond the one action.
pub(crate) fn w1(a: &WorldAbstraction, b: &WorldAbstraction) -> Result<(f64, f64), SimilarityError> {
    let reached = a.reached().into_iter().zip(b.reached());
    let counted: Vec<bool> = reached.map(|(in_a, in_b)| in_a || in_b).collect();
    driftworld_similarity::w1_mdp([&a.rewards, &b.rewards], POINTS, &counted, |row| {
        landed_apart(a, b, row)
    })
}

/// The bisimulation distance between the starts of two worlds that are tables over the same cells, in shares of 100 points: how
/// much what is paid can differ, however the same actions go on. By cells, and so blind to what stays within one.
pub(crate) fn bisimulation(a: &WorldAbstraction, b: &WorldAbstraction) -> Result<Bisimulation, SimilarityError> {
    let starts = (a.start, b.start);
    driftworld_similarity::bisimulation(&process(a)?, &process(b)?, starts, DISCOUNT, MAX_PAIRS)
}

/// How far apart one state and action lead.
fn landed_apart(a: &WorldAbstraction, b: &WorldAbstraction, row: usize) -> f64 {
    match [a, b].map(|of| of.successors[row] as usize == of.grid.end()) {
        [true, true] => 0.0,
        [false, false] => {
            let (from, to) = (a.landings[row].map(f64::from), b.landings[row].map(f64::from));
            let [x, y, turn] = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            let turn = ((turn + 540.0).rem_euclid(360.0) - 180.0).abs();
            (x * x + y * y).sqrt() / METRES + turn / 180.0
        }
        _ => 1.0,
    }
}

fn process(of: &WorldAbstraction) -> Result<Mdp, SimilarityError> {
    let rewards = of.rewards.iter().map(|reward| reward / POINTS).collect();
    Mdp::new(of.states, of.actions, of.successors.clone(), rewards)
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Color, Object, Stimulus, Wall, WorldDraft};

    use super::*;

    #[derive(Debug, PartialEq)]
    struct Found {
        rewards: f64,
        motion: f64,
        bisimulation: Bisimulation,
    }

    impl Found {
        fn w1(&self) -> f64 {
            self.rewards + self.motion
        }
    }

    fn world(change: impl FnOnce(&mut WorldDraft)) -> World {
        let mut world = WorldDraft::default();
        world.environment_params.map_size = [20.0, 20.0];
        for (place, reward) in [([1.0, 7.0], 10.0), ([-5.0, -3.0], -20.0)] {
            let mut cube = Object::new("geometric", place);
            (cube.reward, cube.color) = (reward, Some(Color([1.0, 0.0, 0.0])));
            cube.reward_stimulus = vec![Stimulus::AgentCollide];
            cube.destroy_stimulus = vec![Stimulus::AgentCollide];
            world.objects.push(cube);
        }
        change(&mut world);
        world.check().expect("the world is sound")
    }

    fn between(a: &World, b: &World) -> Found {
        let area = common_area(a, b);
        let [a, b] = [a, b].map(|world| tables(world, area, &Catalogue::default()).expect("the worlds are small"));
        let (rewards, motion) = w1(&a, &b).expect("the tables are of one size");
        let bisimulation = bisimulation(&a, &b).expect("the tables are of one size");
        Found {
            rewards,
            motion,
            bisimulation,
        }
    }

    fn from_base(change: impl FnOnce(&mut WorldDraft)) -> Found {
        let (base, other) = (world(|_| ()), world(change));
        let found = between(&base, &other);
        if crate::tier::quick_or_full(false, true) {
            assert_eq!(found, between(&other, &base), "it makes no difference who comes first");
        }
        found
    }

    fn is_zero(found: &Found) -> bool {
        (found.w1(), found.bisimulation.upper) == (0.0, 0.0)
    }

    #[test]
    fn what_no_action_answers_to_is_zero() {
        assert!(is_zero(&from_base(|_| ())));
        assert!(is_zero(&from_base(|world| world.objects.reverse())));
        assert!(is_zero(&from_base(|world| {
            world.environment_params.light_intensity = 0.1;
            world.objects[0].color = Some(Color([0.0, 0.0, 1.0]));
            (world.max_steps, world.objects[1].tag) = (7, Some("cubes".to_owned()));
        })));
    }

    #[test]
    fn rewards_count_in_proportion() {
        let by = |points: f64| from_base(|world| world.objects[0].reward += points);
        let (one, two) = (by(5.0), by(10.0));
        assert!(one.w1() > 0.0 && (two.w1() - 2.0 * one.w1()).abs() < 1e-12);
        assert!(one.bisimulation.lower > 0.0);
        assert!((two.bisimulation.lower - 2.0 * one.bisimulation.lower).abs() < 1e-9);
        let all = from_base(|world| world.rules.step_reward = -2.0);
        // Five steps of each action everywhere; bisimulation has each in equal shares.
        assert_eq!(all.motion, 0.0);
        assert!((all.w1() - 0.1).abs() < 1e-12, "{all:?}");
        assert!((all.bisimulation.lower - 0.1).abs() < 1e-9, "{all:?}");
    }

    #[test]
    fn motion_counts_by_how_far_it_leads_apart() {
        let wall = Wall {
            polygon: vec![[-10.0, 0.0], [6.0, 0.0], [6.0, 0.4], [-10.0, 0.4]],
            height: None,
            color: None,
        };
        assert!(from_base(|world| world.environment_params.walls = vec![wall]).w1() > 0.01);
        assert!(from_base(|world| world.agent_params.agent_width = 2.0).w1() > 0.001);
        assert!(from_base(|world| world.agent_params.frame_skip = 2).w1() > 0.01);
        let [little, more] = [0.1, 1.0].map(|by| from_base(|world| world.agent_params.max_linear_speed += by).w1());
        assert!(0.0 < little && little < 0.3 * more, "{little} {more}");
    }

    #[test]
    fn the_length_of_a_time_step_alone_counts_little() {
        let fine = from_base(|world| (world.agent_params.time_step, world.agent_params.frame_skip) = (0.05, 2));
        let fast = from_base(|world| world.agent_params.max_linear_speed += 1.0);
        assert!(fine.w1() < 0.01 && fine.w1() < 0.5 * fast.w1(), "{fine:?} {fast:?}");
    }

    #[test]
    fn arenas_of_other_sizes_are_compared_over_both() {
        assert!(from_base(|world| world.environment_params.map_size = [24.0, 20.0]).w1() > 0.0);
    }
}
