//! Scores a lifetime: computes metrics in order, and collects their values.

use indexmap::{IndexMap, IndexSet};

use super::assessment::aggregate;
use super::null_bands::{NullBands, null_bands};
use super::{Assessment, Metric, all_requested, built_in, built_in_headlines};
use crate::lifetime::{Lifetime, Regime, SteLog};
use crate::preprocess::caution_of_scales;
use crate::results::{
    Headline, LEARNED_SHARE, LifetimeMetrics, Reached, Reading, RegimeMetrics, Value, Values, as_logged, curves,
    disagreements, expert_fits, incomparable_experts, is_regime_column, parts, reached,
};
use crate::{BlockType, Log, MetricsError, Options};

/// Scores a lifetime with the metrics of this crate, comparing it with the given single-task experts.
///
/// A value that cannot be computed, for lack of experts, evaluations between learning blocks or a second learning block, is
/// absent, never NaN.
///
/// # Errors
/// Those of [`Lifetime::prepare`].
pub fn score(log: &Log, experts: &[SteLog], options: &Options) -> Result<LifetimeMetrics, MetricsError> {
    Scorer::new().score(log, experts, options)
}

/// Metrics in the order in which they are computed; each sees the values of earlier ones.
///
/// ```
/// # use driftworld_metrics::{Assessment, Headline, Metric, MetricsError, Options, Scorer};
/// # struct WorstEvaluation;
/// # impl Metric for WorstEvaluation {
/// #     fn headlines(&self, _: &Options) -> Vec<Headline> { Vec::new() }
/// #     fn judge(&self, _: &mut Assessment<'_>) -> Result<(), MetricsError> { Ok(()) }
/// # }
/// let scorer = Scorer::new().with(WorstEvaluation)?;
/// # Ok::<(), MetricsError>(())
/// ```
pub struct Scorer {
    metrics: Vec<Box<dyn Metric>>,
    headlines: IndexSet<String>,
}

impl Scorer {
    /// A scorer with all metrics of this crate.
    pub fn new() -> Self {
        let headlines = built_in_headlines().into_iter();
        Self {
            headlines: headlines.map(|headline| headline.name.into_owned()).collect(),
            metrics: built_in(),
        }
    }

    /// Adds a metric, computed after the existing ones.
    ///
    /// # Errors
    /// [`MetricsError::BadOption`] for a headline that is empty, that another metric has, or that the result file uses for
    /// something else.
    pub fn with(mut self, metric: impl Metric + 'static) -> Result<Self, MetricsError> {
        for headline in metric.headlines(&all_requested()) {
            let name = headline.name.into_owned();
            let is_free = !name.is_empty() && !RESERVED.contains(&name.as_str());
            if !is_free || !self.headlines.insert(name.clone()) {
                return Err(MetricsError::bad_option(
                    "headline of a metric",
                    format!("{name:?}"),
                    "a non-empty name that no other metric or field of the results has",
                ));
            }
        }
        self.metrics.push(Box::new(metric));
        Ok(self)
    }

    /// Scores a lifetime, comparing it with the given single-task experts.
    ///
    /// # Errors
    /// Those of [`Lifetime::prepare`] and of [`Scorer::judge`].
    pub fn score(&self, log: &Log, experts: &[SteLog], options: &Options) -> Result<LifetimeMetrics, MetricsError> {
        self.judge(log, &Lifetime::prepare(log, experts, options)?, options)
    }

    /// Scores a lifetime that was already prepared from `log` with `options`, for callers that need the prepared lifetime too.
    ///
    /// # Errors
    /// Those of the metrics; [`MetricsError::BadOption`] if one set a value whose name the result files use for something else.
    pub fn judge(&self, log: &Log, lifetime: &Lifetime, options: &Options) -> Result<LifetimeMetrics, MetricsError> {
        let mut assessment = Assessment::new(log, lifetime, options);
        let mut headlines: Vec<Headline> = Vec::new();
        for metric in &self.metrics {
            metric.judge(&mut assessment)?;
            for headline in metric.headlines(options) {
                assessment.aggregate_tasks(&headline.name);
                headlines.push(headline);
            }
        }
        let ties = decided_by_rounding(&assessment)?;
        let notes: Vec<String> = super::transfer::caution(&assessment).into_iter().collect();
        let contrasts = super::transfer::contrasts_not_requested(&assessment);
        let null_bands = null_bands(log, lifetime, options, &assessment.term_perfs());
        let (regimes, tasks, found) = assessment.into_values();
        check_names(&found, "the lifetime", |name| RESERVED.contains(&name))?;
        for (task, values) in &tasks {
            check_names(values, &format!("task {task:?}"), |name| EXTENT.contains(&name))?;
        }
        for values in &regimes {
            check_names(values, "a regime", is_regime_column)?;
        }
        let in_order = |values: &Values| headlines_first(values, &headlines);
        let finish = |(task, values): (String, Values)| {
            let values = with_extent(in_order(&values), lifetime, &task);
            (task, values)
        };
        let regimes = lifetime.regimes().iter().zip(regimes);
        let (min, max) = extent(lifetime.regimes().iter());
        let reached = reached(log, lifetime, options);
        let expert_fits = expert_fits(log, lifetime, options);
        let mut cautions: Vec<String> = never_learned(&reached, &tasks, options).into_iter().collect();
        cautions.extend(incomparable_experts(&expert_fits));
        cautions.extend(super::ste_relative_performance::caution(lifetime));
        cautions.extend(ties);
        cautions.extend(caution_of_scales(lifetime, options));
        let readings = readings(&headlines, &null_bands, !notes.is_empty(), |name| {
            let parts = parts(&tasks, &contrasts, name);
            parts.into_iter().map(|part| part.value).collect()
        });
        let disagreements = disagreements(|name| readings.get(name).copied());
        cautions.extend(disagreements.into_iter().map(|(_, sentence)| sentence));
        let info = &log.scenario_info;
        Ok(LifetimeMetrics {
            lifetime: in_order(&found),
            run_id: lifetime.run_id().to_owned(),
            complexity: info.complexity.map(|word| word.to_string()).unwrap_or_default(),
            difficulty: info.difficulty.map(|word| word.to_string()).unwrap_or_default(),
            scenario_type: info.scenario_type.map(|word| word.to_string()).unwrap_or_default(),
            metrics_column: options.perf_measure.clone(),
            min,
            max,
            num_lx: num_rows(lifetime.regimes().iter(), BlockType::Train),
            num_ex: num_rows(lifetime.regimes().iter(), BlockType::Test),
            runtime: lifetime.runtime_secs(),
            normalization_data_range: lifetime.normalization_data_range().cloned(),
            as_logged: as_logged(log, options)?,
            notes,
            null_bands: null_bands.bands,
            null_draws: null_bands.drawn,
            readings,
            contrasts,
            curves: curves(lifetime, &reached),
            reached,
            cautions,
            expert_fits,
            task_metrics: tasks.into_iter().map(finish).collect::<IndexMap<_, _>>(),
            regimes: regimes
                .map(|(regime, values)| RegimeMetrics::new(regime, values))
                .collect(),
            headlines,
            definitions: options.definitions,
        })
    }
}

impl Default for Scorer {
    fn default() -> Self {
        Self::new()
    }
}

/// The reading of each metric. `is_negative`: whether some of the performances behind transfer are negative.
fn readings(
    headlines: &[Headline],
    null_bands: &NullBands,
    is_negative: bool,
    parts: impl Fn(&str) -> Vec<f64>,
) -> IndexMap<String, Reading> {
    let mut all = headlines.to_vec();
    let is_new = |headline: &Headline| headlines.iter().all(|known| known.name != headline.name);
    let banded = built_in_headlines().into_iter();
    all.extend(banded.filter(|headline| is_new(headline) && null_bands.bands.contains_key(&*headline.name)));
    let reading = |headline: Headline| {
        let band = null_bands.bands.get(&*headline.name);
        let found = Reading::of_lifetime(headline.good, band, &parts(&headline.name))?;
        let found = if is_negative && super::transfer::is_transfer(&headline.name) {
            Reading::Undefined
        } else {
            found
        };
        Some((headline.name.into_owned(), found))
    };
    all.into_iter().filter_map(reading).collect()
}

/// A caution about tasks that were never learned, which have nothing to retain; it also states the maintenance of the others.
fn never_learned(
    reached: &IndexMap<String, Reached>,
    tasks: &IndexMap<String, Values>,
    options: &Options,
) -> Option<String> {
    let is_never_learned_task = |task: &str| reached.get(task).and_then(Reached::is_never_learned) == Some(true);
    let never_learned_tasks: Vec<&str> = tasks
        .keys()
        .map(String::as_str)
        .filter(|task| is_never_learned_task(task))
        .collect();
    if never_learned_tasks.is_empty() {
        return None;
    }
    let mut parts = vec![format!(
        "never learned (below {:.0}% of the expert): {}: ignore their maintenance and transfer",
        100.0 * LEARNED_SHARE,
        never_learned_tasks.join(", ")
    )];
    for name in ["perf_maintenance_mrlep", "perf_maintenance_mrtlp"] {
        let learned = tasks.iter().filter(|(task, _)| !is_never_learned_task(task));
        let values: Vec<f64> = learned.filter_map(|(_, values)| values.number(name)).collect();
        let has_any = tasks.values().any(|values| values.number(name).is_some());
        match aggregate(values, options) {
            Some(value) => parts.push(format!("{name} of the others: {value:.3}")),
            None if has_any => parts.push(format!("{name} is based on never-learned tasks only")),
            None => {}
        }
    }
    Some(parts.join("; "))
}

/// A caution about numbers that depend on rounding of the performances, each with its value if performances within a
/// billionth count as equal.
fn decided_by_rounding(found: &Assessment<'_>) -> Result<Option<String>, MetricsError> {
    let mut resolved = Assessment::new(found.log(), found.lifetime(), found.options());
    resolved.resolves_ties = true;
    for metric in built_in() {
        metric.judge(&mut resolved)?;
    }
    let mut differing = Vec::new();
    for task in found.lifetime().tasks() {
        let (Some(values), Some(others)) = (found.task(task), resolved.task(task)) else {
            continue;
        };
        let names: IndexSet<&str> = values.iter().chain(others.iter()).map(|(name, _)| name).collect();
        for name in names {
            let [value, other] = [values, others].map(|values| values.number(name));
            let shown = |value: Option<f64>| value.map_or("none".to_owned(), |value| format!("{value:.4}"));
            if value != other {
                differing.push(format!("{name} of {task} {} ({})", shown(value), shown(other)));
            }
        }
    }
    Ok((!differing.is_empty()).then(|| {
        format!(
            "rounding alone decides between performances that differ by less than a billionth (in brackets: the value if these \
             count as equal): {}",
            differing.join(", ")
        )
    }))
}

/// Field names of the results that no headline and no value of a lifetime may use.
const RESERVED: [&str; 22] = [
    "run_id",
    "complexity",
    "difficulty",
    "scenario_type",
    "metrics_column",
    "definitions",
    "min",
    "max",
    "num_lx",
    "num_ex",
    "runtime",
    "normalization_data_range",
    "as_logged",
    "notes",
    "readings",
    "null",
    "contrasts",
    "reached",
    "curves",
    "experts",
    "cautions",
    "task_metrics",
];

/// Field names of a task in the results that no value of a task may use.
const EXTENT: [&str; 4] = ["min", "max", "num_lx", "num_ex"];

/// Checks that no metric set a value whose name the results use for something else: the name would then occur twice.
fn check_names(values: &Values, whose: &str, is_taken: impl Fn(&str) -> bool) -> Result<(), MetricsError> {
    match values.iter().find(|(name, _)| is_taken(name)) {
        Some((name, _)) => Err(MetricsError::bad_option(
            "value of a metric",
            format!("{name:?} of {whose}"),
            "a name that no field or column of the results has",
        )),
        None => Ok(()),
    }
}

/// Puts headlines first, in their order, then everything else in insertion order.
fn headlines_first(values: &Values, headlines: &[Headline]) -> Values {
    let mut ordered = Values::default();
    let is_headline = |name: &str| headlines.iter().any(|headline| headline.name == name);
    let first = (headlines.iter()).filter_map(|headline| Some((&*headline.name, values.get(&headline.name)?)));
    for (name, value) in first.chain(values.iter().filter(|(name, _)| !is_headline(name))) {
        ordered.set(name, Value::clone(value));
    }
    ordered
}

/// Adds the range of a task's performances and its numbers of rows.
fn with_extent(mut values: Values, lifetime: &Lifetime, task: &str) -> Values {
    let (min, max) = extent(lifetime.regimes_of(task));
    let [of_min, of_max, of_learning, of_evaluation] = EXTENT;
    values.set(of_min, min);
    values.set(of_max, max);
    values.set(of_learning, num_rows(lifetime.regimes_of(task), BlockType::Train));
    values.set(of_evaluation, num_rows(lifetime.regimes_of(task), BlockType::Test));
    values
}

/// Smallest and largest performance.
fn extent<'a>(regimes: impl Iterator<Item = &'a Regime>) -> (f64, f64) {
    (regimes.flat_map(|regime| regime.performance.iter().copied()))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), value| {
            (min.min(value), max.max(value))
        })
}

fn num_rows<'a>(regimes: impl Iterator<Item = &'a Regime>, block_type: BlockType) -> usize {
    (regimes.filter(|regime| regime.block_type == block_type))
        .map(Regime::len)
        .sum()
}
