//! Computes the largest distance of points from a surface within a budget of triangle tests.

use rapier3d::math::Vector;
use rapier3d::parry::partitioning::{BvhNode, TraversalAction};
use rapier3d::parry::query::PointQuery;
use rapier3d::parry::shape::TriMesh;

/// Maximum number of triangle tests per level of detail: a second or two of work. Most models need a hundredth of that. But if
/// thousands of large triangles intersect each other, bounding boxes do not help, and every point would test all of them.
const MAX_TRIANGLE_TESTS: u64 = 30_000_000;

/// Points are skipped if their squared distance is below this fraction of the squared maximum so far. The margin exceeds the
/// rounding difference between two ways to compute a distance.
const SKIP_FRACTION: f32 = 1.0 - 1e-4;

/// The remaining budget of triangle tests.
pub(super) struct TestBudget {
    left: u64,
}

impl TestBudget {
    pub(super) fn new() -> Self {
        Self {
            left: MAX_TRIANGLE_TESTS,
        }
    }

    fn take(&mut self, count: u64) {
        self.left = self.left.saturating_sub(count);
    }
}

/// A surface to measure distances from.
pub(super) struct Deviation {
    surface: TriMesh,
}

impl Deviation {
    /// The surface of these triangles; `None` if all are degenerate.
    pub(super) fn new(corners: &[[f32; 3]], triangles: &[[u32; 3]]) -> Option<Self> {
        let corners_used = used(triangles);
        let new_index = |corner: u32| corners_used.binary_search(&corner).map_or(0, |index| index as u32);
        let triangles = triangles.iter().map(|triangle| triangle.map(new_index)).collect();
        let surface = TriMesh::new(
            corners_used.iter().map(|corner| point(corners, *corner)).collect(),
            triangles,
        );
        Some(Self { surface: surface.ok()? })
    }

    /// Distance of a point from the surface.
    pub(super) fn distance(&self, point: Vector) -> f32 {
        self.surface.distance_to_local_point(point, false)
    }

    /// The largest distance of any of the points, but at least `least`. `None` as soon as it exceeds `most`.
    ///
    /// Skips points that have a triangle nearer than the maximum so far. When the budget runs out, the points measured so far
    /// represent the rest, since they are evenly spread. At least one is measured.
    pub(super) fn farthest(&self, points: &[Vector], least: f32, most: f32, budget: &mut TestBudget) -> Option<f32> {
        let mut farthest = least;
        for (number, index) in evenly_spread(points.len()).enumerate() {
            if budget.left == 0 && number > 0 {
                break;
            }
            let point = points[index];
            if self.is_within(point, farthest * farthest * SKIP_FRACTION, budget) {
                continue;
            }
            let distance = self.distance(point);
            // Estimates the cost of that query: every triangle whose box is as near as the surface.
            let reach = distance * distance;
            let near = self.surface.bvh().leaves(|node| squared_distance(node, point) <= reach);
            budget.take(near.count() as u64);
            farthest = farthest.max(distance);
            if farthest > most {
                return None;
            }
        }
        Some(farthest)
    }

    /// Whether a triangle is within this squared distance of a point.
    fn is_within(&self, point: Vector, squared: f32, budget: &mut TestBudget) -> bool {
        let mut found = false;
        self.surface.bvh().traverse(|node| {
            if squared_distance(node, point) > squared {
                return TraversalAction::Prune;
            }
            let Some(triangle) = node.leaf_data() else {
                return TraversalAction::Continue;
            };
            budget.take(1);
            let nearest = self.surface.triangle(triangle).project_local_point(point, false).point;
            found = (nearest - point).length_squared() <= squared;
            if found || budget.left == 0 {
                TraversalAction::EarlyExit
            } else {
                TraversalAction::Continue
            }
        });
        found
    }
}

/// The squared distance of a point from a box.
fn squared_distance(node: &BvhNode, point: Vector) -> f32 {
    let nearest = point.clamp(node.mins(), node.maxs());
    (nearest - point).length_squared()
}

/// All numbers below `count`, each once, in an order whose prefixes are evenly spread.
fn evenly_spread(count: usize) -> impl Iterator<Item = usize> {
    let is_coprime = |step: &usize| {
        let (mut a, mut b) = (*step, count);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    // The step is near the golden section of the count, and coprime to it.
    let first = ((count as f64 * 0.618_034) as usize).max(1);
    let step = (first..=first + count).find(is_coprime).unwrap_or(1);
    (0..count).map(move |number| (number as u64 * step as u64 % count as u64) as usize)
}

/// The corners that triangles use, each once.
pub(super) fn used(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut used = triangles.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    used
}

pub(super) fn point(corners: &[[f32; 3]], corner: u32) -> Vector {
    let [x, y, z] = corners[corner as usize];
    Vector::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn place() -> impl Strategy<Value = [f32; 3]> {
        [-5.0..5.0_f32, -5.0..5.0_f32, -5.0..5.0_f32]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn evenly_spread_yields_every_number_once(count in 0usize..3000) {
            let mut numbers: Vec<usize> = evenly_spread(count).collect();
            numbers.sort_unstable();
            prop_assert!(numbers.into_iter().eq(0..count));
        }

        /// Compared with measuring every point against every triangle.
        #[test]
        fn farthest_equals_the_maximum_over_all_points_exactly(
            corners in prop::collection::vec(place(), 3..60),
            // Corners of the surface itself have distance 0.
            others in prop::collection::vec(place(), 1..60),
            least in prop_oneof![Just(0.0_f32), 0.0..4.0_f32],
        ) {
            let triangles: Vec<[u32; 3]> = (0..corners.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let Some(surface) = Deviation::new(&corners, &triangles) else { return Ok(()) };
            let points: Vec<Vector> = corners.iter().chain(&others).map(|[x, y, z]| Vector::new(*x, *y, *z)).collect();
            let expected = points.iter().map(|point| surface.distance(*point)).fold(least, f32::max);
            let mut budget = TestBudget::new();
            prop_assert_eq!(surface.farthest(&points, least, 1e9, &mut budget), Some(expected));
            prop_assert!(expected <= least || surface.farthest(&points, least, expected * 0.999, &mut budget).is_none());
            // With a small budget, some points represent the rest.
            let some = surface.farthest(&points, 0.0, 1e9, &mut TestBudget { left: 40 });
            prop_assert!(some.is_some_and(|some| some <= expected));
            // Cross-checks distances against the nearest of all triangles.
            for point in &points {
                let to = |triangle: u32| (surface.surface.triangle(triangle).project_local_point(*point, false).point - *point).length();
                let nearest = (0..triangles.len() as u32).map(to).fold(f32::INFINITY, f32::min);
                prop_assert!((surface.distance(*point).max(0.0) - nearest).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn large_intersecting_triangles_stay_within_the_budget() {
        let mut at = 1_u32;
        let mut number = || {
            at = at.wrapping_mul(0x9E37_79B9) ^ (at >> 15);
            (at >> 8) as f32 / (1 << 24) as f32 * 10.0
        };
        let corners: Vec<[f32; 3]> = (0..30_000).map(|_| [number(), number(), number()]).collect();
        let triangles: Vec<[u32; 3]> = (0..10_000).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let surface = Deviation::new(&corners, &triangles[..2500]).expect("the surface has triangles");
        let points: Vec<Vector> = corners.iter().map(|[x, y, z]| Vector::new(*x, *y, *z)).collect();
        let mut budget = TestBudget::new();
        let found = surface.farthest(&points, 0.0, 10.0, &mut budget);
        // Testing every pair would take 30,000 × 2,500 tests.
        let num_tests = MAX_TRIANGLE_TESTS - budget.left;
        assert!(num_tests < 6_000_000, "{num_tests}");
        let expected = points
            .iter()
            .step_by(10)
            .map(|point| surface.distance(*point))
            .fold(0.0, f32::max);
        assert!(found.is_some_and(|found| found >= expected), "{found:?} {expected}");
    }
}
