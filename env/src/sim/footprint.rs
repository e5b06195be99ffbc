//! What a body covers of the ground: a disc or a convex polygon. How far a point is from one is in `gap.rs`; who slides
//! along footprints, in `slide.rs`; where bodies stand, in `collision_world.rs`.
//!
//! All bodies stand upright and move in the plane, so that what stops them is a question of two dimensions. Its answers
//! are exact: closed forms in `f64`, with no iteration that could end early.

use smallvec::{SmallVec, smallvec};

use super::gap::{Gap, away_from, gap_to_line, gap_to_polygon};

/// A point or a way on the ground, in metres.
pub(super) type Point = [f64; 2];

/// A convex polygon, a straight line or a point, widened by a radius.
#[derive(Clone, Debug, Default)]
pub(super) struct Footprint {
    /// One for a disc, two for a wall of round ends; else more, counterclockwise, no two of them alike.
    pub(super) corners: SmallVec<[Point; 4]>,
    /// How far beyond its corners and edges it reaches, in metres.
    pub(super) rounding: f64,
}

/// How near to its end a way counts as there, in metres.
const NEAR_ENOUGH: f64 = 1e-7;

/// How often the search for the first time goes on; it needs five rounds or so, and twenty where a way only grazes.
const MOST_ROUNDS: usize = 64;

impl Footprint {
    /// A disc.
    pub(super) fn disc(middle: Point, radius: f64) -> Self {
        Self {
            corners: smallvec![middle],
            rounding: radius,
        }
    }

    /// One of no corners, with room for those of two rectangles.
    pub(super) fn with_room() -> Self {
        Self {
            corners: SmallVec::with_capacity(8),
            rounding: 0.0,
        }
    }

    /// A line of this half length along x around the origin, widened: its ends are round, so that where two walls meet,
    /// they make one corner without a notch.
    pub(super) fn line(half_length: f64, radius: f64) -> Self {
        Self {
            corners: smallvec![[-half_length, 0.0], [half_length, 0.0]],
            rounding: radius,
        }
    }

    /// A rectangle around the origin, its sides along the axes.
    pub(super) fn rectangle([x, y]: Point) -> Self {
        Self {
            corners: smallvec![[-x, -y], [x, -y], [x, y], [-x, y]],
            rounding: 0.0,
        }
    }

    /// What points enclose; nothing if they lie on a line.
    pub(super) fn around(points: Vec<Point>) -> Option<Self> {
        let corners = SmallVec::from_vec(convex_hull(points));
        (corners.len() >= 3).then_some(Self { corners, rounding: 0.0 })
    }

    /// This footprint turned by an angle whose sine and cosine are given, counterclockwise, and then moved; in the
    /// memory of another one.
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

    /// How far it reaches from the origin, in metres.
    pub(super) fn reach(&self) -> f64 {
        let far = |corner: &Point| (corner[0] * corner[0] + corner[1] * corner[1]).sqrt();
        self.corners.iter().map(far).fold(0.0, f64::max) + self.rounding
    }

    /// All places of a body's middle at which it touches or overlaps this footprint; `body` stands around the origin.
    pub(super) fn widened_into(&self, body: &Self, widened: &mut Self) {
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
        // The edges of both, in the order of their angles; those of the body are turned by half a circle.
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

    /// How far a point is from this footprint.
    ///
    /// The distance is a convex function of the point, inside too: on a straight way it falls, and then it rises.
    pub(super) fn gap(&self, at: Point) -> Gap {
        let gap = match self.corners.as_slice() {
            [middle] => away_from(*middle, at),
            [from, to] => gap_to_line(*from, *to, at),
            corners => gap_to_polygon(corners, at),
        };
        Gap {
            distance: gap.distance - self.rounding,
            ..gap
        }
    }

    /// The first time, 0..1, at which a point on a straight way is no farther than `reach` from this footprint.
    ///
    /// Never late: on a straight way the distance is convex, so that each tangent meets `reach` no later than it does.
    pub(super) fn time_within(&self, from: Point, by: Point, reach: f64) -> Option<f64> {
        let mut time = 0.0;
        for _ in 0..MOST_ROUNDS {
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

/// The corners of what points enclose, counterclockwise (monotone chain).
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

    /// The nearest of many points on the boundary: another way to the same distance, to a few millimetres.
    fn sampled_distance(footprint: &Footprint, at: Point) -> f64 {
        let corners = &footprint.corners;
        let mut least = f64::INFINITY;
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            for k in 0..=2000 {
                let share = f64::from(k) / 2000.0;
                let x = from[0] + (to[0] - from[0]) * share - at[0];
                let y = from[1] + (to[1] - from[1]) * share - at[1];
                least = least.min(libm::hypot(x, y));
            }
        }
        least - footprint.rounding
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
        #[test]
        fn the_gap_is_that_to_the_nearest_of_many_points(footprint in footprint(), at in point()) {
            let gap = footprint.gap(at);
            let sampled = sampled_distance(&footprint, at);
            if footprint.corners.len() > 2 && is_inside(&footprint.corners, at) {
                prop_assert!((gap.distance + sampled).abs() < 0.01, "{} {sampled}", gap.distance);
            } else {
                prop_assert!((gap.distance - sampled).abs() < 0.01, "{} {sampled}", gap.distance);
            }
            // The way out leads out, by as much as one goes.
            let there = footprint.gap([at[0] + gap.out[0] * 0.1, at[1] + gap.out[1] * 0.1]);
            prop_assert!((there.distance - gap.distance - 0.1).abs() < 1e-9 || gap.distance < -0.1 - 1e-9 || gap.distance < 0.0);
        }

        #[test]
        fn the_gap_is_convex_on_a_straight_way(footprint in footprint(), a in point(), b in point(), share in 0.0..1.0_f64) {
            let middle = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
            let [at_a, at_b, at_middle] = [a, b, middle].map(|at| footprint.gap(at).distance);
            prop_assert!(at_middle <= at_a + (at_b - at_a) * share + 1e-9);
        }

        #[test]
        fn the_first_time_is_the_first(footprint in footprint(), from in point(), by in point(), reach in 0.0..0.6_f64) {
            let at = |time: f64| footprint.gap([from[0] + by[0] * time, from[1] + by[1] * time]).distance;
            let found = footprint.time_within(from, by, reach);
            let steps = 4000;
            let sampled = (0..=steps).map(|k| f64::from(k) / f64::from(steps)).find(|time| at(*time) <= reach);
            match (found, sampled) {
                (Some(time), Some(sampled)) => prop_assert!(time <= sampled + 1e-6 && at(time) <= reach + 1e-5),
                // The way grazes between two samples.
                (Some(time), None) => prop_assert!(at(time) <= reach + 1e-5),
                (None, Some(_)) => prop_assert!(false, "missed"),
                (None, None) => {}
            }
        }

        #[test]
        fn a_widened_footprint_is_met_where_the_body_meets_it(
            standing in footprint(),
            points in prop::collection::vec(point(), 3..9),
            at in point(),
        ) {
            let Some(body) = Footprint::around(points) else { return Ok(()) };
            let mut widened = Footprint::disc([0.0; 2], 0.0);
            standing.widened_into(&body, &mut widened);
            // The distance of two convex shapes is the least over the boundary of one of them.
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
