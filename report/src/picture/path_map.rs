//! The image of a path: the items on a map of their distances, joined in order.

#![expect(
    clippy::disallowed_methods,
    reason = "ticks and arrows of a figure, rounded to pixels"
)]

use driftworld_similarity::{DistanceMatrix, Method, Ordering, classical_map};

use super::{Drawing, FAINT, INK, Level, Rgb, Side, TextLine, WHITE, text_width};
use crate::extent;

/// Twice the size of the image, so that positions are rounded to half a pixel.
const SIZE: (i32, i32) = (2000, 1600);
/// Margins without items: left and right, top, and bottom.
const MARGINS: [i32; 3] = [220, 240, 120];
/// Font size of the items' names, in pixels of the image.
const TEXT_SIZE: f32 = 13.0;
/// Height of the titles at the top, which names keep clear of, in pixels of the image.
const TITLE_HEIGHT: f32 = 66.0;
/// With more items, only the ends are named.
const MAX_NAMED: usize = 60;

/// Draws an order of items as a path on a map of their distances, made by classical scaling.
pub fn path_map(matrix: &DistanceMatrix, method: Method, ordering: &Ordering) -> Drawing {
    let map = classical_map(matrix);
    let positions = on_paper(&map.points);
    let path: Vec<(i32, i32)> = ordering.indices.iter().map(|index| positions[*index]).collect();
    let mut picture = Drawing::blank(SIZE.0 as u32 / 2, SIZE.1 as u32 / 2);
    let last = path.len().saturating_sub(1);
    let many = path.len() > MAX_NAMED;
    let (width, radius) = if many { (3, 7) } else { (5, 13) };
    for (step, pair) in path.windows(2).enumerate() {
        let color = color_at(step, last.saturating_sub(1));
        picture.line([middle(pair[0]), middle(pair[1])], width as f32 / 2.0, color);
        if let Some(head) = arrow(pair[0], pair[1], 3 * width + 4) {
            picture.area(head.map(halved), color);
        }
    }
    for (index, at) in path.iter().enumerate() {
        picture.disc(middle(*at), radius as f32 / 2.0, WHITE);
        picture.disc(middle(*at), (radius - 3) as f32 / 2.0, color_at(index, last));
    }
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
            "From orange (first) to blue (last). The map is flat: it shows {:.0} % of the variation of the distances.",
            (100.0 * map.explained).floor()
        ),
    ];
    picture.write(TextLine::new(&titles[0], [20.0, 18.0], 19.0, INK));
    picture.write(TextLine::new(&titles[1], [20.0, 47.0], 13.0, FAINT));
    let path: Vec<[f32; 2]> = path.into_iter().map(halved).collect();
    for name in names(matrix, ordering, &path, many) {
        if let Some(leader) = name.leader {
            picture.line(leader, 1.0, FAINT);
        }
        let [left, top, _, bottom] = name.bounds;
        let words = TextLine::new(name.text, [left + 2.0, f32::midpoint(top, bottom)], TEXT_SIZE, INK);
        picture.write(words.anchored(Side::Left, Level::Middle));
    }
    picture
}

/// The centre of a pixel at double size, in pixels of the image.
fn middle((x, y): (i32, i32)) -> [f32; 2] {
    [x, y].map(|pixel| (pixel as f32 + 0.5) * 0.5)
}

/// A position at double size, in pixels of the image.
fn halved((x, y): (i32, i32)) -> [f32; 2] {
    [x as f32 / 2.0, y as f32 / 2.0]
}

/// The common prefix of all labels, up to the `#` after the task's name; empty for several tasks.
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

/// Converts the map's points to pixels: as large as possible, undistorted, with the second axis upwards.
fn on_paper(points: &[[f64; 2]]) -> Vec<(i32, i32)> {
    let bounds = |axis: usize| extent(points.iter().map(|point| point[axis]));
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

/// Interpolates from orange at the first item to blue at the last.
fn color_at(index: usize, last: usize) -> Rgb {
    let share = if last == 0 { 0.0 } else { index as f64 / last as f64 };
    let mix = |from: f64, to: f64| (from + (to - from) * share) as u8;
    [mix(236.0, 22.0), mix(140.0, 82.0), mix(44.0, 170.0)]
}

/// A triangle in the middle of a step, pointing along it; `None` if the step is too short for it.
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

/// A name in the image, with its box (left, top, right, bottom), and the line to its point if that is far away.
struct Name {
    text: String,
    bounds: [f32; 4],
    leader: Option<[[f32; 2]; 2]>,
}

/// Places the labels of all items, or only of the two ends. A label (the item's position in the order, and its name) goes beside
/// its point if it covers nothing there, otherwise farther away, with a line to the point.
fn names(matrix: &DistanceMatrix, ordering: &Ordering, path: &[[f32; 2]], ends_only: bool) -> Vec<Name> {
    let last = path.len().saturating_sub(1);
    let task = common_task(matrix.labels());
    let dots: Vec<[f32; 4]> = path.iter().map(|[x, y]| [x - 6.0, y - 6.0, x + 6.0, y + 6.0]).collect();
    let steps: Vec<[f32; 4]> = path
        .windows(2)
        .flat_map(|pair| along_line(pair[0], pair[1], 2.0))
        .collect();
    let mut names: Vec<Name> = Vec::new();
    for (index, point) in path.iter().enumerate() {
        if ends_only && index != 0 && index != last {
            continue;
        }
        let label = &matrix.labels()[ordering.indices[index]];
        let text = format!("{} {}", index + 1, &label[task.len()..]);
        let size = [text_width(&text, TEXT_SIZE) + 4.0, TEXT_SIZE * 1.25];
        let cost = |name: &Name| {
            let [left, top, right, bottom] = name.bounds;
            let paper = [
                left,
                top - TITLE_HEIGHT,
                SIZE.0 as f32 / 2.0 - right,
                SIZE.1 as f32 / 2.0 - bottom,
            ];
            let outside: f32 = paper.map(|room| (-room).max(0.0)).iter().sum();
            let line: Vec<[f32; 4]> = name.leader.iter().flat_map(|[a, b]| along_line(*a, *b, 1.0)).collect();
            let covered = |others: &[[f32; 4]]| others.iter().map(|other| overlap(&name.bounds, other)).sum::<f32>();
            let crossed: f32 = names
                .iter()
                .map(|other| {
                    let line_overlap = line.iter().map(|square| overlap(square, &other.bounds)).sum::<f32>();
                    let other_line = other.leader.iter().flat_map(|[a, b]| along_line(*a, *b, 1.0));
                    overlap(&name.bounds, &other.bounds)
                        + line_overlap
                        + other_line.map(|square| overlap(&name.bounds, &square)).sum::<f32>()
                })
                .sum();
            let leader_cost = name
                .leader
                .map_or(0.0, |[a, b]| 40.0 + (b[0] - a[0]).hypot(b[1] - a[1]));
            1000.0 * (outside + crossed) + 20.0 * covered(&dots) + covered(&steps) + leader_cost
        };
        let candidate_boxes = candidate_boxes(*point, size).map(|(bounds, leader)| Name {
            text: text.clone(),
            bounds,
            leader,
        });
        let candidates = candidate_boxes.map(|name| (cost(&name), name));
        if let Some((_, best)) = candidates.min_by(|a, b| a.0.total_cmp(&b.0)) {
            names.push(best);
        }
    }
    names
}

/// Candidate positions for a name of this size, in rings around its point; those in the outer rings have a line to the point.
fn candidate_boxes(
    [x, y]: [f32; 2],
    [wide, high]: [f32; 2],
) -> impl Iterator<Item = ([f32; 4], Option<[[f32; 2]; 2]>)> {
    const DIRECTIONS: u16 = 24;
    let ring = move |number: u16| {
        let off = 10.0 + 9.0 * f32::from(number);
        (0..DIRECTIONS).map(move |direction| {
            let angle = std::f32::consts::TAU * f32::from(direction) / f32::from(DIRECTIONS);
            let (dx, dy) = (angle.cos(), angle.sin());
            // The box touches the ring with the side or corner nearest to the point.
            let (near_x, near_y) = (x + dx * off, y + dy * off);
            let left = near_x - wide * (0.5 - 0.5 * (2.0 * dx).clamp(-1.0, 1.0));
            let top = near_y - high * (0.5 - 0.5 * dy);
            let leader = (number > 1).then(|| {
                let end = [x.clamp(left, left + wide), y.clamp(top, top + high)];
                [[x + dx * 7.0, y + dy * 7.0], end]
            });
            ([left, top, left + wide, top + high], leader)
        })
    };
    (0..24).flat_map(ring)
}

/// Small squares along a line, which names should not cover.
fn along_line(from: [f32; 2], to: [f32; 2], half: f32) -> impl Iterator<Item = [f32; 4]> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let parts = ((dx.abs().max(dy.abs()) / 6.0) as u16).max(1);
    (0..=parts).map(move |part| {
        let share = f32::from(part) / f32::from(parts);
        let (x, y) = (from[0] + dx * share, from[1] + dy * share);
        [x - half, y - half, x + half, y + half]
    })
}

/// The area shared by two rectangles, in pixels.
fn overlap(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let wide = a[2].min(b[2]) - a[0].max(b[0]);
    let high = a[3].min(b[3]) - a[1].max(b[1]);
    wide.max(0.0) * high.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn map_fills_the_paper_upright() {
        let [side, top, bottom] = MARGINS;
        let at = on_paper(&[[0.0, 0.0], [4.0, 0.0], [2.0, 1.0]]);
        assert_eq!((at[0].0, at[1].0), (side, SIZE.0 - side));
        assert!(at[2].1 < at[0].1 && at[2].1 >= top && at[0].1 <= SIZE.1 - bottom);
        assert_eq!(on_paper(&[[0.0, 0.0]; 2])[0].0, SIZE.0 / 2);
    }

    #[test]
    fn overlap_is_the_shared_area() {
        let shared = |b: [f32; 4]| overlap(&[0.0, 0.0, 10.0, 10.0], &b);
        assert!((shared([5.0, 8.0, 20.0, 20.0]) - 10.0).abs() < 1e-6);
        assert!(shared([10.0, 0.0, 20.0, 10.0]) < 1e-6);
    }

    /// Twenty items, most of them at one point: no name covers another, and all are inside the image.
    #[test]
    fn names_of_a_crowd_do_not_overlap() {
        let labels: Vec<String> = (0..20).map(|index| format!("task#a_variant_{index}")).collect();
        let distance = |a: usize, b: usize| {
            if a == b {
                0.0
            } else if a.max(b) > 17 {
                1.0
            } else {
                0.01
            }
        };
        let matrix = DistanceMatrix::measure(labels, |a, b| {
            Ok::<_, driftworld_similarity::SimilarityError>(distance(a, b))
        })
        .expect("the distances are valid");

        let ordering = driftworld_similarity::order(
            &matrix,
            Method::Nearest,
            &driftworld_similarity::OrderOptions::default(),
        )
        .expect("the items can be ordered");
        let positions = on_paper(&classical_map(&matrix).points);
        let path: Vec<[f32; 2]> = ordering.indices.iter().map(|index| halved(positions[*index])).collect();
        let names = names(&matrix, &ordering, &path, false);
        assert_eq!(names.len(), 20);
        for (index, name) in names.iter().enumerate() {
            let [left, top, right, bottom] = name.bounds;
            assert!(
                left >= 0.0 && top >= 0.0 && right <= 1000.0 && bottom <= 800.0,
                "{}",
                name.text
            );
            for other in &names[..index] {
                assert!(
                    overlap(&name.bounds, &other.bounds) < 1e-3,
                    "{} and {}",
                    name.text,
                    other.text
                );
            }
        }
    }
}
