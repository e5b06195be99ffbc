//! Compares EPIC with `NumPy` results computed by the reference's definitions.

use driftworld_similarity::{RewardSamples, SampledReward};
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
    serde_json::from_str(include_str!("oracle/reward.json")).expect("the oracle is valid")
}

impl Rng {
    fn number(&mut self, bound: u64) -> f64 {
        self.below(bound) as f64
    }
}

const GOAL: [f64; 9] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
const TO_GOAL: [f64; 9] = [4.0, 3.0, 2.0, 3.0, 2.0, 1.0, 2.0, 1.0, 0.0];

/// The reward and the potential of each state, as in the reference's `gridworld_rewards.py`.
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
        _ => panic!("unknown reward: {name}"),
    }
}

/// Transitions of a state, an action and a next state, each repeated as often as its weight; all draws, each repeated as often as
/// the product of the weights of its action and state.
fn samples(
    transitions: impl Fn(usize, usize, usize) -> usize,
    of_states: &[usize],
    of_actions: &[usize],
) -> RewardSamples<usize, usize> {
    let states = of_states.len();
    let draws = (0..of_actions.len()).flat_map(|action| (0..states).map(move |next| (action, next)));
    let draws: Vec<(usize, usize)> = draws.collect();
    let all = (0..states).flat_map(|state| draws.iter().map(move |&(action, next)| (state, action, next)));
    let all = all.flat_map(|(state, action, next)| vec![(state, action, next); transitions(state, action, next)]);
    let draws = draws
        .iter()
        .flat_map(|&(action, next)| vec![(action, next); of_actions[action] * of_states[next]]);
    RewardSamples::new(all.collect(), draws.collect()).expect("there are samples")
}

fn on_the_grid(samples: &RewardSamples<usize, usize>, name: &str, discount: f64) -> SampledReward {
    let (reward, potential) = grid_reward(name);
    let reward_of =
        |&state: &usize, _: &usize, &next: &usize| reward[state] + discount * potential[next] - potential[state];
    samples.measure(reward_of).expect("the rewards are valid")
}

/// 1 for each move on a 3 × 3 grid: left, right, up, down, stay; moves into the edge stay in place.
fn walks() -> Vec<usize> {
    let mut weights = vec![0; 9 * 5 * 9];
    for state in 0..9_usize {
        for (action, (down, right)) in [(0, -1), (0, 1), (-1, 0), (1, 0), (0, 0)].into_iter().enumerate() {
            let row = (state / 3).checked_add_signed(down).filter(|row| *row < 3);
            let column = (state % 3).checked_add_signed(right).filter(|column| *column < 3);
            let next = row.zip(column).map_or(state, |(row, column)| 3 * row + column);
            weights[(state * 5 + action) * 9 + next] = 1;
        }
    }
    weights
}

/// Every transition of the grid, possible or not.
fn every_step() -> RewardSamples<usize, usize> {
    samples(|_, _, _| 1, &[1; 9], &[1; 5])
}

/// The oracle's own rounding leaves about 3e-10 between equal rewards; anything else is far larger.
#[track_caller]
fn check(what: &str, found: f64, expected: f64) {
    if expected < 1e-9 {
        assert_eq!(found, 0.0, "{what}");
    }
    assert!((found - expected).abs() <= 1e-9, "{what}: {found}, oracle {expected}");
}

#[test]
fn grid_rewards_match_the_reference() {
    let oracle = oracle();
    assert_eq!(oracle.names.len(), 11);
    let walks = walks();
    let by_walks = samples(
        |state, action, next| walks[(state * 5 + action) * 9 + next],
        &[1; 9],
        &[1; 5],
    );
    for (samples, expected) in [(every_step(), &oracle.by_all), (by_walks, &oracle.by_walks)] {
        let measured = oracle
            .names
            .iter()
            .map(|name| on_the_grid(&samples, name, oracle.discount));
        let measured: Vec<SampledReward> = measured.collect();
        for (a, row) in expected.iter().enumerate() {
            for (b, expected) in row.iter().enumerate() {
                let found = measured[a].distance(&measured[b], oracle.discount);
                let what = format!("{} to {}", oracle.names[a], oracle.names[b]);
                // The reference divides 0 by 0 for the zero reward; ours is halfway.
                let middle = if a == b { 0.0 } else { 0.5 };
                check(
                    &what,
                    found.expect("both use the same samples"),
                    expected.unwrap_or(middle),
                );
            }
        }
    }
}

#[test]
fn equal_goals_are_exactly_0_apart() {
    let (oracle, samples) = (oracle(), every_step());
    let goals = oracle.names[..6]
        .iter()
        .map(|name| on_the_grid(&samples, name, oracle.discount));
    let goals: Vec<SampledReward> = goals.collect();
    for a in &goals {
        for b in &goals {
            assert_eq!(a.distance(b, oracle.discount), Ok(0.0));
        }
    }
}

/// Draws in the order of `drawn` in `oracle/make_reward.py`: 2 to 5 states, 1 to 3 actions, a discount in hundredths; whether
/// the second reward is near the first (one in four); rewards in thousandths, from −1 to 1, and within 0.005 if near; weights
/// of states and actions of 1 to 3; whether transitions have the product of these weights, or weights of 1 to 5.
fn drawn(seed: u64) -> f64 {
    let mut rng = Rng(seed);
    let (states, actions) = (2 + rng.below(4) as usize, 1 + rng.below(3) as usize);
    let discount = rng.number(101) / 100.0;
    let is_near = rng.below(4) == 0;
    let size = states * actions * states;
    let a: Vec<f64> = (0..size).map(|_| rng.number(2001) - 1000.0).collect();
    let b = a.iter().map(|reward| {
        if is_near {
            reward + rng.number(11) - 5.0
        } else {
            rng.number(2001) - 1000.0
        }
    });
    let b: Vec<f64> = b.collect();
    let mut weights =
        |count: usize, max: u64| -> Vec<usize> { (0..count).map(|_| 1 + rng.below(max) as usize).collect() };
    let (of_states, of_actions) = (weights(states, 3), weights(actions, 3));
    let index = |state: usize, action: usize, next: usize| (state * actions + action) * states + next;
    let as_drawn = |state: usize, action: usize, next: usize| of_states[state] * of_actions[action] * of_states[next];
    let samples = if weights(1, 2) == [2] {
        let coverage = weights(size, 5);
        samples(
            |state, action, next| coverage[index(state, action, next)],
            &of_states,
            &of_actions,
        )
    } else {
        samples(as_drawn, &of_states, &of_actions)
    };
    let measure = |rewards: &[f64]| {
        let reward_of = |&state: &usize, &action: &usize, &next: &usize| rewards[index(state, action, next)] / 1000.0;
        samples.measure(reward_of).expect("the rewards are valid")
    };
    let found = measure(&a).distance(&measure(&b), discount);
    found.expect("both use the same samples")
}

#[test]
fn random_rewards_match_numpy() {
    let expected = oracle().drawn;
    assert_eq!(expected.len(), 1000);
    for (seed, expected) in expected.into_iter().enumerate() {
        check(&format!("draw {seed}"), drawn(seed as u64), expected);
    }
}
