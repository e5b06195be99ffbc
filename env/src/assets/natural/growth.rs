//! What plants and stones are put together from, finely or coarsely: trunks, clumps of leaves, tiers of needles. Both forms are of
//! one shape, so that they are a little apart only.

use std::f32::consts::TAU;

use super::super::Mesh;
use super::super::mesh::hash;

/// How finely a thing is made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Fine {
    Whole,
    Coarse,
}

impl Fine {
    /// The first where all is drawn, the second in the coarse form.
    pub(super) fn pick<T>(self, whole: T, coarse: T) -> T {
        match self {
            Self::Whole => whole,
            Self::Coarse => coarse,
        }
    }

    /// A trunk or a branch through places, with its radius at each.
    pub(super) fn wood(self, path: &[([f32; 3], f32)]) -> Mesh {
        let path: Vec<_> = path.iter().map(|(place, radius)| (*place, [*radius; 2])).collect();
        Mesh::tube(&path, self.pick(5, 3))
    }

    /// A clump of leaves: a lumpy ball with these half sides.
    pub(super) fn clump(self, middle: [f32; 3], half: [f32; 3], seed: u32) -> Mesh {
        let (segments, rings) = self.pick((7, 4), (5, 3));
        // As large in section with few segments as with many.
        let step = TAU / segments as f32;
        let wider = (step / libm::sinf(step)).sqrt();
        let mut mesh = Mesh::ball(1.0, 0.0, segments, rings);
        for corner in &mut mesh.corners {
            let factor = 1.0 + 0.16 * wave(*corner, seed);
            *corner = [
                middle[0] + half[0] * wider * factor * corner[0],
                middle[1] + half[1] * wider * factor * corner[1],
                middle[2] + half[2] * factor * corner[2],
            ];
        }
        mesh
    }

    /// A tier of needles: a cone whose rim is jagged and hangs.
    pub(super) fn tier(self, radius: f32, low: f32, high: f32, turn: f32) -> Mesh {
        let count = self.pick(10, 6);
        let mut mesh = Mesh {
            corners: vec![[0.0, 0.0, low + 0.18 * (high - low)], [0.0, 0.0, high]],
            triangles: Vec::new(),
        };
        for k in 0..count {
            let angle = TAU * k as f32 / count as f32 + turn;
            let is_tip = self == Self::Coarse || k % 2 == 0;
            let (reach, z) = if is_tip {
                (radius, low)
            } else {
                (0.78 * radius, low + 0.10 * (high - low))
            };
            mesh.corners
                .push([reach * libm::cosf(angle), reach * libm::sinf(angle), z]);
            let (a, b) = (k + 2, (k + 1) % count + 2);
            mesh.triangles.extend([[a, b, 1], [b, a, 0]]);
        }
        mesh
    }
}

/// A smooth number in −1..1 that depends on a direction and a seed: lumps that few and many corners share.
pub(super) fn wave([x, y, z]: [f32; 3], seed: u32) -> f32 {
    let phase = |k: u32| TAU * hash(seed, 100 + k);
    let one = libm::sinf(2.6 * x + 1.7 * z + phase(0));
    let two = libm::sinf(2.9 * y - 1.3 * x + phase(1));
    let three = libm::sinf(3.4 * z + 1.1 * y + phase(2));
    (one + two + three) / 3.0
}

/// A long leaf or a frond along +y: rises, is widest half-way and droops to its tip.
pub(super) fn frond(fine: Fine, long: f32, wide: f32, rise: f32, droop: f32) -> Mesh {
    Mesh::tube(
        &[
            ([0.0, 0.0, 0.0], [0.0; 2]),
            ([0.0, long * 0.45, rise], [wide, wide * 0.18]),
            ([0.0, long, rise - droop], [0.0; 2]),
        ],
        fine.pick(4, 3),
    )
}
