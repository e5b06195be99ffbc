//! Finds the parts of a scene that may be visible, and chooses their levels of detail.

use super::view::{NEAR, View};
use crate::assets::Material;
use crate::scene::{ARENA_WALLS, Item, Scene};

/// Maximum error of a simplified mesh that is drawn, in pixels.
const TOLERANCE: f32 = 0.5;

/// An object that may be visible.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visible {
    /// Depth of its nearest point in metres.
    pub(super) nearest: f32,
    pub(super) drawable: Drawable,
}

/// An item of a scene, or a group of its panels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Drawable {
    Item(u32),
    Panels(u32),
}

/// Collects everything that may be visible, in the scene's order; leaves out the arena's own walls if they are computed
/// analytically.
pub(super) fn find(scene: &Scene, view: &View, walls_by_formula: bool, found: &mut Vec<Visible>) {
    found.clear();
    let mut record = |middle: [f32; 3], radius: f32, drawable: Drawable| {
        let middle = view.view_from_world(middle);
        if view.sees(middle, radius) {
            found.push(Visible {
                nearest: middle[2] - radius,
                drawable,
            });
        }
    };
    for (index, item) in scene.items.iter().enumerate() {
        if item.visible {
            let [x, y] = item.position;
            let half = item.asset.height * item.scale / 2.0;
            record(
                [x, y, half],
                item.asset.ball_radius() * item.scale,
                Drawable::Item(index as u32),
            );
        }
    }
    for (index, group) in scene.panels.iter().enumerate() {
        if index >= ARENA_WALLS || !walls_by_formula {
            record(group.middle, group.radius, Drawable::Panels(index as u32));
        }
    }
}

/// Sorts from near to far, so that later objects are mostly hidden.
pub(super) fn sort(found: &mut [Visible]) {
    found.sort_unstable_by(|a, b| a.nearest.total_cmp(&b.nearest).then(a.drawable.cmp(&b.drawable)));
}

/// Like [`sort`], with the arena's own walls last. They are long, so parts of them may be near, but everything else stands in
/// front of them.
pub(super) fn sort_arena_last(found: &mut [Visible]) {
    found.sort_unstable_by(|a, b| {
        let of_arena =
            |visible: &Visible| matches!(visible.drawable, Drawable::Panels(k) if (k as usize) < ARENA_WALLS);
        let by_depth = || a.nearest.total_cmp(&b.nearest);
        of_arena(a)
            .cmp(&of_arena(b))
            .then_with(by_depth)
            .then(a.drawable.cmp(&b.drawable))
    });
}

/// The level of an item's mesh that is fine enough for its distance.
pub(super) fn level<'a>(item: &'a Item, visible: Visible, view: &View) -> &'a [Material] {
    let pixels_per_metre = view.scale * item.scale / visible.nearest.max(NEAR);
    item.asset.level(TOLERANCE / pixels_per_metre)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use driftworld_spec::{Object, WorldDraft};

    #[test]
    fn objects_ahead_are_sorted_near_to_far_and_those_behind_left_out() {
        let objects = [[0.0, 30.0], [0.0, -10.0], [0.0, 10.0]].map(|place| Object::new("cube", place));
        let world = WorldDraft::with_objects(objects.to_vec());
        let scene = Scene::from_world(&world.check().expect("the world is valid"));
        let view = View::new(&Camera::first_person([0.0, 0.0], 0.0, 1.0, 60.0), 84, 84);
        let mut found = Vec::new();
        find(&scene, &view, true, &mut found);
        sort(&mut found);
        let order: Vec<Drawable> = found.iter().map(|visible| visible.drawable).collect();
        assert_eq!(order, [Drawable::Item(2), Drawable::Item(0)]);
        find(&scene, &view, false, &mut found);
        assert!(found.len() > 2, "the arena's walls are drawn as panels");
    }
}
