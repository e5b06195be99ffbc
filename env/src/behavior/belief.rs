//! What the expert of one world takes another for: the same things in the same places, that pay as their likes do at home.

use driftworld_spec::{Object, Stimulus, World};

use crate::EnvError;
use crate::assets::Catalogue;
use crate::sim::{Action, Environment, Step};

/// A world as an expert from elsewhere believes it to be, kept in the state of the true one.
pub(super) struct Belief {
    environment: Environment,
    /// Of each object, what is believed to use it up, where it is not so in truth; nothing where both agree.
    vain: Vec<Vec<Stimulus>>,
    /// Which of those were set off.
    tried: Vec<bool>,
}

impl Belief {
    /// What the expert of `home` takes `truth` for.
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

    /// The believed world, in the state of the true one.
    pub(super) fn at(&mut self, truth: &Environment) -> &Environment {
        self.environment.take_state_of(truth);
        for (index, tried) in self.tried.iter_mut().enumerate() {
            // What went and came back can be tried again.
            *tried &= truth.objects()[index].present;
            if *tried {
                self.environment.take_reward_of(index);
            }
        }
        &self.environment
    }

    /// What would come of an action in the believed world, which [`Belief::at`] has put into the state of the true one.
    pub(super) fn foresee(&mut self, action: Action, step: &mut Step) -> Result<(), EnvError> {
        self.environment.step_into(action, step)
    }

    /// Takes note of what a step of the true world set off.
    pub(super) fn note(&mut self, step: &Step) {
        for event in &step.events {
            // Coming near is no try of what has to be touched.
            self.tried[event.object] |= self.vain[event.object].contains(&event.stimulus);
        }
    }
}

/// The object of the same class that looks most like another: of the nearest colour, then of its model, then nearest to its place.
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
        // Farther than any two colours.
        _ => 4.0,
    }
}

fn squared<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// Gives an object the effects of another: what it pays and for what, what destroys it, and what rules call it.
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

/// What uses an object up.
fn uses_up(object: &Object) -> Vec<Stimulus> {
    let both = object.reward_once_stimulus.iter().chain(&object.destroy_stimulus);
    both.copied().collect()
}
