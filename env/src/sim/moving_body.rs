//! Bodies of objects that move: how far one comes before it meets something, and putting one back. Where it wants to go is
//! decided in `motion.rs`, what the agent bumps into is in `body.rs`.

use rapier3d::parry::query::ShapeCastOptions;
use rapier3d::prelude::*;

use super::body::{AGENT, Ground, SKIN, SOLID, WALL};

impl Ground {
    /// Tells the objects where the agent is: they stop in front of it.
    pub(crate) fn place_agent(&mut self, at: [f32; 2]) {
        let shape = self.agent.clone();
        let handle = match self.agent_handle {
            Some(handle) => handle,
            None => self.insert(ColliderBuilder::new(shape), AGENT),
        };
        self.agent_handle = Some(handle);
        self.put(handle, Pose::from_translation(Vector::new(at[0], at[1], 0.0)));
    }

    fn put(&mut self, handle: ColliderHandle, pose: Pose) {
        self.colliders[handle].set_position(pose);
        let aabb = self.colliders[handle].compute_aabb();
        self.broad_phase
            .set_aabb(&IntegrationParameters::default(), handle, aabb);
    }

    /// Turns an object's body to a heading in degrees and moves it towards where it means to go; it stops at walls, solid
    /// objects and the agent, and slides along them once. Hands back how far it came; nothing for an object that is not there.
    pub(crate) fn push(&mut self, index: u32, by: [f32; 2], heading_deg: f32) -> [f32; 2] {
        let Some(handle) = self.handles[index as usize] else {
            return [0.0; 2];
        };
        let collider = &self.colliders[handle];
        let shape = collider.shared_shape().clone();
        let mut pose = *collider.position();
        // Only boxes show where they face.
        if collider.shape().as_cuboid().is_some() {
            pose = Pose::new(pose.translation, Vector::new(0.0, 0.0, -heading_deg.to_radians()));
        }
        let start = pose.translation;
        let mut left = Vector::new(by[0], by[1], 0.0);
        for _ in 0..2 {
            if left.length() < 1e-5 {
                break;
            }
            let Some((share, normal)) = self.obstacle(handle, pose, left, &shape) else {
                pose.translation += left;
                break;
            };
            pose.translation += left * share;
            left *= 1.0 - share;
            left -= normal * left.dot(normal).min(0.0);
        }
        let came = pose.translation - start;
        self.put(handle, pose);
        [came.x, came.y]
    }

    /// The first thing on the way of an object's body: the share of the way to it, and its normal in the plane.
    fn obstacle(&self, own: ColliderHandle, pose: Pose, by: Vector, shape: &SharedShape) -> Option<(f32, Vector)> {
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            target_distance: SKIN,
            stop_at_penetration: false,
            compute_impact_geometry_on_penetration: true,
        };
        let query = self.query_but(SOLID | WALL | AGENT, Some(own));
        let (_, hit) = query.cast_shape(&pose, by, &**shape, options)?;
        let normal = Vector::new(hit.normal1.x, hit.normal1.y, 0.0).normalize_or_zero();
        let normal = if normal == Vector::ZERO {
            -by.normalize_or_zero()
        } else {
            normal
        };
        Some((hit.time_of_impact.clamp(0.0, 1.0), normal))
    }

    /// Whether an object's body, taken away before, would stand free at a place.
    pub(crate) fn is_free(&self, at: [f32; 2], radius: f32) -> bool {
        let [x, y] = [0, 1].map(|axis| self.half[axis] - radius - SKIN - at[axis].abs());
        if x < 0.0 || y < 0.0 {
            return false;
        }
        let ball = SharedShape::ball(radius.max(0.05));
        let pose = Pose::from_translation(Vector::new(at[0], at[1], radius.max(0.05) + 0.01));
        self.query_but(SOLID | WALL | AGENT, None)
            .intersect_shape(pose, &*ball)
            .next()
            .is_none()
    }
}
