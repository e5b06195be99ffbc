//! Rasterises polygons, lines and circles, antialiased by the share of each pixel that they cover.

#![expect(clippy::disallowed_methods, reason = "the results are rounded to pixels")]

use super::{Picture, Rgb};

/// Number of sample lines per row of pixels; coverage along a line is exact.
const LINES: usize = 8;

/// Maximum number of dashes in a line.
const MAX_DASHES: usize = 20_000;

/// Fills an upright rectangle: left, top, right, bottom.
fn rectangle(picture: &mut Picture, [left, top, right, bottom]: [f32; 4], color: Rgb, alpha: f32) {
    let share = |from: f32, to: f32, at: usize| (to.min(at as f32 + 1.0) - from.max(at as f32)).clamp(0.0, 1.0);
    let range = |from: f32, to: f32, most: u32| {
        let last = (to.ceil().max(0.0) as usize).min(most as usize);
        (from.max(0.0) as usize).min(last)..last
    };
    let columns: Vec<(usize, f32)> = range(left, right, picture.width)
        .map(|x| (x, share(left, right, x)))
        .collect();
    for y in range(top, bottom, picture.height) {
        let own = share(top, bottom, y) * alpha;
        for (x, share) in &columns {
            picture.blend(*x, y, color, share * own);
        }
    }
}

/// The left, top, right and bottom of an upright rectangle, if these are its corners.
fn as_rectangle(points: &[[f32; 2]]) -> Option<[f32; 4]> {
    let [a, b, c, d] = points else { return None };
    let upright = |a: &[f32; 2], b: &[f32; 2], c: &[f32; 2], d: &[f32; 2]| {
        a[1] == b[1] && b[0] == c[0] && c[1] == d[1] && d[0] == a[0]
    };
    let finite = points.iter().flatten().all(|place| place.is_finite());
    (finite && (upright(a, b, c, d) || upright(b, c, d, a)))
        .then(|| [a[0].min(c[0]), a[1].min(c[1]), a[0].max(c[0]), a[1].max(c[1])])
}

/// Fills the union of the polygons: overlaps are not darker.
pub(super) fn fill(picture: &mut Picture, polygons: &[Vec<[f32; 2]>], color: Rgb, alpha: f32) {
    if let [polygon] = polygons
        && let Some(bounds) = as_rectangle(polygon)
    {
        return rectangle(picture, bounds, color, alpha);
    }
    let corners = || polygons.iter().flatten();
    let (low, high) = corners().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), point| {
        (low.min(point[1]), high.max(point[1]))
    });
    if low >= high || !low.is_finite() || !high.is_finite() {
        return;
    }
    let top = low.max(0.0) as usize;
    let bottom = (high.ceil().max(0.0) as usize).min(picture.height as usize);
    if top >= bottom {
        return;
    }
    // The crossings of each sample line with the edges, with the direction of each edge.
    let mut crossings: Vec<Vec<(f32, i32)>> = vec![Vec::new(); (bottom - top) * LINES];
    let height = |line: usize| top as f32 + (line as f32 + 0.5) / LINES as f32;
    for polygon in polygons {
        let twice_area: f32 = edges(polygon).map(|[a, b]| a[0] * b[1] - b[0] * a[1]).sum();
        let winding = if twice_area < 0.0 { -1 } else { 1 };
        for [a, b] in edges(polygon) {
            let (upper, lower, down) = if a[1] < b[1] { (a, b, winding) } else { (b, a, -winding) };
            let first = ((upper[1] - top as f32) * LINES as f32 - 0.5).ceil().max(0.0) as usize;
            let slope = (lower[0] - upper[0]) / (lower[1] - upper[1]);
            for (line, line_crossings) in crossings.iter_mut().enumerate().skip(first) {
                let y = height(line);
                if y >= lower[1] {
                    break;
                }
                line_crossings.push((upper[0] + (y - upper[1]) * slope, down));
            }
        }
    }
    let (left, right) = corners().fold((f32::INFINITY, f32::NEG_INFINITY), |(left, right), point| {
        (left.min(point[0]), right.max(point[0]))
    });
    // The columns touched, which are few for most shapes.
    let first = (left.max(0.0) as usize).min(picture.width as usize);
    let last = (right.ceil().max(0.0) as usize).min(picture.width as usize);
    let mut covered = vec![0.0_f32; last.saturating_sub(first)];
    for row in top..bottom {
        covered.fill(0.0);
        for line_crossings in &mut crossings[(row - top) * LINES..][..LINES] {
            line_crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (mut depth, mut from) = (0, 0.0);
            for (x, winding) in line_crossings {
                let before = depth;
                depth += *winding;
                if before == 0 {
                    from = *x;
                } else if depth == 0 {
                    add_span(&mut covered, from - first as f32, *x - first as f32);
                }
            }
        }
        for (x, share) in covered.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            picture.blend(first + x, row, color, (share / LINES as f32).min(1.0) * alpha);
        }
    }
}

fn edges(polygon: &[[f32; 2]]) -> impl Iterator<Item = [[f32; 2]; 2]> + '_ {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Adds to each pixel of a row its share of a span.
fn add_span(covered: &mut [f32], from: f32, to: f32) {
    let most = covered.len() as f32;
    let (from, to) = (from.clamp(0.0, most), to.clamp(0.0, most));
    let last = (to.ceil() as usize).min(covered.len());
    for (x, share) in covered.iter_mut().enumerate().take(last).skip(from as usize) {
        *share += (to.min(x as f32 + 1.0) - from.max(x as f32)).max(0.0);
    }
}

/// Points along a circle, enough of them that no corner is visible.
pub(super) fn circle([x, y]: [f32; 2], radius: f32) -> Vec<[f32; 2]> {
    let count = (8.0 + radius.max(0.0).sqrt() * 8.0).min(256.0) as usize;
    let corner = |k: usize| {
        let angle = std::f32::consts::TAU * k as f32 / count as f32;
        [x + radius * angle.cos(), y + radius * angle.sin()]
    };
    (0..count).map(corner).collect()
}

/// A line of this width as polygons, with round joins if it is thick enough to show them.
pub(super) fn stroke(points: &[[f32; 2]], width: f32) -> Vec<Vec<[f32; 2]>> {
    let half = width / 2.0;
    let mut pieces = Vec::new();
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if length <= 0.0 || !length.is_finite() {
            continue;
        }
        let (nx, ny) = (-dy / length * half, dx / length * half);
        pieces.push(vec![
            [a[0] + nx, a[1] + ny],
            [b[0] + nx, b[1] + ny],
            [b[0] - nx, b[1] - ny],
            [a[0] - nx, a[1] - ny],
        ]);
    }
    if width >= 1.5 {
        let inner = points.get(1..points.len().saturating_sub(1)).unwrap_or_default();
        pieces.extend(inner.iter().map(|corner| circle(*corner, half)));
    }
    pieces
}

/// A line cut into dashes of this length with equal gaps.
pub(super) fn dashes(points: &[[f32; 2]], dash: Option<f32>) -> Vec<Vec<[f32; 2]>> {
    let Some(dash) = dash.filter(|dash| *dash > 0.0) else {
        return vec![points.to_vec()];
    };
    let mut pieces = Vec::new();
    let (mut is_dash, mut left) = (true, dash);
    let mut piece: Vec<[f32; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [mut a, b] = [pair[0], pair[1]];
        loop {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length <= left || pieces.len() >= MAX_DASHES || !length.is_finite() {
                left -= length;
                piece.push(b);
                break;
            }
            let share = left / length;
            a = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
            piece.push(a);
            let whole = std::mem::replace(&mut piece, vec![a]);
            if is_dash {
                pieces.push(whole);
            }
            (is_dash, left) = (!is_dash, dash);
        }
    }
    if is_dash {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The total ink, in pixels.
    fn ink(picture: &Picture) -> f32 {
        let pixels = picture.rgb.chunks_exact(3);
        pixels.map(|rgb| f32::from(255 - rgb[0]) / 255.0).sum()
    }

    fn ink_of(polygons: &[Vec<[f32; 2]>]) -> f32 {
        let mut picture = Picture::blank(60, 50);
        fill(&mut picture, polygons, [0, 0, 0], 1.0);
        ink(&picture)
    }

    #[test]
    fn total_ink_equals_the_shapes_area() {
        for (polygon, area) in [
            (vec![[3.25, 4.5], [13.75, 4.5], [13.75, 9.0], [3.25, 9.0]], 10.5 * 4.5),
            (vec![[5.0, 5.0], [45.0, 5.0], [5.0, 35.0]], 600.0),
            (circle([30.0, 25.0], 12.0), std::f32::consts::PI * 144.0),
        ] {
            let found = ink_of(&[polygon]);
            assert!((found - area).abs() < 0.015 * area, "{found} for {area}");
        }
        let line = stroke(&[[5.0, 5.0], [45.0, 35.0]], 3.0);
        assert!((ink_of(&line) - 150.0).abs() < 2.0);
    }

    #[test]
    fn overlaps_are_filled_once_and_outside_is_clipped() {
        let square = |x: f32| vec![[x, 10.0], [x + 10.0, 10.0], [x + 10.0, 20.0], [x, 20.0]];
        let turned: Vec<[f32; 2]> = square(15.0).into_iter().rev().collect();
        assert!((ink_of(&[square(10.0), turned]) - 150.0).abs() < 0.5);
        assert!((ink_of(&[square(-5.0)]) - 50.0).abs() < 0.5);
        assert!(ink_of(&[square(-50.0), square(1e9), vec![[f32::NAN, 0.0]; 3]]) < 1e-6);
    }

    #[test]
    fn half_of_a_dashed_line_is_drawn() {
        let cut = dashes(&[[0.0, 0.0], [30.0, 0.0], [30.0, 30.0]], Some(5.0));
        assert_eq!(cut.len(), 6);
        let length = |piece: &Vec<[f32; 2]>| -> f32 {
            piece
                .windows(2)
                .map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]))
                .sum()
        };
        assert!((cut.iter().map(length).sum::<f32>() - 30.0).abs() < 1e-3);
    }
}
