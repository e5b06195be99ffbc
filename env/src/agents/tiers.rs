//! Chooses the objects and zones that are worth going to.

use std::cmp::Ordering;

use driftworld_spec::{Object, Stimulus, Zone};

use super::steering::fails;
use crate::sim::SimRef;

/// Objects worth going to, by index: those that pay now without ending the episode; if there are none, those that pay
/// and end it as a success; failing that, those that only end it as a success.
pub(super) fn wanted(sim: SimRef) -> Vec<usize> {
    tiers(sim).into_iter().find(|tier| !tier.is_empty()).unwrap_or_default()
}

/// Objects worth going to, by index, in tiers: those that pay without ending the episode; those that pay and end it as a
/// success; those that only end it as a success. Paying objects that fail the episode when touched are left out.
pub(super) fn tiers(sim: SimRef) -> [Vec<usize>; 3] {
    let world = sim.world;
    let states = sim.objects();
    // In a sequence only the first remaining object pays.
    let remaining = world.objects.iter().zip(states).filter(|(_, state)| !state.collected);
    let first = remaining.filter_map(|(object, _)| object.order).min();
    let is_due = |index: &usize| {
        let order = world.objects[*index].order;
        order.is_none_or(|own| first.is_none_or(|first| own <= first))
    };
    let pays =
        |index: &usize| world.objects[*index].is_target() && states[*index].present && states[*index].reward > 0.0;
    let is_safe = |index: &usize| !fails(world, &world.objects[*index]);
    let ends = |index: &usize| {
        let mut conditions = world.rules.success.iter();
        conditions.any(|condition| condition.is_touch_of(&world.objects[*index]))
    };
    let paying = (0..states.len()).filter(pays).filter(is_due).filter(is_safe);
    let (paying_ends, paying_only): (Vec<usize>, Vec<usize>) = paying.partition(ends);
    let is_left = |index: &usize| states[*index].present && paying_ends.binary_search(index).is_err();
    let ending = (0..states.len()).filter(ends).filter(is_left).collect();
    [paying_only, paying_ends, ending]
}

/// Whether an object pays for this stimulus.
pub(super) fn reacts_to(object: &Object, stimulus: Stimulus) -> bool {
    object.reward_stimulus.contains(&stimulus) || object.reward_once_stimulus.contains(&stimulus)
}

/// Compares zones: those that end the episode in success are worth more, then those that pay more.
pub(super) fn by_worth(a: &Zone, b: &Zone) -> Ordering {
    let by_end = a.ends.is_some().cmp(&b.ends.is_some());
    let by_pay = by_end.then(a.reward_per_second.total_cmp(&b.reward_per_second));
    by_pay.then(a.reward_on_entering.total_cmp(&b.reward_on_entering))
}
