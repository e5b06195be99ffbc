//! Finding a free place for each object. Where a place lies is drawn in `draw.rs`; what walls leave free is in `regions.rs`.

use driftworld_spec::Distribution;

use crate::crowd::Crowd;
use crate::draw::{self, Place};
use crate::regions::Ground;
use crate::stream::Chance;

/// How many places are tried for one object.
pub(crate) const TRIES: u32 = 1000;

/// What is known of the ground while objects are placed on it.
pub(crate) struct Plot<'a> {
    ground: &'a Ground,
    agent: [f64; 2],
    everything: Crowd,
    /// For each group the places of its objects.
    groups: Vec<Crowd>,
}

/// What a place must keep clear of, in metres.
#[derive(Clone, Debug)]
pub(crate) struct Margins {
    pub(crate) separation: f64,
    pub(crate) walls: f64,
    pub(crate) agent: f64,
    /// Groups by number, with the distance to keep from each.
    pub(crate) groups: Vec<(usize, f64)>,
}

/// The middle that a placement is relative to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Anchor {
    pub(crate) at: [f64; 2],
    /// Heading in degrees that the placement turns with; 0 leaves it as it is.
    pub(crate) heading: f64,
}

impl Anchor {
    pub(crate) const ORIGIN: Self = Self {
        at: [0.0, 0.0],
        heading: 0.0,
    };

    /// A place relative to the anchor as one of the world.
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

/// What an object is placed by.
pub(crate) struct Request<'a> {
    pub(crate) placement: &'a Distribution,
    pub(crate) margins: &'a Margins,
    pub(crate) anchor: Anchor,
    /// The group's number.
    pub(crate) group: usize,
    /// The object's number around its anchor: lists of places are taken in turn.
    pub(crate) number: u64,
}

/// A condition that a place can break.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Condition {
    Wall,
    Agent,
    Neighbour,
    Own,
    Group,
}

impl Condition {
    const ALL: [Self; 5] = [Self::Wall, Self::Agent, Self::Neighbour, Self::Own, Self::Group];

    fn broken(self) -> &'static str {
        match self {
            Self::Wall => "too near to a wall or outside the arena",
            Self::Agent => "too near to the agent's start",
            Self::Neighbour => "too near to another object",
            Self::Own => "too near to another object of the group",
            Self::Group => "too near to an object of a group to keep out of",
        }
    }

    fn nearest(self) -> &'static str {
        match self {
            Self::Wall => "the nearest wall",
            Self::Agent => "the agent's start",
            Self::Neighbour => "the nearest neighbour",
            Self::Own => "the nearest of its group",
            Self::Group => "the nearest object to keep out of",
        }
    }

    fn advice(self) -> &'static str {
        match self {
            Self::Wall => "move or widen the placement, or lower keep_out.walls",
            Self::Agent => "move or widen the placement, or lower keep_out.agent",
            Self::Neighbour => "lower the count or the separation, or widen the placement",
            Self::Own => "lower the count or the distance of poisson_disc, or widen the placement",
            Self::Group => "lower the distance in keep_out.groups, or widen the placement",
        }
    }
}

/// A condition broken by a place: what it has and what it needs, in metres.
#[derive(Clone, Copy)]
struct Miss {
    condition: Condition,
    has: f64,
    wants: f64,
}

impl<'a> Plot<'a> {
    pub(crate) fn new(ground: &'a Ground, agent: [f64; 2], groups: usize) -> Self {
        Self {
            ground,
            agent,
            everything: Crowd::default(),
            groups: (0..groups).map(|_| Crowd::default()).collect(),
        }
    }

    /// Takes the ground at a place, so that later objects keep their separation from it.
    pub(crate) fn occupy(&mut self, place: [f64; 2]) {
        self.everything.push(place);
    }

    /// The places of a group.
    pub(crate) fn group(&self, number: usize) -> &Crowd {
        &self.groups[number]
    }

    /// A free place for an object, which it takes; else how many were tried, and why none was free.
    pub(crate) fn find(&mut self, request: &Request, chance: &mut Chance) -> Result<[f64; 2], (u32, String)> {
        let tries = if is_certain(request.placement) { 1 } else { TRIES };
        let mut failed = [0_u32; Condition::ALL.len()];
        let mut closest: Option<Miss> = None;
        for _ in 0..tries {
            let Place { at, own_distance } = draw::place(request.placement, request.number, chance);
            let at = request.anchor.world(at);
            match self.miss(at, own_distance, request) {
                None => {
                    self.everything.push(at);
                    self.groups[request.group].push(at);
                    return Ok(at);
                }
                Some(miss) => {
                    failed[miss.condition as usize] += 1;
                    if closest.is_none_or(|closest| miss.wants - miss.has < closest.wants - closest.has) {
                        closest = Some(miss);
                    }
                }
            }
        }
        Err((tries, reason(failed, closest)))
    }

    /// The first condition that a place breaks.
    fn miss(&self, place: [f64; 2], own_distance: f64, request: &Request) -> Option<Miss> {
        let margins = request.margins;
        let wall = self.ground.clearance(place, margins.walls);
        if wall.is_nan() || wall < margins.walls {
            return Some(Miss {
                condition: Condition::Wall,
                has: wall,
                wants: margins.walls,
            });
        }
        let agent = distance(place, self.agent);
        if agent < margins.agent {
            return Some(Miss {
                condition: Condition::Agent,
                has: agent,
                wants: margins.agent,
            });
        }
        if let Some(has) = self.everything.within(place, margins.separation) {
            return Some(Miss {
                condition: Condition::Neighbour,
                has,
                wants: margins.separation,
            });
        }
        if let Some(has) = self.groups[request.group].within(place, own_distance) {
            return Some(Miss {
                condition: Condition::Own,
                has,
                wants: own_distance,
            });
        }
        margins.groups.iter().find_map(|(group, wants)| {
            let has = self.groups[*group].within(place, *wants)?;
            Some(Miss {
                condition: Condition::Group,
                has,
                wants: *wants,
            })
        })
    }
}

/// Whether another try would give the same place.
fn is_certain(placement: &Distribution) -> bool {
    match placement {
        Distribution::Constant { .. } => true,
        Distribution::Grid { jitter, .. } => placement.needs_group() && jitter.unwrap_or(0.0) == 0.0,
        Distribution::Points { .. } => placement.needs_group(),
        _ => false,
    }
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    ((ax - bx) * (ax - bx) + (ay - by) * (ay - by)).sqrt()
}

fn reason(failed: [u32; Condition::ALL.len()], closest: Option<Miss>) -> String {
    let count = |condition: Condition| failed[condition as usize];
    let worst = Condition::ALL
        .into_iter()
        .max_by_key(|condition| count(*condition))
        .unwrap_or(Condition::Wall);
    let counts: Vec<String> = Condition::ALL
        .into_iter()
        .filter(|condition| count(*condition) > 0)
        .map(|condition| {
            let were = if count(condition) == 1 { "was" } else { "were" };
            format!("{} {were} {}", count(condition), condition.broken())
        })
        .collect();
    let miss = closest.map_or_else(String::new, |Miss { condition, has, wants }| {
        format!(
            "; the best was {has:.2} m from {}, expected {wants} m",
            condition.nearest()
        )
    });
    format!("{}{miss}; {}", counts.join(", "), worst.advice())
}
