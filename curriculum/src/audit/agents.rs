//! Simulated agents with known scores: each computes its reward for a world directly. A reward is 100 times the skill, plus
//! luck.

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};

use crate::run::ExperienceData;

/// Skill before any learning.
const START: f64 = 0.2;
/// Standard deviation of the reward between layouts, the same for every agent and variant.
const LAYOUT_LUCK: f64 = 10.0;
/// Standard deviation of the reward between episodes in the same world.
const EPISODE_LUCK: f64 = 20.0;
/// Standard deviation, between layouts, of the reward of a fixed sequence of actions.
const SEQUENCE_LUCK: f64 = 25.0;

/// The reward of an episode at this skill; its luck depends on `keys`.
fn reward(skill: f64, data: &ExperienceData, keys: &[u64]) -> f64 {
    100.0 * skill + LAYOUT_LUCK * normal("layout", &data.layout) + EPISODE_LUCK * normal("episode", keys)
}

/// A number determined by the keys, approximately normally distributed over keys: the scaled sum of 16 uniform numbers.
pub(super) fn normal(what: &str, keys: &[u64]) -> f64 {
    let mut hash = Sha256::new();
    hash.update(what.as_bytes());
    for key in keys {
        hash.update(key.to_le_bytes());
    }
    let digest = hash.finalize();
    let uniform = digest
        .chunks_exact(2)
        .map(|pair| f64::from(u16::from_le_bytes([pair[0], pair[1]])) / 65_536.0);
    (uniform.sum::<f64>() - 8.0) / (16.0_f64 / 12.0).sqrt()
}

/// Has an expected reward that never changes; luck is drawn for every experience.
pub(super) fn never_learns(run: u32) -> impl FnMut(&ExperienceData) -> f64 {
    move |data| reward(START, data, &[run.into(), data.number])
}

/// Improves in a world each time it is evaluated there.
pub(super) fn learns_while_frozen() -> impl FnMut(&ExperienceData) -> f64 {
    let mut visits: BTreeMap<(String, [u64; 2]), u32> = BTreeMap::new();
    move |data| {
        if data.learning {
            return reward(START, data, &[]);
        }
        let visits = visits.entry((data.variant.clone(), data.layout)).or_default();
        *visits += 1;
        reward(START, data, &[]) + 10.0 * f64::from(*visits)
    }
}

/// Knows only the number of the experience in its block, and the sequence of actions that paid best at that number. It repeats
/// a sequence that paid more than the mean, and replaces one that did not.
pub(super) fn by_number(run: u32, log: u32) -> impl FnMut(&ExperienceData) -> f64 {
    let mut best: BTreeMap<u64, (f64, u64)> = BTreeMap::new();
    move |data| {
        let known = best.get(&data.number_in_block).copied();
        let sequence = match known {
            Some((best, sequence)) if best > 100.0 * START => sequence,
            _ => u64::from(run) << 40 | u64::from(log) << 32 | data.number,
        };
        // The layout, not the variant, determines the reward of a sequence of actions.
        let [seed, index] = data.layout;
        let paid = 100.0 * START + SEQUENCE_LUCK * normal("sequence", &[seed, index, sequence]);
        if data.learning && known.is_none_or(|(best, own)| own == sequence || paid > best) {
            best.insert(data.number_in_block, (paid, sequence));
        }
        paid
    }
}

/// Learns every variant as if there were no others.
pub(super) fn own_expert(run: u32, log: u32, pace: f64) -> impl FnMut(&ExperienceData) -> f64 {
    let mut learned: BTreeMap<String, u32> = BTreeMap::new();
    move |data| {
        let learned = learned.entry(data.variant.clone()).or_default();
        let skill = 1.0 - (1.0 - START) * libm::exp(-f64::from(*learned) / pace);
        *learned += u32::from(data.learning);
        reward(skill, data, &[run.into(), log.into(), data.number])
    }
}

/// Learns a variant at the expense of all others.
pub(super) fn forgets(run: u32, pace: f64) -> impl FnMut(&ExperienceData) -> f64 {
    // The share of the missing skill that it learns per experience, and the share of other skills that it forgets.
    let rate = (1.0 / pace).min(1.0);
    let mut skills: BTreeMap<String, f64> = BTreeMap::new();
    move |data| {
        let skill = skills.get(&data.variant).copied().unwrap_or(0.0);
        let paid = reward(skill, data, &[run.into(), data.number]);
        if data.learning {
            skills.entry(data.variant.clone()).or_insert(0.0);
            for (variant, skill) in &mut skills {
                *skill += rate * (f64::from(u8::from(*variant == data.variant)) - *skill);
            }
        }
        paid
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luck_is_normal() {
        let drawn: Vec<f64> = (0..20_000).map(|key| normal("test", &[key])).collect();
        let moment = |power: i32| drawn.iter().map(|x| x.powi(power)).sum::<f64>() / drawn.len() as f64;
        // Within four standard errors; the fourth moment of 16 uniform numbers is 3 − 6 / (5 · 16).
        assert!(moment(1).abs() < 0.03, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 0.04, "{}", moment(2));
        assert!((moment(4) - 2.925).abs() < 0.3, "{}", moment(4));
    }
}
