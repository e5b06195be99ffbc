//! A world's own chance: streams of random numbers that depend on the world alone. Who draws from them is in `answer.rs`,
//! `objects.rs` and `motion.rs`.

use driftworld_spec::{MotionModel, Object, World};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The stream of bandit arms and of objects that come back; an object that moves has the stream of its number plus one.
const ARMS: u64 = 0;

/// What all chance of a world grows from: the hash of the world at its start, 64 hexadecimal letters.
///
/// Hashing costs as much as writing the world down, so it waits until something needs chance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Seed(Option<String>);

impl Seed {
    /// The seed of a world at its start: there only if one of its objects needs it.
    pub(super) fn of(world: &World) -> Self {
        let needed = world.objects.iter().any(needs_chance);
        Self(needed.then(|| world.hash()))
    }

    /// A seed that was written down.
    pub(super) fn known(hash: String) -> Self {
        Self(Some(hash))
    }

    /// The hash, if it is known.
    pub(super) fn hash(&self) -> Option<&str> {
        self.0.as_deref()
    }

    /// Finds the seed if it is not known yet, and says whether it was not; `start` is the world before anything was spawned.
    pub(super) fn learn(&mut self, start: &World) -> bool {
        let unknown = self.0.is_none();
        self.0.get_or_insert_with(|| start.hash());
        unknown
    }

    /// The stream of bandit arms and of objects that come back, at its beginning.
    pub(super) fn arms(&self) -> ChaCha8Rng {
        self.stream(ARMS)
    }

    /// The stream of an object that moves, at its beginning.
    pub(super) fn mover(&self, object: usize) -> ChaCha8Rng {
        self.stream(object as u64 + 1)
    }

    fn stream(&self, number: u64) -> ChaCha8Rng {
        let mut seed = [0; 32];
        let letters = self.0.as_deref().unwrap_or_default().bytes();
        seed.iter_mut().zip(letters).for_each(|(byte, letter)| *byte = letter);
        let mut chance = ChaCha8Rng::from_seed(seed);
        chance.set_stream(number);
        chance
    }
}

/// Whether an object ever draws: a bandit arm, one that comes back, one that moves.
fn needs_chance(object: &Object) -> bool {
    object.reward_probability < 1.0 || object.respawn.is_some() || moves(object)
}

/// Whether an object moves by itself.
pub(super) fn moves(object: &Object) -> bool {
    object.motion_model != MotionModel::Stationary && object.speed > 0.0
}
