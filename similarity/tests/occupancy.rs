//! Compares distances between grids with scipy, scikit-image and POT, and checks their metric properties.

use driftworld_similarity::{
    BitGrid, Grid, GridShape, SimilarityError, grid_chamfer_distance, grid_earth_movers_distance,
    grid_hausdorff_distance, grid_jaccard_distance,
};
use proptest::prelude::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    taken: Vec<Taken>,
    masses: Vec<Masses>,
}

#[derive(Deserialize)]
struct Taken {
    rows: usize,
    columns: usize,
    cell: f64,
    a: Vec<usize>,
    b: Vec<usize>,
    jaccard: f64,
    chamfer: Option<f64>,
    hausdorff: Option<f64>,
}

#[derive(Deserialize)]
struct Masses {
    rows: usize,
    columns: usize,
    cell: f64,
    a: Vec<f64>,
    b: Vec<f64>,
    earth_movers: f64,
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracle/occupancy.json")).expect("the oracle is valid")
}

#[track_caller]
fn check(what: &str, found: Result<f64, SimilarityError>, expected: f64) {
    let found = found.expect("the grids have the same shape");
    let off = (found - expected).abs() / expected.abs().max(1.0);
    assert!(off <= 1e-11, "{what}: {found}, oracle {expected}");
}

#[test]
fn taken_cells_match_scipy_and_scikit_image() {
    for case in oracle().taken {
        let shape = GridShape::new(case.columns, case.rows, 1, case.cell).expect("the shape is valid");
        let grid = |taken: &[usize]| BitGrid::new(shape, (0..shape.num_cells()).map(|cell| taken.contains(&cell)));
        let (a, b) = (grid(&case.a), grid(&case.b));
        check("jaccard", grid_jaccard_distance(&a, &b), case.jaccard);
        // Cases without an oracle: no distances between empty grids, the diameter if one grid is empty.
        let otherwise = if case.a.is_empty() && case.b.is_empty() {
            0.0
        } else {
            shape.diameter()
        };
        check(
            "chamfer",
            grid_chamfer_distance(&a, &b),
            case.chamfer.unwrap_or(otherwise),
        );
        check(
            "hausdorff",
            grid_hausdorff_distance(&a, &b),
            case.hausdorff.unwrap_or(otherwise),
        );
    }
}

#[test]
fn masses_match_scipy_and_pot() {
    let oracle = oracle();
    for case in oracle.masses {
        let shape = GridShape::new(case.columns, case.rows, 1, case.cell).expect("the shape is valid");
        let grid = |masses: Vec<f64>| Grid::new(shape, masses).expect("the masses are valid");
        let (a, b) = (grid(case.a), grid(case.b));
        let (a, b) = (a.normalised(), b.normalised());
        check("earth mover's", grid_earth_movers_distance(&a, &b), case.earth_movers);
    }
}

#[test]
fn mismatched_grids_are_refused() {
    let grid = |columns, mass| {
        let shape = GridShape::new(columns, 1, 1, 1.0).expect("the shape is valid");
        Grid::new(shape, vec![mass; columns]).expect("the mass is valid")
    };
    let differs = grid_jaccard_distance(&grid(2, 1.0).taken(), &grid(3, 1.0).taken()).expect_err("shapes differ");
    assert_eq!(
        differs.to_string(),
        "grids: found 2 × 1 × 1 cells of 1 m and 3 × 1 × 1 cells of 1 m, expected equal shapes; make both with one raster"
    );
    let (light, heavy) = (grid(2, 1.0), grid(2, 1.5));
    let unequal = grid_earth_movers_distance(&light, &heavy).expect_err("masses differ");
    assert_eq!(
        unequal.to_string(),
        "masses: found sums of 2 and 3, expected equal sums; divide each mass by its sum, or use a distance for unequal masses"
    );
    // Following the error's advice works.
    assert_eq!(
        grid_earth_movers_distance(&light.normalised(), &heavy.normalised()),
        Ok(0.0)
    );
}

/// Grids of 4 × 3 cells in two planes, often with an empty plane.
fn grid() -> impl Strategy<Value = Grid> {
    let shape = GridShape::new(4, 3, 2, 2.0).expect("the shape is valid");
    let plane = || prop_oneof![1 => Just(vec![0u8; 12]), 4 => prop::collection::vec(0u8..4, 12)];
    (plane(), plane()).prop_map(move |(a, b)| {
        let masses = a.into_iter().chain(b).map(f64::from).collect();
        Grid::new(shape, masses).expect("the masses are valid")
    })
}

/// Grids with a total of 1 in each plane.
fn full_grid() -> impl Strategy<Value = Grid> {
    let shape = GridShape::new(4, 3, 2, 2.0).expect("the shape is valid");
    prop::collection::vec(0u8..4, 24).prop_map(move |masses| {
        let mut masses: Vec<f64> = masses.into_iter().map(f64::from).collect();
        masses[0] += 1.0;
        masses[12] += 1.0;
        Grid::new(shape, masses).expect("the masses are valid").normalised()
    })
}

type Measure<'a, T> = (&'a str, f64, fn(&T, &T) -> Result<f64, SimilarityError>);

/// Checks that a measure is 0 for equals, symmetric and within the bound; with `c`, also the triangle inequality.
fn check_axioms<T>((name, bound, measure): Measure<T>, a: &T, b: &T, c: Option<&T>) -> Result<(), TestCaseError> {
    let d = |a: &T, b: &T| measure(a, b).map_err(|error| TestCaseError::fail(error.to_string()));
    prop_assert!(d(a, a)?.abs() < 1e-12, "{} of equals: {}", name, d(a, a)?);
    prop_assert!(
        (d(a, b)? - d(b, a)?).abs() < 1e-12,
        "{}: {} and back {}",
        name,
        d(a, b)?,
        d(b, a)?
    );
    prop_assert!((0.0..=bound + 1e-12).contains(&d(a, b)?), "{}: {}", name, d(a, b)?);
    if let Some(c) = c {
        prop_assert!(d(a, c)? <= d(a, b)? + d(b, c)? + 1e-12, "{}: a detour is shorter", name);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn metrics_of_taken_cells_satisfy_the_axioms(a in grid(), b in grid(), c in grid()) {
        let (a, b, c) = (a.taken(), b.taken(), c.taken());
        let diameter = a.shape().diameter();
        let metrics: [Measure<BitGrid>; 2] = [
            ("jaccard", 1.0, grid_jaccard_distance),
            ("hausdorff", diameter, grid_hausdorff_distance),
        ];
        for metric in metrics {
            check_axioms(metric, &a, &b, Some(&c))?;
            prop_assert_eq!(metric.2(&a, &b) == Ok(0.0), a == b, "{}", metric.0);
        }
        check_axioms(("chamfer", diameter, grid_chamfer_distance), &a, &b, None)?;
        prop_assert!(grid_chamfer_distance(&a, &b)? <= grid_hausdorff_distance(&a, &b)? + 1e-12);
    }

    #[test]
    fn metrics_of_equal_masses_satisfy_the_axioms(a in full_grid(), b in full_grid(), c in full_grid()) {
        let bound = 2.0 * a.shape().diameter();
        check_axioms(("earth mover's", bound, grid_earth_movers_distance), &a, &b, Some(&c))?;
    }
}
