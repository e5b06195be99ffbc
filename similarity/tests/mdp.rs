//! Compares distances between random decision processes with `SciPy`'s linear programs.

use driftworld_similarity::{Mdp, bisimulation, w1_mdp};
use serde::Deserialize;

use crate::draws::Rng;

#[derive(Deserialize)]
struct Oracle {
    cases: Vec<Vec<f64>>,
}

impl Rng {
    /// For each state and action a successor, then a reward in thousandths, from −1 to 1.
    fn process(&mut self, states: usize, actions: usize) -> Mdp {
        let (mut successors, mut rewards) = (Vec::new(), Vec::new());
        for _ in 0..states * actions {
            successors.push(self.below(states as u64) as u32);
            rewards.push((self.below(2001) as f64 - 1000.0) / 1000.0);
        }
        Mdp::new(states, actions, successors, rewards).expect("the tables are valid")
    }
}

/// The contents of an oracle case, in order: the mean of all bisimulation distances, and W₁-MDP for processes of equal size.
/// Draws in the order of `drawn` in `oracle/make_mdp.py`: 1 to 6 states; for the second process the same number (one in two) or
/// 1 to 6; 1 to 3 actions; a discount of 0.3, 0.5 or 0.7; both processes; the reward that counts as 1, in quarters up to 1;
/// which states count besides the first (one in two).
fn drawn(seed: u64) -> Vec<f64> {
    let mut rng = Rng(seed);
    let of_a = 1 + rng.below(6) as usize;
    let of_b = if rng.below(2) == 0 {
        of_a
    } else {
        1 + rng.below(6) as usize
    };
    let actions = 1 + rng.below(3) as usize;
    let discount = (3 + 2 * rng.below(3)) as f64 / 10.0;
    let (a, b) = (rng.process(of_a, actions), rng.process(of_b, actions));
    let unit = (1 + rng.below(4)) as f64 / 4.0;
    let counted: Vec<bool> = (0..of_a).map(|state| rng.below(2) == 1 || state == 0).collect();
    let mut sum = 0.0;
    for (s, t) in (0..of_a).flat_map(|s| (0..of_b).map(move |t| (s, t))) {
        let found = bisimulation(&a, &b, (s, t), discount, 1000).expect("the processes have the same actions");
        assert!(found.upper - found.lower < 1e-12, "all pairs were visited");
        sum += found.upper;
    }
    let mut found = vec![sum / (of_a * of_b) as f64];
    if of_a == of_b {
        let rows = || (0..of_a).flat_map(|state| (0..actions).map(move |action| (state, action)));
        let rewards = |of: &Mdp| -> Vec<f64> { rows().map(|(state, action)| of.reward(state, action)).collect() };
        let line = |row: usize| {
            let leads = |of: &Mdp| of.successor(row / actions, row % actions);
            f64::from(leads(&a).abs_diff(leads(&b))) / 2.0
        };
        let parts = w1_mdp([&rewards(&a), &rewards(&b)], unit, &counted, line).expect("the tables have the same size");
        found.push(parts.0 + parts.1);
    }
    found
}

#[test]
fn random_processes_match_scipy() {
    let oracle: Oracle = serde_json::from_str(include_str!("oracle/mdp.json")).expect("the oracle is valid");
    assert_eq!(oracle.cases.len(), 1000);
    for (seed, expected) in oracle.cases.iter().enumerate() {
        let found = drawn(seed as u64);
        assert_eq!(found.len(), expected.len(), "draw {seed}");
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-9,
                "draw {seed}: {found}, oracle {expected}"
            );
        }
    }
}
