//! [`Belief`]: an expert's beliefs about a world that is not its own. The objects and positions are the true ones, the rewards
//! are those of their counterparts in the expert's own world.

use driftworld_spec::{Object, Stimulus, World};

use crate::EnvError;
use crate::assets::Catalogue;
use crate::sim::{Action, Environment, Step};

/// A world as an expert of another world believes it to be, synchronised with the state of the true one.
pub(super) struct Belief {
    environment: Environment,
    /// For each object whose effects the expert misjudges, the stimuli that it believes to use up the object; empty for other
    /// objects.
    false_stimuli: Vec<Vec<Stimulus>>,
    /// Whether one of those stimuli has been triggered.
    tried: Vec<bool>,
}

impl Belief {
    /// The belief of the expert of `home` about `truth`.
    pub(super) fn new(home: &World, truth: &World, catalogue: &Catalogue) -> Result<Self, EnvError> {
        let believed = truth.clone().edit(|world| {
            world.rules = home.rules.clone();
            for (index, object) in world.objects.iter_mut().enumerate() {
                let counterpart = most_similar(&home.objects, object, index).cloned();
                let counterpart = counterpart.unwrap_or_else(|| Object::new(object.class.clone(), object.coordinates));
                copy_effects(object, counterpart);
            }
        });
        let believed = believed.map_err(|problem| EnvError::BadWorld { problem })?;
        let objects = believed.objects.iter().zip(&truth.objects);
        let false_stimuli = objects.map(|(own, other)| {
            if has_effects_of(own, other) {
                Vec::new()
            } else {
                exhausting_stimuli(own)
            }
        });
        Ok(Self {
            false_stimuli: false_stimuli.collect(),
            tried: vec![false; truth.objects.len()],
            environment: Environment::with_catalogue(believed, catalogue.clone()),
        })
    }

    /// The believed world in the state of the true one.
    pub(super) fn at(&mut self, truth: &Environment) -> &Environment {
        self.environment.copy_state_from(truth);
        for (index, tried) in self.tried.iter_mut().enumerate() {
            // Objects that disappeared and respawned can be tried again.
            *tried &= truth.objects()[index].present;
            if *tried {
                self.environment.clear_reward(index);
            }
        }
        &self.environment
    }

    /// Predicts an action in the believed world, after [`Belief::at`] has set it to the true state.
    pub(super) fn predict(&mut self, action: Action, step: &mut Step) -> Result<(), EnvError> {
        self.environment.step_into(action, step)
    }

    /// Records the stimuli that a step of the true world triggered.
    pub(super) fn record(&mut self, step: &Step) {
        for event in &step.events {
            // For an object that must be touched, coming near does not count as trying it.
            self.tried[event.object] |= self.false_stimuli[event.object].contains(&event.stimulus);
        }
    }
}

/// The most similar object of the same class: by nearest colour, then model, then nearest position, then index.
fn most_similar<'a>(objects: &'a [Object], other: &Object, index: usize) -> Option<&'a Object> {
    let same_class = objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.class == other.class);
    let dissimilarity = |(number, object): &(usize, &Object)| {
        let distance = squared(object.coordinates, other.coordinates);
        let model = f64::from(u8::from(object.model != other.model));
        ([color_distance(object, other), model, distance], number.abs_diff(index))
    };
    let nearest = same_class.min_by(|a, b| {
        let ((a, first), (b, second)) = (dissimilarity(a), dissimilarity(b));
        let numbers = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
        numbers
            .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
            .then(first.cmp(&second))
    });
    nearest.map(|(_, object)| object)
}

fn color_distance(a: &Object, b: &Object) -> f64 {
    match (&a.color, &b.color) {
        (None, None) => 0.0,
        (Some(a), Some(b)) => squared(a.0, b.0),
        // More than the distance between any two colours.
        _ => 4.0,
    }
}

fn squared<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// Gives an object the effects of another: its rewards, stimuli, destruction, order, respawn, and the tag that rules use.
fn copy_effects(object: &mut Object, counterpart: Object) {
    object.tag = counterpart.tag;
    object.reward = counterpart.reward;
    object.reward_probability = counterpart.reward_probability;
    object.reward_stimulus = counterpart.reward_stimulus;
    object.reward_once_stimulus = counterpart.reward_once_stimulus;
    object.destroy_stimulus = counterpart.destroy_stimulus;
    object.range_stimulus_distance = counterpart.range_stimulus_distance;
    object.order = counterpart.order;
    object.respawn = counterpart.respawn;
}

fn has_effects_of(a: &Object, b: &Object) -> bool {
    let mut same = a.clone();
    copy_effects(&mut same, b.clone());
    same == *a
}

/// The stimuli that use an object up.
fn exhausting_stimuli(object: &Object) -> Vec<Stimulus> {
    let both = object.reward_once_stimulus.iter().chain(&object.destroy_stimulus);
    both.copied().collect()
}
