//! [`CertainSums`]: the largest discounted sums of costs over deterministic steps.

/// Nodes with deterministic steps between them, each at a cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct CertainSums<'a> {
    /// Steps per node, at least 1.
    pub(super) steps: usize,
    /// `(nodes · steps,)`: the node that each step leads to.
    pub(super) next: &'a [u32],
    /// `(nodes · steps,)`: the cost of each step.
    pub(super) costs: &'a [f64],
    /// Discount of the next node's value, 0 to below 1.
    pub(super) discount: f64,
}

impl CertainSums<'_> {
    /// The largest sum from each node, `v(i) = max (cost + discount · v(next))`, and a bound on its error.
    ///
    /// Policy iteration (Howard 1960): choose one step per node, add up its path exactly (it ends in a cycle), choose better
    /// steps, until there are none. Costs scaled by `1 − discount` make `v` a mean; sums are exact within rounding over
    /// `1 − discount`.
    pub(super) fn solve(self) -> (Vec<f64>, f64) {
        let nodes = self.next.len() / self.steps;
        let largest = self
            .costs
            .iter()
            .fold(0.0, |largest: f64, cost| largest.max(cost.abs()));
        // Better by more than rounding, so that the iteration cannot cycle.
        let min_gain = 16.0 * f64::EPSILON * largest / ((1.0 - self.discount) * (1.0 - self.discount));
        let mut chosen: Vec<u32> = (0..nodes).map(|node| self.best(node, |_| 0.0).0).collect();
        loop {
            let values = self.sums_along(&chosen);
            let (mut improved, mut residual) = (false, 0.0_f64);
            for (node, step) in chosen.iter_mut().enumerate() {
                let (best, value) = self.best(node, |next| values[next]);
                residual = residual.max((value - values[node]).abs());
                if value > values[node] + min_gain {
                    *step = best;
                    improved = true;
                }
            }
            if !improved {
                return (values, residual / (1.0 - self.discount));
            }
        }
    }

    /// The first best step from a node, by the values of the next nodes.
    fn best(&self, node: usize, value: impl Fn(usize) -> f64) -> (u32, f64) {
        let mut best = (0, f64::NEG_INFINITY);
        for step in 0..self.steps {
            let at = node * self.steps + step;
            let found = self.costs[at] + self.discount * value(self.next[at] as usize);
            if found > best.1 {
                best = (step as u32, found);
            }
        }
        best
    }

    /// The sums along the chosen steps, followed for ever.
    fn sums_along(&self, chosen: &[u32]) -> Vec<f64> {
        let at = |node: usize| node * self.steps + chosen[node] as usize;
        let mut values = vec![f64::NAN; chosen.len()];
        // The path that first reached a node; 0 for none.
        let mut reached = vec![0_u32; chosen.len()];
        let mut path = Vec::new();
        for start in 0..chosen.len() {
            let mut node = start;
            while reached[node] == 0 {
                reached[node] = start as u32 + 1;
                path.push(node);
                node = self.next[at(node)] as usize;
            }
            if values[node].is_nan() {
                // The path closed a cycle: sum it once and extrapolate.
                let (mut sum, mut weight, mut current) = (0.0, 1.0, node);
                loop {
                    sum += weight * self.costs[at(current)];
                    weight *= self.discount;
                    current = self.next[at(current)] as usize;
                    if current == node {
                        break;
                    }
                }
                values[node] = sum / (1.0 - weight);
            }
            while let Some(node) = path.pop() {
                if values[node].is_nan() {
                    values[node] = self.costs[at(node)] + self.discount * values[self.next[at(node)] as usize];
                }
            }
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn solve(steps: usize, next: &[u32], costs: &[f64], discount: f64) -> Vec<f64> {
        let sums = CertainSums {
            steps,
            next,
            costs,
            discount,
        };
        let (values, error) = sums.solve();
        assert!(error < 1e-10, "{error}");
        values
    }

    #[test]
    fn paths_into_cycles_add_up() {
        // 0 leads into a cycle of 1 and 2.
        let found = solve(1, &[1, 2, 1], &[4.0, 1.0, 0.0], 0.5);
        let (one, two) = (4.0 / 3.0, 2.0 / 3.0);
        for (found, expected) in found.into_iter().zip([4.0 + one / 2.0, one, two]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn small_reward_is_given_up_for_a_larger_later_one() {
        // Stay for 1, or take two unpaid steps to a node that pays 3 for ever.
        let found = solve(2, &[0, 1, 2, 2, 2, 2], &[1.0, 0.0, 0.0, 0.0, 3.0, 0.0], 0.9);
        assert!((found[0] - 24.3).abs() < 1e-12);
        assert_eq!(solve(1, &[0], &[2.0], 0.0), [2.0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn no_step_improves_the_solution(
            next in prop::collection::vec(0_u32..20, 60),
            costs in prop::collection::vec(-4_i8..=4, 60),
            discount in 0.0..0.999,
        ) {
            let costs: Vec<f64> = costs.into_iter().map(f64::from).collect();
            let sums = CertainSums { steps: 3, next: &next, costs: &costs, discount };
            let (values, error) = sums.solve();
            prop_assert!(error < 1e-7, "{error}");
            for node in 0..20 {
                let best = sums.best(node, |next| values[next]).1;
                prop_assert!((best - values[node]).abs() < 1e-10 / (1.0 - discount));
            }
        }
    }
}
