//! Jeffreys' divergence: Kullback and Leibler's both ways. One way alone is in `kullback_leibler.rs`.

use driftworld_spec::Distribution;

use super::kullback_leibler::kullback_leibler;
use super::measured::Measured;

/// KL(P ‖ Q) + KL(Q ‖ P) in nats: Σ (p − q) ln(p / q), for densities ∫ (f − g) ln(f / g).
///
/// In `0..=∞`: symmetric, 0 for equals only, no triangle inequality, and infinite as soon as one draws what the other
/// cannot. Takes what [`kullback_leibler`](super::kullback_leibler()) takes, as exactly.
///
/// Source: Jeffreys 1946, "An invariant form for the prior probability in estimation problems".
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::jeffreys;
/// use driftworld_spec::Distribution::{Normal, Uniform};
/// let normal = |mean| Normal { mean, std: 1.0 };
/// // The square of the difference in standard deviations.
/// assert!((jeffreys(&normal(0.0), &normal(3.0)).unwrap().value - 9.0).abs() < 1e-12);
/// assert_eq!(jeffreys(&normal(0.0), &Uniform { low: 0.0, high: 1.0 }).unwrap().value, f64::INFINITY);
/// ```
pub fn jeffreys(a: &Distribution, b: &Distribution) -> Option<Measured> {
    Some(kullback_leibler(a, b)?.plus(kullback_leibler(b, a)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::{Method, jensen_shannon_divergence};
    use Distribution::{Bernoulli, Beta, Exponential, Normal, Uniform};
    use proptest::prelude::*;

    fn laws() -> impl Strategy<Value = Distribution> {
        let beta = (0.5..5.0_f64, 0.5..5.0_f64, 1.0..3.0_f64);
        prop_oneof![
            (0.01..0.99_f64).prop_map(|p| Bernoulli { p }),
            (-3.0..3.0_f64, 0.2..4.0_f64).prop_map(|(mean, std)| Normal { mean, std }),
            (0.1..4.0_f64).prop_map(|rate| Exponential { rate }),
            (0.0..1.0_f64, 1.0..3.0_f64).prop_map(|(low, high)| Uniform { low, high }),
            beta.prop_map(|(alpha, beta, high)| Beta {
                alpha,
                beta,
                low: None,
                high: Some(high)
            }),
        ]
    }

    #[test]
    fn formulas_are_met() {
        let check = |a: &Distribution, b: &Distribution, expected: f64| {
            let found = jeffreys(a, b).unwrap();
            assert!(
                (found.value - expected).abs() < 1e-12 && found.method == Method::Closed,
                "{found:?}"
            );
        };
        // (r − s)² / rs.
        check(&Exponential { rate: 1.0 }, &Exponential { rate: 4.0 }, 9.0 / 4.0);
        let (a, b) = (Normal { mean: 0.0, std: 1.0 }, Normal { mean: 1.0, std: 2.0 });
        // ½ (s²/t² + t²/s²) − 1 + ½ (m − n)² (1/s² + 1/t²).
        check(&a, &b, 0.5 * (4.0 + 0.25) - 1.0 + 0.5 * (1.0 + 0.25));
        let coins = jeffreys(&Bernoulli { p: 0.2 }, &Bernoulli { p: 0.5 }).unwrap();
        let expected = 0.3 * libm::log(0.8 / 0.2);
        assert!((coins.value - expected).abs() < 1e-12, "{coins:?}");
    }

    #[test]
    fn errors_of_both_ways_add_up() {
        let (a, b) = (Measured::quadrature(1.0, 1e-9), Measured::quadrature(2.0, 2e-9));
        let Method::Quadrature { tolerance } = a.plus(b).method else {
            panic!("by quadrature")
        };
        assert!((tolerance - 3e-9).abs() < 1e-20);
        assert_eq!(Measured::closed(1.0).plus(a), Measured::quadrature(2.0, 1e-9));
        assert_eq!(Measured::closed(1.0).plus(Measured::atoms(2.0)), Measured::atoms(3.0));
    }

    proptest! {
        #[test]
        fn it_is_as_far_there_as_back_and_0_for_equals(a in laws(), b in laws()) {
            let d = |a, b| jeffreys(a, b).unwrap().value;
            prop_assert_eq!(d(&a, &a), 0.0);
            prop_assert_eq!(d(&a, &b), d(&b, &a));
            // Lin 1991: Jensen and Shannon's divergence is a quarter of it at most, in nats.
            let bits = jensen_shannon_divergence(&a, &b).unwrap().value;
            prop_assert!(bits * std::f64::consts::LN_2 <= d(&a, &b) / 4.0 + 1e-6, "{bits}");
        }
    }
}
