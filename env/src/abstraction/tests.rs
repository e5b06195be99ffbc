//! Transition and reward tables match the simulator and depend only on motion and rewards.

use driftworld_spec::{Color, Object, Stimulus, Wall, World, WorldDraft};

use super::*;

fn draft() -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [20.0, 20.0];
    let mut cube = Object::new("geometric", [1.0, 7.0]);
    (cube.reward, cube.color) = (10.0, Some(Color([1.0, 0.0, 0.0])));
    cube.reward_stimulus = vec![Stimulus::AgentCollide];
    cube.destroy_stimulus = vec![Stimulus::AgentCollide];
    world.objects = vec![cube];
    world
}

fn abstracted(change: impl FnOnce(&mut WorldDraft)) -> WorldAbstraction {
    let mut world = draft();
    change(&mut world);
    let world = world.check().expect("the world is valid");
    Abstraction::default().of(&world).expect("the world is small")
}

#[test]
fn actions_lead_to_the_poses_that_the_agent_reaches() {
    let found = abstracted(|_| ());
    assert_eq!((found.states, found.actions), (801, 6));
    let from = found.grid.state_at([1.0, -3.0], 0.0) * found.actions;
    // 10 m/s for half a second.
    assert_eq!(found.landings[from], [1.0, 2.0, 0.0]);
    assert_eq!(found.successors[from] as usize, found.grid.state_at([1.0, 2.0], 0.0));
    // 90°/s for half a second.
    assert_eq!(found.landings[from + 3], [1.0, -3.0, 315.0]);
    assert_eq!(found.landings[from + 5], [1.0, -3.0, 0.0]);
}

#[test]
fn touch_reward_is_paid_once_by_the_touching_action() {
    let found = abstracted(|_| ());
    let paid = |place: [f64; 2]| found.rewards[found.grid.state_at(place, 0.0) * found.actions];
    assert_eq!(
        (paid([1.0, 3.0]), paid([1.0, -9.0]), paid([-5.0, 3.0])),
        (10.0, 0.0, 0.0)
    );
    let mean = abstracted(|world| world.objects[0].reward_probability = 0.25);
    assert_eq!(mean.rewards[mean.grid.state_at([1.0, 3.0], 0.0) * 6], 2.5);
}

#[test]
fn ended_episode_leads_to_the_end_state() {
    let found = abstracted(|world| world.rules.success = vec![driftworld_spec::EndCondition::AllCollected]);
    let from = found.grid.state_at([1.0, 3.0], 0.0) * found.actions;
    assert_eq!(found.successors[from] as usize, found.grid.end());
    assert!(found.reached()[found.grid.end()]);
    assert_eq!(found.successors[found.grid.end() * 6] as usize, found.grid.end());
}

#[test]
fn settings_unrelated_to_motion_and_reward_do_not_change_the_tables() {
    let base = abstracted(|_| ());
    let looks = abstracted(|world| {
        world.environment_params.light_intensity = 0.2;
        world.objects[0].color = Some(Color([0.0, 0.0, 1.0]));
        (world.max_steps, world.agent_params.observation_size) = (1, 32);
    });
    assert_eq!(looks, base);
    let fine = abstracted(|world| (world.agent_params.time_step, world.agent_params.frame_skip) = (0.05, 2));
    let differ = |a: &[f32; 3], b: &[f32; 3]| (0..2).any(|axis| (a[axis] - b[axis]).abs() > 0.3);
    let straight = (0..base.landings.len()).step_by(6);
    assert!(
        straight
            .filter(|row| differ(&base.landings[*row], &fine.landings[*row]))
            .count()
            < 20
    );
}

#[test]
fn tables_depend_on_body_walls_speed_and_action_duration() {
    let base = abstracted(|_| ());
    let wall = Wall {
        polygon: vec![[-10.0, 0.0], [6.0, 0.0], [6.0, 0.4], [-10.0, 0.4]],
        height: None,
        color: None,
    };
    for other in [
        abstracted(|world| world.environment_params.walls = vec![wall]),
        abstracted(|world| world.agent_params.agent_width = 2.5),
        abstracted(|world| world.agent_params.max_linear_speed = 9.0),
        abstracted(|world| world.agent_params.frame_skip = 2),
        abstracted(|world| world.objects[0].reward = -10.0),
    ] {
        assert_ne!(other, base);
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let world = World::default();
    let code = |settings: Abstraction| settings.of(&world).expect_err("the setting is out of range").code();
    let default = Abstraction::default;
    assert_eq!(code(Abstraction { cell: 0.0, ..default() }), "env/bad-abstraction");
    assert_eq!(
        code(Abstraction {
            seconds: f64::NAN,
            ..default()
        }),
        "env/bad-abstraction"
    );
    assert_eq!(
        code(Abstraction {
            cell: 0.01,
            ..default()
        }),
        "env/too-many-states"
    );
}
