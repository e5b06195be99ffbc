//! Runs two worlds side by side. Before each step both have the same state, and both agents get the same command, so any
//! difference afterwards is due to an element of the decision process.

use driftworld_spec::{Element, Modality, World};

use super::Experiment;
use super::findings::{Findings, Witness};
use super::matching::Paired;
use super::policy::Policy;
use crate::EnvError;
use crate::render::Frame;
use crate::sim::{Action, Difference, Environment, Event, Snapshot, Step};

/// Both worlds of a pair, one of which leads, and reused buffers.
pub(super) struct Run<'a> {
    experiment: &'a Experiment,
    /// Index of the pair.
    number: usize,
    /// Which of the two worlds leads.
    leader: usize,
    lead: Environment,
    /// The other world. Its objects start where they do in the leader, because that is where they respawn.
    follow: Environment,
    starts: [Snapshot; 2],
    frames: [Frame; 2],
    modalities: Vec<Modality>,
}

/// The current policy and step.
#[derive(Clone, Copy)]
struct Moment {
    policy: Policy,
    step: u32,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        experiment: &'a Experiment,
        number: usize,
        paired: &Paired,
        leader: usize,
    ) -> Result<Self, EnvError> {
        let side = experiment.side;
        if !(1..=4096).contains(&side) {
            return Err(EnvError::PictureSize {
                width: side,
                height: side,
            });
        }
        let open = |world: World| Environment::with_catalogue(world, experiment.catalogue.clone());
        let (own, other) = (&paired.worlds[leader], &paired.worlds[1 - leader]);
        let (lead, follow) = (open(own.clone()), open(with_starts_of(other, own)));
        // If the two request different images, compares those that both request.
        let requested = [own, other].map(|world| &world.agent_params.modalities);
        let shared = requested[0].iter().copied().filter(|one| requested[1].contains(one));
        Ok(Self {
            experiment,
            number,
            leader,
            starts: [lead.snapshot(), follow.snapshot()],
            lead,
            follow,
            frames: [Frame::new(side, side), Frame::new(side, side)],
            modalities: experiment.modalities.clone().unwrap_or_else(|| shared.collect()),
        })
    }

    /// Runs the pair with one policy.
    pub(super) fn run_policy(&mut self, policy: Policy, found: &mut Findings) -> Result<(), EnvError> {
        self.rewind();
        let seed = self.experiment.seed.wrapping_add(self.number as u64);
        let mut agent = policy.agent(self.lead.world(), seed);
        agent.begin(seed);
        found.proof.runs += 1;
        let divisor = if policy == Policy::Still { 5 } else { 1 };
        for step in 0..self.experiment.steps.div_ceil(divisor) {
            if self.lead.ended() {
                break;
            }
            let moment = Moment { policy, step };
            self.follow.copy_state_from(&self.lead);
            if step % self.experiment.look_every.max(1) == 0 {
                self.compare_observations(moment, found)?;
            }
            let action = agent.act(&self.lead);
            self.step(action, moment, found)?;
        }
        Ok(())
    }

    /// Resets both worlds to their starts.
    fn rewind(&mut self) {
        self.lead.restore(&self.starts[0]);
        self.follow.restore(&self.starts[1]);
    }

    /// Steps both worlds with one command, and compares the results.
    fn step(&mut self, action: Action, moment: Moment, found: &mut Findings) -> Result<(), EnvError> {
        let (lead, follow) = (&mut self.lead, &mut self.follow);
        let seconds = follow.world().agent_params.time_step;
        let has_counterpart = !lead.agent_has_room() || follow.agent_has_room();
        let [own, other] = lead.commands(action, seconds)?;
        let [mut own_step, mut other_step] = [Step::default(), Step::default()];
        lead.step_by(own, &mut own_step);
        if !has_counterpart {
            found.proof.without_counterpart += 1;
            return Ok(());
        }
        follow.step_by(other, &mut other_step);
        found.proof.steps += 1;
        let difference = lead.state_difference(follow);
        let reward_difference = if difference.is_some() {
            event_reward_difference(&own_step, &other_step)
        } else {
            outcome_difference(&own_step, &other_step)
        };
        for (element, difference) in [(Element::T, difference), (Element::R, reward_difference)] {
            if let Some(difference) = difference {
                self.record(element, moment, difference, found);
            }
        }
        Ok(())
    }

    /// Records a difference, with the pair's first world first even if the second leads.
    fn record(&self, element: Element, moment: Moment, mut difference: Difference, found: &mut Findings) {
        if self.leader == 1 {
            std::mem::swap(&mut difference.own, &mut difference.other);
        }
        let witness = Witness::of(Some(self.number), Some(moment.policy), Some(moment.step), difference);
        found.record(element, witness);
    }

    /// Compares both observations of the shared state.
    fn compare_observations(&mut self, moment: Moment, found: &mut Findings) -> Result<(), EnvError> {
        found.proof.observations += 1;
        if found.differs(Element::Phi) {
            return Ok(());
        }
        let [lead, follow] = [&self.lead, &self.follow].map(|environment| &environment.world().agent_params);
        let mut difference = None;
        if lead.state_features == follow.state_features && lead.instruction.len() == follow.instruction.len() {
            let (own, other) = (self.lead.state_vector(), self.follow.state_vector());
            difference = Difference::of("the state vector", &own, &other);
        }
        if difference.is_none() && !self.modalities.is_empty() {
            let [own, other] = &mut self.frames;
            self.lead.draw_into(own.target().only(&self.modalities))?;
            self.follow.draw_into(other.target().only(&self.modalities))?;
            difference = image_difference(&self.frames, &self.modalities);
        }
        if let Some(difference) = difference {
            self.record(Element::Phi, moment, difference, found);
        }
        Ok(())
    }

    /// Takes the last step before either world's time limit, and compares whether both end there.
    pub(super) fn compare_at_time_limit(&mut self, found: &mut Findings) {
        let limited = [self.lead.world().clone(), self.follow.world().clone()];
        for world in &limited {
            self.rewind();
            if !self.lead.advance_clock_to_limit_of(world) {
                continue;
            }
            self.follow.copy_state_from(&self.lead);
            let policy = Policy::Still;
            let action = policy.agent(self.lead.world(), 0).act(&self.lead);
            let step = self.lead.num_steps();
            // A world past its time limit takes no step.
            let _ = self.step(action, Moment { policy, step }, found);
        }
    }
}

/// The world, with its agent and objects starting where they do in another world with the same objects; unchanged if the result
/// is invalid.
fn with_starts_of(world: &World, other: &World) -> World {
    let mut placed = world.clone().into_draft();
    let start = &other.agent_params;
    (placed.agent_params.coordinates, placed.agent_params.heading) = (start.coordinates, start.heading);
    for (object, other) in placed.objects.iter_mut().zip(&other.objects) {
        (object.coordinates, object.heading) = (other.coordinates, other.heading);
    }
    placed.check_in_range().unwrap_or_else(|_| world.clone())
}

/// The first event that both worlds share, with the same object, stimulus and destruction, but with different rewards.
fn event_reward_difference(own: &Step, other: &Step) -> Option<Difference> {
    own.events.iter().find_map(|event| {
        let is_same = |other: &&Event| {
            (other.object, other.stimulus, other.destroyed) == (event.object, event.stimulus, event.destroyed)
        };
        let counterpart = other.events.iter().find(is_same)?;
        let name = event.tag.as_deref().unwrap_or("no tag");
        let what = format!(
            "the reward for {:?} of object {} ({name})",
            event.stimulus, event.object
        );
        Difference::of(what, &event.reward, &counterpart.reward)
    })
}

/// A difference in a step's reward, or in how it ended the episode.
fn outcome_difference(own: &Step, other: &Step) -> Option<Difference> {
    let ends = |step: &Step| (step.terminated, step.truncated, step.success);
    Difference::of("the reward", &own.reward, &other.reward)
        .or_else(|| Difference::of("the end (terminated, truncated, success)", &ends(own), &ends(other)))
}

/// The first differing pixel, in the first image that has one.
fn image_difference([a, b]: &[Frame; 2], modalities: &[Modality]) -> Option<Difference> {
    let width = a.width as usize;
    let at = |index: usize| {
        format!(
            "row {}, column {} of {} by {}",
            index / width,
            index % width,
            a.height,
            a.width
        )
    };
    modalities.iter().find_map(|modality| match modality {
        Modality::Rgb => first_pixel_difference("rgb", &a.rgb, &b.rgb, 3, at, PartialEq::eq),
        Modality::Depth => first_pixel_difference("depth", &a.depth, &b.depth, 1, at, |a, b| are_equal_depths(*a, *b)),
        Modality::Segmentation => {
            first_pixel_difference("segmentation", &a.category, &b.category, 1, at, PartialEq::eq)
        }
        Modality::Class => first_pixel_difference("class", &a.class, &b.class, 1, at, PartialEq::eq),
        Modality::Instance => first_pixel_difference("instance", &a.instance, &b.instance, 1, at, PartialEq::eq),
    })
}

/// Whether two depths are equal up to rounding, so that a wall in two pieces looks as far away as a wall in one.
fn are_equal_depths(a: f32, b: f32) -> bool {
    (a - b).abs() <= 1e-5 * a.max(b)
}

/// The first pixel, of `numbers_per_pixel` numbers, in which two images differ.
fn first_pixel_difference<T: std::fmt::Debug>(
    name: &str,
    a: &[T],
    b: &[T],
    numbers_per_pixel: usize,
    at: impl Fn(usize) -> String,
    is_same: impl Fn(&T, &T) -> bool,
) -> Option<Difference> {
    let differs = |(a, b): (&T, &T)| !is_same(a, b);
    let index = a.iter().zip(b).position(differs)? / numbers_per_pixel;
    let of = |image: &[T]| {
        format!(
            "{:?}",
            &image[index * numbers_per_pixel..(index + 1) * numbers_per_pixel]
        )
    };
    Some(Difference {
        what: format!("the {name} image at {}", at(index)),
        own: of(a),
        other: of(b),
    })
}
