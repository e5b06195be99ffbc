//! Simulates pushed bodies as rigid bodies on the ground, with rapier.
//!
//! Each time step creates its own physics world from the pushed bodies that may move, their surroundings and the agent. Only
//! positions and velocities carry over to the next time step, so a saved world resumes exactly, and a world at rest costs
//! nothing.

use driftworld_spec::World;
use rapier3d::prelude::*;

use super::body_shape::body_shape;
use super::collision_world::{CollisionWorld, EDGE, slot};
use super::encounters::Encounters;
use super::groups::{SOLID, WALL};
use super::neighbours::{MARGIN, static_reach, with_neighbours};
use super::outline::Outline;
use super::pushed::Pushed;
use super::sim_ref::SimRef;
use super::slide::SKIN;
use super::state::{SimState, wrapped};
use super::views::Views;

/// The agent's mass in kilograms, with which it pushes bodies.
const AGENT_MASS: f32 = 80.0;

/// Maximum duration of a physics step in seconds.
const MAX_PHYSICS_SECONDS: f32 = 1.0 / 60.0;

/// Minimum number of physics steps in a time step. The first step of a new physics world ignores existing contacts.
const MIN_PHYSICS_STEPS: u32 = 2;

/// Maximum number of physics steps in a time step. Longer time steps use longer physics steps.
const MAX_PHYSICS_STEPS: u32 = 60;

/// Standard gravity in metres per second squared, for friction with the ground.
const GRAVITY: f32 = 9.806_65;

/// A body in the physics world of a time step.
struct Active {
    /// Its index among the pushed bodies.
    index: usize,
    handle: RigidBodyHandle,
    radius: f32,
    friction: f32,
}

/// Lets the agent push bodies in its way, and lets pushed bodies slide on. Returns the agent's displacement, which is less than
/// `by` if pushing slows it down. Records the bodies that it pushed.
pub(super) fn push_bodies(
    world: &World,
    state: &mut SimState,
    views: &mut Views,
    by: [f32; 2],
    encounters: &mut Encounters,
) -> [f32; 2] {
    let sim = SimRef { world, state, views };
    let present = |body: &Pushed| sim.objects()[body.object].present;
    let may_move = |body: &Pushed| present(body) && (body.moves() || may_meet_agent(sim, body, by));
    if !sim.state.pushed.iter().any(may_move) {
        return by;
    }
    let seconds = world.agent_params.time_step as f32;
    let pushed = || sim.state.pushed.iter();
    let agent_pushes = pushed().any(|body| present(body) && may_meet_agent(sim, body, by));
    let first = (0..).zip(pushed()).filter(|(_, body)| may_move(body));
    let parts = ((seconds / MAX_PHYSICS_SECONDS).ceil() as u32).clamp(MIN_PHYSICS_STEPS, MAX_PHYSICS_STEPS);
    let chosen = with_neighbours(sim, first.map(|(index, _)| index).collect(), seconds, parts);
    if !chosen.is_complete {
        stop_all_but(&mut state.pushed, &chosen.indices);
    }
    #[cfg(test)]
    (encounters.num_queries += chosen.num_queries);
    let mut physics = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::default()
    };
    let sim = SimRef { world, state, views };
    let indices = chosen.indices.iter().copied();
    let active: Vec<Active> = indices.map(|index| add_active(sim, &mut physics, index)).collect();
    add_surroundings(sim, &mut physics, &active, seconds);
    let agent = agent_pushes.then(|| add_agent(sim, &mut physics, by, seconds));
    physics.integration_parameters.dt = seconds / parts as f32;
    let mut is_jammed = false;
    for _ in 0..parts {
        physics.step();
        if let Some((_, collider)) = agent {
            record_contacts(&state.pushed, &physics, collider, &mut encounters.met_objects);
        }
        apply_friction(&mut physics, &active);
        let num_pairs = physics.narrow_phase.contact_pairs().count();
        #[cfg(test)]
        (encounters.num_queries += num_pairs as u64);
        if num_pairs > chosen.max_pairs {
            // More bodies have met on their paths than allowed, so they stop.
            is_jammed = true;
            break;
        }
    }
    read_back(&physics, &active, world, state, views, encounters);
    if is_jammed {
        stop_all_but(&mut state.pushed, &[]);
    }
    let Some((body, _)) = agent else { return by };
    let end = physics.bodies[body].translation();
    let start = state.agent.position;
    [end.x - start[0], end.y - start[1]]
}

/// Whether the agent's path may lead to a pushed body.
fn may_meet_agent(sim: SimRef, body: &Pushed, by: [f32; 2]) -> bool {
    let reach = (by[0] * by[0] + by[1] * by[1]).sqrt() + sim.world.agent_params.agent_width as f32 / 2.0;
    let [x, y] = sim.state.offset_to(body.object);
    (x * x + y * y).sqrt() < reach + sim.body_radius(body.object) + MARGIN
}

/// Stops all pushed bodies except these; `indices` must be sorted.
fn stop_all_but(pushed: &mut [Pushed], indices: &[usize]) {
    for (index, body) in pushed.iter_mut().enumerate() {
        if indices.binary_search(&index).is_err() {
            body.stop();
        }
    }
}

fn add_active(sim: SimRef, physics: &mut PhysicsWorld, index: usize) -> Active {
    let body = sim.state.pushed[index];
    let [vx, vy] = body.velocity;
    let agent_speed = sim.world.agent_params.max_linear_speed as f32;
    let farthest = (vx * vx + vy * vy).sqrt().max(agent_speed) * MAX_PHYSICS_SECONDS + MARGIN;
    let own = &sim.objects()[body.object];
    let (mass, friction) = sim.world.objects[body.object]
        .pushable
        .map_or((1.0, 0.5), |pushable| (pushable.mass as f32, pushable.friction as f32));
    let (shape, from_ground) = body_shape(&sim.scene().items[body.object]);
    let turn = Vector::new(0.0, 0.0, -own.heading_deg.to_radians());
    let pose = Pose::new(Vector::new(own.position[0], own.position[1], 0.0), turn);
    let handle = physics.bodies.insert(
        RigidBodyBuilder::dynamic()
            .pose(pose)
            .linvel(Vector::new(body.velocity[0], body.velocity[1], 0.0))
            .angvel(Vector::new(0.0, 0.0, -body.spin_deg.to_radians()))
            .enabled_translations(true, true, false)
            .enabled_rotations(false, false, true)
            .ccd_enabled(true)
            // Predicts contacts; otherwise a body would stand still for the rest of the physics step in which it meets a wall.
            .soft_ccd_prediction(farthest)
            .can_sleep(false),
    );
    // Mass and inertia are those of the solid shape; contacts are those of the outline.
    let mut mass_properties = shape.mass_properties(1.0);
    mass_properties.set_mass(mass, true);
    let outline = sim.views.bodies.outline_of(body.object as u32);
    let collider = ColliderBuilder::new(outline.map_or(shape, Outline::upright))
        .mass_properties(mass_properties.transform_by(&from_ground))
        .friction(friction)
        .restitution(0.0)
        .user_data(u128::from(index as u64));
    physics
        .colliders
        .insert_with_parent(collider, handle, &mut physics.bodies);
    Active {
        index,
        handle,
        radius: sim.body_radius(body.object).max(0.05),
        friction,
    }
}

/// Adds walls and static objects around the bodies, in an order that does not depend on the world's history.
fn add_surroundings(sim: SimRef, physics: &mut PhysicsWorld, active: &[Active], seconds: f32) {
    let mut around: Vec<(u64, ColliderHandle)> = Vec::new();
    // Both the indices among the pushed bodies and their objects are sorted.
    let moves = |object: u32| {
        let own = |body: &Active| sim.state.pushed[body.index].object;
        active.binary_search_by_key(&(object as usize), own).is_ok()
    };
    for body in active {
        let at = sim.objects()[sim.state.pushed[body.index].object].position;
        let reach = static_reach(sim, body.index, seconds);
        let area = [at.map(|metres| metres - reach), at.map(|metres| metres + reach)];
        for handle in sim.views.bodies.around(SOLID | WALL, None, area) {
            let body_data = &sim.views.bodies.body_data[slot(handle)];
            if !body_data.object.is_some_and(moves) {
                around.push((body_data.rank, handle));
            }
        }
    }
    around.sort_unstable_by_key(|(rank, _)| *rank);
    around.dedup_by_key(|(rank, _)| *rank);
    for (_, handle) in around {
        let original = &sim.views.bodies.colliders[handle];
        let mut pose = *original.position();
        pose.translation.z = 0.0;
        let outline = &sim.views.bodies.body_data[slot(handle)].outline;
        if outline.is_disc() {
            pose.rotation = Rotation::IDENTITY;
        }
        let collider = ColliderBuilder::new(outline.upright()).position(pose);
        // Everything slides along walls without friction, as the agent does, so motion along them is kept.
        let is_wall = original.collision_groups().memberships == WALL;
        let collider = if is_wall {
            collider
                .friction(0.0)
                .friction_combine_rule(CoefficientCombineRule::Min)
        } else {
            collider
        };
        physics.colliders.insert(collider);
    }
}

/// Adds the agent as a body with its own mass, on its intended path.
fn add_agent(sim: SimRef, physics: &mut PhysicsWorld, by: [f32; 2], seconds: f32) -> (RigidBodyHandle, ColliderHandle) {
    let [x, y] = sim.agent().position;
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(x, y, 0.0))
        .linvel(Vector::new(by[0] / seconds, by[1] / seconds, 0.0))
        .enabled_translations(true, true, false)
        .lock_rotations()
        .ccd_enabled(true)
        .can_sleep(false);
    let body = physics.bodies.insert(body);
    // Its radius includes the skin, at which it touches pushed bodies. Neither they nor walls slow it down by friction.
    let collider = ColliderBuilder::ball((sim.views.bodies.radius + SKIN) as f32)
        .mass(AGENT_MASS)
        .friction(0.0)
        .friction_combine_rule(CoefficientCombineRule::Min)
        .restitution(0.0);
    let collider = physics
        .colliders
        .insert_with_parent(collider, body, &mut physics.bodies);
    (body, collider)
}

fn record_contacts(pushed: &[Pushed], physics: &PhysicsWorld, agent: ColliderHandle, met_objects: &mut Vec<u32>) {
    for pair in physics.narrow_phase.contact_pairs_with(agent) {
        let other = if pair.collider1 == agent {
            pair.collider2
        } else {
            pair.collider1
        };
        let body = &physics.colliders[other];
        // Static objects have no rigid body.
        if body.parent().is_some() && pair.has_any_active_contact() {
            let index = body.user_data as usize;
            met_objects.push(pushed[index].object as u32);
        }
    }
}

/// Copies positions back from the physics. A body that passed through a wall stays where it was, at rest.
fn read_back(
    physics: &PhysicsWorld,
    active: &[Active],
    world: &World,
    state: &mut SimState,
    views: &mut Views,
    encounters: &mut Encounters,
) {
    for body in active {
        let pushed = &mut state.pushed[body.index];
        let object = pushed.object;
        let own = &mut state.objects[object];
        let moved = &physics.bodies[body.handle];
        let (at, turn) = (moved.translation(), moved.rotation());
        let position = [at.x, at.y].map(|metres| metres.clamp(-EDGE, EDGE));
        let [x, y, turn_speed] = [moved.linvel().x, moved.linvel().y, moved.angvel().z];
        let is_finite = (at.x + at.y + x + y + turn_speed).is_finite();
        if !is_finite || crosses_wall(&views.bodies, own.position, position, object as u32) {
            pushed.stop();
            continue;
        }
        pushed.velocity = [x, y];
        pushed.spin_deg = -turn_speed.to_degrees();
        let yaw = 2.0 * libm::atan2f(turn.z, turn.w);
        let heading_deg = wrapped(-yaw.to_degrees());
        // A body at rest keeps its exact position, regardless of the solver's rounding.
        if position != own.position || pushed.moves() {
            encounters.moved.push((object, own.position));
            (own.position, own.heading_deg) = (position, heading_deg);
            views.sync_object(object, &world.objects[object], own);
        }
    }
}

/// Whether the straight path of an object's body between two positions crosses a wall.
fn crosses_wall(bodies: &CollisionWorld, from: [f32; 2], to: [f32; 2], object: u32) -> bool {
    let way = Vector::new(to[0] - from[0], to[1] - from[1], 0.0);
    let ray = Ray::new(Vector::new(from[0], from[1], 0.05), way);
    let own = bodies.handles.get(object as usize).copied().flatten();
    let hit = |query: QueryPipeline| query.cast_ray(&ray, 1.0, false).is_some();
    bodies.queries_except(WALL, own).any(hit)
}

/// Applies friction with the ground, which slows sliding and rotating bodies until they are at rest.
fn apply_friction(physics: &mut PhysicsWorld, active: &[Active]) {
    let seconds = physics.integration_parameters.dt;
    for body in active {
        let moved = &mut physics.bodies[body.handle];
        let loss = body.friction * GRAVITY * seconds;
        let slower = |speed: f32, loss: f32| if speed > loss { (speed - loss) / speed } else { 0.0 };
        let along = moved.linvel();
        moved.set_linvel(along * slower(along.length(), loss), true);
        // A disc that rotates in place loses speed at its rim 4/3 times as fast as it would by sliding.
        let around = moved.angvel();
        moved.set_angvel(around * slower(around.length(), loss * 4.0 / 3.0 / body.radius), true);
    }
}
