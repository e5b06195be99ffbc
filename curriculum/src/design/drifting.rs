//! Learning blocks that drift from variant to variant; a drift may cross the boundaries of blocks.

use driftworld_spec::{DriftSchedule, DriftSwitch, Regime, RegimeDrift};

use super::Choice;
use super::streams::Streams;
use crate::CurriculumError;

/// How learning blocks drift from each variant to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drifting {
    /// The schedule of each drift.
    pub schedule: DriftSchedule,
    /// How values without intermediate values change.
    pub switch: DriftSwitch,
}

/// The regimes of each learning block: the drifts along `path` one after the other, divided evenly among `num_blocks`.
///
/// A drift cut by a block boundary continues in the next block from the same progress.
pub(super) fn lessons(
    variants: &[Choice],
    path: &[usize],
    num_blocks: u64,
    (learn, streams): (u32, &Streams),
    drifting: Drifting,
) -> Result<Vec<Vec<Regime>>, CurriculumError> {
    let num_drifts = path.len().saturating_sub(1) as u64;
    // Counted over all drifts together, so that no layout is repeated even if variants share their worlds.
    let mut num_learned = 0;
    let mut lessons = Vec::new();
    // Lengths are counted in units: a drift has as many units as there are blocks, a block as many as there are drifts.
    for block in 0..num_blocks {
        let (start, end) = (block * num_drifts, (block + 1) * num_drifts);
        let learned = |part: u64| ((part - start) * u64::from(learn) + num_drifts / 2) / num_drifts;
        let mut regimes = Vec::new();
        let mut position = start;
        while position < end {
            let drift_index = position / num_blocks;
            let end_of_part = end.min((drift_index + 1) * num_blocks);
            let count = (learned(end_of_part) - learned(position)) as u32;
            let (from, to) = (path[drift_index as usize], path[drift_index as usize + 1]);
            let is_between_tasks = variants[from].task != variants[to].task;
            if is_between_tasks && drifting.switch != DriftSwitch::Task {
                return Err(CurriculumError::DriftBetweenTasks {
                    from: variants[from].id(),
                    to: variants[to].id(),
                });
            }
            if count > 0 {
                let progress = |part: u64| (part - drift_index * num_blocks) as f64 / num_blocks as f64;
                let drift = RegimeDrift {
                    task: is_between_tasks.then(|| variants[to].task.clone()),
                    values: variants[to].values.clone(),
                    name: variants[to].name.clone(),
                    schedule: drifting.schedule,
                    switch: drifting.switch,
                    from: progress(position),
                    until: progress(end_of_part),
                    ..RegimeDrift::to(&variants[to].variant)
                };
                regimes.push(Regime {
                    drift: Some(drift),
                    ..streams.learning(&variants[from], count, num_learned)
                });
                num_learned += u64::from(count);
            }
            position = end_of_part;
        }
        lessons.push(regimes);
    }
    Ok(lessons)
}

#[cfg(test)]
mod tests {
    use super::super::Design;
    use super::*;

    /// Each regime as `variant>variant from-until xCOUNT`, with `|` between blocks.
    #[track_caller]
    fn check(path: &[usize], num_blocks: u64, expected: &str) {
        let variants = ["a", "b", "c"].map(|name| Choice::new("t", name));
        let options = Design {
            learn: 20,
            ..Design::default()
        };
        let streams = (options.learn, &Streams::new(&variants, &options));
        let lessons = lessons(&variants, path, num_blocks, streams, Drifting::default()).unwrap();
        let regime = |regime: &Regime| {
            let drift = regime.drift.as_ref().unwrap();
            format!(
                "{}>{} {}-{} x{}",
                regime.variant, drift.to, drift.from, drift.until, regime.count
            )
        };
        let block = |block: &Vec<Regime>| block.iter().map(regime).collect::<Vec<_>>().join(", ");
        assert_eq!(lessons.iter().map(block).collect::<Vec<_>>().join(" | "), expected);
    }

    #[test]
    fn drifts_are_divided_evenly_across_blocks() {
        check(&[0, 1, 2], 2, "a>b 0-1 x20 | b>c 0-1 x20");
        check(&[0, 1], 2, "a>b 0-0.5 x20 | a>b 0.5-1 x20");
        check(&[0, 1, 2], 1, "a>b 0-1 x10, b>c 0-1 x10");
        check(
            &[0, 1, 2, 0],
            2,
            "a>b 0-1 x13, b>c 0-0.5 x7 | b>c 0.5-1 x7, c>a 0-1 x13",
        );
    }

    #[test]
    fn world_numbers_continue_between_drifts_that_share_worlds() {
        let variants = ["a", "b"].map(|name| Choice::new("t", name));
        let options = Design {
            learn: 20,
            paired_learning: true,
            ..Design::default()
        };
        let streams = (options.learn, &Streams::new(&variants, &options));
        let lessons = lessons(&variants, &[0, 1, 0, 1], 2, streams, Drifting::default()).unwrap();
        let mut next = 0;
        for regime in lessons.iter().flatten() {
            assert_eq!(regime.first_index, next);
            next += u64::from(regime.count);
        }
        assert_eq!(next, 40);
    }

    #[test]
    fn only_whole_variants_switch_between_tasks() {
        let variants = [Choice::new("t", "a"), Choice::new("u", "b"), Choice::new("u", "c")];
        let options = Design::default();
        let streams = (options.learn, &Streams::new(&variants, &options));
        let lessons_with = |switch| {
            let drifting = Drifting {
                switch,
                ..Drifting::default()
            };
            lessons(&variants, &[0, 1, 2], 2, streams, drifting)
        };
        for switch in [DriftSwitch::AtPoint, DriftSwitch::Mixture] {
            assert!(matches!(
                lessons_with(switch),
                Err(CurriculumError::DriftBetweenTasks { .. })
            ));
        }
        let lessons = lessons_with(DriftSwitch::Task).unwrap();
        let ends: Vec<_> = lessons
            .iter()
            .flatten()
            .map(|regime| (regime.task.as_str(), regime.end_task()))
            .collect();
        assert_eq!(ends, [("t", "u"), ("u", "u")]);
    }
}
