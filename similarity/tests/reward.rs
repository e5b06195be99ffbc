//! EPIC against what `NumPy` finds by the definitions of the reference. The laws are tested beside the code.

use driftworld_similarity::{Epic, RewardTable};
use serde::Deserialize;

use crate::draws::Rng;

#[derive(Deserialize)]
struct Oracle {
    names: Vec<String>,
    discount: f64,
    by_walks: Vec<Vec<Option<f64>>>,
    by_all: Vec<Vec<Option<f64>>>,
    drawn: Vec<f64>,
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracle/reward.json")).expect("the oracle is sound")
}

impl Rng {
    fn number(&mut self, bound: u64) -> f64 {
        self.below(bound) as f64
    }
}

const GOAL: [f64; 9] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
const TO_GOAL: [f64; 9] = [4.0, 3.0, 2.0, 3.0, 2.0, 1.0, 2.0, 1.0, 0.0];

/// The reward of each state and the potential, as in the reference's `gridworld_rewards.py`.
fn grid_reward(name: &str) -> ([f64; 9], [f64; 9]) {
    let none = [0.0; 9];
    match name {
        "sparse_goal" => (GOAL, none),
        "sparse_goal_shift" => (GOAL.map(|reward| reward + 1.0), none),
        "sparse_goal_scale" => (GOAL.map(|reward| reward * 10.0), none),
        "dense_goal" => (GOAL, TO_GOAL.map(|steps| -steps)),
        "antidense_goal" => (GOAL, TO_GOAL),
        "transformed_goal" => (GOAL.map(|reward| reward * 4.0 - 1.0), TO_GOAL.map(|steps| -3.0 * steps)),
        "center_goal" => ([0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0], none),
        "dirt_path" => ([0.0, -1.0, -1.0, 0.0, 0.0, 0.0, -1.0, -1.0, 4.0], none),
        "cliff_walk" => ([0.0, -1.0, -1.0, 0.0, 0.0, 0.0, -4.0, -4.0, 4.0], none),
        "sparse_penalty" => (GOAL.map(|reward| -reward), none),
        "zero" => (none, none),
        _ => panic!("a reward that the test does not know: {name}"),
    }
}

fn grid_table(name: &str, discount: f64) -> RewardTable {
    let (reward, potential) = grid_reward(name);
    let table = RewardTable::from_fn(9, 5, |state, _, _| reward[state]).expect("the rewards are sound");
    table.shaped(&potential, discount).expect("the potential is sound")
}

/// 1 for each move on a 3 × 3 grid: left, right, up, down, stay; against the edge is to stay.
fn walks() -> Vec<f64> {
    let mut weights = vec![0.0; 9 * 5 * 9];
    for state in 0..9_usize {
        for (action, (down, right)) in [(0, -1), (0, 1), (-1, 0), (1, 0), (0, 0)].into_iter().enumerate() {
            let row = (state / 3).checked_add_signed(down).filter(|row| *row < 3);
            let column = (state % 3).checked_add_signed(right).filter(|column| *column < 3);
            let next = row.zip(column).map_or(state, |(row, column)| 3 * row + column);
            weights[(state * 5 + action) * 9 + next] = 1.0;
        }
    }
    weights
}

/// The oracle's own rounding leaves some 3e-10 of equal rewards; anything else is larger by far.
#[track_caller]
fn check(what: &str, found: f64, expected: f64) {
    if expected < 1e-9 {
        assert_eq!(found, 0.0, "{what}");
    }
    assert!((found - expected).abs() <= 1e-9, "{what}: {found}, oracle {expected}");
}

#[test]
fn rewards_of_the_grid_are_as_far_apart_as_the_reference_says() {
    let oracle = oracle();
    assert_eq!(oracle.names.len(), 11);
    let even = Epic::new(oracle.discount).expect("the discount is sound");
    let tables: Vec<RewardTable> = oracle
        .names
        .iter()
        .map(|name| grid_table(name, oracle.discount))
        .collect();
    for (epic, expected) in [
        (even.clone(), &oracle.by_all),
        (even.with_coverage(walks()), &oracle.by_walks),
    ] {
        for (a, row) in expected.iter().enumerate() {
            for (b, expected) in row.iter().enumerate() {
                let found = epic.distance(&tables[a], &tables[b]).expect("the tables are sound");
                let what = format!("{} to {}", oracle.names[a], oracle.names[b]);
                // The reference divides 0 by 0 for the zero reward; ours lies in the middle.
                let middle = if a == b { 0.0 } else { 0.5 };
                check(&what, found, expected.unwrap_or(middle));
            }
        }
    }
}

#[test]
fn equal_goals_are_exactly_0_apart() {
    let oracle = oracle();
    let epic = Epic::new(oracle.discount).expect("the discount is sound");
    let goals: Vec<RewardTable> = oracle.names[..6]
        .iter()
        .map(|name| grid_table(name, oracle.discount))
        .collect();
    for a in &goals {
        for b in &goals {
            assert_eq!(epic.distance(a, b), Ok(0.0));
        }
    }
}

/// Draws in the order of `drawn` in `oracle/make_reward.py`: 2 to 6 states, 1 to 4 actions, a discount in hundredths; whether the
/// second table is near the first (one in four); rewards in thousandths, from −1 to 1, and within 0.005 where near; weights of
/// states and actions of 1 to 9; whether transitions weigh as states and actions do, or 1 to 5.
fn drawn(seed: u64) -> f64 {
    let mut rng = Rng(seed);
    let (states, actions) = (2 + rng.below(5) as usize, 1 + rng.below(4) as usize);
    let discount = rng.number(101) / 100.0;
    let near = rng.below(4) == 0;
    let size = states * actions * states;
    let a: Vec<f64> = (0..size).map(|_| rng.number(2001) - 1000.0).collect();
    let b = a.iter().map(|reward| {
        if near {
            reward + rng.number(11) - 5.0
        } else {
            rng.number(2001) - 1000.0
        }
    });
    let thousandths = |rewards: Vec<f64>| {
        let values = rewards.into_iter().map(|reward| reward / 1000.0).collect();
        RewardTable::new(states, actions, values).expect("the rewards are sound")
    };
    let b = thousandths(b.collect());
    let a = thousandths(a);
    let mut weights = |count: usize, most: u64| -> Vec<f64> { (0..count).map(|_| 1.0 + rng.number(most)).collect() };
    let (of_states, of_actions) = (weights(states, 9), weights(actions, 9));
    let mut epic = Epic::new(discount)
        .expect("the discount is sound")
        .with_states(of_states)
        .with_actions(of_actions);
    if rng.below(2) == 1 {
        epic = epic.with_coverage((0..size).map(|_| 1.0 + rng.number(5)).collect());
    }
    epic.distance(&a, &b).expect("the tables are of one size")
}

#[test]
fn drawn_rewards_are_as_far_apart_as_numpy_says() {
    let expected = oracle().drawn;
    assert_eq!(expected.len(), 1000);
    for (seed, expected) in expected.into_iter().enumerate() {
        check(&format!("draw {seed}"), drawn(seed as u64), expected);
    }
}
