//! Sliding: the path of a body that is driven in one direction among footprints, without friction.
//!
//! At each moment the body moves as it is driven, minus the component into anything that it touches. So along a wall it keeps
//! the component of its velocity parallel to the wall, whatever the wall's length, the body's width or the time step.

use super::budget::Budget;
use super::footprint::{Footprint, Point};
use super::gap::Gap;

/// Gap that a body keeps from what it slides along, in metres.
pub(super) const SKIN: f64 = 0.01;

/// How much wider than the skin a gap may be to count as contact, in metres: more than the rounding to `f32` at the edge of the
/// world.
const SLACK: f64 = 2e-4;

/// How far a section of the path may depart from a round edge before it is corrected, in metres.
const SAGITTA: f64 = 1e-3;

/// Maximum number of sections of a path, each straight along one obstacle. 1 km along a thousand bodies ends early.
const MOST_PARTS: usize = 4096;

/// Queries per corner in a section of a path: whether its body is touched, when it will be, and whether it is followed.
const LOOKS_PER_PART: usize = 4;

/// Potential obstacles: the footprints of these numbers.
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

    /// The first time, 0..1, at which a body of this radius comes within the skin of something that it does not touch already.
    fn first_time(&self, from: Point, by: Point, radius: f64) -> Option<f64> {
        self.footprints()
            .filter(|footprint| footprint.gap(from).distance - radius > SKIN + SLACK)
            .filter_map(|footprint| footprint.time_within(from, by, radius + SKIN))
            .min_by(f64::total_cmp)
    }

    /// Whether a straight path stays outside the skin of everything.
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

    /// Moves a round body out of overlaps, in at most three moves of up to half a metre, and never through anything else.
    ///
    /// If that would lead just as deep into other obstacles, it stays.
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

    /// A place at most `most` away where a body without radius overlaps nothing; `None` if none is found.
    pub(super) fn room_near(&self, start: Point, most: f64) -> Option<Point> {
        let mut at = start;
        for _ in 0..8 {
            let gaps = self.footprints().map(|footprint| footprint.gap(at));
            let deepest = gaps.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
            if deepest.distance >= 0.0 {
                return Some(at);
            }
            at = add(at, deepest.out, 1e-6 - deepest.distance);
            let off = add(at, start, -1.0);
            if dot(off, off) > most * most {
                return None;
            }
        }
        None
    }

    /// Slides a round body that is driven in a direction for a unit of time; stores its bends and its end in `path`.
    ///
    /// A footprint that contains its centre does not hold it: if something was put onto it, it can walk out in any direction.
    /// Its path ends when the budget does.
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
        for _ in 0..MOST_PARTS {
            if !budget.take(LOOKS_PER_PART * self.num_corners) {
                break;
            }
            touched.clear();
            let gaps = self.footprints().map(|footprint| footprint.gap(at));
            touched.extend(gaps.filter(|gap| is_touched(gap, radius)));
            let Some((way, held_by)) = allowed(by, touched, budget) else {
                break;
            };
            let mut time = left;
            let whole = way.map(|part| part * left);
            if let Some(share) = self.first_time(at, whole, radius) {
                time = left * share;
            }
            match held_by {
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

    /// Follows the edge of the obstacle for this much time, or less if the edge bends away; returns the place and the time.
    fn along(&self, at: Point, by: Point, way: Point, most: f64, out: Point, radius: f64) -> (Point, f64) {
        // The obstacle being followed is touched now, and has this outward direction.
        let holds = |footprint: &&Footprint| {
            let gap = footprint.gap(at);
            is_touched(&gap, radius) && gap.out == out
        };
        let Some(held) = self.footprints().find(holds) else {
            return (add(at, way, most), most);
        };
        let kept = held.gap(at).distance.max(radius + SKIN);
        let mut time = most;
        loop {
            let end = add(at, way, time);
            let gap = held.gap(end);
            let apart = gap.distance - kept;
            if apart <= SAGITTA {
                // If driven away from the edge, the body leaves it.
                let into = dot(by, gap.out).min(0.0);
                let back = if into < 0.0 { apart.max(0.0) } else { 0.0 };
                let onward = add(by, gap.out, -into);
                let taken = time * share_of_time(dot(way, way).sqrt(), dot(onward, onward).sqrt());
                return (add(end, gap.out, -back), taken);
            }
            // Beyond a bend, the edge recedes with the square of the distance.
            time *= (0.9 * (SAGITTA / apart).sqrt()).clamp(0.05, 0.9);
        }
    }
}

/// The fraction of the time that a section of the path takes at its initial speed, if the speed grows linearly with the
/// distance.
///
/// Around a corner it does, up to the third order in the angle.
fn share_of_time(first: f64, last: f64) -> f64 {
    let growth = last / first - 1.0;
    if growth > 1e-6 {
        libm::log1p(growth) / growth
    } else {
        1.0
    }
}

/// Whether something holds a body of this radius. A body without radius is a point among widened footprints, which hold
/// it from inside as well.
fn is_touched(gap: &Gap, radius: f64) -> bool {
    gap.distance - radius <= SKIN + SLACK && (gap.distance >= 0.0 || radius == 0.0)
}

/// The part of a direction that leads into nothing that is touched, and the outward direction of the obstacle that deflected
/// it; `None` if no direction is left.
fn allowed(by: Point, touched: &[Gap], budget: &mut Budget) -> Option<(Point, Option<Point>)> {
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
    // Among the directions along a single obstacle that lead into no other, chooses the one nearest to the intended
    // one. The change must be at least as large as the part of the intended one that leads into the deepest obstacle,
    // minus the slack: directions with smaller changes need not be checked.
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

    /// The definition: every direction along every obstacle, against all obstacles.
    fn allowed_by_all(by: Point, touched: &[Gap]) -> Option<(Point, Option<Point>)> {
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
            let found = allowed(by, &touched, &mut Budget::new(u64::MAX));
            prop_assert_eq!(found, allowed_by_all(by, &touched));
        }
    }
}
