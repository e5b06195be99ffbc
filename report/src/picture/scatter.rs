//! Scatter plots with named points.

#![expect(
    clippy::disallowed_methods,
    reason = "the logarithm only counts the digits of tick labels"
)]

use super::{Drawing, FAINT, INK, Level, Rgb, Side, corner, font_size, middle, round_step, text_width, words};
use crate::extent;

/// A named point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Horizontal value.
    pub x: f64,
    /// Vertical value.
    pub y: f64,
    /// Its name.
    pub label: String,
}

/// One pair of axes with its points.
#[derive(Clone, Debug)]
pub struct Panel {
    /// The title.
    pub title: String,
    /// A line below the title.
    pub words: String,
    /// Name of the horizontal axis.
    pub across: String,
    /// Name of the vertical axis.
    pub up: String,
    /// The value of `y` that means no change, marked by a line.
    pub neutral: f64,
    /// The points.
    pub points: Vec<Point>,
}

const WIDTH: u32 = 720;
const HEIGHT: u32 = 580;
/// Room around the axes: left, right, above, below.
const ROOM: [i32; 4] = [84, 24, 104, 58];
const LABEL: f64 = 16.0;
const DOT: Rgb = [22, 72, 130];
const RIM: Rgb = [205, 209, 214];

/// Draws panels side by side, each with its points. Names for which there is no room are left out and counted.
pub fn scatter(panels: &[Panel]) -> Drawing {
    let mut picture = Drawing::blank(WIDTH * panels.len().max(1) as u32, HEIGHT);
    for (index, panel) in panels.iter().enumerate() {
        panel.draw(&mut picture, index as i32 * WIDTH as i32);
    }
    picture
}

/// A rectangle in pixels: left, top, right, bottom.
type Box4 = [i32; 4];

/// A range of numbers on an axis of the picture.
struct Axis {
    from: f64,
    step: f64,
    ticks: usize,
}

impl Axis {
    /// A range that includes the values, with about five round tick marks.
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = extent(values);
        let (low, high) = if high > low {
            (low, high)
        } else {
            (low - 0.5, low + 0.5)
        };
        let step = round_step((high - low) / 5.0);
        let from = (low / step).floor() * step;
        let ticks = (((high - from) / step).ceil() as usize).max(1);
        Self { from, step, ticks }
    }

    fn share(&self, value: f64) -> f64 {
        (value - self.from) / (self.step * self.ticks as f64)
    }

    /// The tick marks with their labels.
    fn marks(&self) -> impl Iterator<Item = (f64, String)> + '_ {
        let digits = (-self.step.log10().floor()).max(0.0) as usize;
        (0..=self.ticks).map(move |tick| {
            let value = self.from + self.step * tick as f64;
            // Avoids a minus sign before a zero with a rounding error.
            let value = if value.abs() < self.step * 1e-9 { 0.0 } else { value };
            (value, format!("{value:.digits$}"))
        })
    }
}

impl Panel {
    fn draw(&self, picture: &mut Drawing, left: i32) {
        let x_axis = Axis::around(self.points.iter().map(|point| point.x).chain([0.0]));
        let y_axis = Axis::around(self.points.iter().map(|point| point.y).chain([self.neutral]));
        let [room_left, room_right, room_above, room_below] = ROOM;
        let (x0, x1) = (left + room_left, left + WIDTH as i32 - room_right);
        let (y0, y1) = (room_above, HEIGHT as i32 - room_below);
        let x = |value: f64| x0 + (x_axis.share(value) * f64::from(x1 - x0)).round() as i32;
        let y = |value: f64| y1 - (y_axis.share(value) * f64::from(y1 - y0)).round() as i32;
        picture.write(words(&self.title, (left + 16, 14), 24.0, INK));
        picture.write(words(&self.words, (left + 16, 44), 17.0, FAINT));
        for (value, word) in x_axis.marks() {
            picture.line([middle((x(value), y0)), middle((x(value), y1))], 1.0, RIM);
            picture.write(words(word, (x(value), y1 + 8), 17.0, FAINT).anchored(Side::Middle, Level::Top));
        }
        for (value, word) in y_axis.marks() {
            picture.line([middle((x0, y(value))), middle((x1, y(value)))], 1.0, RIM);
            picture.write(words(word, (x0 - 8, y(value) - 8), 17.0, FAINT).anchored(Side::Right, Level::Top));
        }
        let neutral = y(self.neutral);
        picture.line([corner((x0, neutral)), corner((x1, neutral))], 2.0, FAINT);
        let below = (i32::midpoint(x0, x1), y1 + 30);
        picture.write(words(&self.across, below, 18.0, INK).anchored(Side::Middle, Level::Top));
        picture.write(words(&self.up, (x0, y0 - 24), 18.0, INK));
        let dots: Vec<(i32, i32)> = self.points.iter().map(|point| (x(point.x), y(point.y))).collect();
        for dot in &dots {
            picture.disc(middle(*dot), 4.0, DOT);
        }
        let line = [x0, neutral - 2, x1, neutral + 2];
        let unnamed = self.name(picture, &dots, line, [x0, y0, x1, y1]);
        if unnamed > 0 {
            let label = format!("{unnamed} of {} names do not fit", dots.len());
            picture.write(words(label, (x1, y0 - 22), 16.0, FAINT).anchored(Side::Right, Level::Top));
        }
    }

    /// Writes each name in the first free box around its dot, clear of the line; returns the number of names left out.
    fn name(&self, picture: &mut Drawing, dots: &[(i32, i32)], line: Box4, rim: Box4) -> usize {
        let boxes = dots.iter().map(|(x, y)| [x - 5, y - 5, x + 5, y + 5]);
        let mut taken: Vec<Box4> = boxes.chain([line]).collect();
        let mut unnamed = 0;
        for (point, dot) in self.points.iter().zip(dots) {
            let size = font_size(LABEL);
            let wide = text_width(&point.label, size).ceil() as i32;
            match free_box(*dot, [wide + 2, size as i32], &taken, rim) {
                Some(candidate) => {
                    picture.write(words(&point.label, (candidate[0], candidate[1]), LABEL, INK));
                    taken.push(candidate);
                }
                None => unnamed += 1,
            }
        }
        unnamed
    }
}

/// The first box around a dot, starting at the right, that overlaps nothing and lies inside the border.
fn free_box((x, y): (i32, i32), [wide, high]: [i32; 2], taken: &[Box4], rim: Box4) -> Option<Box4> {
    let (right, left, middle) = (x + 7, x - 7 - wide, x - wide / 2);
    let (level, above, below) = (y - high / 2, y - high - 6, y + 7);
    let corners = [
        (right, level),
        (left, level),
        (middle, above),
        (middle, below),
        (right, above),
        (right, below),
        (left, above),
        (left, below),
    ];
    let boxes = corners.map(|(left, top)| [left, top, left + wide, top + high]);
    let disjoint = |a: &Box4, b: &Box4| a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
    let inside = |candidate: &Box4| {
        candidate[0] >= rim[0] && candidate[1] >= rim[1] && candidate[2] <= rim[2] && candidate[3] <= rim[3]
    };
    boxes
        .into_iter()
        .find(|candidate| inside(candidate) && taken.iter().all(|other| disjoint(candidate, other)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tick_marks_are_round_and_span_all_values() {
        for (values, words) in [
            (vec![0.0, 1.0], vec!["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]),
            (vec![0.03, 0.11], vec!["0.02", "0.04", "0.06", "0.08", "0.10", "0.12"]),
        ] {
            let axis = Axis::around(values.iter().copied());
            assert_eq!(axis.marks().map(|(_, word)| word).collect::<Vec<_>>(), words);
            assert!(values.iter().all(|value| (0.0..=1.0).contains(&axis.share(*value))));
        }
        let one = Axis::around([3.0].into_iter());
        assert!((0.0..=1.0).contains(&one.share(3.0)));
    }

    #[test]
    fn names_never_overlap() {
        let rim = [0, 0, 200, 200];
        let first = free_box((100, 100), [40, 12], &[], rim).expect("there is room on the right");
        let second = free_box((100, 100), [40, 12], &[first], rim).expect("there is room on the left");
        assert!(first[0] > 100 && second[2] < 100);
        assert_eq!(free_box((100, 100), [40, 12], &[rim], rim), None);
    }
}
