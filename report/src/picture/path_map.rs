//! A picture of a path: the items on a map of their distances, joined in their order. Where they stand is `similarity`'s.

#![expect(
    clippy::disallowed_methods,
    reason = "ticks and arrows of a figure, rounded to what is drawn"
)]

use driftworld_similarity::{DistanceMatrix, Method, Ordering, classical_map};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{FAINT, INK, Label, Picture};
use crate::ReportError;

/// Twice the size of the picture, which is halved in the end so that slanted lines are smooth.
const SIZE: (i32, i32) = (2000, 1600);
/// Free of items at the left and right, above, and below.
const MARGINS: [i32; 3] = [220, 240, 120];
/// The size of the items' names, and their width for each letter.
const TEXT: (i32, i32) = (28, 14);
/// With more items than this only the ends are named.
const MAX_NAMED: usize = 60;

/// Draws an order of items as a path over a map of their distances, by classical scaling.
///
/// # Errors
/// [`ReportError::Drawing`].
pub fn path_map(matrix: &DistanceMatrix, method: Method, ordering: &Ordering) -> Result<Picture, ReportError> {
    let map = classical_map(matrix);
    let places = on_paper(&map.points);
    let path: Vec<(i32, i32)> = ordering.indices.iter().map(|index| places[*index]).collect();
    let mut picture = Picture::blank(SIZE.0 as u32, SIZE.1 as u32);
    let last = path.len().saturating_sub(1);
    let many = path.len() > MAX_NAMED;
    let (width, radius) = if many { (3, 7) } else { (5, 13) };
    picture.draw(|area| {
        for (step, pair) in path.windows(2).enumerate() {
            let color = along(step, last.saturating_sub(1));
            area.draw(&PathElement::new(pair.to_vec(), color.stroke_width(width)))?;
            if let Some(head) = arrow(pair[0], pair[1], 3 * width as i32 + 4) {
                area.draw(&Polygon::new(head.to_vec(), color.filled()))?;
            }
        }
        for (place, at) in path.iter().enumerate() {
            area.draw(&Circle::new(*at, radius, WHITE.filled()))?;
            area.draw(&Circle::new(*at, radius - 3, along(place, last).filled()))?;
        }
        Ok(())
    })?;
    let of_task = match common_task(matrix.labels()) {
        "" => String::new(),
        task => format!("{}, ", task.trim_end_matches('#')),
    };
    let titles = [
        format!(
            "{}{}: length {:.4}, largest step {:.4}, mean step {:.4}",
            of_task,
            method.name(),
            ordering.length,
            ordering.largest_step(),
            ordering.mean_step()
        ),
        format!(
            "From orange to blue. The map is flat: it keeps {:.0} % of the distances' eigenvalues, squared.",
            (100.0 * map.explained).floor()
        ),
    ];
    let names = names(matrix, ordering, &path, many);
    let mut labels = vec![
        label(&titles[0], (40, 36), 44, INK, HPos::Left),
        label(&titles[1], (40, 96), 30, FAINT, HPos::Left),
    ];
    labels.extend(
        names
            .iter()
            .map(|name| label(&name.text, name.at, TEXT.0 as u32, INK, name.side)),
    );
    picture.label(&labels)?;
    Ok(picture.halved())
}

/// What all labels begin with, up to the `#` behind a task's name; nothing if they are of several tasks.
fn common_task(labels: &[String]) -> &str {
    let task = |label: &str| label.rfind('#').map_or(0, |at| at + 1);
    let Some(first) = labels.first() else { return "" };
    let common = &first[..task(first)];
    if labels.iter().all(|label| label[..task(label)] == *common) {
        common
    } else {
        ""
    }
}

fn label(text: &str, at: (i32, i32), size: u32, color: RGBColor, side: HPos) -> Label<'_> {
    let anchor = Pos::new(side, VPos::Top);
    Label {
        text,
        at,
        size,
        color,
        anchor,
    }
}

/// The map's points as pixels: as large as fits, not distorted, the second axis upwards.
fn on_paper(points: &[[f64; 2]]) -> Vec<(i32, i32)> {
    let bounds = |axis: usize| {
        points
            .iter()
            .map(|point| point[axis])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
    };
    let [x, y] = [bounds(0), bounds(1)];
    let [side, top, bottom] = MARGINS;
    let (free_x, free_y) = (f64::from(SIZE.0 - 2 * side), f64::from(SIZE.1 - top - bottom));
    let scale = [(x, free_x), (y, free_y)]
        .into_iter()
        .filter(|((low, high), _)| high - low > 1e-12)
        .map(|((low, high), free)| free / (high - low))
        .fold(f64::INFINITY, f64::min);
    let scale = if scale.is_finite() { scale } else { 1.0 };
    let middle = (f64::midpoint(x.0, x.1), f64::midpoint(y.0, y.1));
    let pixel = |point: &[f64; 2]| {
        let right = f64::from(SIZE.0) / 2.0 + (point[0] - middle.0) * scale;
        let down = f64::from(top) + free_y / 2.0 - (point[1] - middle.1) * scale;
        (right.round() as i32, down.round() as i32)
    };
    points.iter().map(pixel).collect()
}

/// From orange at the first to blue at the last.
fn along(place: usize, last: usize) -> RGBColor {
    let share = if last == 0 { 0.0 } else { place as f64 / last as f64 };
    let mix = |from: f64, to: f64| (from + (to - from) * share) as u8;
    RGBColor(mix(236.0, 22.0), mix(140.0, 82.0), mix(44.0, 170.0))
}

/// A triangle in the middle of a step that points along it; none where it would be longer than the step.
fn arrow(from: (i32, i32), to: (i32, i32), size: i32) -> Option<[(i32, i32); 3]> {
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let length = dx.hypot(dy);
    if length < f64::from(3 * size) {
        return None;
    }
    let (ux, uy, size) = (dx / length, dy / length, f64::from(size));
    let middle = (f64::from(from.0) + dx / 2.0, f64::from(from.1) + dy / 2.0);
    let at = |ahead: f64, aside: f64| {
        let x = middle.0 + ux * ahead * size - uy * aside * size;
        let y = middle.1 + uy * ahead * size + ux * aside * size;
        (x.round() as i32, y.round() as i32)
    };
    Some([at(1.0, 0.0), at(-0.7, 0.8), at(-0.7, -0.8)])
}

/// A name in the picture.
struct Name {
    text: String,
    at: (i32, i32),
    side: HPos,
}

/// Each item's place in the order and its name, beside its point where they cover nothing else; all items, or the two ends.
fn names(matrix: &DistanceMatrix, ordering: &Ordering, path: &[(i32, i32)], ends_only: bool) -> Vec<Name> {
    // What is taken: left, top, right, bottom.
    let mut taken: Vec<[i32; 4]> = path.iter().map(|(x, y)| [x - 12, y - 12, x + 12, y + 12]).collect();
    taken.extend(path.windows(2).flat_map(|pair| along_step(pair[0], pair[1])));
    let last = path.len().saturating_sub(1);
    let task = common_task(matrix.labels());
    let short = |label: &str| label[task.len()..].to_owned();
    let mut names = Vec::new();
    for (place, (x, y)) in path.iter().enumerate() {
        if ends_only && place != 0 && place != last {
            continue;
        }
        let text = format!("{} {}", place + 1, short(&matrix.labels()[ordering.indices[place]]));
        let wide = TEXT.1 * text.chars().count() as i32;
        let (gap, high) = (18, TEXT.0 + 4);
        // Right, left, below and above, and then the same farther off.
        let spots = (0..6).flat_map(|ring| {
            let off = ring * high;
            [
                (x + gap, y - high / 2 - off, HPos::Left),
                (x + gap, y - high / 2 + off, HPos::Left),
                (x - gap, y - high / 2 - off, HPos::Right),
                (x - gap, y - high / 2 + off, HPos::Right),
                (*x, y + gap + off, HPos::Center),
                (*x, y - gap - high - off, HPos::Center),
            ]
        });
        let boxed = |(x, y, side): &(i32, i32, HPos)| {
            let left = match side {
                HPos::Left => *x,
                HPos::Right => x - wide,
                HPos::Center => x - wide / 2,
            };
            [left, *y, left + wide, y + high]
        };
        let covered = |spot: &(i32, i32, HPos)| -> i64 {
            let mine = boxed(spot);
            let beyond = [-mine[0], mine[2] - SIZE.0, 130 - mine[1], mine[3] - SIZE.1];
            let outside = i64::from(beyond.map(|pixels| pixels.max(0)).iter().sum::<i32>()) * 100;
            // A little overlap is better than a name far from its point.
            let off = i64::from((spot.1 - y).abs()) * 3;
            outside + off + taken.iter().map(|other| overlap(&mine, other)).sum::<i64>()
        };
        if let Some(best) = spots.min_by_key(covered) {
            taken.push(boxed(&best));
            names.push(Name {
                text,
                at: (best.0, best.1),
                side: best.2,
            });
        }
    }
    names
}

/// Small squares along a step, which names had better not cover.
fn along_step(from: (i32, i32), to: (i32, i32)) -> impl Iterator<Item = [i32; 4]> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let parts = (dx.abs().max(dy.abs()) / 24).max(1);
    (0..=parts).map(move |part| {
        let (x, y) = (from.0 + dx * part / parts, from.1 + dy * part / parts);
        [x - 5, y - 5, x + 5, y + 5]
    })
}

/// How many pixels two rectangles share.
fn overlap(a: &[i32; 4], b: &[i32; 4]) -> i64 {
    let wide = a[2].min(b[2]) - a[0].max(b[0]);
    let high = a[3].min(b[3]) - a[1].max(b[1]);
    i64::from(wide.max(0)) * i64::from(high.max(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_fills_the_paper_and_stands_upright() {
        let [side, top, bottom] = MARGINS;
        let at = on_paper(&[[0.0, 0.0], [4.0, 0.0], [2.0, 1.0]]);
        assert_eq!((at[0].0, at[1].0), (side, SIZE.0 - side));
        assert!(at[2].1 < at[0].1 && at[2].1 >= top && at[0].1 <= SIZE.1 - bottom);
        assert_eq!(on_paper(&[[0.0, 0.0]; 2])[0].0, SIZE.0 / 2);
    }

    #[test]
    fn rectangles_share_what_lies_in_both() {
        assert_eq!(overlap(&[0, 0, 10, 10], &[5, 8, 20, 20]), 10);
        assert_eq!(overlap(&[0, 0, 10, 10], &[10, 0, 20, 10]), 0);
    }
}
