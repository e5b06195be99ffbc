//! [`Zones`]: the geometry of a world's zones.

use driftworld_spec::{World, Zone};

use super::footprint::{Point, squared_distance};
use super::state::SimState;

/// The zones of a world, in an order that does not depend on the order of the list, so that sums and products over them are the
/// same, bit for bit.
#[derive(Clone, Debug, Default)]
pub(crate) struct Zones(pub(super) Vec<Area>);

/// One zone.
#[derive(Clone, Debug)]
pub(crate) struct Area {
    pub(crate) zone: Zone,
    /// Minimum and maximum x and y in metres.
    bounds: [Point; 2],
    /// Its index in the world's list.
    pub(super) index: usize,
}

impl Zones {
    /// The zones of a world.
    pub(super) fn new(world: &World) -> Self {
        let zones = world.environment_params.zones.iter().enumerate();
        let mut areas: Vec<Area> = zones
            .filter_map(|(index, zone)| {
                let bounds = zone.bounds()?;
                let zone = zone.clone();
                Some(Area { zone, bounds, index })
            })
            .collect();
        let numbers = |area: &Area| {
            let zone = &area.zone;
            [zone.reward_per_second, zone.reward_on_entering, zone.speed_factor]
        };
        areas.sort_by(|a, b| {
            let pairs = numbers(a).into_iter().zip(numbers(b));
            let mut orders = pairs.map(|(a, b)| a.total_cmp(&b));
            orders.find(|order| order.is_ne()).unwrap_or(a.index.cmp(&b.index))
        });
        Self(areas)
    }

    /// Marks the zones that the agent is in as entered, without events.
    pub(super) fn locate(&self, state: &mut SimState) {
        let here = state.agent.position.map(f64::from);
        state.inside.clear();
        state.inside.extend(self.0.iter().map(|area| area.contains(here)));
    }

    /// Indices, in the world's list, of the zones that the agent has entered and is still in, in ascending order.
    pub(super) fn entered(&self, state: &SimState) -> Vec<u32> {
        let areas = self.0.iter().zip(&state.inside);
        let entered = areas.filter(|(_, inside)| **inside);
        let mut entered: Vec<u32> = entered.map(|(area, _)| area.index as u32).collect();
        entered.sort_unstable();
        entered
    }

    /// Resumes from the result of [`Self::entered`].
    pub(super) fn resume(&self, entered: &[u32], state: &mut SimState) {
        state.inside.clear();
        let is_entered = |area: &Area| entered.contains(&(area.index as u32));
        state.inside.extend(self.0.iter().map(is_entered));
    }

    /// Whether a path enters one of the chosen zones from outside.
    pub(crate) fn are_entered(&self, path: &[Point], is_chosen: impl Fn(&Zone) -> bool) -> bool {
        let (Some(start), Some(end)) = (path.first(), path.last()) else {
            return false;
        };
        let is_entered = |area: &Area| !area.contains(*start) && (area.contains(*end) || area.is_crossed(path));
        self.0.iter().any(|area| is_chosen(&area.zone) && is_entered(area))
    }

    /// The zones that contain a position.
    pub(super) fn around(&self, point: Point) -> impl Iterator<Item = &Zone> {
        let areas = self.0.iter().filter(move |area| area.contains(point));
        areas.map(|area| &area.zone)
    }
}

impl Area {
    /// Whether it contains a position.
    pub(crate) fn contains(&self, point: Point) -> bool {
        let [low, high] = self.bounds;
        (0..2).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis]) && self.zone.contains(point)
    }

    /// Whether it contains any point of a path.
    pub(super) fn is_crossed(&self, path: &[Point]) -> bool {
        let [low, high] = self.bounds;
        path.windows(2).any(|ends| {
            let is_past = |axis: usize| {
                let [from, to] = [ends[0][axis], ends[1][axis]];
                from.max(to) < low[axis] || from.min(to) > high[axis]
            };
            !is_past(0) && !is_past(1) && (self.zone.contains(ends[0]) || self.crosses_border(ends[0], ends[1]))
        })
    }

    /// Whether a straight path between two positions crosses its border.
    fn crosses_border(&self, from: Point, to: Point) -> bool {
        if let Some(disc) = &self.zone.disc {
            return squared_distance(disc.center, from, to) < disc.radius * disc.radius;
        }
        let Some(corners) = &self.zone.polygon else {
            return false;
        };
        let mut edges = corners.iter().zip(corners.iter().cycle().skip(1));
        edges.any(|(a, b)| side(from, to, *a) != side(from, to, *b) && side(*a, *b, from) != side(*a, *b, to))
    }
}

/// Whether a point is to the left of a line.
fn side(from: Point, to: Point, point: Point) -> bool {
    (to[0] - from[0]) * (point[1] - from[1]) > (to[1] - from[1]) * (point[0] - from[0])
}
