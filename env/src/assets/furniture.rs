//! Things people make to sit on, keep in and carry: bags, barrels, beds, benches, chairs, pots, shelves, tables.

use super::mesh::hash;
use super::{Asset, Builder, Mesh};

pub(super) const WOOD: [f32; 3] = [0.56, 0.38, 0.22];
pub(super) const DARK_WOOD: [f32; 3] = [0.38, 0.26, 0.16];
pub(super) const IRON: [f32; 3] = [0.28, 0.29, 0.31];

/// A box of width, depth, height whose lowest corner is at `(x, y, z)` by its middle.
pub(super) fn plank(size: [f32; 3], [x, y, z]: [f32; 3]) -> Mesh {
    Mesh::cuboid(size, z).moved([x, y, 0.0])
}

pub(super) fn legs(width: f32, depth: f32, height: f32, thick: f32) -> Mesh {
    let (x, y) = (width / 2.0 - thick / 2.0, depth / 2.0 - thick / 2.0);
    [[-x, -y], [x, -y], [x, y], [-x, y]]
        .iter()
        .fold(Mesh::default(), |mesh, [x, y]| {
            mesh.with(&plank([thick, thick, height], [*x, *y, 0.0]))
        })
}

/// Bag number `model` of 6.
pub(crate) fn bag(model: u32) -> Asset {
    let size = 0.34 + 0.05 * model as f32;
    let colors = [[0.72, 0.60, 0.42], [0.45, 0.34, 0.24], [0.30, 0.40, 0.52]];
    let body = Mesh::lathe(
        &[
            [size * 0.8, 0.0],
            [size, size * 0.7],
            [size * 0.55, size * 1.5],
            [size * 0.2, size * 1.65],
        ],
        8,
    );
    let tie = Mesh::lathe(&[[size * 0.24, size * 1.6], [size * 0.42, size * 1.95]], 7);
    let bag = Builder::default().main(colors[model as usize % 3], body.with(&tie));
    bag.fixed(
        [0.85, 0.78, 0.55],
        Mesh::cylinder(size * 0.3, size * 1.56, size * 1.66, 8),
    )
    .round(size)
}

/// Barrel number `model` of 5: wooden ones with hoops, and steel drums.
pub(crate) fn barrel(model: u32) -> Asset {
    let tall = 0.95 + 0.06 * model as f32;
    if model.is_multiple_of(2) {
        let ring = |z: f32| Mesh::cylinder(0.385, z, z + 0.05, 14);
        let colors = [[0.20, 0.38, 0.58], [0.66, 0.24, 0.18], [0.30, 0.46, 0.30]];
        return Builder::default()
            .main(colors[model as usize % 3], Mesh::cylinder(0.37, 0.0, tall, 14))
            .fixed(
                IRON,
                ring(tall * 0.3)
                    .with(&ring(tall * 0.64))
                    .with(&Mesh::cylinder(0.12, tall, tall + 0.03, 8)),
            )
            .round(0.38);
    }
    let staves = Mesh::lathe(
        &[
            [0.30, 0.0],
            [0.38, tall * 0.3],
            [0.40, tall * 0.5],
            [0.38, tall * 0.7],
            [0.30, tall],
        ],
        12,
    );
    let hoop = |radius: f32, z: f32| Mesh::cylinder(radius, z, z + 0.07, 12);
    let hoops = hoop(0.395, tall * 0.24)
        .with(&hoop(0.395, tall * 0.69))
        .with(&hoop(0.33, 0.04))
        .with(&hoop(0.33, tall - 0.12));
    Builder::default().main(WOOD, staves).fixed(IRON, hoops).round(0.4)
}

/// The bed.
pub(crate) fn bed() -> Asset {
    Builder::default()
        .fixed(
            DARK_WOOD,
            plank([1.1, 2.0, 0.3], [0.0, 0.0, 0.0])
                .with(&plank([1.1, 0.08, 0.9], [0.0, 1.0, 0.0]))
                .with(&plank([1.1, 0.08, 0.55], [0.0, -1.0, 0.0])),
        )
        .main([0.36, 0.46, 0.66], plank([1.0, 1.9, 0.22], [0.0, 0.0, 0.3]))
        .fixed([0.93, 0.92, 0.88], plank([0.8, 0.4, 0.12], [0.0, 0.7, 0.52]))
        .boxed()
}

/// Bench number `model` of 3.
pub(crate) fn bench(model: u32) -> Asset {
    let wide = 1.3 + 0.25 * model as f32;
    let seat = Builder::default()
        .main(WOOD, plank([wide, 0.45, 0.07], [0.0, 0.0, 0.42]))
        .fixed(IRON, legs(wide * 0.9, 0.4, 0.42, 0.08));
    if model == 1 {
        seat.boxed()
    } else {
        seat.main(WOOD, plank([wide, 0.06, 0.4], [0.0, 0.22, 0.5])).boxed()
    }
}

/// Chair number `model` of 4.
pub(crate) fn chair(model: u32) -> Asset {
    let back = 0.45 + 0.12 * model as f32;
    let seat = Builder::default().fixed(DARK_WOOD, legs(0.5, 0.5, 0.45, 0.06)).main(
        WOOD,
        plank([0.52, 0.52, 0.07], [0.0, 0.0, 0.45]).with(&plank([0.52, 0.06, back], [0.0, 0.23, 0.5])),
    );
    if model % 2 == 1 {
        return seat.boxed();
    }
    let arms = plank([0.06, 0.5, 0.05], [0.26, 0.0, 0.72]).with(&plank([0.06, 0.5, 0.05], [-0.26, 0.0, 0.72]));
    seat.fixed(
        DARK_WOOD,
        arms.with(&plank([0.05, 0.05, 0.25], [0.26, -0.2, 0.5]))
            .with(&plank([0.05, 0.05, 0.25], [-0.26, -0.2, 0.5])),
    )
    .boxed()
}

/// Pot number `model` of 4.
pub(crate) fn pot(model: u32) -> Asset {
    let size = 0.3 + 0.05 * model as f32;
    let body = Mesh::lathe(
        &[
            [size * 0.6, 0.0],
            [size, size * 0.8],
            [size * 0.7, size * 1.5],
            [size * 0.85, size * 1.7],
        ],
        11,
    );
    let pot = Builder::default().main([0.70, 0.38, 0.24], body);
    if model.is_multiple_of(2) {
        return pot
            .fixed(
                [0.25, 0.16, 0.1],
                Mesh::cylinder(size * 0.7, size * 1.7, size * 1.71, 11),
            )
            .round(size);
    }
    let plant = (0..5).fold(Mesh::default(), |mesh, k| {
        let leaf = Mesh::cone(0.1, 0.0, size * 1.6, 4).tilted(18.0 + 18.0 * hash(model, k));
        mesh.with(&leaf.turned(72.0 * k as f32).moved([0.0, 0.0, size * 1.6]))
    });
    pot.fixed([0.24, 0.50, 0.22], plant).round(size)
}

/// The shelf, with books.
pub(crate) fn shelf() -> Asset {
    let boards = (0..5).fold(Mesh::default(), |mesh, k| {
        mesh.with(&plank([1.2, 0.35, 0.05], [0.0, 0.0, 0.45 * k as f32]))
    });
    let sides = plank([0.05, 0.35, 1.85], [0.6, 0.0, 0.0]).with(&plank([0.05, 0.35, 1.85], [-0.6, 0.0, 0.0]));
    let colors = [[0.66, 0.22, 0.18], [0.20, 0.40, 0.56], [0.80, 0.66, 0.30]];
    let books = |kind: u32| {
        (0..24).filter(|k| k % 3 == kind).fold(Mesh::default(), |mesh, k| {
            let x = -0.48 + 0.16 * (k % 6) as f32 + 0.05 * hash(3, k);
            let tall = 0.24 + 0.12 * hash(5, k);
            mesh.with(&plank([0.11, 0.26, tall], [x, 0.0, 0.05 + 0.45 * (k / 6) as f32]))
        })
    };
    (0..3)
        .fold(Builder::default().main(WOOD, boards.with(&sides)), |shelf, kind| {
            shelf.fixed(colors[kind as usize], books(kind))
        })
        .boxed()
}

/// Table number `model` of 3.
pub(crate) fn table(model: u32) -> Asset {
    match model {
        2 => Builder::default()
            .main(WOOD, Mesh::cylinder(0.65, 0.72, 0.79, 14))
            .fixed(DARK_WOOD, Mesh::lathe(&[[0.35, 0.0], [0.08, 0.1], [0.08, 0.72]], 8))
            .round(0.6),
        3 => Builder::default()
            .main(WOOD, plank([0.9, 0.9, 0.06], [0.0, 0.0, 0.42]))
            .fixed(DARK_WOOD, legs(0.8, 0.8, 0.42, 0.08))
            .boxed(),
        _ => Builder::default()
            .main(WOOD, plank([1.5, 0.85, 0.07], [0.0, 0.0, 0.72]))
            .fixed(DARK_WOOD, legs(1.35, 0.7, 0.72, 0.09))
            .boxed(),
    }
}
