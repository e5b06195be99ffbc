//! Runs two worlds side by side: before each step both have the same state, and both bodies get the same command. Any
//! difference afterwards is due to an element.

use driftworld_spec::{Element, Modality, World};

use super::Experiment;
use super::findings::{Findings, Witness};
use super::matching::Paired;
use super::policy::Policy;
use crate::EnvError;
use crate::render::Frame;
use crate::sim::{Action, Environment, Event, Snapshot, Step, Unlike};

/// Both worlds of a pair, one of which leads, with reused buffers.
pub(super) struct Run<'a> {
    experiment: &'a Experiment,
    /// Index of the pair.
    number: usize,
    /// Which of the two worlds leads.
    leader: usize,
    lead: Environment,
    /// The other world, with its objects starting where they do in the leader, because they respawn there.
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
        let (lead, follow) = (open(own.clone()), open(placed_as(other, own)));
        // If the two request different images, compares those that both have.
        let asked = [own, other].map(|world| &world.agent_params.modalities);
        let shared = asked[0].iter().copied().filter(|one| asked[1].contains(one));
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
    pub(super) fn live(&mut self, policy: Policy, found: &mut Findings) -> Result<(), EnvError> {
        self.rewind();
        let seed = self.experiment.seed.wrapping_add(self.number as u64);
        let mut agent = policy.agent(self.lead.world(), seed);
        agent.begin(seed);
        found.proof.runs += 1;
        let share = if policy == Policy::Still { 5 } else { 1 };
        for step in 0..self.experiment.steps.div_ceil(share) {
            if self.lead.ended() {
                break;
            }
            let moment = Moment { policy, step };
            self.follow.take_state_of(&self.lead);
            if step % self.experiment.look_every.max(1) == 0 {
                self.look(moment, found)?;
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
        let [mut paid, mut other_paid] = [Step::default(), Step::default()];
        lead.step_by(own, &mut paid);
        if !has_counterpart {
            found.proof.without_counterpart += 1;
            return Ok(());
        }
        follow.step_by(other, &mut other_paid);
        found.proof.steps += 1;
        let unlike = lead.state_unlike(follow);
        let paid_otherwise = if unlike.is_some() {
            event_unlike(&paid, &other_paid)
        } else {
            paid_unlike(&paid, &other_paid)
        };
        for (element, unlike) in [(Element::T, unlike), (Element::R, paid_otherwise)] {
            if let Some(unlike) = unlike {
                self.note(element, moment, unlike, found);
            }
        }
        Ok(())
    }

    /// Records a difference; the pair's first world comes first, whichever leads.
    fn note(&self, element: Element, moment: Moment, mut unlike: Unlike, found: &mut Findings) {
        if self.leader == 1 {
            std::mem::swap(&mut unlike.own, &mut unlike.other);
        }
        let witness = Witness::of(Some(self.number), Some(moment.policy), Some(moment.step), unlike);
        found.note(element, witness);
    }

    /// Compares both observations of the shared state.
    fn look(&mut self, moment: Moment, found: &mut Findings) -> Result<(), EnvError> {
        found.proof.observations += 1;
        if found.differs(Element::Phi) {
            return Ok(());
        }
        let [lead, follow] = [&self.lead, &self.follow].map(|environment| &environment.world().agent_params);
        let mut unlike = None;
        if lead.state_features == follow.state_features && lead.instruction.len() == follow.instruction.len() {
            let (own, other) = (self.lead.state_vector(), self.follow.state_vector());
            unlike = Unlike::of("the state vector", &own, &other);
        }
        if unlike.is_none() && !self.modalities.is_empty() {
            let [own, other] = &mut self.frames;
            self.lead.draw_into(own.target().only(&self.modalities))?;
            self.follow.draw_into(other.target().only(&self.modalities))?;
            unlike = pictures_unlike(&self.frames, &self.modalities);
        }
        if let Some(unlike) = unlike {
            self.note(Element::Phi, moment, unlike, found);
        }
        Ok(())
    }

    /// Takes the last step before either world's time limit, and compares whether both end there.
    pub(super) fn at_the_limit(&mut self, found: &mut Findings) {
        let limited = [self.lead.world().clone(), self.follow.world().clone()];
        for world in &limited {
            self.rewind();
            if !self.lead.wind_to_limit_of(world) {
                continue;
            }
            self.follow.take_state_of(&self.lead);
            let policy = Policy::Still;
            let action = policy.agent(self.lead.world(), 0).act(&self.lead);
            let step = self.lead.num_steps();
            // A world past its time limit takes no step.
            let _ = self.step(action, Moment { policy, step }, found);
        }
    }
}

/// The world, with its agent and objects starting where they do in another world with the same objects; unchanged if they have
/// no room there.
fn placed_as(world: &World, other: &World) -> World {
    let mut placed = world.clone().into_draft();
    let start = &other.agent_params;
    (placed.agent_params.coordinates, placed.agent_params.heading) = (start.coordinates, start.heading);
    for (object, other) in placed.objects.iter_mut().zip(&other.objects) {
        (object.coordinates, object.heading) = (other.coordinates, other.heading);
    }
    placed.check_in_range().unwrap_or_else(|_| world.clone())
}

/// An event of the same object and kind in both worlds that has different rewards, whatever else happened.
fn event_unlike(own: &Step, other: &Step) -> Option<Unlike> {
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
        Unlike::of(what, &event.reward, &counterpart.reward)
    })
}

/// Differences in a step's reward, or in how it ended the episode.
fn paid_unlike(own: &Step, other: &Step) -> Option<Unlike> {
    let ends = |step: &Step| (step.terminated, step.truncated, step.success);
    Unlike::of("the reward", &own.reward, &other.reward)
        .or_else(|| Unlike::of("the end (terminated, truncated, success)", &ends(own), &ends(other)))
}

/// The first differing pixel, in the first image that has one.
fn pictures_unlike([a, b]: &[Frame; 2], modalities: &[Modality]) -> Option<Unlike> {
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
        Modality::Rgb => first("rgb", &a.rgb, &b.rgb, 3, at, PartialEq::eq),
        Modality::Depth => first("depth", &a.depth, &b.depth, 1, at, |a, b| is_as_far(*a, *b)),
        Modality::Segmentation => first("segmentation", &a.category, &b.category, 1, at, PartialEq::eq),
        Modality::Class => first("class", &a.class, &b.class, 1, at, PartialEq::eq),
        Modality::Instance => first("instance", &a.instance, &b.instance, 1, at, PartialEq::eq),
    })
}

/// Whether two depths are equal up to rounding: a wall in two pieces is as far away as a wall in one.
fn is_as_far(a: f32, b: f32) -> bool {
    (a - b).abs() <= 1e-5 * a.max(b)
}

/// The first pixel, of `each` numbers, in which two images differ.
fn first<T: std::fmt::Debug>(
    name: &str,
    a: &[T],
    b: &[T],
    each: usize,
    at: impl Fn(usize) -> String,
    is_same: impl Fn(&T, &T) -> bool,
) -> Option<Unlike> {
    let differs = |(a, b): (&T, &T)| !is_same(a, b);
    let index = a.iter().zip(b).position(differs)? / each;
    let of = |image: &[T]| format!("{:?}", &image[index * each..(index + 1) * each]);
    Some(Unlike {
        what: format!("the {name} image at {}", at(index)),
        own: of(a),
        other: of(b),
    })
}
