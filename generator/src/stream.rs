//! Random streams: each source of random numbers has its own stream, addressed by world and object.

use std::convert::Infallible;

use driftworld_spec::{MAX_SEED, philox};
use rand::TryRng;
use sha2::{Digest, Sha256};

/// One named stream of a task under a seed.
///
/// The numbers come from Philox, keyed by the SHA-256 of task, seed and name; world, object and attempt form the counter.
/// Numbers can be accessed in any order: each is computed without the others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stream {
    key: [u64; 2],
}

impl Stream {
    pub(crate) fn new(task: &str, seed: u64, name: &str) -> Self {
        let mut hash = Sha256::new();
        hash.update(b"driftworld stream 2\0");
        for part in [task.as_bytes(), &seed.to_le_bytes(), name.as_bytes()] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        let digest = hash.finalize();
        let word = |from: usize| u64::from_le_bytes(std::array::from_fn(|byte| digest[from + byte]));
        Self {
            key: [word(0), word(8)],
        }
    }

    /// The random numbers of one object in one world; `attempt` is the number of times that the world was sampled again.
    pub(crate) fn at(&self, index: u64, object: u64, attempt: u32) -> Rng {
        Rng {
            key: self.key,
            counter: [index, object, 0, u64::from(attempt)],
            numbers: [0; 4],
            used: 4,
        }
    }

    /// Seed number `number`: an integer up to [`MAX_SEED`].
    pub(crate) fn seed(&self, number: u64) -> u64 {
        philox(self.key, [number, 0, 0, 0])[0] & MAX_SEED
    }

    /// Like [`Stream::seed`], for a world that was sampled again `attempt` times.
    pub(crate) fn seed_at(&self, number: u64, attempt: u32) -> u64 {
        philox(self.key, [number, 0, 0, u64::from(attempt)])[0] & MAX_SEED
    }

    /// A number that is the same for all worlds of the stream.
    pub(crate) fn constant(&self, number: u64) -> u64 {
        philox(self.key, [number, 0, 0, u64::MAX])[0]
    }
}

/// The random numbers of one object in one world.
pub(crate) struct Rng {
    key: [u64; 2],
    counter: [u64; 4],
    numbers: [u64; 4],
    used: usize,
}

impl Rng {
    fn next(&mut self) -> u64 {
        if self.used == self.numbers.len() {
            self.numbers = philox(self.key, self.counter);
            self.counter[2] += 1;
            self.used = 0;
        }
        self.used += 1;
        self.numbers[self.used - 1]
    }

    /// A number strictly between 0 and 1, with 52 random bits.
    pub(crate) fn unit(&mut self) -> f64 {
        unit(self.next())
    }

    /// An integer below `bound`, which is at least 1.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        ((self.unit() * bound as f64) as usize).min(bound - 1)
    }
}

/// 64 bits as a number strictly between 0 and 1.
pub(crate) fn unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64)
}

/// Lets the distributions of `rand_distr` draw from this generator.
impl TryRng for Rng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok((self.next() >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.next())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(8) {
            chunk.copy_from_slice(&self.next().to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_address_has_its_own_numbers() {
        let stream = Stream::new("task", 7, "parameter/light");
        let first = |stream: &Stream, index, object, attempt| stream.at(index, object, attempt).next();
        let all = [
            first(&stream, 0, 0, 0),
            first(&stream, 1, 0, 0),
            first(&stream, 0, 1, 0),
            first(&stream, 0, 0, 1),
            first(&Stream::new("task", 8, "parameter/light"), 0, 0, 0),
            first(&Stream::new("task", 7, "parameter/dark"), 0, 0, 0),
            first(&Stream::new("other", 7, "parameter/light"), 0, 0, 0),
        ];
        let different: std::collections::BTreeSet<u64> = all.into_iter().collect();
        assert_eq!(different.len(), all.len());
    }

    #[test]
    fn unit_number_is_strictly_between_0_and_1() {
        assert!(unit(0) > 0.0 && unit(u64::MAX) < 1.0);
    }
}
