//! OSPA and GOSPA against their formulas around scipy's assignment. The laws are tested beside the code.

use driftworld_similarity::Ospa;
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    cut_off: f64,
    order: f64,
    /// Class, x, y.
    a: Vec<(u32, f64, f64)>,
    b: Vec<(u32, f64, f64)>,
    ospa: f64,
    gospa: f64,
}

#[test]
fn distances_are_those_of_the_formulas() {
    let oracle: Oracle = serde_json::from_str(include_str!("oracle/ospa.json")).expect("the oracle is sound");
    assert!(oracle.cases.len() > 40);
    for case in oracle.cases {
        let objects = |of: &[(u32, f64, f64)]| -> Vec<_> { of.iter().map(|&(class, x, y)| (class, [x, y])).collect() };
        let (a, b) = (objects(&case.a), objects(&case.b));
        let ospa = Ospa::new(case.cut_off, case.order).expect("they are within bounds");
        let mean = ospa.between_objects(&a, &b).expect("the objects are sound");
        let total = ospa.total_between_objects(&a, &b).expect("the objects are sound");
        for (name, found, expected) in [("OSPA", mean, case.ospa), ("GOSPA", total, case.gospa)] {
            assert!(
                (found - expected).abs() <= 1e-9 * expected.max(1.0),
                "{name} of {} and {} objects, cut-off {}, order {}: {found}, expected {expected}",
                a.len(),
                b.len(),
                case.cut_off,
                case.order
            );
        }
    }
}
