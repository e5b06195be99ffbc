//! The parts that two sketches of worlds are compared by, found one after the other. What becomes of them, a table or a sum, is said in
//! `world.rs`.

use std::cell::RefCell;

use driftworld_spec::Comparison;

use crate::assignment::Assignment;
use crate::combined::distance::{Part, position};
use crate::combined::sketch::{ObjectFeatures, Sketch};
use crate::scalar::{circular_difference, relative_difference};

/// Objects this far apart, in metres, are no more like each other than one that is there and one that is not.
const CUT_OFF: f64 = 10.0;

/// Starts this far apart, in metres, are half of the way to the greatest distance.
const HALF_WAY: f64 = 10.0;

/// Takes the parts as they are found: the comparison, the measure's own number, and the one that counts.
pub(super) trait Sink {
    fn add(&mut self, comparison: Comparison, raw: f64, normalised: f64);
}

/// Keeps every part.
pub(super) struct Parts(pub(super) Vec<Part>);

impl Sink for Parts {
    fn add(&mut self, comparison: Comparison, raw: f64, normalised: f64) {
        self.0.push(Part {
            name: comparison.name().to_owned(),
            element: comparison.element(),
            measure: comparison.measure(),
            method: None,
            raw,
            normalised: normalised.clamp(0.0, 1.0),
            weight: 1.0,
            share: 0.0,
        });
    }
}

/// Keeps sums only.
#[derive(Default)]
pub(super) struct Sums(pub(super) [(f64, f64); 5]);

impl Sink for Sums {
    fn add(&mut self, comparison: Comparison, _: f64, normalised: f64) {
        let (sum, count) = &mut self.0[position(comparison.element())];
        *sum += normalised.clamp(0.0, 1.0);
        *count += 1.0;
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

/// What comparing all objects of two worlds comes to.
#[derive(Default)]
struct Objects {
    /// Metres between matched objects, each at most the cut-off, and the cut-off for each without a match.
    metres: f64,
    /// The number of objects of the world that has more.
    most: f64,
    /// Sums over classes of the smaller and of the greater number of objects.
    fewer: f64,
    more: f64,
    /// Sums over objects that have a counterpart.
    turn: f64,
    motion: f64,
    body: f64,
    reward: f64,
    reward_relative: f64,
    paid_for: f64,
    odds: f64,
    color: f64,
    look: f64,
}

impl Objects {
    fn of(a: &Sketch, b: &Sketch) -> Self {
        let mut all = Self::default();
        for (mine, theirs) in a.classes_of_both(b) {
            all.fewer += mine.len().min(theirs.len()) as f64;
            all.more += mine.len().max(theirs.len()) as f64;
            all.metres += matched_metres(mine, theirs);
            for (a, b) in mine.iter().zip(theirs) {
                all.add(a, b);
            }
        }
        all.most = a.objects.len().max(b.objects.len()) as f64;
        all.metres += CUT_OFF * (all.most - all.fewer);
        all
    }

    fn add(&mut self, a: &ObjectFeatures, b: &ObjectFeatures) {
        self.turn += circular_difference(a.heading, b.heading);
        self.motion += differs(a.motion, b.motion);
        self.body += differs(a.body, b.body);
        self.reward += (a.reward - b.reward).abs();
        self.reward_relative += share((a.reward - b.reward).abs(), 2.0 * a.reward.abs().max(b.reward.abs()));
        self.paid_for += differs(a.paid_for, b.paid_for);
        self.odds += (a.odds - b.odds).abs();
        self.look += differs(a.look, b.look);
        self.color += match (a.color, b.color) {
            (Some(a), Some(b)) => a.distance(b),
            (None, None) => 0.0,
            _ => 1.0,
        };
    }

    /// The mean over objects that have a counterpart.
    fn mean(&self, sum: f64) -> f64 {
        share(sum, self.fewer)
    }
}

/// Metres between the objects of one class in two worlds, paired so that they are least, each at most the cut-off.
fn matched_metres(a: &[ObjectFeatures], b: &[ObjectFeatures]) -> f64 {
    thread_local! {
        static BUFFERS: RefCell<(Vec<f64>, Assignment)> = RefCell::default();
    }
    match (a, b) {
        ([], _) | (_, []) => return 0.0,
        ([a], [b]) => return length(a.place, b.place).min(CUT_OFF),
        _ => {}
    }
    BUFFERS.with_borrow_mut(|(costs, assignment)| {
        costs.clear();
        for mine in a {
            costs.extend(b.iter().map(|theirs| length(mine.place, theirs.place).min(CUT_OFF)));
        }
        // Finite and within the cut-off; more objects than an assignment takes are compared in their order.
        let in_order = || {
            a.iter()
                .zip(b)
                .map(|(a, b)| length(a.place, b.place).min(CUT_OFF))
                .sum()
        };
        assignment.solve(costs, a.len(), b.len()).unwrap_or_else(|_| in_order())
    })
}

fn state(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let places = share(objects.metres, objects.most);
    sink.add(Comparison::PlacesOfObjects, places, places / CUT_OFF);
    let cells = jaccard(&a.cells, &b.cells);
    sink.add(Comparison::CellsTaken, cells, cells);
    let numbers = share(objects.more - objects.fewer, objects.more);
    sink.add(Comparison::NumbersOfObjects, numbers, numbers);
    let metres = length(a.start, b.start);
    sink.add(Comparison::Start, metres, metres / (metres + HALF_WAY));
    let turns = objects.mean(objects.turn);
    sink.add(Comparison::HeadingsOfObjects, turns, turns / 180.0);
    let turn = circular_difference(a.heading, b.heading);
    sink.add(Comparison::Heading, turn, turn / 180.0);
}

fn action(a: &Sketch, b: &Sketch, sink: &mut impl Sink) {
    same(Comparison::ModelOfActions, a.action_model, b.action_model, sink);
    same(Comparison::SpaceOfActions, a.action_space, b.action_space, sink);
    relative(Comparison::LargestSpeed, a.linear_speed, b.linear_speed, sink);
    relative(Comparison::LargestTurnRate, a.angular_speed, b.angular_speed, sink);
}

fn transition(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let moves = objects.mean(objects.motion);
    sink.add(Comparison::Motion, moves, moves);
    let bodies = objects.mean(objects.body);
    sink.add(Comparison::Bodies, bodies, bodies);
    relative(Comparison::TimeStep, a.time_step, b.time_step, sink);
    relative(Comparison::Width, a.agent_width, b.agent_width, sink);
    same(Comparison::MapAndWalls, a.walls, b.walls, sink);
    relative(Comparison::ArenaSize, a.area, b.area, sink);
}

fn reward(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let rewards = (objects.mean(objects.reward), objects.mean(objects.reward_relative));
    sink.add(Comparison::Rewards, rewards.0, rewards.1);
    let paid_for = objects.mean(objects.paid_for);
    sink.add(Comparison::PaidFor, paid_for, paid_for);
    let odds = objects.mean(objects.odds);
    sink.add(Comparison::RewardProbabilities, odds, odds);
    let raw = (a.step_reward - b.step_reward).abs();
    let larger = a.step_reward.abs().max(b.step_reward.abs());
    sink.add(Comparison::StepReward, raw, share(raw, 2.0 * larger));
    same(Comparison::ShapingAndEndings, a.rules, b.rules, sink);
    same(Comparison::Limit, a.limit, b.limit, sink);
}

fn observation(a: &Sketch, b: &Sketch, objects: &Objects, sink: &mut impl Sink) {
    let colors = objects.mean(objects.color);
    sink.add(Comparison::ColorsOfObjects, colors, colors);
    let looks = objects.mean(objects.look);
    sink.add(Comparison::ModelsOfObjects, looks, looks);
    relative(Comparison::Light, a.light, b.light, sink);
    let apart = a.surroundings.iter().zip(&b.surroundings).map(|(a, b)| a.distance(*b));
    let around = apart.sum::<f64>() / 4.0;
    sink.add(Comparison::ColorsOfSurroundings, around, around);
    same(Comparison::CameraAndWeather, a.camera, b.camera, sink);
}

/// Share of the cells taken in either that are not taken in both; both in rising order.
fn jaccard(a: &[(i32, i32)], b: &[(i32, i32)]) -> f64 {
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => {
                (i, j, common) = (i + 1, j + 1, common + 1);
            }
        }
    }
    let all = a.len() + b.len() - common;
    share((all - common) as f64, all as f64)
}

fn same(comparison: Comparison, a: u32, b: u32, sink: &mut impl Sink) {
    let raw = differs(a, b);
    sink.add(comparison, raw, raw);
}

/// Difference of two numbers of at least 0, and its share of the larger one: a metric.
fn relative(comparison: Comparison, a: f64, b: f64, sink: &mut impl Sink) {
    let raw = (a - b).abs();
    sink.add(comparison, raw, relative_difference(a, b));
}

fn share(raw: f64, whole: f64) -> f64 {
    if raw == 0.0 {
        0.0
    } else {
        raw / whole.max(f64::MIN_POSITIVE)
    }
}

fn differs(a: u32, b: u32) -> f64 {
    f64::from(u8::from(a != b))
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    (x * x + y * y).sqrt()
}
