//! Random numbers of a running world: a stream per object and purpose.
//!
//! Every draw has an index, and does not depend on earlier draws. An object's third draw depends only on the world's seed, the
//! object's identity and the index 3, and on nothing else in the world.

use std::collections::BTreeMap;

use driftworld_spec::{Object, World};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Padding of the key of a world with a seed.
const DOMAIN: [u8; 24] = *b"driftworld chance 1\0\0\0\0\0";

/// The seed of all random numbers of a world: its `seed`, or the hash of the initial positions. Hashing takes as long as
/// reading the world, so it is postponed until a random number is needed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum Seed {
    /// A world without a seed, in which no random number has been needed yet.
    #[default]
    Unknown,
    /// The world's own seed.
    Own(u64),
    /// The hash of its initial positions, 64 hexadecimal digits.
    Places(String),
}

impl Seed {
    /// The seed of a world at its start. It is known if the world or its progress contains one, or if an object needs it.
    pub(super) fn of(world: &World, written: Option<String>) -> Self {
        let needed = || world.objects.iter().any(Object::takes_chances);
        match (world.seed, written) {
            (Some(seed), _) => Self::Own(seed),
            (None, Some(hash)) => Self::Places(hash),
            (None, None) if needed() => Self::Places(world.hash_of_places()),
            (None, None) => Self::Unknown,
        }
    }

    /// The hash of the positions, if that is the seed.
    pub(super) fn hash(&self) -> Option<&str> {
        match self {
            Self::Places(hash) => Some(hash),
            Self::Unknown | Self::Own(_) => None,
        }
    }

    /// Computes the seed if it is not known yet; `start` is the world before anything was spawned.
    pub(super) fn resolve(&mut self, start: &World) {
        if *self == Self::Unknown {
            *self = Self::Places(start.hash_of_places());
        }
    }

    fn key(&self) -> [u8; 32] {
        let mut key = [0; 32];
        match self {
            Self::Unknown => {}
            Self::Own(seed) => {
                key[..8].copy_from_slice(&seed.to_le_bytes());
                key[8..].copy_from_slice(&DOMAIN);
            }
            // Uses the first 32 digits as bytes, which make a good enough key.
            Self::Places(hash) => key.iter_mut().zip(hash.bytes()).for_each(|(byte, digit)| *byte = digit),
        }
        key
    }
}

/// The purpose of a draw.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    /// A wanderer's goals.
    Goals = 1,
    /// Whether a bandit arm pays.
    Pulls = 2,
    /// Positions for respawning.
    Returns = 3,
}

/// Identities of a world's objects, independent of their position in the list. Objects with the same seed, or without a seed at
/// the same position, are distinguished by their relative order.
#[derive(Clone, Debug, Default)]
pub(super) struct Identities {
    /// Number of objects so far with each base identity.
    counts: BTreeMap<u64, u64>,
}

impl Identities {
    /// The identity of the next object of a world; `object` is its initial state.
    pub(super) fn take(&mut self, object: &Object) -> u64 {
        let own = match object.seed {
            Some(seed) => mix(mix(1) ^ seed),
            None => object
                .coordinates
                .iter()
                // 0 and −0 are the same.
                .fold(mix(2), |mixed, metres| mix(mixed ^ (metres + 0.0).to_bits())),
        };
        let count = self.counts.entry(own).or_insert(0);
        *count += 1;
        mix(own ^ *count)
    }
}

/// The random numbers of one object for one purpose.
#[derive(Clone, Debug)]
pub(super) struct Stream {
    key: [u8; 32],
    number: u64,
}

impl Stream {
    pub(super) fn new(seed: &Seed, identity: u64, purpose: Purpose) -> Self {
        Self {
            key: seed.key(),
            number: mix(identity ^ purpose as u64),
        }
    }

    /// Draw number `draw`: two numbers in 0..1, excluding 1.
    pub(super) fn draw(&self, draw: u64) -> [f64; 2] {
        self.redraw(draw, 0)
    }

    /// Replacement number `attempt` of draw number `draw`; 0 is the draw itself.
    pub(super) fn redraw(&self, draw: u64, attempt: u64) -> [f64; 2] {
        /// 32-bit words per draw.
        const WORDS: u128 = 4;
        let mut rng = ChaCha8Rng::from_seed(self.key);
        rng.set_stream(self.number);
        // Attempts are in the lower half, so that draws and attempts do not overlap.
        rng.set_word_pos(WORDS * (u128::from(draw) << 32 | u128::from(attempt)));
        [rng.random(), rng.random()]
    }
}

/// The random numbers of a bandit arm or a respawning object, and the number of draws so far.
#[derive(Clone, Debug)]
pub(super) struct ObjectRng {
    /// The object's index in the world.
    pub(super) object: usize,
    pulling: Stream,
    returning: Stream,
    /// Number of pulls so far.
    pub(super) pulls: u64,
    /// Number of respawns so far.
    pub(super) returns: u64,
    /// Number of positions tried so far for the next respawn.
    pub(super) tries: u64,
}

impl ObjectRng {
    /// The random numbers of an object; `None` if it needs none.
    pub(super) fn new(index: usize, object: &Object, seed: &Seed, identity: u64) -> Option<Self> {
        (object.reward_probability < 1.0 || object.respawn.is_some()).then(|| Self {
            object: index,
            pulling: Stream::new(seed, identity, Purpose::Pulls),
            returning: Stream::new(seed, identity, Purpose::Returns),
            pulls: 0,
            returns: 0,
            tries: 0,
        })
    }

    /// Whether the next pull pays, with this probability. The draw does not depend on the probability, so a lower probability
    /// only removes payments.
    pub(super) fn pull(&mut self, probability: f64) -> bool {
        let [unit, _] = self.pulling.draw(self.pulls);
        self.pulls += 1;
        unit < probability
    }

    /// Two numbers for the next position to try.
    pub(super) fn draw_position(&mut self) -> [f64; 2] {
        let place = self.returning.redraw(self.returns, self.tries);
        self.tries += 1;
        place
    }

    /// Records that the object has respawned.
    pub(super) fn record_return(&mut self) {
        self.returns += 1;
        self.tries = 0;
    }
}

/// A bijective mix of 64 bits (the finaliser of `SplitMix64`).
fn mix(bits: u64) -> u64 {
    let mut z = bits.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(place: [f64; 2], seed: Option<u64>) -> Object {
        Object {
            seed,
            ..Object::new("rock", place)
        }
    }

    #[test]
    fn draws_differ_by_index_object_and_purpose() {
        let mut drawn = Vec::new();
        for seed in [Seed::Own(1), Seed::Own(2), Seed::Places("ab".repeat(32))] {
            let mut identities = Identities::default();
            for object in [
                at([0.0, 0.0], None),
                at([0.0, 0.0], None),
                at([0.0, 1.0], None),
                at([0.0, 0.0], Some(0)),
                at([0.0, 1.0], Some(0)),
                at([0.0, 0.0], Some(1)),
            ] {
                let identity = identities.take(&object);
                for purpose in [Purpose::Goals, Purpose::Pulls, Purpose::Returns] {
                    let stream = Stream::new(&seed, identity, purpose);
                    let draws = [stream.draw(0), stream.draw(1), stream.redraw(0, 1)];
                    drawn.extend(draws.iter().flatten().map(|unit| unit.to_bits()));
                }
            }
        }
        let count = drawn.len();
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!((drawn.len(), count), (324, 324));
    }

    #[test]
    fn identity_follows_the_objects_seed_not_its_index() {
        let objects: Vec<Object> = (0..5).map(|seed| at([1.0, 2.0], Some(seed))).collect();
        let identities = |order: &[usize]| -> BTreeMap<usize, u64> {
            let mut identities = Identities::default();
            let of = |number: &usize| (*number, identities.take(&objects[*number]));
            order.iter().map(of).collect()
        };
        let all = identities(&[0, 1, 2, 3, 4]);
        assert_eq!(identities(&[4, 2, 0, 1, 3]), all);
        assert_eq!(identities(&[3]), [(3, all[&3])].into());
    }

    /// Pinned, because a change would affect every world with random numbers.
    #[test]
    fn random_numbers_are_stable() {
        let identity = Identities::default().take(&at([3.0, 4.0], Some(7)));
        let stream = Stream::new(&Seed::Own(5), identity, Purpose::Goals);
        assert_eq!(
            (identity, stream.draw(2)),
            (
                17_452_601_307_055_861_954,
                [0.604_290_513_060_048_8, 0.225_097_670_981_466_5]
            )
        );
    }

    #[test]
    fn draws_are_uniform() {
        let identity = Identities::default().take(&at([3.0, 4.0], None));
        let stream = Stream::new(&Seed::Own(5), identity, Purpose::Pulls);
        for axis in 0..2 {
            let mut units: Vec<f64> = (0..20_000).map(|draw| stream.draw(draw)[axis]).collect();
            units.sort_unstable_by(f64::total_cmp);
            // Kolmogorov–Smirnov: 1.95 / √n is α = 0.001.
            let gap = |(number, unit): (usize, &f64)| (unit - (number as f64 + 0.5) / 20_000.0).abs();
            let largest = units.iter().enumerate().map(gap).fold(0.0, f64::max);
            assert!(largest < 1.95 / 20_000_f64.sqrt(), "{largest}");
        }
    }
}
