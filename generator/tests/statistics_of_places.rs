//! Tests that the positions of objects follow the declared placement. `statistics.rs` tests numbers.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use driftworld_generator::Sampler;
use driftworld_spec::{Distribution, TaskSpec, World};

/// A sampler of a group without minimum distances, in an arena with room for all objects, and its placement.
fn sampler(placement: &str, count: u32, more: &str) -> (Sampler, Distribution) {
    let text = format!(
        r#"{{ "version": 2, "name": "places", "world": {{ "environment_params": {{ "map_size": [300, 300] }} }},
            "groups": [{{ "name": "g", "count": {count}, "object": {{ "class": "cube" }}, "placement": {placement},
                          "keep_out": {{ "walls": 0, "agent": 0 }} {more} }}] }}"#
    );
    let task = TaskSpec::from_json("places.json", &text).unwrap_or_else(|error| panic!("{error}"));
    let variant = task.variant("default").expect("it always exists");
    let declared = variant.settle(match &task.groups()[0].spec.placement {
        driftworld_spec::Source::Distribution(distribution) => distribution,
        _ => panic!("these placements are written out, not parameters"),
    });
    (Sampler::new(&variant, 7), declared)
}

fn world(sampler: &Sampler, index: u64) -> World {
    sampler.world(index).unwrap_or_else(|error| panic!("{error}"))
}

/// The positions of all objects in 200 worlds of 50 objects each, and their placement.
fn positions(placement: &str) -> (Vec<[f64; 2]>, Distribution) {
    let (sampler, declared) = sampler(placement, 50, "");
    let worlds = (0..200).map(|index| world(&sampler, index));
    (
        worlds
            .flat_map(|world| world.into_draft().objects.into_iter().map(|object| object.coordinates))
            .collect(),
        declared,
    )
}

#[track_caller]
fn check_moments(placement: &str) {
    let (positions, declared) = positions(placement);
    let n = positions.len() as f64;
    let expected = declared.planar_moments().expect("placements draw points");
    let mean = [0, 1].map(|axis| positions.iter().map(|position| position[axis]).sum::<f64>() / n);
    for axis in 0..2 {
        let error = (expected.covariance[axis][axis] / n).sqrt();
        assert!(
            (mean[axis] - expected.mean[axis]).abs() <= 5.0 * error + 1e-9,
            "{placement}: mean {mean:?}, expected {expected:?}"
        );
    }
    for (i, j) in [(0, 0), (0, 1), (1, 1)] {
        let deviation = |position: &[f64; 2], axis: usize| position[axis] - expected.mean[axis];
        let products: Vec<f64> = positions
            .iter()
            .map(|position| deviation(position, i) * deviation(position, j))
            .collect();
        let found = products.iter().sum::<f64>() / n;
        let error = (products.iter().map(|p| (p - found) * (p - found)).sum::<f64>() / n / n).sqrt();
        let covariance = expected.covariance[i][j];
        assert!(
            (found - covariance).abs() <= 5.0 * error + 1e-9,
            "{placement}: covariance {i}{j} {found}, expected {covariance}"
        );
    }
}

#[test]
fn positions_have_the_moments_of_their_placement() {
    for placement in [
        r#"{ "box": { "low": [-40, 0], "high": [80, 10] } }"#,
        r#"{ "disc": { "center": [5, -5], "radius": 30 } }"#,
        r#"{ "annulus": { "center": [0, 0], "inner": 20, "outer": 30 } }"#,
        r#"{ "gaussian": { "mean": [3, 4], "std": 12 } }"#,
        r#"{ "gaussian": { "mean": [3, 4], "std": [20, 5], "correlation": -0.7 } }"#,
        r#"{ "gaussian": { "mean": [0, 0], "covariance": [[100, 30], [30, 25]] } }"#,
        r#"{ "points": { "values": [[0, 0], [10, 0], [0, 40]], "order": "random" } }"#,
        r#"{ "grid": { "low": [0, 0], "high": [60, 20], "columns": 6, "rows": 4, "order": "random" } }"#,
        r#"{ "grid": { "low": [0, 0], "high": [60, 20], "columns": 6, "rows": 4, "jitter": 0.8, "order": "random" } }"#,
        r#"{ "mixture": { "parts": [{ "disc": { "center": [-20, 0], "radius": 5 } }, { "box": { "low": [10, 10], "high": [20, 30] } }], "weights": [1, 2] } }"#,
    ] {
        check_moments(placement);
    }
}

/// Chi-square test of positions over cells of equal probability. The bound lies five standard deviations above the mean.
fn check_cells(name: &str, cells: &[usize], count: usize) {
    let expected = cells.len() as f64 / count as f64;
    let mut found = vec![0.0; count];
    for cell in cells {
        found[*cell] += 1.0;
    }
    let statistic: f64 = found.iter().map(|n| (n - expected) * (n - expected) / expected).sum();
    let degrees = count as f64 - 1.0;
    assert!(
        statistic < degrees + 5.0 * (2.0 * degrees).sqrt(),
        "{name}: {statistic} over {count} cells"
    );
}

#[test]
fn positions_in_boxes_discs_and_rings_are_uniform() {
    let (positions_in_box, _) = positions(r#"{ "box": { "low": [0, 0], "high": [80, 40] } }"#);
    let cells: Vec<usize> = positions_in_box
        .iter()
        .map(|[x, y]| (x / 10.0) as usize * 4 + (y / 10.0) as usize)
        .collect();
    check_cells("box", &cells, 32);
    // Divides the area into eight rings of equal area by eight sectors.
    for (placement, inner) in [
        (r#"{ "disc": { "center": [0, 0], "radius": 50 } }"#, 0.0_f64),
        (r#"{ "annulus": { "center": [0, 0], "inner": 30, "outer": 50 } }"#, 30.0),
    ] {
        let cells: Vec<usize> = positions(placement)
            .0
            .iter()
            .map(|[x, y]| {
                let ring = (x * x + y * y - inner * inner) / (2500.0 - inner * inner) * 8.0;
                let sector = y.atan2(*x).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU * 8.0;
                (ring as usize).min(7) * 8 + (sector as usize).min(7)
            })
            .collect();
        check_cells(placement, &cells, 64);
    }
}

#[test]
fn points_and_grid_cells_are_taken_in_turn() {
    let (points, _) = sampler(r#"{ "points": { "values": [[0, 0], [10, 0], [0, 40]] } }"#, 5, "");
    let found: Vec<[f64; 2]> = world(&points, 9)
        .objects
        .iter()
        .map(|object| object.coordinates)
        .collect();
    assert_eq!(found, [[0.0, 0.0], [10.0, 0.0], [0.0, 40.0], [0.0, 0.0], [10.0, 0.0]]);
    let (grid, _) = sampler(
        r#"{ "grid": { "low": [0, 0], "high": [30, 20], "columns": 3, "rows": 2, "jitter": 1 } }"#,
        6,
        "",
    );
    for index in 0..50 {
        let cells: Vec<usize> = world(&grid, index)
            .objects
            .iter()
            .map(|object| (object.coordinates[0] / 10.0) as usize + 3 * (object.coordinates[1] / 10.0) as usize)
            .collect();
        assert_eq!(
            cells,
            [0, 1, 2, 3, 4, 5],
            "each cell once, row by row from the south-west"
        );
    }
}

#[test]
fn poisson_disc_keeps_distance_within_its_group() {
    let (discs, _) = sampler(
        r#"{ "poisson_disc": { "low": [-50, -50], "high": [50, 50], "distance": 8 } }"#,
        60,
        "",
    );
    for index in 0..20 {
        let world = world(&discs, index);
        for (k, a) in world.objects.iter().enumerate() {
            for b in &world.objects[..k] {
                let gap = (a.coordinates[0] - b.coordinates[0]).hypot(a.coordinates[1] - b.coordinates[1]);
                assert!(gap >= 8.0, "{index}: {gap}");
            }
        }
    }
    let (crowd, _) = sampler(
        r#"{ "poisson_disc": { "low": [0, 0], "high": [10, 10], "distance": 8 } }"#,
        9,
        "",
    );
    let error = crowd.world(0).expect_err("nine do not fit").to_string();
    assert!(
        error.contains("another object of the group") && error.contains("distance of poisson_disc"),
        "{error}"
    );
}

#[test]
fn counts_around_objects_follow_their_distribution_and_placements_rotate() {
    let text = r#"{ "version": 2, "name": "around", "world": { "environment_params": { "map_size": [300, 300] } }, "groups": [
        { "name": "houses", "count": 20, "object": { "class": "building" }, "facing": "random",
          "placement": { "box": { "low": [-120, -120], "high": [120, 120] } } },
        { "name": "flags", "count": { "binomial": { "n": 3, "p": 0.4 } }, "around": "houses", "turned": true,
          "object": { "class": "fence" }, "placement": { "points": { "values": [[0, 5], [0, 6], [0, 7]] } },
          "keep_out": { "walls": 0, "agent": 0 } } ] }"#;
    let task = TaskSpec::from_json("around.json", text).unwrap_or_else(|error| panic!("{error}"));
    let sampler = Sampler::new(&task.variant("default").expect("it always exists"), 3);
    let (mut num_houses, mut histogram) = (0, [0_u32; 4]);
    for index in 0..100 {
        let world = world(&sampler, index);
        let (flags_of_world, houses_of_world): (Vec<_>, Vec<_>) = world
            .objects
            .iter()
            .partition(|object| object.tag.as_deref() == Some("flags"));
        let mut remaining = &flags_of_world[..];
        for house in houses_of_world {
            num_houses += 1;
            // The flags stand 5, 6 and 7 m ahead of the house. Headings grow clockwise from north.
            let ahead = |metres: f64| {
                let angle = house.heading.to_radians();
                [
                    house.coordinates[0] + metres * angle.sin(),
                    house.coordinates[1] + metres * angle.cos(),
                ]
            };
            let count = remaining
                .iter()
                .zip([5.0, 6.0, 7.0])
                .take_while(|(flag, metres)| {
                    let [x, y] = ahead(*metres);
                    (flag.coordinates[0] - x).hypot(flag.coordinates[1] - y) < 1e-9
                })
                .count();
            histogram[count] += 1;
            remaining = &remaining[count..];
        }
        assert!(remaining.is_empty(), "every flag stands ahead of its house");
    }
    let probabilities = [0.216, 0.432, 0.288, 0.064];
    for (found, probability) in histogram.iter().zip(probabilities) {
        let expected = f64::from(num_houses) * probability;
        let error = (expected * (1.0 - probability)).sqrt();
        assert!(
            (f64::from(*found) - expected).abs() < 5.0 * error,
            "{histogram:?} of {num_houses}"
        );
    }
}
