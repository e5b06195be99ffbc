//! Rocks, shrubs and mushrooms: what lies and grows about, as large as in the plain look.

use super::super::levels::levelled;
use super::super::mesh::hash;
use super::super::{Asset, Builder, Mesh};
use super::growth::{Fine, frond, wave};

/// Rock number `model` of 44.
pub(super) fn rock(model: u32) -> Asset {
    let make = |fine: Fine| {
        let size = 0.5 + 0.7 * hash(model, 1);
        let flat = 0.55 + 0.5 * hash(model, 2);
        let deep = 0.75 + 0.3 * hash(model, 3);
        let mut stones = stone(fine, [0.0, 0.0], [size, size * deep, size * flat], model);
        if model.is_multiple_of(3) {
            let half = [size * 0.5, size * 0.45, size * flat * 0.5];
            stones = stones.with(&stone(fine, [size * 0.9, size * 0.4], half, model + 7));
        }
        let grey = 0.42 + 0.18 * hash(model, 5);
        let warm = 0.07 * hash(model, 6);
        Builder::default().main([grey + warm, grey, grey - warm], stones)
    };
    levelled(make(Fine::Whole), make(Fine::Coarse))
}

/// A ball with lumps, cut by planes as stone breaks; a third of it is in the ground.
fn stone(fine: Fine, [x, y]: [f32; 2], half: [f32; 3], seed: u32) -> Mesh {
    let (segments, rings) = fine.pick((9, 6), (7, 4));
    let mut mesh = Mesh::ball(1.0, 0.0, segments, rings);
    let cuts: Vec<([f32; 3], f32)> = (0..7)
        .map(|k| {
            let turn = std::f32::consts::TAU * (k as f32 + hash(seed, 10 + k)) / 6.0;
            let rise = if k == 6 { 1.0 } else { 0.9 * hash(seed, 20 + k) - 0.1 };
            let level = (1.0 - rise * rise).max(0.0).sqrt();
            (
                [level * libm::cosf(turn), level * libm::sinf(turn), rise],
                0.74 + 0.16 * hash(seed, 30 + k),
            )
        })
        .collect();
    for corner in &mut mesh.corners {
        let factor = 1.12 + 0.10 * wave(*corner, seed);
        let mut at = corner.map(|part| part * factor);
        for (normal, far) in &cuts {
            let beyond: f32 = (0..3).map(|axis| at[axis] * normal[axis]).sum::<f32>() - far;
            if beyond > 0.0 {
                (0..3).for_each(|axis| at[axis] -= beyond * normal[axis]);
            }
        }
        *corner = [
            x + half[0] * at[0],
            y + half[1] * at[1],
            (half[2] * (at[2] + 0.7)).max(0.0),
        ];
    }
    mesh
}

/// Shrub number `model` of 11: leafy, with berries, with flowers, or of long leaves.
pub(super) fn shrub(model: u32) -> Asset {
    let size = 0.45 + 0.35 * hash(model, 1);
    let shift = 0.16 * hash(model, 6);
    let leaf = [0.20 + shift, 0.42 + shift * 0.4, 0.16];
    let dark = leaf.map(|channel| channel * 0.75);
    let dots = |count: u32, wide: f32| {
        (0..count).fold(Mesh::default(), |mesh, k| {
            let turn = 360.0 * (k as f32 + 0.5 * hash(model, 60 + k)) / count as f32 * 2.0;
            let (out, up) = (
                size * (0.55 + 0.35 * hash(model, 70 + k)),
                size * (0.7 + 0.8 * hash(model, 80 + k)),
            );
            mesh.with(&Mesh::ball(wide, 0.0, 4, 2).moved([0.0, out, up]).turned(turn))
        })
    };
    let make = |fine: Fine| {
        if model % 4 == 2 {
            let leaves = (0..12).fold(Mesh::default(), |mesh, k| {
                let up = 0.5 + 0.9 * hash(model, 20 + k);
                let blade = frond(
                    fine,
                    size * 1.15,
                    size * 0.11,
                    size * up,
                    size * (0.15 - 0.5 * up * hash(model, 40 + k)),
                );
                mesh.with(&blade.turned(30.0 * k as f32 + 20.0 * hash(model, 30 + k)))
            });
            return Builder::default().main(leaf, leaves);
        }
        let top = fine.clump([0.0, 0.0, size * 0.85], [size * 0.95, size * 0.9, size * 0.8], model);
        let low = fine
            .clump(
                [size * 0.7, size * 0.1, size * 0.5],
                [size * 0.62, size * 0.6, size * 0.52],
                model + 20,
            )
            .with(&fine.clump(
                [-size * 0.5, size * 0.5, size * 0.45],
                [size * 0.6, size * 0.55, size * 0.48],
                model + 30,
            ));
        let bush = Builder::default().main(leaf, top).main(dark, low);
        if model.is_multiple_of(3) {
            bush.fixed([0.80, 0.12, 0.18], dots(9, 0.06))
        } else if model % 4 == 1 {
            let petals = [[0.94, 0.90, 0.96], [0.92, 0.56, 0.76], [0.95, 0.80, 0.24]][model as usize % 3];
            bush.fixed(petals, dots(11, 0.08))
        } else {
            bush
        }
    };
    levelled(make(Fine::Whole), make(Fine::Coarse))
}

/// Mushroom number `model` of 6: some have a ring and dots.
pub(super) fn mushroom(model: u32) -> Asset {
    let tall = 0.5 + 0.12 * model as f32;
    let wide = 0.28 + 0.1 * (model % 3) as f32;
    let colors = [[0.80, 0.14, 0.10], [0.66, 0.46, 0.26], [0.88, 0.66, 0.30]];
    let make = |fine: Fine| {
        let around = fine.pick(10, 6);
        let cap = Mesh::tube(
            &[
                ([0.0, 0.0, tall * 0.60], [0.08; 2]),
                ([0.0, 0.0, tall * 0.58], [wide; 2]),
                ([0.0, 0.0, tall * 0.76], [wide * 0.86; 2]),
                ([0.0, 0.0, tall * 0.92], [wide * 0.5; 2]),
                ([0.0, 0.0, tall], [0.0; 2]),
            ],
            around,
        );
        let stem = Mesh::tube(
            &[
                ([0.0, 0.0, 0.0], [0.13; 2]),
                ([0.0, 0.0, tall * 0.2], [0.085; 2]),
                ([0.0, 0.0, tall * 0.62], [0.075; 2]),
            ],
            fine.pick(7, 4),
        );
        let dots = (0..7).fold(Mesh::default(), |mesh, k| {
            let (out, up) = if k < 4 {
                (wide * 0.78, 0.79)
            } else {
                (wide * 0.42, 0.93)
            };
            let dot = Mesh::ball(0.045, 0.0, 4, 2).moved([0.0, out, tall * up]);
            mesh.with(&dot.turned(90.0 * k as f32 + 33.0 * (k / 4) as f32))
        });
        let is_dotted = model.is_multiple_of(3) && fine == Fine::Whole;
        Builder::default()
            .fixed(
                [0.93, 0.90, 0.80],
                stem.with(&if is_dotted { dots } else { Mesh::default() }),
            )
            .main(colors[model as usize % 3], cap)
    };
    levelled(make(Fine::Whole), make(Fine::Coarse))
}
