//! The values of a metric, one mark per task on a line, with the lifetime's value and the one that means no effect.
//!
//! Not here: the table the strips stand in, see `page`.

use plotters::prelude::*;

use super::palette::{FAINT, INK, Look, RIM};
use super::paper::{Paper, draw_mark};
use super::vectors;
use crate::ReportError;

const SIZE: (i32, i32) = (220, 30);
/// Tasks beyond these are left out.
const MOST_MARKS: usize = 60;

/// Marks for `tasks` (place in the lifetime's list, value), a stroke for the lifetime's value, a dashed one for no effect.
pub(crate) fn strip(tasks: &[(usize, f64)], value: Option<f64>, neutral: Option<f64>) -> Result<String, ReportError> {
    let all = || tasks.iter().map(|task| task.1).chain(value).chain(neutral);
    let low = all().fold(f64::INFINITY, f64::min);
    let high = all().fold(f64::NEG_INFINITY, f64::max);
    let d = Paper::dots;
    let x = |value: f64| {
        let share = if high > low { (value - low) / (high - low) } else { 0.5 };
        d(10) + (f64::from(d(SIZE.0 - 20)) * share).round() as i32
    };
    vectors("strip", SIZE, |area| {
        let (middle, bottom) = (d(SIZE.1 / 2), d(SIZE.1 - 2));
        area.draw(&PathElement::new(
            [(d(4), middle), (d(SIZE.0 - 4), middle)],
            RIM.light.stroke_width(2),
        ))?;
        if let Some(neutral) = neutral {
            let at = x(neutral);
            for y in (d(2)..bottom).step_by(d(5) as usize) {
                area.draw(&PathElement::new(
                    [(at, y), (at, y + d(3))],
                    FAINT.light.stroke_width(2),
                ))?;
            }
        }
        let mut placed: Vec<(i32, i32)> = Vec::new();
        for (task, value) in tasks.iter().take(MOST_MARKS) {
            let at = (x(*value), middle);
            let free = |place: &(i32, i32)| {
                placed
                    .iter()
                    .all(|other| other.1 != place.1 || (other.0 - place.0).abs() >= d(9))
            };
            // Equal values would hide each other: they stand above and below.
            let place = [0, -d(9), d(9)]
                .map(|aside| (at.0, at.1 + aside))
                .into_iter()
                .find(free);
            placed.push(place.unwrap_or(at));
            draw_mark(area, Look::of(*task), place.unwrap_or(at), d(4))?;
        }
        if let Some(value) = value {
            let at = x(value);
            area.draw(&PathElement::new(
                [(at, d(4)), (at, bottom - d(2))],
                Paper::stroke(INK.light, 2.0),
            ))?;
        }
        Ok(())
    })
}
