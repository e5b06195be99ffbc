//! Animals for predator and prey: each stands on its feet, faces +y and is as large as in nature. How they move is the
//! world's.

use super::levels::levelled;
use super::{Asset, Builder, ColliderShape, Mesh};

/// The animals in the order of their model numbers: prey, then predators.
pub(crate) const ANIMALS: [&str; 10] = [
    "rabbit",
    "hen",
    "sheep",
    "pig",
    "deer",
    "fox",
    "wolf",
    "bear",
    "lion",
    "crocodile",
];

type Color = [f32; 3];

const DARK: Color = [0.10, 0.09, 0.09];
const CREAM: Color = [0.93, 0.90, 0.84];
const PINK: Color = [0.90, 0.62, 0.60];
const HORN: Color = [0.80, 0.72, 0.56];

/// Animal number `model` of [`ANIMALS`].
pub(crate) fn animal(model: u32) -> Asset {
    let (half, make): ([f32; 3], fn(Fine) -> Builder) = match model {
        1 => ([0.09, 0.19, 0.20], rabbit),
        2 => ([0.11, 0.19, 0.21], hen),
        3 => ([0.27, 0.56, 0.44], sheep),
        4 => ([0.24, 0.60, 0.37], pig),
        5 => ([0.21, 0.78, 0.95], deer),
        6 => ([0.11, 0.42, 0.27], fox),
        7 => ([0.18, 0.70, 0.55], wolf),
        8 => ([0.38, 0.92, 0.62], bear),
        9 => ([0.28, 0.95, 0.62], lion),
        _ => ([0.34, 1.50, 0.21], crocodile),
    };
    Asset {
        collider: ColliderShape::Box { half },
        ..levelled(make(Fine::Whole), make(Fine::Coarse))
    }
}

/// How finely an animal is made.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fine {
    Whole,
    Coarse,
}

impl Fine {
    /// Segments around a body or a head.
    fn body(self) -> u32 {
        if self == Self::Whole { 6 } else { 4 }
    }

    /// What lies in the middle of the animal: from back to front or up, each with y, z, half width, half height.
    fn middle(self, rings: &[[f32; 4]]) -> Mesh {
        let path: Vec<_> = rings
            .iter()
            .map(|[y, z, wide, high]| ([0.0, *y, *z], [*wide, *high]))
            .collect();
        Mesh::tube(&path, self.body())
    }

    /// The same for what is thin: tails, combs.
    fn thin(rings: &[[f32; 4]]) -> Mesh {
        let path: Vec<_> = rings
            .iter()
            .map(|[y, z, wide, high]| ([0.0, *y, *z], [*wide, *high]))
            .collect();
        Mesh::tube(&path, 4)
    }

    /// The same on both sides, as for legs, ears and horns: x, y, z, half width, half depth.
    fn pair(self, rings: &[[f32; 5]]) -> Mesh {
        let is_short = self == Self::Coarse || rings.len() < 3;
        let ends = [rings[0], rings[rings.len() - 1]];
        let rings = if is_short { &ends } else { rings };
        let path: Vec<_> = rings
            .iter()
            .map(|[x, y, z, wide, deep]| ([*x, *y, *z], [*wide, *deep]))
            .collect();
        Mesh::tube(&path, 3).on_both_sides()
    }

    /// A pair of legs from the ground up, x from the middle, bent at the knee by `bend` to the front.
    fn legs(self, [x, y]: [f32; 2], top: f32, [thigh, foot]: [f32; 2], bend: f32) -> Mesh {
        let (hoof, hip) = ([x, y, 0.0, foot, foot * 1.25], [x, y, top, thigh, thigh * 1.2]);
        if bend == 0.0 {
            return self.pair(&[hoof, hip]);
        }
        let knee = [x, y + bend, top * 0.5, (foot + thigh) * 0.42, (foot + thigh) * 0.5];
        self.pair(&[hoof, knee, hip])
    }

    /// Two eyes and a nose as small tents, which are left out of the coarse form.
    fn face(self, eye: [f32; 3], nose: [f32; 3], size: f32) -> Mesh {
        if self == Self::Coarse {
            return Mesh::default();
        }
        let tent = |[x, y, z]: [f32; 3], size: f32| {
            Mesh::tube(&[([x, y - size, z], [size; 2]), ([x, y + size, z], [0.0; 2])], 3)
        };
        tent(eye, size).on_both_sides().with(&tent(nose, size * 1.2))
    }
}

/// It sits, its ears up.
fn rabbit(fine: Fine) -> Builder {
    let body = fine.middle(&[
        [-0.17, 0.10, 0.04, 0.05],
        [-0.12, 0.12, 0.085, 0.10],
        [-0.02, 0.13, 0.08, 0.09],
        [0.07, 0.13, 0.055, 0.065],
    ]);
    let head = fine.middle(&[
        [0.03, 0.19, 0.03, 0.04],
        [0.08, 0.21, 0.05, 0.055],
        [0.13, 0.20, 0.045, 0.045],
        [0.17, 0.185, 0.015, 0.015],
    ]);
    let ears = fine.pair(&[
        [0.025, 0.07, 0.24, 0.012, 0.012],
        [0.035, 0.05, 0.33, 0.026, 0.014],
        [0.04, 0.03, 0.41, 0.0, 0.0],
    ]);
    let lining = fine.pair(&[
        [0.03, 0.082, 0.26, 0.006, 0.003],
        [0.036, 0.066, 0.33, 0.014, 0.004],
        [0.038, 0.052, 0.38, 0.0, 0.0],
    ]);
    let feet = fine
        .pair(&[[0.06, -0.13, 0.02, 0.025, 0.02], [0.065, 0.03, 0.015, 0.02, 0.015]])
        .with(&fine.pair(&[[0.035, 0.09, 0.0, 0.018, 0.018], [0.035, 0.06, 0.12, 0.025, 0.025]]));
    let tail = Mesh::ball(0.04, 0.0, 5, 3).moved([0.0, -0.19, 0.11]);
    Builder::default()
        .main([0.62, 0.50, 0.38], body.with(&head).with(&ears).with(&feet))
        .fixed(CREAM, tail)
        .fixed(PINK, lining)
        .fixed(DARK, fine.face([0.043, 0.115, 0.225], [0.0, 0.165, 0.19], 0.012))
}

/// White with a red comb.
fn hen(fine: Fine) -> Builder {
    let body = fine.middle(&[
        [-0.15, 0.25, 0.04, 0.06],
        [-0.08, 0.21, 0.09, 0.09],
        [0.02, 0.19, 0.105, 0.10],
        [0.11, 0.22, 0.07, 0.08],
        [0.14, 0.29, 0.04, 0.045],
    ]);
    let head = fine.middle(&[
        [0.12, 0.24, 0.05, 0.05],
        [0.135, 0.33, 0.035, 0.04],
        [0.14, 0.38, 0.035, 0.04],
        [0.14, 0.41, 0.01, 0.015],
    ]);
    let tail = fine.middle(&[
        [-0.10, 0.24, 0.05, 0.05],
        [-0.20, 0.36, 0.045, 0.06],
        [-0.21, 0.41, 0.0, 0.0],
    ]);
    let wings = fine.pair(&[
        [0.095, 0.07, 0.22, 0.015, 0.03],
        [0.115, -0.02, 0.21, 0.02, 0.07],
        [0.09, -0.14, 0.24, 0.0, 0.0],
    ]);
    let comb = Fine::thin(&[
        [0.11, 0.41, 0.008, 0.02],
        [0.15, 0.425, 0.010, 0.028],
        [0.175, 0.39, 0.0, 0.0],
    ]);
    let wattle = Mesh::tube(
        &[([0.0, 0.165, 0.35], [0.012; 2]), ([0.0, 0.165, 0.305], [0.014; 2])],
        3,
    );
    let beak = fine.middle(&[[0.165, 0.375, 0.018, 0.018], [0.215, 0.36, 0.0, 0.0]]);
    let legs = fine
        .pair(&[[0.045, 0.02, 0.0, 0.012, 0.012], [0.045, 0.02, 0.13, 0.014, 0.014]])
        .with(&fine.pair(&[[0.045, -0.02, 0.008, 0.012, 0.008], [0.05, 0.075, 0.008, 0.022, 0.006]]));
    Builder::default()
        .main([0.93, 0.91, 0.86], body.with(&head).with(&tail))
        .fixed([0.74, 0.70, 0.63], wings)
        .fixed([0.82, 0.12, 0.10], comb.with(&wattle))
        .fixed([0.92, 0.66, 0.14], beak.with(&legs))
        .fixed(DARK, fine.face([0.034, 0.15, 0.385], [0.0, 0.14, 0.385], 0.008))
}

/// A ball of wool with a dark face and dark legs.
fn sheep(fine: Fine) -> Builder {
    let wool = fine.middle(&[
        [-0.50, 0.60, 0.15, 0.15],
        [-0.40, 0.60, 0.27, 0.27],
        [-0.10, 0.62, 0.27, 0.25],
        [0.22, 0.62, 0.28, 0.27],
        [0.36, 0.66, 0.16, 0.18],
    ]);
    let wool = if fine == Fine::Whole {
        wool.roughened(0.06, [0.0, 0.0, 0.6], 4)
    } else {
        wool
    };
    let cap = fine.middle(&[
        [0.34, 0.84, 0.08, 0.05],
        [0.42, 0.90, 0.11, 0.07],
        [0.50, 0.88, 0.07, 0.04],
    ]);
    let head = fine.middle(&[
        [0.30, 0.78, 0.10, 0.12],
        [0.44, 0.82, 0.10, 0.11],
        [0.58, 0.74, 0.065, 0.07],
        [0.63, 0.70, 0.03, 0.03],
    ]);
    let ears = fine.pair(&[[0.08, 0.42, 0.85, 0.03, 0.03], [0.20, 0.40, 0.79, 0.0, 0.0]]);
    let legs =
        fine.legs([0.15, 0.22], 0.45, [0.06, 0.04], 0.0)
            .with(&fine.legs([0.15, -0.34], 0.45, [0.06, 0.04], 0.0));
    let tail = fine.middle(&[[-0.48, 0.66, 0.06, 0.06], [-0.56, 0.48, 0.04, 0.04]]);
    Builder::default()
        .main([0.92, 0.90, 0.84], wool.with(&cap).with(&tail))
        .fixed([0.20, 0.17, 0.16], head.with(&ears).with(&legs))
        .fixed(
            [0.95, 0.80, 0.40],
            fine.face([0.085, 0.51, 0.82], [0.0, 0.52, 0.80], 0.02),
        )
}

/// Pink, with a snout.
fn pig(fine: Fine) -> Builder {
    let skin = [0.90, 0.64, 0.60];
    let body = fine.middle(&[
        [-0.58, 0.44, 0.10, 0.12],
        [-0.44, 0.43, 0.22, 0.23],
        [-0.05, 0.41, 0.24, 0.25],
        [0.25, 0.43, 0.22, 0.24],
        [0.38, 0.48, 0.16, 0.18],
    ]);
    let head = fine.middle(&[
        [0.28, 0.50, 0.17, 0.19],
        [0.44, 0.52, 0.15, 0.16],
        [0.55, 0.47, 0.09, 0.09],
        [0.62, 0.45, 0.075, 0.075],
    ]);
    let ears = fine.pair(&[
        [0.10, 0.38, 0.64, 0.05, 0.03],
        [0.15, 0.46, 0.73, 0.04, 0.02],
        [0.14, 0.50, 0.66, 0.0, 0.0],
    ]);
    let snout = fine.middle(&[[0.61, 0.45, 0.085, 0.085], [0.65, 0.45, 0.085, 0.085]]);
    let legs =
        fine.legs([0.13, 0.24], 0.32, [0.075, 0.05], 0.0)
            .with(&fine.legs([0.13, -0.42], 0.32, [0.085, 0.05], 0.0));
    let tail = Fine::thin(&[
        [-0.57, 0.50, 0.02, 0.02],
        [-0.64, 0.56, 0.02, 0.02],
        [-0.60, 0.62, 0.0, 0.0],
    ]);
    Builder::default()
        .main(skin, body.with(&head).with(&legs).with(&tail))
        .fixed([0.80, 0.48, 0.46], ears.with(&snout))
        .fixed(DARK, fine.face([0.09, 0.53, 0.57], [0.0, 0.66, 0.45], 0.022))
}

/// A stag: long legs, neck up, antlers.
fn deer(fine: Fine) -> Builder {
    let coat = [0.60, 0.38, 0.20];
    let body = fine.middle(&[
        [-0.70, 1.08, 0.09, 0.12],
        [-0.50, 1.05, 0.18, 0.22],
        [0.28, 1.02, 0.19, 0.26],
        [0.45, 1.12, 0.12, 0.18],
    ]);
    let neck = fine.middle(&[
        [0.30, 1.12, 0.13, 0.20],
        [0.50, 1.38, 0.09, 0.12],
        [0.62, 1.60, 0.075, 0.09],
    ]);
    let head = fine.middle(&[
        [0.54, 1.66, 0.06, 0.07],
        [0.64, 1.68, 0.085, 0.09],
        [0.80, 1.60, 0.055, 0.06],
        [0.92, 1.55, 0.04, 0.04],
    ]);
    let ears = fine.pair(&[[0.06, 0.58, 1.72, 0.035, 0.02], [0.20, 0.54, 1.78, 0.0, 0.0]]);
    let legs =
        fine.legs([0.12, 0.30], 0.90, [0.075, 0.035], 0.0)
            .with(&fine.legs([0.12, -0.52], 0.95, [0.10, 0.035], -0.05));
    let beams = fine
        .pair(&[
            [0.05, 0.60, 1.74, 0.025, 0.025],
            [0.20, 0.46, 1.98, 0.022, 0.022],
            [0.30, 0.56, 2.28, 0.008, 0.008],
        ])
        .with(&fine.pair(&[[0.09, 0.56, 1.81, 0.02, 0.02], [0.14, 0.76, 1.94, 0.0, 0.0]]))
        .with(&fine.pair(&[[0.21, 0.47, 2.02, 0.02, 0.02], [0.12, 0.62, 2.20, 0.0, 0.0]]));
    let mirror = fine.middle(&[[-0.66, 1.10, 0.10, 0.13], [-0.74, 1.04, 0.07, 0.12]]);
    let tail = Fine::thin(&[[-0.70, 1.16, 0.04, 0.03], [-0.80, 1.02, 0.0, 0.0]]);
    Builder::default()
        .main(coat, body.with(&neck).with(&head).with(&ears).with(&legs).with(&tail))
        .fixed(CREAM, mirror)
        .fixed(HORN, beams)
        .fixed(DARK, fine.face([0.075, 0.70, 1.68], [0.0, 0.92, 1.555], 0.022))
}

/// What dogs and cats have in common: body, neck, legs.
struct Prowler {
    /// From rump to chest.
    body: [[f32; 4]; 4],
    neck: [[f32; 4]; 2],
    /// Half the distance of the legs, y of the front ones, y of the hind ones, their height.
    legs: [f32; 4],
    /// Half widths of thigh and foot.
    leg: [f32; 2],
}

impl Prowler {
    fn torso(&self, fine: Fine) -> Mesh {
        fine.middle(&self.body).with(&fine.middle(&self.neck))
    }

    fn legs(&self, fine: Fine) -> Mesh {
        let [x, front, hind, top] = self.legs;
        let [thigh, foot] = self.leg;
        fine.legs([x, front], top, [thigh * 0.85, foot], 0.0).with(&fine.legs(
            [x, hind],
            top,
            [thigh, foot],
            -0.1 * top,
        ))
    }
}

/// Red, with a long tail whose tip is white.
fn fox(fine: Fine) -> Builder {
    let prowler = Prowler {
        body: [
            [-0.27, 0.33, 0.06, 0.07],
            [-0.18, 0.33, 0.085, 0.09],
            [0.12, 0.33, 0.085, 0.10],
            [0.22, 0.36, 0.06, 0.08],
        ],
        neck: [[0.16, 0.38, 0.07, 0.08], [0.27, 0.47, 0.055, 0.06]],
        legs: [0.055, 0.15, -0.19, 0.30],
        leg: [0.04, 0.02],
    };
    let head = fine.middle(&[
        [0.22, 0.48, 0.055, 0.05],
        [0.29, 0.49, 0.085, 0.065],
        [0.35, 0.465, 0.045, 0.04],
        [0.45, 0.445, 0.012, 0.012],
    ]);
    let ears = fine.pair(&[[0.05, 0.27, 0.52, 0.032, 0.018], [0.062, 0.26, 0.63, 0.0, 0.0]]);
    let brush = fine.middle(&[
        [-0.26, 0.34, 0.03, 0.03],
        [-0.40, 0.27, 0.06, 0.06],
        [-0.55, 0.22, 0.065, 0.065],
    ]);
    let tip = fine.middle(&[[-0.545, 0.222, 0.063, 0.063], [-0.68, 0.19, 0.0, 0.0]]);
    let bib = fine.middle(&[
        [0.225, 0.30, 0.045, 0.05],
        [0.30, 0.43, 0.05, 0.04],
        [0.42, 0.428, 0.01, 0.01],
    ]);
    Builder::default()
        .main(
            [0.82, 0.38, 0.12],
            prowler.torso(fine).with(&head).with(&ears).with(&brush),
        )
        .fixed(CREAM, tip.with(&bib))
        .fixed([0.16, 0.12, 0.11], prowler.legs(fine))
        .fixed(DARK, fine.face([0.05, 0.345, 0.50], [0.0, 0.45, 0.448], 0.012))
}

/// Grey, high on its legs, its tail low.
fn wolf(fine: Fine) -> Builder {
    let prowler = Prowler {
        body: [
            [-0.48, 0.66, 0.10, 0.13],
            [-0.32, 0.66, 0.15, 0.17],
            [0.22, 0.66, 0.17, 0.22],
            [0.40, 0.72, 0.12, 0.17],
        ],
        neck: [[0.26, 0.76, 0.15, 0.18], [0.50, 0.93, 0.11, 0.12]],
        legs: [0.11, 0.26, -0.36, 0.60],
        leg: [0.085, 0.04],
    };
    let head = fine.middle(&[
        [0.42, 0.94, 0.10, 0.09],
        [0.52, 0.97, 0.13, 0.11],
        [0.62, 0.93, 0.07, 0.07],
        [0.80, 0.89, 0.04, 0.04],
    ]);
    let ears = fine.pair(&[[0.075, 0.48, 1.03, 0.045, 0.025], [0.09, 0.47, 1.17, 0.0, 0.0]]);
    let tail = fine.middle(&[
        [-0.46, 0.72, 0.05, 0.05],
        [-0.60, 0.56, 0.075, 0.075],
        [-0.68, 0.36, 0.065, 0.065],
        [-0.70, 0.22, 0.0, 0.0],
    ]);
    let pale = fine
        .middle(&[[0.50, 0.89, 0.075, 0.05], [0.79, 0.865, 0.025, 0.02]])
        .with(&fine.middle(&[[-0.28, 0.56, 0.10, 0.08], [0.30, 0.56, 0.11, 0.11]]));
    Builder::default()
        .main(
            [0.42, 0.43, 0.46],
            prowler.torso(fine).with(&head).with(&ears).with(&tail),
        )
        .fixed([0.74, 0.73, 0.70], pale.with(&prowler.legs(fine)))
        .fixed(DARK, fine.face([0.07, 0.61, 0.975], [0.0, 0.80, 0.90], 0.022))
}

/// Brown, heavy, with round ears and a pale muzzle.
fn bear(fine: Fine) -> Builder {
    let body = fine.middle(&[
        [-0.86, 0.70, 0.18, 0.20],
        [-0.68, 0.72, 0.34, 0.36],
        [-0.15, 0.72, 0.37, 0.36],
        [0.30, 0.80, 0.34, 0.38],
        [0.52, 0.86, 0.22, 0.26],
    ]);
    let head = fine.middle(&[
        [0.40, 0.92, 0.20, 0.22],
        [0.62, 0.98, 0.22, 0.22],
        [0.78, 0.94, 0.15, 0.15],
        [0.86, 0.90, 0.09, 0.09],
    ]);
    let ears = fine.pair(&[
        [0.15, 0.58, 1.14, 0.06, 0.035],
        [0.17, 0.57, 1.25, 0.055, 0.03],
        [0.175, 0.57, 1.28, 0.02, 0.015],
    ]);
    let muzzle = fine.middle(&[[0.78, 0.90, 0.10, 0.09], [0.98, 0.87, 0.065, 0.06]]);
    let legs = fine
        .pair(&[[0.22, 0.36, 0.0, 0.12, 0.15], [0.22, 0.32, 0.60, 0.15, 0.17]])
        .with(&fine.pair(&[[0.22, -0.56, 0.0, 0.12, 0.15], [0.22, -0.60, 0.60, 0.17, 0.20]]));
    let tail = Mesh::ball(0.07, 0.0, 5, 3).moved([0.0, -0.90, 0.82]);
    Builder::default()
        .main([0.36, 0.23, 0.14], body.with(&head).with(&ears).with(&legs).with(&tail))
        .fixed([0.70, 0.54, 0.36], muzzle)
        .fixed(DARK, fine.face([0.12, 0.79, 1.02], [0.0, 0.98, 0.90], 0.032))
}

/// Tawny, with a mane around its head and a tuft on its tail.
fn lion(fine: Fine) -> Builder {
    let prowler = Prowler {
        body: [
            [-0.66, 0.76, 0.13, 0.16],
            [-0.48, 0.76, 0.20, 0.22],
            [0.20, 0.76, 0.22, 0.26],
            [0.42, 0.82, 0.18, 0.22],
        ],
        neck: [[0.30, 0.84, 0.20, 0.22], [0.52, 0.98, 0.16, 0.18]],
        legs: [0.15, 0.30, -0.52, 0.66],
        leg: [0.11, 0.065],
    };
    let mane = fine.middle(&[
        [0.30, 0.88, 0.22, 0.26],
        [0.42, 0.95, 0.34, 0.38],
        [0.60, 1.00, 0.31, 0.33],
        [0.64, 1.00, 0.20, 0.22],
    ]);
    let head = fine.middle(&[
        [0.58, 1.00, 0.17, 0.18],
        [0.74, 1.00, 0.15, 0.15],
        [0.80, 0.95, 0.10, 0.10],
        [0.92, 0.92, 0.085, 0.08],
    ]);
    let ears = fine.pair(&[[0.16, 0.58, 1.24, 0.06, 0.035], [0.19, 0.57, 1.37, 0.0, 0.0]]);
    let tail = Fine::thin(&[[-0.64, 0.82, 0.03, 0.03], [-0.95, 0.44, 0.02, 0.02]]);
    let tuft = Fine::thin(&[
        [-0.92, 0.46, 0.03, 0.03],
        [-0.98, 0.36, 0.06, 0.06],
        [-1.02, 0.26, 0.0, 0.0],
    ]);
    let coat = [0.80, 0.60, 0.30];
    Builder::default()
        .main(
            coat,
            prowler
                .torso(fine)
                .with(&prowler.legs(fine))
                .with(&head)
                .with(&ears)
                .with(&tail),
        )
        .fixed([0.44, 0.24, 0.10], mane.with(&tuft))
        .fixed(DARK, fine.face([0.08, 0.75, 1.05], [0.0, 0.92, 0.95], 0.028))
}

/// Long, low and green, its jaws a little open.
fn crocodile(fine: Fine) -> Builder {
    let body = fine.middle(&[
        [-1.50, 0.08, 0.0, 0.0],
        [-0.90, 0.15, 0.11, 0.11],
        [-0.45, 0.20, 0.23, 0.16],
        [0.10, 0.22, 0.28, 0.17],
        [0.55, 0.22, 0.20, 0.14],
        [0.78, 0.23, 0.17, 0.12],
    ]);
    let upper = fine.middle(&[
        [0.76, 0.27, 0.17, 0.09],
        [0.98, 0.28, 0.14, 0.06],
        [1.50, 0.27, 0.075, 0.035],
    ]);
    let lower = fine.middle(&[[0.76, 0.18, 0.16, 0.05], [1.44, 0.12, 0.07, 0.025]]);
    let brows = fine.pair(&[[0.08, 0.86, 0.34, 0.045, 0.05], [0.08, 0.88, 0.40, 0.03, 0.03]]);
    let legs = fine
        .pair(&[[0.36, 0.44, 0.0, 0.07, 0.08], [0.22, 0.40, 0.22, 0.08, 0.09]])
        .with(&fine.pair(&[[0.38, -0.40, 0.0, 0.07, 0.08], [0.22, -0.40, 0.22, 0.09, 0.11]]));
    let ridge = (0..7).fold(Mesh::default(), |mesh, k| {
        let y = 0.45 - 0.24 * k as f32;
        let z = if k < 4 {
            0.36 - 0.01 * k as f32
        } else {
            0.30 - 0.035 * (k as f32 - 4.0)
        };
        mesh.with(&scale(y, z))
    });
    let teeth = if fine == Fine::Whole {
        [0.98, 1.16, 1.34].into_iter().fold(Mesh::default(), |mesh, y| {
            let x = 0.13 - 0.15 * (y - 0.98);
            mesh.with(&Mesh::cone(0.03, 0.0, 0.07, 3).moved([x, y, 0.16]).on_both_sides())
        })
    } else {
        Mesh::default()
    };
    Builder::default()
        .main([0.28, 0.42, 0.20], body.with(&upper).with(&brows).with(&legs))
        .fixed([0.72, 0.70, 0.48], lower)
        .fixed([0.18, 0.28, 0.14], ridge)
        .fixed(CREAM, teeth)
        .fixed(DARK, fine.face([0.08, 0.90, 0.375], [0.0, 1.50, 0.285], 0.02))
}

/// One scale of a back.
fn scale(y: f32, z: f32) -> Mesh {
    Mesh::cone(0.07, 0.0, 0.10, 3).turned(30.0).moved([0.0, y, z])
}
