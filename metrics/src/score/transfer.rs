//! Transfer: what learning one task does to another, not yet learnt (forward) or learnt before (backward).
//!
//! Not here: what becomes of a task whatever was learnt in between, see `performance_maintenance`.

use std::collections::BTreeMap;

use indexmap::{IndexMap, IndexSet};

use crate::lifetime::Lifetime;
use crate::report::{PairValues, RegimeMetrics};
use crate::{BlockType, TransferMethod};

/// Transfers by direction and method; `None` for a method that was not asked for.
pub(super) struct Transfers {
    pub(super) forward_ratio: Option<Pairs>,
    pub(super) forward_contrast: Option<Pairs>,
    pub(super) backward_ratio: Option<Pairs>,
    pub(super) backward_contrast: Option<Pairs>,
}

/// Values from a trained task to another: `[trained][other]`, in order of the later evaluation.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Pairs(IndexMap<String, PairValues>);

impl Pairs {
    /// The values from one trained task.
    pub(super) fn of_trained(&self, trained: &str) -> PairValues {
        self.0.get(trained).cloned().unwrap_or_default()
    }

    /// The first value of every pair.
    pub(super) fn first_values(&self) -> Vec<f64> {
        self.0
            .values()
            .flat_map(IndexMap::values)
            .filter_map(|values| values.first().copied())
            .collect()
    }
}

/// Two consecutive evaluations of a task between which another was learnt.
struct Gap<'a> {
    trained: &'a str,
    other: &'a str,
    before: f64,
    after: f64,
}

/// Gaps by the regime number of their later evaluation.
type Gaps<'a> = BTreeMap<usize, Gap<'a>>;

/// All transfers of a lifetime.
///
/// QUIRK: each later evaluation holds one value per direction. Where several tasks were learnt since the evaluation
/// before, all of them had a part in it, but the last pair in permutation order gets it: tasks in the order in which
/// they first appear among the assessed regimes.
pub(super) fn transfers(lifetime: &Lifetime, regimes: &[RegimeMetrics], method: TransferMethod) -> Transfers {
    let places = Places::of(lifetime);
    let (mut forward, mut backward) = (Gaps::new(), Gaps::new());
    for (trained, learning) in places.trained() {
        for other in places.tasks.keys().copied().filter(|other| *other != trained) {
            let (evaluated, first_learnt) = places.evaluated_and_first_learnt(other);
            for pair in evaluated.windows(2) {
                let term_perf = |regime_num: usize| regimes[regime_num].term_perf;
                let gap = || Gap {
                    trained,
                    other,
                    before: term_perf(pair[0]),
                    after: term_perf(pair[1]),
                };
                let between = &learning[above(learning, pair[0])..above(learning, pair[1])];
                if between.first().is_some_and(|place| *place < first_learnt) {
                    forward.insert(pair[1], gap());
                }
                if between.last().is_some_and(|place| *place > first_learnt) {
                    backward.insert(pair[1], gap());
                }
            }
        }
    }
    Transfers {
        forward_ratio: method.has_ratio().then(|| pairs(&forward, ratio)),
        forward_contrast: method.has_contrast().then(|| pairs(&forward, contrast)),
        backward_ratio: method.has_ratio().then(|| pairs(&backward, ratio)),
        backward_contrast: method.has_contrast().then(|| pairs(&backward, contrast)),
    }
}

/// Index of the first place after `limit` in ascending places.
fn above(places: &[usize], limit: usize) -> usize {
    places.partition_point(|place| *place <= limit)
}

/// Regime numbers of each task's learning and evaluation, ascending; tasks in order of appearance.
struct Places<'a> {
    tasks: IndexMap<&'a str, (Vec<usize>, Vec<usize>)>,
}

impl<'a> Places<'a> {
    fn of(lifetime: &'a Lifetime) -> Self {
        let assessed = || lifetime.regimes().iter().filter(|regime| lifetime.is_assessed(regime));
        let names: IndexSet<&str> = assessed().map(|regime| regime.task_name.as_str()).collect();
        let mut tasks: IndexMap<_, _> = names.into_iter().map(|name| (name, (Vec::new(), Vec::new()))).collect();
        for regime in assessed() {
            let (learning, evaluation) = &mut tasks[regime.task_name.as_str()];
            match regime.block_type {
                BlockType::Train => learning.push(regime.regime_num),
                BlockType::Test => evaluation.push(regime.regime_num),
            }
        }
        Self { tasks }
    }

    fn trained(&self) -> impl Iterator<Item = (&'a str, &[usize])> {
        self.tasks
            .iter()
            .map(|(name, (learning, _))| (*name, learning.as_slice()))
    }

    /// A task never learnt counts as learnt after everything.
    fn evaluated_and_first_learnt(&self, task: &str) -> (&[usize], usize) {
        let (learning, evaluation) = &self.tasks[task];
        (evaluation, learning.first().copied().unwrap_or(usize::MAX))
    }
}

/// After over before; nothing where before is 0.
fn ratio(gap: &Gap<'_>) -> Option<f64> {
    Some(gap.after / gap.before).filter(|value| value.is_finite())
}

/// Difference over sum; nothing where the sum is 0.
fn contrast(gap: &Gap<'_>) -> Option<f64> {
    Some((gap.after - gap.before) / (gap.before + gap.after)).filter(|value| value.is_finite())
}

fn pairs(gaps: &Gaps<'_>, compare: fn(&Gap<'_>) -> Option<f64>) -> Pairs {
    let mut pairs = Pairs::default();
    for gap in gaps.values() {
        if let Some(value) = compare(gap) {
            let from = pairs.0.entry(gap.trained.to_owned()).or_default();
            from.entry(gap.other.to_owned()).or_default().push(value);
        }
    }
    pairs
}
