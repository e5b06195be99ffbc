//! Matches the objects of two worlds within each class, by all their features together.

use std::cell::RefCell;
use std::cmp::Ordering;

use crate::assignment::{Assignment, MAX_ASSIGNED};
#[cfg(test)]
use crate::combined::kinds::KindDistance;
use crate::combined::kinds::Kinds;
use crate::combined::sketch::ObjectFeatures;

/// Distance between objects, in metres, that counts as 1.
pub(super) const POSITION_UNIT: f64 = 10.0;

impl ObjectFeatures {
    pub(super) fn metres(&self, other: &Self) -> f64 {
        length(self.position, other.position)
    }

    /// In Oklab; 1 between a coloured object and one with its asset's own colours.
    pub(super) fn color_distance(&self, other: &Self) -> f64 {
        match (self.color, other.color) {
            (Some(a), Some(b)) if a.0 == b.0 => 0.0,
            (Some(a), Some(b)) => a.distance(b),
            (None, None) => 0.0,
            _ => 1.0,
        }
    }

    /// The cost of matching two objects of one class: their distance in everything but the reward, which only breaks ties. A
    /// metric.
    #[cfg(test)]
    fn cost(&self, other: &Self) -> f64 {
        self.position_cost(other) + KindDistance::between(self, other).cost
    }

    fn position_cost(&self, other: &Self) -> f64 {
        self.metres(other) * (1.0 / POSITION_UNIT)
            + turn(self.heading, other.heading) * (1.0 / 180.0)
            // The relative difference of scales, which are above 0.
            + (self.scale - other.scale).abs() * self.per_scale.min(other.per_scale)
    }
}

pub(super) fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    (x * x + y * y).sqrt()
}

/// The smaller angle between two headings in `0..360`.
pub(super) fn turn(a: f64, b: f64) -> f64 {
    let turn = (a - b).abs();
    turn.min(360.0 - turn)
}

#[derive(Default)]
struct Buffers {
    costs: Vec<f64>,
    assignment: Assignment,
    /// Which objects of the larger set are matched.
    is_matched: Vec<bool>,
}

/// Visits each object of one class in two worlds once: every object of the smaller set with its match, the unmatched objects of
/// the larger set alone. The matching has the minimum sum of costs; ties are broken by the objects alone, not by the order of
/// the worlds.
///
/// Rewards decide only between otherwise equal matchings; if they counted, a world with all rewards reversed would look like one
/// with swapped objects.
pub(super) fn each_match<'a>(
    a: &'a [ObjectFeatures],
    b: &'a [ObjectFeatures],
    mut visit: impl FnMut(Option<&'a ObjectFeatures>, Option<&'a ObjectFeatures>),
) {
    thread_local! {
        static BUFFERS: RefCell<Buffers> = RefCell::default();
    }
    if a.is_empty() || b.is_empty() {
        for unmatched in a {
            visit(Some(unmatched), None);
        }
        for unmatched in b {
            visit(None, Some(unmatched));
        }
        return;
    }
    let in_order = comes_first(a, b);
    let (fewer, more) = if in_order { (a, b) } else { (b, a) };
    let mut visit_in_order = |one, other| if in_order { visit(one, other) } else { visit(other, one) };
    BUFFERS.with_borrow_mut(
        |Buffers {
             costs,
             assignment,
             is_matched,
         }| {
            costs.clear();
            // Sets too large for an assignment are compared in order: the cost matrix would take gigabytes.
            let may_solve = more.len() <= MAX_ASSIGNED;
            if may_solve && is_of_one_kind(fewer) && is_of_one_kind(more) {
                // Costs between kinds are the same for every matching.
                for one in fewer {
                    costs.extend(more.iter().map(|other| one.position_cost(other)));
                }
            } else if may_solve {
                Kinds::with(|kinds| {
                    for one in fewer {
                        let cost = |other| one.position_cost(other) + kinds.distance(one, other).cost;
                        costs.extend(more.iter().map(cost));
                    }
                });
            }
            // All costs are finite.
            let is_solved = may_solve && assignment.solve(costs, fewer.len(), more.len()).is_ok();
            let partner = |index: usize| {
                if is_solved {
                    assignment.partners()[index]
                } else {
                    Some(index)
                }
            };
            is_matched.clear();
            is_matched.resize(more.len(), false);
            for (index, one) in fewer.iter().enumerate() {
                let other = partner(index).map(|column| {
                    is_matched[column] = true;
                    &more[column]
                });
                visit_in_order(Some(one), other);
            }
            for (other, _) in more.iter().zip(&*is_matched).filter(|(_, is_matched)| !**is_matched) {
                visit_in_order(None, Some(other));
            }
        },
    );
}

fn is_of_one_kind(objects: &[ObjectFeatures]) -> bool {
    objects.windows(2).all(|pair| pair[0].kind == pair[1].kind)
}

/// Whether `a` has fewer objects than `b`, or the same number and does not come after it in order.
fn comes_first(a: &[ObjectFeatures], b: &[ObjectFeatures]) -> bool {
    let by_number = a.len().cmp(&b.len());
    let by_object = || a.iter().zip(b).map(|(a, b)| a.order(b)).find(|order| order.is_ne());
    by_number.then_with(|| by_object().unwrap_or(Ordering::Equal)).is_le()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::combined::sketch::Sketcher;
    use driftworld_spec::{Object, Stimulus, World};
    use proptest::prelude::*;

    fn features(objects: &[(f64, f64, f64)]) -> Vec<ObjectFeatures> {
        let object = |(x, y, reward): &(f64, f64, f64)| {
            let mut object = Object::new("cube", [*x, *y]);
            (object.reward, object.reward_stimulus) = (*reward, vec![Stimulus::AgentCollide]);
            object
        };
        let world = World::default()
            .edit(|world| world.objects.extend(objects.iter().map(object)))
            .unwrap();
        Sketcher::default().sketch(&world).objects
    }

    /// The minimum sum over all matchings, by brute force.
    fn least(fewer: &[ObjectFeatures], more: &[ObjectFeatures]) -> f64 {
        let Some((first, rest)) = fewer.split_first() else {
            return 0.0;
        };
        let costs = (0..more.len()).map(|at| {
            let mut left = more.to_vec();
            let other = left.remove(at);
            first.cost(&other) + least(rest, &left)
        });
        costs.fold(f64::INFINITY, f64::min)
    }

    fn objects() -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
        prop::collection::vec((-60.0..60.0_f64, -60.0..60.0_f64, -300.0..300.0_f64), 0..5)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn matching_is_as_cheap_as_the_best_by_brute_force(a in objects(), b in objects()) {
            let (a, b) = (features(&a), features(&b));
            let (mut sum, mut alone) = (0.0, 0);
            each_match(&a, &b, |a, b| match (a, b) {
                (Some(a), Some(b)) => sum += a.cost(b),
                _ => alone += 1,
            });
            let (fewer, more) = if a.len() <= b.len() { (&a, &b) } else { (&b, &a) };
            let least = least(fewer, more);
            prop_assert!((sum - least).abs() < 1e-9, "{sum} and {least}");
            prop_assert_eq!(alone, more.len() - fewer.len());
        }
    }
}
