//! The expert's paths: to the nearest of equal zones, around objects that cover part of a zone, and always forwards on open
//! ground.

use driftworld_spec::{Color, EndCondition, MotionModel, Object, Stimulus, WorldDraft, Zone, ZoneEnd};
use proptest::prelude::*;

use crate::fixtures::{by_expert, wall_of};

/// A zone to end the episode in success.
fn exit(at: [f64; 2], radius: f64) -> Zone {
    let mut zone = Zone::disc(at, radius);
    zone.ends = Some(ZoneEnd::Success);
    zone.color = Some(Color([0.2, 0.8, 0.2]));
    zone
}

/// An arena of 24 m with a wall across part of the middle.
fn hall(zones: Vec<Zone>) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [24.0, 24.0];
    world.environment_params.walls = vec![wall_of([[-6.0, -0.2], [6.0, -0.2], [6.0, 0.2], [-6.0, 0.2]])];
    world.environment_params.zones = zones;
    world.agent_params.coordinates = [0.0, -5.0];
    world.max_steps = 900;
    world
}

/// Metres walked to a success, `None` without one.
fn length(world: WorldDraft) -> Option<f32> {
    let (mut length, mut last) = (0.0, world.agent_params.coordinates.map(|metres| metres as f32));
    let (_, end) = by_expert(world.check().expect("the world is valid"), |environment, _| {
        let here = environment.agent().position;
        length += ((here[0] - last[0]).powi(2) + (here[1] - last[1]).powi(2)).sqrt();
        last = here;
    });
    end.success.then_some(length)
}

fn place() -> impl Strategy<Value = [f64; 2]> {
    (-9.0..9.0_f64, prop_oneof![-9.0..-7.0_f64, 2.0..9.0]).prop_map(|(x, y)| [x, y])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 60)))]

    /// In any order, and with a wall that is nearer in a straight line than around it.
    #[test]
    fn another_equal_zone_makes_no_path_longer(a in place(), b in place()) {
        let walk = |to: &[[f64; 2]]| length(hall(to.iter().map(|at| exit(*at, 1.0)).collect())).expect("no path is blocked");
        let (alone, both) = ([walk(&[a]), walk(&[b])], walk(&[a, b]));
        prop_assert_eq!(both, walk(&[b, a]));
        // Paths over cells are up to 8 % longer than straight ones.
        prop_assert!(both <= 1.1 * alone[0].min(alone[1]) + 1.0, "{} m, {:?} m to each alone", both, alone);
    }

    #[test]
    fn zone_partly_covered_by_a_rock_is_entered(at in place(), offset in [-1.0..1.0_f64, -1.0..1.0]) {
        let mut world = hall(vec![exit(at, 1.8)]);
        let mut rock = Object::new("cube", [at[0] + offset[0], at[1] + offset[1]]);
        rock.solid = true;
        world.objects = vec![rock];
        prop_assert!(length(world).is_some());
    }

    /// Smaller than a cell, or along a wall of the arena.
    #[test]
    fn tiny_zones_are_entered(at in place(), radius in 0.15..0.4_f64, is_at_wall in any::<bool>(), depth in 0.52..0.9_f64) {
        let mut zone = exit(at, radius);
        if is_at_wall {
            (zone.disc, zone.polygon) = (None, Some(vec![[-3.0, 12.0 - depth], [3.0, 12.0 - depth], [3.0, 12.0], [-3.0, 12.0]]));
        }
        prop_assert!(length(hall(vec![zone])).is_some());
    }

    /// The agent is 1 m wide.
    #[test]
    fn gaps_that_the_agent_fits_through_are_passed(x in -4.0..4.0_f64, gap in 1.45..3.0_f64) {
        let mut world = hall(vec![exit([0.0, 6.0], 1.0)]);
        let wall = |from: f64, to: f64| wall_of([[from, -0.2], [to, -0.2], [to, 0.2], [from, 0.2]]);
        world.environment_params.walls = vec![wall(-12.0, x - gap / 2.0), wall(x + gap / 2.0, 12.0)];
        prop_assert!(length(world).is_some());
    }

    /// However long its path is, the expert never backs up in the first 1,000 steps.
    #[test]
    fn expert_on_open_ground_never_backs_up(speed in 1.0..8.0_f64, x in -0.5..0.5_f64) {
        let mut world = WorldDraft::with_objects(vec![Object::new("cube", [x, 40.0])]);
        world.objects[0].tag = Some("goal".to_owned());
        world.rules.success = vec![EndCondition::Touch("goal".to_owned())];
        world.agent_params.coordinates = [0.0, -40.0];
        world.agent_params.max_linear_speed = speed;
        world.max_steps = 5000;
        let mut last = -40.0;
        let (_, end) = by_expert(world.check().expect("the world is valid"), |environment, _| {
            let [_, y] = environment.agent().position;
            assert!(y >= last - 1e-4, "from {last} back to {y}");
            last = y;
        });
        prop_assert!(end.success);
    }
}

/// Behind a wall with a gap too narrow for the agent, the goal is out of reach until it comes through.
#[test]
fn moving_goal_is_reached_once_it_enters_the_agents_room() {
    let mut world = hall(Vec::new());
    world.environment_params.walls = [[-12.0, -0.3], [0.3, 12.0]]
        .map(|[west, east]| wall_of([[west, -0.2], [east, -0.2], [east, 0.2], [west, 0.2]]))
        .to_vec();
    let mut goal = Object::new("geometric", [0.0, 9.0]);
    goal.scale = 0.2;
    goal.reward = 1.0;
    goal.reward_once_stimulus = vec![Stimulus::AgentCollide];
    goal.destroy_stimulus = vec![Stimulus::AgentCollide];
    goal.motion_model = MotionModel::Patrol;
    goal.speed = 1.0;
    goal.waypoints = vec![[0.0, 9.0], [0.0, -3.0], [9.0, -3.0]];
    world.objects.push(goal);
    world.rules.success = vec![EndCondition::ReturnAtLeast(1.0)];
    assert!(length(world).is_some_and(|metres| metres > 0.5));
}
