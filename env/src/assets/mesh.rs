//! Triangle meshes and the kit of shapes that assets are made of. Which asset is made of what is in the family files.

use std::f32::consts::TAU;

use crate::vector::{cross, dot, sub};

/// A triangle mesh: corners in metres, triangles counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corners in metres; x east, y north, z up.
    pub corners: Vec<[f32; 3]>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A box with its lowest face on z = `z`, centred on the z axis. `size` is width (x), depth (y), height (z).
    pub fn cuboid(size: [f32; 3], z: f32) -> Self {
        let [w, d, h] = [size[0] / 2.0, size[1] / 2.0, size[2]];
        Self::prism(&[[-w, -d], [w, -d], [w, d], [-w, d]], z, z + h)
    }

    /// A polygon (counter-clockwise, convex) stood up from `low` to `high`.
    pub fn prism(polygon: &[[f32; 2]], low: f32, high: f32) -> Self {
        let n = polygon.len() as u32;
        let mut mesh = Self::default();
        for &[x, y] in polygon {
            mesh.corners.extend([[x, y, low], [x, y, high]]);
        }
        for k in 0..n {
            let (a, b) = (2 * k, 2 * ((k + 1) % n));
            mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
        for k in 1..n.saturating_sub(1) {
            mesh.triangles
                .extend([[1, 2 * k + 1, 2 * k + 3], [0, 2 * k + 2, 2 * k]]);
        }
        mesh
    }

    /// A profile of (radius, height) pairs from bottom to top, turned about the z axis in `segments` steps.
    ///
    /// A radius of 0 closes the shape in a point; ends of other radius are capped.
    pub fn lathe(profile: &[[f32; 2]], segments: u32) -> Self {
        let mut mesh = Self::default();
        let mut rings = Vec::new();
        for &[radius, z] in profile {
            let first = mesh.corners.len() as u32;
            let count = if radius > 0.0 { segments } else { 1 };
            for k in 0..count {
                let angle = TAU * k as f32 / segments as f32;
                mesh.corners
                    .push([radius * libm::cosf(angle), radius * libm::sinf(angle), z]);
            }
            rings.push((first, count));
        }
        mesh.join(&rings, segments);
        mesh
    }

    /// A tube through places, there as wide as twice the first half and as high as twice the second; its ends are capped, or
    /// closed in a point where both are 0. Width is measured along x, and height across the tube; a tube along x has it along y.
    /// With few segments it is as large in section as with many, so that a coarser tube can stand for a finer one.
    pub fn tube(path: &[([f32; 3], [f32; 2])], segments: u32) -> Self {
        let mut mesh = Self::default();
        let mut rings = Vec::new();
        let (Some((first, _)), Some((last, _))) = (path.first(), path.last()) else {
            return mesh;
        };
        let whole = unit(sub(*last, *first));
        let side = if whole[0].abs() > 0.9 {
            [0.0, 1.0, 0.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let step = TAU / segments as f32;
        let wider = (step / libm::sinf(step)).sqrt();
        for (k, (place, half)) in path.iter().enumerate() {
            let (before, after) = (path[k.saturating_sub(1)].0, path[(k + 1).min(path.len() - 1)].0);
            let ahead = unit(sub(after, before));
            let along = dot(side, ahead);
            let across = unit([0, 1, 2].map(|axis| side[axis] - along * ahead[axis]));
            let over = cross(ahead, across);
            let number = mesh.corners.len() as u32;
            let count = if *half == [0.0; 2] { 1 } else { segments };
            for corner in 0..count {
                // Half a segment on, so that four segments are a box.
                let angle = step * (corner as f32 + 0.5);
                let (a, b) = (wider * half[0] * libm::cosf(angle), wider * half[1] * libm::sinf(angle));
                mesh.corners
                    .push([0, 1, 2].map(|axis| place[axis] + a * across[axis] + b * over[axis]));
            }
            rings.push((number, count));
        }
        mesh.join(&rings, segments);
        mesh
    }

    /// Bands between neighbouring rings, and a cap on either end that is no point.
    fn join(&mut self, rings: &[(u32, u32)], segments: u32) {
        for pair in rings.windows(2) {
            self.band(pair[0], pair[1], segments);
        }
        if let (Some(&(bottom, low)), Some(&(top, high))) = (rings.first(), rings.last()) {
            for k in 1..low.saturating_sub(1) {
                self.triangles.push([bottom, bottom + k + 1, bottom + k]);
            }
            for k in 1..high.saturating_sub(1) {
                self.triangles.push([top, top + k, top + k + 1]);
            }
        }
    }

    fn band(&mut self, (low, low_count): (u32, u32), (high, high_count): (u32, u32), segments: u32) {
        for k in 0..segments {
            let next = (k + 1) % segments;
            let at = |first: u32, count: u32, k: u32| first + if count == 1 { 0 } else { k };
            let (a, b) = (at(low, low_count, k), at(low, low_count, next));
            let (c, d) = (at(high, high_count, k), at(high, high_count, next));
            if a != b {
                self.triangles.push([a, b, d]);
            }
            if c != d {
                self.triangles.push([a, d, c]);
            }
        }
    }

    /// A cylinder from `low` to `high`.
    pub fn cylinder(radius: f32, low: f32, high: f32, segments: u32) -> Self {
        Self::lathe(&[[radius, low], [radius, high]], segments)
    }

    /// A cone with its point up.
    pub fn cone(radius: f32, low: f32, high: f32, segments: u32) -> Self {
        Self::lathe(&[[radius, low], [0.0, high]], segments)
    }

    /// A ball of `rings` bands around a centre on the z axis.
    pub fn ball(radius: f32, centre: f32, segments: u32, rings: u32) -> Self {
        let profile: Vec<[f32; 2]> = (0..=rings)
            .map(|k| {
                let angle = TAU / 2.0 * k as f32 / rings as f32;
                let reach = if k == 0 || k == rings {
                    0.0
                } else {
                    radius * libm::sinf(angle)
                };
                [reach, centre - radius * libm::cosf(angle)]
            })
            .collect();
        Self::lathe(&profile, segments)
    }

    /// The mesh moved.
    #[must_use]
    pub fn moved(mut self, by: [f32; 3]) -> Self {
        self.corners
            .iter_mut()
            .for_each(|corner| (0..3).for_each(|axis| corner[axis] += by[axis]));
        self
    }

    /// The mesh stretched along each axis; factors are above 0.
    #[must_use]
    pub fn stretched(mut self, by: [f32; 3]) -> Self {
        self.corners
            .iter_mut()
            .for_each(|corner| (0..3).for_each(|axis| corner[axis] *= by[axis]));
        self
    }

    /// The mesh turned about the z axis, counter-clockwise seen from above.
    #[must_use]
    pub fn turned(mut self, degrees: f32) -> Self {
        let (sin, cos) = (libm::sinf(degrees.to_radians()), libm::cosf(degrees.to_radians()));
        for corner in &mut self.corners {
            let [x, y, _] = *corner;
            (corner[0], corner[1]) = (x * cos - y * sin, x * sin + y * cos);
        }
        self
    }

    /// The mesh tilted about the x axis: what points up leans towards −y.
    #[must_use]
    pub fn tilted(mut self, degrees: f32) -> Self {
        let (sin, cos) = (libm::sinf(degrees.to_radians()), libm::cosf(degrees.to_radians()));
        for corner in &mut self.corners {
            let [_, y, z] = *corner;
            (corner[1], corner[2]) = (y * cos - z * sin, y * sin + z * cos);
        }
        self
    }

    /// The mesh with every corner moved in or out by up to `share`, by chance that depends on `seed` alone.
    #[must_use]
    pub fn roughened(mut self, share: f32, centre: [f32; 3], seed: u32) -> Self {
        for (k, corner) in self.corners.iter_mut().enumerate() {
            let factor = 1.0 + share * (2.0 * hash(seed, k as u32) - 1.0);
            (0..3).for_each(|axis| corner[axis] = centre[axis] + (corner[axis] - centre[axis]) * factor);
            corner[2] = corner[2].max(0.0);
        }
        self
    }

    /// The mesh and its mirror image on the other side of x = 0.
    #[must_use]
    pub fn on_both_sides(self) -> Self {
        let mut other = self.clone();
        other.corners.iter_mut().for_each(|corner| corner[0] = -corner[0]);
        other.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self.with(&other)
    }

    /// Both meshes as one.
    #[must_use]
    pub fn with(mut self, other: &Self) -> Self {
        let first = self.corners.len() as u32;
        self.corners.extend_from_slice(&other.corners);
        self.triangles.extend(
            other
                .triangles
                .iter()
                .map(|triangle| triangle.map(|corner| corner + first)),
        );
        self
    }
}

/// A vector of length 1; x where there is no direction.
fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length = dot(vector, vector).sqrt();
    if length > 0.0 {
        vector.map(|part| part / length)
    } else {
        [1.0, 0.0, 0.0]
    }
}

/// A number in 0..1 that depends on its arguments alone.
pub(crate) fn hash(seed: u32, k: u32) -> f32 {
    let mut x = seed.wrapping_mul(0x9E37_79B9) ^ k.wrapping_mul(0x85EB_CA6B) ^ 0x27D4_EB2F;
    x ^= x >> 15;
    x = x.wrapping_mul(0x2C1B_3C6D);
    x ^= x >> 12;
    x = x.wrapping_mul(0x297A_2D39);
    x ^= x >> 15;
    (x >> 8) as f32 / (1 << 24) as f32
}
