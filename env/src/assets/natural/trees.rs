//! Sixteen kinds of trees, two or three for each family of the plain look: what is a conifer there is a spruce or a pine here.

use super::super::levels::levelled;
use super::super::mesh::hash;
use super::super::{Asset, Builder, Mesh};
use super::growth::{Fine, frond};

type Color = [f32; 3];

const BARK: Color = [0.36, 0.26, 0.18];
const RED_BARK: Color = [0.52, 0.32, 0.20];
const GREY_BARK: Color = [0.48, 0.45, 0.40];
const BIRCH: Color = [0.90, 0.89, 0.85];
const DARK: Color = [0.12, 0.11, 0.10];

/// A kind of tree: drawn for its model and height.
type Kind = fn(Fine, u32, f32) -> Builder;

/// Kinds of the plain look's families, each with the height in metres of a tree of middling size.
const FAMILIES: [(f32, &[Kind]); 7] = [
    (4.5, &[dead, snag]),
    (6.0, &[spruce, pine]),
    (5.0, &[oak, maple, willow]),
    (7.0, &[poplar, cypress]),
    (5.5, &[birch, birches, cherry]),
    (4.8, &[acacia, cedar]),
    (5.5, &[coconut_palm, date_palm]),
];

/// Tree number `model` of 49.
pub(super) fn tree(model: u32) -> Asset {
    let (height, kinds) = FAMILIES[model as usize % 7];
    let make = kinds[model as usize / 7 % kinds.len()];
    let height = height * (0.85 + 0.4 * hash(model, 1));
    levelled(make(Fine::Whole, model, height), make(Fine::Coarse, model, height))
}

/// A colour, a little lighter or darker by model.
fn tint(model: u32, base: Color) -> Color {
    let shift = 0.10 * (hash(model, 9) - 0.5);
    base.map(|channel| (channel + shift).clamp(0.04, 0.96))
}

/// The same in the shade, for what is lower in a crown.
fn shaded(color: Color) -> Color {
    color.map(|channel| channel * 0.78)
}

/// An upright trunk.
fn trunk(fine: Fine, radius: f32, height: f32) -> Mesh {
    fine.wood(&[
        ([0.0, 0.0, 0.0], radius * 1.5),
        ([0.0, 0.0, height * 0.15], radius),
        ([0.0, 0.0, height], radius * 0.6),
    ])
}

fn clumps(fine: Fine, model: u32, places: &[([f32; 3], [f32; 3])]) -> Mesh {
    places
        .iter()
        .enumerate()
        .fold(Mesh::default(), |mesh, (k, (middle, half))| {
            mesh.with(&fine.clump(*middle, *half, model + 50 * k as u32))
        })
}

fn spruce(fine: Fine, model: u32, h: f32) -> Builder {
    let wide = h * (0.25 + 0.05 * hash(model, 2));
    let tiers = fine.pick(5, 4);
    let tier = |k: u32| {
        let share = k as f32 / tiers as f32;
        let low = h * (0.12 + 0.80 * share);
        fine.tier(
            wide * (1.0 - 0.88 * share),
            low,
            (low + h * 0.36).min(h),
            0.6 * k as f32,
        )
    };
    let needles = (0..tiers).fold(Mesh::default(), |mesh, k| mesh.with(&tier(k)));
    Builder::default()
        .fixed(BARK, trunk(fine, 0.17, h * 0.35))
        .main(tint(model, [0.10, 0.30, 0.20]), needles)
}

fn pine(fine: Fine, model: u32, h: f32) -> Builder {
    let lean = 0.08 * h * (hash(model, 3) - 0.5);
    let wood = fine
        .wood(&[
            ([0.0, 0.0, 0.0], 0.24),
            ([lean, 0.0, h * 0.45], 0.15),
            ([0.0, lean, h * 0.88], 0.09),
        ])
        .with(&fine.wood(&[([lean, 0.0, h * 0.5], 0.07), ([0.20 * h, 0.0, h * 0.70], 0.04)]));
    let top = clumps(
        fine,
        model,
        &[
            ([0.0, lean, h * 0.90], [h * 0.24, h * 0.22, h * 0.10]),
            ([-h * 0.12, h * 0.08, h * 0.78], [h * 0.17, h * 0.16, h * 0.07]),
            ([h * 0.20, 0.0, h * 0.73], [h * 0.14, h * 0.13, h * 0.06]),
        ],
    );
    Builder::default()
        .fixed(RED_BARK, wood)
        .main(tint(model, [0.16, 0.36, 0.20]), top)
}

fn oak(fine: Fine, model: u32, h: f32) -> Builder {
    let branch = |x: f32, y: f32| fine.wood(&[([0.0, 0.0, h * 0.32], 0.11), ([x, y, h * 0.56], 0.05)]);
    let wood = trunk(fine, 0.24, h * 0.55)
        .with(&branch(h * 0.26, h * 0.05))
        .with(&branch(-h * 0.24, -h * 0.08));
    let leaf = tint(model, [0.28, 0.46, 0.16]);
    let top = clumps(
        fine,
        model,
        &[
            ([0.0, 0.0, h * 0.80], [h * 0.27, h * 0.26, h * 0.20]),
            ([h * 0.10, h * 0.20, h * 0.68], [h * 0.20, h * 0.18, h * 0.15]),
        ],
    );
    let low = clumps(
        fine,
        model + 7,
        &[
            ([h * 0.28, 0.0, h * 0.60], [h * 0.20, h * 0.20, h * 0.15]),
            ([-h * 0.28, -h * 0.06, h * 0.62], [h * 0.21, h * 0.20, h * 0.16]),
        ],
    );
    Builder::default()
        .fixed(BARK, wood)
        .main(leaf, top)
        .main(shaded(leaf), low)
}

/// In autumn: yellow, orange or red.
fn maple(fine: Fine, model: u32, h: f32) -> Builder {
    let colors = [[0.86, 0.40, 0.10], [0.74, 0.18, 0.12], [0.90, 0.66, 0.16]];
    let leaf = colors[model as usize / 21 % 3];
    let top = fine.clump([0.0, 0.0, h * 0.66], [h * 0.30, h * 0.29, h * 0.33], model);
    let low = clumps(
        fine,
        model,
        &[
            ([h * 0.20, h * 0.10, h * 0.48], [h * 0.17, h * 0.17, h * 0.15]),
            ([-h * 0.20, -h * 0.06, h * 0.50], [h * 0.16, h * 0.17, h * 0.14]),
        ],
    );
    Builder::default()
        .fixed(GREY_BARK, trunk(fine, 0.18, h * 0.5))
        .main(leaf, top)
        .main(shaded(leaf), low)
}

/// A dome with branches that hang to the ground.
fn willow(fine: Fine, model: u32, h: f32) -> Builder {
    let leaf = tint(model, [0.50, 0.60, 0.24]);
    let dome = fine.clump([0.0, 0.0, h * 0.74], [h * 0.36, h * 0.36, h * 0.24], model);
    let count = fine.pick(13, 9);
    let strand = |k: u32| {
        let reach = h * (0.34 + 0.06 * hash(model, 20 + k));
        let end = h * (0.10 + 0.16 * hash(model, 40 + k));
        let path = [
            ([0.0, reach * 0.7, h * 0.80], [h * 0.05, h * 0.05]),
            ([0.0, reach, h * 0.60], [h * 0.085, h * 0.05]),
            ([0.0, reach * 1.04, end], [0.0; 2]),
        ];
        Mesh::tube(&path, 3).turned(360.0 * (k as f32 + 0.4 * hash(model, 60 + k)) / count as f32)
    };
    let curtain = (0..count).fold(Mesh::default(), |mesh, k| mesh.with(&strand(k)));
    Builder::default()
        .fixed(BARK, trunk(fine, 0.24, h * 0.6))
        .main(leaf, dome)
        .main(shaded(leaf), curtain)
}

fn poplar(fine: Fine, model: u32, h: f32) -> Builder {
    let top = clumps(
        fine,
        model,
        &[
            ([0.0, 0.0, h * 0.44], [h * 0.13, h * 0.13, h * 0.26]),
            ([0.02 * h, 0.0, h * 0.72], [h * 0.10, h * 0.10, h * 0.27]),
        ],
    );
    Builder::default()
        .fixed(GREY_BARK, trunk(fine, 0.15, h * 0.4))
        .main(tint(model, [0.42, 0.56, 0.20]), top)
}

/// A dark flame.
fn cypress(fine: Fine, model: u32, h: f32) -> Builder {
    let ring = |z: f32, wide: f32| ([0.0, 0.0, h * z], [h * wide; 2]);
    let flame = Mesh::tube(
        &[
            ring(0.07, 0.03),
            ring(0.20, 0.085),
            ring(0.45, 0.088),
            ring(0.75, 0.05),
            ring(1.0, 0.0),
        ],
        fine.pick(8, 5),
    );
    Builder::default()
        .fixed(BARK, trunk(fine, 0.15, h * 0.12))
        .main(tint(model, [0.08, 0.25, 0.14]), flame)
}

/// A white trunk between two places, with dark marks.
fn white_trunk(fine: Fine, foot: [f32; 3], top: [f32; 3], radius: f32) -> (Mesh, Mesh) {
    let at = |share: f32| [0, 1, 2].map(|axis| foot[axis] + share * (top[axis] - foot[axis]));
    let wood = fine.wood(&[(foot, radius * 1.2), (top, radius * 0.6)]);
    let marks = [0.12, 0.3, 0.42, 0.6].iter().fold(Mesh::default(), |mesh, share| {
        let wide = [radius * (1.2 - 0.6 * share) * 1.06; 2];
        mesh.with(&Mesh::tube(&[(at(*share), wide), (at(share + 0.025), wide)], 4))
    });
    (wood, fine.pick(marks, Mesh::default()))
}

fn birch(fine: Fine, model: u32, h: f32) -> Builder {
    let (wood, marks) = white_trunk(fine, [0.0; 3], [0.0, 0.0, h * 0.85], 0.13);
    let leaf = tint(model, [0.56, 0.66, 0.24]);
    let top = clumps(
        fine,
        model,
        &[
            ([0.0, 0.0, h * 0.85], [h * 0.15, h * 0.15, h * 0.15]),
            ([h * 0.10, h * 0.05, h * 0.66], [h * 0.16, h * 0.15, h * 0.14]),
            ([-h * 0.11, -h * 0.04, h * 0.57], [h * 0.14, h * 0.14, h * 0.12]),
        ],
    );
    Builder::default().fixed(BIRCH, wood).fixed(DARK, marks).main(leaf, top)
}

/// Three trunks from one foot.
fn birches(fine: Fine, model: u32, h: f32) -> Builder {
    let tops = [
        [0.16 * h, 0.05 * h, 0.80 * h],
        [-0.17 * h, 0.08 * h, 0.72 * h],
        [0.02 * h, -0.16 * h, 0.66 * h],
    ];
    let mut all = (Mesh::default(), Mesh::default(), Mesh::default());
    for (k, top) in tops.into_iter().enumerate() {
        let foot = [top[0] * 0.5, top[1] * 0.5, 0.0];
        let (wood, marks) = white_trunk(fine, foot, top, 0.09);
        let half = [h * 0.15, h * 0.15, h * 0.18];
        all = (
            all.0.with(&wood),
            all.1.with(&fine.pick(marks, Mesh::default())),
            all.2.with(&fine.clump(top, half, model + 50 * k as u32)),
        );
    }
    Builder::default()
        .fixed(BIRCH, all.0)
        .fixed(DARK, all.1)
        .main(tint(model, [0.62, 0.64, 0.20]), all.2)
}

/// In blossom.
fn cherry(fine: Fine, model: u32, h: f32) -> Builder {
    let branch = |x: f32, y: f32, z: f32| fine.wood(&[([0.0, 0.0, h * 0.28], 0.10), ([x, y, z], 0.04)]);
    let wood = trunk(fine, 0.17, h * 0.35)
        .with(&branch(h * 0.22, 0.0, h * 0.62))
        .with(&branch(-h * 0.20, h * 0.08, h * 0.66))
        .with(&branch(0.0, -h * 0.16, h * 0.72));
    let blossom = tint(model, [0.94, 0.68, 0.76]);
    let top = clumps(
        fine,
        model,
        &[
            ([h * 0.20, 0.0, h * 0.66], [h * 0.20, h * 0.19, h * 0.14]),
            ([-h * 0.20, h * 0.08, h * 0.68], [h * 0.19, h * 0.18, h * 0.14]),
            ([0.0, -h * 0.12, h * 0.80], [h * 0.20, h * 0.20, h * 0.15]),
        ],
    );
    Builder::default()
        .fixed(DARK.map(|channel| channel + 0.12), wood)
        .main(blossom, top)
}

/// A flat crown on a forked trunk.
fn acacia(fine: Fine, model: u32, h: f32) -> Builder {
    let fork = |x: f32, y: f32| {
        fine.wood(&[
            ([0.0, 0.0, h * 0.40], 0.12),
            ([x * 0.6, y * 0.6, h * 0.66], 0.08),
            ([x, y, h * 0.84], 0.05),
        ])
    };
    let wood = fine
        .wood(&[([0.0, 0.0, 0.0], 0.24), ([0.0, 0.0, h * 0.42], 0.15)])
        .with(&fork(h * 0.26, h * 0.04))
        .with(&fork(-h * 0.24, -h * 0.06));
    let top = clumps(
        fine,
        model,
        &[
            ([h * 0.16, 0.0, h * 0.90], [h * 0.38, h * 0.34, h * 0.07]),
            ([-h * 0.22, -h * 0.04, h * 0.84], [h * 0.30, h * 0.28, h * 0.06]),
        ],
    );
    Builder::default()
        .fixed(GREY_BARK, wood)
        .main(tint(model, [0.44, 0.50, 0.16]), top)
}

/// Flat storeys around a straight trunk.
fn cedar(fine: Fine, model: u32, h: f32) -> Builder {
    let storey = |k: u32| {
        let share = k as f32 / 3.0;
        let (x, y) = (
            0.10 * h * (hash(model, 70 + k) - 0.5),
            0.10 * h * (hash(model, 80 + k) - 0.5),
        );
        let wide = h * (0.36 - 0.24 * share);
        fine.clump(
            [x, y, h * (0.36 + 0.56 * share)],
            [wide, wide * 0.92, h * 0.07],
            model + 50 * k,
        )
    };
    let top = (0..4).fold(Mesh::default(), |mesh, k| mesh.with(&storey(k)));
    Builder::default()
        .fixed(BARK, trunk(fine, 0.20, h * 0.94))
        .main(tint(model, [0.16, 0.34, 0.30]), top)
}

/// A bent trunk, fronds that droop, coconuts.
fn coconut_palm(fine: Fine, model: u32, h: f32) -> Builder {
    let bend = h * (0.08 + 0.10 * hash(model, 3));
    let wood = fine.wood(&[
        ([0.0, 0.0, 0.0], 0.22),
        ([bend * 0.15, 0.0, h * 0.30], 0.13),
        ([bend * 0.5, 0.0, h * 0.65], 0.11),
        ([bend, 0.0, h * 0.92], 0.10),
    ]);
    let count = 9;
    let crown = (0..count).fold(Mesh::default(), |mesh, k| {
        let long = h * (0.36 + 0.06 * hash(model, 20 + k));
        let leaf = frond(fine, long, h * 0.055, h * 0.09, h * (0.16 + 0.14 * hash(model, 30 + k)));
        mesh.with(
            &leaf
                .turned(360.0 * k as f32 / count as f32)
                .moved([bend, 0.0, h * 0.91]),
        )
    });
    let nuts = [[0.16, 0.05], [-0.10, 0.14], [-0.06, -0.16]]
        .iter()
        .fold(Mesh::default(), |mesh, [x, y]| {
            mesh.with(&Mesh::ball(0.13, 0.0, 5, 3).moved([bend + x, *y, h * 0.88]))
        });
    Builder::default()
        .fixed([0.52, 0.44, 0.34], wood)
        .main(tint(model, [0.30, 0.52, 0.18]), crown)
        .fixed([0.34, 0.22, 0.12], fine.pick(nuts, Mesh::default()))
}

/// A thick, straight trunk with a ball of stiff fronds, dry ones below.
fn date_palm(fine: Fine, model: u32, h: f32) -> Builder {
    let wood = fine.wood(&[
        ([0.0, 0.0, 0.0], 0.30),
        ([0.0, 0.0, h * 0.30], 0.22),
        ([0.0, 0.0, h * 0.66], 0.26),
        ([0.0, 0.0, h * 0.74], 0.16),
    ]);
    let ring = |count: u32, long: f32, rise: f32, droop: f32, turn: f32| {
        (0..count).fold(Mesh::default(), |mesh, k| {
            let leaf = frond(fine, h * long, h * 0.04, h * rise, h * droop);
            mesh.with(
                &leaf
                    .turned(360.0 * k as f32 / count as f32 + turn)
                    .moved([0.0, 0.0, h * 0.72]),
            )
        })
    };
    let green = ring(8, 0.34, 0.06, 0.10, 0.0).with(&ring(6, 0.26, 0.15, -0.06, 25.0));
    Builder::default()
        .fixed([0.46, 0.34, 0.22], wood)
        .main(tint(model, [0.36, 0.50, 0.26]), green)
        .fixed([0.62, 0.50, 0.28], ring(6, 0.20, -0.04, 0.16, 12.0))
}

/// Bare branches that fork.
fn dead(fine: Fine, model: u32, h: f32) -> Builder {
    let mut wood = trunk(fine, 0.19, h * 0.8);
    for k in 0..5 {
        let turn = 72.0 * k as f32 + 40.0 * hash(model, 50 + k);
        let (low, out) = (h * (0.36 + 0.09 * k as f32), h * (0.30 - 0.03 * k as f32));
        let branch = Mesh::tube(
            &[
                ([0.0, 0.0, low], [0.07; 2]),
                ([0.0, out * 0.55, low + out * 0.35], [0.045; 2]),
                ([0.0, out, low + out * 0.95], [0.0; 2]),
            ],
            3,
        );
        let twig = Mesh::tube(
            &[
                ([0.0, out * 0.55, low + out * 0.35], [0.035; 2]),
                ([0.1 * out, out * 1.15, low + out * 0.45], [0.0; 2]),
            ],
            3,
        );
        wood = wood.with(&branch.with(&fine.pick(twig, Mesh::default())).turned(turn));
    }
    Builder::default().main(tint(model, [0.48, 0.44, 0.40]), wood)
}

/// A trunk that broke off, and what is left of a branch.
fn snag(fine: Fine, model: u32, h: f32) -> Builder {
    let top = h * 0.62;
    let mut wood = fine.wood(&[
        ([0.0, 0.0, 0.0], 0.34),
        ([0.0, 0.0, h * 0.12], 0.25),
        ([0.0, 0.0, top], 0.20),
    ]);
    for (k, rise) in [0.38, 0.20, 0.30].into_iter().enumerate() {
        let splinter = Mesh::tube(
            &[
                ([0.0, 0.09, top - 0.1], [0.11; 2]),
                ([0.0, 0.13, top + rise * h * 0.7], [0.0; 2]),
            ],
            3,
        );
        wood = wood.with(&splinter.turned(120.0 * k as f32 + 30.0));
    }
    let stub = Mesh::tube(
        &[
            ([0.0, 0.0, h * 0.36], [0.10; 2]),
            ([0.0, h * 0.20, h * 0.50], [0.06; 2]),
        ],
        fine.pick(5, 3),
    );
    let hollow = fine.clump([0.0, -0.20, h * 0.30], [0.09, 0.06, 0.16], 1);
    Builder::default()
        .main(
            tint(model, [0.42, 0.36, 0.30]),
            wood.with(&stub.turned(60.0 + 200.0 * hash(model, 5))),
        )
        .fixed(DARK, fine.pick(hollow, Mesh::default()))
}
