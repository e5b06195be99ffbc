//! Properties of doors and carriable objects under random actions: no object is lost or put into a wall, no door closes on the
//! agent, and a saved world resumes.

use driftworld_env::{Action, Effect, Environment};
use driftworld_spec::{Door, Portable, Pushable, StateFeature, Stimulus, Switch, World, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::{key, thing, wall_of};

/// A house of four rooms with doors of all kinds, keys, a switch, a pushable box and a wanderer.
fn house() -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [16.0, 16.0];
    let wall = |x: [f64; 2], y: [f64; 2]| wall_of([[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]);
    world.environment_params.walls = vec![
        wall([-8.0, -4.75], [-0.15, 0.15]),
        wall([-3.25, 3.25], [-0.15, 0.15]),
        wall([4.75, 8.0], [-0.15, 0.15]),
        wall([-0.15, 0.15], [-8.0, -4.75]),
        wall([-0.15, 0.15], [-3.25, 3.25]),
        wall([-0.15, 0.15], [4.75, 8.0]),
    ];
    let leaf = |at: [f64; 2], heading: f64, door: Door| {
        let mut leaf = thing("door", "door", at);
        (leaf.scale, leaf.heading, leaf.door) = (1.5, heading, Some(door));
        leaf
    };
    let both = || vec![Stimulus::AgentCollide, Stimulus::AgentInteract];
    let interact = || vec![Stimulus::AgentInteract];
    let mut lever = thing("switch", "lever", [-6.0, -6.0]);
    lever.switch = Some(Switch::of("door"));
    let mut crate_ = thing("cube", "box", [2.0, -2.0]);
    crate_.pushable = Some(Pushable {
        mass: 10.0,
        friction: 0.3,
    });
    let mut guest = thing("barrel", "guest", [5.0, 5.0]);
    (guest.motion_model, guest.speed) = (driftworld_spec::MotionModel::RandomWaypoint, 3.0);
    let mut soft = key("door_key", [-5.0, 5.0]);
    soft.solid = false;
    soft.portable = Some(Portable {
        on: both(),
        consumed: false,
    });
    world.objects = vec![
        leaf(
            [-4.0, 0.0],
            0.0,
            Door {
                opens_on: both(),
                closes_on: interact(),
                ..Door::default()
            },
        ),
        leaf(
            [0.0, 4.0],
            90.0,
            Door {
                key: Some("door_key".to_owned()),
                closes_after: Some(0.7),
                ..Door::default()
            },
        ),
        leaf(
            [4.0, 0.0],
            180.0,
            Door {
                opens_on: Vec::new(),
                period: Some(1.3),
                ..Door::default()
            },
        ),
        leaf(
            [0.0, -4.0],
            270.0,
            Door {
                opens_on: both(),
                open: true,
                closes_after: Some(2.0),
                ..Door::default()
            },
        ),
        lever,
        crate_,
        guest,
        soft,
        key("stone", [-2.0, -2.0]),
        key("stone", [-3.0, -5.0]),
    ];
    (world.agent_params.coordinates, world.agent_params.agent_width) = ([-4.0, -3.0], 0.6);
    world.agent_params.carry_limit = 2;
    world.agent_params.max_linear_speed = 4.0;
    world.agent_params.state_features = vec![StateFeature::Position, StateFeature::Carrying];
    world.seed = Some(7);
    world
}

/// Mostly ahead, with turns and frequent interactions.
fn action() -> impl Strategy<Value = Action> {
    (-1.0..4.0_f64, -90.0..90.0_f64, 0..3_u8)
        .prop_map(|(speed, turn, hand)| Action::Continuous([speed, turn, f64::from(u8::from(hand == 0))]))
}

/// Distance of a point from the nearest wall of the house, negative inside.
fn distance_to_wall(world: &World, [x, y]: [f32; 2]) -> f64 {
    let (x, y) = (f64::from(x), f64::from(y));
    let walls = world.environment_params.walls.iter().map(|wall| {
        let (low, high) = (wall.polygon[0], wall.polygon[2]);
        let out = |at: f64, axis: usize| (low[axis] - at).max(at - high[axis]);
        let (dx, dy) = (out(x, 0), out(y, 1));
        if dx <= 0.0 && dy <= 0.0 {
            dx.max(dy)
        } else {
            libm::hypot(dx.max(0.0), dy.max(0.0))
        }
    });
    walls.fold((8.0 - x.abs()).min(8.0 - y.abs()), f64::min)
}

/// A lower bound on the distance of the agent's centre from a closed door's leaf.
fn distance_to_leaf(world: &World, environment: &Environment, door: usize) -> f64 {
    let [x, y] = environment.agent().position.map(f64::from);
    let [dx, dy] = [
        x - world.objects[door].coordinates[0],
        y - world.objects[door].coordinates[1],
    ]
    .map(f64::abs);
    let (along, across) = if door.is_multiple_of(2) { (dx, dy) } else { (dy, dx) };
    libm::hypot((along - 0.75).max(0.0), (across - 0.14).max(0.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn things_are_never_lost_or_in_walls_and_doors_never_close_on_the_agent(actions in prop::collection::vec(action(), 200..500)) {
        let world = house().check().expect("the world is valid");
        let mut environment = Environment::new(world.clone());
        for action in actions {
            let before: Vec<bool> = environment.objects().iter().map(|own| own.open).collect();
            let step = environment.step(action).expect("the episode has no end");
            for (index, own) in environment.objects().iter().enumerate() {
                if world.objects[index].portable.is_some() {
                    prop_assert!(own.present != own.carried, "object {index} is lost or duplicated");
                }
                if own.carried {
                    prop_assert_eq!(own.position, environment.agent().position);
                }
                if world.objects[index].door.is_some() && !own.open {
                    let apart = distance_to_leaf(&world, &environment, index);
                    prop_assert!(apart > 0.3 - 1e-3, "the agent is {apart} from closed door {index}, before {:?}", before[index]);
                }
            }
            for event in step.events.iter().filter(|event| event.effect == Some(Effect::PutDown)) {
                let own = &environment.objects()[event.object];
                prop_assert!(distance_to_wall(&world, own.position) > 0.14, "{:?}", own.position);
                let lies = |other: &usize| *other != event.object && environment.objects()[*other].present;
                for other in (4..10).filter(lies) {
                    let there = environment.objects()[other].position;
                    let apart = libm::hypotf(there[0] - own.position[0], there[1] - own.position[1]);
                    prop_assert!(apart > 0.14 || !world.objects[other].solid, "in object {other}");
                }
            }
            let carried = environment.objects().iter().filter(|own| own.carried).count();
            prop_assert!(carried <= 2 && environment.state_vector()[2] == carried as f32);
        }
    }

    #[test]
    fn saved_house_resumes_bit_for_bit(
        actions in prop::collection::vec(action(), 50..300),
        share in 0.0..1.0_f64,
    ) {
        let mut environment = Environment::new(house().check().expect("the world is valid"));
        let written_at = (actions.len() as f64 * share) as usize;
        let mut other = None;
        for (number, action) in actions.into_iter().enumerate() {
            if number == written_at {
                let text = environment.state().to_json();
                let read = World::from_json("state", &text).expect("a state is a valid world");
                let went_on = Environment::new(read);
                prop_assert_eq!(went_on.state().to_json(), text);
                other = Some((went_on, environment.snapshot()));
            }
            let step = environment.step(action).expect("the episode has no end");
            if let Some((other, _)) = &mut other {
                prop_assert_eq!(other.step(action).expect("the episode has no end"), step);
                prop_assert_eq!(other.state().to_json(), environment.state().to_json());
                prop_assert_eq!(other.observe().rgb.clone(), environment.observe().rgb.clone());
            }
        }
        if let Some((mut other, moment)) = other {
            other.restore(&moment);
            let state = other.state();
            environment.restore(&moment);
            prop_assert_eq!(state, environment.state());
        }
    }
}
