//! Effects of zones on the agent inside: rewards, speed, the end of the episode, and teleports.

use driftworld_env::{Action, Agent, Environment, RandomAgent};
use driftworld_spec::{ActionModel, Object, World, WorldDraft, Zone, ZoneEnd};
use proptest::prelude::*;

use crate::fixtures::step;

const AHEAD: Action = Action::Continuous([10.0, 0.0, 0.0]);
const REST: Action = Action::Continuous([0.0; 3]);

fn start(zones: Vec<Zone>, change: impl FnOnce(&mut WorldDraft)) -> Environment {
    let mut world = WorldDraft::default();
    world.environment_params.zones = zones;
    change(&mut world);
    Environment::new(world.check().expect("the world is valid"))
}

/// A square around a centre.
fn square([x, y]: [f64; 2], half: f64) -> Zone {
    Zone::polygon(vec![
        [x - half, y - half],
        [x + half, y - half],
        [x + half, y + half],
        [x - half, y + half],
    ])
}

fn pays(mut zone: Zone, per_second: f64, on_entering: f64) -> Zone {
    (zone.reward_per_second, zone.reward_on_entering) = (per_second, on_entering);
    zone
}

fn teleports(mut zone: Zone, to: [f64; 2]) -> Zone {
    zone.teleport = Some(to);
    zone
}

fn ends(mut zone: Zone, end: ZoneEnd) -> Zone {
    zone.ends = Some(end);
    zone
}

fn zone() -> impl Strategy<Value = Zone> {
    let place = prop::array::uniform2(-6.0..6.0f64);
    let shape = (place, 0.5..4.0f64, any::<bool>());
    let shape = shape.prop_map(|(at, size, is_disc)| {
        if is_disc {
            Zone::disc(at, size)
        } else {
            square(at, size)
        }
    });
    (shape, -3.0..3.0f64, -5.0..5.0f64, 0.2..2.0f64).prop_map(|(zone, per_second, on_entering, factor)| {
        let mut zone = pays(zone, per_second, on_entering);
        zone.speed_factor = factor;
        zone
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

    /// Standing in zones pays per second, independently of the time step, and once for entering, in the first step.
    #[test]
    fn standing_in_zones_pays_per_second(
        zones in prop::collection::vec(zone(), 0..5),
        at in prop::array::uniform2(-6.0..6.0f64),
        time_step in prop::sample::select(vec![0.02, 0.05, 0.1, 0.25]),
        frame_skip in 1u32..6,
    ) {
        let around: Vec<Zone> = zones.iter().filter(|zone| zone.contains(at)).cloned().collect();
        let mut environment = start(zones, |world| {
            let agent = &mut world.agent_params;
            (agent.coordinates, agent.time_step, agent.frame_skip) = (at, time_step, frame_skip);
        });
        let entering: f64 = around.iter().map(|zone| zone.reward_on_entering).sum();
        let rate: f64 = around.iter().map(|zone| zone.reward_per_second).sum();
        let mut earned = 0.0;
        for _ in 0..20 {
            earned += step(&mut environment, REST).reward;
            let expected = entering + rate * environment.seconds();
            prop_assert!((earned - expected).abs() < 1e-9, "{earned} for {expected}");
        }
    }

    /// Walking through a disc pays for the time on the chord, give or take one time step, and for one entry.
    #[test]
    fn crossing_a_zone_pays_for_the_time_in_it(
        offset in -2.5..2.5f64,
        speed in 0.5..40.0f64,
        time_step in prop::sample::select(vec![0.02, 0.05, 0.1, 0.3]),
        rate in -4.0..4.0f64,
    ) {
        let radius = 3.0;
        let zones = vec![pays(Zone::disc([offset, 0.0], radius), rate, 100.0)];
        let mut environment = start(zones, |world| {
            let agent = &mut world.agent_params;
            (agent.coordinates, agent.time_step, agent.max_linear_speed) = ([0.0, -10.0], time_step, speed);
        });
        let mut earned = 0.0;
        while environment.agent().position[1] < 10.0 {
            earned += step(&mut environment, Action::Continuous([speed, 0.0, 0.0])).reward;
        }
        let chord = 2.0 * (radius * radius - offset * offset).sqrt();
        let expected = 100.0 + rate * chord / speed;
        prop_assert!((earned - expected).abs() <= rate.abs() * time_step * 1.001 + 1e-6, "{earned} for {expected}");
    }

    /// Rewards and positions do not depend on the order of the list, bit for bit.
    #[test]
    fn order_of_zones_does_not_matter(
        zones in prop::collection::vec(zone(), 1..7),
        turned in any::<prop::sample::Index>(),
        seed in any::<u64>(),
    ) {
        let mut others = zones.clone();
        others.rotate_left(turned.index(zones.len()));
        others.reverse();
        let [mut one, mut other] = [zones, others].map(|zones| {
            start(zones, |world| world.environment_params.map_size = [16.0, 16.0])
        });
        let mut agent = RandomAgent::new(seed);
        for _ in 0..60 {
            let action = agent.act(&one);
            let (mine, theirs) = (step(&mut one, action), step(&mut other, action));
            prop_assert_eq!(mine.reward.to_bits(), theirs.reward.to_bits());
            prop_assert_eq!(one.agent().position.map(f32::to_bits), other.agent().position.map(f32::to_bits));
        }
    }

    /// The speed is the maximum speed times all factors at the agent's position at the beginning of a time step.
    #[test]
    fn factors_on_the_speed_are_multiplied(zones in prop::collection::vec(zone(), 0..5), heading in 0.0..360.0f64) {
        let factor: f64 = zones.iter().filter(|zone| zone.contains([0.0; 2])).map(|zone| zone.speed_factor).product();
        for model in [ActionModel::ByVelocity, ActionModel::ByWaypoint] {
            let mut environment = start(zones.clone(), |world| {
                (world.agent_params.heading, world.agent_params.action_model) = (heading, model);
            });
            let action = if model == ActionModel::ByVelocity { AHEAD } else { Action::Continuous([40.0, 9.0, 0.0]) };
            step(&mut environment, action);
            let [x, y] = environment.agent().position.map(f64::from);
            prop_assert!(((x * x + y * y).sqrt() - factor).abs() < 1e-5, "1 m at full speed, times {factor}");
        }
    }

    /// No lava is thin enough, and no agent fast enough, to jump over it.
    #[test]
    fn no_zone_is_jumped_over(width in 0.001..0.5f64, speed in 1.0..100.0f64, heading in -60.0..60.0f64) {
        let lava = Zone::polygon(vec![[-60.0, 2.0], [60.0, 2.0], [60.0, 2.0 + width], [-60.0, 2.0 + width]]);
        let mut environment = start(vec![ends(lava, ZoneEnd::Failure)], |world| {
            world.environment_params.map_size = [200.0, 200.0];
            world.agent_params.max_linear_speed = speed;
            world.agent_params.heading = f64::rem_euclid(heading, 360.0);
        });
        while !environment.ended() {
            prop_assert!(environment.agent().position[1] <= 2.0);
            step(&mut environment, Action::Continuous([speed, 0.0, 0.0]));
        }
    }
}

#[test]
fn zone_ends_are_success_or_failure_and_success_takes_precedence() {
    let end = |ends: &[ZoneEnd]| {
        let zones = ends.iter().map(|end| self::ends(Zone::disc([0.0, 1.0], 0.5), *end));
        let mut environment = start(zones.collect(), |_| ());
        let step = step(&mut environment, AHEAD);
        (step.terminated, step.success)
    };
    assert_eq!(end(&[]), (false, false));
    assert_eq!(end(&[ZoneEnd::Failure]), (true, false));
    assert_eq!(end(&[ZoneEnd::Success]), (true, true));
    assert_eq!(end(&[ZoneEnd::Failure, ZoneEnd::Success]), (true, true));
    // An agent that starts in a zone has entered it.
    let mut environment = start(vec![ends(Zone::disc([0.0; 2], 2.0), ZoneEnd::Failure)], |_| ());
    assert!(step(&mut environment, REST).terminated);
}

#[test]
fn zones_that_teleport_to_each_other_work_both_ways() {
    let (here, there) = ([0.0, 3.0], [0.0, -20.0]);
    let zones = vec![
        pays(teleports(Zone::disc(here, 1.0), there), 0.0, 1.0),
        pays(teleports(Zone::disc(there, 1.0), here), 0.0, 10.0),
    ];
    let mut environment = start(zones, |world| world.agent_params.frame_skip = 10);
    assert_eq!(
        step(&mut environment, Action::Continuous([1.9, 0.0, 0.0])).reward,
        0.0,
        "at its edge"
    );
    // Enters the first zone within the first time steps; during the remaining ones it continues from the middle of the second zone.
    let into = step(&mut environment, Action::Continuous([0.9, 0.0, 0.0]));
    assert_eq!(into.reward, 11.0, "arriving counts as entering");
    assert!((-19.5..-19.0).contains(&environment.agent().position[1]));
    // Leaving the second zone and entering it again teleports to the first.
    assert_eq!(step(&mut environment, Action::Continuous([5.0, 0.0, 0.0])).reward, 0.0);
    assert_eq!(
        step(&mut environment, Action::Continuous([-8.0, 0.0, 0.0])).reward,
        11.0
    );
    assert!((-2.0..3.0).contains(&environment.agent().position[1]));
}

#[test]
fn teleport_avoids_objects_and_the_first_of_several_counts() {
    let target = [10.0, 10.0];
    let zones = vec![
        teleports(Zone::disc([0.0, 1.0], 0.9), target),
        teleports(Zone::disc([0.0, 1.0], 0.8), [-10.0, 10.0]),
    ];
    let mut environment = start(zones, |world| {
        let mut cube = Object::new("cube", target);
        cube.scale = 2.0;
        world.objects.push(cube);
    });
    step(&mut environment, AHEAD);
    let [x, y] = environment.agent().position;
    let distance = ((x - 10.0).powi(2) + (y - 10.0).powi(2)).sqrt();
    assert!((0.5..4.1).contains(&distance), "({x}, {y})");
    assert_eq!(environment.agent().velocity, [0.0; 2]);
}

#[test]
fn agent_placed_into_a_zone_from_outside_has_not_entered_it() {
    let mut environment = start(vec![pays(Zone::disc([20.0, 0.0], 3.0), 2.0, 50.0)], |_| ());
    environment.teleport([20.0, 0.0], 0.0).expect("there is room");
    let mut other = Environment::new(environment.state());
    for environment in [&mut environment, &mut other] {
        assert!((step(environment, REST).reward - 0.2).abs() < 1e-12);
    }
}

#[test]
fn worlds_in_the_docs_are_valid() {
    let page = include_str!("../../docs/worlds.md");
    let texts: Vec<&str> = page
        .split("```json\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .filter(|text| text.contains("\"zones\"") || text.contains("\"energy\""))
        .collect();
    assert_eq!(texts.len(), 2);
    for text in texts {
        let world = World::from_json("docs/worlds.md", text).unwrap_or_else(|error| panic!("{error}"));
        assert!(world.remarks("docs/worlds.md", text).is_empty());
        step(&mut Environment::new(world), REST);
    }
}
