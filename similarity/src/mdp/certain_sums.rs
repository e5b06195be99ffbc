//! [`CertainSums`]: the largest discounted sums of costs over steps with one successor each. What the places and costs stand for is
//! known elsewhere.

/// Places from each of which some steps lead to others, at a cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct CertainSums<'a> {
    /// Steps from each place, at least 1.
    pub(super) steps: usize,
    /// `(places · steps,)`: where each step leads.
    pub(super) next: &'a [u32],
    /// `(places · steps,)`: what each step costs.
    pub(super) costs: &'a [f64],
    /// What the next place counts for, 0 to below 1.
    pub(super) discount: f64,
}

impl CertainSums<'_> {
    /// The largest sum from each place, `v(i) = max (cost + discount · v(next))`, and how far off one is at most.
    ///
    /// Policy iteration (Howard 1960): take one step from each place, add up its way exactly (it ends in a cycle), take better steps,
    /// until there is none. Costs of a share of `1 − discount` make `v` a mean; sums are exact within rounding over `1 − discount`.
    pub(super) fn solve(self) -> (Vec<f64>, f64) {
        let places = self.next.len() / self.steps;
        let largest = self
            .costs
            .iter()
            .fold(0.0, |largest: f64, cost| largest.max(cost.abs()));
        // Better by more than rounding, so that no step is taken back.
        let better = 16.0 * f64::EPSILON * largest / ((1.0 - self.discount) * (1.0 - self.discount));
        let mut chosen: Vec<u32> = (0..places).map(|place| self.best(place, |_| 0.0).0).collect();
        loop {
            let values = self.along(&chosen);
            let (mut improved, mut off) = (false, 0.0_f64);
            for (place, step) in chosen.iter_mut().enumerate() {
                let (best, value) = self.best(place, |next| values[next]);
                off = off.max((value - values[place]).abs());
                if value > values[place] + better {
                    *step = best;
                    improved = true;
                }
            }
            if !improved {
                return (values, off / (1.0 - self.discount));
            }
        }
    }

    /// The first best step from a place, by the values of the next.
    fn best(&self, place: usize, value: impl Fn(usize) -> f64) -> (u32, f64) {
        let mut best = (0, f64::NEG_INFINITY);
        for step in 0..self.steps {
            let at = place * self.steps + step;
            let found = self.costs[at] + self.discount * value(self.next[at] as usize);
            if found > best.1 {
                best = (step as u32, found);
            }
        }
        best
    }

    /// The sums of going on by the chosen steps for ever.
    fn along(&self, chosen: &[u32]) -> Vec<f64> {
        let at = |place: usize| place * self.steps + chosen[place] as usize;
        let mut values = vec![f64::NAN; chosen.len()];
        // By which way a place was reached first; 0 for none.
        let mut reached = vec![0_u32; chosen.len()];
        let mut way = Vec::new();
        for start in 0..chosen.len() {
            let mut place = start;
            while reached[place] == 0 {
                reached[place] = start as u32 + 1;
                way.push(place);
                place = self.next[at(place)] as usize;
            }
            if values[place].is_nan() {
                // The way met itself: once round the cycle and on for ever.
                let (mut sum, mut weight, mut on) = (0.0, 1.0, place);
                loop {
                    sum += weight * self.costs[at(on)];
                    weight *= self.discount;
                    on = self.next[at(on)] as usize;
                    if on == place {
                        break;
                    }
                }
                values[place] = sum / (1.0 - weight);
            }
            while let Some(place) = way.pop() {
                if values[place].is_nan() {
                    values[place] = self.costs[at(place)] + self.discount * values[self.next[at(place)] as usize];
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
    fn ways_into_cycles_add_up() {
        // 0 leads into a cycle of 1 and 2.
        let found = solve(1, &[1, 2, 1], &[4.0, 1.0, 0.0], 0.5);
        let (one, two) = (4.0 / 3.0, 2.0 / 3.0);
        for (found, expected) in found.into_iter().zip([4.0 + one / 2.0, one, two]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn a_small_pay_is_left_for_a_larger_one_farther_on() {
        // Stay for 1, or go two steps for nothing to where 3 is paid for ever.
        let found = solve(2, &[0, 1, 2, 2, 2, 2], &[1.0, 0.0, 0.0, 0.0, 3.0, 0.0], 0.9);
        assert!((found[0] - 24.3).abs() < 1e-12);
        assert_eq!(solve(1, &[0], &[2.0], 0.0), [2.0]);
    }

    proptest! {
        #[test]
        fn no_step_is_better(
            next in prop::collection::vec(0_u32..20, 60),
            costs in prop::collection::vec(-4_i8..=4, 60),
            discount in 0.0..0.999,
        ) {
            let costs: Vec<f64> = costs.into_iter().map(f64::from).collect();
            let sums = CertainSums { steps: 3, next: &next, costs: &costs, discount };
            let (values, error) = sums.solve();
            prop_assert!(error < 1e-7, "{error}");
            for place in 0..20 {
                let best = sums.best(place, |next| values[next]).1;
                prop_assert!((best - values[place]).abs() < 1e-10 / (1.0 - discount));
            }
        }
    }
}
