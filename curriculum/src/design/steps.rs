//! Sequences of variants whose neighbours are a given distance apart. The search is in `walk.rs`.

use driftworld_spec::Variant;

use super::picked::Picked;
use super::walk::{MOST_COMPARISONS, Walk};
use super::wanted::{MAX_STEPS, Steps};
use crate::CurriculumError;

/// Variants of one task, beginning with `anchor`, each `distance ± tolerance` from the one before.
///
/// No two variants are closer than half the distance, so the sequence does not run back and forth. A matching variant of the
/// `pool` is preferred to a made one; among made ones, the farthest from the path so far. At a dead end the search backtracks, a
/// bounded number of times. The same arguments always give the same sequence. `task` is the task's name in scenarios.
///
/// # Errors
/// [`CurriculumError::BadSteps`] for numbers out of range; [`CurriculumError::SeveralTasks`];
/// [`CurriculumError::StepsGivenUp`] if the search reaches its limit of comparisons; [`CurriculumError::TooFewSteps`] with the
/// length of the longest sequence found, and the largest distance of any variant from the anchor.
pub fn steps(task: &str, pool: &[Variant], anchor: &Variant, wanted: &Steps) -> Result<Vec<Picked>, CurriculumError> {
    let sound = wanted.distance > 0.0
        && wanted.distance <= 1.0
        && wanted.tolerance >= 0.0
        && wanted.tolerance < wanted.distance
        && (1..=MAX_STEPS).contains(&wanted.count);
    if !sound {
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
            limit: MOST_COMPARISONS,
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
    use super::super::picked::is_alone;
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

    fn found(from: &str, distance: f64, count: u32, element: Option<Element>) -> Result<Vec<Picked>, CurriculumError> {
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
    fn neighbours_are_the_wanted_distance_apart_and_declared_ones_come_before_made_ones() {
        let path = found("rich", 0.25, 4, Some(Element::R)).unwrap();
        assert_eq!(names(&path), ["rich", "half", "middle", "rich-step-3", "rich-step-4"]);
        for pair in path.windows(2) {
            let apart = pair[0].distance(&pair[1]).unwrap();
            assert!((apart.element(Element::R).unwrap() - 0.25).abs() <= 0.01);
            assert!(is_alone(&apart, Element::R));
        }
    }

    #[test]
    fn search_backtracks_from_a_dead_end() {
        // From the middle, 3 steps of 0.25 fit on neither side: at most 2 in the reward alone, more in all elements together.
        let error = found("middle", 0.25, 3, Some(Element::R)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "steps from t#middle: found at most 2 of 0.25 ± 0.01, expected 3; the farthest variant is 0.5000 away: \
             ask for fewer or smaller steps, a larger tolerance, or another start"
        );
        let path = found("middle", 0.1, 7, None).unwrap();
        assert_eq!(path.len(), 8);
        for (a, b) in (0..8).flat_map(|a| (0..a).map(move |b| (a, b))) {
            let apart = path[a].distance(&path[b]).unwrap().total;
            assert!(
                apart > 0.05 && (a - b > 1 || (apart - 0.1).abs() <= 0.01),
                "{a} {b} {apart}"
            );
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for (distance, count) in [(0.0, 3), (1.5, 3), (0.2, 0), (0.2, 1001), (f64::NAN, 3), (0.005, 3)] {
            assert!(matches!(
                found("rich", distance, count, None),
                Err(CurriculumError::BadSteps(_))
            ));
        }
    }
}
