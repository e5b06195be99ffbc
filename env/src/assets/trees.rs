//! Trees: seven families, told apart at a glance; the model number picks family, proportions and tint.

use super::mesh::hash;
use super::{Asset, Builder, Mesh};

const BARK: [f32; 3] = [0.42, 0.30, 0.20];
const BIRCH: [f32; 3] = [0.86, 0.85, 0.80];

/// Tree number `model` of 49.
pub(crate) fn tree(model: u32) -> Asset {
    let tall = 0.85 + 0.4 * hash(model, 1);
    match model % 7 {
        1 => conifer(model, 6.0 * tall),
        2 => broadleaf(model, 5.0 * tall),
        3 => poplar(model, 7.0 * tall),
        4 => birch(model, 5.5 * tall),
        5 => layered(model, 4.8 * tall),
        6 => palm(model, 5.5 * tall),
        _ => dead(model, 4.5 * tall),
    }
}

fn green(model: u32, base: [f32; 3]) -> [f32; 3] {
    let shift = 0.14 * (hash(model, 9) - 0.5);
    [base[0] + shift * 0.8, base[1] + shift, base[2] + shift * 0.4].map(|c| c.clamp(0.05, 0.95))
}

fn trunk(radius: f32, height: f32) -> Mesh {
    Mesh::lathe(
        &[[radius * 1.25, 0.0], [radius, height * 0.25], [radius * 0.7, height]],
        7,
    )
}

fn conifer(model: u32, height: f32) -> Asset {
    let wide = height * (0.24 + 0.06 * hash(model, 2));
    let tiers = 3 + model / 7 % 2;
    let mut crown = Mesh::default();
    for k in 0..tiers {
        let low = height * (0.16 + 0.24 * k as f32);
        let radius = wide * (1.0 - 0.24 * k as f32);
        crown = crown.with(&Mesh::cone(radius, low, (low + height * 0.46).min(height), 9).turned(17.0 * k as f32));
    }
    Builder::default()
        .fixed(BARK, trunk(0.16, height * 0.4))
        .main(green(model, [0.16, 0.42, 0.24]), crown)
        .round(0.25)
}

fn leaves(radius: f32, at: [f32; 3], flat: f32, seed: u32) -> Mesh {
    Mesh::ball(radius, 0.0, 8, 5)
        .roughened_ball(seed)
        .stretched([1.0, 1.0, flat])
        .moved(at)
}

impl Mesh {
    /// Corners of a ball around the origin moved in and out a little.
    fn roughened_ball(mut self, seed: u32) -> Self {
        for (k, corner) in self.corners.iter_mut().enumerate() {
            let factor = 0.88 + 0.24 * hash(seed, k as u32);
            for metres in corner.iter_mut() {
                *metres *= factor;
            }
        }
        self
    }
}

fn broadleaf(model: u32, height: f32) -> Asset {
    let wide = height * (0.27 + 0.05 * hash(model, 2));
    let crown = leaves(wide, [0.0, 0.0, height * 0.68], 0.95, model)
        .with(&leaves(wide * 0.68, [wide * 0.6, 0.2, height * 0.55], 0.9, model + 50))
        .with(&leaves(
            wide * 0.62,
            [-wide * 0.55, -0.3, height * 0.6],
            0.9,
            model + 60,
        ));
    Builder::default()
        .fixed(BARK, trunk(0.2, height * 0.55))
        .main(green(model, [0.30, 0.52, 0.20]), crown)
        .round(0.3)
}

fn poplar(model: u32, height: f32) -> Asset {
    let wide = height * 0.13;
    let crown = leaves(wide, [0.0, 0.0, 0.0], 3.1, model).moved([0.0, 0.0, height * 0.56]);
    Builder::default()
        .fixed(BARK, trunk(0.15, height * 0.4))
        .main(green(model, [0.34, 0.50, 0.22]), crown)
        .round(0.25)
}

fn birch(model: u32, height: f32) -> Asset {
    let wide = height * 0.2;
    let crown = leaves(wide, [0.0, 0.0, height * 0.72], 1.25, model).with(&leaves(
        wide * 0.7,
        [0.3, -wide * 0.6, height * 0.58],
        1.0,
        model + 40,
    ));
    Builder::default()
        .fixed(BIRCH, trunk(0.13, height * 0.7))
        .main(green(model, [0.50, 0.60, 0.22]), crown)
        .round(0.22)
}

fn layered(model: u32, height: f32) -> Asset {
    let wide = height * 0.36;
    let crown = leaves(wide, [0.0, 0.0, height * 0.82], 0.34, model).with(&leaves(
        wide * 0.62,
        [wide * 0.5, 0.3, height * 0.6],
        0.34,
        model + 30,
    ));
    Builder::default()
        .fixed(BARK, trunk(0.17, height * 0.78))
        .main(green(model, [0.40, 0.50, 0.18]), crown)
        .round(0.26)
}

fn palm(model: u32, height: f32) -> Asset {
    let mut crown = Mesh::default();
    for k in 0..8 {
        let frond = Mesh::cone(0.26, 0.0, height * 0.36, 4).stretched([1.0, 0.3, 1.0]);
        let lean = 98.0 + 16.0 * hash(model, 20 + k);
        crown = crown.with(&frond.tilted(lean).turned(45.0 * k as f32).moved([0.0, 0.0, height]));
    }
    Builder::default()
        .fixed([0.55, 0.44, 0.30], trunk(0.17, height))
        .main(green(model, [0.26, 0.50, 0.20]), crown)
        .fixed([0.45, 0.30, 0.16], Mesh::ball(0.22, height - 0.1, 6, 4))
        .round(0.25)
}

fn dead(model: u32, height: f32) -> Asset {
    let mut wood = trunk(0.2, height);
    for k in 0..4 {
        let long = height * (0.3 + 0.2 * hash(model, 30 + k));
        let branch = Mesh::lathe(&[[0.09, 0.0], [0.02, long]], 5).tilted(52.0 + 14.0 * hash(model, 40 + k));
        let turn = 90.0 * k as f32 + 50.0 * hash(model, 50 + k);
        wood = wood.with(&branch.turned(turn).moved([0.0, 0.0, height * (0.42 + 0.13 * k as f32)]));
    }
    Builder::default().main([0.50, 0.44, 0.38], wood).round(0.25)
}
