//! Draws a metric as one mark per task on a line, with the lifetime's value and the neutral value.

use plotters::prelude::*;

use super::palette::{FAINT, INK, Look, RIM};
use super::paper::{Paper, draw_mark, line};
use super::vectors;
use crate::{ReportError, extent};

const SIZE: (i32, i32) = (220, 30);
/// Maximum number of marks; more are thinned out evenly.
const MAX_MARKS: usize = 60;

/// Indices of the marks to draw: all of them, or an even selection that includes the first and the last.
fn drawn_indices(marks: usize) -> impl Iterator<Item = usize> {
    let kept = marks.min(MAX_MARKS);
    (0..kept).map(move |index| index * marks.saturating_sub(1) / kept.saturating_sub(1).max(1))
}

/// The number of marks drawn, if not all are.
pub(crate) fn thinned_count(marks: usize) -> Option<String> {
    (marks > MAX_MARKS).then(|| format!("{MAX_MARKS} of {marks}"))
}

/// Draws a mark for each of `tasks` (index in the lifetime's list, value), a stroke for the lifetime's value, and a dashed one for
/// the neutral value.
pub(crate) fn strip(tasks: &[(usize, f64)], value: Option<f64>, neutral: Option<f64>) -> Result<String, ReportError> {
    let all = || tasks.iter().map(|task| task.1).chain(value).chain(neutral);
    let (low, high) = extent(all());
    let d = Paper::dots;
    let x = |value: f64| {
        let share = if high > low { (value - low) / (high - low) } else { 0.5 };
        d(10) + (f64::from(d(SIZE.0 - 20)) * share).round() as i32
    };
    vectors("strip", SIZE, |area| {
        let (middle, bottom) = (d(SIZE.1 / 2), d(SIZE.1 - 2));
        line(
            area,
            [(d(4), middle), (d(SIZE.0 - 4), middle)],
            RIM.light.stroke_width(2),
        )?;
        if let Some(neutral) = neutral {
            let at = x(neutral);
            for y in (d(2)..bottom).step_by(d(5) as usize) {
                line(area, [(at, y), (at, y + d(3))], FAINT.light.stroke_width(2))?;
            }
        }
        let mut occupied: Vec<(i32, i32)> = Vec::new();
        for (task, value) in drawn_indices(tasks.len()).map(|index| &tasks[index]) {
            let at = (x(*value), middle);
            let free = |position: &(i32, i32)| {
                occupied
                    .iter()
                    .all(|other| other.1 != position.1 || (other.0 - position.0).abs() >= d(9))
            };
            // Equal values are drawn above and below each other, so that none is hidden.
            let position = [0, -d(9), d(9)]
                .map(|offset| (at.0, at.1 + offset))
                .into_iter()
                .find(free);
            occupied.push(position.unwrap_or(at));
            draw_mark(area, Look::of(*task), position.unwrap_or(at), d(4))?;
        }
        if let Some(value) = value {
            let at = x(value);
            line(area, [(at, d(4)), (at, bottom - d(2))], Paper::stroke(INK.light, 2.0))?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_thinned_out_evenly_and_counted() {
        let check = |marks: usize, expected: Option<&str>| {
            let indices: Vec<usize> = drawn_indices(marks).collect();
            assert_eq!(indices.len(), marks.min(MAX_MARKS));
            assert_eq!(indices.first().copied(), (marks > 0).then_some(0));
            assert_eq!(indices.last().copied(), marks.checked_sub(1));
            let steps: Vec<usize> = indices.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let (longest, shortest) = (steps.iter().max(), steps.iter().min());
            assert!(
                longest
                    .zip(shortest)
                    .is_none_or(|(longest, shortest)| longest - shortest <= 1),
                "{steps:?}"
            );
            assert_eq!(thinned_count(marks).as_deref(), expected);
        };
        check(0, None);
        check(1, None);
        check(60, None);
        check(61, Some("60 of 61"));
        check(1770, Some("60 of 1770"));
    }
}
