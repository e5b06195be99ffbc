//! The first thing that a moving shape meets. Who asks is `body.rs` and `moving_body.rs`.
//!
//! The engine's own search looks at bodies in the order of its tree, and where two are met at nearly the same time the order
//! decides. That order depends on the tree's past, which a world that was written down does not have: so here all that may be
//! met is cast against, and ties go to the body with the lowest number.

use rapier3d::parry::query::ShapeCastOptions;
use rapier3d::prelude::*;

use super::body::{Ground, SKIN, WALL};

/// What a moving shape met.
pub(super) struct Hit {
    pub(super) collider: ColliderHandle,
    /// Share of the way to it, 0..1.
    pub(super) share: f32,
    /// Its normal in the plane, of length 1, against the motion if the engine has none.
    pub(super) normal: Vector,
}

impl Ground {
    /// The first body of these groups, one left aside, that a shape meets on its way; it stops the skin's width before.
    pub(super) fn first_met(
        &self,
        groups: Group,
        but: Option<ColliderHandle>,
        shape: &dyn Shape,
        pose: &Pose,
        by: Vector,
    ) -> Option<Hit> {
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            target_distance: SKIN,
            stop_at_penetration: false,
            compute_impact_geometry_on_penetration: true,
        };
        let end = Pose {
            translation: pose.translation + by,
            ..*pose
        };
        let area = shape.compute_swept_aabb(pose, &end).loosened(2.0 * SKIN);
        let dispatcher = self.narrow_phase.query_dispatcher();
        let mut first: Option<(f32, u128, ColliderHandle, Vector)> = None;
        for (handle, collider) in self.query_but(groups, but).intersect_aabb_conservative(area) {
            let own = collider.position();
            let cast = dispatcher.cast_shapes(
                &own.inv_mul(pose),
                own.rotation.inverse() * by,
                collider.shape(),
                shape,
                options,
            );
            let Ok(Some(hit)) = cast else { continue };
            let key = rank(collider);
            let time = hit.time_of_impact;
            if first.is_none_or(|(best, other, ..)| time < best || (time == best && key < other)) {
                first = Some((time, key, handle, own.rotation * hit.normal1));
            }
        }
        let (time, _, collider, normal) = first?;
        let normal = Vector::new(normal.x, normal.y, 0.0).normalize_or_zero();
        Some(Hit {
            collider,
            share: time.clamp(0.0, 1.0),
            normal: if normal == Vector::ZERO {
                -by.normalize_or_zero()
            } else {
                normal
            },
        })
    }
}

/// A number for each body that depends on the world alone: walls are told apart by the number that they were given, objects by
/// theirs.
pub(super) fn rank(collider: &Collider) -> u128 {
    let wall = collider.collision_groups().memberships == WALL;
    collider.user_data | u128::from(wall) << 64
}
