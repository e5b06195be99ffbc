//! Checks the progress of a saved world against the objects and zones that it has.

use crate::error::Problem;
use crate::world::{ObjectProgress, Progress, WorldDraft};

/// The parts of a world's progress that do not fit the world.
pub(super) fn problems(world: &WorldDraft) -> Vec<Problem> {
    let Some(progress) = &world.progress else {
        return Vec::new();
    };
    let (found, count) = (progress.objects.len(), world.objects.len());
    let mut problems = Vec::new();
    if found != count {
        let found = format!("the progress of {found} objects");
        problems.push(wrong("objects", found, format!("one for each of {count} objects")));
    }
    for (index, (object, own)) in world.objects.iter().zip(&progress.objects).enumerate() {
        let at = |key: &str| format!("objects/{index}{key}");
        if own.present && own.returns_at.is_some() {
            let found = "a return time for an object that is present";
            problems.push(wrong(&at("/returns_at"), found, "no return time, or present false"));
        }
        if own.waypoint > 0 {
            let waypoints = object.waypoints.len();
            problems.extend(beyond(&at("/waypoint"), "waypoint", [own.waypoint], waypoints));
        }
        if object.door.is_none() && (own.open.is_some() || own.unlocked || own.closes_at.is_some()) {
            problems.push(wrong(&at(""), "the progress of a door", "none: it is not a door"));
        }
    }
    let zones = world.environment_params.zones.len();
    problems.extend(beyond("zones", "zone", progress.zones.iter().copied(), zones));
    let rails = progress.rails.iter();
    let named = rails.flat_map(|rails| rails.target.iter().chain(&rails.given_up));
    problems.extend(beyond("rails", "object", named.copied(), count));
    problems.extend(carried_problems(world, progress));
    problems
}

/// The carried objects that do not fit the world.
fn carried_problems(world: &WorldDraft, progress: &Progress) -> Vec<Problem> {
    let carried = &progress.carried;
    let mut problems = Vec::new();
    let is_carried = |index: u32| {
        let index = index as usize;
        let is_portable = world.objects.get(index).is_some_and(|object| object.portable.is_some());
        let is_away = |own: &ObjectProgress| !own.present && own.returns_at.is_none();
        is_portable && progress.objects.get(index).is_some_and(is_away)
    };
    let mut entries = carried.iter().enumerate();
    if let Some((at, thing)) = entries.find(|(at, thing)| !is_carried(**thing) || carried[..*at].contains(thing)) {
        let expected = "a portable object, once, that is not present and does not return";
        problems.push(wrong(&format!("carried/{at}"), format!("object {thing}"), expected));
    }
    let limit = world.agent_params.carry_limit;
    if carried.len() > limit as usize {
        let expected = format!("at most {limit}, the agent's carry_limit");
        problems.push(wrong("carried", format!("{} things", carried.len()), expected));
    }
    problems
}

fn wrong(position: &str, found: impl Into<String>, expected: impl Into<String>) -> Problem {
    Problem::new("spec/progress", format!("/progress/{position}"), found, expected)
}

/// The problem of the first index that is out of range.
fn beyond(position: &str, noun: &str, numbers: impl IntoIterator<Item = u32>, count: usize) -> Option<Problem> {
    let number = numbers.into_iter().find(|number| *number as usize >= count)?;
    let expected = format!("one of {count} {noun}s, counted from 0");
    Some(wrong(position, format!("{noun} {number}"), expected))
}
