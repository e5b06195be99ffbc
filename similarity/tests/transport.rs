//! Compares the transport of masses and points with POT.

use driftworld_similarity::{earth_movers_distance, optimal_transport};
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    plans: Vec<Masses>,
    points: Vec<Points>,
}

#[derive(Deserialize)]
struct Masses {
    description: String,
    from: Vec<f64>,
    to: Vec<f64>,
    costs: Vec<f64>,
    cost: f64,
}

#[derive(Deserialize)]
struct Points {
    a: Vec<[f64; 2]>,
    b: Vec<[f64; 2]>,
    earth_movers: f64,
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracle/transport.json")).expect("the oracle is valid")
}

#[track_caller]
fn check(what: &str, found: f64, expected: f64, within: f64) {
    let off = (found - expected).abs() / expected.abs().max(1.0);
    assert!(off <= within, "{what}: {found}, oracle {expected}");
}

#[test]
fn plan_costs_match_pot() {
    let plans = oracle().plans;
    assert!(plans.len() > 30);
    for case in plans {
        let plan = optimal_transport(&case.from, &case.to, &case.costs).expect("the masses are valid");
        check(&case.description, plan.cost, case.cost, 1e-12);
    }
}

#[test]
fn point_distances_match_pot() {
    for case in oracle().points {
        let found = earth_movers_distance(&case.a, &case.b).expect("the points are valid");
        check("earth mover's", found, case.earth_movers, 1e-12);
    }
}
