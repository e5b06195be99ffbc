//! Finds the cells of a layout that fit a request, and assigns them to objects and the agent.

use std::collections::BTreeSet;

use driftworld_spec::{CellKind, CellRoom, Distribution, Doorway, Layout, Legend, Plan};

use crate::stream::Rng;

/// Number of cells to try at random before going through them one by one.
const RANDOM_TRIES: usize = 32;

/// Number of positions to try in a cell with jitter; the last is the centre.
const TRIES_IN_CELL: usize = 8;

/// A cell or a doorway of a plan, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Spot {
    Cell(usize),
    Doorway(usize),
}

/// A position where something can be placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FreePlace {
    pub(crate) place: [f64; 2],
    /// The cell or doorway that it occupies, if one was requested.
    pub(crate) spot: Option<Spot>,
    /// Heading in degrees; only in a doorway.
    pub(crate) heading: Option<f64>,
}

/// The cells or doorways that fit a request, and which of them are taken.
pub(crate) struct Cells<'a> {
    plan: &'a Plan,
    fitting: Vec<FreePlace>,
    jitter: f64,
    taken: BTreeSet<usize>,
    /// The request and the number of fitting cells, for messages.
    asked: String,
}

impl<'a> Cells<'a> {
    /// The cells of a layout that fit a distribution of cells, for a group of this name and an agent that starts at this
    /// position; otherwise the reason why none fits.
    pub(crate) fn find(
        plan: Option<&'a Plan>,
        layout: Option<&Layout>,
        distribution: &Distribution,
        group: &str,
        agent: [f64; 2],
    ) -> Result<Self, String> {
        let (Some(plan), Some(layout)) = (plan.filter(|plan| !plan.cells.is_empty()), layout) else {
            return Err("the world's layout has no cells; use a maze, rooms or a text".to_owned());
        };
        let Distribution::Cells {
            kind,
            letter,
            of_group,
            room,
            walk,
            jitter,
        } = distribution
        else {
            unreachable!("callers pass distributions of cells")
        };
        let start = plan.cell_at(agent);
        if start.is_none() && (room.is_some() || walk.is_some()) {
            return Err(format!(
                "the agent starts at {agent:?}, which lies in no cell of the layout"
            ));
        }
        let metres = start
            .filter(|_| walk.is_some())
            .map(|start| plan.walking_distances(start));
        let own_room = start.map(|start| plan.cells[start].room);
        let is_own = |letter: char| matches!(layout.meaning(letter), Some(Legend::Group(name)) if name == group);
        let fits = |index: &usize, rooms: [u32; 2]| {
            let cell = &plan.cells[*index];
            let by_letter = letter
                .as_ref()
                .is_none_or(|letters| cell.letter.is_some_and(|own| letters.contains(own)));
            let by_group = !of_group || cell.letter.is_some_and(is_own);
            let by_room = room.is_none_or(|room| {
                let is_own = rooms.iter().any(|room| own_room == Some(*room));
                (room == CellRoom::SameAsAgent) == is_own
            });
            let by_walk = metres.as_ref().zip(*walk).is_none_or(|(metres, [least, most])| {
                // Tolerates rounding: a path of 4 cells of 2.5 m counts as 10 m.
                (least - 1e-6..=most + 1e-6).contains(&metres[*index])
            });
            by_letter && by_group && by_room && by_walk
        };
        let is_kind = |index: &usize| kind.has(plan.cells[*index].open_sides());
        let fitting: Vec<FreePlace> = if *kind == CellKind::Doorway {
            let doorways = plan.doorways.iter().enumerate();
            let fits = |(_, doorway): &(usize, &Doorway)| {
                let cell = plan.cell_at(doorway.center);
                cell.is_some_and(|cell| fits(&cell, doorway.rooms))
            };
            let found = |(index, doorway): (usize, &Doorway)| FreePlace {
                place: doorway.center,
                spot: Some(Spot::Doorway(index)),
                heading: Some(doorway.heading),
            };
            doorways.filter(fits).map(found).collect()
        } else {
            let cells = (0..plan.cells.len()).filter(is_kind);
            let cells = cells.filter(|index| fits(index, [plan.cells[*index].room; 2]));
            let found = |index: usize| FreePlace {
                place: plan.cells[index].center,
                spot: Some(Spot::Cell(index)),
                heading: None,
            };
            cells.map(found).collect()
        };
        let by_letter = letter.as_ref().map(|letters| format!(" at the letters {letters:?}"));
        let by_group = of_group.then(|| format!(" at the letters of the group {group:?}"));
        let by_room = room.map(|room| match room {
            CellRoom::OtherThanAgent => " in a room other than the agent's".to_owned(),
            CellRoom::SameAsAgent => " in the agent's room".to_owned(),
        });
        let by_walk = walk.map(|[least, most]| format!(" at a walking distance of {least} to {most} m from the agent"));
        let conditions: String = [by_letter, by_group, by_room, by_walk].into_iter().flatten().collect();
        let asked = format!("{}{conditions}", kind.describe());
        let (all, count) = (plan.cells.len(), fitting.len());
        let asked = if *kind == CellKind::Doorway {
            format!("of {} doorways, {count} are {asked}", plan.doorways.len())
        } else {
            let of_kind = (0..all).filter(is_kind).count();
            let names_kind = *kind != CellKind::Any && !conditions.is_empty() && of_kind > 0;
            let of_them = if names_kind {
                format!(", {of_kind} of them {}", kind.describe())
            } else {
                String::new()
            };
            format!("of {all} cells{of_them}, {count} are {asked}")
        };
        if fitting.is_empty() {
            return Err(format!("{asked}; relax the request, or change the layout"));
        }
        Ok(Self {
            plan,
            fitting,
            jitter: jitter.filter(|_| *kind != CellKind::Doorway).unwrap_or(0.0),
            taken: BTreeSet::new(),
            asked,
        })
    }

    /// Excludes the cells that are already taken.
    pub(crate) fn exclude(&mut self, taken: &BTreeSet<Spot>) {
        let fitting = self.fitting.iter().enumerate();
        let excluded = fitting.filter(|(_, found)| found.spot.is_some_and(|spot| taken.contains(&spot)));
        self.taken.extend(excluded.map(|(index, _)| index));
    }

    /// Excludes cells marked with letters in a text layout, unless there are no others.
    pub(crate) fn exclude_letters(&mut self) {
        let has_letter =
            |found: &FreePlace| matches!(found.spot, Some(Spot::Cell(cell)) if self.plan.cells[cell].letter.is_some());
        let plain: Vec<FreePlace> = self
            .fitting
            .iter()
            .filter(|found| !has_letter(found))
            .copied()
            .collect();
        if !plain.is_empty() {
            self.fitting = plain;
        }
    }

    /// Whether the centre of every free fitting cell satisfies a condition.
    pub(crate) fn all_centers(&self, is: impl Fn([f64; 2]) -> bool) -> bool {
        let fitting = self.fitting.iter().enumerate();
        let mut free = fitting.filter(|(index, _)| !self.taken.contains(index));
        free.all(|(_, found)| is(found.place))
    }

    /// Takes a free cell and returns a position in it that `is_free` accepts: tries cells at random, then all in turn.
    /// `is_free` gets a position and the centre of its cell. On failure, returns the number of tries and the request.
    pub(crate) fn take(
        &mut self,
        rng: &mut Rng,
        mut is_free: impl FnMut([f64; 2], [f64; 2]) -> bool,
    ) -> Result<FreePlace, (u32, String)> {
        let count = self.fitting.len();
        let mut tries = 0;
        let mut first = 0;
        for turn in 0..RANDOM_TRIES + count {
            if turn < RANDOM_TRIES {
                first = ((rng.unit() * count as f64) as usize).min(count - 1);
            }
            let index = (first + turn.saturating_sub(RANDOM_TRIES - 1)) % count;
            if self.taken.contains(&index) {
                continue;
            }
            let found = self.fitting[index];
            let middle = found.place;
            let places = if self.jitter > 0.0 { TRIES_IN_CELL } else { 1 };
            for left in (0..places).rev() {
                let jittered = |axis: usize, rng: &mut Rng| {
                    let share = if left > 0 {
                        self.jitter * (rng.unit() - 0.5)
                    } else {
                        0.0
                    };
                    middle[axis] + share * self.plan.cell[axis]
                };
                let place = [jittered(0, rng), jittered(1, rng)];
                tries += 1;
                if is_free(place, middle) {
                    self.taken.insert(index);
                    return Ok(FreePlace { place, ..found });
                }
            }
        }
        let taken = self.taken.len();
        Err((tries, format!("{}, and {taken} of them are taken", self.asked)))
    }
}
