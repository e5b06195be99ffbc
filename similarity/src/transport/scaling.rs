//! [`Scaling`]: Sinkhorn's iteration, stabilised, and the bounds that its state proves. Masses and settings are checked in `sinkhorn.rs`.

use super::sinkhorn::{Sinkhorn, SinkhornSettings};

/// Scalings beyond this, or below its inverse, are taken up by the potentials.
const SCALING: f64 = 1e13;

/// Steps at each larger regularisation on the way down to the one asked for.
const STEPS_ON_THE_WAY: usize = 50;

/// The state of the iteration: P = u · exp((f + g − C) / ε) · v.
pub(super) struct Scaling<'a> {
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
    pub(super) fn new(a: Vec<f64>, b: Vec<f64>, costs: &'a [f64]) -> Self {
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
    pub(super) fn descend(&mut self, settings: &SinkhornSettings) -> usize {
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
    pub(super) fn finish(mut self) -> Sinkhorn {
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
            for entry in entries {
                *entry *= thinner;
            }
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

    #[test]
    fn what_is_left_out_is_put_right_and_priced() {
        // One step only: the rows are off, and both bounds still hold for the exact cost of 0.5.
        let costs = [0.0, 1.0, 1.0, 0.0];
        let mut scaling = Scaling::new(vec![0.75, 0.25], vec![0.25, 0.75], &costs);
        let settings = SinkhornSettings {
            max_steps: 1,
            ..SinkhornSettings::new(0.4)
        };
        assert_eq!(scaling.descend(&settings), 1);
        let found = scaling.finish();
        assert!(found.marginal_error > 1e-3, "{found:?}");
        assert!(found.lower <= 0.5 && 0.5 <= found.upper, "{found:?}");
    }

    #[test]
    fn sums_of_products_take_every_number() {
        let numbers: Vec<f64> = (1..=19).map(f64::from).collect();
        assert_eq!(dot(&numbers, &[2.0; 19]), 380.0);
        let mut sums = vec![0.0; 2];
        times_transposed(&[1.0, 2.0, 3.0, 4.0], &[10.0, 1.0], &mut sums);
        assert_eq!(sums, [13.0, 24.0]);
    }
}
