//! Maps drawn with letters by other programs, read as worlds with a text layout: DeepMind Lab's text levels in `dmlab.rs`,
//! MiniGrid's grids in `minigrid.rs`. What is not known is left out, with a warning.

mod dmlab;
mod minigrid;

use std::collections::BTreeMap;

use crate::error::Problem;
use crate::layout::{Layout, Legend};
use crate::warning::Warning;
use crate::world::{Door, EndCondition, Object, Stimulus, World, WorldDraft, Zone, ZoneEnd};
use crate::{Color, SpecError};

/// What stands for a cell that was not understood: floor.
const FLOOR: char = ' ';

/// A map as it is read: letters of a layout, and what stands on them.
struct Reader<'a> {
    name: &'a str,
    /// Side of a cell in metres.
    cell: f64,
    rows: Vec<Vec<char>>,
    legend: BTreeMap<String, Legend>,
    /// Objects, with the column and row of their cells.
    objects: Vec<(Object, [usize; 2])>,
    /// Where the agent may start: column, row, and heading in degrees.
    starts: Vec<([usize; 2], f64)>,
    /// Doors, each with its colour if it has one, and column and row of its cell.
    doors: Vec<(Door, Option<Color>, [usize; 2])>,
    /// Cells whose floor ends the episode as a failure: column and row.
    lava: Vec<[usize; 2]>,
    /// What is not known: how often it stands there, and line and column of the first.
    unknown: BTreeMap<String, (usize, [usize; 2])>,
    warnings: Vec<Warning>,
}

impl<'a> Reader<'a> {
    fn new(name: &'a str, cell: f64) -> Self {
        Self {
            name,
            cell,
            rows: Vec::new(),
            legend: BTreeMap::new(),
            objects: Vec::new(),
            starts: Vec::new(),
            doors: Vec::new(),
            lava: Vec::new(),
            unknown: BTreeMap::new(),
            warnings: Vec::new(),
        }
    }

    /// Says what did not pass; `line` and `column` count from 1, and are 0 where it is about the whole.
    fn warn(&mut self, [line, column]: [usize; 2], text: impl Into<String>) {
        self.warnings.push(Warning {
            name: self.name.to_owned(),
            pointer: "/environment_params/layout/text".to_owned(),
            line,
            column,
            text: text.into(),
        });
    }

    /// Counts what is not known, to be said once for all its places.
    fn do_not_know(&mut self, what: String, place: [usize; 2]) {
        self.unknown.entry(what).or_insert((0, place)).0 += 1;
    }

    fn warn_of_unknown(&mut self) {
        let mut unknown: Vec<_> = std::mem::take(&mut self.unknown).into_iter().collect();
        unknown.sort_by_key(|(_, (_, place))| *place);
        for (what, (count, place)) in unknown {
            let times = if count > 1 {
                format!(" ({count} of it, this one first)")
            } else {
                String::new()
            };
            self.warn(place, format!("{what} is not known{times}; it is read as floor"));
        }
    }

    /// A door in a doorway, for which a letter stands.
    fn put_door(&mut self, letter: char, door: Door, color: Option<&str>, at: [usize; 2]) {
        self.legend.insert(letter.to_string(), Legend::Doorway);
        self.doors.push((door, color.and_then(Color::from_name), at));
    }

    /// An object of a group at a cell. Hands back the letter that stands for the group: the one that is wanted, or another if that
    /// stands for another group.
    fn put(&mut self, letter: char, object: Object, at: [usize; 2]) -> char {
        let meant = Legend::Group(object.tag.clone().unwrap_or_default());
        self.objects.push((object, at));
        let others = letter.to_lowercase().chain('1'..='9');
        let is_free = |one: &char| self.legend.get(&one.to_string()).is_none_or(|known| *known == meant);
        let own = std::iter::once(letter).chain(others).find(is_free).unwrap_or(letter);
        self.legend.insert(own.to_string(), meant);
        own
    }

    /// Refuses a text of which more is unknown than known: it is no map.
    fn expect_map(&self, expected: &str) -> Result<(), SpecError> {
        let unknown: usize = self.unknown.values().map(|(count, _)| count).sum();
        let known = self.rows.iter().flatten().filter(|letter| **letter != FLOOR).count();
        let Some((what, (_, [line, column]))) = self.unknown.iter().min_by_key(|(_, (_, place))| *place) else {
            return Ok(());
        };
        if unknown <= known {
            return Ok(());
        }
        let all = unknown + known;
        let found = format!("{unknown} of {all} signs that are not known, {what} first");
        let mut problem = Problem::new("spec/text-map", "", found, expected.to_owned());
        (problem.line, problem.column) = (*line, *column);
        Err(SpecError::Document {
            name: self.name.to_owned(),
            problems: vec![problem],
            more: false,
        })
    }

    /// The zones of lava: one for each stretch of cells in a row.
    fn zones(&self) -> Vec<Zone> {
        let mut stretches: Vec<[[usize; 2]; 2]> = Vec::new();
        for &at in &self.lava {
            match stretches.last_mut() {
                Some([_, last]) if [last[0] + 1, last[1]] == at => *last = at,
                _ => stretches.push([at, at]),
            }
        }
        let half = self.cell / 2.0;
        let zone = |[first, last]: [[usize; 2]; 2]| {
            let ([west, y], [east, _]) = (self.place(first), self.place(last));
            let [low, high] = [[west - half, y - half], [east + half, y + half]];
            let mut zone = Zone::polygon(vec![low, [high[0], low[1]], high, [low[0], high[1]]]);
            zone.name = Some("lava".to_owned());
            (zone.ends, zone.color) = (Some(ZoneEnd::Failure), Color::from_name("orangered"));
            zone
        };
        stretches.into_iter().map(zone).collect()
    }

    /// The middle of a cell in metres.
    fn place(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        let columns = self.rows.first().map_or(0, Vec::len) as f64;
        let rows = self.rows.len() as f64;
        [
            (column as f64 + 0.5 - columns / 2.0) * self.cell,
            (rows / 2.0 - 0.5 - row as f64) * self.cell,
        ]
    }

    /// The world of what was read; lines that are too short are filled up with walls.
    fn world(mut self) -> Result<(World, Vec<Warning>), SpecError> {
        self.warn_of_unknown();
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        self.rows.iter_mut().for_each(|row| row.resize(columns, '#'));
        if self.starts.is_empty() {
            self.warn(
                [0, 0],
                "nothing says where the agent starts; it starts in the first free cell",
            );
            let taken = |at: [usize; 2]| self.objects.iter().any(|(_, place)| *place == at);
            let cells = self.rows.iter().enumerate();
            let cells = cells.flat_map(|(row, letters)| {
                letters
                    .iter()
                    .enumerate()
                    .map(move |(column, letter)| ([column, row], *letter))
            });
            let free = cells
                .filter(|(at, letter)| !['#', '*'].contains(letter) && !taken(*at) && !self.lava.contains(at))
                .map(|(at, _)| at)
                .next();
            self.starts.extend(free.map(|at| (at, 0.0)));
        } else if self.starts.len() > 1 {
            let count = self.starts.len();
            self.warn(
                [0, 0],
                format!("of {count} places where the agent may start, it starts in the first"),
            );
        }
        let mut draft = WorldDraft::default();
        let used: Vec<char> = self.rows.iter().flatten().copied().collect();
        let legend = self.legend.clone();
        let layout = Layout {
            text: Some(self.rows.iter().map(|row| row.iter().collect()).collect()),
            cell: Some(self.cell),
            height: Some(self.cell.min(4.0)),
            legend: legend
                .into_iter()
                .filter(|(letter, _)| used.iter().any(|other| letter.chars().eq([*other])))
                .collect(),
            ..Layout::default()
        };
        // What fits through a cell in the other program fits here.
        draft.agent_params.agent_width = (self.cell / 3.0).min(1.0);
        if let Some((start, heading)) = self.starts.first() {
            draft.agent_params.coordinates = self.place(*start);
            draft.agent_params.heading = *heading;
        }
        let has = |tag: &str| {
            self.objects
                .iter()
                .any(|(object, _)| object.tag.as_deref() == Some(tag))
        };
        if has("goal") {
            draft.rules.success = vec![EndCondition::Touch("goal".to_owned())];
        }
        for (object, at) in &self.objects {
            let coordinates = self.place(*at);
            draft.objects.push(Object {
                coordinates,
                ..object.clone()
            });
        }
        // The agent carries one thing at a time, as in MiniGrid.
        let is_carried = |object: &Object| object.portable.is_some();
        draft.agent_params.carry_limit = u32::from(draft.objects.iter().any(is_carried));
        draft.objects.extend(self.doors_in(&layout));
        draft.environment_params.zones = self.zones();
        draft.environment_params.layout = Some(layout);
        match draft.check() {
            Ok(world) => Ok((world, self.warnings)),
            // They are about the text, not about a world that nobody has seen.
            Err(SpecError::Document { problems, more, .. }) => Err(SpecError::Document {
                name: self.name.to_owned(),
                problems,
                more,
            }),
            Err(other) => Err(other),
        }
    }

    /// The doors, each across its doorway.
    fn doors_in(&self, layout: &Layout) -> Vec<Object> {
        let doorways = if self.doors.is_empty() {
            Vec::new()
        } else {
            layout.plan(0).doorways.clone()
        };
        let door = |(door, color, at): &(Door, Option<Color>, [usize; 2])| {
            let coordinates = self.place(*at);
            let near = |center: [f64; 2]| {
                [0, 1]
                    .into_iter()
                    .all(|axis| (center[axis] - coordinates[axis]).abs() < self.cell / 2.0)
            };
            let doorway = doorways.iter().find(|doorway| near(doorway.center));
            Object {
                heading: doorway.map_or(0.0, |doorway| doorway.heading),
                // The model is 1 m wide.
                scale: doorway.map_or(self.cell, |doorway| doorway.width),
                color: *color,
                tag: Some("door".to_owned()),
                door: Some(door.clone()),
                ..Object::new("door", coordinates)
            }
        };
        self.doors.iter().map(door).collect()
    }
}

/// An object of a class and colour that the agent passes through, of a group.
fn thing(class: &str, color: &str, group: &str) -> Object {
    Object {
        color: Color::from_name(color),
        solid: false,
        tag: Some(group.to_owned()),
        ..Object::new(class, [0.0, 0.0])
    }
}

/// The same, which pays once when the agent comes to it, and is gone then.
fn pays(object: Object, reward: f64) -> Object {
    Object {
        reward,
        reward_once_stimulus: vec![Stimulus::AgentCollide],
        destroy_stimulus: vec![Stimulus::AgentCollide],
        ..object
    }
}
