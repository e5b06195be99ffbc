//! Transfer: the effect of learning one task on another that is not yet learned (forward) or was learned before (backward).

use std::collections::BTreeMap;
use std::rc::Rc;

use indexmap::{IndexMap, IndexSet};

use super::assessment::{Assessment, aggregate};
use super::metric::Metric;
use super::null_bands::Statistic;
use crate::lifetime::Lifetime;
use crate::results::{Direction, Headline, PairValues, Values};
use crate::{BlockType, Definitions, MetricsError, Options};

/// `forward_transfer_…` and `backward_transfer_…` of every trained task, by ratio and contrast as requested.
///
/// Contrasts lie in -1..=1, and ratios above 1 mean an improvement, only if no performance is negative; otherwise [`caution`] warns.
///
/// QUIRK: for the lifetime's value, the first value of every pair of tasks counts, however often the pair occurs.
pub(super) struct Transfer;

impl Metric for Transfer {
    fn headlines(&self, options: &Options) -> Vec<Headline> {
        let mut headlines = Vec::new();
        for measure in requested(options) {
            for (name, others) in measure.names.into_iter().zip(["not learned yet", "learned before"]) {
                let explanation = format!("does learning one task help others {others}? {}", measure.explanation);
                headlines.push(Headline::new(
                    name,
                    explanation,
                    Direction::HigherThan(measure.no_effect),
                ));
            }
        }
        headlines
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let term_perfs = assessment.term_perfs();
        let gaps = gaps(assessment.lifetime(), assessment.options());
        for measure in requested(assessment.options()) {
            for (name, gaps) in measure.names.iter().zip(&gaps) {
                set(assessment, name, &pairs(gaps, &term_perfs, measure.compare));
            }
        }
        Ok(())
    }
}

/// A way to compare a task's performance before and after another was learned.
struct Measure {
    /// Names of forward and backward transfer.
    names: [&'static str; 2],
    explanation: &'static str,
    no_effect: f64,
    compare: Compare,
}

const CONTRAST: Measure = Measure {
    names: ["forward_transfer_contrast", "backward_transfer_contrast"],
    explanation: "change over sum, from -1 to 1 if none is negative",
    no_effect: 0.0,
    compare: contrast,
};

const RATIO: Measure = Measure {
    names: ["forward_transfer_ratio", "backward_transfer_ratio"],
    explanation: "after over before, if none is negative",
    no_effect: 1.0,
    compare: ratio,
};

fn requested(options: &Options) -> impl Iterator<Item = Measure> + use<> {
    let method = options.transfer_method;
    let contrast = method.has_contrast().then_some(CONTRAST);
    contrast.into_iter().chain(method.has_ratio().then_some(RATIO))
}

/// The lifetime's values as functions of terminal performances: contrasts always, ratios if requested.
pub(super) fn statistics<'a>(lifetime: &Lifetime, options: &'a Options) -> Vec<Statistic<'a>> {
    let pairs = gaps(lifetime, options).map(|gaps| Rc::new(by_pair(&gaps)));
    let statistic = |name, pairs: &Rc<Vec<Vec<(usize, usize)>>>, compare: Compare| {
        let pairs = Rc::clone(pairs);
        Statistic::new(name, move |term_perfs| {
            let first = |gaps: &Vec<(usize, usize)>| {
                let mut values = gaps.iter().map(|gap| (term_perfs[gap.0], term_perfs[gap.1]));
                values.find_map(|(before, after)| compare(before, after))
            };
            aggregate(pairs.iter().filter_map(first).collect(), options)
        })
    };
    let measures = [CONTRAST].into_iter();
    let measures = measures.chain(options.transfer_method.has_ratio().then_some(RATIO));
    let both = measures.map(|measure| [0, 1].map(|k| statistic(measure.names[k], &pairs[k], measure.compare)));
    both.flatten().collect()
}

/// A caution about ratios and contrasts that are based on negative performances.
pub(super) fn caution(assessment: &Assessment<'_>) -> Option<String> {
    let term_perfs = assessment.term_perfs();
    let gaps = gaps(assessment.lifetime(), assessment.options());
    let lowest = (gaps.iter().flat_map(BTreeMap::values))
        .flat_map(|gap| [term_perfs[gap.before], term_perfs[gap.after]])
        .fold(f64::INFINITY, f64::min);
    (lowest < 0.0).then(|| {
        format!(
            "some performances are negative (down to {lowest:.4}): contrasts may lie outside -1 to 1, and a ratio \
             above 1 may be a loss; normalise performance (-n task) to interpret transfer"
        )
    })
}

/// Whether a metric measures transfer.
pub(super) fn is_transfer(name: &str) -> bool {
    CONTRAST.names.contains(&name) || RATIO.names.contains(&name)
}

/// The contrasts of each task if only ratios are requested; results show them anyway.
pub(super) fn contrasts_not_requested(assessment: &Assessment<'_>) -> IndexMap<String, Values> {
    if assessment.options().transfer_method.has_contrast() {
        return IndexMap::new();
    }
    let term_perfs = assessment.term_perfs();
    let gaps = gaps(assessment.lifetime(), assessment.options());
    let contrasts = gaps.each_ref().map(|gaps| pairs(gaps, &term_perfs, contrast));
    let of_task = |task: &String| {
        let mut values = Values::default();
        for (name, pairs) in CONTRAST.names.into_iter().zip(&contrasts) {
            values.set(name, pairs.get(task.as_str()).cloned().unwrap_or_default());
        }
        (task.clone(), values)
    };
    assessment.lifetime().tasks().iter().map(of_task).collect()
}

/// Values from a trained task to another: `[trained][other]`, in order of the later evaluation.
type Pairs<'a> = IndexMap<&'a str, PairValues>;

fn set(assessment: &mut Assessment<'_>, name: &str, pairs: &Pairs<'_>) {
    for task in assessment.lifetime().tasks() {
        assessment.set_task(task, name, Some(pairs.get(task.as_str()).cloned().unwrap_or_default()));
    }
    let first_values = (pairs.values().flat_map(IndexMap::values)).filter_map(|values| values.first().copied());
    assessment.set_lifetime(name, assessment.aggregate(first_values.collect()));
}

/// Two consecutive evaluations of a task between which another was learned, by their regime numbers.
struct Gap<'a> {
    trained: &'a str,
    other: &'a str,
    before: usize,
    after: usize,
}

/// Gaps by the regime number of their later evaluation, and by the index of the trained task where several may share an evaluation.
type Gaps<'a> = BTreeMap<(usize, usize), Gap<'a>>;

/// All gaps of a lifetime, forward and backward.
///
/// QUIRK: each later evaluation holds one value per direction. If several tasks were learned since the previous evaluation, all
/// of them contributed, but only the last pair gets the value, where tasks are in the order in which they first appear among
/// the assessed regimes. Under the published definitions, each of them gets the value.
fn gaps<'a>(lifetime: &'a Lifetime, options: &Options) -> [Gaps<'a>; 2] {
    let task_regimes = TaskRegimes::of(lifetime);
    let (mut forward, mut backward) = (Gaps::new(), Gaps::new());
    for (index, (&trained, (learning, _))) in task_regimes.tasks.iter().enumerate() {
        let slot = match options.definitions {
            Definitions::Reference => 0,
            Definitions::Published => index,
        };
        for (&other, (learned, evaluated)) in task_regimes.tasks.iter().filter(|(other, _)| **other != trained) {
            // A task that is never learned counts as learned after everything else.
            let first_learned = learned.first().copied().unwrap_or(usize::MAX);
            for pair in evaluated.windows(2) {
                // If the task was first learned in a drift between the two, the change is due to learning the task itself.
                if pair[0] < first_learned && first_learned < pair[1] && task_regimes.drifts.contains(&first_learned) {
                    continue;
                }
                let gap = || Gap {
                    trained,
                    other,
                    before: pair[0],
                    after: pair[1],
                };
                let between = &learning[above(learning, pair[0])..above(learning, pair[1])];
                if between.first().is_some_and(|regime_num| *regime_num < first_learned) {
                    forward.insert((pair[1], slot), gap());
                }
                if between.last().is_some_and(|regime_num| *regime_num > first_learned) {
                    backward.insert((pair[1], slot), gap());
                }
            }
        }
    }
    [forward, backward]
}

/// Index of the first regime after `limit`, in ascending regime numbers.
fn above(regime_nums: &[usize], limit: usize) -> usize {
    regime_nums.partition_point(|regime_num| *regime_num <= limit)
}

/// Regime numbers of each task's learning and evaluation, ascending; tasks are in order of appearance. A drift counts as learning
/// the tasks in its `learns`.
struct TaskRegimes<'a> {
    tasks: IndexMap<&'a str, (Vec<usize>, Vec<usize>)>,
    /// Regime numbers of drifts.
    drifts: IndexSet<usize>,
}

impl<'a> TaskRegimes<'a> {
    fn of(lifetime: &'a Lifetime) -> Self {
        let assessed = lifetime.regimes().iter().filter(|regime| lifetime.is_assessed(regime));
        let (mut tasks, mut drifts) = (IndexMap::<_, (Vec<_>, Vec<_>)>::new(), IndexSet::new());
        for regime in assessed {
            let number = regime.regime_num;
            if regime.drift.is_some() {
                drifts.insert(number);
            }
            match regime.block_type {
                BlockType::Train => {
                    for task in &regime.learns {
                        tasks.entry(task.as_str()).or_default().0.push(number);
                    }
                }
                BlockType::Test => tasks.entry(regime.task_name.as_str()).or_default().1.push(number),
            }
        }
        Self { tasks, drifts }
    }
}

/// Compares the performance before with the one after.
type Compare = fn(f64, f64) -> Option<f64>;

/// `after` divided by `before`; `None` if `before` is 0.
fn ratio(before: f64, after: f64) -> Option<f64> {
    Some(after / before).filter(|value| value.is_finite())
}

/// The difference divided by the sum; `None` if the sum is 0.
fn contrast(before: f64, after: f64) -> Option<f64> {
    Some((after - before) / (before + after)).filter(|value| value.is_finite())
}

fn pairs<'a>(gaps: &Gaps<'a>, term_perfs: &[f64], compare: Compare) -> Pairs<'a> {
    let mut pairs = Pairs::default();
    for gap in gaps.values() {
        if let Some(value) = compare(term_perfs[gap.before], term_perfs[gap.after]) {
            let from = pairs.entry(gap.trained).or_default();
            from.entry(gap.other.to_owned()).or_default().push(value);
        }
    }
    pairs
}

/// The evaluations before and after each gap of every pair of tasks, in order.
fn by_pair(gaps: &Gaps<'_>) -> Vec<Vec<(usize, usize)>> {
    let mut pairs: IndexMap<(&str, &str), Vec<(usize, usize)>> = IndexMap::new();
    for gap in gaps.values() {
        let of_pair = pairs.entry((gap.trained, gap.other)).or_default();
        of_pair.push((gap.before, gap.after));
    }
    pairs.into_values().collect()
}
