//! What is built: houses, a car, ruins, fences, roadblocks, signs, tents.

use super::mesh::hash;
use super::{Asset, Builder, Mesh};

const STONE: [f32; 3] = [0.58, 0.56, 0.52];
const GLASS: [f32; 3] = [0.34, 0.48, 0.60];
const PLANK: [f32; 3] = [0.60, 0.44, 0.28];

fn block(size: [f32; 3], [x, y, z]: [f32; 3]) -> Mesh {
    Mesh::cuboid(size, z).moved([x, y, 0.0])
}

/// A gable roof over width and depth, its ridge along x, between two heights.
fn gable(width: f32, depth: f32, low: f32, high: f32) -> Mesh {
    let (w, d) = (width / 2.0, depth / 2.0);
    Mesh {
        corners: vec![
            [-w, -d, low],
            [w, -d, low],
            [w, d, low],
            [-w, d, low],
            [-w, 0.0, high],
            [w, 0.0, high],
        ],
        triangles: vec![
            [0, 1, 5],
            [0, 5, 4],
            [2, 3, 4],
            [2, 4, 5],
            [3, 0, 4],
            [1, 2, 5],
            [0, 3, 2],
            [0, 2, 1],
        ],
    }
}

/// Building number `model` of 3.
pub(crate) fn building(model: u32) -> Asset {
    let (wide, deep, tall) = [(7.0, 5.5, 3.2), (5.5, 5.5, 6.5), (9.0, 6.5, 3.6)][(model as usize - 1) % 3];
    let walls = [[0.86, 0.80, 0.68], [0.74, 0.52, 0.42], [0.80, 0.82, 0.80]][(model as usize - 1) % 3];
    let mut windows = Mesh::default();
    let floors = if tall > 5.0 { 2 } else { 1 };
    for floor in 0..floors {
        for side in [-1.0, 1.0] {
            let z = 1.1 + 3.0 * floor as f32;
            for x in [-0.3, 0.3] {
                windows = windows.with(&block([1.0, 0.08, 1.1], [x * wide, side * deep / 2.0, z]));
            }
            windows = windows.with(&block([0.08, 1.0, 1.1], [side * wide / 2.0, 0.0, z]));
        }
    }
    Builder::default()
        .main(walls, Mesh::cuboid([wide, deep, tall], 0.0))
        .fixed([0.58, 0.26, 0.20], gable(wide + 0.6, deep + 0.6, tall, tall + 2.0))
        .fixed(GLASS, windows)
        .fixed([0.36, 0.24, 0.16], block([1.1, 0.1, 2.1], [0.0, -deep / 2.0, 0.0]))
        .boxed()
}

/// The car.
pub(crate) fn car() -> Asset {
    let wheel = |x: f32, y: f32| {
        Mesh::cylinder(0.33, -0.1, 0.1, 10)
            .tilted(90.0)
            .turned(90.0)
            .moved([x, y, 0.33])
    };
    let wheels = wheel(0.8, 1.2)
        .with(&wheel(-0.8, 1.2))
        .with(&wheel(0.8, -1.2))
        .with(&wheel(-0.8, -1.2));
    Builder::default()
        .main([0.70, 0.16, 0.16], block([1.7, 4.0, 0.6], [0.0, 0.0, 0.3]))
        .fixed(GLASS, block([1.5, 2.0, 0.55], [0.0, -0.2, 0.9]))
        .main([0.70, 0.16, 0.16], block([1.55, 1.7, 0.08], [0.0, -0.2, 1.45]))
        .fixed([0.12, 0.12, 0.13], wheels)
        .fixed(
            [0.95, 0.92, 0.70],
            block([0.3, 0.06, 0.16], [0.55, 2.0, 0.55]).with(&block([0.3, 0.06, 0.16], [-0.55, 2.0, 0.55])),
        )
        .boxed()
}

/// Castle ruin number `model` of 7.
pub(crate) fn castle_ruin(model: u32) -> Asset {
    let tall = 2.2 + 0.5 * model as f32;
    let stones = match model % 3 {
        0 => {
            let tower = Mesh::cylinder(1.5, 0.0, tall, 10);
            (0..5).fold(tower, |mesh, k| {
                let battlement = block([0.6, 0.45, 0.6], [0.0, 1.25, tall]);
                mesh.with(&battlement.turned(72.0 * k as f32))
            })
        }
        1 => (0..6).fold(Mesh::default(), |mesh, k| {
            let height = tall * (0.4 + 0.6 * hash(model, k));
            mesh.with(&block([0.8, 0.6, height], [-2.0 + 0.8 * k as f32, 0.0, 0.0]))
        }),
        _ => block([0.8, 0.8, tall], [-1.4, 0.0, 0.0])
            .with(&block([0.8, 0.8, tall * 0.9], [1.4, 0.0, 0.0]))
            .with(&block([3.6, 0.8, 0.6], [0.0, 0.0, tall]))
            .with(&block([0.9, 0.7, 0.5], [2.4, 0.5, 0.0])),
    };
    Builder::default().main(STONE, stones).boxed()
}

/// Fence number `model` of 31: pickets, rails or stone, longer and shorter, with and without gaps.
pub(crate) fn fence(model: u32) -> Asset {
    let long = 2.0 + 0.25 * (model % 5) as f32;
    let tall = 0.9 + 0.08 * (model % 7) as f32;
    let posts = (model % 4 + 4).max(4);
    match model % 3 {
        0 => {
            let wall = Mesh::cuboid([long, 0.3, tall * 0.8], 0.0);
            Builder::default()
                .main(STONE, wall.with(&Mesh::cuboid([long + 0.1, 0.4, 0.1], tall * 0.8)))
                .boxed()
        }
        1 => {
            let pickets = (0..posts + 4).fold(Mesh::default(), |mesh, k| {
                let x = long * (k as f32 / (posts + 3) as f32 - 0.5);
                mesh.with(&block([0.1, 0.04, tall], [x, 0.0, 0.0]))
            });
            let rails = block([long, 0.05, 0.08], [0.0, 0.05, tall * 0.25])
                .with(&block([long, 0.05, 0.08], [0.0, 0.05, tall * 0.7]));
            Builder::default()
                .main([0.88, 0.86, 0.80], pickets.with(&rails))
                .boxed()
        }
        _ => {
            let uprights = (0..3).fold(Mesh::default(), |mesh, k| {
                mesh.with(&block([0.14, 0.14, tall], [long * (k as f32 / 2.0 - 0.5), 0.0, 0.0]))
            });
            let rails = (0..3).fold(uprights, |mesh, k| {
                mesh.with(&block([long, 0.06, 0.12], [0.0, 0.08, tall * (0.2 + 0.28 * k as f32)]))
            });
            Builder::default().main(PLANK, rails).boxed()
        }
    }
}

/// The roadblock.
pub(crate) fn roadblock() -> Asset {
    let stripe = |k: u32| block([0.32, 0.1, 0.28], [-0.8 + 0.32 * k as f32, 0.0, 0.65]);
    let stripes = |odd: u32| {
        (0..6)
            .filter(|k| k % 2 == odd)
            .fold(Mesh::default(), |mesh, k| mesh.with(&stripe(k)))
    };
    let feet = block([0.1, 0.6, 0.1], [-0.65, 0.0, 0.0]).with(&block([0.1, 0.6, 0.1], [0.65, 0.0, 0.0]));
    let posts = block([0.1, 0.08, 0.65], [-0.65, 0.0, 0.0]).with(&block([0.1, 0.08, 0.65], [0.65, 0.0, 0.0]));
    Builder::default()
        .main([0.85, 0.22, 0.16], stripes(0))
        .fixed([0.95, 0.95, 0.92], stripes(1))
        .fixed([0.3, 0.3, 0.32], feet.with(&posts))
        .boxed()
}

/// The street sign.
pub(crate) fn street_sign() -> Asset {
    Builder::default()
        .fixed([0.55, 0.56, 0.58], Mesh::cylinder(0.05, 0.0, 2.3, 7))
        .main([0.18, 0.36, 0.66], block([0.8, 0.06, 0.8], [0.0, -0.06, 1.6]))
        .fixed([0.95, 0.95, 0.92], block([0.5, 0.08, 0.14], [0.0, -0.06, 1.93]))
        .round(0.12)
}

/// Tent number `model` of 3: ridge, pyramid, dome.
pub(crate) fn tent(model: u32) -> Asset {
    match model {
        2 => {
            let cloth = Mesh::lathe(&[[1.7, 0.0], [1.55, 0.9], [0.0, 2.6]], 8);
            Builder::default()
                .main([0.82, 0.74, 0.56], cloth)
                .fixed([0.25, 0.2, 0.16], block([0.8, 0.1, 1.1], [0.0, -1.5, 0.0]))
                .round(1.6)
        }
        3 => {
            let cloth = Mesh::lathe(&[[1.5, 0.0], [1.4, 0.6], [1.0, 1.15], [0.5, 1.4], [0.0, 1.5]], 10);
            Builder::default()
                .main([0.20, 0.46, 0.56], cloth)
                .fixed([0.12, 0.2, 0.26], block([0.7, 0.1, 0.8], [0.0, -1.38, 0.0]))
                .round(1.4)
        }
        _ => Builder::default()
            .main([0.78, 0.48, 0.20], gable(2.8, 2.4, 0.0, 1.7))
            .fixed(
                [0.3, 0.2, 0.12],
                Mesh::prism(&[[-0.02, -0.45], [0.02, -0.45], [0.02, 0.45], [-0.02, 0.45]], 0.0, 0.9)
                    .moved([1.4, 0.0, 0.0]),
            )
            .boxed(),
    }
}
