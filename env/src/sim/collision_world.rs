//! [`CollisionWorld`]: the bodies on the ground that the agent collides with, slides along and touches.

use driftworld_spec::World;
use rapier3d::prelude::*;

use super::body_shape::{body_shape, bounding_box, shows_heading};
use super::broad_phase::BroadPhase;
use super::budget::Budget;
use super::footprint::{Footprint, Point};
use super::gap::Gap;
use super::groups::{AGENT, GHOST, SOLID, WALL};
use super::outline::Outline;
use crate::polygon::to_f32;
use crate::prefetch::prefetch;
use crate::scene::{Item, Scene};

/// Boundary for bodies that start outside the arena, in metres from the origin. Documents allow no positions beyond it.
pub(super) const EDGE: f32 = 300.0;

/// All bodies of a world. They are not moved by forces, so there are no physics steps here, only queries about shapes.
pub(crate) struct CollisionWorld {
    pub(super) colliders: ColliderSet,
    /// Positions of colliders, by handle number.
    pub(super) broad_phase: BroadPhase,
    pub(super) engine: Box<Engine>,
    /// For each object, its collider while it is present.
    pub(super) handles: Vec<Option<ColliderHandle>>,
    /// Colliders of carried objects, which are removed from the trees but kept so that they can be put back without allocating.
    pub(super) set_aside: Vec<(u32, ColliderHandle)>,
    /// The agent's own collider, if moving objects may meet it.
    pub(super) agent_handle: Option<ColliderHandle>,
    pub(super) agent: SharedShape,
    /// Half the agent's width.
    pub(super) radius: f64,
    height: f32,
    /// Half the arena's sides.
    pub(super) half: [f32; 2],
    /// Static data of each body, by handle number of its collider.
    pub(super) body_data: Vec<BodyData>,
    /// Footprint of each body up to the agent's height.
    pub(super) low: Vec<Footprint>,
    /// Whole footprint of each body.
    pub(super) whole: Vec<Footprint>,
    pub(super) scratch: Scratch,
}

/// Parts of the engine that queries and removals need as arguments. They stay empty.
#[derive(Default)]
pub(super) struct Engine {
    bodies: RigidBodySet,
    islands: IslandManager,
    soft_bodies: SoftBodySet,
    pub(super) narrow_phase: NarrowPhase,
}

/// Static data of one body, for queries about the ground.
pub(super) struct BodyData {
    /// Its outline before rotation and translation.
    pub(super) outline: Outline,
    /// Its object; `None` for walls and the agent.
    pub(super) object: Option<u32>,
    /// A number that depends only on the world: walls are numbered in order of creation, objects by their index.
    pub(super) rank: u64,
}

/// Buffers reused by each motion.
#[derive(Default)]
pub(super) struct Scratch {
    /// The bodies around a motion, by handle number.
    pub(super) numbers: Vec<u32>,
    pub(super) touched: Vec<Gap>,
    /// The points where the agent's path in this time step starts, bends and ends.
    pub(super) path: Vec<Point>,
    /// The path of an object that moves by itself.
    pub(super) strides: Vec<Point>,
    /// Indices of widened footprints.
    pub(super) indices: Vec<u32>,
    /// The rotated body of an object that moves.
    pub(super) body: Footprint,
    /// Positions at which bodies would overlap a door.
    pub(super) doorway: Footprint,
    /// Footprints widened by that body.
    pub(super) widened: Vec<Footprint>,
}

impl CollisionWorld {
    pub(crate) fn new(world: &World, scene: &Scene) -> Self {
        let agent = &world.agent_params;
        let (radius, height) = (agent.agent_width as f32 / 2.0, agent.agent_height as f32);
        // For everything on the ground this is an upright cylinder: the round ends are below the ground and above the head.
        let capsule = |radius: f32| SharedShape::capsule(Vector::ZERO, Vector::new(0.0, 0.0, height), radius);
        let mut bodies = Self {
            colliders: ColliderSet::new(),
            broad_phase: BroadPhase::default(),
            engine: Box::default(),
            handles: vec![None; scene.items.len()],
            set_aside: Vec::new(),
            agent_handle: None,
            agent: capsule(radius),
            radius: f64::from(radius),
            height,
            half: scene.arena_size().map(|side| side / 2.0),
            body_data: Vec::new(),
            low: Vec::new(),
            whole: Vec::new(),
            scratch: Scratch::default(),
        };
        let edges = world.obstacles().map(<[_]>::len).sum::<usize>();
        let count = 4 + edges + scene.items.len();
        bodies.colliders = ColliderSet::with_capacity(count + 1);
        bodies.body_data.reserve(count);
        bodies.low.reserve(count);
        bodies.whole.reserve(count);
        bodies.add_arena(scene.arena_size());
        for corners in world.obstacles() {
            bodies.add_region(corners);
        }
        for (index, (item, object)) in scene.items.iter().zip(&world.objects).enumerate() {
            bodies.add_object(index as u32, item, object.solid);
        }
        bodies
    }

    /// Prefetches the memory that the next motion reads.
    pub(super) fn prefetch(&self) {
        self.broad_phase.prefetch();
        prefetch(self.low.as_slice());
        prefetch(self.scratch.numbers.as_slice());
        prefetch(self.scratch.path.as_slice());
    }

    /// Adds a body; `heading_deg` rotates its outline.
    pub(super) fn insert(
        &mut self,
        collider: ColliderBuilder,
        group: Group,
        outline: Outline,
        heading_deg: f32,
    ) -> ColliderHandle {
        let number = self.colliders.len() as u32;
        let collider = if group == WALL {
            collider.user_data(u128::from(number))
        } else {
            collider
        };
        let groups = InteractionGroups::new(group, Group::ALL, InteractionTestMode::And);
        let handle = self.colliders.insert(collider.collision_groups(groups));
        let slot = slot(handle);
        let user_data = self.colliders[handle].user_data as u64;
        let body_data = BodyData {
            outline,
            object: (group == SOLID || group == GHOST).then_some(user_data as u32),
            rank: user_data | u64::from(group == WALL) << 32 | u64::from(group == AGENT) << 33,
        };
        // A new handle has the next number or the number of a removed body.
        if let Some(old) = self.body_data.get_mut(slot) {
            *old = body_data;
        } else {
            self.body_data.push(body_data);
            self.low.push(Footprint::default());
            self.whole.push(Footprint::default());
        }
        self.record_position(handle, heading_deg);
        handle
    }

    /// Records a body's current position and heading.
    pub(super) fn record_position(&mut self, handle: ColliderHandle, heading_deg: f32) {
        let collider = &self.colliders[handle];
        let area = bounding_box(collider.shape(), collider.position());
        let slot = slot(handle);
        self.broad_phase
            .put(collider.collision_groups().memberships, slot as u32, area);
        let at = collider.translation();
        let at = [f64::from(at.x), f64::from(at.y)];
        let outline = &self.body_data[slot].outline;
        outline.place_into(heading_deg, at, &mut self.low[slot], &mut self.whole[slot]);
    }

    /// Adds four thick walls around the arena.
    fn add_arena(&mut self, [width, depth]: [f32; 2]) {
        const THICK: f32 = 2.0;
        let (x, y) = (width / 2.0, depth / 2.0);
        for (half, at) in [
            ([THICK, y + 2.0 * THICK], [x + THICK, 0.0]),
            ([THICK, y + 2.0 * THICK], [-x - THICK, 0.0]),
            ([x + 2.0 * THICK, THICK], [0.0, y + THICK]),
            ([x + 2.0 * THICK, THICK], [0.0, -y - THICK]),
        ] {
            let wall = ColliderBuilder::cuboid(half[0], half[1], self.wall_half_height())
                .translation(Vector::new(at[0], at[1], 0.0));
            let outline = Outline::of_whole(Footprint::rectangle(half.map(f64::from)));
            self.insert(wall, WALL, outline, 0.0);
        }
    }

    /// Walls extend above the agent's head and below its feet.
    fn wall_half_height(&self) -> f32 {
        self.height + 1.0
    }

    /// Adds a thin wall along every edge of a polygon. Unlike a triangulation, this works for every polygon.
    fn add_region(&mut self, corners: &[[f64; 2]]) {
        let corners = to_f32(corners);
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
            if length > 0.0 {
                let angle = libm::atan2f(along[1], along[0]);
                let middle = Vector::new(f32::midpoint(from[0], to[0]), f32::midpoint(from[1], to[1]), 0.0);
                let half = [length / 2.0, 0.02];
                let wall = ColliderBuilder::cuboid(half[0], half[1], self.wall_half_height());
                let wall = wall.position(Pose::new(middle, Vector::new(0.0, 0.0, angle)));
                let outline = Outline::of_whole(Footprint::line(f64::from(half[0]), f64::from(half[1])));
                self.insert(wall, WALL, outline, -angle.to_degrees());
            }
        }
    }

    /// Adds an object's body at its item's position.
    pub(super) fn add_object(&mut self, index: u32, item: &Item, solid: bool) {
        let (shape, from_ground) = body_shape(item);
        // Composed by hand, because a product of poses would make the rounding of the height depend on the heading.
        let at = from_ground.translation + Vector::new(item.position[0], item.position[1], 0.0);
        let pose = if shows_heading(&shape) {
            // Headings are clockwise.
            Pose::new(at, Vector::new(0.0, 0.0, -item.heading_deg.to_radians()))
        } else {
            Pose {
                translation: at,
                ..from_ground
            }
        };
        let collider = ColliderBuilder::new(shape).position(pose).user_data(u128::from(index));
        let group = if solid { SOLID } else { GHOST };
        let outline = Outline::of(&item.body.collider, item.scale, self.height);
        let handle = self.insert(collider, group, outline, item.heading_deg);
        if self.handles.len() <= index as usize {
            self.handles.resize(index as usize + 1, None);
        }
        self.handles[index as usize] = Some(handle);
    }

    /// Moves a body to a position and a heading in degrees.
    pub(super) fn put(&mut self, handle: ColliderHandle, at: [f32; 2], heading_deg: f32) {
        let collider = &self.colliders[handle];
        let mut pose = *collider.position();
        if shows_heading(collider.shared_shape()) {
            pose = Pose::new(pose.translation, Vector::new(0.0, 0.0, -heading_deg.to_radians()));
        }
        (pose.translation.x, pose.translation.y) = (at[0], at[1]);
        self.colliders[handle].set_position(pose);
        self.record_position(handle, heading_deg);
    }

    /// Removes an object's body.
    pub(super) fn remove(&mut self, index: u32) {
        if let Some(handle) = self.handles[index as usize].take() {
            let group = self.colliders[handle].collision_groups().memberships;
            self.colliders.remove(
                handle,
                &mut self.engine.islands,
                &mut self.engine.bodies,
                &mut self.engine.soft_bodies,
                false,
            );
            self.broad_phase.remove(group, slot(handle) as u32);
        }
    }

    /// Queries about bodies of these groups, except one body; one query for each tree that contains such bodies.
    pub(super) fn queries_except(
        &self,
        groups: Group,
        except: Option<ColliderHandle>,
    ) -> impl Iterator<Item = QueryPipeline<'_>> {
        let interaction = InteractionGroups::new(Group::ALL, groups, InteractionTestMode::And);
        let mut filter = QueryFilter::default().groups(interaction);
        filter.exclude_collider = except;
        self.broad_phase.of(groups).map(move |bvh| QueryPipeline {
            dispatcher: self.engine.narrow_phase.query_dispatcher(),
            bvh,
            bodies: &self.engine.bodies,
            colliders: &self.colliders,
            filter,
        })
    }

    /// The bodies of these groups, except one, whose bounding boxes intersect a rectangle on the ground.
    pub(super) fn around(
        &self,
        groups: Group,
        except: Option<ColliderHandle>,
        area: [[f32; 2]; 2],
    ) -> impl Iterator<Item = ColliderHandle> {
        let interaction = InteractionGroups::new(Group::ALL, groups, InteractionTestMode::And);
        let numbers = self.broad_phase.around(groups, area);
        numbers.filter_map(move |number| {
            let (collider, handle) = self.colliders.get_unknown_gen(number)?;
            let matches = collider.collision_groups().test(interaction) && Some(handle) != except;
            matches.then_some(handle)
        })
    }

    /// Collects in `scratch.numbers` the bodies of these groups, except one, around the path from one position to another, and
    /// returns their total number of corners.
    ///
    /// `None`, with an incomplete list, if there are more bodies than queries in the budget; each body takes one query.
    pub(super) fn gather(
        &mut self,
        groups: Group,
        except: Option<ColliderHandle>,
        [from, to]: [Point; 2],
        reach: f64,
        budget: &mut Budget,
    ) -> Option<usize> {
        let mut numbers = std::mem::take(&mut self.scratch.numbers);
        numbers.clear();
        // Enough capacity for most paths, so that steps do not allocate.
        numbers.reserve(64);
        self.scratch.touched.reserve(16);
        self.scratch.path.reserve(64);
        self.scratch.strides.reserve(64);
        self.scratch.indices.reserve(64);
        let low = [0, 1].map(|axis| (from[axis].min(to[axis]) - reach) as f32);
        let high = [0, 1].map(|axis| (from[axis].max(to[axis]) + reach) as f32);
        // One body more than the budget is enough to know that there are too many, in whichever order the tree lists them.
        let max_bodies = usize::try_from(budget.left()).unwrap_or(usize::MAX).saturating_add(1);
        let around = self.around(groups, except, [low, high]).take(max_bodies);
        numbers.extend(around.map(|handle| slot(handle) as u32));
        let is_complete = budget.take(numbers.len());
        if is_complete {
            // The tree's order depends on its history, which a saved world does not contain.
            numbers.sort_unstable_by_key(|number| self.body_data[*number as usize].rank);
        }
        let corners = || numbers.iter().map(|number| self.whole[*number as usize].corners.len());
        let num_corners = is_complete.then(|| corners().sum());
        self.scratch.numbers = numbers;
        num_corners
    }

    /// The outline of an object while it is present.
    pub(super) fn outline_of(&self, object: u32) -> Option<&Outline> {
        self.handles[object as usize].map(|handle| &self.body_data[slot(handle)].outline)
    }

    /// The points where the agent's path in this time step starts, bends and ends.
    pub(super) fn path(&self) -> &[Point] {
        &self.scratch.path
    }

    /// The agent's position at the start of this time step.
    pub(super) fn path_start(&self) -> [f32; 2] {
        let start = self.scratch.path.first().copied().unwrap_or_default();
        start.map(|metres| metres as f32)
    }

    /// The solid objects that the agent's body would overlap at a position, in order of index.
    pub(crate) fn blocking(&self, at: [f32; 2], found: &mut Vec<u32>) {
        found.clear();
        let radius = self.radius as f32;
        let area = [at.map(|metres| metres - radius), at.map(|metres| metres + radius)];
        for handle in self.around(SOLID, None, area) {
            let slot = slot(handle);
            let inside = self.low[slot].gap(at.map(f64::from)).distance < self.radius;
            found.extend(self.body_data[slot].object.filter(|_| inside));
        }
        found.sort_unstable();
    }

    /// Finds the objects in the 1 m cube directly in front of the agent, in order of index.
    pub(crate) fn in_reach(&self, at: [f32; 2], forward: [f32; 2], found: &mut Vec<u32>) {
        found.clear();
        let cube = Cuboid::new(Vector::new(0.5, 0.5, 0.5));
        let ahead = self.radius as f32 + 0.5;
        let centre = Vector::new(at[0] + forward[0] * ahead, at[1] + forward[1] * ahead, 0.5);
        let pose = Pose::new(centre, Vector::new(0.0, 0.0, libm::atan2f(forward[1], forward[0])));
        for query in self.queries_except(SOLID | GHOST, None) {
            found.extend(
                query
                    .intersect_shape(pose, &cube)
                    .map(|(_, collider)| collider.user_data as u32),
            );
        }
        found.sort_unstable();
    }
}

/// The number of a handle; numbers of removed colliders are reused.
pub(super) fn slot(handle: ColliderHandle) -> usize {
    handle.into_raw_parts().0 as usize
}
