//! The scale of a map: converts metres to pixels, and draws a labelled bar and a north arrow in the corners where they cover
//! least.

#![expect(clippy::disallowed_methods, reason = "only positions of lines and labels on a map")]

use driftworld_env::{Scene, top_down_scale};
use driftworld_report::picture::{Drawing, Level, Rgb, Side, TextLine, text_width};

const INK: Rgb = [20, 24, 30];
const WHITE: Rgb = [255, 255, 255];

/// Converts positions in metres to pixels of a map.
pub(crate) struct MapProjection {
    pub(crate) size: [f32; 2],
    pub(crate) scale: f32,
}

impl MapProjection {
    pub(crate) fn of(scene: &Scene, [width, height]: [u32; 2]) -> Self {
        Self {
            size: [width as f32, height as f32],
            scale: top_down_scale(scene, width, height),
        }
    }

    pub(crate) fn pixel(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [width, height] = self.size;
        [width / 2.0 + x * self.scale, height / 2.0 - y * self.scale]
    }

    pub(crate) fn pixels(&self, metres: &[[f32; 2]]) -> Vec<[f32; 2]> {
        metres.iter().map(|point| self.pixel(*point)).collect()
    }
}

/// Corners of a map as (right, bottom): the scale bar prefers the first, north the last.
pub(crate) const CORNERS: [[bool; 2]; 4] = [[false, true], [true, true], [false, false], [true, false]];

/// Removes from the list the corner where a box of this size covers the least weight of marks, and returns the box's top left
/// pixel there.
pub(crate) fn freest(
    corners: &mut Vec<[bool; 2]>,
    size: [f32; 2],
    map: [f32; 2],
    marks: &[([f32; 2], f32)],
) -> [f32; 2] {
    let edge = (map[1] / 40.0).round();
    let near = map[1] / 20.0;
    let top_left = |corner: [bool; 2]| {
        [0, 1].map(|axis| {
            if corner[axis] {
                map[axis] - edge - size[axis]
            } else {
                edge
            }
        })
    };
    let cost = |corner: [bool; 2]| -> f32 {
        let at = top_left(corner);
        let covers = |mark: [f32; 2]| {
            [0, 1]
                .into_iter()
                .all(|axis| (at[axis] - near..at[axis] + size[axis] + near).contains(&mark[axis]))
        };
        marks
            .iter()
            .filter(|(mark, _)| covers(*mark))
            .map(|(_, weight)| weight)
            .sum()
    };
    let mut best = 0;
    for number in 1..corners.len() {
        if cost(corners[number]) < cost(corners[best]) {
            best = number;
        }
    }
    top_left(corners.remove(best))
}

/// The length of a bar in metres: a round number, at most `max`.
fn bar_metres(max: f32) -> f32 {
    let power = 10_f32.powf(max.log10().floor());
    let steps = [5.0, 2.0, 1.0].into_iter().map(|step| step * power);
    steps.into_iter().find(|step| *step <= max).unwrap_or(power)
}

/// A scale bar with its label.
pub(crate) struct Bar {
    label: String,
    length: f32,
    font_size: f32,
    height: f32,
}

impl Bar {
    /// The bar of a map, at most this long in pixels.
    pub(crate) fn of(projection: &MapProjection, max: f32) -> Self {
        let metres = bar_metres(max / projection.scale);
        let size = projection.size[1];
        Self {
            label: format!("{metres} m"),
            length: metres * projection.scale,
            font_size: (size / 22.0).clamp(9.0, 20.0),
            height: (size / 100.0).clamp(2.0, 8.0).round(),
        }
    }

    /// The bar's size in pixels, with label and rim.
    pub(crate) fn size(&self) -> [f32; 2] {
        let wide = self.length.max(text_width(&self.label, self.font_size)) + 8.0;
        [wide, (self.font_size * 1.1 + self.height + 7.0).ceil()]
    }

    /// Draws the bar with its top left corner at this position; on a map, with a light background.
    pub(crate) fn draw(&self, on: &mut Drawing, [left, top]: [f32; 2], on_a_map: bool) {
        let [wide, high] = self.size();
        if on_a_map {
            let (right, bottom) = (left + wide, top + high);
            on.tint(
                [[left, top], [right, top], [right, bottom], [left, bottom]],
                WHITE,
                0.75,
            );
        }
        on.write(TextLine::new(&self.label, [left + 4.0, top + 3.0], self.font_size, INK));
        let bar = [left + 4.0, top + high - self.height - 3.0, self.length, self.height];
        on.rectangle(bar, [0, 0, 0]);
    }
}

/// Side in pixels of the north arrow on a map of this height.
pub(crate) fn north_size(size: f32) -> f32 {
    (1.72 * (size / 14.0).clamp(12.0, 44.0)).round()
}

/// A north arrow in a disc whose bounding square has this top left corner and side.
pub(crate) fn north(map: &mut Drawing, [left, top]: [f32; 2], side: f32) {
    let high = side / 1.72;
    let x = left + side / 2.0;
    map.tint_disc([x, top + side / 2.0], side / 2.0, WHITE, 0.75);
    let top = top + 0.14 * high;
    let half = high * 0.26;
    map.area(
        [
            [x, top],
            [x + half, top + 0.72 * high],
            [x, top + 0.55 * high],
            [x - half, top + 0.72 * high],
        ],
        INK,
    );
    let words = TextLine::new("N", [x, top + 0.8 * high], high * 0.62, INK);
    map.write(words.anchored(Side::Middle, Level::Top));
}
