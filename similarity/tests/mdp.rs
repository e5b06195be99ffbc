//! Distances of drawn decision processes against what `SciPy` finds by linear programs. The laws are tested beside the code.

use driftworld_similarity::{Mdp, bisimulation, w1_mdp, w1_mdp_pooled};
use serde::Deserialize;

use crate::draws::Rng;

#[derive(Deserialize)]
struct Oracle {
    cases: Vec<Vec<f64>>,
}

impl Rng {
    /// For each state and action: 1 to 3 successors, each drawn evenly with a weight of 1 to 8, one that is drawn again with both;
    /// then a reward in thousandths, from −1 to 1.
    fn process(&mut self, states: usize, actions: usize) -> Mdp {
        let (mut rows, mut rewards) = (Vec::new(), Vec::new());
        for _ in 0..states * actions {
            let mut row = vec![0.0; states];
            for _ in 0..=self.below(3) {
                let successor = self.below(states as u64) as usize;
                row[successor] += 1.0 + self.below(8) as f64;
            }
            let sum: f64 = row.iter().sum();
            rows.push(row.into_iter().map(|weight| weight / sum).enumerate().collect());
            rewards.push((self.below(2001) as f64 - 1000.0) / 1000.0);
        }
        Mdp::new(states, actions, &rows, rewards).expect("the rows are sound")
    }
}

/// What a case of the oracle holds, in its order; the last four for processes of one size only. Draws in the order of `drawn` in
/// `oracle/make_mdp.py`: 1 to 4 states, in the second as many (one in two) or 1 to 4; 1 to 3 actions; a discount of 0.3, 0.5 or
/// 0.7; both processes; weights of the states of each, 1 to 5.
fn drawn(seed: u64) -> Vec<(&'static str, f64)> {
    let mut rng = Rng(seed);
    let of_a = 1 + rng.below(4) as usize;
    let of_b = if rng.below(2) == 0 {
        of_a
    } else {
        1 + rng.below(4) as usize
    };
    let actions = 1 + rng.below(3) as usize;
    let discount = (3 + 2 * rng.below(3)) as f64 / 10.0;
    let (a, b) = (rng.process(of_a, actions), rng.process(of_b, actions));
    let mut weights = |count: usize| -> Vec<f64> { (0..count).map(|_| 1.0 + rng.below(5) as f64).collect() };
    let (start_a, start_b) = (weights(of_a), weights(of_b));
    let d = bisimulation(&a, &b, discount, 1e-10).expect("the processes have the same actions");
    let values = a.optimal_values(discount, 1e-11).expect("the discount is sound");
    let mut found = vec![
        (
            "mean of bisimulation",
            d.values().iter().sum::<f64>() / d.values().len() as f64,
        ),
        ("hausdorff", d.hausdorff()),
        (
            "kantorovich",
            d.kantorovich(&start_a, &start_b).expect("the weights are sound"),
        ),
        ("values", values.iter().map(|value| value.abs()).sum()),
    ];
    if of_a == of_b {
        let line = |s: usize, t: usize| s.abs_diff(t) as f64 / 2.0;
        let best = d.best_match().expect("the processes are of one size");
        found.push(("mean of best match", best.mean));
        found.push(("largest of best match", best.largest));
        found.push((
            "w1",
            w1_mdp(&a, &b, &start_a, line).expect("the processes are of one size"),
        ));
        found.push((
            "w1 pooled",
            w1_mdp_pooled(&a, &b, &start_a, line).expect("the processes are of one size"),
        ));
    }
    found
}

/// A quarter of the draws, so that they are checked side by side.
fn check_quarter(quarter: usize) {
    let oracle: Oracle = serde_json::from_str(include_str!("oracle/mdp.json")).expect("the oracle is sound");
    assert_eq!(oracle.cases.len(), 1000);
    for (seed, expected) in oracle.cases.iter().enumerate().skip(quarter).step_by(4) {
        let found = drawn(seed as u64);
        assert_eq!(found.len(), expected.len(), "draw {seed}");
        for ((what, found), expected) in found.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-9,
                "draw {seed}, {what}: {found}, oracle {expected}"
            );
        }
    }
}

#[test]
fn drawn_processes_are_as_far_apart_as_scipy_says() {
    check_quarter(0);
}

#[test]
fn drawn_processes_are_as_far_apart_as_scipy_says_second_quarter() {
    check_quarter(1);
}

#[test]
fn drawn_processes_are_as_far_apart_as_scipy_says_third_quarter() {
    check_quarter(2);
}

#[test]
fn drawn_processes_are_as_far_apart_as_scipy_says_fourth_quarter() {
    check_quarter(3);
}
