//! Regression tests for bugs in distances by worlds that an audit found. Each comment states the former, wrong result.

use driftworld::generator::Sampler;
use driftworld::similarity::{Distance, Weights, world_distance, world_sets_distance};
use driftworld::spec::{Color, Element, MotionModel, Object, Region, Stimulus, Wall, World, WorldDraft};
use driftworld::tasks;
use serde_json::Value;

fn d(a: &World, b: &World) -> Distance {
    world_distance(a, b, &Weights::default())
}

fn world(change: impl FnOnce(&mut WorldDraft)) -> World {
    World::default().edit(change).unwrap_or_else(|error| panic!("{error}"))
}

fn cube(color: &str, reward: f64, place: [f64; 2]) -> Object {
    let mut cube = Object::new("cube", place);
    cube.color = Color::from_name(color);
    (cube.reward, cube.reward_stimulus) = (reward, vec![Stimulus::AgentCollide]);
    cube
}

fn drawn(name: &str, index: u64) -> World {
    let variant = tasks::variant(name).unwrap_or_else(|error| panic!("{error}"));
    Sampler::new(&variant, 0)
        .world(index)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A reversal of all rewards gave an R of only 0.048, because five other parts of the reward were 0. Many smaller changes gave
/// as much.
#[test]
fn reversal_of_all_pay_is_not_diluted() {
    let pays = |sign: f64| {
        world(|world| {
            world
                .objects
                .extend([0.0, 5.0, 9.0].map(|x| cube("red", 100.0 * sign, [x, x])));
        })
    };
    let found = d(&pays(1.0), &pays(-1.0));
    assert_eq!((found.element(Element::R), found.total), (Some(6.0), 6.0));
    let shared = |world: &World| world.clone().edit(|world| world.rules.reward_per_second = -1.0);
    let [a, b] = [&pays(1.0), &pays(-1.0)].map(|world| shared(world).unwrap_or_else(|error| panic!("{error}")));
    assert_eq!(d(&a, &b).total, 6.0);
}

/// A rewarding red object in the north and a costly blue one in the south had distance 0 in every element from the same objects
/// swapped, because positions, colours and rewards were compared separately.
#[test]
fn opposite_worlds_differ() {
    let worlds = |red: f64| {
        world(|world| {
            world
                .objects
                .extend([cube("red", 10.0, [0.0, red]), cube("blue", -10.0, [0.0, -red])]);
        })
    };
    let found = d(&worlds(10.0), &worlds(-10.0));
    // Matched objects are either 20 m apart, or differ in colour and by 20 points.
    assert!(found.total > 0.5, "{found:#?}");
    assert!(found.total >= 2.0 * 20.0 / 100.0);
}

/// Worlds with the same objects in a different order had a distance of up to 0.037.
#[test]
fn reordered_objects_have_distance_0() {
    for (task, _) in tasks::BUILT_IN {
        for variant in tasks::variants(task).unwrap_or_else(|error| panic!("{error}")) {
            let sampler = Sampler::new(&variant, 3);
            let world = sampler.world(0).unwrap_or_else(|error| panic!("{error}"));
            let reversed = world.clone().edit(|world| world.objects.reverse());
            let found = d(&world, &reversed.unwrap_or_else(|error| panic!("{error}")));
            assert!(
                found.parts.iter().all(|part| part.raw == 0.0 && part.normalised == 0.0),
                "{}",
                variant.id()
            );
        }
    }
}

/// As above, for walls and regions of the map, which were compared in listed order.
#[test]
fn reordered_walls_and_regions_have_distance_0() {
    let polygon = |x: f64| vec![[x, 10.0], [x + 2.0, 10.0], [x + 1.0, 14.0]];
    let listed = |xs: [f64; 3]| {
        world(|world| {
            let walls = xs.map(|x| Wall {
                polygon: polygon(x),
                height: Some(2.0),
                color: None,
            });
            world.environment_params.walls = walls.to_vec();
            world.environment_params.predefined_map = 1;
            world.environment_params.map_regions = Some(xs.map(|x| Region(polygon(x + 10.0))).to_vec());
        })
    };
    assert_eq!(d(&listed([-20.0, 12.0, 20.0]), &listed([20.0, -20.0, 12.0])).total, 0.0);
    assert!(d(&listed([-20.0, 12.0, 20.0]), &listed([20.0, -20.0, 12.5])).total > 0.0);
}

/// Adding eight barrels that cost 100 each gave R = 0, as did −50 or −5000. So did the step from a to b in the paper's Figure 4.
#[test]
fn added_costs_count() {
    let park = drawn("find_objects#blue", 0);
    let barrels = |reward: f64| {
        let more = park.clone().edit(|world| {
            world.objects.extend((0..8).map(|index| {
                let mut barrel = cube("tan", reward, [f64::from(index) * 3.0 - 12.0, 25.0]);
                "barrel".clone_into(&mut barrel.class);
                barrel
            }));
        });
        let found = d(&park, &more.unwrap_or_else(|error| panic!("{error}")));
        found.element(Element::R).unwrap_or(0.0)
    };
    assert!((barrels(-100.0) - 8.0).abs() < 1e-12);
    assert!((barrels(-50.0) - 4.0).abs() < 1e-12);
    assert!((barrels(-5000.0) - 400.0).abs() < 1e-9);
    let figure = |name: &str| (0..4).map(|index| drawn(name, index)).collect::<Vec<_>>();
    let found = world_sets_distance(
        &figure("blue_red_green#a"),
        &figure("blue_red_green#b"),
        &Weights::default(),
    );
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    assert!(
        found.element(Element::R).is_some_and(|reward| reward > 0.0),
        "{found:#?}"
    );
}

/// Magnitudes were only compared for equality: speeds of 2 and 2.001 were as far apart as 2 and 20, fog at 60 and 59 m as at 60
/// and 2 m, sizes of 1 and 1.0001 as 1 and 10. A map of 100 × 50 m equalled one of 50 × 100 m.
#[test]
fn magnitudes_are_graded() {
    let changes = [
        ("/objects/0/speed", [2.0, 2.001, 20.0]),
        ("/environment_params/fog_distance", [60.0, 59.0, 2.0]),
        ("/objects/0/scale", [1.0, 1.0001, 10.0]),
        ("/objects/0/turn_rate", [90.0, 91.0, 720.0]),
        ("/objects/1/range_stimulus_distance", [2.0, 2.5, 19.0]),
        ("/environment_params/wall_height", [4.0, 4.25, 9.0]),
        ("/agent_params/field_of_view", [60.0, 61.0, 120.0]),
        ("/rules/order_penalty", [-1.0, -1.25, -60.0]),
    ];
    let mut approached = cube("red", 5.0, [3.0, 3.0]);
    approached.reward_stimulus = vec![Stimulus::AgentInRange];
    let mut mover = Object::new("ball", [0.0, 0.0]);
    mover.motion_model = MotionModel::RandomWaypoint;
    let plain: Value =
        serde_json::to_value(world(|world| world.objects = vec![mover, approached])).expect("a world is JSON");
    for (name, values) in changes {
        let [base, near, far] = values.map(|value| {
            let mut json = plain.clone();
            let (parent, key) = name.rsplit_once('/').expect("a pointer has a slash");
            json.pointer_mut(parent).expect("every part is written")[key] = value.into();
            World::from_json("w.json", &json.to_string()).unwrap_or_else(|error| panic!("{error}"))
        });
        let (near, far) = (d(&base, &near).total, d(&base, &far).total);
        let [at, by, to] = values.map(f64::abs);
        assert!((near - (by - at).abs() / by.max(at)).abs() < 1e-12, "{name}: {near}");
        assert!((far - (to - at).abs() / to.max(at)).abs() < 1e-12, "{name}: {far}");
        assert!(near < 0.25 && far > 0.4, "{name}: {near} and {far}");
    }
    let sized = |map_size: [f64; 2]| world(|world| world.environment_params.map_size = map_size);
    assert_eq!(d(&sized([100.0, 50.0]), &sized([50.0, 100.0])).total, 1.0);
}

/// Moving a tree by 4 mm across a cell border counted as much as moving it to another cell.
#[test]
fn positions_have_no_cell_borders() {
    let tree = |x: f64| world(|world| world.objects.push(Object::new("tree", [x, 1.0])));
    for x in [-2.0, -0.002, 0.0, 0.998, 1.998, 3.0] {
        let moved = |metres: f64| d(&tree(x), &tree(x + metres)).total;
        assert!(
            (moved(0.004) - 0.0004).abs() < 1e-12 && (moved(4.0) - 0.4).abs() < 1e-12,
            "{x}"
        );
    }
}
