//! Scans the region that a task's requirements allow within the ranges, for cases where the straight line to the ends is cut
//! off.
//!
//! Walks lines along every axis through the whole box. Where a line leaves the allowed region, bisects to its border; between
//! two points on either side of the target distance, bisects to that distance. From the nearest points it continues in all
//! directions with ever smaller steps. Deterministic: the same arguments find the same variant.

use driftworld_spec::Variant;

use super::search::{Changes, Search, with};
use super::space::{Axis, Point, Space};

/// Number of parts into which a line through the box is divided.
const PARTS: usize = 32;

/// With a budget below this, which is too small to search every line closely, the whole box is searched coarsely first.
const SMALL_BUDGET: usize = 3000;

/// Maximum number of parts per axis of the grid of lines in the coarse search.
const COARSE_PARTS: usize = 3;

/// Bisection steps towards a border, and towards the target distance.
const MAX_BISECTIONS: u32 = 48;

/// Number of points from which the search continues in small steps.
const MAX_STARTS: usize = 12;

/// Number of times the small steps are halved.
const STEP_HALVINGS: u32 = 30;

/// Maximum number of points on either side of the target distance that are paired with those on the other side.
const MAX_PAIRED: usize = 6;

/// Maximum number of axes for which diagonals are also tried.
const MAX_DIAGONAL_AXES: usize = 8;

/// Directions of small steps: along each axis and, if there are few axes, along the diagonals of each pair.
fn directions(axes: usize) -> Vec<Vec<(usize, f64)>> {
    let mut found = Vec::new();
    for a in 0..axes {
        found.extend([1.0, -1.0].map(|sign| vec![(a, sign)]));
        for b in (0..a).filter(|_| axes <= MAX_DIAGONAL_AXES) {
            let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
            found.extend(signs.map(|(first, second)| vec![(a, first), (b, second)]));
        }
    }
    found
}

/// An allowed point, and its distance.
type Measured = (Point, f64);

impl<'a, D: FnMut(&Variant) -> f64> Search<'a, D> {
    /// Searches one combination of choices in every direction; true if the target was met.
    pub(super) fn scan(&mut self, space: &Space<'a>, combination: &Changes, budget: usize) -> bool {
        let scan = Scan {
            search: self,
            space,
            combination,
            budget,
        };
        scan.run()
    }
}

/// A search through one combination of choices.
pub(super) struct Scan<'s, 'a, D> {
    pub(super) search: &'s mut Search<'a, D>,
    pub(super) space: &'s Space<'a>,
    pub(super) combination: &'s Changes,
    /// Number of variants that it may still measure.
    pub(super) budget: usize,
}

/// Ends the search: the target distance was met, or the budget is used up.
struct Stop;

impl<D: FnMut(&Variant) -> f64> Scan<'_, '_, D> {
    /// Scans the whole box; true if the target distance was met.
    pub(super) fn run(mut self) -> bool {
        // The search's nearest variant shows whether the target was met.
        let _end = self.scan_all();
        let is_met = self.search.is_met();
        self.search.is_complete &= is_met || self.budget > 0;
        is_met
    }

    fn scan_all(&mut self) -> Result<(), Stop> {
        let mut points: Vec<Measured> = Vec::new();
        let here = self.space.here();
        if self.space.axes.is_empty() {
            return Ok(());
        }
        points.extend(self.look(&here)?.map(|distance| (here.clone(), distance)));
        if self.budget < SMALL_BUDGET && self.space.axes.len() > 1 {
            for along in 0..self.space.axes.len() {
                for anchor in self.space.anchors(along, COARSE_PARTS) {
                    self.line(&anchor, along, PARTS / 2, &mut points)?;
                }
            }
        }
        for along in 0..self.space.axes.len() {
            self.line(&here, along, 4 * PARTS, &mut points)?;
        }
        // First the neighbourhood, which usually suffices, then the whole box.
        self.continue_from_nearest(&mut points, 1)?;
        if self.space.axes.len() == 1 {
            return Ok(());
        }
        for along in 0..self.space.axes.len() {
            for anchor in self.space.anchors(along, PARTS) {
                self.line(&anchor, along, PARTS, &mut points)?;
            }
        }
        self.continue_from_nearest(&mut points, MAX_STARTS)
    }

    /// Continues from the nearest points.
    fn continue_from_nearest(&mut self, points: &mut [Measured], starts: usize) -> Result<(), Stop> {
        self.pairs(points)?;
        let target = self.search.target;
        points.sort_by(|a, b| (a.1 - target).abs().total_cmp(&(b.1 - target).abs()));
        for start in spaced_out(points, self.space, starts) {
            self.refine(start)?;
        }
        Ok(())
    }

    /// The distance of a point; `None` if the task does not allow it.
    fn look(&mut self, point: &[f64]) -> Result<Option<f64>, Stop> {
        if self.budget == 0 {
            return Err(Stop);
        }
        self.budget -= 1;
        let changes = with(self.combination, &self.space.changes(point));
        let Some(found) = self.search.look(changes) else {
            return Ok(None);
        };
        if self.search.meets(&found) {
            return Err(Stop);
        }
        Ok(Some(found.distance))
    }

    /// Walks along an axis through a point, from end to end.
    fn line(&mut self, through: &[f64], along: usize, parts: usize, points: &mut Vec<Measured>) -> Result<(), Stop> {
        let parts = self.space.parts(along, parts);
        let mut before: Option<(Point, Option<f64>)> = None;
        for part in 0..=parts {
            let mut point = through.to_vec();
            point[along] = self.space.at(along, part, parts);
            let distance = self.look(&point)?;
            match (&before, distance) {
                (Some((last, Some(near))), Some(far)) => self.between((last, *near), (&point, far))?,
                (Some((last, Some(inside))), None) => self.border((last, *inside), &point, points)?,
                (Some((last, None)), Some(inside)) => {
                    let last = last.clone();
                    self.border((&point, inside), &last, points)?;
                }
                _ => {}
            }
            points.extend(distance.map(|distance| (point.clone(), distance)));
            before = Some((point, distance));
        }
        Ok(())
    }

    /// Moves from an allowed point towards one that is not, as far as possible.
    fn border(&mut self, inside: (&[f64], f64), outside: &[f64], points: &mut Vec<Measured>) -> Result<(), Stop> {
        let (mut low, mut high) = (0.0, 1.0);
        let mut last = None;
        for _ in 0..MAX_BISECTIONS {
            let t = f64::midpoint(low, high);
            let point = between(inside.0, outside, t);
            match self.look(&point)? {
                Some(distance) => {
                    last = Some((point, distance));
                    low = t;
                }
                None => high = t,
            }
        }
        if let Some((point, distance)) = last {
            self.between(inside, (&point, distance))?;
            points.push((point, distance));
        }
        Ok(())
    }

    /// Bisects between two points on either side of the target distance.
    fn between(&mut self, a: (&[f64], f64), b: (&[f64], f64)) -> Result<(), Stop> {
        let target = self.search.target;
        if (a.1 < target) == (b.1 < target) {
            return Ok(());
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..MAX_BISECTIONS {
            let t = f64::midpoint(low, high);
            // If the point between them is not allowed, the two are not connected.
            let Some(distance) = self.look(&between(a.0, b.0, t))? else {
                return Ok(());
            };
            if (distance < target) == (a.1 < target) {
                low = t;
            } else {
                high = t;
            }
        }
        Ok(())
    }

    /// Tries straight lines between points nearer and points farther than the target distance.
    fn pairs(&mut self, points: &[Measured]) -> Result<(), Stop> {
        let target = self.search.target;
        let side = |far: bool| {
            let mut side: Vec<&Measured> = points
                .iter()
                .filter(|(_, distance)| (*distance >= target) == far)
                .collect();
            side.sort_by(|a, b| (a.1 - target).abs().total_cmp(&(b.1 - target).abs()));
            side
        };
        let (near, far) = (side(false), side(true));
        for a in near.iter().take(MAX_PAIRED) {
            for b in far.iter().take(MAX_PAIRED) {
                self.between((&a.0, a.1), (&b.0, b.1))?;
            }
        }
        Ok(())
    }

    /// From a point, takes ever smaller steps in any direction that brings it nearer to the target distance.
    fn refine(&mut self, (start, distance): Measured) -> Result<(), Stop> {
        let target = self.search.target;
        let directions = directions(self.space.axes.len());
        let (mut at, mut distance, mut step) = (start, distance, 0.25);
        for _ in 0..STEP_HALVINGS {
            let mut moved = true;
            while moved {
                moved = false;
                for direction in &directions {
                    let mut point = at.clone();
                    for (axis, sign) in direction {
                        let Axis {
                            low, high, is_whole, ..
                        } = &self.space.axes[*axis];
                        let min_step = if *is_whole { 1.0 } else { 0.0 };
                        point[*axis] = (point[*axis] + sign * ((high - low) * step).max(min_step)).clamp(*low, *high);
                    }
                    if point == at {
                        continue;
                    }
                    let Some(found) = self.look(&point)? else { continue };
                    self.between((&at, distance), (&point, found))?;
                    if (found - target).abs() < (distance - target).abs() {
                        (at, distance, moved) = (point, found, true);
                    }
                }
            }
            step /= 2.0;
        }
        Ok(())
    }
}

/// The nearest points, no two of them close together.
fn spaced_out(sorted: &[Measured], space: &Space, max: usize) -> Vec<Measured> {
    let mut kept: Vec<Measured> = Vec::new();
    for (point, distance) in sorted {
        let is_close = |(other, _): &Measured| {
            let mut differences = space.axes.iter().zip(point.iter().zip(other));
            differences.all(|(axis, (a, b))| (a - b).abs() <= 0.1 * (axis.high - axis.low))
        };
        if !kept.iter().any(is_close) {
            kept.push((point.clone(), *distance));
            if kept.len() == max {
                break;
            }
        }
    }
    kept
}

fn between(a: &[f64], b: &[f64], t: f64) -> Point {
    a.iter()
        .zip(b)
        .map(|(a, b)| if a == b { *a } else { a + (b - a) * t })
        .collect()
}
