//! Pushes bodies: rigid bodies on the ground, simulated by rapier.
//!
//! Each time step creates its own physics world from the pushed bodies that may move, their surroundings and the agent; only
//! positions and velocities carry over to the next time step. So a saved world resumes exactly, and a world at rest costs
//! nothing.

use driftworld_spec::World;
use rapier3d::prelude::*;

use super::body_shape::body_shape;
use super::collision_world::{CollisionWorld, EDGE, slot};
use super::encounters::Encounters;
use super::groups::{SOLID, WALL};
use super::neighbours::{MARGIN, standing_reach, with_neighbours};
use super::outline::Outline;
use super::pushed::Pushed;
use super::sim_ref::SimRef;
use super::slide::SKIN;
use super::state::{SimState, wrapped};
use super::views::Views;

/// The agent's mass in kilograms. In each time step it meets the bodies that it pushes with this mass and its speed.
const AGENT_MASS: f32 = 80.0;

/// Maximum duration of a physics step in seconds.
const LONGEST: f32 = 1.0 / 60.0;

/// Minimum number of physics steps in a time step: the first step of a new physics world ignores existing contacts.
const FEWEST_PARTS: u32 = 2;

/// Maximum number of physics steps in a time step: longer time steps use longer physics steps.
const MOST_PARTS: u32 = 60;

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

/// Lets the agent push what is in its way, and lets pushed bodies slide on. Returns the agent's displacement: less than
/// `by` if what it pushes holds it up. Records what it pushed.
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
    let parts = ((seconds / LONGEST).ceil() as u32).clamp(FEWEST_PARTS, MOST_PARTS);
    let chosen = with_neighbours(sim, first.map(|(index, _)| index).collect(), seconds, parts);
    if !chosen.is_whole {
        stop_all_but(&mut state.pushed, &chosen.indices);
    }
    #[cfg(test)]
    (encounters.looked += chosen.looked);
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
            note_contacts(&state.pushed, &physics, collider, &mut encounters.met);
        }
        rub(&mut physics, &active);
        let num_pairs = physics.narrow_phase.contact_pairs().count();
        #[cfg(test)]
        (encounters.looked += num_pairs as u64);
        if num_pairs > chosen.most_pairs {
            // More bodies have met on their paths than allowed: they stop there.
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
    let [x, y] = sim.state.way_to(body.object);
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
    let farthest = (vx * vx + vy * vy).sqrt().max(agent_speed) * LONGEST + MARGIN;
    let own = &sim.objects()[body.object];
    let (mass, friction) = sim.world.objects[body.object]
        .pushable
        .map_or((1.0, 0.5), |pushable| (pushable.mass as f32, pushable.friction as f32));
    let (shape, from_ground) = body_shape(&sim.scene().items[body.object]);
    let turn = Vector::new(0.0, 0.0, -own.heading_deg.to_radians());
    let place = Pose::new(Vector::new(own.position[0], own.position[1], 0.0), turn);
    let handle = physics.bodies.insert(
        RigidBodyBuilder::dynamic()
            .pose(place)
            .linvel(Vector::new(body.velocity[0], body.velocity[1], 0.0))
            .angvel(Vector::new(0.0, 0.0, -body.spin_deg.to_radians()))
            .enabled_translations(true, true, false)
            .enabled_rotations(false, false, true)
            .ccd_enabled(true)
            // Contacts are predicted: otherwise a body would stand still for the rest of the physics step in which it meets a
            // wall.
            .soft_ccd_prediction(farthest)
            .can_sleep(false),
    );
    // Its mass and inertia are those of the solid; its contacts are those of its outline.
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
    // Both are sorted: indices among the pushed bodies, and their objects.
    let moves = |object: u32| {
        let own = |body: &Active| sim.state.pushed[body.index].object;
        active.binary_search_by_key(&(object as usize), own).is_ok()
    };
    for body in active {
        let at = sim.objects()[sim.state.pushed[body.index].object].position;
        let reach = standing_reach(sim, body.index, seconds);
        let area = [at.map(|metres| metres - reach), at.map(|metres| metres + reach)];
        for handle in sim.views.bodies.around(SOLID | WALL, None, area) {
            let standing = &sim.views.bodies.standing[slot(handle)];
            if !standing.object.is_some_and(moves) {
                around.push((standing.rank, handle));
            }
        }
    }
    around.sort_unstable_by_key(|(rank, _)| *rank);
    around.dedup_by_key(|(rank, _)| *rank);
    for (_, handle) in around {
        let standing = &sim.views.bodies.colliders[handle];
        let mut place = *standing.position();
        place.translation.z = 0.0;
        let outline = &sim.views.bodies.standing[slot(handle)].outline;
        if outline.is_disc() {
            place.rotation = Rotation::IDENTITY;
        }
        let collider = ColliderBuilder::new(outline.upright()).position(place);
        // Everything slides along walls without friction, as the agent does: motion along them is kept.
        let is_wall = standing.collision_groups().memberships == WALL;
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
    // Its radius includes the skin, at which it meets pushed bodies.
    // Neither pushed bodies nor walls slow it by friction.
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

fn note_contacts(pushed: &[Pushed], physics: &PhysicsWorld, agent: ColliderHandle, met: &mut Vec<u32>) {
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
            met.push(pushed[index].object as u32);
        }
    }
}

/// Copies positions back from the physics; a body that went through a wall stays where it was, at rest.
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
        let sound = (at.x + at.y + x + y + turn_speed).is_finite();
        if !sound || leads_through(&views.bodies, own.position, position, object as u32) {
            pushed.stop();
            continue;
        }
        pushed.velocity = [x, y];
        pushed.spin_deg = -turn_speed.to_degrees();
        let yaw = 2.0 * libm::atan2f(turn.z, turn.w);
        let heading_deg = wrapped(-yaw.to_degrees());
        // A body at rest keeps its exact position, whatever the solver does.
        if position != own.position || pushed.moves() {
            encounters.moved.push((object, own.position));
            (own.position, own.heading_deg) = (position, heading_deg);
            views.sync_object(object, &world.objects[object], own);
        }
    }
}

/// Whether the straight path of an object's body between two positions crosses a wall.
fn leads_through(bodies: &CollisionWorld, from: [f32; 2], to: [f32; 2], object: u32) -> bool {
    let way = Vector::new(to[0] - from[0], to[1] - from[1], 0.0);
    let ray = Ray::new(Vector::new(from[0], from[1], 0.05), way);
    let own = bodies.handles.get(object as usize).copied().flatten();
    let hit = |query: QueryPipeline| query.cast_ray(&ray, 1.0, false).is_some();
    bodies.queries_but(WALL, own).any(hit)
}

/// Friction with the ground: slows sliding and rotating bodies until they are at rest.
fn rub(physics: &mut PhysicsWorld, active: &[Active]) {
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
