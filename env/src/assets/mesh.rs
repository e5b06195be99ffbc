//! Triangle meshes.

/// A triangle mesh: corners in metres, triangles counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corners in metres; x east, y north, z up.
    pub corners: Vec<[f32; 3]>,
    /// Indices of three corners each.
    pub triangles: Vec<[u32; 3]>,
}

/// Simple shapes for tests in other files.
#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::Mesh;

    impl Mesh {
        /// A box with its lowest face on z = `z`, centred on the z axis. `size` is width (x), depth (y), height (z).
        pub(crate) fn cuboid(size: [f32; 3], z: f32) -> Self {
            let [w, d, h] = [size[0] / 2.0, size[1] / 2.0, size[2]];
            let upright = |[x, y]: [f32; 2]| [[x, y, z], [x, y, z + h]];
            Self {
                corners: [[-w, -d], [w, -d], [w, d], [-w, d]].map(upright).concat(),
                triangles: vec![
                    [0, 2, 3],
                    [0, 3, 1],
                    [2, 4, 5],
                    [2, 5, 3],
                    [4, 6, 7],
                    [4, 7, 5],
                    [6, 0, 1],
                    [6, 1, 7],
                    [1, 3, 5],
                    [0, 4, 2],
                    [1, 5, 7],
                    [0, 6, 4],
                ],
            }
        }

        /// Merges two meshes.
        #[cfg(feature = "gltf")]
        #[must_use]
        pub(crate) fn with(mut self, other: &Self) -> Self {
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

        /// Rotates a profile of (radius, height) pairs, from bottom to top, about the z axis in `segments` steps.
        ///
        /// A radius of 0 closes the shape in a point; other ends are capped.
        pub(crate) fn lathe(profile: &[[f32; 2]], segments: u32) -> Self {
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

        /// Joins neighbouring rings with bands, and caps the ends that are not points.
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
        #[cfg(feature = "gltf")]
        pub(crate) fn cylinder(radius: f32, low: f32, high: f32, segments: u32) -> Self {
            Self::lathe(&[[radius, low], [radius, high]], segments)
        }

        /// A ball of `rings` bands around a centre on the z axis.
        pub(crate) fn ball(radius: f32, centre: f32, segments: u32, rings: u32) -> Self {
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
    }
}
