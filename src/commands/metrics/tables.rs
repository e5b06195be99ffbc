//! Tables of metrics: of one lifetime, of several, of two agents.

use std::collections::BTreeSet;

use crate::metrics::{
    AsLogged, Direction, Exchanged, Improvement, Interval, LifetimeMetrics, MAX_P_VALUE, MIN_AGREEING_SHARE,
    NULL_PERMUTATIONS, NullBand, RepeatedMetric, ScaledBy,
};

use driftworld_text::{counted, one_line, printable, rounded, whole};

use super::reached_table::{curves, reached, reached_by_several};
use crate::scoring::{Comparison, Scores, Varied, own_scale};
use crate::table::{table, without_empty};
use crate::variant_names::VariantNames;

/// The scores of one lifetime, or of several with their aggregates.
pub(super) fn scores(scores: &Scores, names: &VariantNames) -> String {
    let Some(comparison) = &scores.comparison else {
        let each = scores.lifetimes.iter().map(|lifetime| summary(lifetime, names));
        return each.collect::<Vec<_>>().join("\n\n");
    };
    several(scores, comparison, names)
}

/// The lifetime's values as a table for newcomers.
fn summary(scores: &LifetimeMetrics, names: &VariantNames) -> String {
    let rows = scores.summary().into_iter().filter_map(|row| {
        let error = row.null_band.and_then(|band| band.standard_error);
        let value = row.value?;
        let value = with_error(short(value), error.map(|error| rounded(error, decimals(value))));
        let [band, p] = beside_null(row.null_band);
        let reading = row.word.unwrap_or_default().to_owned();
        Some(vec![
            row.name.into_owned(),
            value,
            band,
            p,
            reading,
            row.explanation.into_owned(),
        ])
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let has_bands = !scores.null_bands.is_empty();
    let head = format!(
        "{}: {} learning and {} evaluation experiences, scored by {}",
        one_line(&scores.run_id),
        scores.num_lx,
        scores.num_ex,
        one_line(&scores.metrics_column)
    );
    let mut parts = vec![head];
    parts.extend(reached(scores, names));
    parts.push(as_logged(&[("", std::slice::from_ref(scores))]));
    parts.extend(curves(scores, names));
    parts.extend(scaled(scores, names));
    let headings = ["metric", "value", "null band", "p", "reading", "what it says"];
    let mut metrics = without_empty(&headings, &rows, &[1, 3]);
    if has_bands {
        metrics.push('\n');
        metrics.push_str(&what_bands_are(scores));
    }
    if scores.nothing_was_learned() {
        metrics.push_str(
            "\nnote: nothing was learned: no task is better after learning than before, so ignore maintenance and transfer",
        );
    }
    for note in scores.notes.iter().chain(&scores.cautions) {
        metrics.push_str("\nnote: ");
        metrics.push_str(&printable(note));
    }
    parts.push(metrics);
    parts.join("\n\n")
}

/// The null band of a value, and its p-value.
fn beside_null(band: Option<NullBand>) -> [String; 2] {
    let Some(band) = band else {
        return [whole("no null"), String::new()];
    };
    [from_to(band.low, band.high), number(band.p)]
}

/// Explains null bands, and how these were computed.
fn what_bands_are(scores: &LifetimeMetrics) -> String {
    let rows = match scores.null_bands.values().next().map(|band| band.exchanged) {
        Some(Exchanged::Positions) => "rows by their position in the evaluation, because the log names no world twice,",
        Some(Exchanged::WorldsAndPositions) => "rows of each world, or by position if no world is named twice,",
        _ => "rows of each world",
    };
    format!(
        "Null band: the central 95% of values when {rows} are permuted across evaluations {NULL_PERMUTATIONS} times, as if the \
         agent never changed. An effect is named outside the band, with p at most {MAX_P_VALUE}, and two standard errors over \
         worlds (±) from no effect. mixed: less than {:.0}% of the effects of tasks or pairs point that way. no null: \
         permuting evaluations does not test that metric.",
        100.0 * MIN_AGREEING_SHARE
    )
}

/// Explains what the metrics are based on, with their limits; `None` if nothing is scaled.
fn scaled(scores: &LifetimeMetrics, names: &VariantNames) -> Option<String> {
    scores.normalization_data_range.as_ref()?;
    let by = |by: ScaledBy| {
        let tasks = scores.reached.iter().filter(move |(_, task)| task.scaled_by == by);
        tasks.map(|(name, _)| names.shown(name)).collect::<Vec<_>>()
    };
    let (anchored, own) = (by(ScaledBy::Anchors), by(ScaledBy::Own));
    if anchored.is_empty() {
        return Some(SCALED.to_owned());
    }
    let mut text = format!(
        "Metrics are computed after scaling each task from its floor to its ceiling, to 1..101: {}.",
        one_line(anchored.join(", "))
    );
    if !own.is_empty() {
        let tasks = one_line(own.join(", ")).to_string();
        text.push_str(" These have no known floor below a ceiling, so they are scaled by this lifetime's own range: ");
        text.push_str(&tasks);
        text.push('.');
    }
    Some(text)
}

/// What metrics are based on if nothing is known about the tasks.
const SCALED: &str = "Metrics are computed after scaling each task to 1..101, by default between this lifetime's own \
     worst and best. They show how performance changed, not how good it was. To compare agents, use the rows above, \
     --scales, or --common-ranges.";

/// Columns as logged, averaged over lifetimes: how good agents are, without scaling.
fn as_logged(agents: &[(&str, &[LifetimeMetrics])]) -> String {
    let columns: BTreeSet<(usize, &str)> = agents
        .iter()
        .flat_map(|(_, lifetimes)| lifetimes.iter())
        .flat_map(|lifetime| lifetime.as_logged.keys().enumerate())
        .map(|(place, name)| (place, name.as_str()))
        .collect();
    let mut rows: Vec<[String; 3]> = Vec::new();
    for (_, column) in columns {
        for (agent, lifetimes) in agents {
            let of = |part: fn(&AsLogged) -> Option<f64>| {
                let logged = lifetimes
                    .iter()
                    .filter_map(|lifetime| part(lifetime.as_logged.get(column)?));
                mean(&logged.collect::<Vec<_>>(), number)
            };
            let name = format!("mean {column}{agent}");
            if rows.iter().all(|row| row[0] != name) {
                rows.push([name, of(|logged| logged.learning), of(|logged| logged.evaluation)]);
            }
        }
    }
    table(["as logged", "learning", "evaluation"], rows, &[1, 2])
}

/// Several lifetimes, compared with those of another agent if there are any.
fn several(scores: &Scores, together: &Comparison, names: &VariantNames) -> String {
    let (lifetimes, others) = (scores.lifetimes.as_slice(), scores.lifetimes_against.as_slice());
    let options = &scores.options;
    let share = format!("{}% interval", together.intervals.confidence * 100.0);
    let mut parts = vec![format!(
        "{}: {} learning and {} evaluation experiences in all, scored by {}",
        counted(lifetimes.len(), "lifetime"),
        lifetimes.iter().map(|life| life.num_lx).sum::<usize>(),
        lifetimes.iter().map(|life| life.num_ex).sum::<usize>(),
        one_line(lifetimes.first().map_or("", |life| &life.metrics_column)),
    )];
    parts.extend(scores.varied.map(Varied::sentence));
    parts.extend(reached_by_several("", lifetimes, names));
    parts.extend(reached_by_several(" by the other agent", others, names));
    parts.extend([
        as_logged(&if others.is_empty() {
            vec![("", lifetimes)]
        } else {
            vec![("", lifetimes), (" of the other agent", others)]
        }),
        repeats(&together.repeats, &share),
    ]);
    parts.extend(notes("note", lifetimes));
    parts.extend(notes("note on the other agent", others));
    if let Some(own) = own_scale(options) {
        parts.push(own);
    } else if options.scales.is_some() && options.data_range.is_none() {
        parts.push(
            "Tasks with a floor and a ceiling are scaled by them, others by each lifetime's own range.".to_owned(),
        );
    } else if options.data_range.is_some() {
        parts.push("All lifetimes are scaled by the same ranges.".to_owned());
    }
    if !others.is_empty() {
        parts.push(format!(
            "against {} of another agent",
            counted(others.len(), "lifetime")
        ));
        parts.push(repeats(&together.repeats_against, &share));
        let is_tested = together.improvement.iter().any(|row| row.improvement.p_value.is_some());
        parts.push(if is_tested { format!(
            "Probability that a lifetime of the first agent is better than one of the other; 0.5 means neither is. p: \
             how often two equal agents would differ at least as much, by permuting lifetimes between them. Agents \
             differ where p is at most {}; that share of equal agents is called different by mistake.",
            number(1.0 - together.intervals.confidence)
        ) } else {
            "One lifetime of each does not show which agent is better: run several, with other seeds.".to_owned()
        });
        parts.push(improvements(together, &share));
    }
    parts.extend(super::power_table::power(&together.power));
    parts.join("\n\n")
}

/// Notes on an agent's lifetimes, each once.
fn notes(label: &str, lifetimes: &[LifetimeMetrics]) -> Vec<String> {
    let all = lifetimes
        .iter()
        .flat_map(|life| life.notes.iter().chain(&life.cautions));
    let once: BTreeSet<&str> = all.map(String::as_str).collect();
    once.into_iter()
        .map(|note| format!("{label}: {}", one_line(note)))
        .collect()
}

fn improvements(together: &Comparison, share: &str) -> String {
    let alpha = 1.0 - together.intervals.confidence;
    let verdict = |improvement: &Improvement| match improvement.p_value {
        // The rounding of 1 - 0.95 must not matter.
        Some(p) if p <= alpha + 1e-12 && improvement.probability.value > 0.5 => "first is better",
        Some(p) if p <= alpha + 1e-12 => "other is better",
        Some(_) if improvement.least_p_value.is_some_and(|least| least <= alpha + 1e-12) => "no clear difference",
        _ => "too few lifetimes",
    };
    let rows = together.improvement.iter().map(|row| {
        [
            row.headline.name.to_string(),
            if row.improvement.p_value.is_some() {
                number(row.improvement.probability.value)
            } else {
                String::new()
            },
            interval(row.improvement.probability.best_interval()),
            row.improvement.p_value.map_or_else(String::new, number),
            verdict(&row.improvement).to_owned(),
            row.improvement.strata.len().to_string(),
        ]
    });
    let by_t = together
        .improvement
        .iter()
        .any(|row| row.improvement.probability.t_interval.is_some());
    let share = if by_t { format!("{share} (t)") } else { share.to_owned() };
    let rows: Vec<Vec<String>> = rows.map(Vec::from).collect();
    without_empty(
        &["metric", "P(better)", &share, "p", "reading", "tasks"],
        &rows,
        &[1, 3, 5],
    )
}

/// Each metric over the lifetimes, with notes on the intervals.
fn repeats(metrics: &[RepeatedMetric], share: &str) -> String {
    let few = metrics.iter().any(|row| row.iqm.t_interval.is_some());
    let rows = metrics.iter().map(|row| {
        let mut cells = vec![
            row.headline.name.to_string(),
            short(row.iqm.value),
            interval(row.iqm.interval),
        ];
        if few {
            cells.push(interval(row.iqm.t_interval));
        }
        cells.push(short(row.mean.value));
        if few {
            cells.push(interval(row.mean.t_interval));
        }
        cells.extend(beside_null(row.null));
        cells.push(row.word.unwrap_or_default().to_owned());
        cells.push(whole(&format!("{} x {}", row.num_runs, row.num_strata)));
        cells.push(whole(&good(row.headline.good)));
        cells
    });
    let t = format!("{share} (t)");
    let mut headings = vec!["metric", "IQM", share];
    headings.extend(few.then_some(t.as_str()));
    headings.push("mean");
    headings.extend(few.then_some(t.as_str()));
    headings.extend(["null band", "p", "reading", "runs x tasks", "better"]);
    let numbers = if few { [1, 4, 7] } else { [1, 3, 5] };
    let cautions: BTreeSet<&str> = metrics.iter().filter_map(|row| row.caution.as_deref()).collect();
    let mut lines = vec![without_empty(&headings, &rows.collect::<Vec<_>>(), &numbers)];
    if metrics.iter().any(|row| row.null.is_some()) {
        lines.push(format!(
            "Null band: the central 95% of means over lifetimes when the rows of each world are permuted across evaluations \
             {NULL_PERMUTATIONS} times, in all lifetimes alike, as if the agent never changed. An effect is named if the {} of \
             the IQM excludes the neutral value and, if there is a null, the mean over lifetimes is outside its band, with p at \
             most {MAX_P_VALUE}. no null: permuting evaluations does not test this metric.",
            if few { &t } else { share }
        ));
    }
    lines.extend(cautions.into_iter().map(|caution| format!("note: {caution}")));
    if few {
        lines.push(format!("note: {FEW}"));
    }
    lines.join("\n")
}

/// Caution about intervals from few lifetimes.
const FEW: &str = "below ten lifetimes, bootstrap intervals contain the true value less often than they claim (82 \
     instead of 95 times in 100 with five lifetimes); use Student's (t), which assumes that lifetimes are normally \
     distributed";

fn interval(found: Option<Interval>) -> String {
    found.map_or_else(String::new, |found| from_to(found.low, found.high))
}

/// A range without line breaks.
fn from_to(low: f64, high: f64) -> String {
    whole(&format!("{} to {}", short(low), short(high)))
}

/// A value with its standard error, if known, without line breaks.
pub(super) fn with_error(value: String, error: Option<String>) -> String {
    match error {
        Some(error) => whole(&format!("{value} ± {error}")),
        None => value,
    }
}

/// The mean of some values, formatted by `show`; empty without values.
pub(super) fn mean(values: &[f64], show: fn(f64) -> String) -> String {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    if values.is_empty() { String::new() } else { show(mean) }
}

/// With three decimals; zero has no sign.
pub(super) fn number(value: f64) -> String {
    rounded(value, 3)
}

/// With about four digits, so that tables fit 80 columns.
fn short(value: f64) -> String {
    rounded(value, decimals(value))
}

/// Number of decimals for a value of this size.
fn decimals(value: f64) -> usize {
    match value.abs() {
        size if size >= 100.0 => 1,
        size if size >= 10.0 => 2,
        _ => 3,
    }
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
    fn number_that_rounds_to_0_has_no_sign() {
        let check = |value: f64, expected: &str| assert_eq!(number(value), expected);
        check(-0.0, "0.000");
        check(-0.000_4, "0.000");
        check(-0.000_6, "-0.001");
        check(-12.5, "-12.500");
        check(0.0, "0.000");
    }

    #[test]
    fn short_number_has_about_four_digits() {
        let check = |value: f64, expected: &str| assert_eq!(short(value), expected);
        check(-57.616, "-57.62");
        check(1.55, "1.550");
        check(-0.000_4, "0.000");
        check(101.0, "101.0");
    }
}
