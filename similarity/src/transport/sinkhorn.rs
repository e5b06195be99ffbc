//! Entropic transport by Sinkhorn's iteration, with bounds that the exact cost lies between. The iteration is in `scaling.rs`, the exact
//! cost itself is found in `exact.rs`.

use serde::Serialize;

use super::exact::{check_costs, taken};
use super::masses::Units;
use super::scaling::Scaling;
use crate::SimilarityError;

/// Most steps.
pub const MAX_SINKHORN_STEPS: usize = 1_000_000;

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinkhornSettings {
    /// Weight of the entropy, in units of cost, above 0. The plan costs at most `regularisation · ln(places)` times the mass more
    /// than the cheapest: a hundredth of the largest cost is quick and within some percent.
    pub regularisation: f64,
    /// Share of the mass that may arrive at the wrong place when it stops, 1e-15 to 1.
    pub tolerance: f64,
    /// Steps after which it stops in any case, 1 to [`MAX_SINKHORN_STEPS`].
    pub max_steps: usize,
}

impl SinkhornSettings {
    /// This regularisation, a tolerance of 1e-6 and at most 10,000 steps.
    pub fn new(regularisation: f64) -> Self {
        Self {
            regularisation,
            tolerance: 1e-6,
            max_steps: 10_000,
        }
    }

    fn check(&self) -> Result<(), SimilarityError> {
        let bad = |name, found, expected| {
            Err(SimilarityError::BadNumber {
                of: name,
                found,
                expected,
            })
        };
        if !(1e-200..=1e200).contains(&self.regularisation) {
            return bad("regularisation", self.regularisation, "a number from 1e-200 to 1e200");
        }
        if !(1e-15..=1.0).contains(&self.tolerance) {
            return bad("tolerance", self.tolerance, "a number from 1e-15 to 1");
        }
        if !(1..=MAX_SINKHORN_STEPS).contains(&self.max_steps) {
            return bad("max_steps", self.max_steps as f64, "from 1 to 1000000");
        }
        Ok(())
    }
}

/// What Sinkhorn's iteration found, and how far off it can be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sinkhorn {
    /// The cost of the plan as the iteration left it: Σ P·C. What other tools return.
    pub cost: f64,
    /// The exact cost is not below this: the value of prices that are feasible.
    pub lower: f64,
    /// The exact cost is not above this: the cost of the plan after its row and column sums were put right.
    pub upper: f64,
    /// Share of the mass that leaves from or arrives at the wrong place: half the sum of absolute differences of row sums, plus that of
    /// column sums.
    pub marginal_error: f64,
    /// Steps at the regularisation asked for.
    pub steps: usize,
}

/// Transport with an entropic regularisation: the plan that minimises Σ P·C − ε·H(P), and its cost.
///
/// Shapes, units and masses as in [`optimal_transport`](crate::optimal_transport). Not a distance: equal masses cost more than 0,
/// the more the larger ε. What is stated is true whether or not it converged: `lower ≤ exact cost ≤ upper` within rounding, and
/// `marginal_error` is measured at the end; compare it with the tolerance to see whether the steps were enough.
///
/// Scaling steps on a kernel that takes up potentials (stabilised in the log domain), from a large ε down. Time
/// `steps · origins · destinations`, and more steps the smaller ε. Where [`optimal_transport`](crate::optimal_transport) is quick
/// enough, it is the better choice.
///
/// # Errors
/// As [`optimal_transport`](crate::optimal_transport), and [`SimilarityError::BadNumber`].
///
/// # Example
/// ```
/// use driftworld_similarity::{SinkhornSettings, sinkhorn};
/// let costs = [0.0, 5.0, 5.0, 0.0];
/// let found = sinkhorn(&[0.75, 0.25], &[0.25, 0.75], &costs, &SinkhornSettings::new(0.05))?;
/// assert!(found.lower <= 2.5 && 2.5 <= found.upper + 1e-12);
/// assert!(found.upper - found.lower < 1e-5);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Sources: Cuturi 2013; Schmitzer 2019 for the stabilisation; Altschuler, Weed and Rigollet 2017 for putting the sums right. Same
/// `cost` as `ot.sinkhorn2` (POT 0.9), see `tests/oracle/transport.json`.
pub fn sinkhorn(
    from: &[f64],
    to: &[f64],
    costs: &[f64],
    settings: &SinkhornSettings,
) -> Result<Sinkhorn, SimilarityError> {
    settings.check()?;
    check_costs(from.len(), to.len(), costs)?;
    let units = Units::of(from, to)?;
    let (origins, destinations) = (taken(&units.from)?, taken(&units.to)?);
    let total = units.from.iter().sum::<i64>() as f64;
    if origins.is_empty() {
        return Ok(Sinkhorn {
            cost: 0.0,
            lower: 0.0,
            upper: 0.0,
            marginal_error: 0.0,
            steps: 0,
        });
    }
    let share = |units: &[i64], places: &[usize]| places.iter().map(|&place| units[place] as f64 / total).collect();
    let row = |origin: usize| {
        let row = &costs[origin * to.len()..][..to.len()];
        destinations.iter().map(move |&destination| row[destination])
    };
    let among: Vec<f64> = origins.iter().copied().flat_map(row).collect();
    let mut scaling = Scaling::new(share(&units.from, &origins), share(&units.to, &destinations), &among);
    let steps = scaling.descend(settings);
    let mass = total * units.unit;
    let found = scaling.finish();
    Ok(Sinkhorn {
        cost: found.cost * mass,
        lower: found.lower * mass,
        upper: found.upper * mass,
        marginal_error: found.marginal_error,
        steps,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimal_transport;
    use proptest::prelude::*;

    /// Sources on a line and sinks on another.
    fn lines(n: usize, m: usize) -> Vec<f64> {
        (0..n)
            .flat_map(|i| (0..m).map(move |j| libm::hypot(i as f64 - j as f64, 1.0)))
            .collect()
    }

    #[test]
    fn a_small_regularisation_does_not_underflow() {
        let costs: Vec<f64> = lines(30, 30).iter().map(|cost| cost * 1e3).collect();
        let (from, to): (Vec<f64>, Vec<f64>) = (
            (1..=30).map(f64::from).collect(),
            (1..=30).rev().map(f64::from).collect(),
        );
        let exact = optimal_transport(&from, &to, &costs).unwrap().cost;
        let settings = SinkhornSettings {
            max_steps: 20_000,
            ..SinkhornSettings::new(1.0)
        };
        let found = sinkhorn(&from, &to, &costs, &settings).unwrap();
        assert!(found.marginal_error <= 1e-6, "{found:?}");
        assert!((found.cost - exact).abs() < 1e-3 * exact, "{found:?}, exact {exact}");
    }

    #[test]
    fn settings_out_of_range_are_refused() {
        for settings in [
            SinkhornSettings::new(0.0),
            SinkhornSettings::new(f64::NAN),
            SinkhornSettings {
                tolerance: 0.0,
                ..SinkhornSettings::new(1.0)
            },
            SinkhornSettings {
                max_steps: 0,
                ..SinkhornSettings::new(1.0)
            },
        ] {
            let found = sinkhorn(&[1.0], &[1.0], &[1.0], &settings).unwrap_err();
            assert_eq!(found.code(), "similarity/bad-number");
        }
    }

    #[test]
    fn nothing_costs_nothing() {
        let found = sinkhorn(&[0.0], &[], &[], &SinkhornSettings::new(1.0)).unwrap();
        assert_eq!((found.cost, found.lower, found.upper), (0.0, 0.0, 0.0));
    }

    proptest! {
        #[test]
        fn the_exact_cost_lies_between_the_bounds_even_after_few_steps(
            from in prop::collection::vec(0.01f64..1.0, 1..12),
            to in prop::collection::vec(0.01f64..1.0, 1..12),
            numbers in prop::collection::vec(0.0f64..1.0, 144),
            regularisation in prop::sample::select(vec![1e-3, 1e-2, 0.1, 1.0]),
            max_steps in 1usize..60,
        ) {
            let (sum_from, sum_to) = (from.iter().sum::<f64>(), to.iter().sum::<f64>());
            let to: Vec<f64> = to.iter().map(|mass| mass * sum_from / sum_to).collect();
            let costs = &numbers[..from.len() * to.len()];
            let exact = optimal_transport(&from, &to, costs).unwrap().cost;
            let settings = SinkhornSettings { max_steps, ..SinkhornSettings::new(regularisation) };
            let found = sinkhorn(&from, &to, costs, &settings).unwrap();
            prop_assert!(found.lower <= exact + 1e-9 && exact <= found.upper + 1e-9, "{:?}, exact {}", found, exact);
        }
    }
}
