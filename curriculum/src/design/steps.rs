//! Sequences of variants whose neighbours are a given distance apart. The search is in `walk.rs`.

use driftworld_spec::Variant;

use super::picked::Picked;
use super::walk::{MAX_COMPARISONS, Walk};
use super::wanted::{MAX_STEPS, Steps};
use crate::CurriculumError;

/// Variants of one task, beginning with `anchor`, each `distance ± tolerance` from the one before.
///
/// No two variants are closer than half the distance, so the sequence does not run back and forth. A matching variant of the
/// `pool` is preferred to a generated one; among generated ones, the farthest from the path so far. At a dead end the search
/// backtracks, a bounded number of times. The same arguments always give the same sequence. `task` is the task's name in
/// scenarios.
///
/// # Errors
/// [`CurriculumError::BadSteps`] for numbers out of range; [`CurriculumError::SeveralTasks`] if the pool has a variant of
/// another task; [`CurriculumError::StepsGivenUp`] if the search reaches its limit of comparisons;
/// [`CurriculumError::TooFewSteps`] with the length of the longest sequence found, and the largest distance of any variant from
/// the anchor.
pub fn steps(task: &str, pool: &[Variant], anchor: &Variant, wanted: &Steps) -> Result<Vec<Picked>, CurriculumError> {
    let is_valid = wanted.distance > 0.0
        && wanted.distance <= 1.0
        && wanted.tolerance >= 0.0
        && wanted.tolerance < wanted.distance
        && (1..=MAX_STEPS).contains(&wanted.count);
    if !is_valid {
        return Err(CurriculumError::BadSteps(*wanted));
    }
    if let Some(other) = pool.iter().find(|other| other.task().name() != anchor.task().name()) {
        return Err(CurriculumError::several_tasks(anchor.id(), other.id()));
    }
    let mut walk = Walk::new(task, pool, anchor, wanted);
    if walk.extend()? {
        return Ok(walk.path);
    }
    if walk.budget_exhausted() {
        return Err(CurriculumError::StepsGivenUp {
            anchor: anchor.id(),
            found: walk.longest,
            wanted: *wanted,
            limit: MAX_COMPARISONS,
        });
    }
    Err(CurriculumError::TooFewSteps {
        anchor: anchor.id(),
        found: walk.longest,
        wanted: *wanted,
        farthest: walk.farthest()?,
    })
}

#[cfg(test)]
mod tests {
    use super::super::picked::is_only_in;
    use super::*;
    use driftworld_spec::{Element, TaskSpec};
    use std::sync::Arc;

    fn task() -> Arc<TaskSpec> {
        TaskSpec::from_json(
            "t",
            r#"{ "name": "t", "parameters": {
                "pay": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 },
                "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 },
                "look": { "role": "variant", "type": "string", "affects": ["O"], "choices": ["a", "b"], "default": "a" } },
               "variants": { "rich": {}, "half": { "pay": 50 }, "middle": { "pay": 0 } } }"#,
        )
        .unwrap()
    }

    fn search(from: &str, distance: f64, count: u32, element: Option<Element>) -> Result<Vec<Picked>, CurriculumError> {
        let task = task();
        let wanted = Steps {
            distance,
            tolerance: 0.01,
            count,
            element,
        };
        steps("t", &task.all_variants(), &task.variant(from).unwrap(), &wanted)
    }

    fn names(picked: &[Picked]) -> Vec<&str> {
        picked.iter().map(|one| one.choice.name()).collect()
    }

    #[test]
    fn neighbours_are_the_wanted_distance_apart_and_declared_ones_come_first() {
        let path = search("rich", 0.25, 4, Some(Element::R)).unwrap();
        assert_eq!(names(&path), ["rich", "half", "middle", "rich-step-3", "rich-step-4"]);
        for pair in path.windows(2) {
            let gap = pair[0].distance(&pair[1]).unwrap();
            assert!((gap.element(Element::R).unwrap() - 0.25).abs() <= 0.01);
            assert!(is_only_in(&gap, Element::R));
        }
    }

    #[test]
    fn search_backtracks_from_a_dead_end() {
        // From the middle, 3 steps of 0.25 fit on neither side: at most 2 in the reward alone, more in all elements together.
        let error = search("middle", 0.25, 3, Some(Element::R)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "steps from t#middle: found at most 2 steps of 0.25 ± 0.01, expected 3; the farthest variant is 0.5000 away: \
             ask for fewer or smaller steps, a larger tolerance, or another start"
        );
        let path = search("middle", 0.1, 7, None).unwrap();
        assert_eq!(path.len(), 8);
        for (a, b) in (0..8).flat_map(|a| (0..a).map(move |b| (a, b))) {
            let gap = path[a].distance(&path[b]).unwrap().total;
            assert!(gap > 0.05 && (a - b > 1 || (gap - 0.1).abs() <= 0.01), "{a} {b} {gap}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for (distance, count) in [(0.0, 3), (1.5, 3), (0.2, 0), (0.2, 1001), (f64::NAN, 3), (0.005, 3)] {
            assert!(matches!(
                search("rich", distance, count, None),
                Err(CurriculumError::BadSteps(_))
            ));
        }
    }
}
