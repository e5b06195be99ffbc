//! Summarises learning, transfer and forgetting in a lifetime, from the evaluations around its learning blocks.

use crate::curriculum::{RegimeSummary, Summary};
use crate::spec::BlockKind;
use crate::table::table;
use crate::tasks;

/// The mean reward of a variant before and after learning a different variant.
struct Change {
    /// The variant learned in between.
    learned: String,
    variant: String,
    before: f64,
    after: f64,
    /// Whether the variant that changed had already been learned.
    was_learned: bool,
}

impl Change {
    fn gain(&self) -> f64 {
        self.after - self.before
    }

    fn in_words(&self, moved: &str) -> String {
        format!(
            "learning {} {moved} {} from {:.0} to {:.0}",
            self.learned, self.variant, self.before, self.after
        )
    }
}

/// A table with one row per variant: its first reward, the changes by transfer, learning and forgetting, its last reward, and
/// the reward of each agent in `beside`. Sentences below it state the largest transfer and the largest forgetting.
pub(super) fn effects_table(summary: &Summary, beside: &[(String, Summary)]) -> String {
    let mut headings = vec![
        "variant",
        "at first",
        "transferred",
        "learned",
        "forgotten",
        "at the end",
    ];
    headings.extend(beside.iter().map(|(agent, _)| agent.as_str()));
    let numbers: Vec<usize> = (1..headings.len()).collect();
    let mut parts = vec![
        table(headings, rows(summary, beside), &numbers),
        "transferred: gained before its own block, by learning others\n\
         learned: gained in its own block\n\
         forgotten: lost after it (-), or still gained (+)\n\
         In each row, 'at first' plus the three changes gives 'at the end'.\n"
            .to_owned(),
    ];
    let (known, new): (Vec<Change>, Vec<Change>) = changes(summary).into_iter().partition(|change| change.was_learned);
    let by_gain = |a: &Change, b: &Change| a.gain().total_cmp(&b.gain());
    let largest_rise = new.into_iter().filter(|change| change.gain() > 0.0).max_by(by_gain);
    let largest_fall = known.into_iter().filter(|change| change.gain() < 0.0).min_by(by_gain);
    parts.extend(largest_rise.map(|largest_rise| {
        let (from_to, variant) = (largest_rise.in_words("raised"), &largest_rise.variant);
        format!("Transfer: {from_to}, before {variant} was ever learned.")
    }));
    parts.extend(largest_fall.map(|largest_fall| {
        let (from_to, variant) = (largest_fall.in_words("lowered"), &largest_fall.variant);
        format!("Forgetting: {from_to}, although {variant} had been learned.")
    }));
    parts.join("\n")
}

fn short(variant: &str) -> String {
    tasks::split(variant).1.unwrap_or(variant).to_owned()
}

fn of_kind(summary: &Summary, kind: BlockKind) -> impl DoubleEndedIterator<Item = &RegimeSummary> {
    summary.regimes.iter().filter(move |regime| regime.kind == kind)
}

fn evaluations_of<'a>(summary: &'a Summary, variant: &'a str) -> impl DoubleEndedIterator<Item = &'a RegimeSummary> {
    of_kind(summary, BlockKind::Evaluation).filter(move |regime| regime.variant == variant)
}

/// One row per variant evaluated before and after its first learning block, in the order of these blocks. Rewards are
/// in whole points, so that the parts shown add up.
fn rows(summary: &Summary, beside: &[(String, Summary)]) -> Vec<Vec<String>> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for block in of_kind(summary, BlockKind::Learning) {
        let variant = short(&block.variant);
        if rows.iter().any(|row| row[0] == variant) {
            continue;
        }
        let evaluations = || evaluations_of(summary, &block.variant);
        let (Some(first), Some(before), Some(after), Some(last)) = (
            evaluations().next(),
            evaluations().take_while(|regime| regime.block < block.block).last(),
            evaluations().find(|regime| regime.block > block.block),
            evaluations().next_back(),
        ) else {
            continue;
        };
        let [first, before, after, last] = [first, before, after, last].map(|regime| regime.mean_reward.round() as i64);
        let change = |points: i64| match points {
            0 => "0".to_owned(),
            points => format!("{points:+}"),
        };
        let others = beside
            .iter()
            .filter_map(|(_, other)| evaluations_of(other, &block.variant).next());
        let mut row = vec![
            variant,
            first.to_string(),
            change(before - first),
            change(after - before),
            change(last - after),
            last.to_string(),
        ];
        row.extend(others.map(|regime| format!("{:.0}", regime.mean_reward)));
        rows.push(row);
    }
    rows
}

/// The effect of each learning block on the other variants evaluated before and after it.
fn changes(summary: &Summary) -> Vec<Change> {
    let evaluation = |block: Option<usize>| {
        let own = of_kind(summary, BlockKind::Evaluation).filter(move |regime| Some(regime.block) == block);
        own.map(|regime| (short(&regime.variant), regime.mean_reward))
    };
    let mut learned_before: Vec<String> = Vec::new();
    let mut changes = Vec::new();
    for regime in of_kind(summary, BlockKind::Learning) {
        let learned = short(&regime.variant);
        for (variant, before) in evaluation(regime.block.checked_sub(1)) {
            let mut evaluated = evaluation(Some(regime.block + 1));
            if let Some((_, after)) = evaluated.find(|(other, _)| *other == variant && variant != learned) {
                changes.push(Change {
                    was_learned: learned_before.contains(&variant),
                    learned: learned.clone(),
                    variant,
                    before,
                    after,
                });
            }
        }
        learned_before.push(learned);
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
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
    fn change_counts_as_transfer_before_learning_and_as_forgetting_after() {
        let lifetime = summary(&[
            &[("a", 0.0), ("b", 1.0), ("c", 2.0)],
            &[("a", 5.0)],
            &[("a", 10.0), ("b", 4.0), ("c", 9.0)],
            &[("b", 5.0)],
            &[("a", 3.0), ("b", 20.0), ("c", 8.0)],
        ]);
        let planner = summary(&[&[("b", 30.0), ("a", 11.4)]]);
        let text = effects_table(&lifetime, &[("planner".to_owned(), planner)]);
        let expected = "\
variant  at first  transferred  learned  forgotten  at the end  planner
a               0            0      +10         -7           3       11
b               1           +3      +16          0          20       30
transferred: gained before its own block, by learning others
learned: gained in its own block
forgotten: lost after it (-), or still gained (+)
In each row, 'at first' plus the three changes gives 'at the end'.

Transfer: learning a raised c from 2 to 9, before c was ever learned.
Forgetting: learning b lowered a from 10 to 3, although a had been learned.";
        let lines = |text: &str| text.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>();
        assert_eq!(lines(&text), lines(expected));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// For any rewards, the parts shown for a variant add up: the first and last rewards are those of the first and the
        /// last evaluation, and the parts sum to their difference.
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
            let text = effects_table(&summary(&blocks), &[]);
            for (number, name) in NAMES.into_iter().enumerate() {
                let line = text.lines().find(|line| line.starts_with(&format!("{name} "))).unwrap();
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
    fn unchanging_agent_neither_transfers_nor_forgets() {
        let same: &[(&str, f64)] = &[("a", 1.0), ("b", 1.0)];
        let text = effects_table(&summary(&[same, &[("a", 1.0)], same, &[("b", 1.0)], same]), &[]);
        assert!(!text.contains("Transfer") && !text.contains("Forgetting"), "{text}");
    }
}
