//! [`dynamics_distance`]: how differently two worlds answer to what an agent does, by the Wasserstein MDP distance and by bisimulation.
//! A world as tables is `env`'s, the distances are `similarity`'s.

use driftworld_env::{Abstraction, Catalogue, EnvError, WorldAbstraction};
use driftworld_similarity::{Mdp, PairedBisimulation, SimilarityError, paired_bisimulation};
use driftworld_spec::World;

use crate::{Failure, argument};

/// How two worlds are made finite and compared.
#[derive(Clone, Debug)]
pub struct DynamicsOptions {
    /// Side of a cell in metres; default 2.
    pub cell: f64,
    /// Seconds that an action is held, up to 60; default 0.5. It is held for whole steps of each world, as few as last that long.
    pub seconds: f64,
    /// How many points count 1; default 100.
    pub points: f64,
    /// How many metres count 1; default 10.
    pub metres: f64,
    /// What the next action counts of this one in the bisimulation, 0 to 0.9999; default 0.9.
    pub discount: f64,
    /// How many pairs of states the bisimulation looks at; default 131,072. With fewer than there are its bounds are apart.
    pub max_pairs: usize,
    /// Where assets come from.
    pub catalogue: Catalogue,
}

impl Default for DynamicsOptions {
    fn default() -> Self {
        Self {
            cell: 2.0,
            seconds: 0.5,
            points: 100.0,
            metres: 10.0,
            discount: 0.9,
            max_pairs: 1 << 17,
            catalogue: Catalogue::default(),
        }
    }
}

/// How far two worlds are apart in what actions do there.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicsDistance {
    /// How differently one action ends, on average: 1 is 100 points, 10 m, half a turn, or an end of the episode in one world alone.
    /// The sum of `rewards` and `motion`.
    pub w1: f64,
    /// What of it is in what the action pays.
    pub rewards: f64,
    /// What of it is in where the action leads.
    pub motion: f64,
    /// The bisimulation distance between the starts is not below this, in shares of 100 points.
    pub bisimulation_lower: f64,
    /// It is not above this.
    pub bisimulation_upper: f64,
    /// How many states `w1` is the mean of.
    pub states: usize,
    /// How many pairs of states the bisimulation looked at.
    pub pairs: usize,
}

/// How differently two worlds answer to the same actions.
///
/// Both worlds become tables ([`Abstraction`]) over the same cells, which cover both arenas around the origin. `w1` compares state by state
/// and action by action what the action pays and where the agent stands after it: `|Δ reward| / points + metres apart /
/// metres + turn apart / 180°`, or 1 in place of the way and the turn where the episode ends in one world alone. This is
/// the Wasserstein-1 distance of two certain outcomes ([`driftworld_similarity::w1_mdp`]), by the place itself and not by its cell, so
/// that small changes count little and not nothing. It is the mean over all actions and over the states that actions lead to from the start
/// of either world. Where the agent has no room in one world, it stays there, unpaid.
///
/// The bisimulation distance is that of the starts of both tables with rewards over `points`: how much what is paid can differ, however
/// the same actions go on, each time with `discount`, times `1 − discount`. By cells, and so blind to what stays within one.
///
/// Shorter time steps with as long a hold change no straight way; a curve they change by some centimetres, for an agent turns before it
/// goes in each time step.
///
/// Both are symmetric and 0 for equal worlds. The states that `w1` is the mean of depend on the pair, so a detour may be shorter. What tables do not hold is not seen: looks, limits of time, what comes of
/// taking or pushing things beyond the one action.
///
/// # Errors
/// [`Failure`] for options out of range, and for arenas of more cells than there may be.
///
/// # Example
/// ```
/// use driftworld::dynamics::{DynamicsOptions, dynamics_distance};
/// use driftworld::spec::World;
/// let walker = World::default().edit(|world| world.environment_params.map_size = [20.0, 20.0])?;
/// let runner = walker.clone().edit(|world| world.agent_params.max_linear_speed = 12.0)?;
/// let found = dynamics_distance(&walker, &runner, &DynamicsOptions::default()).unwrap();
/// assert!(found.w1 > 0.0 && found.w1 < 0.1, "half of the six actions go at most a metre farther");
/// assert_eq!(found.bisimulation_upper, 0.0, "nothing pays");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn dynamics_distance(a: &World, b: &World, options: &DynamicsOptions) -> Result<DynamicsDistance, Failure> {
    check(options)?;
    let area = common_area(a, b);
    let (a, b) = (tables(a, area, options)?, tables(b, area, options)?);
    let (rewards, motion, states) = w1(&a, &b, options);
    let found = bisimulation(&a, &b, options)?;
    Ok(DynamicsDistance {
        w1: rewards + motion,
        rewards,
        motion,
        bisimulation_lower: found.lower()[0],
        bisimulation_upper: found.upper()[0],
        states,
        pairs: found.pairs(),
    })
}

/// The sides of the area that both arenas lie in, around the origin.
pub(crate) fn common_area(a: &World, b: &World) -> [f64; 2] {
    let sides = [a, b].map(|world| world.environment_params.arena_size());
    [0, 1].map(|axis| sides[0][axis].max(sides[1][axis]))
}

/// A world as tables over the cells of an area.
pub(crate) fn tables(world: &World, area: [f64; 2], options: &DynamicsOptions) -> Result<WorldAbstraction, EnvError> {
    let abstraction = Abstraction {
        cell: options.cell,
        seconds: options.seconds,
        area: Some(area),
        catalogue: options.catalogue.clone(),
    };
    abstraction.of(world)
}

/// The bisimulation distance of the starts of two tables.
pub(crate) fn bisimulation(
    a: &WorldAbstraction,
    b: &WorldAbstraction,
    options: &DynamicsOptions,
) -> Result<PairedBisimulation, SimilarityError> {
    let (of_a, of_b) = (process(a, options)?, process(b, options)?);
    paired_bisimulation(&of_a, &of_b, &[(a.start, b.start)], options.discount, options.max_pairs)
}

fn check(options: &DynamicsOptions) -> Result<(), Failure> {
    for (name, found) in [("points", options.points), ("metres", options.metres)] {
        if !(found > 0.0 && found.is_finite()) {
            let name = argument(name);
            return Err(Failure::usage(format!(
                "{name}: found {found}, expected a finite number above 0"
            )));
        }
    }
    Ok(())
}

/// The means over states that are reached in either world, of what actions pay and of where they lead, and how many states those
/// are.
pub(crate) fn w1(a: &WorldAbstraction, b: &WorldAbstraction, options: &DynamicsOptions) -> (f64, f64, usize) {
    let reached = a.reached().into_iter().zip(b.reached());
    let (mut rewards, mut motion, mut count) = (0.0, 0.0, 0_usize);
    for (state, _) in reached.enumerate().filter(|(_, (in_a, in_b))| *in_a || *in_b) {
        for row in state * a.actions..(state + 1) * a.actions {
            let (paid, led) = apart(a, b, row, options);
            rewards += paid;
            motion += led;
        }
        count += 1;
    }
    let rows = (count * a.actions) as f64;
    (rewards / rows, motion / rows, count)
}

/// How far the outcomes of one state and action are apart: in what is paid, and in where it leads.
fn apart(a: &WorldAbstraction, b: &WorldAbstraction, row: usize, options: &DynamicsOptions) -> (f64, f64) {
    let paid = (a.rewards[row] - b.rewards[row]).abs() / options.points;
    // Sums of as many points over other numbers of steps differ by rounding.
    let paid = if paid < 1e-12 { 0.0 } else { paid };
    let ends = [a, b].map(|of| of.successors[row] as usize == of.grid.end());
    let led = match ends {
        [true, true] => 0.0,
        [false, false] => {
            let (from, to) = (a.landings[row].map(f64::from), b.landings[row].map(f64::from));
            let [x, y, turn] = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            let turn = ((turn + 540.0).rem_euclid(360.0) - 180.0).abs();
            (x * x + y * y).sqrt() / options.metres + turn / 180.0
        }
        _ => 1.0,
    };
    (paid, led)
}

fn process(of: &WorldAbstraction, options: &DynamicsOptions) -> Result<Mdp, SimilarityError> {
    let successors: Vec<usize> = of.successors.iter().map(|state| *state as usize).collect();
    let rewards = of.rewards.iter().map(|reward| reward / options.points).collect();
    Mdp::deterministic(of.states, of.actions, &successors, rewards)
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Color, Object, Stimulus, Wall, WorldDraft};

    use super::*;

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

    fn from_base(change: impl FnOnce(&mut WorldDraft)) -> DynamicsDistance {
        let (base, other) = (world(|_| ()), world(change));
        let between = |a, b| dynamics_distance(a, b, &DynamicsOptions::default()).expect("the worlds are small");
        let found = between(&base, &other);
        assert_eq!(found, between(&other, &base), "it makes no difference who comes first");
        found
    }

    fn is_zero(found: &DynamicsDistance) -> bool {
        (found.w1, found.bisimulation_upper) == (0.0, 0.0)
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
        assert!(one.w1 > 0.0 && (two.w1 - 2.0 * one.w1).abs() < 1e-12);
        assert!(one.bisimulation_lower > 0.0);
        assert!((two.bisimulation_lower - 2.0 * one.bisimulation_lower).abs() < 1e-9);
        let all = from_base(|world| world.rules.step_reward = -2.0);
        // Five steps of each action everywhere; bisimulation has each in equal shares.
        assert_eq!((all.w1, all.motion), (all.rewards, 0.0));
        assert!((all.w1 - 0.1).abs() < 1e-12, "{all:?}");
        assert!((all.bisimulation_lower - 0.1).abs() < 1e-9, "{all:?}");
    }

    #[test]
    fn motion_counts_by_how_far_it_leads_apart() {
        let wall = Wall {
            polygon: vec![[-10.0, 0.0], [6.0, 0.0], [6.0, 0.4], [-10.0, 0.4]],
            height: None,
            color: None,
        };
        assert!(from_base(|world| world.environment_params.walls = vec![wall]).w1 > 0.01);
        assert!(from_base(|world| world.agent_params.agent_width = 2.0).w1 > 0.001);
        assert!(from_base(|world| world.agent_params.frame_skip = 2).w1 > 0.01);
        let [little, more] = [0.1, 1.0].map(|by| from_base(|world| world.agent_params.max_linear_speed += by).w1);
        assert!(0.0 < little && little < 0.3 * more, "{little} {more}");
    }

    #[test]
    fn the_length_of_a_time_step_alone_counts_little() {
        let fine = from_base(|world| (world.agent_params.time_step, world.agent_params.frame_skip) = (0.05, 2));
        let fast = from_base(|world| world.agent_params.max_linear_speed += 1.0);
        assert!(fine.w1 < 0.01 && fine.w1 < 0.5 * fast.w1, "{fine:?} {fast:?}");
    }

    #[test]
    fn arenas_of_other_sizes_and_options_out_of_range() {
        assert!(from_base(|world| world.environment_params.map_size = [24.0, 20.0]).w1 > 0.0);
        let base = world(|_| ());
        for options in [
            DynamicsOptions {
                points: 0.0,
                ..DynamicsOptions::default()
            },
            DynamicsOptions {
                metres: f64::NAN,
                ..DynamicsOptions::default()
            },
            DynamicsOptions {
                cell: -1.0,
                ..DynamicsOptions::default()
            },
            DynamicsOptions {
                discount: 1.0,
                ..DynamicsOptions::default()
            },
        ] {
            assert!(dynamics_distance(&base, &base, &options).is_err());
        }
    }
}
