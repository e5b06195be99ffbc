//! Culls objects hidden by walls. Records the nearest wall in each column of an image; objects behind it that are not higher
//! need not be drawn.

use super::view::{NEAR, View};
use crate::scene::{Item, PanelGroup};

/// Tolerances for rounding: in columns, and as a fraction of a depth.
const COLUMN_TOLERANCE: f32 = 0.01;
const DEPTH_TOLERANCE: f32 = 1e-3;

/// The drawn walls by column. Used only for cameras that look straight ahead from a height between the ground and the tops of
/// walls, because there a wall fills its columns from the ground to above the horizon.
#[derive(Clone, Debug, Default)]
pub(super) struct Hidden {
    /// 1 / depth of the nearest wall of each column; 0 without one.
    inverse: Vec<f32>,
    /// Minimum height of all recorded walls, in metres.
    height: Option<f32>,
    is_usable: bool,
    /// Disables culling, so that everything is drawn.
    pub(super) is_disabled: bool,
}

impl Hidden {
    /// Clears the recorded walls.
    pub(super) fn clear(&mut self, view: &View) {
        self.inverse.clear();
        self.inverse.resize(view.size[0] as usize, 0.0);
        self.height = None;
        self.is_usable =
            !self.is_disabled && view.axes.forward[2] == 0.0 && view.axes.right[2] == 0.0 && view.position[2] > 0.0;
    }

    /// Records walls that were drawn.
    pub(super) fn record(&mut self, group: &PanelGroup, view: &View) {
        let is_high_enough = match self.height {
            Some(height) => group.height >= height,
            None => group.height > view.position[2] * (1.0 + DEPTH_TOLERANCE),
        };
        if !self.is_usable || !is_high_enough {
            return;
        }
        for [from, to] in &group.edges {
            self.record_edge(camera_position(view, *from), camera_position(view, *to), view);
        }
        if !group.edges.is_empty() {
            self.height.get_or_insert(group.height);
        }
    }

    fn record_edge(&mut self, mut from: [f32; 2], mut to: [f32; 2], view: &View) {
        // Walls are visible only from their right-hand side.
        if from[0] * to[1] - from[1] * to[0] >= 0.0 {
            return;
        }
        let min_depth = 2.0 * NEAR;
        if from[1] < min_depth && to[1] < min_depth {
            return;
        }
        let cut = |near: [f32; 2], far: [f32; 2]| {
            let along = (min_depth - near[1]) / (far[1] - near[1]);
            [near[0] + along * (far[0] - near[0]), min_depth]
        };
        if from[1] < min_depth {
            from = cut(from, to);
        } else if to[1] < min_depth {
            to = cut(to, from);
        }
        let [a, b] = [from, to].map(|[right, ahead]| (column(view, right, ahead), 1.0 / ahead));
        let [(left, left_inverse), (right, right_inverse)] = if a.0 < b.0 { [a, b] } else { [b, a] };
        let last = self.inverse.len() as f32 - 1.0;
        let first = (left + COLUMN_TOLERANCE).ceil().max(0.0);
        let last = (right - COLUMN_TOLERANCE).floor().min(last);
        if first > last {
            return;
        }
        let slope = (right_inverse - left_inverse) / (right - left);
        for (step, inverse) in self.inverse[first as usize..=last as usize].iter_mut().enumerate() {
            let here = left_inverse + slope * (first + step as f32 - left);
            *inverse = inverse.max(here);
        }
    }

    /// Whether walls hide all of a group of panels.
    pub(super) fn hides_panels(&self, group: &PanelGroup, view: &View) -> bool {
        if !self.may_hide(group.height) || group.edges.is_empty() {
            return false;
        }
        let (mut columns, mut nearest) = ([f32::INFINITY, f32::NEG_INFINITY], f32::INFINITY);
        // Around a region, each edge begins where another one ends. A wall of the arena is a single edge, so its end is added.
        let last = group.edges.last().map(|[_, to]| to);
        for corner in group.edges.iter().map(|[from, _]| from).chain(last) {
            let [right, ahead] = camera_position(view, *corner);
            if ahead < 2.0 * NEAR {
                return false;
            }
            let at = column(view, right, ahead);
            columns = [columns[0].min(at), columns[1].max(at)];
            nearest = nearest.min(ahead);
        }
        self.hides(columns, nearest)
    }

    /// Whether an item is behind the recorded walls.
    pub(super) fn hides_item(&self, item: &Item, view: &View) -> bool {
        let [x, y] = item.position;
        let top = item.asset.height * item.scale;
        let radius = item.asset.ball_radius() * item.scale;
        self.hides_ball([x, y, top / 2.0], radius, top, view)
    }

    /// Whether walls hide a ball whose contents are no higher than `top`, in metres.
    pub(super) fn hides_ball(&self, middle: [f32; 3], radius: f32, top: f32, view: &View) -> bool {
        if !self.may_hide(top) {
            return false;
        }
        let [right, _, ahead] = view.view_from_world(middle);
        let (nearest, farthest) = (ahead - radius, ahead + radius);
        if nearest < 2.0 * NEAR {
            return false;
        }
        let [left, right] = [right - radius, right + radius];
        let left = column(view, left, if left < 0.0 { nearest } else { farthest });
        let right = column(view, right, if right > 0.0 { nearest } else { farthest });
        self.hides([left, right], nearest)
    }

    fn may_hide(&self, top: f32) -> bool {
        self.height.is_some_and(|height| top <= height)
    }

    fn hides(&self, columns: [f32; 2], nearest: f32) -> bool {
        let last = self.inverse.len() as f32 - 1.0;
        let first = (columns[0] - COLUMN_TOLERANCE).ceil().max(0.0);
        let last = (columns[1] + COLUMN_TOLERANCE).floor().min(last);
        if first > last {
            return true;
        }
        let inverse = (1.0 + DEPTH_TOLERANCE) / nearest;
        let mut walls = self.inverse[first as usize..=last as usize].iter();
        walls.all(|wall| *wall > inverse)
    }
}

/// Position of a point on the ground relative to the camera: metres to the right and ahead.
fn camera_position(view: &View, [x, y]: [f32; 2]) -> [f32; 2] {
    let [right, _, ahead] = view.view_from_world([x, y, 0.0]);
    [right, ahead]
}

fn column(view: &View, right: f32, ahead: f32) -> f32 {
    right / ahead * view.scale + view.size[0] / 2.0 - 0.5
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Layout, Maze, Object, WorldDraft};
    use proptest::prelude::*;

    use crate::camera::Camera;
    use crate::render::{CpuRenderer, Frame};
    use crate::scene::Scene;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

        /// Compares colours, depths and instances bit for bit.
        #[test]
        fn culling_hidden_objects_does_not_change_images(
            (seed, standing, wall) in (0_u64..999, 0.3..=1.0, 0.05..1.5_f64),
            at in prop::array::uniform2(-11.5_f32..11.5),
            (heading, eye, low) in (0.0_f32..360.0, 0.1_f32..2.0, 1.0..3.0_f64),
            things in prop::collection::vec((prop::array::uniform2(-11.0_f64..11.0), 0.2..3.0_f64), 0..12),
        ) {
            let mut draft = WorldDraft::default();
            let maze = Maze { seed: Some(seed), wall, height: Some(low), ..Maze::default() };
            draft.environment_params.layout = Some(Layout { maze: Some(maze), standing, ..Layout::default() });
            draft.objects.extend(things.into_iter().map(|(at, scale)| Object { scale, ..Object::new("geometric", at) }));
            let scene = Scene::from_world(&draft.check().expect("the world is valid"));
            let camera = Camera::first_person(at, heading, eye, 60.0);
            let [hiding, all] = [true, false].map(|hides| {
                let mut frame = Frame::new(84, 84);
                CpuRenderer::new().with_culling(hides).render(&scene, &camera, &mut frame);
                frame
            });
            let other = (0..84 * 84).filter(|pixel| {
                let same = |rgb: &Frame| rgb.rgb[3 * pixel..3 * pixel + 3].to_vec();
                same(&hiding) != same(&all) || hiding.depth[*pixel].to_bits() != all.depth[*pixel].to_bits()
                    || hiding.instance[*pixel] != all.instance[*pixel]
            });
            let other: Vec<usize> = other.collect();
            prop_assert!(other.is_empty(), "{} pixels, first at {:?}", other.len(), other.first().map(|at| [at % 84, at / 84]));
        }
    }
}
