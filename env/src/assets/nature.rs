//! What grows and lies about: rocks, shrubs, mushrooms, a stump.

use super::mesh::hash;
use super::{Asset, Builder, Mesh};

/// Rock number `model` of 44.
pub(crate) fn rock(model: u32) -> Asset {
    let size = 0.5 + 0.7 * hash(model, 1);
    let flat = 0.55 + 0.5 * hash(model, 2);
    let stone = |radius: f32, seed: u32| {
        Mesh::ball(radius, 0.0, 7, 4)
            .stretched([1.0, 0.75 + 0.3 * hash(seed, 3), flat])
            .moved([0.0, 0.0, radius * flat * 0.7])
    };
    let mut mesh = stone(size, model).roughened(0.22, [0.0, 0.0, size * 0.3], model);
    if model.is_multiple_of(3) {
        mesh = mesh.with(
            &stone(size * 0.5, model + 7)
                .roughened(0.2, [0.0, 0.0, 0.2], model + 7)
                .moved([size * 0.9, size * 0.4, 0.0]),
        );
    }
    let grey = 0.45 + 0.16 * hash(model, 5);
    Builder::default()
        .main([grey + 0.03, grey, grey - 0.03], mesh)
        .round(size * 0.85)
}

/// Shrub number `model` of 11.
pub(crate) fn shrub(model: u32) -> Asset {
    let size = 0.45 + 0.35 * hash(model, 1);
    let bush = |radius: f32, x: f32, y: f32, seed: u32| {
        Mesh::ball(radius, radius * 0.8, 7, 4)
            .roughened(0.2, [0.0, 0.0, radius * 0.8], seed)
            .moved([x, y, 0.0])
    };
    let leaves = bush(size, 0.0, 0.0, model)
        .with(&bush(size * 0.7, size * 0.7, 0.1, model + 20))
        .with(&bush(size * 0.6, -size * 0.5, size * 0.5, model + 30));
    let shift = 0.2 * hash(model, 6);
    let shrub = Builder::default().main([0.26 + shift, 0.46 + shift * 0.4, 0.20], leaves);
    if !model.is_multiple_of(3) {
        return shrub.round(size * 0.8);
    }
    let berries = (0..6).fold(Mesh::default(), |mesh, k| {
        let (x, y) = (
            size * (hash(model, 60 + k) - 0.5) * 1.6,
            size * (hash(model, 70 + k) - 0.5) * 1.6,
        );
        mesh.with(&Mesh::ball(0.07, 0.0, 5, 3).moved([x, y, size * (0.8 + 0.7 * hash(model, 80 + k))]))
    });
    shrub.fixed([0.78, 0.16, 0.22], berries).round(size * 0.8)
}

/// Mushroom number `model` of 6.
pub(crate) fn mushroom(model: u32) -> Asset {
    let tall = 0.5 + 0.12 * model as f32;
    let wide = 0.28 + 0.1 * (model % 3) as f32;
    let cap = if model.is_multiple_of(2) {
        Mesh::lathe(
            &[
                [0.1, tall * 0.55],
                [wide, tall * 0.6],
                [wide * 0.8, tall * 0.85],
                [0.0, tall],
            ],
            9,
        )
    } else {
        Mesh::lathe(&[[0.1, tall * 0.45], [wide, tall * 0.5], [0.0, tall]], 9)
    };
    let colors = [[0.80, 0.20, 0.16], [0.72, 0.52, 0.30], [0.86, 0.70, 0.40]];
    Builder::default()
        .fixed([0.92, 0.89, 0.80], Mesh::lathe(&[[0.14, 0.0], [0.09, tall * 0.6]], 7))
        .main(colors[model as usize % 3], cap)
        .round(0.2)
}

/// A stump with a root or two.
pub(crate) fn stump() -> Asset {
    let root = |turn: f32| {
        Mesh::cone(0.12, 0.0, 0.6, 5)
            .tilted(78.0)
            .turned(turn)
            .moved([0.0, 0.0, 0.12])
    };
    let wood = Mesh::lathe(&[[0.5, 0.0], [0.36, 0.2], [0.34, 0.55]], 9)
        .with(&root(20.0))
        .with(&root(150.0))
        .with(&root(265.0));
    Builder::default()
        .main([0.40, 0.29, 0.20], wood)
        .fixed([0.78, 0.66, 0.46], Mesh::cylinder(0.30, 0.55, 0.57, 9))
        .round(0.4)
}
