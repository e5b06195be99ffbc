//! What rooms are furnished with beyond the original's beds, chairs and tables; all of it faces +y. What the original has is in
//! `furniture.rs`.

use super::furniture::{DARK_WOOD, IRON, WOOD, legs, plank};
use super::{Asset, Builder, Mesh};

/// The pieces in the order of their model numbers.
pub(crate) const FURNISHINGS: [&str; 10] = [
    "sofa",
    "armchair",
    "desk",
    "cabinet",
    "wardrobe",
    "lamp",
    "television",
    "fridge",
    "stove",
    "bathtub",
];

const BLACK: [f32; 3] = [0.08, 0.08, 0.09];
const BRASS: [f32; 3] = [0.80, 0.66, 0.28];
const WHITE: [f32; 3] = [0.92, 0.92, 0.90];

/// Piece number `model` of [`FURNISHINGS`].
pub(crate) fn furnishing(model: u32) -> Asset {
    match model {
        1 => seat(1.9, 2),
        2 => seat(0.95, 1),
        3 => desk(),
        4 => cabinet(),
        5 => wardrobe(),
        6 => lamp(),
        7 => television(),
        8 => fridge(),
        9 => stove(),
        _ => bathtub(),
    }
}

/// A box with its mirror image.
fn pair(size: [f32; 3], at: [f32; 3]) -> Mesh {
    plank(size, at).on_both_sides()
}

/// A sofa or an armchair: this wide, with so many cushions.
fn seat(wide: f32, cushions: u32) -> Asset {
    let fabric = [0.30, 0.44, 0.46];
    let frame = plank([wide, 0.85, 0.22], [0.0, 0.0, 0.10])
        .with(&plank([wide, 0.22, 0.55], [0.0, -0.315, 0.30]))
        .with(&pair([0.18, 0.85, 0.36], [wide / 2.0 - 0.09, 0.0, 0.26]));
    let room = (wide - 0.36) / cushions as f32;
    let soft = (0..cushions).fold(Mesh::default(), |mesh, k| {
        let x = room * (k as f32 - (cushions - 1) as f32 / 2.0);
        mesh.with(&plank([room - 0.03, 0.62, 0.15], [x, 0.10, 0.32]))
            .with(&plank([room - 0.05, 0.14, 0.36], [x, -0.15, 0.45]))
    });
    Builder::default()
        .main(fabric, frame)
        .fixed([0.86, 0.82, 0.72], soft)
        .fixed(DARK_WOOD, legs(wide - 0.1, 0.75, 0.1, 0.08))
        .boxed()
}

/// A desk with drawers, a screen and a keyboard.
fn desk() -> Asset {
    let drawers = (0..3).fold(Mesh::default(), |mesh, k| {
        mesh.with(&plank([0.34, 0.02, 0.18], [0.47, 0.34, 0.09 + 0.21 * k as f32]))
    });
    Builder::default()
        .main(
            WOOD,
            plank([1.4, 0.7, 0.05], [0.0, 0.0, 0.70])
                .with(&plank([0.05, 0.66, 0.70], [-0.66, 0.0, 0.0]))
                .with(&plank([0.42, 0.66, 0.70], [0.47, 0.0, 0.0])),
        )
        .fixed([0.80, 0.68, 0.50], drawers)
        .fixed(
            BLACK,
            plank([0.62, 0.05, 0.38], [-0.15, -0.15, 0.87])
                .with(&plank([0.24, 0.18, 0.02], [-0.15, -0.15, 0.75]))
                .with(&plank([0.06, 0.04, 0.12], [-0.15, -0.16, 0.76]))
                .with(&plank([0.44, 0.15, 0.025], [-0.15, 0.16, 0.75])),
        )
        .fixed([0.36, 0.62, 0.86], plank([0.56, 0.01, 0.32], [-0.15, -0.12, 0.90]))
        .boxed()
}

/// A chest of four drawers.
fn cabinet() -> Asset {
    let front = |k: u32| [0.0, 0.225, 0.12 + 0.22 * k as f32];
    let drawers = (0..4).fold(Mesh::default(), |mesh, k| {
        mesh.with(&plank([0.80, 0.03, 0.19], front(k)))
    });
    let knobs = (0..4).fold(Mesh::default(), |mesh, k| {
        let [_, y, z] = front(k);
        mesh.with(&pair([0.05, 0.05, 0.05], [0.2, y + 0.03, z + 0.07]))
    });
    Builder::default()
        .main(WOOD, plank([0.9, 0.45, 0.95], [0.0, 0.0, 0.05]))
        .fixed(
            DARK_WOOD,
            plank([0.96, 0.50, 0.04], [0.0, 0.0, 1.0]).with(&legs(0.9, 0.45, 0.06, 0.08)),
        )
        .fixed([0.74, 0.55, 0.34], drawers)
        .fixed(BRASS, knobs)
        .boxed()
}

/// A wardrobe with two doors.
fn wardrobe() -> Asset {
    Builder::default()
        .main(
            [0.48, 0.32, 0.20],
            plank([1.2, 0.58, 1.9], [0.0, 0.0, 0.06]).with(&plank([1.28, 0.64, 0.08], [0.0, 0.0, 1.94])),
        )
        .fixed([0.66, 0.48, 0.30], pair([0.53, 0.03, 1.66], [0.285, 0.29, 0.18]))
        .fixed(BRASS, pair([0.04, 0.05, 0.22], [0.07, 0.32, 0.95]))
        .fixed(DARK_WOOD, legs(1.2, 0.58, 0.06, 0.1))
        .boxed()
}

/// A lamp that stands on the ground.
fn lamp() -> Asset {
    Builder::default()
        .main([0.98, 0.86, 0.52], Mesh::lathe(&[[0.26, 1.25], [0.14, 1.62]], 9))
        .fixed(
            IRON,
            Mesh::lathe(&[[0.19, 0.0], [0.16, 0.04], [0.02, 0.06]], 9).with(&Mesh::cylinder(0.035, 0.05, 1.3, 5)),
        )
        .round(0.2)
}

/// A television on its stand.
fn television() -> Asset {
    Builder::default()
        .main(WOOD, plank([1.3, 0.4, 0.42], [0.0, 0.0, 0.06]))
        .fixed([0.70, 0.52, 0.32], pair([0.58, 0.02, 0.32], [0.31, 0.2, 0.11]))
        .fixed(
            BLACK,
            plank([1.12, 0.06, 0.64], [0.0, 0.0, 0.54])
                .with(&plank([0.4, 0.22, 0.02], [0.0, 0.0, 0.48]))
                .with(&plank([0.12, 0.04, 0.06], [0.0, 0.0, 0.49]))
                .with(&legs(1.25, 0.36, 0.06, 0.06)),
        )
        .fixed([0.22, 0.42, 0.66], plank([1.04, 0.01, 0.56], [0.0, 0.035, 0.58]))
        .boxed()
}

/// A fridge, its freezer below.
fn fridge() -> Asset {
    Builder::default()
        .main(
            WHITE,
            plank([0.66, 0.60, 1.76], [0.0, -0.03, 0.04])
                .with(&plank([0.66, 0.06, 1.14], [0.0, 0.31, 0.66]))
                .with(&plank([0.66, 0.06, 0.56], [0.0, 0.31, 0.06])),
        )
        .fixed(
            [0.46, 0.48, 0.50],
            plank([0.04, 0.05, 0.5], [0.25, 0.365, 0.74]).with(&plank([0.04, 0.05, 0.3], [0.25, 0.365, 0.28])),
        )
        .fixed(
            BLACK,
            plank([0.6, 0.56, 0.04], [0.0, -0.03, 0.0]).with(&plank([0.64, 0.02, 0.04], [0.0, 0.275, 0.62])),
        )
        .boxed()
}

/// A stove: four plates, an oven with a window.
fn stove() -> Asset {
    let plates = [-0.15, 0.15].into_iter().fold(Mesh::default(), |mesh, y| {
        mesh.with(
            &Mesh::cylinder(0.10, 0.88, 0.90, 8)
                .moved([0.15, y, 0.0])
                .on_both_sides(),
        )
    });
    let knobs = [-0.2, -0.07, 0.07, 0.2].into_iter().fold(Mesh::default(), |mesh, x| {
        mesh.with(&plank([0.05, 0.04, 0.05], [x, 0.32, 0.77]))
    });
    Builder::default()
        .main(
            WHITE,
            plank([0.6, 0.6, 0.88], [0.0, 0.0, 0.0]).with(&plank([0.6, 0.05, 0.16], [0.0, -0.275, 0.88])),
        )
        .fixed(
            BLACK,
            plates.with(&knobs).with(&plank([0.44, 0.02, 0.34], [0.0, 0.30, 0.22])),
        )
        .fixed([0.62, 0.64, 0.66], plank([0.5, 0.05, 0.03], [0.0, 0.32, 0.64]))
        .boxed()
}

/// A bathtub full of water, its tap at the back.
fn bathtub() -> Asset {
    let sides = pair([0.10, 1.7, 0.58], [0.35, 0.0, 0.0])
        .with(&plank([0.64, 0.12, 0.58], [0.0, 0.79, 0.0]))
        .with(&plank([0.64, 0.12, 0.58], [0.0, -0.79, 0.0]));
    Builder::default()
        .main(WHITE, sides)
        .fixed([0.40, 0.68, 0.84], plank([0.64, 1.5, 0.46], [0.0, 0.0, 0.0]))
        .fixed(
            [0.62, 0.64, 0.66],
            plank([0.05, 0.05, 0.22], [0.0, -0.79, 0.58]).with(&plank([0.05, 0.22, 0.05], [0.0, -0.70, 0.75])),
        )
        .boxed()
}
