//! Bodies on the ground: what the agent bumps into, slides along and touches. What a touch is worth is in `environment.rs`.

use driftworld_spec::World;
use rapier3d::parry::partitioning::Bvh;
use rapier3d::parry::query::{ClosestPoints, closest_points};
use rapier3d::prelude::*;

use super::casting::{Hit, rank};
use crate::assets::ColliderShape;
use crate::scene::{Item, Scene};

/// Distance that the agent keeps from what it slides along, in metres.
pub(super) const SKIN: f32 = 0.01;

/// Distance at which a touch counts, in metres: a little more than the skin.
const TOUCH: f32 = 0.03;

/// Where the world ends for what starts outside the arena, in metres from the origin: a document knows no place beyond.
pub(super) const EDGE: f32 = 300.0;

/// Longest way that is cast at once, in metres.
const STRETCH: f32 = 1.0;

/// How often a stretch's motion is turned aside before it ends.
const SLIDES: usize = 5;

/// Bodies that stop the agent.
pub(super) const SOLID: Group = Group::GROUP_1;
/// Bodies that it passes through.
const GHOST: Group = Group::GROUP_2;
/// Walls: they stop it, and are nobody's object.
pub(super) const WALL: Group = Group::GROUP_3;

/// The agent, as objects that move meet it.
pub(super) const AGENT: Group = Group::GROUP_4;

/// All bodies of a world. Nothing moves by forces, so there is no time step here: only questions about shapes.
pub(crate) struct Ground {
    bodies: RigidBodySet,
    pub(super) colliders: ColliderSet,
    /// Where colliders are, by the numbers of their handles. The engine's own broad phase, made for its step, lost bodies that
    /// were taken away and put back many times without one.
    tree: Bvh,
    pub(super) narrow_phase: NarrowPhase,
    islands: IslandManager,
    soft_bodies: SoftBodySet,
    /// For each object, its collider while it is there.
    pub(super) handles: Vec<Option<ColliderHandle>>,
    /// The agent's own collider, where objects move and may meet it.
    pub(super) agent_handle: Option<ColliderHandle>,
    pub(super) agent: SharedShape,
    /// The agent's body without its radius: what is pushed out of things.
    axis: Segment,
    touch: SharedShape,
    radius: f32,
    height: f32,
    /// Half the arena's sides.
    pub(super) half: [f32; 2],
}

/// A motion on its way.
struct Motion<'a> {
    /// Where it has come to.
    position: [f32; 2],
    /// Objects that were met on the way, each once, by index.
    met: &'a mut Vec<u32>,
}

impl Ground {
    pub(crate) fn new(world: &World, scene: &Scene) -> Self {
        let agent = &world.agent_params;
        let (radius, height) = (agent.agent_width as f32 / 2.0, agent.agent_height as f32);
        // An upright cylinder for all that stands on the ground: the round ends lie below it and above the head.
        let capsule = |radius: f32| SharedShape::capsule(Vector::ZERO, Vector::new(0.0, 0.0, height), radius);
        let mut ground = Self {
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            tree: Bvh::new(),
            narrow_phase: NarrowPhase::new(),
            islands: IslandManager::new(),
            soft_bodies: SoftBodySet::new(),
            handles: vec![None; scene.items.len()],
            agent_handle: None,
            agent: capsule(radius),
            axis: Segment::new(Vector::ZERO, Vector::new(0.0, 0.0, height)),
            touch: capsule(radius + TOUCH),
            radius,
            height,
            half: scene.arena_size().map(|side| side / 2.0),
        };
        ground.add_arena(scene.arena_size());
        let environment = &world.environment_params;
        for region in environment.regions() {
            ground.add_region(region);
        }
        for wall in &environment.walls {
            ground.add_region(&wall.polygon);
        }
        for (index, (item, object)) in scene.items.iter().zip(&world.objects).enumerate() {
            ground.add_object(index as u32, item, object.solid);
        }
        ground
    }

    pub(super) fn insert(&mut self, collider: ColliderBuilder, group: Group) -> ColliderHandle {
        let collider = if group == WALL {
            let number = self.colliders.len() as u128;
            collider.user_data(number)
        } else {
            collider
        };
        let groups = InteractionGroups::new(group, Group::ALL, InteractionTestMode::And);
        let handle = self.colliders.insert(collider.collision_groups(groups));
        self.note_place(handle);
        handle
    }

    /// Notes where a collider is now.
    pub(super) fn note_place(&mut self, handle: ColliderHandle) {
        let area = self.colliders[handle].compute_aabb();
        self.tree.insert(area, handle.into_raw_parts().0);
    }

    /// Four thick walls around the arena.
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
            self.insert(wall, WALL);
        }
    }

    /// Walls are endless to the agent: higher than it, and deeper than its feet.
    fn wall_half_height(&self) -> f32 {
        self.height + 1.0
    }

    /// A thin wall along every edge of a polygon: no triangulation that a strange polygon could break.
    fn add_region(&mut self, corners: &[[f64; 2]]) {
        let corners: Vec<[f32; 2]> = corners
            .iter()
            .map(|corner| corner.map(|metres| metres as f32))
            .collect();
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
            if length > 0.0 {
                let angle = libm::atan2f(along[1], along[0]);
                let middle = Vector::new(f32::midpoint(from[0], to[0]), f32::midpoint(from[1], to[1]), 0.0);
                let wall = ColliderBuilder::cuboid(length / 2.0, 0.02, self.wall_half_height());
                self.insert(wall.position(Pose::new(middle, Vector::new(0.0, 0.0, angle))), WALL);
            }
        }
    }

    /// The shape of an object's body, and where it is in the object's frame: on the ground, facing +y.
    pub(super) fn shape(item: &Item) -> (SharedShape, Pose) {
        let scale = item.scale;
        let least = |metres: f32| (metres * scale).max(0.005);
        let (shape, height, tilt) = match &item.asset.collider {
            ColliderShape::Box { half } => {
                let [x, y, z] = half.map(least);
                (SharedShape::cuboid(x, y, z), z, 0.0)
            }
            ColliderShape::Ball { radius } => (SharedShape::ball(least(*radius)), least(*radius), 0.0),
            ColliderShape::Cylinder { radius, half_height } => {
                // The engine's cylinders lie along y.
                let (radius, half) = (least(*radius), least(*half_height));
                (SharedShape::cylinder(half, radius), half, std::f32::consts::FRAC_PI_2)
            }
            ColliderShape::Capsule { radius, half_height } => {
                let (radius, half) = (least(*radius), (half_height * scale).max(0.0));
                (SharedShape::capsule_z(half, radius), half + radius, 0.0)
            }
            ColliderShape::Hull { points } => {
                let corners: Vec<Vector> = points
                    .iter()
                    .map(|point| Vector::new(point[0], point[1], point[2]) * scale)
                    .collect();
                if let Some(shape) = SharedShape::convex_hull(&corners) {
                    (shape, 0.0, 0.0)
                } else {
                    // Points in one plane hold nothing: the cylinder around them.
                    let (radius, half) = (least(item.asset.collider.radius()), least(item.asset.height / 2.0));
                    (SharedShape::cylinder(half, radius), half, std::f32::consts::FRAC_PI_2)
                }
            }
        };
        let from_ground = Pose::new(Vector::new(0.0, 0.0, height), Vector::new(tilt, 0.0, 0.0));
        (shape, from_ground)
    }

    /// Puts an object's body where its item stands.
    pub(crate) fn add_object(&mut self, index: u32, item: &Item, solid: bool) {
        let (shape, from_ground) = Self::shape(item);
        // Put together by hand: a product of poses would round the height in a way that depends on the heading.
        let at = from_ground.translation + Vector::new(item.position[0], item.position[1], 0.0);
        let pose = if shows_heading(&shape) {
            // Headings turn clockwise.
            Pose::new(at, Vector::new(0.0, 0.0, -item.heading_deg.to_radians()))
        } else {
            Pose {
                translation: at,
                ..from_ground
            }
        };
        let collider = ColliderBuilder::new(shape).position(pose).user_data(u128::from(index));
        let handle = self.insert(collider, if solid { SOLID } else { GHOST });
        if self.handles.len() <= index as usize {
            self.handles.resize(index as usize + 1, None);
        }
        self.handles[index as usize] = Some(handle);
    }

    /// Takes an object away.
    pub(crate) fn remove(&mut self, index: u32) {
        if let Some(handle) = self.handles[index as usize].take() {
            self.colliders.remove(
                handle,
                &mut self.islands,
                &mut self.bodies,
                &mut self.soft_bodies,
                false,
            );
            self.tree.remove(handle.into_raw_parts().0);
        }
    }

    /// Whether the straight way of an object's body between two places leads through something solid.
    pub(super) fn leads_through(&self, from: [f32; 2], to: [f32; 2], object: u32) -> bool {
        let way = Vector::new(to[0] - from[0], to[1] - from[1], 0.0);
        let ray = Ray::new(Vector::new(from[0], from[1], 0.05), way);
        let own = self.handles.get(object as usize).copied().flatten();
        self.query_but(WALL, own).cast_ray(&ray, 1.0, false).is_some()
    }

    fn query(&self, groups: Group) -> QueryPipeline<'_> {
        self.query_but(groups, None)
    }

    /// Questions about bodies of these groups, one body left aside.
    pub(super) fn query_but(&self, groups: Group, but: Option<ColliderHandle>) -> QueryPipeline<'_> {
        let groups = InteractionGroups::new(Group::ALL, groups, InteractionTestMode::And);
        let mut filter = QueryFilter::default().groups(groups);
        filter.exclude_collider = but;
        QueryPipeline {
            dispatcher: self.narrow_phase.query_dispatcher(),
            bvh: &self.tree,
            bodies: &self.bodies,
            colliders: &self.colliders,
            filter,
        }
    }

    /// Moves the agent's body as far as solid things let it, sliding along them.
    ///
    /// Hands back where it comes to, and notes the objects that it met on the way, each once.
    ///
    /// The motion is a cast of the whole shape, so nothing is passed through at any speed; long ways are walked in
    /// stretches, because the engine's casts lose precision with length.
    pub(crate) fn slide(&self, from: [f32; 2], by: [f32; 2], met: &mut Vec<u32>) -> [f32; 2] {
        let mut motion = Motion { position: from, met };
        let way = Vector::new(by[0], by[1], 0.0);
        let stretches = (way.length() / STRETCH).ceil().max(1.0);
        for _ in 0..stretches as u32 {
            let before = motion.position;
            self.slide_stretch(way / stretches, &mut motion);
            if motion.position == before {
                break;
            }
        }
        motion.position
    }

    fn slide_stretch(&self, mut left: Vector, motion: &mut Motion<'_>) {
        let mut last_normal: Option<Vector> = None;
        for _ in 0..SLIDES {
            if left.length() < 1e-6 {
                break;
            }
            let start = motion.position;
            let hit = self.first_hit(start, left);
            let share = hit.as_ref().map_or(1.0, |hit| hit.share);
            let end = self.kept_clear(start, [start[0] + left.x * share, start[1] + left.y * share]);
            if self.is_crossed(start, end) {
                break;
            }
            motion.position = end;
            self.pass_ghosts(start, motion.position, motion.met);
            let Some(Hit { collider, normal, .. }) = hit else { break };
            if let Some(index) = self.object_of(collider) {
                note(motion.met, index);
            }
            left *= 1.0 - share;
            left -= normal * left.dot(normal).min(0.0);
            // In a corner the way along one wall leads into the other: there is no way on.
            if let Some(last) = last_normal
                && left.dot(last) < 0.0
            {
                left -= last * left.dot(last);
                if left.dot(normal) < 0.0 {
                    break;
                }
            }
            last_normal = Some(normal);
        }
    }

    /// Whether the straight way between two places leads through the surface of something solid. A cast that missed, by
    /// rounding, what it should have met ends here: the body's middle never changes sides.
    fn is_crossed(&self, from: [f32; 2], to: [f32; 2]) -> bool {
        let way = Vector::new(to[0] - from[0], to[1] - from[1], 0.0);
        let ray = Ray::new(Vector::new(from[0], from[1], self.height / 2.0), way);
        let outside = |_: ColliderHandle, body: &Collider| {
            object_of(body).is_none() || !body.shape().contains_point(body.position(), ray.origin)
        };
        let mut query = self.query(SOLID | WALL);
        query.filter.predicate = Some(&outside);
        query.cast_ray(&ray, 1.0, false).is_some()
    }

    /// A place moved out of what it touches by the rounding of casts, and back into the arena that it came from.
    fn kept_clear(&self, from: [f32; 2], at: [f32; 2]) -> [f32; 2] {
        let mut place = at;
        for _ in 0..3 {
            let Some(push) = self.deepest_push(place) else { break };
            (place[0], place[1]) = (place[0] + push.x, place[1] + push.y);
        }
        for axis in 0..2 {
            let inside = self.half[axis] - self.radius - SKIN;
            if from[axis].abs() <= inside + SKIN && inside > 0.0 {
                place[axis] = place[axis].clamp(-inside, inside);
            }
            place[axis] = place[axis].clamp(-EDGE, EDGE);
        }
        place
    }

    /// The way out of the solid thing that is nearest, if one is nearer than the skin.
    fn deepest_push(&self, at: [f32; 2]) -> Option<Vector> {
        let reach = Ball::new(self.radius + SKIN);
        let solid = self.query(SOLID | WALL);
        let mut worst: Option<(f32, u128, Vector)> = None;
        // The slice at the height of the body's middle decides: all shapes stand upright.
        let middle = Pose::from_translation(Vector::new(at[0], at[1], self.height / 2.0));
        for (_, collider) in solid.intersect_shape(middle, &reach) {
            let Some((distance, normal)) = self.separation(at, collider) else {
                continue;
            };
            let key = rank(collider);
            let deeper = |least: f32, other: u128| distance < least || (distance == least && key < other);
            if distance < SKIN * 0.9 && worst.is_none_or(|(least, other, _)| deeper(least, other)) {
                worst = Some((distance, key, normal * (SKIN - distance).min(0.5)));
            }
        }
        worst.map(|(_, _, push)| push)
    }

    /// How far the agent's body is from another, below 0 if they overlap, and the way out in the plane, of length 1; nothing if
    /// they are farther apart than the skin.
    ///
    /// The engine's contacts would take memory from the heap for shapes that overlap. The axis of the body hardly ever does; if
    /// it does, the way out is that from the middle of the other.
    fn separation(&self, at: [f32; 2], collider: &Collider) -> Option<(f32, Vector)> {
        let pose = Pose::from_translation(Vector::new(at[0], at[1], 0.0));
        let (other, reach) = (collider.position(), self.radius + SKIN);
        let (apart, way) = match closest_points(&pose, &self.axis, other, collider.shape(), reach).ok()? {
            ClosestPoints::Disjoint => return None,
            // In a wall there is no way out that could not be the wrong side.
            ClosestPoints::Intersecting if object_of(collider).is_none() => return None,
            ClosestPoints::Intersecting => (0.0, pose.translation - other.translation),
            ClosestPoints::WithinMargin(own, others) => {
                let way = pose * own - *other * others;
                (way.length(), way)
            }
        };
        Some((apart - self.radius, Vector::new(way.x, way.y, 0.0).normalize_or_zero()))
    }

    /// The first solid thing on the agent's way.
    fn first_hit(&self, from: [f32; 2], by: Vector) -> Option<Hit> {
        let pose = Pose::from_translation(Vector::new(from[0], from[1], 0.0));
        self.first_met(SOLID | WALL, None, &*self.agent, &pose, by)
    }

    /// Notes the objects without substance that a stretch of the way leads through.
    fn pass_ghosts(&self, from: [f32; 2], to: [f32; 2], met: &mut Vec<u32>) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        let samples = (length / self.radius.max(0.05)).ceil().clamp(1.0, 10_000.0) as u32;
        let query = self.query(GHOST);
        for k in 1..=samples {
            let share = k as f32 / samples as f32;
            let at = Vector::new(from[0] + along[0] * share, from[1] + along[1] * share, 0.0);
            for (_, collider) in query.intersect_shape(Pose::from_translation(at), &*self.agent) {
                note(met, collider.user_data as u32);
            }
        }
    }

    fn object_of(&self, handle: ColliderHandle) -> Option<u32> {
        object_of(&self.colliders[handle])
    }

    /// The objects that the agent's body touches, by index in rising order.
    pub(crate) fn touching(&self, at: [f32; 2], touched: &mut Vec<u32>) {
        touched.clear();
        let pose = Pose::from_translation(Vector::new(at[0], at[1], 0.0));
        let query = self.query(SOLID | GHOST);
        touched.extend(
            query
                .intersect_shape(pose, &*self.touch)
                .map(|(_, collider)| collider.user_data as u32),
        );
        touched.sort_unstable();
    }

    /// The solid objects that the agent's body would be inside of at a place, by index in rising order.
    pub(crate) fn blocking(&self, at: [f32; 2], found: &mut Vec<u32>) {
        found.clear();
        let pose = Pose::from_translation(Vector::new(at[0], at[1], 0.0));
        let query = self.query(SOLID);
        let inside = query.intersect_shape(pose, &*self.agent);
        found.extend(inside.map(|(_, collider)| collider.user_data as u32));
        found.sort_unstable();
    }

    /// Finds the objects in the 1 m cube right in front of the agent, by index in rising order.
    pub(crate) fn in_reach(&self, at: [f32; 2], forward: [f32; 2], found: &mut Vec<u32>) {
        found.clear();
        let cube = Cuboid::new(Vector::new(0.5, 0.5, 0.5));
        let ahead = self.radius + 0.5;
        let centre = Vector::new(at[0] + forward[0] * ahead, at[1] + forward[1] * ahead, 0.5);
        let pose = Pose::new(centre, Vector::new(0.0, 0.0, libm::atan2f(forward[1], forward[0])));
        let query = self.query(SOLID | GHOST);
        found.extend(
            query
                .intersect_shape(pose, &cube)
                .map(|(_, collider)| collider.user_data as u32),
        );
        found.sort_unstable();
    }
}

/// The object whose body this is; walls are nobody's.
fn object_of(collider: &Collider) -> Option<u32> {
    (collider.collision_groups().memberships != WALL).then_some(collider.user_data as u32)
}

/// Whether a body shows where it faces: round ones do not.
pub(super) fn shows_heading(shape: &SharedShape) -> bool {
    matches!(shape.shape_type(), ShapeType::Cuboid | ShapeType::ConvexPolyhedron)
}

fn note(met: &mut Vec<u32>, index: u32) {
    if !met.contains(&index) {
        met.push(index);
    }
}
