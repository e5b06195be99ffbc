//! Distances between colours and between sets of colours.

pub(crate) mod cie76;
pub(crate) mod ciede2000;
pub(crate) mod hyab;
pub(crate) mod lab;
pub(crate) mod measure;
pub(crate) mod sets;
pub(crate) mod srgb;

fn euclidean(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    (x * x + y * y + z * z).sqrt()
}
