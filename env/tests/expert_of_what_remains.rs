//! The expert completes every subgoal that it can: unreachable objects do not keep it from others, and it does not touch
//! objects that end the episode as a failure. Tested with and without doors and portable objects.

use driftworld_env::EndedBy;
use driftworld_spec::{EndCondition, Object, Portable, Stimulus, Wall, World, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::{by_expert, wall_of};

fn cube(tag: &str, at: [f64; 2], reward: f64) -> Object {
    let mut object = Object::new("cube", at);
    (object.tag, object.reward) = (Some(tag.to_owned()), reward);
    if reward != 0.0 {
        object.reward_once_stimulus = vec![Stimulus::AgentCollide];
    }
    object
}

/// An arena of 24 m with a goal in the north, whose touch is a success and may pay.
fn field(pays: f64, has_things: bool) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [24.0, 24.0];
    world.objects = vec![cube("goal", [0.0, 9.0], pays)];
    if has_things {
        let mut key = Object::new("key", [-10.0, -10.0]);
        key.portable = Some(Portable::default());
        world.objects.push(key);
    }
    world.rules.success = vec![EndCondition::Touch("goal".to_owned())];
    world.agent_params.coordinates = [0.0, -9.0];
    world.max_steps = 900;
    world
}

/// Four walls around a position.
fn cell([x, y]: [f64; 2]) -> Vec<Wall> {
    let wall = |low: [f64; 2], high: [f64; 2]| {
        wall_of([
            [x + low[0], y + low[1]],
            [x + high[0], y + low[1]],
            [x + high[0], y + high[1]],
            [x + low[0], y + high[1]],
        ])
    };
    vec![
        wall([-2.0, -2.0], [2.0, -1.8]),
        wall([-2.0, 1.8], [2.0, 2.0]),
        wall([-2.0, -2.0], [-1.8, 2.0]),
        wall([1.8, -2.0], [2.0, 2.0]),
    ]
}

/// How an episode of the expert ends, and its return.
fn run_expert(world: World) -> (Option<EndedBy>, bool, f64) {
    let mut earned = 0.0;
    let (_, last) = by_expert(world, |_, step| earned += step.reward);
    (last.ended_by, last.success, earned)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 60)))]

    #[test]
    fn unreachable_objects_do_not_keep_the_expert_from_others(
        has_things in any::<bool>(), pays in prop::sample::select(vec![0.0, 1.0]), is_layout in any::<bool>(),
        shut in prop::collection::vec(prop::array::uniform2(-7.0..7.0_f64), 1..3), open in prop::option::of(-9.0..-3.0_f64),
    ) {
        let mut world = field(pays, has_things);
        let shut: Vec<[f64; 2]> = shut.into_iter().map(|[x, y]| [x, y * 0.6]).collect();
        let walls: Vec<Wall> = shut.iter().flat_map(|at| cell(*at)).collect();
        if is_layout {
            let walls = walls.into_iter().map(|wall| driftworld_spec::LayoutWall { polygon: Some(wall.polygon), ..Default::default() });
            world.environment_params.layout = Some(driftworld_spec::Layout { walls: Some(walls.collect()), ..Default::default() });
        } else {
            world.environment_params.walls = walls;
        }
        world.objects.extend(shut.iter().map(|at| cube("gem", *at, 5.0)));
        // One reachable gem, far from all cells.
        if let Some(x) = open {
            world.objects.push(cube("gem", [x, -9.0], 5.0));
        }
        let (ended_by, success, earned) = run_expert(world.check().expect("the world is valid"));
        prop_assert!(success, "{ended_by:?} after {earned}");
        let expected = pays + if open.is_some() { 5.0 } else { 0.0 };
        prop_assert_eq!(earned, expected);
    }

    #[test]
    fn expert_touches_nothing_that_fails(
        has_things in any::<bool>(), gap in -8.0..8.0_f64, (solid, scale) in (any::<bool>(), 0.8..1.6_f64), heading in 0.0..360.0_f64,
    ) {
        let mut world = field(1.0, has_things);
        // A row of lava across the arena, with one gap of 4 m.
        let places = (0..25).map(|number| f64::from(number) - 12.0).filter(|x| (x - gap).abs() > 2.0 + scale / 2.0);
        world.objects.extend(places.map(|x| {
            let mut lava = cube("lava", [x, 0.0], 0.0);
            (lava.solid, lava.scale) = (solid, scale);
            lava
        }));
        world.rules.failure = vec![EndCondition::Touch("lava".to_owned())];
        world.agent_params.heading = heading;
        let (ended_by, success, earned) = run_expert(world.check().expect("the world is valid"));
        prop_assert!(success, "{ended_by:?} after {earned}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 60)))]

    /// Carriable objects on open ground that block no path are not moved, whatever their number.
    #[test]
    fn thing_beside_the_path_is_left_alone(
        things in prop::collection::vec(prop::array::uniform2(-8.0..8.0_f64), 1..6), heading in 0.0..360.0_f64,
    ) {
        let mut world = field(1.0, false);
        world.agent_params.carry_limit = 3;
        world.agent_params.heading = heading;
        let far = |at: &[f64; 2]| libm::hypot(at[0], at[1] - 9.0) > 2.0 && libm::hypot(at[0], at[1] + 9.0) > 2.0;
        world.objects.extend(things.into_iter().filter(far).map(|at| {
            let mut key = Object::new("key", at);
            key.portable = Some(Portable::default());
            key
        }));
        let (_, last) = by_expert(world.check().expect("the world is valid"), |environment, _| {
            assert!(environment.objects().iter().all(|own| !own.carried));
        });
        prop_assert!(last.success, "{:?}", last.ended_by);
    }
}

/// An object right behind a doorway, which leaves no way around it: an agent that may carry it moves it out of the way.
#[test]
fn thing_in_the_way_is_picked_up() {
    let behind = |carry_limit: u32, at: f64| {
        let mut world = field(1.0, false);
        let wall = |x: [f64; 2]| wall_of([[x[0], -0.15], [x[1], -0.15], [x[1], 0.15], [x[0], 0.15]]);
        world.environment_params.walls = vec![wall([-12.0, -0.75]), wall([0.75, 12.0])];
        let mut key = Object::new("key", [0.0, at]);
        key.portable = Some(Portable::default());
        world.objects.push(key);
        world.agent_params.carry_limit = carry_limit;
        run_expert(world.check().expect("the world is valid"))
    };
    for at in [0.7, 0.8, 0.9] {
        assert_eq!(
            behind(1, at),
            (Some(EndedBy::Touch), true, 1.0),
            "{at} m behind the wall"
        );
    }
    let (ended_by, success, _) = behind(0, 0.8);
    assert!(!success, "{ended_by:?}: there is no path");
}
