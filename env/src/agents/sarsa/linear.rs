//! Linear Sarsa(λ): the value of an action is a weighted sum of the features.

use super::eye::FEATURES;

/// Learning rate.
const LEARNING_RATE: f32 = 0.02;

/// Features of an image.
pub(super) type Features = [f32; FEATURES];

/// Weights of `ACTIONS` actions, and their eligibility traces.
#[derive(Clone)]
pub(super) struct LinearSarsa<const ACTIONS: usize> {
    weights: Box<[Features; ACTIONS]>,
    traces: Box<[Features; ACTIONS]>,
}

impl<const ACTIONS: usize> LinearSarsa<ACTIONS> {
    /// All actions start with value 0.
    pub(super) fn new() -> Self {
        Self {
            weights: Box::new([[0.0; FEATURES]; ACTIONS]),
            traces: Box::new([[0.0; FEATURES]; ACTIONS]),
        }
    }

    /// The value of each action.
    pub(super) fn values(&self, features: &Features) -> [f32; ACTIONS] {
        std::array::from_fn(|action| self.weights[action].iter().zip(features).map(|(w, x)| w * x).sum())
    }

    /// Clears the traces and keeps the weights.
    pub(super) fn begin(&mut self) {
        for traces in self.traces.iter_mut() {
            traces.fill(0.0);
        }
    }

    /// Records an action: adds its features to the traces, after earlier traces have been multiplied by `decay`.
    pub(super) fn record(&mut self, features: &Features, action: usize, decay: f32) {
        for trace in self.traces.iter_mut().flatten() {
            *trace *= decay;
        }
        for (trace, x) in self.traces[action].iter_mut().zip(features) {
            *trace += x;
        }
    }

    /// Learns that the last action was worth `error` more than predicted, given the features before it. The step is divided by
    /// their squared norm, so that the learning rate does not depend on how many features are active.
    pub(super) fn learn(&mut self, features: &Features, error: f32) {
        let size = features.iter().map(|x| x * x).sum::<f32>().max(1.0);
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
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// Compares the traces with a plain sum over all errors and earlier actions.
        #[test]
        fn weights_equal_the_sum_over_errors_and_earlier_actions(
            steps in proptest::collection::vec((0_usize..FEATURES, 0.1_f32..2.0, 0_usize..3, -1.0_f32..1.0), 1..12),
            decay in 0.0_f32..1.0,
        ) {
            let mut learner = LinearSarsa::<3>::new();
            let features_at = |t: usize| {
                let mut features = [0.0; FEATURES];
                features[steps[t].0] = steps[t].1;
                features
            };
            for (t, (_, _, action, error)) in steps.iter().enumerate() {
                learner.record(&features_at(t), *action, decay);
                learner.learn(&features_at(t), *error);
            }
            for (k, (feature, _, action, _)) in steps.iter().enumerate() {
                let mut expected = 0.0_f64;
                for (t, (_, x, _, error)) in steps.iter().enumerate() {
                    let step = f64::from(LEARNING_RATE * error) / f64::from((x * x).max(1.0));
                    for (earlier, other) in steps.iter().enumerate().take(t + 1) {
                        if (other.0, other.2) == (*feature, *action) {
                            expected += step * f64::from(decay).powi((t - earlier) as i32) * f64::from(other.1);
                        }
                    }
                }
                let found = f64::from(learner.weights[*action][*feature]);
                prop_assert!((found - expected).abs() < 1e-5, "action {}: {} and {}", k, found, expected);
            }
        }
    }

    #[test]
    fn value_of_a_repeated_action_converges_to_its_reward() {
        let mut learner = LinearSarsa::<2>::new();
        let mut features = [0.0; FEATURES];
        (features[3], features[FEATURES - 1]) = (0.5, 1.0);
        for _ in 0..500 {
            learner.begin();
            learner.record(&features, 1, 0.5);
            learner.learn(&features, 2.0 - learner.values(&features)[1]);
        }
        let [unused, repeated] = learner.values(&features);
        assert!((repeated - 2.0).abs() < 0.01, "{repeated}");
        assert_eq!(unused, 0.0);
    }
}
