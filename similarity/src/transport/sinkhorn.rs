//! Entropic transport by Sinkhorn's iteration, with bounds that the exact cost lies between. The exact cost itself is found in
//! `exact.rs`.

use serde::Serialize;

use super::exact::{check_costs, taken};
use super::masses::Units;
use crate::SimilarityError;

/// Most steps.
pub const MAX_SINKHORN_STEPS: usize = 1_000_000;

/// Scalings beyond this, or below its inverse, are taken up by the potentials.
const SCALING: f64 = 1e13;

/// Steps at each larger regularisation on the way down to the one asked for.
const STEPS_ON_THE_WAY: usize = 50;

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
        let bad = |name, found, expected| Err(SimilarityError::BadSetting { name, found, expected });
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
/// As [`optimal_transport`](crate::optimal_transport), and [`SimilarityError::BadSetting`].
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

/// The state of the iteration: P = u · exp((f + g − C) / ε) · v.
struct Scaling<'a> {
    a: Vec<f64>,
    b: Vec<f64>,
    costs: &'a [f64],
    f: Vec<f64>,
    g: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    kernel: Vec<f64>,
    epsilon: f64,
}

impl<'a> Scaling<'a> {
    fn new(a: Vec<f64>, b: Vec<f64>, costs: &'a [f64]) -> Self {
        Self {
            f: vec![0.0; a.len()],
            g: vec![0.0; b.len()],
            u: vec![1.0; a.len()],
            v: vec![1.0; b.len()],
            kernel: vec![0.0; costs.len()],
            epsilon: 0.0,
            a,
            b,
            costs,
        }
    }

    /// From a regularisation as large as the costs down to the one asked for. Returns the steps at the last.
    fn descend(&mut self, settings: &SinkhornSettings) -> usize {
        let (least, largest) = self
            .costs
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &cost| {
                (cost.min(low), cost.max(high))
            });
        let mut epsilon = largest - least;
        while epsilon > 2.0 * settings.regularisation {
            self.iterate(epsilon, 1e-3, STEPS_ON_THE_WAY);
            epsilon /= 4.0;
        }
        self.iterate(settings.regularisation, settings.tolerance, settings.max_steps)
    }

    /// Scales rows and columns in turn until row sums are right within the tolerance. Returns the steps.
    fn iterate(&mut self, epsilon: f64, tolerance: f64, max_steps: usize) -> usize {
        self.epsilon = epsilon;
        self.fit_potentials();
        let (mut rows, mut columns) = (vec![0.0; self.a.len()], vec![0.0; self.b.len()]);
        for step in 1..=max_steps {
            times(&self.kernel, &self.v, &mut rows);
            let off: f64 = self
                .u
                .iter()
                .zip(&rows)
                .zip(&self.a)
                .map(|((u, row), a)| (u * row - a).abs())
                .sum();
            if off <= 2.0 * tolerance && step > 1 {
                return step - 1;
            }
            scale(&mut self.u, &self.a, &rows);
            times_transposed(&self.kernel, &self.u, &mut columns);
            scale(&mut self.v, &self.b, &columns);
            let extreme = |scaling: &f64| !(1.0 / SCALING..=SCALING).contains(scaling);
            if self.u.iter().chain(&self.v).any(extreme) {
                self.absorb();
                self.fit_potentials();
            }
        }
        max_steps
    }

    /// Moves the logarithms of the scalings into the potentials. Those that ran out of range are left to `fit_potentials`.
    fn absorb(&mut self) {
        let potentials = self.f.iter_mut().zip(&self.u).chain(self.g.iter_mut().zip(&self.v));
        for (potential, &scaling) in potentials {
            if scaling > 0.0 && scaling.is_finite() {
                *potential += self.epsilon * libm::log(scaling);
            }
        }
    }

    /// One step in the log domain, where nothing overflows: rows, then columns; then the kernel anew.
    fn fit_potentials(&mut self) {
        let (epsilon, width) = (self.epsilon, self.b.len());
        for (origin, (f, a)) in self.f.iter_mut().zip(&self.a).enumerate() {
            let row = self.costs[origin * width..][..width].iter().zip(&self.g);
            *f = epsilon * libm::log(*a) - soft_max(epsilon, row.map(|(cost, g)| g - cost));
        }
        for (destination, (g, b)) in self.g.iter_mut().zip(&self.b).enumerate() {
            let column = self.costs[destination..].iter().step_by(width).zip(&self.f);
            *g = epsilon * libm::log(*b) - soft_max(epsilon, column.map(|(cost, f)| f - cost));
        }
        for (origin, row) in self.kernel.chunks_exact_mut(width).enumerate() {
            let costs = &self.costs[origin * width..][..width];
            for ((kernel, cost), g) in row.iter_mut().zip(costs).zip(&self.g) {
                *kernel = libm::exp((self.f[origin] + g - cost) / epsilon);
            }
        }
        self.u.fill(1.0);
        self.v.fill(1.0);
    }

    /// What the plan costs, how wrong its sums are, and bounds of the exact cost; for a mass of 1.
    fn finish(mut self) -> Sinkhorn {
        let width = self.b.len();
        let mut plan = std::mem::take(&mut self.kernel);
        for (row, u) in plan.chunks_exact_mut(width).zip(&self.u) {
            for (entry, v) in row.iter_mut().zip(&self.v) {
                *entry *= u * v;
            }
        }
        let cost = dot(&plan, self.costs);
        let (mut rows, mut columns) = (vec![0.0; self.a.len()], vec![0.0; width]);
        let (ones_a, ones_b) = (vec![1.0; self.a.len()], vec![1.0; width]);
        times(&plan, &ones_b, &mut rows);
        times_transposed(&plan, &ones_a, &mut columns);
        let off = |sums: &[f64], masses: &[f64]| -> f64 {
            let apart = sums.iter().zip(masses).map(|(sum, mass)| (sum - mass).abs());
            apart.sum::<f64>() / 2.0
        };
        let marginal_error = off(&rows, &self.a) + off(&columns, &self.b);
        // Too full rows are thinned, then too full columns; what is missing is spread over all pairs in proportion.
        for (entries, (sum, mass)) in plan.chunks_exact_mut(width).zip(rows.iter().zip(&self.a)) {
            let thinner = if sum > mass { mass / sum } else { 1.0 };
            entries.iter_mut().for_each(|entry| *entry *= thinner);
        }
        times_transposed(&plan, &ones_a, &mut columns);
        let thinner: Vec<f64> = columns
            .iter()
            .zip(&self.b)
            .map(|(sum, mass)| if sum > mass { mass / sum } else { 1.0 })
            .collect();
        for entries in plan.chunks_exact_mut(width) {
            entries
                .iter_mut()
                .zip(&thinner)
                .for_each(|(entry, thinner)| *entry *= thinner);
        }
        times(&plan, &ones_b, &mut rows);
        times_transposed(&plan, &ones_a, &mut columns);
        let missing = |masses: &[f64], sums: &[f64]| -> Vec<f64> {
            masses
                .iter()
                .zip(sums)
                .map(|(mass, sum)| (mass - sum).max(0.0))
                .collect()
        };
        let (missing_rows, missing_columns) = (missing(&self.a, &rows), missing(&self.b, &columns));
        let whole: f64 = missing_rows.iter().sum();
        let mut upper = dot(&plan, self.costs);
        if whole > 0.0 {
            let mut costs = vec![0.0; self.a.len()];
            times(self.costs, &missing_columns, &mut costs);
            upper += dot(&costs, &missing_rows) / whole;
        }
        Sinkhorn {
            cost,
            upper,
            lower: self.lower(),
            marginal_error,
            steps: 0,
        }
    }

    /// The value of the potentials once they are raised as far as the costs allow and no further.
    fn lower(&mut self) -> f64 {
        self.absorb();
        let width = self.b.len();
        let mut highest = vec![f64::INFINITY; width];
        for (row, f) in self.costs.chunks_exact(width).zip(&self.f) {
            highest
                .iter_mut()
                .zip(row)
                .for_each(|(high, cost)| *high = high.min(cost - f));
        }
        let rows = self.costs.chunks_exact(width);
        let first: f64 = rows
            .zip(&self.a)
            .map(|(row, a)| {
                a * row
                    .iter()
                    .zip(&highest)
                    .map(|(cost, g)| cost - g)
                    .fold(f64::INFINITY, f64::min)
            })
            .sum();
        first + dot(&highest, &self.b)
    }
}

/// ε · ln Σ exp(x / ε), without overflow.
fn soft_max(epsilon: f64, numbers: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = numbers.clone().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = numbers.map(|number| libm::exp((number - largest) / epsilon)).sum();
    largest + epsilon * libm::log(sum)
}

/// Scalings that make sums right: mass over sum; where a sum has vanished, what was there stays.
fn scale(scalings: &mut [f64], masses: &[f64], sums: &[f64]) {
    for ((scaling, mass), sum) in scalings.iter_mut().zip(masses).zip(sums) {
        if *sum > 0.0 {
            *scaling = mass / sum;
        }
    }
}

/// A table times a column.
fn times(table: &[f64], column: &[f64], result: &mut [f64]) {
    for (result, row) in result.iter_mut().zip(table.chunks_exact(column.len())) {
        *result = dot(row, column);
    }
}

/// The table turned round times a column.
fn times_transposed(table: &[f64], column: &[f64], result: &mut [f64]) {
    result.fill(0.0);
    for (row, factor) in table.chunks_exact(result.len()).zip(column) {
        result
            .iter_mut()
            .zip(row)
            .for_each(|(result, entry)| *result += factor * entry);
    }
}

/// Sum of products: eight sums side by side in a fixed order, which the compiler turns into vectors.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    let (first, second) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = first
        .remainder()
        .iter()
        .zip(second.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in first.zip(second) {
        for lane in 0..8 {
            lanes[lane] += a[lane] * b[lane];
        }
    }
    lanes.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimal_transport;
    use proptest::prelude::*;

    /// Sources on a line and sinks on another.
    fn lines(n: usize, m: usize) -> Vec<f64> {
        (0..n)
            .flat_map(|i| (0..m).map(move |j| (i as f64 - j as f64).hypot(1.0)))
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
            assert_eq!(found.code(), "similarity/bad-setting");
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
