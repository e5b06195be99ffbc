//! Compares the dynamics of two worlds by the Wasserstein MDP distance and by bisimulation.

use driftworld_env::{Abstraction, Catalogue, EnvError, WorldAbstraction};
use driftworld_similarity::{Bisimulation, Mdp, SimilarityError};
use driftworld_spec::World;

/// Difference in points that counts as a distance of 1.
const POINTS: f64 = 100.0;

/// Difference in metres that counts as a distance of 1.
const METRES: f64 = 10.0;

/// Discount of the bisimulation.
const DISCOUNT: f64 = 0.9;

/// Maximum number of state pairs that the bisimulation visits. If there are more, its lower and upper bounds differ.
const MAX_PAIRS: usize = 1 << 17;

/// The sides of the area around the origin that contains both arenas.
pub(crate) fn common_area(a: &World, b: &World) -> [f64; 2] {
    let sides = [a, b].map(|world| world.environment_params.arena_size());
    [0, 1].map(|axis| sides[0][axis].max(sides[1][axis]))
}

/// Tabulates a world over the cells of an area.
pub(crate) fn tables(world: &World, area: [f64; 2], catalogue: &Catalogue) -> Result<WorldAbstraction, EnvError> {
    let abstraction = Abstraction {
        area: Some(area),
        catalogue: catalogue.clone(),
        ..Abstraction::default()
    };
    abstraction.of(world)
}

/// The mean difference between the outcomes of one action in two worlds tabulated over the same cells: 1 is 100 points, 10 m,
/// half a turn, or an end of the episode in only one world. Returns the parts due to rewards and due to successors.
///
/// The mean is taken over all actions, and over the states that can be reached from the start of either world. The agent's
/// position after an action is compared in metres and not by cell, so that small changes count a little. In a state without
/// room for the agent, its actions leave it there without reward. Shorter time steps with proportionally larger frame skips do
/// not change straight paths. They change curves by centimetres, because an agent turns before it moves in each time step.
///
/// Symmetric, and 0 for equal worlds. The averaged states depend on the pair, so the triangle inequality may fail. Ignores what
/// the tables do not contain: looks, time limits, and the consequences of taking or pushing objects beyond one action.
pub(crate) fn w1(a: &WorldAbstraction, b: &WorldAbstraction) -> Result<(f64, f64), SimilarityError> {
    let reached = a.reached().into_iter().zip(b.reached());
    let counted: Vec<bool> = reached.map(|(in_a, in_b)| in_a || in_b).collect();
    driftworld_similarity::w1_mdp([&a.rewards, &b.rewards], POINTS, &counted, |row| {
        successor_distance(a, b, row)
    })
}

/// The bisimulation distance between the starts of two worlds tabulated over the same cells, as a share of 100 points: the
/// largest difference in discounted rewards under equal actions. It compares cells, and so ignores changes within a cell.
pub(crate) fn bisimulation(a: &WorldAbstraction, b: &WorldAbstraction) -> Result<Bisimulation, SimilarityError> {
    let starts = (a.start, b.start);
    driftworld_similarity::bisimulation(&process(a)?, &process(b)?, starts, DISCOUNT, MAX_PAIRS)
}

/// The distance between the successors of one state and action.
fn successor_distance(a: &WorldAbstraction, b: &WorldAbstraction, row: usize) -> f64 {
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
        world.check().expect("the world is valid")
    }

    fn between(a: &World, b: &World) -> Found {
        let area = common_area(a, b);
        let [a, b] = [a, b].map(|world| tables(world, area, &Catalogue::default()).expect("the worlds are small"));
        let (rewards, motion) = w1(&a, &b).expect("the tables have the same size");
        let bisimulation = bisimulation(&a, &b).expect("the tables have the same size");
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
            assert_eq!(found, between(&other, &base), "the distance is symmetric");
        }
        found
    }

    fn is_zero(found: &Found) -> bool {
        (found.w1(), found.bisimulation.upper) == (0.0, 0.0)
    }

    #[test]
    fn irrelevant_changes_have_distance_0() {
        assert!(is_zero(&from_base(|_| ())));
        assert!(is_zero(&from_base(|world| world.objects.reverse())));
        assert!(is_zero(&from_base(|world| {
            world.environment_params.light_intensity = 0.1;
            world.objects[0].color = Some(Color([0.0, 0.0, 1.0]));
            (world.max_steps, world.objects[1].tag) = (7, Some("cubes".to_owned()));
        })));
    }

    #[test]
    fn rewards_count_proportionally() {
        let raised = |points: f64| from_base(|world| world.objects[0].reward += points);
        let (one, two) = (raised(5.0), raised(10.0));
        assert!(one.w1() > 0.0 && (two.w1() - 2.0 * one.w1()).abs() < 1e-12);
        assert!(one.bisimulation.lower > 0.0);
        assert!((two.bisimulation.lower - 2.0 * one.bisimulation.lower).abs() < 1e-9);
        let costly = from_base(|world| world.rules.step_reward = -2.0);
        // Every action takes five steps, so it loses 10 points in every state; bisimulation takes a discounted mean.
        assert_eq!(costly.motion, 0.0);
        assert!((costly.w1() - 0.1).abs() < 1e-12, "{costly:?}");
        assert!((costly.bisimulation.lower - 0.1).abs() < 1e-9, "{costly:?}");
    }

    #[test]
    fn motion_counts_by_the_distance_of_successors() {
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
    fn time_step_length_alone_counts_little() {
        let fine = from_base(|world| (world.agent_params.time_step, world.agent_params.frame_skip) = (0.05, 2));
        let fast = from_base(|world| world.agent_params.max_linear_speed += 1.0);
        assert!(fine.w1() < 0.01 && fine.w1() < 0.5 * fast.w1(), "{fine:?} {fast:?}");
    }

    #[test]
    fn arenas_of_different_sizes_are_compared_over_both() {
        assert!(from_base(|world| world.environment_params.map_size = [24.0, 20.0]).w1() > 0.0);
    }
}
