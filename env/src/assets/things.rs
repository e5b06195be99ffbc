//! What opens, and what opens it: doors, keys, switches.

use super::{Asset, Builder, Mesh};

const OAK: [f32; 3] = [0.55, 0.36, 0.20];
const BRASS: [f32; 3] = [0.80, 0.66, 0.28];
const IRON: [f32; 3] = [0.28, 0.29, 0.31];

fn block(size: [f32; 3], [x, y, z]: [f32; 3]) -> Mesh {
    Mesh::cuboid(size, z).moved([x, y, 0.0])
}

/// Door number `model` of 2, a leaf and a gate: 1 m wide, 0.1 m thick and 2 m high, its hinges at its left end.
pub(crate) fn door(model: u32) -> Asset {
    if model == 2 {
        let frame = block([1.0, 0.08, 0.1], [0.0, 0.0, 0.0]).with(&block([1.0, 0.08, 0.1], [0.0, 0.0, 1.9]));
        let bars = (0..7).fold(frame, |mesh, k| {
            mesh.with(&block([0.06, 0.06, 1.8], [-0.45 + 0.15 * k as f32, 0.0, 0.1]))
        });
        return Builder::default()
            .main(OAK, bars)
            .fixed(IRON, block([0.16, 0.1, 0.2], [0.38, 0.0, 0.95]))
            .boxed();
    }
    let knob = |y: f32| Mesh::ball(0.05, 0.0, 8, 5).moved([0.4, y, 1.0]);
    let panels = [0.25, 1.15].into_iter().fold(Mesh::default(), |mesh, z| {
        mesh.with(&block([0.66, 0.084, 0.6], [0.0, 0.0, z]))
    });
    Builder::default()
        .main(OAK, block([1.0, 0.07, 2.0], [0.0, 0.0, 0.0]).with(&panels))
        .fixed(BRASS, knob(0.05).with(&knob(-0.05)))
        .fixed(
            IRON,
            block([0.06, 0.1, 0.12], [-0.47, 0.0, 0.3]).with(&block([0.06, 0.1, 0.12], [-0.47, 0.0, 1.6])),
        )
        .boxed()
}

/// The key: it stands on its bit, 0.6 m high, so that it is seen from afar.
pub(crate) fn key() -> Asset {
    let ring = (0..10).fold(Mesh::default(), |mesh, k| {
        let piece = Mesh::cuboid([0.1, 0.06, 0.05], -0.025).moved([0.0, 0.0, 0.12]);
        mesh.with(&in_wall_plane(piece, 36.0 * k as f32).moved([0.0, 0.0, 0.46]))
    });
    let shaft = block([0.06, 0.06, 0.36], [0.0, 0.0, 0.0]);
    let bit = block([0.12, 0.05, 0.06], [0.08, 0.0, 0.02]).with(&block([0.09, 0.05, 0.06], [0.07, 0.0, 0.13]));
    Builder::default().main(BRASS, ring.with(&shaft).with(&bit)).round(0.15)
}

/// A mesh turned around the y axis by degrees.
fn in_wall_plane(mut mesh: Mesh, degrees: f32) -> Mesh {
    let (sine, cosine) = (libm::sinf(degrees.to_radians()), libm::cosf(degrees.to_radians()));
    for corner in &mut mesh.corners {
        let [x, y, z] = *corner;
        *corner = [x * cosine + z * sine, y, z * cosine - x * sine];
    }
    mesh
}

/// The switch: a lever on a post, 1.1 m high.
pub(crate) fn switch() -> Asset {
    Builder::default()
        .fixed(
            IRON,
            block([0.3, 0.3, 0.08], [0.0, 0.0, 0.0]).with(&block([0.12, 0.12, 0.7], [0.0, 0.0, 0.08])),
        )
        .main(
            [0.85, 0.25, 0.2],
            block([0.24, 0.2, 0.16], [0.0, 0.0, 0.7]).with(&block([0.05, 0.05, 0.24], [0.0, 0.0, 0.86])),
        )
        .boxed()
}
