//! A lifetime being scored: its inputs, and the values computed so far.

use indexmap::{IndexMap, IndexSet};

use crate::lifetime::Lifetime;
use crate::results::{Value, Values};
use crate::statistics::{mean, median};
use crate::{AggregationMethod, Definitions, Log, Options};

/// The input and output of a [`Metric`](crate::Metric).
#[derive(Debug)]
pub struct Assessment<'a> {
    log: &'a Log,
    lifetime: &'a Lifetime,
    options: &'a Options,
    regimes: Vec<Values>,
    tasks: IndexMap<String, Values>,
    whole: Values,
    /// Lifetime values that a metric set to a non-finite number; they are not aggregated from the tasks' values either.
    non_finite: IndexSet<String>,
    /// Whether performances that differ only by rounding count as equal.
    pub(super) resolves_ties: bool,
}

/// Relative tolerance for rounding when the same numbers are summed in a different order.
const ROUNDING: f64 = 1e-9;

impl<'a> Assessment<'a> {
    pub(super) fn new(log: &'a Log, lifetime: &'a Lifetime, options: &'a Options) -> Self {
        Self {
            log,
            lifetime,
            options,
            regimes: vec![Values::default(); lifetime.regimes().len()],
            tasks: (lifetime.tasks().iter())
                .map(|task| (task.clone(), Values::default()))
                .collect(),
            whole: Values::default(),
            non_finite: IndexSet::new(),
            resolves_ties: options.definitions == Definitions::Published,
        }
    }

    /// The difference up to which these performances count as equal: a billionth of the largest magnitude, or 0 if
    /// rounding decides between them.
    pub(super) fn slack(&self, values: &[f64]) -> f64 {
        let largest = || values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        if self.resolves_ties { ROUNDING * largest() } else { 0.0 }
    }

    /// The log as read, with every column.
    pub fn log(&self) -> &'a Log {
        self.log
    }

    /// The preprocessed lifetime.
    pub fn lifetime(&self) -> &'a Lifetime {
        self.lifetime
    }

    /// The options it is scored with.
    pub fn options(&self) -> &'a Options {
        self.options
    }

    /// Values of a regime by its number; `None` if there is no such regime.
    pub fn regime(&self, regime_num: usize) -> Option<&Values> {
        self.regimes.get(regime_num)
    }

    /// Values of a task by its name; `None` if there is no such task.
    pub fn task(&self, task: &str) -> Option<&Values> {
        self.tasks.get(task)
    }

    /// Terminal performance of a regime, if that metric has already been computed.
    pub fn term_perf(&self, regime_num: usize) -> Option<f64> {
        self.regime(regime_num)?.number("term_perf")
    }

    /// Sets a value of a regime; `None`, non-finite values, and values of unknown regimes are dropped.
    pub fn set_regime(&mut self, regime_num: usize, name: &str, value: Option<impl Into<Value>>) {
        if let (Some(values), Some(value)) = (self.regimes.get_mut(regime_num), value) {
            values.set(name, value);
        }
    }

    /// Sets a value of a task; `None`, non-finite values, and values of unknown tasks are dropped.
    pub fn set_task(&mut self, task: &str, name: &str, value: Option<impl Into<Value>>) {
        if let (Some(values), Some(value)) = (self.tasks.get_mut(task), value) {
            values.set(name, value);
        }
    }

    /// Sets a value of the lifetime; `None` and non-finite values are dropped. A non-finite value also prevents aggregating the
    /// tasks' values.
    pub fn set_lifetime(&mut self, name: &str, value: Option<impl Into<Value>>) {
        let Some(value) = value.map(Into::into) else { return };
        if value.is_finite() {
            self.non_finite.shift_remove(name);
            self.whole.set(name, value);
        } else {
            self.non_finite.insert(name.to_owned());
        }
    }

    /// Sets the lifetime's value to the mean or median of tasks' values, which may be infinite, such as quotients with
    /// divisor 0: if the result is not finite, the lifetime has no value, as in the reference. NaN is skipped.
    pub(super) fn set_lifetime_of(&mut self, name: &str, of_tasks: Vec<f64>) {
        let known = of_tasks.into_iter().filter(|value| !value.is_nan()).collect();
        self.set_lifetime(name, self.aggregate(known));
    }

    /// Mean or median, depending on the options; `None` without values.
    pub fn aggregate(&self, values: Vec<f64>) -> Option<f64> {
        aggregate(values, self.options)
    }

    /// Terminal performance of each regime, by its number; NaN if it has none.
    pub(super) fn term_perfs(&self) -> Vec<f64> {
        let numbers = self.regimes.iter().map(|values| values.number("term_perf"));
        numbers.map(|number| number.unwrap_or(f64::NAN)).collect()
    }

    /// If a headline has numbers for tasks but none for the lifetime, aggregates those, skipping missing ones.
    pub(super) fn aggregate_tasks(&mut self, name: &str) {
        if self.whole.get(name).is_none() && !self.non_finite.contains(name) {
            let numbers = self.tasks.values().filter_map(|values| values.number(name)).collect();
            self.set_lifetime(name, self.aggregate(numbers));
        }
    }

    /// The values of regimes, tasks and lifetime.
    pub(super) fn into_values(self) -> (Vec<Values>, IndexMap<String, Values>, Values) {
        (self.regimes, self.tasks, self.whole)
    }
}

/// Mean or median, depending on the options; `None` without values.
pub(super) fn aggregate(values: Vec<f64>, options: &Options) -> Option<f64> {
    match options.aggregation_method {
        AggregationMethod::Mean => mean(&values),
        AggregationMethod::Median => median(values),
    }
}
