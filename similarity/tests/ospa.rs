//! Compares OSPA with its formula applied to scipy's assignment.

use driftworld_similarity::ospa;
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    cut_off: f64,
    /// Class, x, y.
    a: Vec<(u32, f64, f64)>,
    b: Vec<(u32, f64, f64)>,
    ospa: f64,
}

#[test]
fn distances_match_the_formula() {
    let oracle: Oracle = serde_json::from_str(include_str!("oracle/ospa.json")).expect("the oracle is valid");
    assert!(oracle.cases.len() > 40);
    for case in oracle.cases {
        let objects = |of: &[(u32, f64, f64)]| -> Vec<_> { of.iter().map(|&(class, x, y)| (class, [x, y])).collect() };
        let (a, b) = (objects(&case.a), objects(&case.b));
        let found = ospa(&a, &b, case.cut_off).expect("the objects are valid");
        assert!(
            (found - case.ospa).abs() <= 1e-9 * case.ospa.max(1.0),
            "{} and {} objects, cut-off {}: {found}, expected {}",
            a.len(),
            b.len(),
            case.cut_off,
            case.ospa
        );
    }
}
