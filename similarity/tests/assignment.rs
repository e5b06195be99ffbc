//! Compares the sums of assignments with scipy's.

use driftworld_similarity::Assignment;
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    description: String,
    rows: usize,
    columns: usize,
    costs: Vec<f64>,
    total: f64,
}

#[test]
fn sums_match_scipy() {
    let oracle: Oracle = serde_json::from_str(include_str!("oracle/assignment.json")).expect("the oracle is valid");
    assert!(oracle.cases.len() > 40);
    let mut assignment = Assignment::new();
    for case in oracle.cases {
        let total = assignment
            .solve(&case.costs, case.rows, case.columns)
            .expect("the costs are valid");
        assert!(
            (total - case.total).abs() <= 1e-9 * case.total.abs().max(1.0),
            "{}: {total}, scipy {}",
            case.description,
            case.total
        );
    }
}
