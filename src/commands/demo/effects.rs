//! What learning one variant did to the others, read off the evaluations around it.

use crate::curriculum::Summary;
use crate::spec::BlockKind;
use crate::table::wide_table;
use crate::tasks;

/// The evaluations before and after one learning block.
struct Effect {
    /// The variant that was learned.
    learned: String,
    before: f64,
    after: f64,
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

    fn shown(change: Option<&Self>) -> String {
        change.map_or_else(
            || "-".to_owned(),
            |Self { variant, before, after }| format!("{variant}: {before:.0} to {after:.0}"),
        )
    }
}

/// One row for each learning block, and below in words where transfer and forgetting were largest.
pub(super) fn effects_table(summary: &Summary) -> String {
    let effects = effects(summary);
    let headings = [
        "learned",
        "before",
        "after",
        "rose most, not learned yet",
        "fell most, learned before",
    ];
    let row = |effect: &Effect| {
        vec![
            effect.learned.clone(),
            format!("{:.0}", effect.before),
            format!("{:.0}", effect.after),
            Change::shown(effect.transfer.as_ref()),
            Change::shown(effect.forgetting.as_ref()),
        ]
    };
    let rows = effects.iter().map(row).collect();
    let table = wide_table(headings.map(str::to_owned).to_vec(), rows, &[1, 2]);
    [Some(table), transfer_sentence(&effects), forgetting_sentence(&effects)]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("\n")
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
    let short = |variant: &str| tasks::split(variant).1.unwrap_or(variant).to_owned();
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
        let (own, others): (Vec<_>, Vec<_>) = changes.into_iter().partition(|change| change.variant == learned);
        let (known, new): (Vec<_>, Vec<_>) =
            (others.into_iter()).partition(|change| learned_before.contains(&change.variant));
        if let Some(own) = own.first() {
            let rose = new.into_iter().filter(|change| change.gain() > 0.0);
            let fell = known.into_iter().filter(|change| change.gain() < 0.0);
            effects.push(Effect {
                learned: learned.clone(),
                before: own.before,
                after: own.after,
                transfer: rose.max_by(|a, b| a.gain().total_cmp(&b.gain())),
                forgetting: fell.min_by(|a, b| a.gain().total_cmp(&b.gain())),
            });
        }
        learned_before.push(learned);
    }
    effects
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curriculum::RegimeSummary;

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
learned  before  after  rose most, not learned yet  fell most, learned before
a             0     10  c: 2 to 9                   -
b             4     20  -                           a: 10 to 3
Transfer: learning a raised c from 2 to 9, before c was ever learned.
Forgetting: learning b lowered a from 10 to 3, although a had been learned.";
        let lines = |text: &str| text.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>();
        assert_eq!(lines(&said), lines(expected));
    }

    #[test]
    fn an_agent_that_does_not_change_neither_transfers_nor_forgets() {
        let same: &[(&str, f64)] = &[("a", 1.0), ("b", 1.0)];
        let said = effects_table(&summary(&[same, &[("a", 1.0)], same, &[("b", 1.0)], same]));
        assert!(!said.contains("Transfer") && !said.contains("Forgetting"), "{said}");
    }
}
