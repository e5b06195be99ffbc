//! The random numbers of a running world: a stream for each object and purpose. Who draws from them is in
//! `interactions.rs`, `motion.rs` and `mover.rs`.
//!
//! Every draw has a number, and is had without the draws before it: what an object draws for the third time depends on
//! the world's seed, on the object's own and on the 3, and on nothing else that is in the world or happens in it.

use std::collections::BTreeMap;

use driftworld_spec::{Object, World};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What the key of a world with a seed is filled up with.
const DOMAIN: [u8; 24] = *b"driftworld chance 1\0\0\0\0\0";

/// What all random numbers of a world depend on: its `seed`, or the hash of where things stood at its start.
///
/// Hashing costs as much as reading the world, so it waits until something draws.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum Seed {
    /// A world without a seed in which nothing has drawn yet.
    #[default]
    Unknown,
    /// The world's own.
    Own(u64),
    /// The hash of its places, 64 hexadecimal letters.
    Places(String),
}

impl Seed {
    /// The seed of a world at its start: known if it has one, or if one of its objects needs it.
    pub(super) fn of(world: &World, written: Option<String>) -> Self {
        let needed = || world.objects.iter().any(Object::takes_chances);
        match (world.seed, written) {
            (Some(seed), _) => Self::Own(seed),
            (None, Some(hash)) => Self::Places(hash),
            (None, None) if needed() => Self::Places(world.hash_of_places()),
            (None, None) => Self::Unknown,
        }
    }

    /// The hash of places, if that is the seed.
    pub(super) fn hash(&self) -> Option<&str> {
        match self {
            Self::Places(hash) => Some(hash),
            Self::Unknown | Self::Own(_) => None,
        }
    }

    /// Finds the seed if it is not known yet; `start` is the world before anything was spawned.
    pub(super) fn learn(&mut self, start: &World) {
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
            // The letters, not the bytes that they stand for: half of them is as good a key as any.
            Self::Places(hash) => key
                .iter_mut()
                .zip(hash.bytes())
                .for_each(|(byte, letter)| *byte = letter),
        }
        key
    }
}

/// What an object draws for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    /// Where a wanderer goes.
    Goals = 1,
    /// Whether a bandit arm pays.
    Pulls = 2,
    /// Where an object comes back.
    Returns = 3,
}

/// Which of a world's objects is meant, by what it is and not by where it stands in the list.
///
/// Objects with one seed, or without one at one place, are told apart by their order among each other.
#[derive(Clone, Debug, Default)]
pub(super) struct Identities {
    /// How many objects there are of each so far.
    taken: BTreeMap<u64, u64>,
}

impl Identities {
    /// The identity of the next object of a world; `object` is as it was at its start.
    pub(super) fn take(&mut self, object: &Object) -> u64 {
        let own = match object.seed {
            Some(seed) => mix(mix(1) ^ seed),
            None => object
                .coordinates
                .iter()
                // 0 has one form.
                .fold(mix(2), |mixed, metres| mix(mixed ^ (metres + 0.0).to_bits())),
        };
        let before = self.taken.entry(own).or_insert(0);
        *before += 1;
        mix(own ^ *before)
    }
}

/// The numbers that one object draws for one purpose.
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

    /// Draw number `draw`: two numbers, from 0 up to but not including 1.
    pub(super) fn draw(&self, draw: u64) -> [f64; 2] {
        self.redraw(draw, 0)
    }

    /// What draw number `draw` is replaced by for the `attempt`th time; the first is number 0.
    pub(super) fn redraw(&self, draw: u64, attempt: u64) -> [f64; 2] {
        /// Words of 32 bits that one draw takes.
        const WORDS: u128 = 4;
        let mut rng = ChaCha8Rng::from_seed(self.key);
        rng.set_stream(self.number);
        // Attempts in the lower half, so that neither runs into the other's numbers.
        rng.set_word_pos(WORDS * (u128::from(draw) << 32 | u128::from(attempt)));
        [rng.random(), rng.random()]
    }
}

/// The random numbers of a bandit arm, or of an object that comes back, and how many of them it has drawn.
#[derive(Clone, Debug)]
pub(super) struct ObjectRng {
    /// The object's number in the world.
    pub(super) object: usize,
    pulling: Stream,
    returning: Stream,
    /// Pulls so far.
    pub(super) pulls: u64,
    /// Returns so far.
    pub(super) returns: u64,
    /// Places tried for the next return.
    pub(super) tries: u64,
}

impl ObjectRng {
    /// Those of an object that needs any.
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

    /// Whether the next pull pays, with this probability. The same number decides whatever the probability: lowering it
    /// takes payments away and adds none.
    pub(super) fn pull(&mut self, probability: f64) -> bool {
        let [unit, _] = self.pulling.draw(self.pulls);
        self.pulls += 1;
        unit < probability
    }

    /// Two numbers for the next place that is tried.
    pub(super) fn draw_place(&mut self) -> [f64; 2] {
        let place = self.returning.redraw(self.returns, self.tries);
        self.tries += 1;
        place
    }

    /// Notes that the object has come back.
    pub(super) fn note_return(&mut self) {
        self.returns += 1;
        self.tries = 0;
    }
}

/// Spreads 64 bits over 64 bits, one to one (the finaliser of `SplitMix64`).
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
    fn every_draw_of_every_object_for_every_purpose_is_another() {
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
    fn an_object_is_known_by_its_seed_wherever_it_stands_in_the_list() {
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

    /// Pinned: if it changes, so does every world that draws.
    #[test]
    fn the_numbers_stay_as_they_are() {
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
    fn draws_are_spread_evenly() {
        let identity = Identities::default().take(&at([3.0, 4.0], None));
        let stream = Stream::new(&Seed::Own(5), identity, Purpose::Pulls);
        for axis in 0..2 {
            let mut units: Vec<f64> = (0..20_000).map(|draw| stream.draw(draw)[axis]).collect();
            units.sort_unstable_by(f64::total_cmp);
            // Kolmogorov and Smirnov: 1.95 / √n is α = 0.001.
            let gap = |(number, unit): (usize, &f64)| (unit - (number as f64 + 0.5) / 20_000.0).abs();
            let most = units.iter().enumerate().map(gap).fold(0.0, f64::max);
            assert!(most < 1.95 / 20_000_f64.sqrt(), "{most}");
        }
    }
}
