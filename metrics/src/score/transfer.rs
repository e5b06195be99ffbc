//! Transfer: what learning one task does to another, not yet learned (forward) or learned before (backward).
//!
//! Not here: what becomes of a task whatever was learned in between, see `performance_maintenance`.

use std::collections::BTreeMap;
use std::rc::Rc;

use indexmap::{IndexMap, IndexSet};

use super::assessment::aggregate;
use super::null_bands::Statistic;
use super::{Assessment, Metric};
use crate::lifetime::Lifetime;
use crate::results::{Direction, Headline, PairValues, Values};
use crate::{BlockType, Definitions, MetricsError, Options};

/// `forward_transfer_…` and `backward_transfer_…` of every trained task, by ratio and contrast as far as they are asked
/// for.
///
/// A contrast lies in -1..=1, and a ratio above 1 is an improvement, only where no performance is negative; [`caution`] says so where
/// one is.
///
/// QUIRK: for the lifetime's value, the first value of every pair of tasks counts, however often the pair met.
pub(super) struct Transfer;

impl Metric for Transfer {
    fn headlines(&self, options: &Options) -> Vec<Headline> {
        let mut headlines = Vec::new();
        let method = options.transfer_method;
        if method.has_contrast() {
            headlines.push(Headline::new(
                "forward_transfer_contrast",
                "does learning one task help others not learned yet? change over sum, from -1 to 1 if none is negative",
                Direction::HigherThan(0.0),
            ));
            headlines.push(Headline::new(
                "backward_transfer_contrast",
                "does learning one task help others learned before? change over sum, from -1 to 1 if none is negative",
                Direction::HigherThan(0.0),
            ));
        }
        if method.has_ratio() {
            headlines.push(Headline::new(
                "forward_transfer_ratio",
                "does learning one task help others not learned yet? after over before, if none is negative",
                Direction::HigherThan(1.0),
            ));
            headlines.push(Headline::new(
                "backward_transfer_ratio",
                "does learning one task help others learned before? after over before, if none is negative",
                Direction::HigherThan(1.0),
            ));
        }
        headlines
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let method = assessment.options().transfer_method;
        let term_perfs = assessment.term_perfs();
        let (forward, backward) = gaps(assessment.lifetime(), assessment.options());
        for (direction, gaps) in [("forward", &forward), ("backward", &backward)] {
            for (measure, is_asked_for, compare) in [
                ("ratio", method.has_ratio(), ratio as Compare),
                ("contrast", method.has_contrast(), contrast),
            ] {
                if is_asked_for {
                    let name = format!("{direction}_transfer_{measure}");
                    set(assessment, &name, &pairs(gaps, &term_perfs, compare));
                }
            }
        }
        Ok(())
    }
}

/// The lifetime's values as functions of terminal performances: contrasts always, ratios if they are asked for.
pub(super) fn statistics<'a>(lifetime: &Lifetime, options: &'a Options) -> Vec<Statistic<'a>> {
    let (forward, backward) = gaps(lifetime, options);
    let (forward, backward) = (Rc::new(by_pair(&forward)), Rc::new(by_pair(&backward)));
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
    let mut found = vec![
        statistic("forward_transfer_contrast", &forward, contrast),
        statistic("backward_transfer_contrast", &backward, contrast),
    ];
    if options.transfer_method.has_ratio() {
        found.push(statistic("forward_transfer_ratio", &forward, ratio));
        found.push(statistic("backward_transfer_ratio", &backward, ratio));
    }
    found
}

/// What a reader of ratios and contrasts must be told, where performances they were made of are negative.
pub(super) fn caution(assessment: &Assessment<'_>) -> Option<String> {
    let term_perfs = assessment.term_perfs();
    let (forward, backward) = gaps(assessment.lifetime(), assessment.options());
    let gaps = forward.values().chain(backward.values());
    let least = gaps
        .flat_map(|gap| [term_perfs[gap.before], term_perfs[gap.after]])
        .fold(f64::INFINITY, f64::min);
    (least < 0.0).then(|| {
        format!(
            "some performances are negative (down to {least:.4}): contrasts may lie outside -1 to 1, and a ratio \
             above 1 may be a loss; normalise performance (-n task) to interpret transfer"
        )
    })
}

/// Whether a metric is one of transfer.
pub(super) fn is_transfer(name: &str) -> bool {
    let measure = name
        .strip_prefix("forward_transfer_")
        .or(name.strip_prefix("backward_transfer_"));
    matches!(measure, Some("contrast" | "ratio"))
}

/// The contrasts of each task where ratios alone are asked for: they are shown all the same.
pub(super) fn contrasts_not_asked_for(assessment: &Assessment<'_>) -> IndexMap<String, Values> {
    if assessment.options().transfer_method.has_contrast() {
        return IndexMap::new();
    }
    let term_perfs = assessment.term_perfs();
    let (forward, backward) = gaps(assessment.lifetime(), assessment.options());
    let (forward, backward) = (
        pairs(&forward, &term_perfs, contrast),
        pairs(&backward, &term_perfs, contrast),
    );
    let of_task = |task: &String| {
        let mut values = Values::default();
        for (name, pairs) in [
            ("forward_transfer_contrast", &forward),
            ("backward_transfer_contrast", &backward),
        ] {
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

/// Gaps by the regime number of their later evaluation, and by the trained task where several may share one.
type Gaps<'a> = BTreeMap<(usize, usize), Gap<'a>>;

/// All gaps of a lifetime, forward and backward.
///
/// QUIRK: each later evaluation holds one value per direction. Where several tasks were learned since the evaluation
/// before, all of them had a part in it, but the last pair in permutation order gets it: tasks in the order in which
/// they first appear among the assessed regimes. Under the published definitions each of them gets it.
fn gaps<'a>(lifetime: &'a Lifetime, options: &Options) -> (Gaps<'a>, Gaps<'a>) {
    let places = Places::of(lifetime);
    let (mut forward, mut backward) = (Gaps::new(), Gaps::new());
    for (index, (trained, learning)) in places.trained().enumerate() {
        let who = match options.definitions {
            Definitions::Reference => 0,
            Definitions::Published => index,
        };
        for other in places.tasks.keys().copied().filter(|other| *other != trained) {
            let (evaluated, first_learned) = places.evaluated_and_first_learned(other);
            for pair in evaluated.windows(2) {
                let gap = || Gap {
                    trained,
                    other,
                    before: pair[0],
                    after: pair[1],
                };
                let between = &learning[above(learning, pair[0])..above(learning, pair[1])];
                if between.first().is_some_and(|place| *place < first_learned) && !places.drift_begins(other, pair) {
                    forward.insert((pair[1], who), gap());
                }
                if between.last().is_some_and(|place| *place > first_learned) && !places.drift_begins(other, pair) {
                    backward.insert((pair[1], who), gap());
                }
            }
        }
    }
    (forward, backward)
}

/// Index of the first place after `limit` in ascending places.
fn above(places: &[usize], limit: usize) -> usize {
    places.partition_point(|place| *place <= limit)
}

/// Regime numbers of each task's learning and evaluation, ascending; tasks in order of appearance. Drifts count as
/// learning of the tasks that they pass.
struct Places<'a> {
    tasks: IndexMap<&'a str, (Vec<usize>, Vec<usize>)>,
    /// Regime numbers of drifts.
    drifts: IndexSet<usize>,
}

impl<'a> Places<'a> {
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

    /// Whether a task was learned for the first time between two evaluations, by a drift: then what changed there was
    /// its own learning, and no transfer.
    fn drift_begins(&self, task: &str, evaluations: &[usize]) -> bool {
        let first = self.tasks[task].0.first();
        first.is_some_and(|first| evaluations[0] < *first && *first < evaluations[1] && self.drifts.contains(first))
    }

    fn trained(&self) -> impl Iterator<Item = (&'a str, &[usize])> + use<'a, '_> {
        self.tasks
            .iter()
            .map(|(name, (learning, _))| (*name, learning.as_slice()))
    }

    /// A task never learned counts as learned after everything.
    fn evaluated_and_first_learned(&self, task: &str) -> (&[usize], usize) {
        let (learning, evaluation) = &self.tasks[task];
        (evaluation, learning.first().copied().unwrap_or(usize::MAX))
    }
}

/// How performance after is held against performance before.
type Compare = fn(f64, f64) -> Option<f64>;

/// After over before; nothing where before is 0.
fn ratio(before: f64, after: f64) -> Option<f64> {
    Some(after / before).filter(|value| value.is_finite())
}

/// Difference over sum; nothing where the sum is 0.
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

/// The evaluations before and after of each pair of tasks, in order.
fn by_pair(gaps: &Gaps<'_>) -> Vec<Vec<(usize, usize)>> {
    let mut pairs: IndexMap<(&str, &str), Vec<(usize, usize)>> = IndexMap::new();
    for gap in gaps.values() {
        let of_pair = pairs.entry((gap.trained, gap.other)).or_default();
        of_pair.push((gap.before, gap.after));
    }
    pairs.into_values().collect()
}
