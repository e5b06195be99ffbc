//! Helpers for points and polygons on the ground: conversion to `f32`, distances, and point tests.

use std::ops::{Add, Div, Mul, Sub};

/// Converts corners to `f32`, the simulator's precision.
pub(crate) fn to_f32(corners: &[[f64; 2]]) -> Vec<[f32; 2]> {
    let corners = corners.iter();
    corners.map(|corner| corner.map(|metres| metres as f32)).collect()
}

/// The distance between two points.
pub(crate) fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    (dx * dx + dy * dy).sqrt()
}

/// Whether a point is inside a polygon, by the even-odd rule, or within `margin` metres of one of its edges.
pub(crate) fn is_near_or_inside<F>(corners: impl Iterator<Item = [F; 2]> + Clone, [x, y]: [F; 2], margin: F) -> bool
where
    F: Copy + PartialOrd + From<u8> + Add<Output = F> + Sub<Output = F> + Mul<Output = F> + Div<Output = F>,
{
    let (zero, one) = (F::from(0), F::from(1));
    let mut inside = false;
    for ([ax, ay], [bx, by]) in corners.clone().zip(corners.cycle().skip(1)) {
        let (dx, dy) = (bx - ax, by - ay);
        let squared = dx * dx + dy * dy;
        let along = if squared > zero {
            ((x - ax) * dx + (y - ay) * dy) / squared
        } else {
            zero
        };
        // Clamps the projection to the edge's ends.
        let along = if along < zero {
            zero
        } else if along > one {
            one
        } else {
            along
        };
        let (ex, ey) = (x - ax - along * dx, y - ay - along * dy);
        if ex * ex + ey * ey < margin * margin {
            return true;
        }
        if (ay > y) != (by > y) && x < dx * (y - ay) / dy + ax {
            inside = !inside;
        }
    }
    inside
}
