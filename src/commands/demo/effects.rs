//! What was learned, transferred and forgotten in a lifetime, read off the evaluations around its learning blocks.

use crate::curriculum::Summary;
use crate::spec::BlockKind;
use crate::table::table;
use crate::tasks;

/// What one learning block did to other variants.
struct Effect {
    /// The variant that was learned.
    learned: String,
    /// The variant that was not learned yet and rose most.
    transfer: Option<Change>,
    /// The variant that was learned before and fell most.
    forgetting: Option<Change>,
}

/// The mean reward of a variant before and after another was learned.
#[derive(Clone)]
struct Change {
    variant: String,
    before: f64,
    after: f64,
}

impl Change {
    fn gain(&self) -> f64 {
        self.after - self.before
    }
}

/// What became of one variant over the lifetime, in whole points of reward, so that the parts shown add up.
struct Account {
    variant: String,
    at_first: i64,
    /// Gained before its own block: by learning others.
    transferred: i64,
    learned: i64,
    /// Gained after its own block, while others were learned: below 0 where it was forgotten.
    afterwards: i64,
}

impl Account {
    fn at_the_end(&self) -> i64 {
        self.at_first + self.transferred + self.learned + self.afterwards
    }
}

/// One row for each variant: what it paid at first, what was transferred to it, learned and forgotten, and what it paid at
/// the end; below in words where transfer and forgetting were largest.
pub(super) fn effects_table(summary: &Summary) -> String {
    let headings = [
        "variant",
        "at first",
        "transferred",
        "learned",
        "forgotten",
        "at the end",
    ];
    let row = |account: Account| {
        [
            account.variant.clone(),
            account.at_first.to_string(),
            change(account.transferred),
            change(account.learned),
            change(account.afterwards),
            account.at_the_end().to_string(),
        ]
    };
    let rows = accounts(summary).into_iter().map(row);
    let table = table(headings, rows, &[1, 2, 3, 4, 5]);
    let meaning = "transferred: gained before its own block, by learning others\n\
                   learned: gained in its own block\n\
                   forgotten: lost after it (-), or still gained (+)\n\
                   Each row adds up to its end.\n"
        .to_owned();
    let effects = effects(summary);
    [
        Some(table),
        Some(meaning),
        transfer_sentence(&effects),
        forgetting_sentence(&effects),
    ]
    .into_iter()
    .flatten()
    .collect::<Vec<_>>()
    .join("\n")
}

fn change(points: i64) -> String {
    if points == 0 {
        "0".to_owned()
    } else {
        format!("{points:+}")
    }
}

fn short(variant: &str) -> String {
    tasks::split(variant).1.unwrap_or(variant).to_owned()
}

/// Every variant that was learned, in the order of its first block, and was evaluated around it.
fn accounts(summary: &Summary) -> Vec<Account> {
    let of = |kind: BlockKind| summary.regimes.iter().filter(move |regime| regime.kind == kind);
    let mut accounts: Vec<Account> = Vec::new();
    for block in of(BlockKind::Learning) {
        let variant = short(&block.variant);
        if accounts.iter().any(|account| account.variant == variant) {
            continue;
        }
        let evaluations = || of(BlockKind::Evaluation).filter(|regime| regime.variant == block.variant);
        let points = |reward: f64| reward.round() as i64;
        let (Some(first), Some(before), Some(after), Some(last)) = (
            evaluations().next(),
            evaluations().take_while(|regime| regime.block < block.block).last(),
            evaluations().find(|regime| regime.block > block.block),
            evaluations().next_back(),
        ) else {
            continue;
        };
        let [first, before, after, last] = [first, before, after, last].map(|regime| points(regime.mean_reward));
        accounts.push(Account {
            variant,
            at_first: first,
            transferred: before - first,
            learned: after - before,
            afterwards: last - after,
        });
    }
    accounts
}

fn transfer_sentence(effects: &[Effect]) -> Option<String> {
    let changes = effects
        .iter()
        .filter_map(|effect| Some((effect, effect.transfer.as_ref()?)));
    let (effect, change) = changes.max_by(|(_, a), (_, b)| a.gain().total_cmp(&b.gain()))?;
    Some(format!(
        "Transfer: learning {} raised {} from {:.0} to {:.0}, before {} was ever learned.",
        effect.learned, change.variant, change.before, change.after, change.variant
    ))
}

fn forgetting_sentence(effects: &[Effect]) -> Option<String> {
    let changes = effects
        .iter()
        .filter_map(|effect| Some((effect, effect.forgetting.as_ref()?)));
    let (effect, change) = changes.min_by(|(_, a), (_, b)| a.gain().total_cmp(&b.gain()))?;
    Some(format!(
        "Forgetting: learning {} lowered {} from {:.0} to {:.0}, although {} had been learned.",
        effect.learned, change.variant, change.before, change.after, change.variant
    ))
}

fn effects(summary: &Summary) -> Vec<Effect> {
    let evaluation = |block: Option<usize>| -> Vec<(String, f64)> {
        let own = summary.regimes.iter().filter(|regime| Some(regime.block) == block);
        own.filter(|regime| regime.kind == BlockKind::Evaluation)
            .map(|regime| (short(&regime.variant), regime.mean_reward))
            .collect()
    };
    let mut learned_before: Vec<String> = Vec::new();
    let mut effects = Vec::new();
    for regime in summary
        .regimes
        .iter()
        .filter(|regime| regime.kind == BlockKind::Learning)
    {
        let (first, second) = (
            evaluation(regime.block.checked_sub(1)),
            evaluation(Some(regime.block + 1)),
        );
        let learned = short(&regime.variant);
        let change = |(variant, before): &(String, f64)| {
            let after = second.iter().find(|(other, _)| other == variant)?.1;
            let (variant, before) = (variant.clone(), *before);
            Some(Change { variant, before, after })
        };
        let changes: Vec<Change> = first.iter().filter_map(change).collect();
        let others = changes.into_iter().filter(|change| change.variant != learned);
        let (known, new): (Vec<_>, Vec<_>) = others.partition(|change| learned_before.contains(&change.variant));
        let rose = new.into_iter().filter(|change| change.gain() > 0.0);
        let fell = known.into_iter().filter(|change| change.gain() < 0.0);
        effects.push(Effect {
            learned: learned.clone(),
            transfer: rose.max_by(|a, b| a.gain().total_cmp(&b.gain())),
            forgetting: fell.min_by(|a, b| a.gain().total_cmp(&b.gain())),
        });
        learned_before.push(learned);
    }
    effects
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curriculum::RegimeSummary;
    use proptest::prelude::*;

    fn summary(blocks: &[&[(&str, f64)]]) -> Summary {
        let mut regimes = Vec::new();
        for (block, variants) in blocks.iter().enumerate() {
            for (regime, (variant, mean_reward)) in variants.iter().enumerate() {
                let kind = if block % 2 == 0 {
                    BlockKind::Evaluation
                } else {
                    BlockKind::Learning
                };
                regimes.push(RegimeSummary {
                    block,
                    regime,
                    kind,
                    variant: format!("task#{variant}"),
                    experiences: 3,
                    skipped: 0,
                    mean_reward: *mean_reward,
                    success_rate: 0.0,
                });
            }
        }
        Summary {
            regimes,
            ..Summary::default()
        }
    }

    #[test]
    fn what_was_not_learned_yet_transfers_and_what_was_learned_is_forgotten() {
        let said = effects_table(&summary(&[
            &[("a", 0.0), ("b", 1.0), ("c", 2.0)],
            &[("a", 5.0)],
            &[("a", 10.0), ("b", 4.0), ("c", 9.0)],
            &[("b", 5.0)],
            &[("a", 3.0), ("b", 20.0), ("c", 8.0)],
        ]));
        let expected = "\
variant  at first  transferred  learned  forgotten  at the end
a               0            0      +10         -7           3
b               1           +3      +16          0          20
transferred: gained before its own block, by learning others
learned: gained in its own block
forgotten: lost after it (-), or still gained (+)
Each row adds up to its end.

Transfer: learning a raised c from 2 to 9, before c was ever learned.
Forgetting: learning b lowered a from 10 to 3, although a had been learned.";
        let lines = |text: &str| text.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>();
        assert_eq!(lines(&said), lines(expected));
    }

    proptest! {
        /// Whatever the rewards are, what is shown of a variant adds up: what it paid at first and at the end are those of the
        /// first and the last evaluation, and the parts are what lies between.
        #[test]
        fn every_row_adds_up(rewards in prop::collection::vec(prop::array::uniform3(-500.0..500.0f64), 4)) {
            const NAMES: [&str; 3] = ["a", "b", "c"];
            let evaluation = |block: usize| -> Vec<(&str, f64)> { NAMES.into_iter().zip(rewards[block]).collect() };
            let evaluations: Vec<_> = (0..4).map(evaluation).collect();
            let learned = NAMES.map(|name| [(name, 0.0)]);
            let mut blocks: Vec<&[(&str, f64)]> = Vec::new();
            for number in 0..3 {
                blocks.extend([&evaluations[number][..], &learned[number][..]]);
            }
            blocks.push(&evaluations[3]);
            let said = effects_table(&summary(&blocks));
            for (number, name) in NAMES.into_iter().enumerate() {
                let line = said.lines().find(|line| line.starts_with(&format!("{name} "))).unwrap();
                let shown: Vec<i64> = line.split_whitespace().skip(1).map(|cell| cell.parse().unwrap()).collect();
                let level = |block: usize| rewards[block][number].round() as i64;
                prop_assert_eq!(shown[0], level(0));
                prop_assert_eq!(shown[0] + shown[1], level(number));
                prop_assert_eq!(shown[0] + shown[1] + shown[2], level(number + 1));
                prop_assert_eq!(shown[0] + shown[1] + shown[2] + shown[3], level(3));
                prop_assert_eq!(shown[4], level(3));
            }
        }
    }

    #[test]
    fn an_agent_that_does_not_change_neither_transfers_nor_forgets() {
        let same: &[(&str, f64)] = &[("a", 1.0), ("b", 1.0)];
        let said = effects_table(&summary(&[same, &[("a", 1.0)], same, &[("b", 1.0)], same]));
        assert!(!said.contains("Transfer") && !said.contains("Forgetting"), "{said}");
    }
}
