//! Compares structural similarities with scikit-image.

use driftworld_similarity::picture::{Picture, structural_similarity};
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    height: usize,
    width: usize,
    a: (String, usize),
    b: (String, usize),
    similarity: f64,
}

/// The same bytes as `picture` of `oracle/make_ssim.py`.
fn picture((kind, seed): &(String, usize), height: usize, width: usize) -> Vec<u8> {
    let mut rgb = Vec::with_capacity(height * width * 3);
    for row in 0..height {
        for column in 0..width {
            for channel in 0..3 {
                let value = match kind.as_str() {
                    "stripes" => (column * (seed + 3) + channel * 40) % 256,
                    "checks" => (row / (seed + 2) + column / (seed + 2)) % 2 * 200 + channel * 10,
                    "noise" => {
                        let key = row * 7919 + column * 104_729 + channel * 1_299_709 + seed * 15_485_863;
                        key * 2_654_435_761 % (1 << 32) / (1 << 24)
                    }
                    _ => *seed,
                };
                rgb.push(u8::try_from(value).expect("every rule gives bytes"));
            }
        }
    }
    rgb
}

#[test]
fn similarities_match_scikit_image() {
    let oracle: Oracle = serde_json::from_str(include_str!("oracle/ssim.json")).expect("the oracle is valid");
    assert!(oracle.cases.len() > 100);
    for case in oracle.cases {
        let (a, b) = (
            picture(&case.a, case.height, case.width),
            picture(&case.b, case.height, case.width),
        );
        let view = |rgb| Picture::new(rgb, case.height, case.width).expect("the size is valid");
        let found = structural_similarity(view(&a), view(&b)).expect("the sizes are valid");
        assert!(
            (found - case.similarity).abs() < 1e-9,
            "{:?} and {:?}, {} × {}: {found}, scikit-image {}",
            case.a,
            case.b,
            case.height,
            case.width,
            case.similarity
        );
    }
}
