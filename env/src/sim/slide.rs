//! Computes the path of a body that is driven in one direction and slides along footprints without friction.
//!
//! At each moment the body moves in the driven direction, minus the component into anything that it touches. So along a wall it
//! keeps the component of its velocity parallel to the wall, regardless of the wall's length, the body's width and the time
//! step.

use super::budget::Budget;
use super::footprint::{Footprint, Point};
use super::gap::Gap;

/// Gap in metres between a body and the obstacles along which it slides.
pub(super) const SKIN: f64 = 0.01;

/// Maximum excess of a gap over the skin, in metres, at which it counts as contact. Exceeds the rounding to `f32` at the edge
/// of the world.
const SLACK: f64 = 2e-4;

/// Maximum deviation of a section of the path from a round edge, in metres, before it is corrected.
const SAGITTA: f64 = 1e-3;

/// Maximum number of sections of a path, each straight along one obstacle. A path of 1 km along a thousand bodies ends early.
const MAX_SECTIONS: usize = 4096;

/// Cost of a section of a path, in queries per corner: finds the footprints that are touched, the next one that will be, and
/// the one that is followed.
const QUERIES_PER_SECTION: usize = 4;

/// Potential obstacles: the footprints with certain numbers.
#[derive(Clone, Copy)]
pub(super) struct Obstacles<'a> {
    /// The footprints by number.
    pub(super) footprints: &'a [Footprint],
    /// The numbers of those that may be met, in an order that depends only on the world.
    pub(super) numbers: &'a [u32],
    /// Their total number of corners.
    pub(super) num_corners: usize,
}

impl Obstacles<'_> {
    fn footprints(&self) -> impl Iterator<Item = &Footprint> {
        self.numbers.iter().map(|number| &self.footprints[*number as usize])
    }

    /// The first time, 0..1, at which a body of this radius comes within the skin of an obstacle that it does not touch yet.
    fn first_time(&self, from: Point, by: Point, radius: f64) -> Option<f64> {
        self.footprints()
            .filter(|footprint| footprint.gap(from).distance - radius > SKIN + SLACK)
            .filter_map(|footprint| footprint.time_within(from, by, radius + SKIN))
            .min_by(f64::total_cmp)
    }

    /// Whether a straight path stays outside the skin of all obstacles.
    pub(super) fn is_clear(&self, from: Point, by: Point, radius: f64) -> bool {
        self.footprints()
            .all(|footprint| footprint.time_within(from, by, radius + SKIN).is_none())
    }

    /// The gap to the deepest overlap, ignoring footprints that contain the body's centre.
    fn deepest_overlap(&self, at: Point, radius: f64) -> Option<Gap> {
        self.footprints()
            .map(|footprint| footprint.gap(at))
            .filter(|gap| (0.0..radius).contains(&gap.distance))
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// Moves a round body out of overlaps, in at most three moves of up to half a metre, but never through other obstacles. The
    /// body stays if that would lead just as deep into other obstacles.
    pub(super) fn out_of_overlap(&self, start: Point, radius: f64) -> Point {
        let mut at = start;
        for _ in 0..3 {
            let Some(gap) = self.deepest_overlap(at, radius) else {
                break;
            };
            let length = (radius - gap.distance).min(0.5);
            let by = gap.out.map(|part| part * length);
            let share = self.first_time(at, by, radius).unwrap_or(1.0);
            at = add(at, by, share);
        }
        let depth = |at: Point| {
            self.deepest_overlap(at, radius)
                .map_or(0.0, |gap| radius - gap.distance)
        };
        if depth(at) < depth(start) { at } else { start }
    }

    /// A position at most `max_distance` away where a body without radius overlaps nothing; `None` if none is found.
    pub(super) fn room_near(&self, start: Point, max_distance: f64) -> Option<Point> {
        let mut at = start;
        for _ in 0..8 {
            let gaps = self.footprints().map(|footprint| footprint.gap(at));
            let deepest = gaps.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
            if deepest.distance >= 0.0 {
                return Some(at);
            }
            at = add(at, deepest.out, 1e-6 - deepest.distance);
            let off = add(at, start, -1.0);
            if dot(off, off) > max_distance * max_distance {
                return None;
            }
        }
        None
    }

    /// Slides a round body that is driven in a direction for a unit of time; stores the path's bends and end in `path`.
    ///
    /// A footprint that contains the body's centre does not block it, so that the body can leave in any direction if an object
    /// was placed onto it. The path ends when the budget is used up.
    pub(super) fn slide(
        &self,
        from: Point,
        by: Point,
        radius: f64,
        budget: &mut Budget,
        touched: &mut Vec<Gap>,
        path: &mut Vec<Point>,
    ) {
        let (mut at, mut left) = (from, 1.0);
        for _ in 0..MAX_SECTIONS {
            if !budget.take(QUERIES_PER_SECTION * self.num_corners) {
                break;
            }
            touched.clear();
            let gaps = self.footprints().map(|footprint| footprint.gap(at));
            touched.extend(gaps.filter(|gap| is_in_contact(gap, radius)));
            let Some((way, deflector)) = allowed_direction(by, touched, budget) else {
                break;
            };
            let mut time = left;
            let whole = way.map(|part| part * left);
            if let Some(share) = self.first_time(at, whole, radius) {
                time = left * share;
            }
            match deflector {
                Some(out) => (at, time) = self.along(at, by, way, time, out, radius),
                None => at = add(at, way, time),
            }
            if path.last() != Some(&at) {
                path.push(at);
            }
            left -= time;
            if left <= 1e-9 {
                break;
            }
        }
    }

    /// Follows the edge of an obstacle for at most `most` time, less if the edge bends away; returns the position and the time.
    fn along(&self, at: Point, by: Point, way: Point, most: f64, out: Point, radius: f64) -> (Point, f64) {
        // The obstacle being followed is touched now, and has this outward direction.
        let holds = |footprint: &&Footprint| {
            let gap = footprint.gap(at);
            is_in_contact(&gap, radius) && gap.out == out
        };
        let Some(followed) = self.footprints().find(holds) else {
            return (add(at, way, most), most);
        };
        let kept = followed.gap(at).distance.max(radius + SKIN);
        let mut time = most;
        loop {
            let end = add(at, way, time);
            let gap = followed.gap(end);
            let deviation = gap.distance - kept;
            if deviation <= SAGITTA {
                // A body that is driven away from the edge leaves it.
                let into = dot(by, gap.out).min(0.0);
                let back = if into < 0.0 { deviation.max(0.0) } else { 0.0 };
                let onward = add(by, gap.out, -into);
                let taken = time * time_fraction(dot(way, way).sqrt(), dot(onward, onward).sqrt());
                return (add(end, gap.out, -back), taken);
            }
            // Beyond a bend, the edge recedes with the square of the distance.
            time *= (0.9 * (SAGITTA / deviation).sqrt()).clamp(0.05, 0.9);
        }
    }
}

/// The time that a section of the path takes if the speed grows linearly with the distance, as a fraction of the time at its
/// initial speed. Around a corner the speed does grow like this, up to the third order in the angle.
fn time_fraction(first: f64, last: f64) -> f64 {
    let growth = last / first - 1.0;
    if growth > 1e-6 {
        libm::log1p(growth) / growth
    } else {
        1.0
    }
}

/// Whether an obstacle at this gap blocks a body of this radius. A body without radius is a point among widened footprints,
/// which block it even if it is inside them.
fn is_in_contact(gap: &Gap, radius: f64) -> bool {
    gap.distance - radius <= SKIN + SLACK && (gap.distance >= 0.0 || radius == 0.0)
}

/// The part of a direction that leads into no touched obstacle, and the outward direction of the obstacle that deflected it;
/// `None` if no direction is left.
fn allowed_direction(by: Point, touched: &[Gap], budget: &mut Budget) -> Option<(Point, Option<Point>)> {
    let length = dot(by, by).sqrt();
    // The next direction is likely to be blocked by the same obstacle as the last.
    let mut suspect = 0;
    let mut free = |way: Point, slack: f64| {
        let leads_into = |gap: &Gap| dot(way, gap.out) < -slack;
        if touched.get(suspect).is_some_and(leads_into) {
            return false;
        }
        let found = touched.iter().position(leads_into);
        suspect = found.unwrap_or(suspect);
        found.is_none()
    };
    if length <= 1e-9 {
        return None;
    }
    if free(by, 0.0) {
        return Some((by, None));
    }
    // Among the directions along a single obstacle that lead into no other, chooses the one nearest to the intended direction.
    // The change must be at least as large as the part of the intended direction that leads into the deepest obstacle, minus
    // the slack; directions with smaller changes need not be checked.
    let deepest = touched.iter().map(|gap| -dot(by, gap.out)).fold(0.0, f64::max);
    let mut best: Option<(f64, Point, Point)> = None;
    for gap in touched {
        let into = dot(by, gap.out);
        if into >= 0.0 || -into < deepest - 4e-6 * length || best.is_some_and(|(least, ..)| -into >= least) {
            continue;
        }
        let way = add(by, gap.out, -into);
        if !budget.take(touched.len()) {
            break;
        }
        if free(way, 1e-6 * length) {
            best = Some((-into, way, gap.out));
        }
    }
    let (_, way, out) = best?;
    (dot(way, way).sqrt() > 1e-6 * length).then_some((way, Some(out)))
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn add(at: Point, by: Point, share: f64) -> Point {
    [at[0] + by[0] * share, at[1] + by[1] * share]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition: tests every direction along every obstacle against all obstacles.
    fn allowed_by_definition(by: Point, touched: &[Gap]) -> Option<(Point, Option<Point>)> {
        let length = dot(by, by).sqrt();
        let free = |way: Point, slack: f64| touched.iter().all(|gap| dot(way, gap.out) >= -slack);
        if length <= 1e-9 {
            return None;
        }
        if free(by, 0.0) {
            return Some((by, None));
        }
        let mut best: Option<(f64, Point, Point)> = None;
        for gap in touched {
            let into = dot(by, gap.out);
            let way = add(by, gap.out, -into);
            if into < 0.0 && free(way, 1e-6 * length) && best.is_none_or(|(least, ..)| -into < least) {
                best = Some((-into, way, gap.out));
            }
        }
        let (_, way, out) = best?;
        (dot(way, way).sqrt() > 1e-6 * length).then_some((way, Some(out)))
    }

    /// Directions in steps of a few degrees, some nearly or exactly equal.
    fn direction() -> impl Strategy<Value = Point> {
        let noise = prop_oneof![Just(0.0), -1e-5..1e-5_f64, -1e-7..1e-7_f64, -0.5..0.5_f64];
        (0..24_i32, noise).prop_map(|(step, noise)| {
            let angle = f64::from(step) * std::f64::consts::TAU / 24.0 + noise;
            [libm::sin(angle), libm::cos(angle)]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 2000)))]

        #[test]
        fn allowed_direction_equals_the_definition_bit_for_bit(
            by in direction(),
            length in prop_oneof![1e-8..1e-3_f64, 1e-3..1e3_f64],
            outs in prop::collection::vec(direction(), 0..12),
        ) {
            let by = by.map(|part| part * length);
            let touched: Vec<Gap> = outs.into_iter().map(|out| Gap { distance: 0.0, out }).collect();
            let found = allowed_direction(by, &touched, &mut Budget::new(u64::MAX));
            prop_assert_eq!(found, allowed_by_definition(by, &touched));
        }
    }
}
