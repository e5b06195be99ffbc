//! Streams of chance: every source of numbers has one of its own, addressed by world and object. What is drawn from them is in `draw.rs`.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

/// Words that each object's share of a stream holds before it would run into its neighbour's: 2^20 draws.
const WORDS_PER_OBJECT: u128 = 1 << 21;

/// The key of one named stream of a task under a seed.
///
/// The numbers are `ChaCha8`'s under a key that is the SHA-256 of task, seed and name; the world's index is the stream
/// number and the object's number the place in it. Any of them can be had without any other.
#[derive(Clone, Debug)]
pub(crate) struct Stream {
    base: ChaCha8Rng,
}

impl Stream {
    pub(crate) fn new(task: &str, seed: u64, name: &str) -> Self {
        let mut hash = Sha256::new();
        hash.update(b"driftworld stream 1\0");
        for part in [task.as_bytes(), &seed.to_le_bytes(), name.as_bytes()] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        Self {
            base: ChaCha8Rng::from_seed(hash.finalize().into()),
        }
    }

    /// The numbers of one object in one world.
    pub(crate) fn at(&self, index: u64, object: u32) -> Chance {
        let mut rng = self.base.clone();
        rng.set_stream(index);
        rng.set_word_pos(u128::from(object) * WORDS_PER_OBJECT);
        Chance(rng)
    }
}

/// A source of numbers at one place.
pub(crate) struct Chance(ChaCha8Rng);

impl Chance {
    /// A number in 0..1, 53 bits of it chance.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A whole number in 0..n, each alike; `n` is above 0.
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        // Lemire's multiplication, with rejection of the short remainder.
        let threshold = n.wrapping_neg() % n;
        loop {
            let product = u128::from(self.0.next_u64()) * u128::from(n);
            if product as u64 >= threshold {
                return (product >> 64) as u64;
            }
        }
    }
}
