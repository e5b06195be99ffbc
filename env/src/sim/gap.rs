//! [`Gap`]: distance and direction from a point, a line segment or a convex polygon. The tests are in `footprint.rs`, which
//! widens all three.

use super::footprint::Point;

/// The gap between a footprint and a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    /// Distance in metres; below 0 inside.
    pub(super) distance: f64,
    /// Unit vector that points straight away from the footprint; inside it, along the shortest way out.
    pub(super) out: Point,
}

/// The gap between two points.
pub(super) fn gap_to_point(middle: Point, at: Point) -> Gap {
    let way = [at[0] - middle[0], at[1] - middle[1]];
    let distance = (way[0] * way[0] + way[1] * way[1]).sqrt();
    // At the exact centre, all ways out are equally short.
    let out = if distance > 0.0 {
        way.map(|part| part / distance)
    } else {
        [1.0, 0.0]
    };
    Gap { distance, out }
}

/// The gap between a line segment and a point.
pub(super) fn gap_to_line(from: Point, to: Point, at: Point) -> Gap {
    let line = [to[0] - from[0], to[1] - from[1]];
    let way = [at[0] - from[0], at[1] - from[1]];
    let squared = line[0] * line[0] + line[1] * line[1];
    let along = line[0] * way[0] + line[1] * way[1];
    if along <= 0.0 || squared == 0.0 {
        return gap_to_point(from, at);
    }
    if along >= squared {
        return gap_to_point(to, at);
    }
    let length = squared.sqrt();
    // Twice the area between the line and the point: positive on its right.
    let beyond = line[1] * way[0] - line[0] * way[1];
    let side = if beyond < 0.0 { -1.0 } else { 1.0 };
    Gap {
        distance: beyond.abs() / length,
        out: [side * line[1] / length, -side * line[0] / length],
    }
}

/// The gap between a convex polygon, with corners counter-clockwise, and a point.
pub(super) fn gap_to_polygon(corners: &[Point], at: Point) -> Gap {
    let mut inside = Gap {
        distance: f64::NEG_INFINITY,
        out: [1.0, 0.0],
    };
    let mut nearest: Option<(f64, Point)> = None;
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let edge = [to[0] - from[0], to[1] - from[1]];
        let way = [at[0] - from[0], at[1] - from[1]];
        // Twice the area between the edge and the point: positive outside.
        let beyond = edge[1] * way[0] - edge[0] * way[1];
        let squared = edge[0] * edge[0] + edge[1] * edge[1];
        if beyond <= 0.0 {
            if nearest.is_none() {
                let length = squared.sqrt();
                if beyond > inside.distance * length {
                    (inside.distance, inside.out) = (beyond / length, [edge[1] / length, -edge[0] / length]);
                }
            }
            continue;
        }
        let along = edge[0] * way[0] + edge[1] * way[1];
        if along >= 0.0 && along <= squared {
            let length = squared.sqrt();
            return Gap {
                distance: beyond / length,
                out: [edge[1] / length, -edge[0] / length],
            };
        }
        let corner = if along < 0.0 { from } else { to };
        let way = [at[0] - corner[0], at[1] - corner[1]];
        let far = way[0] * way[0] + way[1] * way[1];
        if nearest.is_none_or(|(nearest_so_far, _)| far < nearest_so_far) {
            nearest = Some((far, *corner));
        }
    }
    nearest.map_or(inside, |(_, corner)| gap_to_point(corner, at))
}
