//! The values of a metric as one mark per task on a line, with the lifetime's value and the value of no effect.

use plotters::prelude::*;

use super::palette::{FAINT, INK, Look, RIM};
use super::paper::{Paper, draw_mark, line};
use super::vectors;
use crate::{ReportError, extent};

const SIZE: (i32, i32) = (220, 30);
/// Maximum number of marks; more are thinned out evenly.
const MOST_MARKS: usize = 60;

/// Indices of the marks to draw: all, or an even selection that includes the first and the last.
fn drawn(marks: usize) -> impl Iterator<Item = usize> {
    let kept = marks.min(MOST_MARKS);
    (0..kept).map(move |index| index * marks.saturating_sub(1) / kept.saturating_sub(1).max(1))
}

/// The number of marks drawn, if not all are.
pub(crate) fn thinned_count(marks: usize) -> Option<String> {
    (marks > MOST_MARKS).then(|| format!("{MOST_MARKS} of {marks}"))
}

/// Marks for `tasks` (index in the lifetime's list, value), a stroke for the lifetime's value, a dashed one for no effect.
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
        let mut placed: Vec<(i32, i32)> = Vec::new();
        for (task, value) in drawn(tasks.len()).map(|index| &tasks[index]) {
            let at = (x(*value), middle);
            let free = |place: &(i32, i32)| {
                placed
                    .iter()
                    .all(|other| other.1 != place.1 || (other.0 - place.0).abs() >= d(9))
            };
            // Equal values are drawn above and below each other, so that none is hidden.
            let place = [0, -d(9), d(9)]
                .map(|aside| (at.0, at.1 + aside))
                .into_iter()
                .find(free);
            placed.push(place.unwrap_or(at));
            draw_mark(area, Look::of(*task), place.unwrap_or(at), d(4))?;
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
            let places: Vec<usize> = drawn(marks).collect();
            assert_eq!(places.len(), marks.min(MOST_MARKS));
            assert_eq!(places.first().copied(), (marks > 0).then_some(0));
            assert_eq!(places.last().copied(), marks.checked_sub(1));
            let steps: Vec<usize> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let (most, least) = (steps.iter().max(), steps.iter().min());
            assert!(
                most.zip(least).is_none_or(|(most, least)| most - least <= 1),
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
