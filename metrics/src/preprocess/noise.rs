//! Gaussian noise on the performances of a lifetime, after all other preprocessing.

use std::f64::consts::PI;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::Options;
use crate::lifetime::Lifetime;

/// Adds noise, in normalised units, to every preprocessed performance of the lifetime. Logged values and the experts' performances
/// are unchanged.
///
/// The same seed gives the same noise on every machine. The reference uses `NumPy`'s generator, unseeded.
pub(crate) fn disturb(lifetime: &mut Lifetime, options: &Options) {
    let Some(noise) = options.noise else { return };
    let mut generator = ChaCha8Rng::seed_from_u64(noise.seed);
    for regime in lifetime.own_regimes_mut() {
        for performance in &mut regime.performance {
            *performance += noise.mean + noise.std * standard_normal(&mut generator);
        }
    }
}

/// The Box–Muller method, using one of its two numbers.
fn standard_normal(generator: &mut ChaCha8Rng) -> f64 {
    // Uniform numbers of 53 bits; `radius` lies in 0 (exclusive) to 1, so that its logarithm is finite.
    let mut unit = || (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let (radius, turn) = (1.0 - unit(), unit());
    libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(2.0 * PI * turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_standard_normal_and_reproducible() {
        let mut generator = ChaCha8Rng::seed_from_u64(0);
        let numbers: Vec<f64> = (0..100_000).map(|_| standard_normal(&mut generator)).collect();
        let moment = |power: i32| numbers.iter().map(|number| number.powi(power)).sum::<f64>() / 1e5;
        // Standard errors of the first four moments at 100,000 numbers: 0.003, 0.0045, 0.012, 0.031.
        for (power, expected, tolerance) in [(1, 0.0, 0.013), (2, 1.0, 0.018), (3, 0.0, 0.05), (4, 3.0, 0.125)] {
            assert!(
                (moment(power) - expected).abs() < tolerance,
                "moment {power}: {}",
                moment(power)
            );
        }
        let first: Vec<String> = numbers[..3].iter().map(|number| format!("{number:.6}")).collect();
        assert_eq!(first, ["-1.535541", "1.440462", "-1.956916"]);
    }
}
