//! The agent's energy: consumption, gains, and the end of the episode when it is used up; and stimuli that occur in every time
//! step.

use driftworld_env::{Action, Agent, EndedBy, Environment, RandomAgent};
use driftworld_spec::{EndCondition, Energy, Object, StateFeature, Stimulus, Trigger, WorldDraft, Zone, ZoneEnd};
use proptest::prelude::*;

use crate::fixtures::step;

const REST: Action = Action::Continuous([0.0; 3]);

fn energy(start: f64, per_second: f64, per_metre: f64, most: f64) -> Energy {
    Energy {
        start,
        per_second,
        per_metre,
        most,
    }
}

fn start(change: impl FnOnce(&mut WorldDraft)) -> Environment {
    let mut world = WorldDraft::default();
    world.agent_params.state_features = vec![StateFeature::Energy, StateFeature::Zone];
    world.rules.failure = vec![EndCondition::OutOfEnergy];
    change(&mut world);
    Environment::new(world.check().expect("the world is valid"))
}

fn has(environment: &Environment) -> f32 {
    environment.state_vector()[0]
}

/// An object of 1 m that is not solid.
fn thing(at: [f64; 2]) -> Object {
    let mut thing = Object::new("cube", at);
    thing.solid = false;
    thing
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

    /// Energy decreases per second and per metre, and ends the episode at the same simulated time for every time step.
    #[test]
    fn energy_falls_with_time_and_distance_and_ends_the_episode(
        begin in 1.0..50.0f64,
        per_second in -9.0..-1.0f64,
        per_metre in -2.0..0.0f64,
        speed in 0.0..8.0f64,
        time_step in prop::sample::select(vec![0.02, 0.05, 0.1, 0.25]),
        frame_skip in 1u32..5,
    ) {
        let mut environment = start(|world| {
            world.environment_params.map_size = [300.0, 300.0];
            let agent = &mut world.agent_params;
            agent.coordinates = [0.0, -140.0];
            (agent.energy, agent.time_step, agent.frame_skip) =
                (Some(energy(begin, per_second, per_metre, 60.0)), time_step, frame_skip);
        });
        let used = -(per_second + per_metre * speed);
        loop {
            let step = step(&mut environment, Action::Continuous([speed, 0.0, 0.0]));
            let expected = (begin - used * environment.seconds()).max(0.0);
            prop_assert!((f64::from(has(&environment)) - expected).abs() < 1e-2);
            if step.ended() {
                prop_assert_eq!((step.terminated, step.success, step.ended_by), (true, false, Some(EndedBy::Energy)));
                break;
            }
        }
        prop_assert!((environment.seconds() - begin / used).abs() <= time_step + 1e-2);
    }

    /// Energy stays between 0 and its capacity for all actions and objects.
    #[test]
    fn energy_never_exceeds_its_capacity(
        most in 1.0..20.0f64,
        gains in prop::collection::vec((-30.0..30.0f64, prop::array::uniform2(-6.0..6.0f64), any::<bool>()), 0..8),
        rates in prop::array::uniform2(-4.0..4.0f64),
        seed in any::<u64>(),
    ) {
        let mut environment = start(|world| {
            world.rules.failure.clear();
            world.environment_params.map_size = [16.0, 16.0];
            world.agent_params.energy = Some(energy(most / 2.0, rates[0], rates[1], most));
            for (gain, at, is_level) in gains {
                let mut thing = thing(at);
                (thing.energy, thing.reward_stimulus) = (gain, vec![Stimulus::AgentCollide]);
                thing.contact_trigger = if is_level { Trigger::Level } else { Trigger::Edge };
                world.objects.push(thing);
            }
        });
        let mut agent = RandomAgent::new(seed);
        for _ in 0..60 {
            let action = agent.act(&environment);
            step(&mut environment, action);
            prop_assert!((0.0..=most as f32).contains(&has(&environment)));
        }
    }

    /// A level-triggered stimulus acts in each time step, an edge-triggered one once; starting in range counts as entering it.
    #[test]
    fn level_stimuli_act_every_time_step_and_edge_stimuli_once(
        is_range in any::<bool>(),
        frame_skip in 1u32..5,
        steps in 1usize..9,
    ) {
        let earned = |trigger: Trigger| {
            let mut environment = start(|world| {
                world.agent_params.frame_skip = frame_skip;
                let mut thing = thing([0.0, 0.5]);
                (thing.reward, thing.range_stimulus_distance) = (1.0, 3.0);
                let stimulus = if is_range { Stimulus::AgentInRange } else { Stimulus::AgentCollide };
                thing.reward_stimulus = vec![stimulus];
                (thing.range_trigger, thing.contact_trigger) = (trigger, trigger);
                world.objects.push(thing);
            });
            (0..steps).map(|_| step(&mut environment, REST).reward).sum::<f64>()
        };
        prop_assert_eq!(earned(Trigger::Edge), 1.0);
        prop_assert_eq!(earned(Trigger::Level), steps as f64 * f64::from(frame_skip));
    }
}

#[test]
fn paying_objects_give_energy_as_often_as_they_pay() {
    let gained = |change: fn(&mut Object)| {
        let mut environment = start(|world| {
            world.agent_params.energy = Some(energy(10.0, 0.0, 0.0, 100.0));
            let mut thing = thing([0.0, 3.0]);
            thing.energy = 20.0;
            change(&mut thing);
            world.objects.push(thing);
        });
        for speed in [10.0, -10.0, 10.0] {
            for _ in 0..6 {
                step(&mut environment, Action::Continuous([speed, 0.0, 0.0]));
            }
        }
        has(&environment) - 10.0
    };
    assert_eq!(
        gained(|thing| thing.reward_stimulus = vec![Stimulus::AgentCollide]),
        60.0
    );
    assert_eq!(
        gained(|thing| thing.reward_once_stimulus = vec![Stimulus::AgentCollide]),
        20.0
    );
    assert_eq!(
        gained(|thing| thing.destroy_stimulus = vec![Stimulus::AgentCollide]),
        20.0
    );
    assert_eq!(gained(|_| ()), 0.0);
}

#[test]
fn step_reports_the_cause_of_the_end() {
    let ended_by = |change: fn(&mut WorldDraft)| {
        let mut environment = start(change);
        loop {
            let step = step(&mut environment, Action::Continuous([10.0, 0.0, 0.0]));
            if let Some(end) = step.ended_by {
                assert!(step.ended());
                return end.word();
            }
            assert!(!step.ended());
        }
    };
    let coin = |world: &mut WorldDraft| {
        let mut coin = thing([0.0, 5.0]);
        (coin.reward, coin.reward_once_stimulus) = (1.0, vec![Stimulus::AgentCollide]);
        coin.tag = Some("coin".to_owned());
        world.objects.push(coin);
    };
    assert_eq!(ended_by(|world| world.max_steps = 3), "steps");
    assert_eq!(ended_by(|world| world.max_seconds = 0.3), "time");
    assert_eq!(
        ended_by(|world| world.agent_params.energy = Some(energy(1.0, -9.0, 0.0, 1.0))),
        "energy"
    );
    let zone = |world: &mut WorldDraft| {
        let mut zone = Zone::disc([0.0, 5.0], 1.0);
        zone.ends = Some(ZoneEnd::Success);
        world.environment_params.zones = vec![zone];
    };
    let with = |rule: Option<EndCondition>| {
        let mut environment = start(|world| {
            if rule.is_none() {
                zone(world);
            }
            coin(world);
            world.rules.success.extend(rule);
            world.max_steps = 20;
        });
        loop {
            let step = step(&mut environment, Action::Continuous([10.0, 0.0, 0.0]));
            if step.ended() {
                assert!(step.success);
                return step.ended_by.map(EndedBy::word);
            }
        }
    };
    assert_eq!(with(None), Some("zone"));
    assert_eq!(with(Some(EndCondition::AllCollected)), Some("all_collected"));
    assert_eq!(with(Some(EndCondition::Touch("coin".to_owned()))), Some("touch"));
    assert_eq!(with(Some(EndCondition::ReturnAtLeast(1.0))), Some("return"));
}
