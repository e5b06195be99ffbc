//! The expert takes zones into account: it avoids those that cost, and visits those that pay if nothing else does.

use driftworld_env::{Action, EndedBy, Environment};
use driftworld_spec::{ActionModel, EndCondition, Object, Stimulus, WorldDraft, Zone, ZoneEnd};
use proptest::prelude::*;

fn start(zones: Vec<Zone>, at: [f64; 2], change: impl FnOnce(&mut WorldDraft)) -> Environment {
    let mut world = WorldDraft {
        max_steps: 600,
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [30.0, 30.0];
    world.environment_params.zones = zones;
    let agent = &mut world.agent_params;
    (agent.coordinates, agent.action_model) = (at, ActionModel::OnRails);
    change(&mut world);
    Environment::new(world.check().expect("the world is valid"))
}

/// The cause of the end, whether it was a success, and the return.
fn run_episode(environment: &mut Environment) -> (Option<EndedBy>, bool, f64) {
    loop {
        let step = environment
            .step(Action::Continuous([0.0; 3]))
            .expect("the episode continues");
        if step.ended() {
            return (step.ended_by, step.success, environment.episode_return());
        }
    }
}

fn lava(corners: [[f64; 2]; 2]) -> Zone {
    let [[x, y], [to_x, to_y]] = corners;
    let mut zone = Zone::polygon(vec![[x, y], [to_x, y], [to_x, to_y], [x, to_y]]);
    zone.ends = Some(ZoneEnd::Failure);
    zone
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 100)))]

    /// A stream of lava with a ford somewhere, up to two pools that cost, and the goal beyond.
    #[test]
    fn lava_is_crossed_at_the_ford(
        ford in -11.0..11.0f64,
        width in 2.0..4.0f64,
        start_x in -13.0..13.0f64,
        goal_x in -13.0..13.0f64,
        pools in prop::collection::vec((prop::array::uniform2(-10.0..10.0f64), 0.5..2.0f64), 0..3),
    ) {
        let (from, to) = ([start_x, -12.0], [goal_x, 12.0]);
        let mut zones = vec![
            lava([[-15.0, -1.0], [ford - width / 2.0, 1.0]]),
            lava([[ford + width / 2.0, -1.0], [15.0, 1.0]]),
        ];
        for ([x, y], radius) in pools {
            // Pools cover neither the ford, nor the agent, nor the goal.
            let y = if y > 0.0 { 6.0 + y / 5.0 } else { y / 5.0 - 5.0 };
            let mut pool = Zone::disc([x, y], radius);
            pool.reward_per_second = -10.0;
            zones.push(pool);
        }
        let mut environment = start(zones, from, |world| {
            let mut goal = Object::new("cube", to);
            (goal.reward, goal.reward_once_stimulus) = (1.0, vec![Stimulus::AgentCollide]);
            world.objects.push(goal);
            world.rules.success = vec![EndCondition::AllCollected];
        });
        prop_assert_eq!(run_episode(&mut environment), (Some(EndedBy::AllCollected), true, 1.0));
    }

    /// If nothing else pays, it goes to the zone that does, and stays there.
    #[test]
    fn zone_that_pays_is_visited(
        at in prop::array::uniform2(-13.0..13.0f64),
        zone in prop::array::uniform2(-11.0..11.0f64),
        radius in 1.0..3.0f64,
        ends in any::<bool>(),
    ) {
        let mut wanted = Zone::disc(zone, radius);
        wanted.reward_per_second = 1.0;
        wanted.ends = ends.then_some(ZoneEnd::Success);
        let mut poor = Zone::disc([-zone[0], zone[1]], 0.8);
        poor.reward_on_entering = 0.001;
        let mut environment = start(vec![poor, wanted], at, |_| ());
        let (ended_by, success, paid) = run_episode(&mut environment);
        if ends {
            prop_assert_eq!((ended_by, success), (Some(EndedBy::Zone), true));
        } else {
            prop_assert!(ended_by == Some(EndedBy::Steps) && paid > 45.0, "{paid}");
        }
    }
}
