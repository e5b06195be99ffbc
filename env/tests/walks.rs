//! Compares a thousand straight walks among walls and objects with those of a frictionless disc, computed independently: it
//! moves in steps of two millimetres, after each of which it is moved out of obstacles to a skin's distance. Distances to boxes
//! and discs are computed in their own frames.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use driftworld_env::{Action, ColliderShape, Environment};
use driftworld_spec::{Object, World, WorldDraft};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::fixtures::wall_of;

const SKIN: f64 = 0.01;
const STEPS: usize = 120;
const SPEED: f64 = 5.0;

/// An upright body: a box in its own frame, or a disc, which is a box without sides.
struct Upright {
    middle: [f64; 2],
    /// The unit vector of its own x axis.
    axis: [f64; 2],
    half: [f64; 2],
    radius: f64,
}

impl Upright {
    /// The distance of a point, and the direction away.
    fn distance(&self, at: [f64; 2]) -> (f64, [f64; 2]) {
        let [dx, dy] = [at[0] - self.middle[0], at[1] - self.middle[1]];
        let [ax, ay] = self.axis;
        let local = [dx * ax + dy * ay, dy * ax - dx * ay];
        let clamped = [0, 1].map(|axis| local[axis].clamp(-self.half[axis], self.half[axis]));
        let off = [local[0] - clamped[0], local[1] - clamped[1]];
        let far = off[0].hypot(off[1]);
        if far > 0.0 {
            let out = [off[0] / far, off[1] / far];
            let out = [out[0] * ax - out[1] * ay, out[0] * ay + out[1] * ax];
            return (far - self.radius, out);
        }
        (-self.radius, [ax, ay])
    }

    fn bound(&self) -> f64 {
        self.half[0].hypot(self.half[1]) + self.radius
    }
}

fn edge(from: [f64; 2], to: [f64; 2]) -> Upright {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]).max(1e-12);
    Upright {
        middle: [0, 1].map(|axis| f64::midpoint(from[axis], to[axis])),
        axis: along.map(|part| part / length),
        half: [length / 2.0, 0.0],
        radius: 0.02,
    }
}

/// All bodies of a world.
fn uprights(environment: &Environment) -> Vec<Upright> {
    let world = environment.world();
    let mut all = Vec::new();
    let regions = world.environment_params.regions();
    let walls = world
        .environment_params
        .walls
        .iter()
        .map(|wall| wall.polygon.as_slice());
    for polygon in regions.into_iter().chain(walls) {
        for (from, to) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            if from != to {
                all.push(edge(*from, *to));
            }
        }
    }
    let [x, y] = world.environment_params.arena_size().map(|side| side / 2.0 + 0.02);
    all.push(edge([-x, -y], [x, -y]));
    all.push(edge([x, -y], [x, y]));
    all.push(edge([x, y], [-x, y]));
    all.push(edge([-x, y], [-x, -y]));
    let agent_height = world.agent_params.agent_height;
    for item in &environment.scene().items {
        let scale = f64::from(item.scale);
        let heading = f64::from(item.heading_deg).to_radians();
        let (half, radius) = match &item.asset.collider {
            ColliderShape::Box { half: [x, y, _] } => ([f64::from(*x) * scale, f64::from(*y) * scale], 0.0),
            ColliderShape::Cylinder { radius, .. } => ([0.0; 2], f64::from(*radius) * scale),
            ColliderShape::Ball { radius } | ColliderShape::Capsule { radius, .. } => {
                let radius = f64::from(*radius) * scale;
                let over = (radius - agent_height).max(0.0);
                ([0.0; 2], (radius * radius - over * over).sqrt())
            }
            ColliderShape::Hull { .. } => unreachable!("no built-in object is a hull"),
        };
        all.push(Upright {
            middle: item.position.map(f64::from),
            axis: [heading.cos(), -heading.sin()],
            half,
            radius,
        });
    }
    all
}

/// The end of a frictionless disc's walk.
fn walk_of_a_disc(all: &[Upright], from: [f64; 2], heading_deg: f64, radius: f64) -> [f64; 2] {
    const PART: f64 = 0.002;
    let keep = radius + SKIN;
    let way = [
        heading_deg.to_radians().sin() * PART,
        heading_deg.to_radians().cos() * PART,
    ];
    let mut at = from;
    let mut near: Vec<&Upright> = Vec::new();
    let parts = (STEPS as f64 * SPEED * 0.1 / PART).round() as usize;
    for part in 0..parts {
        if part % 200 == 0 {
            near.clear();
            near.extend(all.iter().filter(|body| body.distance(at).0 < keep + 0.5));
        }
        at = [at[0] + way[0], at[1] + way[1]];
        for _ in 0..20 {
            let worst = near
                .iter()
                .map(|body| body.distance(at))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match worst {
                Some((distance, out)) if distance < keep - 1e-9 => {
                    at = [0, 1].map(|axis| at[axis] + out[axis] * (keep - distance));
                }
                _ => break,
            }
        }
    }
    at
}

const CLASSES: [&str; 12] = [
    "cube", "ball", "tree", "bush", "rock", "car", "house", "building", "barrel", "tent", "fence", "lamp",
];

fn world(rng: &mut ChaCha8Rng, number: usize) -> World {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [100.0, 100.0];
    // The four built-in maps, and open ground.
    world.environment_params.predefined_map = (number % 5) as _;
    let mut uniform = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
    for _ in 0..10 {
        let (middle, turn) = ([uniform(-45.0, 45.0), uniform(-45.0, 45.0)], uniform(0.0, 6.3));
        let half = [uniform(0.3, 12.0), uniform(0.1, 3.0)];
        let corner = |x: f64, y: f64| {
            let (x, y) = (x * half[0], y * half[1]);
            [
                middle[0] + x * turn.cos() - y * turn.sin(),
                middle[1] + x * turn.sin() + y * turn.cos(),
            ]
        };
        let polygon = vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        world.environment_params.walls.push(wall_of(polygon));
    }
    for class in CLASSES {
        let mut object = Object::new(class, [uniform(-45.0, 45.0), uniform(-45.0, 45.0)]);
        object.heading = uniform(0.0, 360.0);
        object.scale = uniform(0.5, 2.5);
        world.objects.push(object);
    }
    world.agent_params.agent_width = uniform(0.4, 1.4);
    world.agent_params.coordinates = [uniform(-48.0, 48.0), uniform(-48.0, 48.0)];
    world.agent_params.heading = uniform(0.0, 360.0);
    world.check().expect("the world is valid")
}

#[test]
fn thousand_walks_end_where_a_frictionless_disc_does() {
    const WALKS: usize = 1000;
    let mut rng = ChaCha8Rng::seed_from_u64(16);
    let (mut done, mut number, mut far, mut slid) = (0, 0, Vec::new(), 0);
    while done < WALKS {
        number += 1;
        let world = world(&mut rng, number);
        let agent = world.agent_params.clone();
        let mut environment = Environment::new(world);
        let radius = agent.agent_width / 2.0;
        let all = uprights(&environment);
        // Tests only walks that start in the open, outside closed regions.
        let is_free = all.iter().all(|body| body.distance(agent.coordinates).0 > radius + 0.1);
        if !is_free || all.iter().any(|body| body.bound() < 1e-3) {
            continue;
        }
        done += 1;
        for _ in 0..STEPS {
            environment
                .step(Action::Continuous([SPEED, 0.0, 0.0]))
                .expect("the episode continues");
        }
        let found = environment.agent().position.map(f64::from);
        let expected = walk_of_a_disc(&all, agent.coordinates, agent.heading, radius);
        let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        let straight = [agent.heading.to_radians().sin(), agent.heading.to_radians().cos()];
        let straight = [0, 1].map(|axis| agent.coordinates[axis] + straight[axis] * SPEED * 0.1 * STEPS as f64);
        slid += usize::from((expected[0] - straight[0]).hypot(expected[1] - straight[1]) > 0.5);
        if off > 0.02 * SPEED * 0.1 * STEPS as f64 {
            far.push((number, off, found, expected));
        }
    }
    println!("{} of {WALKS} walks are off, {slid} met something: {far:?}", far.len());
    assert!(slid > WALKS / 2, "most walks hit obstacles: {slid}");
    assert!(far.len() <= WALKS / 100, "{} of {WALKS} are off: {far:?}", far.len());
}
