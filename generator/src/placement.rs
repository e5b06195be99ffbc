//! Finding a free place for each object. Where a place lies is drawn in `draw.rs`; what walls leave free is in `regions.rs`.

use std::collections::HashMap;

use driftworld_spec::Distribution;

use crate::draw;
use crate::regions::Ground;
use crate::stream::Chance;

/// How many places are tried for one object.
pub(crate) const TRIES: u32 = 1000;

/// Side of the cells by which neighbours are found, in metres.
const CELL: f64 = 4.0;

/// What is known of the ground while objects are placed on it.
pub(crate) struct Plot {
    ground: Ground,
    agent: [f64; 2],
    cells: HashMap<[i32; 2], Vec<[f64; 2]>>,
}

/// What a place must keep clear of, in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    pub(crate) separation: f64,
    pub(crate) wall: f64,
    pub(crate) agent: f64,
}

/// The three conditions, in the order in which they are counted.
const CONDITIONS: [(&str, &str, &str); 3] = [
    (
        "too near to a wall or outside the arena",
        "wall",
        "move or widen the placement, or lower wall_margin",
    ),
    (
        "too near to the agent's start",
        "start",
        "move or widen the placement, or lower agent_margin",
    ),
    (
        "too near to another object",
        "neighbour",
        "lower the count or the separation, or widen the placement",
    ),
];

impl Plot {
    pub(crate) fn new(ground: Ground, agent: [f64; 2]) -> Self {
        Self {
            ground,
            agent,
            cells: HashMap::new(),
        }
    }

    /// Takes the ground at a place, so that later objects keep their separation from it.
    pub(crate) fn occupy(&mut self, place: [f64; 2]) {
        self.cells.entry(cell(place)).or_default().push(place);
    }

    /// A free place for an object; else why there is none.
    pub(crate) fn find(
        &mut self,
        placement: &Distribution,
        margins: Margins,
        number: u32,
        chance: &mut Chance,
    ) -> Result<[f64; 2], (u32, String)> {
        let tries = if matches!(placement, Distribution::Points { .. }) {
            1
        } else {
            TRIES
        };
        let mut failed = [0_u32; 3];
        let mut closest: Option<(f64, usize, f64)> = None;
        for _ in 0..tries {
            let place = draw::point(placement, number, chance);
            match self.fault(place, margins) {
                None => {
                    self.occupy(place);
                    return Ok(place);
                }
                Some((condition, has, wants)) => {
                    failed[condition] += 1;
                    if closest.is_none_or(|(miss, ..)| wants - has < miss) {
                        closest = Some((wants - has, condition, has));
                    }
                }
            }
        }
        Err((tries, reason(failed, closest, margins)))
    }

    /// Which condition a place breaks, what it has and what it needs in metres.
    fn fault(&self, place: [f64; 2], margins: Margins) -> Option<(usize, f64, f64)> {
        let wall = self.ground.clearance(place, margins.wall);
        if wall < margins.wall {
            return Some((0, wall, margins.wall));
        }
        let agent = distance(place, self.agent);
        if agent < margins.agent {
            return Some((1, agent, margins.agent));
        }
        let neighbour = self.nearest(place, margins.separation)?;
        Some((2, neighbour, margins.separation))
    }

    /// Distance to the nearest object within `reach`, if there is one.
    fn nearest(&self, place: [f64; 2], reach: f64) -> Option<f64> {
        if reach <= 0.0 {
            return None;
        }
        let span = (reach / CELL).ceil() as i32;
        let [cx, cy] = cell(place);
        let mut least = reach;
        let mut found = false;
        if (2 * i64::from(span) + 1).pow(2) > self.cells.len() as i64 {
            // Fewer cells are taken than lie in reach. The order in which they are seen does not matter to a minimum.
            #[expect(clippy::iter_over_hash_type, reason = "a minimum does not depend on the order")]
            for others in self.cells.values() {
                closer(others, place, &mut least, &mut found);
            }
        } else {
            for x in cx - span..=cx + span {
                for y in cy - span..=cy + span {
                    if let Some(others) = self.cells.get(&[x, y]) {
                        closer(others, place, &mut least, &mut found);
                    }
                }
            }
        }
        found.then_some(least)
    }
}

fn closer(others: &[[f64; 2]], place: [f64; 2], least: &mut f64, found: &mut bool) {
    for other in others {
        let metres = distance(place, *other);
        if metres < *least {
            (*least, *found) = (metres, true);
        }
    }
}

fn cell([x, y]: [f64; 2]) -> [i32; 2] {
    [(x / CELL).floor() as i32, (y / CELL).floor() as i32]
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    ((ax - bx) * (ax - bx) + (ay - by) * (ay - by)).sqrt()
}

fn reason(failed: [u32; 3], closest: Option<(f64, usize, f64)>, margins: Margins) -> String {
    let worst = (0..3).max_by_key(|&condition| failed[condition]).unwrap_or(0);
    let wants = [margins.wall, margins.agent, margins.separation];
    let counts: Vec<String> = (0..3)
        .filter(|&condition| failed[condition] > 0)
        .map(|condition| format!("{} were {}", failed[condition], CONDITIONS[condition].0))
        .collect();
    let miss = closest.map_or_else(String::new, |(_, condition, has)| {
        let (name, wants) = (CONDITIONS[condition].1, wants[condition]);
        format!("; the best was {has:.2} m from the nearest {name}, expected {wants} m")
            .replace("nearest start", "agent's start")
    });
    format!("{}{miss}; {}", counts.join(", "), CONDITIONS[worst].2)
}
