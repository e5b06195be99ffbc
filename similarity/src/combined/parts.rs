//! Computes the parts of the distance between two sketches of worlds, and passes them to a [`Sink`].

use std::sync::Arc;

use driftworld_spec::Comparison;

use crate::combined::kinds::Kinds;
use crate::combined::matching::{UNIT_OF_PLACE, UNIT_OF_REWARD, each_match};
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
    alone: f64,
    alone_pays: f64,
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
                (Some(alone), None) | (None, Some(alone)) => {
                    all.alone += 1.0;
                    all.alone_pays += alone.reward.abs();
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
        // Everything else is equal.
        if a.kind == b.kind {
            return;
        }
        let apart = Kinds::with(|kinds| *kinds.apart(a, b));
        self.motion += apart.motion;
        self.body += apart.body;
        self.reward += apart.reward;
        self.paid_for += apart.paid_for;
        self.odds += apart.odds;
        self.color += apart.color;
        self.model += apart.model;
    }
}

/// The smaller angle between two headings in `0..360`.
pub(super) fn turn(a: f64, b: f64) -> f64 {
    let turn = (a - b).abs();
    turn.min(360.0 - turn)
}

fn state(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let places = objects.metres;
    sink.add(Comparison::PlacesOfObjects, places, places / UNIT_OF_PLACE);
    sink.add(Comparison::Unmatched, objects.alone, objects.alone);
    sink.add(Comparison::HeadingsOfObjects, objects.turn, objects.turn / 180.0);
    let metres = length(a.start, b.start);
    sink.add(Comparison::Start, metres, metres / UNIT_OF_PLACE);
    let turn = turn(a.heading, b.heading);
    sink.add(Comparison::Heading, turn, turn / 180.0);
}

fn action(a: &Sketch, b: &Sketch, sink: &mut impl Sink) {
    as_it_is(
        Comparison::ModelOfActions,
        a.action_model.distance(&b.action_model),
        sink,
    );
    as_it_is(
        Comparison::SpaceOfActions,
        a.action_space.distance(&b.action_space),
        sink,
    );
    relative(Comparison::LargestSpeed, a.linear_speed, b.linear_speed, sink);
    relative(Comparison::LargestTurnRate, a.angular_speed, b.angular_speed, sink);
}

fn transition(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    as_it_is(Comparison::Motion, objects.motion, sink);
    as_it_is(Comparison::Bodies, objects.body, sink);
    relative(Comparison::TimeStep, a.time_step, b.time_step, sink);
    relative(Comparison::Width, a.agent_width, b.agent_width, sink);
    as_it_is(Comparison::EnergyOfAgent, a.energy.distance(&b.energy), sink);
    let map = f64::from(u8::from(a.map != b.map));
    as_it_is(Comparison::MapAndWalls, map + a.walls.distance(&b.walls), sink);
    let layouts = match (&a.layout, &b.layout) {
        (None, None) => 0.0,
        (Some(a), Some(b)) if Arc::ptr_eq(a, b) => 0.0,
        (a, b) => {
            let open = LayoutShape::open();
            a.as_deref().unwrap_or(open).distance(b.as_deref().unwrap_or(open))
        }
    };
    let layouts = layouts + f64::from(u8::from(a.doors != b.doors));
    as_it_is(Comparison::Layouts, layouts, sink);
    let sides = a.arena.iter().zip(&b.arena);
    let (raw, normalised) = sides.fold((0.0, 0.0), |(raw, normalised), (a, b)| {
        (raw + (a - b).abs(), normalised + relative_difference(*a, *b))
    });
    sink.add(Comparison::ArenaSize, raw, normalised);
    as_it_is(Comparison::Zones, a.zones[0].distance(&b.zones[0]), sink);
}

fn reward(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let rewards = objects.reward + objects.alone_pays;
    sink.add(Comparison::Rewards, rewards, rewards / UNIT_OF_REWARD);
    as_it_is(Comparison::PaidFor, objects.paid_for, sink);
    as_it_is(Comparison::RewardProbabilities, objects.odds, sink);
    as_it_is(Comparison::StepReward, (a.step_reward - b.step_reward).abs(), sink);
    as_it_is(Comparison::ShapingAndEndings, a.rules.distance(&b.rules), sink);
    as_it_is(Comparison::ZonePay, a.zones[1].distance(&b.zones[1]), sink);
    let limits = match (a.limit, b.limit) {
        (Some(a), Some(b)) => relative_difference(a, b),
        (None, None) => 0.0,
        _ => 1.0,
    };
    as_it_is(Comparison::Limit, limits, sink);
}

fn observation(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    as_it_is(Comparison::ColorsOfObjects, objects.color, sink);
    as_it_is(Comparison::UnmatchedLooks, objects.alone, sink);
    as_it_is(Comparison::ModelsOfObjects, objects.model, sink);
    as_it_is(Comparison::SizesOfObjects, objects.scale, sink);
    relative(Comparison::Light, a.light, b.light, sink);
    let apart = a.surroundings.iter().zip(&b.surroundings).map(|(a, b)| a.distance(*b));
    as_it_is(Comparison::ColorsOfSurroundings, apart.sum(), sink);
    as_it_is(Comparison::ZoneLooks, a.zones[2].distance(&b.zones[2]), sink);
    let picture: f64 = a
        .picture
        .iter()
        .zip(&b.picture)
        .map(|(a, b)| relative_difference(*a, *b))
        .sum();
    as_it_is(
        Comparison::CameraAndWeather,
        picture + a.camera.distance(&b.camera),
        sink,
    );
}

/// A number that needs no normalisation.
fn as_it_is(comparison: Comparison, number: f64, sink: &mut impl Sink) {
    sink.add(comparison, number, number);
}

/// Difference of two numbers of at least 0, as a share of the larger one: a metric.
fn relative(comparison: Comparison, a: f64, b: f64, sink: &mut impl Sink) {
    let raw = (a - b).abs();
    sink.add(comparison, raw, relative_difference(a, b));
}

pub(super) fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    (x * x + y * y).sqrt()
}
