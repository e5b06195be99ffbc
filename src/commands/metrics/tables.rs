//! Metrics as tables for people: of one lifetime, of several, of two agents. The JSON beside them is the library's.

use std::collections::BTreeSet;

use crate::metrics::{Direction, Estimate, LifetimeMetrics, NormalizationMethod, Options, RepeatedMetric};

use super::many::Together;
use crate::commands::table::table;

/// The lifetime's values as a table for a newcomer.
pub(crate) fn summary(scores: &LifetimeMetrics) -> String {
    let rows = scores.summary().into_iter().filter_map(|row| {
        let value = number(row.value?);
        Some([
            row.name.into_owned(),
            value,
            good(row.good),
            row.explanation.into_owned(),
        ])
    });
    let head = format!(
        "{}: {} learning and {} evaluation experiences, scored by {}\n\n",
        scores.run_id, scores.num_lx, scores.num_ex, scores.metrics_column
    );
    head + &table(["metric", "value", "good", "what it says"], rows.collect(), &[1])
}

/// Several lifetimes, and how they compare with another agent's.
pub(super) fn many(
    lifetimes: &[LifetimeMetrics],
    others: &[LifetimeMetrics],
    together: &Together<'_>,
    options: &Options,
) -> String {
    let share = format!("{}% interval", together.intervals.confidence * 100.0);
    let mut parts = vec![
        format!(
            "{}: {} learning and {} evaluation experiences in all, scored by {}",
            counted(lifetimes.len(), "lifetime"),
            lifetimes.iter().map(|life| life.num_lx).sum::<usize>(),
            lifetimes.iter().map(|life| life.num_ex).sum::<usize>(),
            lifetimes.first().map_or("", |life| &life.metrics_column),
        ),
        repeats(&together.repeats, &share),
    ];
    if let Some(own) = own_scale(options) {
        parts.push(own.to_owned());
    } else if options.data_range.is_some() {
        parts.push("Performances of all lifetimes are scaled by the same ranges.".to_owned());
    }
    if !others.is_empty() {
        parts.push(format!(
            "against {} of another agent",
            counted(others.len(), "lifetime")
        ));
        parts.push(repeats(&together.repeats_against, &share));
        parts.push(
            "how probably a lifetime of the first agent is better than one of the other, 0.5 for neither".to_owned(),
        );
        parts.push(improvements(together, &share));
    }
    parts.join("\n\n")
}

/// What must be known before levels of different lifetimes are compared, where each has a scale of its own.
pub(crate) fn own_scale(options: &Options) -> Option<&'static str> {
    let is_own = options.normalization_method != NormalizationMethod::Off && options.data_range.is_none();
    is_own.then_some(
        "Each lifetime is scaled by its own smallest and largest performance: levels (avg_train_perf, avg_eval_perf) of one say \
         nothing beside another's. --common-ranges, -d and -n none give one scale.",
    )
}

fn improvements(together: &Together<'_>, share: &str) -> String {
    let rows = together.improvement.iter().map(|row| {
        [
            row.headline.name.to_string(),
            number(row.improvement.probability.value),
            interval(&row.improvement.probability),
            row.improvement.strata.len().to_string(),
        ]
    });
    table(["metric", "P(better)", share, "tasks"], rows.collect(), &[1, 3])
}

/// Each metric over the lifetimes, and what a reader must be told of the intervals.
fn repeats(metrics: &[RepeatedMetric], share: &str) -> String {
    let rows = metrics.iter().map(|row| {
        [
            row.headline.name.to_string(),
            number(row.iqm.value),
            interval(&row.iqm),
            number(row.mean.value),
            format!("{} x {}", row.num_runs, row.num_strata),
            good(row.headline.good),
        ]
    });
    let cautions: BTreeSet<&str> = metrics.iter().filter_map(|row| row.caution.as_deref()).collect();
    let mut lines = vec![table(
        ["metric", "IQM", share, "mean", "runs x tasks", "good"],
        rows.collect(),
        &[1, 3],
    )];
    lines.extend(cautions.into_iter().map(|caution| format!("note: {caution}")));
    lines.join("\n")
}

fn counted(number: usize, what: &str) -> String {
    if number == 1 {
        format!("1 {what}")
    } else {
        format!("{number} {what}s")
    }
}

fn interval(estimate: &Estimate) -> String {
    estimate.interval.map_or_else(String::new, |found| {
        format!("{} to {}", number(found.low), number(found.high))
    })
}

/// With three decimals; what rounds to nothing has no sign.
fn number(value: f64) -> String {
    let shown = format!("{value:.3}");
    if shown == "-0.000" { "0.000".to_owned() } else { shown }
}

fn good(good: Direction) -> String {
    match good {
        Direction::Higher => "higher".to_owned(),
        Direction::Lower => "lower".to_owned(),
        Direction::HigherThan(neutral) => format!("above {neutral}"),
        Direction::LowerThan(neutral) => format!("below {neutral}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_rounds_to_nothing_has_no_sign() {
        let check = |value: f64, expected: &str| assert_eq!(number(value), expected);
        check(-0.0, "0.000");
        check(-0.000_4, "0.000");
        check(-0.000_6, "-0.001");
        check(-12.5, "-12.500");
        check(0.0, "0.000");
    }
}
