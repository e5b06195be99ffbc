//! The car: bonnet, cabin, wheels with hubs, lights in front and behind.

use super::super::levels::levelled;
use super::super::{Asset, Builder, Mesh};
use super::growth::Fine;

const GLASS: [f32; 3] = [0.20, 0.30, 0.38];
const BLACK: [f32; 3] = [0.07, 0.07, 0.08];
const CHROME: [f32; 3] = [0.72, 0.74, 0.76];

/// The car, which faces +y.
pub(super) fn car() -> Asset {
    levelled(make(Fine::Whole), make(Fine::Coarse))
}

/// A side view as wide as said at each place: y, from z, to z, half width.
fn hull(stations: &[[f32; 4]]) -> Mesh {
    let path: Vec<_> = stations
        .iter()
        .map(|[y, low, high, wide]| {
            // A tube of four segments is a box whose half side is this share of its own.
            let share = 0.5_f32.sqrt() * std::f32::consts::FRAC_PI_2.sqrt();
            (
                [0.0, *y, f32::midpoint(*low, *high)],
                [wide / share, (high - low) / 2.0 / share],
            )
        })
        .collect();
    Mesh::tube(&path, 4)
}

fn make(fine: Fine) -> Builder {
    let body = hull(&[
        [-2.0, 0.42, 0.86, 0.74],
        [-1.75, 0.28, 0.92, 0.85],
        [1.45, 0.28, 0.90, 0.85],
        [1.85, 0.30, 0.74, 0.80],
        [2.0, 0.40, 0.64, 0.70],
    ]);
    let glass = hull(&[
        [-1.55, 0.88, 0.92, 0.74],
        [-1.05, 0.88, 1.42, 0.66],
        [0.25, 0.88, 1.44, 0.66],
        [0.95, 0.88, 0.92, 0.74],
    ]);
    let roof = hull(&[[-1.10, 1.41, 1.47, 0.62], [0.28, 1.42, 1.50, 0.63]]);
    let wheel = |y: f32, radius: f32, wide: f32, around: u32| {
        let round = Mesh::cylinder(radius, -wide, wide, around).tilted(90.0).turned(90.0);
        round.moved([0.78, y, 0.33]).on_both_sides()
    };
    let around = fine.pick(10, 6);
    let tyres = wheel(1.25, 0.33, 0.11, around).with(&wheel(-1.25, 0.33, 0.11, around));
    let hubs = wheel(1.25, 0.17, 0.12, 6).with(&wheel(-1.25, 0.17, 0.12, 6));
    let light = |y: f32, z: f32| {
        Mesh::cuboid([0.32, 0.06, 0.14], z)
            .moved([0.50, y, 0.0])
            .on_both_sides()
    };
    let paint = [0.70, 0.14, 0.14];
    Builder::default()
        .main(paint, body.with(&roof))
        .fixed(GLASS, glass)
        .fixed(BLACK, tyres)
        .fixed(CHROME, fine.pick(hubs, Mesh::default()))
        .fixed([0.98, 0.95, 0.76], light(1.98, 0.54))
        .fixed([0.86, 0.08, 0.06], light(-1.98, 0.64))
}
