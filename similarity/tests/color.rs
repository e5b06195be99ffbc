//! Compares distances between colours with scikit-image and colour-science.

use driftworld_similarity::{ColorMeasure, Lab, cie76, ciede2000, hyab};
use driftworld_spec::Color;
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    sharma: Vec<[f64; 7]>,
    pairs: Vec<Pair>,
}

#[derive(Deserialize)]
struct Pair {
    a: [f64; 3],
    b: [f64; 3],
    lab_a: [f64; 3],
    lab_b: [f64; 3],
    srgb: f64,
    cie76: f64,
    ciede2000: f64,
    hyab: f64,
    oklab: f64,
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracle/color.json")).expect("the oracle is valid")
}

#[test]
fn pairs_published_by_sharma_are_reproduced() {
    for [l1, a1, b1, l2, a2, b2, expected] in oracle().sharma {
        let (a, b) = (Lab([l1, a1, b1]), Lab([l2, a2, b2]));
        for found in [ciede2000(a, b), ciede2000(b, a)] {
            // The published table has four digits.
            assert!(
                (found - expected).abs() < 1e-4,
                "{a:?} to {b:?}: {found}, expected {expected}"
            );
        }
    }
}

#[test]
fn lab_distances_match_the_oracles() {
    for pair in oracle().pairs {
        let (a, b) = (Lab(pair.lab_a), Lab(pair.lab_b));
        for (name, found, expected) in [
            ("cie76", cie76(a, b), pair.cie76),
            ("ciede2000", ciede2000(a, b), pair.ciede2000),
            ("hyab", hyab(a, b), pair.hyab),
        ] {
            assert!(
                (found - expected).abs() < 1e-9,
                "{name} of {a:?} to {b:?}: {found}, expected {expected}"
            );
        }
    }
}

#[test]
fn srgb_distances_match_the_oracles() {
    for pair in oracle().pairs {
        let (a, b) = (Color(pair.a), Color(pair.b));
        for (lab, expected) in [(Lab::from(a), pair.lab_a), (Lab::from(b), pair.lab_b)] {
            let gap = (0..3).map(|k| (lab.0[k] - expected[k]).abs()).fold(0.0, f64::max);
            assert!(gap < 1e-9, "{lab:?}, expected {expected:?}");
        }
        for (measure, expected, tolerance) in [
            (ColorMeasure::Srgb, pair.srgb, 1e-12),
            (ColorMeasure::Cie76, pair.cie76, 1e-9),
            (ColorMeasure::Ciede2000, pair.ciede2000, 1e-9),
            (ColorMeasure::Hyab, pair.hyab, 1e-9),
            // Via XYZ, with matrices of four to ten digits.
            (ColorMeasure::Oklab, pair.oklab, 1e-4),
        ] {
            let found = measure.between(a, b);
            assert!(
                (found - expected).abs() < tolerance,
                "{measure:?} of {a:?} to {b:?}: {found}, expected {expected}"
            );
        }
    }
}
