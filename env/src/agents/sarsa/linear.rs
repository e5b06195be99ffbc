//! Linear Sarsa(λ): what a deed is worth is a weighted sum of what is seen. What is seen is in `eye.rs`, who acts in `mod.rs`.

use super::LEARNING_RATE;
use super::eye::FEATURES;

/// What is seen before a deed.
pub(super) type Seen = [f32; FEATURES];

/// Weights of `DEEDS` deeds, and what of them the errors to come will change.
#[derive(Clone)]
pub(super) struct LinearSarsa<const DEEDS: usize> {
    weights: Box<[Seen; DEEDS]>,
    traces: Box<[Seen; DEEDS]>,
}

impl<const DEEDS: usize> LinearSarsa<DEEDS> {
    /// All deeds are worth nothing.
    pub(super) fn new() -> Self {
        Self {
            weights: Box::new([[0.0; FEATURES]; DEEDS]),
            traces: Box::new([[0.0; FEATURES]; DEEDS]),
        }
    }

    /// What each deed is worth.
    pub(super) fn values(&self, seen: &Seen) -> [f32; DEEDS] {
        std::array::from_fn(|deed| self.weights[deed].iter().zip(seen).map(|(w, x)| w * x).sum())
    }

    /// Forgets what was done, not what was learned.
    pub(super) fn begin(&mut self) {
        for traces in self.traces.iter_mut() {
            traces.fill(0.0);
        }
    }

    /// What was done: it has a share in the errors to come, and earlier deeds only `decay` of the share that they had.
    pub(super) fn done(&mut self, seen: &Seen, deed: usize, decay: f32) {
        for trace in self.traces.iter_mut().flatten() {
            *trace *= decay;
        }
        for (trace, x) in self.traces[deed].iter_mut().zip(seen) {
            *trace += x;
        }
    }

    /// Learns that the last deed was worth so much more than was thought. `seen` is what was seen before it: the rate is that of
    /// one deed whatever the number of features that are on.
    pub(super) fn learn(&mut self, seen: &Seen, error: f32) {
        let size = seen.iter().map(|x| x * x).sum::<f32>().max(1.0);
        let step = LEARNING_RATE * error / size;
        let traces = self.traces.iter().flatten();
        for (weight, trace) in self.weights.iter_mut().flatten().zip(traces) {
            *weight += step * trace;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The weights are the sum over all errors of what every earlier deed has of them, however it is summed.
        #[test]
        fn weights_are_the_sum_over_errors_and_earlier_deeds(
            way in proptest::collection::vec((0_usize..FEATURES, 0.1_f32..2.0, 0_usize..3, -1.0_f32..1.0), 1..12),
            decay in 0.0_f32..1.0,
        ) {
            let mut learner = LinearSarsa::<3>::new();
            let seen_at = |t: usize| {
                let mut seen = [0.0; FEATURES];
                seen[way[t].0] = way[t].1;
                seen
            };
            for (t, (_, _, deed, error)) in way.iter().enumerate() {
                learner.done(&seen_at(t), *deed, decay);
                learner.learn(&seen_at(t), *error);
            }
            for (k, (feature, _, deed, _)) in way.iter().enumerate() {
                let mut expected = 0.0_f64;
                for (t, (_, x, _, error)) in way.iter().enumerate() {
                    let step = f64::from(LEARNING_RATE * error) / f64::from((x * x).max(1.0));
                    for (earlier, other) in way.iter().enumerate().take(t + 1) {
                        if (other.0, other.2) == (*feature, *deed) {
                            expected += step * f64::from(decay).powi((t - earlier) as i32) * f64::from(other.1);
                        }
                    }
                }
                let found = f64::from(learner.weights[*deed][*feature]);
                prop_assert!((found - expected).abs() < 1e-5, "deed {}: {} and {}", k, found, expected);
            }
        }
    }

    #[test]
    fn what_is_done_again_and_again_comes_to_be_worth_what_it_pays() {
        let mut learner = LinearSarsa::<2>::new();
        let mut seen = [0.0; FEATURES];
        (seen[3], seen[FEATURES - 1]) = (0.5, 1.0);
        for _ in 0..500 {
            learner.begin();
            learner.done(&seen, 1, 0.5);
            learner.learn(&seen, 2.0 - learner.values(&seen)[1]);
        }
        let [other, own] = learner.values(&seen);
        assert!((own - 2.0).abs() < 0.01, "{own}");
        assert_eq!(other, 0.0);
    }
}
