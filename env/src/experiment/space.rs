//! Compares the spaces of states, actions and observations of two worlds.

use std::collections::BTreeMap;

use driftworld_spec::{ActionModel, AgentParams, World};

use crate::sim::{Action, Difference, Intent};

/// The kind of an object in the state space: its class, and the tag that rules use.
pub(super) type Kind = (String, Option<String>);

/// The kind of an object.
pub(super) fn kind(object: &driftworld_spec::Object) -> Kind {
    (object.class.clone(), object.tag.clone())
}

/// Number of objects of each kind in a world.
pub(super) fn count(world: &World) -> BTreeMap<Kind, usize> {
    let mut counts = BTreeMap::new();
    for object in &world.objects {
        *counts.entry(kind(object)).or_insert(0) += 1;
    }
    counts
}

/// A kind's name: its tag if it has one, otherwise its class.
pub(super) fn display_name((class, tag): &Kind) -> &str {
    tag.as_deref().unwrap_or(class)
}

/// The minimum and maximum number of objects of each kind over a task's worlds.
#[derive(Debug, Default)]
pub(super) struct StateSpace {
    counts: BTreeMap<Kind, [usize; 2]>,
}

impl StateSpace {
    pub(super) fn of<'a>(worlds: impl Iterator<Item = &'a World> + Clone) -> Self {
        let counts_per_world: Vec<_> = worlds.map(count).collect();
        let mut counts: BTreeMap<Kind, [usize; 2]> = BTreeMap::new();
        for kind in counts_per_world.iter().flat_map(BTreeMap::keys) {
            if !counts.contains_key(kind) {
                let own = || {
                    counts_per_world
                        .iter()
                        .map(|counts| counts.get(kind).copied().unwrap_or(0))
                };
                counts.insert(kind.clone(), [own().min().unwrap_or(0), own().max().unwrap_or(0)]);
            }
        }
        Self { counts }
    }

    fn range(&self, kind: &Kind) -> [usize; 2] {
        self.counts.get(kind).copied().unwrap_or([0, 0])
    }

    /// Whether both or neither have objects of this kind, and their ranges overlap.
    pub(super) fn shares_counts(&self, other: &Self, kind: &Kind) -> bool {
        let ([low, high], [other_low, other_high]) = (self.range(kind), other.range(kind));
        (high > 0) == (other_high > 0) && low <= other_high && other_low <= high
    }

    /// A kind that only one of the two has, or whose ranges do not overlap.
    pub(super) fn difference(&self, other: &Self) -> Option<Difference> {
        let kinds = self.counts.keys().chain(other.counts.keys());
        let found = kinds.into_iter().find(|kind| !self.shares_counts(other, kind))?;
        let [a, b] = [self, other].map(|space| {
            let [low, high] = space.range(found);
            if low == high {
                low.to_string()
            } else {
                format!("{low} to {high}")
            }
        });
        let what = format!("the number of {} objects over all worlds", display_name(found));
        Some(Difference { what, own: a, other: b })
    }
}

/// A difference in the ground that objects can occupy: the arena's size, the regions, or the walls.
pub(super) fn ground_difference(a: &World, b: &World) -> Option<Difference> {
    let (own, other) = (&a.environment_params, &b.environment_params);
    let walls = |world: &World| -> Vec<Vec<[f64; 2]>> {
        let regions = world.environment_params.regions().len();
        world.obstacles().skip(regions).map(<[_]>::to_vec).collect()
    };
    Difference::of(
        "the size of the arena in metres",
        &own.arena_size(),
        &other.arena_size(),
    )
    .or_else(|| Difference::of("the regions that cannot be entered", &own.regions(), &other.regions()))
    .or_else(|| Difference::of("the walls", &walls(a), &walls(b)))
}

/// A difference in the available actions, or in the commands that they give to the agent's body.
pub(super) fn action_difference(a: &World, b: &World) -> Option<Difference> {
    let space = |agent: &AgentParams| match agent.num_actions() {
        Some(rows) => format!("{rows} rows of a table"),
        None => "three numbers".to_owned(),
    };
    let (own, other) = (&a.agent_params, &b.agent_params);
    let effect = |agent: &AgentParams| match agent.action_model {
        ActionModel::OnRails => "ignored, and the agent tours",
        ActionModel::None => "ignored",
        ActionModel::ByVelocity | ActionModel::ByWaypoint => "obeyed",
    };
    Difference::of("the form of an action", &space(own), &space(other))
        .or_else(|| Difference::of("the effect of an action", &effect(own), &effect(other)))
        .or_else(|| {
            let mut actions_to_test = actions_to_test(own).into_iter();
            actions_to_test.find_map(|action| {
                Difference::of(
                    format!("the body's motion in a second of {}", describe(action)),
                    &intent_text(a, action),
                    &intent_text(b, action),
                )
            })
        })
}

/// Actions to test: all rows of a table, or numbers within and beyond the agents' limits.
fn actions_to_test(agent: &AgentParams) -> Vec<Action> {
    /// From small values to beyond the limit of the fastest agent.
    const NUMBERS: [f64; 9] = [-4000.0, -70.0, -7.0, -0.4, 0.0, 0.4, 7.0, 70.0, 4000.0];
    if let Some(rows) = agent.num_actions() {
        return (0..rows).map(Action::Discrete).collect();
    }
    let mut actions = Vec::new();
    for a in NUMBERS {
        for b in NUMBERS {
            for c in [0.0, 0.7, 90.0] {
                actions.push(Action::Continuous([a, b, c]));
            }
        }
    }
    actions
}

fn describe(action: Action) -> String {
    match action {
        Action::Continuous([a, b, c]) => format!("the action [{a}, {b}, {c}]"),
        Action::Discrete(row) => format!("action number {row}"),
    }
}

/// The command that an action gives to the agent's body for one second, as text; `None` if the world has no such action.
fn intent_text(world: &World, action: Action) -> Option<String> {
    let per_second = AgentParams {
        time_step: 1.0,
        ..world.agent_params.clone()
    };
    let numbers = action.numbers(world).ok()?;
    let intent = Intent::new(per_second.action_model, numbers, &per_second);
    let goes = match intent.towards {
        Some(([x, y], metres)) => format!("goes up to {metres} m towards ({x}, {y})"),
        None => format!("goes {} m", intent.ahead),
    };
    let interacts = if intent.interact { ", interacts" } else { "" };
    Some(format!("turns {} degrees, {goes}{interacts}", intent.turn_deg))
}

/// A difference in the form of observations.
pub(super) fn observation_difference(a: &World, b: &World, is_chosen: bool) -> Option<Difference> {
    let (own, other) = (&a.agent_params, &b.agent_params);
    let modalities = || Difference::of("the images of an observation", &own.modalities, &other.modalities);
    (!is_chosen)
        .then(modalities)
        .flatten()
        .or_else(|| {
            Difference::of(
                "the images' width and height",
                &own.picture_size(),
                &other.picture_size(),
            )
        })
        .or_else(|| {
            Difference::of(
                "the features of the state vector",
                &own.state_features,
                &other.state_features,
            )
        })
        .or_else(|| {
            Difference::of(
                "the length of the instruction",
                &own.instruction.len(),
                &other.instruction.len(),
            )
        })
}
