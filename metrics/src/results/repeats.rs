//! Metrics of repeated lifetimes: aggregates with their uncertainty, and comparisons of two agents.

use serde::Serialize;

use super::{Exchanged, Headline, LifetimeMetrics, NullBand, Part, Reading, disagreements};
use crate::MetricsError;
use crate::repeats::{
    Aggregate, BootstrapOptions, Estimate, Improvement, ScoreTable, estimate, probability_of_improvement,
};
use crate::statistics::mean;

impl NullBand {
    /// The band of a metric's mean over several lifetimes: for each permutation, the mean over the lifetimes. Lifetimes without
    /// bands, such as those read from JSON, do not count; `None` if there are no others.
    ///
    /// Evaluations are permuted in the same way in all lifetimes, so the band is valid even if these share worlds or seeds.
    /// It has no standard error: the variation between lifetimes is in their intervals.
    pub fn over_lifetimes(name: &str, lifetimes: &[LifetimeMetrics]) -> Option<Self> {
        let with_both = lifetimes.iter().filter_map(|lifetime| {
            let draws = lifetime.null_draws.get(name).filter(|draws| !draws.is_empty())?;
            Some((lifetime.null_bands.get(name)?, draws))
        });
        let (bands, draws): (Vec<&Self>, Vec<&Vec<f64>>) = with_both.unzip();
        let values: Vec<f64> = bands.iter().map(|band| band.value).collect();
        let num_permutations = draws.iter().map(|draws| draws.len()).min()?;
        let of_permutation = |number: usize| {
            let of_each: Vec<f64> = draws.iter().map(|draws| draws[number]).collect();
            mean(&of_each).filter(|mean| mean.is_finite())
        };
        let permuted: Vec<f64> = (0..num_permutations).filter_map(of_permutation).collect();
        let first = bands.first()?.exchanged;
        let exchanged = if bands.iter().all(|band| band.exchanged == first) {
            first
        } else {
            Exchanged::WorldsAndPositions
        };
        Self::new(mean(&values)?, &permuted, exchanged)
    }
}

/// One metric over repeated lifetimes of one agent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RepeatedMetric {
    /// The metric.
    #[serde(flatten)]
    pub headline: Headline,
    /// Mean of the middle half of all values.
    pub iqm: Estimate,
    /// Mean of the strata's means.
    pub mean: Estimate,
    /// Median of the strata's means.
    pub median: Estimate,
    /// Lifetimes that have a value.
    pub num_runs: usize,
    /// Tasks that have a value; for transfer, pairs of tasks.
    pub num_strata: usize,
    /// The null band of the metric's mean over lifetimes; `None` for a metric that cannot be tested by permuting evaluations.
    /// Its value differs from `mean` if lifetimes lack some tasks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub null: Option<NullBand>,
    /// The reading of the metric; `None` without a neutral value.
    pub reading: Option<Reading>,
    /// The reading in the metric's own words, as in every table.
    pub word: Option<&'static str>,
    /// A warning for readers of the intervals.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub caution: Option<String>,
}

/// One metric of two agents.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedMetric {
    /// The metric.
    #[serde(flatten)]
    pub headline: Headline,
    /// The probability that a lifetime of the first agent is better than one of the second.
    pub improvement: Improvement,
    /// The interquartile means of the first and of the second agent.
    pub values: [Estimate; 2],
}

/// Aggregates every metric that has a value in some lifetime over all lifetimes, in the order of the headlines.
///
/// Variation is analysed task by task: a task's values in the lifetimes are one stratum; for transfer, the first values
/// of a pair of tasks; for a metric without values for tasks, the values of the lifetimes.
///
/// # Errors
/// Those of [`estimate`](crate::repeats::estimate()) and [`ScoreTable::from_runs`].
pub fn over_repeats(
    lifetimes: &[LifetimeMetrics],
    options: &BootstrapOptions,
) -> Result<Vec<RepeatedMetric>, MetricsError> {
    let mut found = Vec::new();
    for headline in headlines(lifetimes) {
        let Some(table) = table(lifetimes, &headline, |_, value| value)? else {
            continue;
        };
        let [iqm, mean, median] = estimate(&table, [Aggregate::Iqm, Aggregate::Mean, Aggregate::Median], options)?;
        let null = NullBand::over_lifetimes(&headline.name, lifetimes);
        let is_undefined = |life: &LifetimeMetrics| life.readings.get(&*headline.name) == Some(&Reading::Undefined);
        let reading = if lifetimes.iter().any(is_undefined) {
            Some(Reading::Undefined)
        } else {
            Reading::of_lifetimes(headline.good, null.as_ref(), iqm.best_interval())
        };
        found.push(RepeatedMetric {
            null,
            reading,
            word: reading.map(|reading| reading.word(&headline.name)),
            headline,
            iqm,
            mean,
            median,
            num_runs: table.num_runs(),
            num_strata: table.strata().count(),
            caution: table.caution(options.resampling),
        });
    }
    let reading = |name: &str| found.iter().find(|row| row.headline.name == name)?.reading;
    for (ratio, sentence) in disagreements(reading) {
        if let Some(row) = found.iter_mut().find(|row| row.headline.name == ratio) {
            let caution = row.caution.take().map(|caution| format!("{caution}; "));
            row.caution = Some(caution.unwrap_or_default() + &sentence);
        }
    }
    Ok(found)
}

/// The probability that a lifetime of agent `a` is better than one of agent `b`, for every metric for which both have values in
/// a shared task. If lower values are better, the lower value wins.
///
/// # Errors
/// Those of [`probability_of_improvement`](crate::repeats::probability_of_improvement()) and [`ScoreTable::from_runs`].
pub fn compare_agents(
    a: &[LifetimeMetrics],
    b: &[LifetimeMetrics],
    options: &BootstrapOptions,
) -> Result<Vec<ComparedMetric>, MetricsError> {
    let mut found = Vec::new();
    for headline in headlines(a) {
        let (Some(of_a), Some(of_b)) = (
            table(a, &headline, higher_is_better)?,
            table(b, &headline, higher_is_better)?,
        ) else {
            continue;
        };
        if of_a.strata().all(|stratum| of_b.scores(stratum).is_none()) {
            continue;
        }
        let improvement = probability_of_improvement(&of_a, &of_b, options)?;
        let value = |lifetimes| {
            let table = table(lifetimes, &headline, |_, value| value)?;
            let estimates = table.map(|table| estimate(&table, [Aggregate::Iqm], options));
            Ok::<_, MetricsError>(estimates.transpose()?.map(|[iqm]| iqm))
        };
        let (Some(of_a), Some(of_b)) = (value(a)?, value(b)?) else {
            continue;
        };
        found.push(ComparedMetric {
            headline,
            improvement,
            values: [of_a, of_b],
        });
    }
    Ok(found)
}

/// The headlines of all lifetimes, each once.
pub(super) fn headlines(lifetimes: &[LifetimeMetrics]) -> Vec<Headline> {
    let mut headlines: Vec<Headline> = Vec::new();
    for headline in lifetimes.iter().flat_map(LifetimeMetrics::shown_headlines) {
        if headlines.iter().all(|known| known.name != headline.name) {
            headlines.push(headline);
        }
    }
    headlines
}

/// The values of a metric per lifetime and stratum; `None` if no lifetime has one.
fn table(
    lifetimes: &[LifetimeMetrics],
    headline: &Headline,
    view: fn(&Headline, f64) -> f64,
) -> Result<Option<ScoreTable>, MetricsError> {
    let runs = (1..).zip(lifetimes).map(|(number, lifetime)| {
        let values = strata(lifetime, &headline.name).into_iter();
        let values = values.map(|(stratum, value)| (stratum, view(headline, value)));
        // Folders of logs may share a name; runs must not.
        (format!("{number}, {}", lifetime.run_id), values.collect::<Vec<_>>())
    });
    let runs: Vec<_> = runs.filter(|(_, values)| !values.is_empty()).collect();
    if runs.is_empty() {
        return Ok(None);
    }
    ScoreTable::from_runs(runs).map(Some)
}

/// A value, negated if lower is better.
fn higher_is_better(headline: &Headline, value: f64) -> f64 {
    if headline.good.is_higher() { value } else { -value }
}

fn strata(lifetime: &LifetimeMetrics, name: &str) -> Vec<(String, f64)> {
    let named = |part: Part<'_>| match part.other {
        Some(other) => (format!("{} → {other}", part.task), part.value),
        None => (part.task.to_owned(), part.value),
    };
    let found: Vec<_> = lifetime.parts(name).into_iter().map(named).collect();
    match lifetime.number(name) {
        Some(value) if found.is_empty() => vec![("lifetime".to_owned(), value)],
        _ => found,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::Direction;

    fn lifetime(run_id: &str, tasks: &serde_json::Value, whole: &serde_json::Value) -> LifetimeMetrics {
        let mut fields = json!({
            "run_id": run_id, "complexity": "", "difficulty": "", "scenario_type": "", "metrics_column": "reward",
            "min": 1.0, "max": 101.0, "num_lx": 10, "num_ex": 10, "runtime": 0.0,
            "normalization_data_range": null, "task_metrics": tasks,
        });
        for (name, value) in whole.as_object().unwrap() {
            fields[name] = value.clone();
        }
        serde_json::from_value(fields).unwrap()
    }

    fn of_task(value: f64) -> LifetimeMetrics {
        lifetime(
            "run",
            &json!({ "a_1": { "avg_eval_perf": value }, "b_1": { "avg_eval_perf": 2.0 } }),
            &json!({}),
        )
    }

    #[test]
    fn tasks_are_the_strata_of_a_metric() {
        let found = over_repeats(&[of_task(4.0), of_task(8.0)], &BootstrapOptions::default()).unwrap();
        let [row] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!(row.headline.name, "avg_eval_perf");
        assert_eq!(
            (row.num_runs, row.num_strata, row.mean.value, row.median.value),
            (2, 2, 4.0, 4.0)
        );
        // The middle half of 2, 2, 4, 8 is 2 and 4.
        assert_eq!(row.iqm.value, 3.0);
        assert_eq!(row.caution, None);
    }

    #[test]
    fn pairs_of_tasks_are_the_strata_of_transfer_by_their_first_value() {
        let tasks = json!({ "a_1": { "forward_transfer_ratio": { "b_1": [3.0, 9.0], "c_1": [] } } });
        let found = over_repeats(&[lifetime("run", &tasks, &json!({}))], &BootstrapOptions::default()).unwrap();
        assert_eq!(
            (found[0].num_strata, found[0].mean.value, found[0].mean.interval),
            (1, 3.0, None)
        );
        assert!(
            found[0].caution.as_deref().unwrap().starts_with("no interval"),
            "{:?}",
            found[0].caution
        );
    }

    #[test]
    fn lifetime_only_metric_has_one_stratum() {
        let of = |value: f64| lifetime("run", &json!({ "a_1": {} }), &json!({ "sample_efficiency": value }));
        let found = over_repeats(&[of(0.5), of(1.5)], &BootstrapOptions::default()).unwrap();
        assert_eq!((found[0].num_strata, found[0].mean.value), (1, 1.0));
    }

    #[test]
    fn better_agent_wins_even_if_lower_is_better() {
        let (good, bad) = ([of_task(5.0), of_task(6.0)], [of_task(1.0), of_task(2.0)]);
        let probability = |a: &[LifetimeMetrics], b: &[LifetimeMetrics]| {
            let found = compare_agents(a, b, &BootstrapOptions::default()).unwrap();
            found[0].improvement.probability.value
        };
        assert_eq!(probability(&good, &bad), 0.75, "1 in one task, 0.5 in the other");
        let turned = |lifetimes: &[LifetimeMetrics]| -> Vec<LifetimeMetrics> {
            let mut turned = lifetimes.to_vec();
            for lifetime in &mut turned {
                lifetime
                    .headlines
                    .iter_mut()
                    .for_each(|headline| headline.good = Direction::Lower);
            }
            turned
        };
        assert_eq!(probability(&turned(&good), &turned(&bad)), 0.25);
    }

    #[test]
    fn agents_without_a_shared_task_are_not_compared() {
        let other = lifetime("run", &json!({ "z_1": { "avg_eval_perf": 1.0 } }), &json!({}));
        assert_eq!(
            compare_agents(&[of_task(1.0)], &[other], &BootstrapOptions::default()).unwrap(),
            []
        );
    }
}
