//! Computes the parts of the distance between two sketches of worlds, and passes them to a [`Sink`].

use std::sync::Arc;

use driftworld_spec::Comparison;

use crate::combined::kinds::{Kinds, REWARD_UNIT};
use crate::combined::matching::{POSITION_UNIT, each_match, length, turn};
use crate::combined::sketch::{ObjectFeatures, Sketch};
use crate::combined::weighted_distance::Part;
use crate::combined::weights::Weights;
use crate::layout_shape::LayoutShape;
use crate::scalar::relative_difference;

/// Receives each part: the comparison, the raw difference in the field's unit, and the normalised one.
pub(super) trait Sink {
    fn add(&mut self, comparison: Comparison, raw: f64, normalised: f64);
}

/// Keeps every part.
pub(super) struct Parts(pub(super) Vec<Part>);

impl Sink for Parts {
    fn add(&mut self, comparison: Comparison, raw: f64, normalised: f64) {
        self.0.push(Part {
            normalised,
            ..Part::of(comparison.name(), comparison.element(), comparison.unit(), raw)
        });
    }
}

/// Keeps only the weighted sum.
pub(super) struct Sum<'a> {
    pub(super) weights: &'a Weights,
    pub(super) total: f64,
}

impl Sink for Sum<'_> {
    fn add(&mut self, comparison: Comparison, _: f64, normalised: f64) {
        self.total += self.weights.of(comparison.element()) * normalised;
    }
}

/// Adds all parts of the distance to the sink, element by element.
pub(super) fn compare(a: &Sketch, b: &Sketch, sink: &mut impl Sink) {
    let objects = Objects::of(a, b);
    state(a, b, &objects, sink);
    action(a, b, sink);
    transition(a, b, &objects, sink);
    reward(a, b, &objects, sink);
    observation(a, b, &objects, sink);
}

/// Sums over all objects of two worlds.
#[derive(Default)]
struct Objects {
    /// Number of unmatched objects, and their pay.
    unmatched: f64,
    unmatched_pay: f64,
    /// Sums over matched objects.
    metres: f64,
    turn: f64,
    motion: f64,
    body: f64,
    reward: f64,
    paid_for: f64,
    odds: f64,
    color: f64,
    model: f64,
    scale: f64,
}

impl Objects {
    fn of(a: &Sketch, b: &Sketch) -> Self {
        let mut all = Self::default();
        for (mine, theirs) in a.classes_of_both(b) {
            each_match(mine, theirs, |a, b| match (a, b) {
                (Some(a), Some(b)) => all.add(a, b),
                (Some(unmatched), None) | (None, Some(unmatched)) => {
                    all.unmatched += 1.0;
                    all.unmatched_pay += unmatched.reward.abs();
                }
                (None, None) => {}
            });
        }
        all
    }

    fn add(&mut self, a: &ObjectFeatures, b: &ObjectFeatures) {
        self.metres += a.metres(b);
        self.turn += turn(a.heading, b.heading);
        self.scale += relative_difference(a.scale, b.scale);
        // Objects of one kind differ in nothing else.
        if a.kind == b.kind {
            return;
        }
        let distance = Kinds::with(|kinds| *kinds.distance(a, b));
        self.motion += distance.motion;
        self.body += distance.body;
        self.reward += distance.reward;
        self.paid_for += distance.paid_for;
        self.odds += distance.odds;
        self.color += distance.color;
        self.model += distance.model;
    }
}

fn state(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let metres_moved = objects.metres;
    sink.add(Comparison::PlacesOfObjects, metres_moved, metres_moved / POSITION_UNIT);
    sink.add(Comparison::Unmatched, objects.unmatched, objects.unmatched);
    sink.add(Comparison::HeadingsOfObjects, objects.turn, objects.turn / 180.0);
    let metres = length(a.start, b.start);
    sink.add(Comparison::Start, metres, metres / POSITION_UNIT);
    let turn = turn(a.heading, b.heading);
    sink.add(Comparison::Heading, turn, turn / 180.0);
}

fn action(a: &Sketch, b: &Sketch, sink: &mut impl Sink) {
    add_unnormalised(
        Comparison::ModelOfActions,
        a.action_model.distance(&b.action_model),
        sink,
    );
    add_unnormalised(
        Comparison::SpaceOfActions,
        a.action_space.distance(&b.action_space),
        sink,
    );
    relative(Comparison::LargestSpeed, a.linear_speed, b.linear_speed, sink);
    relative(Comparison::LargestTurnRate, a.angular_speed, b.angular_speed, sink);
}

fn transition(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    add_unnormalised(Comparison::Motion, objects.motion, sink);
    add_unnormalised(Comparison::Bodies, objects.body, sink);
    relative(Comparison::TimeStep, a.time_step, b.time_step, sink);
    relative(Comparison::Width, a.agent_width, b.agent_width, sink);
    add_unnormalised(Comparison::EnergyOfAgent, a.energy.distance(&b.energy), sink);
    let map = f64::from(u8::from(a.map != b.map));
    add_unnormalised(Comparison::MapAndWalls, map + a.walls.distance(&b.walls), sink);
    let layouts = match (&a.layout, &b.layout) {
        (None, None) => 0.0,
        (Some(a), Some(b)) if Arc::ptr_eq(a, b) => 0.0,
        (a, b) => {
            let open = LayoutShape::open();
            a.as_deref().unwrap_or(open).distance(b.as_deref().unwrap_or(open))
        }
    };
    let layouts = layouts + f64::from(u8::from(a.doors != b.doors));
    add_unnormalised(Comparison::Layouts, layouts, sink);
    let sides = a.arena.iter().zip(&b.arena);
    let (raw, normalised) = sides.fold((0.0, 0.0), |(raw, normalised), (a, b)| {
        (raw + (a - b).abs(), normalised + relative_difference(*a, *b))
    });
    sink.add(Comparison::ArenaSize, raw, normalised);
    add_unnormalised(Comparison::Zones, a.zones[0].distance(&b.zones[0]), sink);
}

fn reward(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let rewards = objects.reward + objects.unmatched_pay;
    sink.add(Comparison::Rewards, rewards, rewards / REWARD_UNIT);
    add_unnormalised(Comparison::PaidFor, objects.paid_for, sink);
    add_unnormalised(Comparison::RewardProbabilities, objects.odds, sink);
    add_unnormalised(Comparison::StepReward, (a.step_reward - b.step_reward).abs(), sink);
    add_unnormalised(Comparison::ShapingAndEndings, a.rules.distance(&b.rules), sink);
    add_unnormalised(Comparison::ZonePay, a.zones[1].distance(&b.zones[1]), sink);
    let limits = match (a.limit, b.limit) {
        (Some(a), Some(b)) => relative_difference(a, b),
        (None, None) => 0.0,
        _ => 1.0,
    };
    add_unnormalised(Comparison::Limit, limits, sink);
}

fn observation(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    add_unnormalised(Comparison::ColorsOfObjects, objects.color, sink);
    add_unnormalised(Comparison::UnmatchedLooks, objects.unmatched, sink);
    add_unnormalised(Comparison::ModelsOfObjects, objects.model, sink);
    add_unnormalised(Comparison::SizesOfObjects, objects.scale, sink);
    relative(Comparison::Light, a.light, b.light, sink);
    let distance = a.surroundings.iter().zip(&b.surroundings).map(|(a, b)| a.distance(*b));
    add_unnormalised(Comparison::ColorsOfSurroundings, distance.sum(), sink);
    add_unnormalised(Comparison::ZoneLooks, a.zones[2].distance(&b.zones[2]), sink);
    let picture: f64 = a
        .picture
        .iter()
        .zip(&b.picture)
        .map(|(a, b)| relative_difference(*a, *b))
        .sum();
    add_unnormalised(
        Comparison::CameraAndWeather,
        picture + a.camera.distance(&b.camera),
        sink,
    );
}

/// Adds a number that needs no normalisation.
fn add_unnormalised(comparison: Comparison, number: f64, sink: &mut impl Sink) {
    sink.add(comparison, number, number);
}

/// Adds the difference of two numbers of at least 0, as a share of the larger value: a metric.
fn relative(comparison: Comparison, a: f64, b: f64, sink: &mut impl Sink) {
    let raw = (a - b).abs();
    sink.add(comparison, raw, relative_difference(a, b));
}
