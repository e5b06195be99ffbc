//! What the expert of one world believes about another: the same objects in the same places, with the rewards of their
//! counterparts at home.

use driftworld_spec::{Object, Stimulus, World};

use crate::EnvError;
use crate::assets::Catalogue;
use crate::sim::{Action, Environment, Step};

/// A world as an expert from elsewhere believes it to be, synchronised with the state of the true one.
pub(super) struct Belief {
    environment: Environment,
    /// For each object about which the belief is wrong, the stimuli that are believed to use it up; empty for the
    /// others.
    vain: Vec<Vec<Stimulus>>,
    /// Which of those have been triggered.
    tried: Vec<bool>,
}

impl Belief {
    /// What the expert of `home` believes about `truth`.
    pub(super) fn new(home: &World, truth: &World, catalogue: &Catalogue) -> Result<Self, EnvError> {
        let believed = truth.clone().edit(|world| {
            world.rules = home.rules.clone();
            for (index, object) in world.objects.iter_mut().enumerate() {
                let like = most_alike(&home.objects, object, index).cloned();
                let like = like.unwrap_or_else(|| Object::new(object.class.clone(), object.coordinates));
                take_effects(object, like);
            }
        });
        let believed = believed.map_err(|problem| EnvError::BadWorld { problem })?;
        let objects = believed.objects.iter().zip(&truth.objects);
        let vain = objects.map(|(own, other)| {
            if has_effects_of(own, other) {
                Vec::new()
            } else {
                uses_up(own)
            }
        });
        Ok(Self {
            vain: vain.collect(),
            tried: vec![false; truth.objects.len()],
            environment: Environment::with_catalogue(believed, catalogue.clone()),
        })
    }

    /// The believed world, set to the state of the true one.
    pub(super) fn at(&mut self, truth: &Environment) -> &Environment {
        self.environment.take_state_of(truth);
        for (index, tried) in self.tried.iter_mut().enumerate() {
            // Objects that left and came back can be tried again.
            *tried &= truth.objects()[index].present;
            if *tried {
                self.environment.take_reward_of(index);
            }
        }
        &self.environment
    }

    /// Predicts an action in the believed world, after [`Belief::at`] has set it to the true state.
    pub(super) fn foresee(&mut self, action: Action, step: &mut Step) -> Result<(), EnvError> {
        self.environment.step_into(action, step)
    }

    /// Records which stimuli a step of the true world triggered.
    pub(super) fn note(&mut self, step: &Step) {
        for event in &step.events {
            // Coming near does not count as trying an object that has to be touched.
            self.tried[event.object] |= self.vain[event.object].contains(&event.stimulus);
        }
    }
}

/// The most similar object of the same class: by nearest colour, then by model, then by nearest place, then by index.
fn most_alike<'a>(objects: &'a [Object], other: &Object, index: usize) -> Option<&'a Object> {
    let same_class = objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.class == other.class);
    let unlike = |(number, object): &(usize, &Object)| {
        let place = squared(object.coordinates, other.coordinates);
        let model = f64::from(u8::from(object.model != other.model));
        ([colors_apart(object, other), model, place], number.abs_diff(index))
    };
    let nearest = same_class.min_by(|a, b| {
        let ((a, first), (b, second)) = (unlike(a), unlike(b));
        let numbers = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
        numbers
            .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
            .then(first.cmp(&second))
    });
    nearest.map(|(_, object)| object)
}

fn colors_apart(a: &Object, b: &Object) -> f64 {
    match (&a.color, &b.color) {
        (None, None) => 0.0,
        (Some(a), Some(b)) => squared(a.0, b.0),
        // More than the distance of any two colours.
        _ => 4.0,
    }
}

fn squared<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// Gives an object the effects of another: rewards, their stimuli, destruction, and the tag that rules use.
fn take_effects(object: &mut Object, like: Object) {
    object.tag = like.tag;
    object.reward = like.reward;
    object.reward_probability = like.reward_probability;
    object.reward_stimulus = like.reward_stimulus;
    object.reward_once_stimulus = like.reward_once_stimulus;
    object.destroy_stimulus = like.destroy_stimulus;
    object.range_stimulus_distance = like.range_stimulus_distance;
    object.order = like.order;
    object.respawn = like.respawn;
}

fn has_effects_of(a: &Object, b: &Object) -> bool {
    let mut same = a.clone();
    take_effects(&mut same, b.clone());
    same == *a
}

/// The stimuli that use an object up.
fn uses_up(object: &Object) -> Vec<Stimulus> {
    let both = object.reward_once_stimulus.iter().chain(&object.destroy_stimulus);
    both.copied().collect()
}
