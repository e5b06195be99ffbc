//! Finds a free position for each object. Candidates are drawn in `draw.rs`; the distance to walls is computed in
//! `clearance.rs`.

use std::collections::BTreeSet;

use driftworld_spec::{CellKind, Distribution, Layout, Plan, Turns};
use strum::VariantArray;

use crate::cells::{Cells, FreePlace, Spot};
use crate::clearance::FreeSpace;
use crate::draw::{self, Place};
use crate::spatial_hash::SpatialHash;
use crate::stream::Rng;

/// Maximum number of positions to try for one object. If points are taken in turn and jittered in their cells, this many in the
/// object's own cell, and the same number again in all other cells together.
pub(crate) const MAX_TRIES: u32 = 1000;

/// The context for placing an object: free space, the agent's start, and the objects placed earlier.
pub(crate) struct PlacementContext<'a> {
    free_space: &'a FreeSpace,
    agent: [f64; 2],
    everything: SpatialHash,
    /// For each group, the positions of its objects.
    groups: Vec<SpatialHash>,
    /// Cells and doorways already assigned to objects.
    taken: BTreeSet<Spot>,
    /// Centres of doorways.
    doorways: SpatialHash,
}

/// Minimum clearances of a position, in metres.
#[derive(Clone, Debug)]
pub(crate) struct Margins {
    pub(crate) separation: f64,
    pub(crate) walls: f64,
    pub(crate) agent: f64,
    /// Groups by index, with the minimum distance to each.
    pub(crate) groups: Vec<(usize, f64)>,
}

/// The origin of a placement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Anchor {
    pub(crate) at: [f64; 2],
    /// Heading in degrees by which the placement is rotated; 0 for no rotation.
    pub(crate) heading: f64,
}

impl Anchor {
    pub(crate) const ORIGIN: Self = Self {
        at: [0.0, 0.0],
        heading: 0.0,
    };

    /// Converts a position relative to the anchor into world coordinates.
    fn world(self, [x, y]: [f64; 2]) -> [f64; 2] {
        if self.heading == 0.0 {
            return [self.at[0] + x, self.at[1] + y];
        }
        // Headings grow clockwise.
        let angle = self.heading.to_radians();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        [self.at[0] + x * cos + y * sin, self.at[1] - x * sin + y * cos]
    }
}

/// The inputs for placing one object.
pub(crate) struct Request<'a> {
    pub(crate) placement: &'a Distribution,
    pub(crate) margins: &'a Margins,
    pub(crate) anchor: Anchor,
    /// The group's index.
    pub(crate) group: usize,
    /// Distance in metres from a doorway's centre within which the object would block the doorway; 0 for objects that block
    /// nothing.
    pub(crate) doorway_clearance: f64,
    /// The object's index around its anchor, for lists of points that are taken in turn; see [`Turns`].
    pub(crate) number: u64,
}

/// A condition that a position can fail.
#[derive(Clone, Copy, Debug, PartialEq, strum::VariantArray)]
enum Condition {
    Wall,
    Agent,
    Neighbour,
    Own,
    Group,
    Doorway,
}

impl Condition {
    fn describe_failure(self) -> &'static str {
        match self {
            Self::Wall => "too near to a wall or outside the arena",
            Self::Agent => "too near to the agent's start",
            Self::Neighbour => "too near to another object",
            Self::Own => "too near to another object of the group",
            Self::Group => "too near to an object of a group in keep_out.groups",
            Self::Doorway => "in the way of a doorway",
        }
    }

    fn nearest(self) -> &'static str {
        match self {
            Self::Wall => "the nearest wall",
            Self::Agent => "the agent's start",
            Self::Neighbour => "the nearest neighbour",
            Self::Own => "the nearest of its group",
            Self::Group => "the nearest object of these groups",
            Self::Doorway => "the nearest doorway",
        }
    }

    fn advice(self) -> &'static str {
        match self {
            Self::Wall => "move or widen the placement, or lower keep_out.walls",
            Self::Agent => "move or widen the placement, or lower keep_out.agent",
            Self::Neighbour => "lower the count or the separation, or widen the placement",
            Self::Own => "lower the count or the distance of poisson_disc, or widen the placement",
            Self::Group => "lower the distance in keep_out.groups, or widen the placement",
            Self::Doorway => "lower the count, make the rooms larger, or set \"solid\": false",
        }
    }
}

/// A condition that a position failed, with the distance found and the minimum in metres.
#[derive(Clone, Copy)]
struct Miss {
    condition: Condition,
    found: f64,
    min: f64,
}

impl<'a> PlacementContext<'a> {
    pub(crate) fn new(free_space: &'a FreeSpace, agent: [f64; 2], groups: usize) -> Self {
        let mut doorways = SpatialHash::default();
        let plan = free_space.plan.iter().flat_map(|plan| &plan.doorways);
        plan.for_each(|doorway| doorways.push(doorway.center));
        Self {
            free_space,
            agent,
            doorways,
            everything: SpatialHash::default(),
            groups: (0..groups).map(|_| SpatialHash::default()).collect(),
            taken: BTreeSet::new(),
        }
    }

    /// Marks a position as taken, so that later objects keep their separation from it.
    pub(crate) fn occupy(&mut self, place: [f64; 2]) {
        self.everything.push(place);
    }

    /// The layout's plan.
    pub(crate) fn plan(&self) -> Option<&'a Plan> {
        self.free_space.plan.as_deref()
    }

    /// Whether a position has these clearances in metres: `walls` from walls, `others` from the objects placed so far and the
    /// agent's start.
    pub(crate) fn is_clear(&self, place: [f64; 2], walls: f64, others: f64) -> bool {
        self.free_space.clearance(place, walls) >= walls
            && distance(place, self.agent) >= others
            && self.everything.within(place, others).is_none()
    }

    /// The positions of a group.
    pub(crate) fn group(&self, number: usize) -> &SpatialHash {
        &self.groups[number]
    }

    /// Finds and takes a free position for an object; otherwise returns the number of tries, and why no position was free.
    ///
    /// If the points of a `points` or `grid` are taken in turn, `turns` tracks the points taken by earlier objects around the
    /// same anchor.
    pub(crate) fn find(
        &mut self,
        request: &Request,
        turns: Option<&mut Turns>,
        rng: &mut Rng,
    ) -> Result<[f64; 2], (u32, String)> {
        if let Some(turns) = turns {
            return self.find_in_turn(request, turns, rng);
        }
        let mut tried = TryStatistics::default();
        let tries = if matches!(request.placement, Distribution::Constant { .. }) {
            1
        } else {
            MAX_TRIES
        };
        let is_mixture = request.placement.needs_group();
        for turn in 0..tries {
            // In a mixture, a list moves on from the object's own point once half of the tries have failed.
            let offset = turn.saturating_sub(MAX_TRIES / 2) * u32::from(is_mixture);
            if let Some(at) = self.try_at(request, request.number + u64::from(offset), rng, &mut tried) {
                return Ok(at);
            }
        }
        Err(tried.failure())
    }

    /// The cells that fit a distribution of cells, for a group of this name; otherwise the reason why none fits.
    pub(crate) fn cells(
        &self,
        layout: Option<&Layout>,
        asked: &Distribution,
        group: &str,
    ) -> Result<Cells<'a>, String> {
        let mut cells = Cells::find(self.free_space.plan.as_deref(), layout, asked, group, self.agent)?;
        cells.exclude(&self.taken);
        Ok(cells)
    }

    /// Whether a placement allows objects to block doorways: by its kind of cells, by letters, or because only cells in
    /// doorways are left. Placements outside cells are given by coordinates in metres, which allows it too.
    pub(crate) fn allows_doorways(&self, placement: &Distribution, cells: Option<&Cells>, clearance: f64) -> bool {
        match placement {
            Distribution::Cells {
                kind, letter, of_group, ..
            } => {
                let is_asked = *kind == CellKind::Doorway || letter.is_some() || *of_group;
                let is_in_doorway = |middle| self.doorways.within(middle, clearance).is_some();
                is_asked || cells.is_none_or(|cells| cells.all_centers(is_in_doorway))
            }
            _ => true,
        }
    }

    /// Like [`PlacementContext::find`], in a cell of a layout. The centre of a cell never counts as too near to a wall.
    pub(crate) fn find_in_cells(
        &mut self,
        request: &Request,
        cells: &mut Cells,
        rng: &mut Rng,
    ) -> Result<FreePlace, (u32, String)> {
        let mut tried = TryStatistics::default();
        let mut margins = request.margins.clone();
        let found = cells.take(rng, |place, middle| {
            let room = self.free_space.clearance(middle, request.margins.walls).max(0.0);
            margins.walls = room.min(request.margins.walls);
            let request = Request {
                margins: &margins,
                ..*request
            };
            let missed = self.miss(place, 0.0, &request);
            missed.is_none_or(|miss| {
                tried.failed[miss.condition as usize] += 1;
                false
            })
        });
        match found {
            Ok(found) => {
                self.everything.push(found.place);
                self.groups[request.group].push(found.place);
                self.taken.extend(found.spot);
                Ok(found)
            }
            Err((tries, asked)) if tried.failed.iter().all(|count| *count == 0) => {
                Err((tries, format!("{asked}; lower the count, or relax the request")))
            }
            Err((tries, asked)) => Err((tries, format!("{asked}; {}", tried.failure().1))),
        }
    }

    /// Like [`PlacementContext::find`], if points are taken in turn: tries the object's own point, then the following ones.
    fn find_in_turn(&mut self, request: &Request, turns: &mut Turns, rng: &mut Rng) -> Result<[f64; 2], (u32, String)> {
        let is_jittered = matches!(request.placement, Distribution::Grid { jitter, .. } if jitter.unwrap_or(0.0) > 0.0);
        let others = request.placement.num_turns().unwrap_or(1).clamp(2, MAX_TRIES as usize) as u32 - 1;
        let mut tried = TryStatistics::default();
        let found = turns.candidates(request.number).enumerate().find_map(|(rank, place)| {
            let tries = match (is_jittered, rank) {
                (false, _) => 1,
                (true, 0) => MAX_TRIES,
                (true, _) => MAX_TRIES / others,
            };
            let at = (0..tries).find_map(|_| self.try_at(request, place as u64, rng, &mut tried))?;
            Some((place, at))
        });
        let Some((place, at)) = found else {
            return Err(tried.failure());
        };
        turns.take(request.number, place);
        Ok(at)
    }

    /// Draws a position and takes it if it is free; `number` is the index of the point, if points are taken in turn.
    fn try_at(&mut self, request: &Request, number: u64, rng: &mut Rng, tried: &mut TryStatistics) -> Option<[f64; 2]> {
        let Place { at, own_distance } = draw::place(request.placement, number, rng);
        let at = request.anchor.world(at);
        let Some(miss) = self.miss(at, own_distance, request) else {
            self.everything.push(at);
            self.groups[request.group].push(at);
            return Some(at);
        };
        tried.failed[miss.condition as usize] += 1;
        if tried
            .closest
            .is_none_or(|closest| miss.min - miss.found < closest.min - closest.found)
        {
            tried.closest = Some(miss);
        }
        None
    }

    /// The first condition that a position fails.
    fn miss(&self, place: [f64; 2], own_distance: f64, request: &Request) -> Option<Miss> {
        let margins = request.margins;
        let miss = |condition, min: f64, found: Option<f64>| found.map(|found| Miss { condition, found, min });
        let wall = self.free_space.clearance(place, margins.walls);
        let is_at_wall = wall.is_nan() || wall < margins.walls;
        let agent = || Some(distance(place, self.agent)).filter(|agent| *agent < margins.agent);
        let everything = || self.everything.within(place, margins.separation);
        let own = || self.groups[request.group].within(place, own_distance);
        let of_group = |group: usize, min: f64| miss(Condition::Group, min, self.groups[group].within(place, min));
        miss(Condition::Wall, margins.walls, is_at_wall.then_some(wall))
            .or_else(|| miss(Condition::Agent, margins.agent, agent()))
            .or_else(|| miss(Condition::Neighbour, margins.separation, everything()))
            .or_else(|| miss(Condition::Own, own_distance, own()))
            .or_else(|| margins.groups.iter().find_map(|(group, min)| of_group(*group, *min)))
            .or_else(|| {
                miss(
                    Condition::Doorway,
                    request.doorway_clearance,
                    self.doorways.within(place, request.doorway_clearance),
                )
            })
    }
}

/// Statistics of the positions tried.
#[derive(Default)]
struct TryStatistics {
    failed: [u32; Condition::VARIANTS.len()],
    closest: Option<Miss>,
}

impl TryStatistics {
    /// The number of tries, and why no position was free.
    fn failure(self) -> (u32, String) {
        let tries = self.failed.iter().sum();
        if tries == 0 {
            // This happens only if points are taken in turn and all are already taken.
            let reason = "every place in the list is taken; add places, or lower the count".to_owned();
            return (tries, reason);
        }
        (tries, reason(self.failed, self.closest))
    }
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    ((ax - bx) * (ax - bx) + (ay - by) * (ay - by)).sqrt()
}

fn reason(failed: [u32; Condition::VARIANTS.len()], closest: Option<Miss>) -> String {
    let count = |condition: Condition| failed[condition as usize];
    let worst = Condition::VARIANTS
        .iter()
        .copied()
        .max_by_key(|condition| count(*condition))
        .unwrap_or(Condition::Wall);
    let counts: Vec<String> = Condition::VARIANTS
        .iter()
        .copied()
        .filter(|condition| count(*condition) > 0)
        .map(|condition| {
            let were = if count(condition) == 1 { "was" } else { "were" };
            format!("{} {were} {}", count(condition), condition.describe_failure())
        })
        .collect();
    let miss = closest.map_or_else(String::new, |Miss { condition, found, min }| {
        format!(
            "; the best was {found:.2} m from {}, expected {min} m",
            condition.nearest()
        )
    });
    format!("{}{miss}; {}", counts.join(", "), worst.advice())
}
