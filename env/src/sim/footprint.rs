//! [`Footprint`]: the area of ground that a body covers, as a disc or a convex polygon. All bodies are upright and move in the
//! plane, so collisions are a two-dimensional problem. Gaps are computed exactly, by closed forms in `f64`. The time of a
//! contact is found by iteration, but the result is never late.

use smallvec::{SmallVec, smallvec};

use super::gap::{Gap, gap_to_line, gap_to_point, gap_to_polygon};

/// A point or a vector on the ground, in metres.
pub(super) type Point = [f64; 2];

/// A convex polygon, a line segment or a point, widened by a radius.
#[derive(Clone, Debug, Default)]
pub(super) struct Footprint {
    /// One for a disc, two for a wall with round ends, otherwise more: counter-clockwise and distinct.
    pub(super) corners: SmallVec<[Point; 4]>,
    /// The radius by which corners and edges are widened, in metres.
    pub(super) rounding: f64,
}

/// Distance from the target, in metres, at which the search for the time of a contact stops.
const NEAR_ENOUGH: f64 = 1e-7;

/// Maximum number of iterations of that search. It needs about five, or twenty if the path only grazes the footprint.
const MAX_ITERATIONS: usize = 64;

impl Footprint {
    /// A disc.
    pub(super) fn disc(middle: Point, radius: f64) -> Self {
        Self {
            corners: smallvec![middle],
            rounding: radius,
        }
    }

    /// A segment along x around the origin with this half length, widened by a radius. Its ends are round, so that two walls
    /// meet in a corner without a notch.
    pub(super) fn line(half_length: f64, radius: f64) -> Self {
        Self {
            corners: smallvec![[-half_length, 0.0], [half_length, 0.0]],
            rounding: radius,
        }
    }

    /// An axis-aligned rectangle around the origin.
    pub(super) fn rectangle([x, y]: Point) -> Self {
        Self {
            corners: smallvec![[-x, -y], [x, -y], [x, y], [-x, y]],
            rounding: 0.0,
        }
    }

    /// The convex hull of points; `None` if they are collinear.
    pub(super) fn around(points: Vec<Point>) -> Option<Self> {
        let corners = SmallVec::from_vec(convex_hull(points));
        (corners.len() >= 3).then_some(Self { corners, rounding: 0.0 })
    }

    /// Writes to `placed` this footprint, rotated counter-clockwise by an angle given by its sine and cosine, and then
    /// translated.
    pub(super) fn place_into(&self, [sine, cosine]: Point, at: Point, placed: &mut Self) {
        placed.rounding = self.rounding;
        placed.corners.clear();
        let corners = self.corners.iter();
        placed
            .corners
            .extend(corners.map(|[x, y]| [at[0] + cosine * x - sine * y, at[1] + sine * x + cosine * y]));
    }

    /// Its radius, if it is a disc.
    pub(super) fn as_disc(&self) -> Option<f64> {
        (self.corners.len() == 1).then_some(self.rounding)
    }

    /// Largest distance from the origin, in metres.
    pub(super) fn reach(&self) -> f64 {
        let far = |corner: &Point| (corner[0] * corner[0] + corner[1] * corner[1]).sqrt();
        self.corners.iter().map(far).fold(0.0, f64::max) + self.rounding
    }

    /// Writes to `widened` all positions of a body's centre at which it touches or overlaps this footprint: a Minkowski sum.
    /// `body` is around the origin.
    pub(super) fn widen_into(&self, body: &Self, widened: &mut Self) {
        widened.rounding = self.rounding + body.rounding;
        widened.corners.clear();
        if let [own] = body.corners.as_slice() {
            let corners = self.corners.iter();
            widened
                .corners
                .extend(corners.map(|corner| [corner[0] - own[0], corner[1] - own[1]]));
            return;
        }
        if let [middle] = self.corners.as_slice() {
            let corners = body.corners.iter();
            widened
                .corners
                .extend(corners.map(|corner| [middle[0] - corner[0], middle[1] - corner[1]]));
            return;
        }
        // Merges the edges of both, ordered by angle; the body's edges are rotated by 180 degrees.
        let lowest = |corners: &[Point], sign: f64| {
            let key = |index: &usize| corners[*index].map(|part| part * sign);
            let below = |a: &usize, b: &usize| {
                let ([ax, ay], [bx, by]) = (key(a), key(b));
                ay.total_cmp(&by).then(ax.total_cmp(&bx))
            };
            (0..corners.len()).min_by(below).unwrap_or(0)
        };
        let (a, b) = (&self.corners, &body.corners);
        let (first_a, first_b) = (lowest(a, 1.0), lowest(b, -1.0));
        let (mut done_a, mut done_b) = (0, 0);
        while done_a < a.len() || done_b < b.len() {
            let at = |corners: &[Point], first: usize, done: usize| corners[(first + done) % corners.len()];
            let (from_a, to_a) = (at(a, first_a, done_a), at(a, first_a, done_a + 1));
            let (from_b, to_b) = (at(b, first_b, done_b), at(b, first_b, done_b + 1));
            widened.corners.push([from_a[0] - from_b[0], from_a[1] - from_b[1]]);
            let edge_a = [to_a[0] - from_a[0], to_a[1] - from_a[1]];
            let edge_b = [from_b[0] - to_b[0], from_b[1] - to_b[1]];
            let turn = edge_a[0] * edge_b[1] - edge_a[1] * edge_b[0];
            let (a_left, b_left) = (done_a < a.len(), done_b < b.len());
            if a_left && (!b_left || turn >= 0.0) {
                done_a += 1;
            }
            if b_left && (!a_left || turn <= 0.0) {
                done_b += 1;
            }
        }
    }

    /// The gap between this footprint and a point.
    ///
    /// The distance is a convex function of the point, even inside, so along a straight path it first falls and then rises.
    pub(super) fn gap(&self, at: Point) -> Gap {
        let gap = match self.corners.as_slice() {
            [middle] => gap_to_point(*middle, at),
            [from, to] => gap_to_line(*from, *to, at),
            corners => gap_to_polygon(corners, at),
        };
        Gap {
            distance: gap.distance - self.rounding,
            ..gap
        }
    }

    /// The first time, 0..1, at which a point on a straight path is within `reach` of this footprint.
    ///
    /// The result is never late. Along a straight path the distance is convex, so each tangent reaches `reach` no later than
    /// the distance itself.
    pub(super) fn time_within(&self, from: Point, by: Point, reach: f64) -> Option<f64> {
        let mut time = 0.0;
        for _ in 0..MAX_ITERATIONS {
            let gap = self.gap([from[0] + by[0] * time, from[1] + by[1] * time]);
            let above = gap.distance - reach;
            if above <= NEAR_ENOUGH {
                break;
            }
            let closing = -(gap.out[0] * by[0] + gap.out[1] * by[1]);
            if closing <= 0.0 || above > closing * (1.0 - time) {
                return None;
            }
            time += above / closing;
        }
        Some(time)
    }
}

/// The corners of the convex hull of points, counter-clockwise (monotone chain).
fn convex_hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let mut hull: Vec<Point> = Vec::with_capacity(points.len() + 1);
    let mut half = |points: &mut dyn Iterator<Item = &Point>| {
        let start = hull.len();
        for &point in points {
            while let [.., a, b] = hull[start..] {
                let turn = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
                if turn > 1e-9 {
                    break;
                }
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    };
    half(&mut points.iter());
    half(&mut points.iter().rev());
    hull
}

/// The squared distance between a point and a line segment.
pub(super) fn squared_distance(point: Point, from: Point, to: Point) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let off = [point[0] - from[0], point[1] - from[1]];
    let length = way[0] * way[0] + way[1] * way[1];
    let share = if length > 0.0 {
        ((off[0] * way[0] + off[1] * way[1]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let [x, y] = [0, 1].map(|axis| off[axis] - way[axis] * share);
    x * x + y * y
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        [-5.0..5.0_f64, -5.0..5.0_f64]
    }

    fn footprint() -> impl Strategy<Value = Footprint> {
        let disc = (point(), 0.05..3.0_f64).prop_map(|(middle, radius)| Footprint::disc(middle, radius));
        let polygon = prop::collection::vec(point(), 3..9)
            .prop_filter_map("points on a line", Footprint::around)
            .boxed();
        let line = (point(), 0.0..6.3_f64, 0.1..4.0_f64, 0.0..0.5_f64).prop_map(|(at, turn, half, radius)| {
            let mut placed = Footprint::default();
            Footprint::line(half, radius).place_into([libm::sin(turn), libm::cos(turn)], at, &mut placed);
            placed
        });
        prop_oneof![disc, polygon, line]
    }

    /// The distance to the nearest of many points on the boundary, as a cross-check; accurate to a few millimetres.
    fn sampled_distance(footprint: &Footprint, at: Point) -> f64 {
        let corners = &footprint.corners;
        let mut nearest = f64::INFINITY;
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            for k in 0..=2000 {
                let share = f64::from(k) / 2000.0;
                let x = from[0] + (to[0] - from[0]) * share - at[0];
                let y = from[1] + (to[1] - from[1]) * share - at[1];
                nearest = nearest.min(libm::hypot(x, y));
            }
        }
        nearest - footprint.rounding
    }

    fn is_inside(corners: &[Point], [x, y]: Point) -> bool {
        let mut inside = false;
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            if (a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0] {
                inside = !inside;
            }
        }
        inside
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn gap_matches_the_nearest_of_many_boundary_points(footprint in footprint(), at in point()) {
            let gap = footprint.gap(at);
            let sampled = sampled_distance(&footprint, at);
            if footprint.corners.len() > 2 && is_inside(&footprint.corners, at) {
                prop_assert!((gap.distance + sampled).abs() < 0.01, "{} {sampled}", gap.distance);
            } else {
                prop_assert!((gap.distance - sampled).abs() < 0.01, "{} {sampled}", gap.distance);
            }
            // Moving outwards increases the distance by the same amount.
            let there = footprint.gap([at[0] + gap.out[0] * 0.1, at[1] + gap.out[1] * 0.1]);
            prop_assert!((there.distance - gap.distance - 0.1).abs() < 1e-9 || gap.distance < -0.1 - 1e-9 || gap.distance < 0.0);
        }

        #[test]
        fn gap_is_convex_along_a_straight_path(footprint in footprint(), a in point(), b in point(), share in 0.0..1.0_f64) {
            let middle = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
            let [at_a, at_b, at_middle] = [a, b, middle].map(|at| footprint.gap(at).distance);
            prop_assert!(at_middle <= at_a + (at_b - at_a) * share + 1e-9);
        }

        #[test]
        fn time_within_is_the_first_time(footprint in footprint(), from in point(), by in point(), reach in 0.0..0.6_f64) {
            let at = |time: f64| footprint.gap([from[0] + by[0] * time, from[1] + by[1] * time]).distance;
            let found = footprint.time_within(from, by, reach);
            let steps = 4000;
            let sampled = (0..=steps).map(|k| f64::from(k) / f64::from(steps)).find(|time| at(*time) <= reach);
            match (found, sampled) {
                (Some(time), Some(sampled)) => prop_assert!(time <= sampled + 1e-6 && at(time) <= reach + 1e-5),
                // The path grazes the footprint between two samples.
                (Some(time), None) => prop_assert!(at(time) <= reach + 1e-5),
                (None, Some(_)) => prop_assert!(false, "the contact was missed"),
                (None, None) => {}
            }
        }

        #[test]
        fn widened_footprint_is_met_where_the_body_meets_the_original(
            standing in footprint(),
            points in prop::collection::vec(point(), 3..9),
            at in point(),
        ) {
            let Some(body) = Footprint::around(points) else { return Ok(()) };
            let mut widened = Footprint::disc([0.0; 2], 0.0);
            standing.widen_into(&body, &mut widened);
            // The distance between two convex shapes is the minimum over the boundary of one of them.
            let mut least = f64::INFINITY;
            for (from, to) in body.corners.iter().zip(body.corners.iter().cycle().skip(1)) {
                for k in 0..=500 {
                    let share = f64::from(k) / 500.0;
                    let [x, y] = [0, 1].map(|axis| at[axis] + from[axis] + (to[axis] - from[axis]) * share);
                    least = least.min(standing.gap([x, y]).distance);
                }
            }
            let found = widened.gap(at).distance;
            if found > 0.02 {
                prop_assert!((found - least).abs() < 0.02, "{found} {least}");
            } else if least < -0.02 {
                prop_assert!(found < 0.0, "{found} {least}");
            }
        }
    }
}
