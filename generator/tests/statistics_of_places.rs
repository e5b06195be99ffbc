//! Objects are placed according to the declared law. Numbers are tested in `statistics.rs`.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use driftworld_generator::Sampler;
use driftworld_spec::{Distribution, TaskSpec, World};

/// Samples of a group that keeps no distances, in an arena wide enough for all.
fn sampler(placement: &str, count: u32, more: &str) -> (Sampler, Distribution) {
    let text = format!(
        r#"{{ "version": 2, "name": "places", "world": {{ "environment_params": {{ "map_size": [300, 300] }} }},
            "groups": [{{ "name": "g", "count": {count}, "object": {{ "class": "cube" }}, "placement": {placement},
                          "keep_out": {{ "walls": 0, "agent": 0 }} {more} }}] }}"#
    );
    let task = TaskSpec::from_json("places.json", &text).unwrap_or_else(|error| panic!("{error}"));
    let variant = task.variant("default").expect("it is always there");
    let law = variant.settle(match &task.groups()[0].spec.placement {
        driftworld_spec::Source::Distribution(distribution) => distribution,
        _ => panic!("the placements here are written out"),
    });
    (Sampler::new(&variant, 7), law)
}

fn world(sampler: &Sampler, index: u64) -> World {
    sampler.world(index).unwrap_or_else(|error| panic!("{error}"))
}

/// The places of all objects in 200 worlds of 50 objects each.
fn places(placement: &str) -> (Vec<[f64; 2]>, Distribution) {
    let (sampler, law) = sampler(placement, 50, "");
    let worlds = (0..200).map(|index| world(&sampler, index));
    (
        worlds
            .flat_map(|world| world.into_draft().objects.into_iter().map(|object| object.coordinates))
            .collect(),
        law,
    )
}

#[track_caller]
fn check_moments(placement: &str) {
    let (places, law) = places(placement);
    let n = places.len() as f64;
    let expected = law.planar_moments().expect("it draws points");
    let mean = [0, 1].map(|axis| places.iter().map(|place| place[axis]).sum::<f64>() / n);
    for axis in 0..2 {
        let error = (expected.covariance[axis][axis] / n).sqrt();
        assert!(
            (mean[axis] - expected.mean[axis]).abs() <= 5.0 * error + 1e-9,
            "{placement}: mean {mean:?}, expected {expected:?}"
        );
    }
    for (i, j) in [(0, 0), (0, 1), (1, 1)] {
        let deviation = |place: &[f64; 2], axis: usize| place[axis] - expected.mean[axis];
        let products: Vec<f64> = places
            .iter()
            .map(|place| deviation(place, i) * deviation(place, j))
            .collect();
        let found = products.iter().sum::<f64>() / n;
        let error = (products.iter().map(|p| (p - found) * (p - found)).sum::<f64>() / n / n).sqrt();
        let wanted = expected.covariance[i][j];
        assert!(
            (found - wanted).abs() <= 5.0 * error + 1e-9,
            "{placement}: covariance {i}{j} {found}, expected {wanted}"
        );
    }
}

#[test]
fn places_have_the_moments_of_their_law() {
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

/// Chi-square test of places over cells of equal probability; the bound is five standard deviations above the mean.
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
fn boxes_discs_and_rings_are_filled_evenly() {
    let (places_of_box, _) = places(r#"{ "box": { "low": [0, 0], "high": [80, 40] } }"#);
    let cells: Vec<usize> = places_of_box
        .iter()
        .map(|[x, y]| (x / 10.0) as usize * 4 + (y / 10.0) as usize)
        .collect();
    check_cells("box", &cells, 32);
    // Eight rings of equal area times eight sectors.
    for (placement, inner) in [
        (r#"{ "disc": { "center": [0, 0], "radius": 50 } }"#, 0.0_f64),
        (r#"{ "annulus": { "center": [0, 0], "inner": 30, "outer": 50 } }"#, 30.0),
    ] {
        let cells: Vec<usize> = places(placement)
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
fn lists_and_grids_are_taken_in_turn() {
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
fn poisson_discs_keep_distance_within_the_group_only() {
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
fn counts_around_each_object_follow_their_law_and_placements_rotate_with_it() {
    let text = r#"{ "version": 2, "name": "around", "world": { "environment_params": { "map_size": [300, 300] } }, "groups": [
        { "name": "houses", "count": 20, "object": { "class": "building" }, "facing": "random",
          "placement": { "box": { "low": [-120, -120], "high": [120, 120] } } },
        { "name": "flags", "count": { "binomial": { "n": 3, "p": 0.4 } }, "around": "houses", "turned": true,
          "object": { "class": "fence" }, "placement": { "points": { "values": [[0, 5], [0, 6], [0, 7]] } },
          "keep_out": { "walls": 0, "agent": 0 } } ] }"#;
    let task = TaskSpec::from_json("around.json", text).unwrap_or_else(|error| panic!("{error}"));
    let sampler = Sampler::new(&task.variant("default").expect("it is always there"), 3);
    let (mut houses, mut flags) = (0, [0_u32; 4]);
    for index in 0..100 {
        let world = world(&sampler, index);
        let (around, middle): (Vec<_>, Vec<_>) = world
            .objects
            .iter()
            .partition(|object| object.tag.as_deref() == Some("flags"));
        let mut rest = &around[..];
        for house in middle {
            houses += 1;
            // In front of the house: 5, 6 and 7 m along its heading, which grows clockwise from north.
            let ahead = |metres: f64| {
                let angle = house.heading.to_radians();
                [
                    house.coordinates[0] + metres * angle.sin(),
                    house.coordinates[1] + metres * angle.cos(),
                ]
            };
            let own = rest
                .iter()
                .zip([5.0, 6.0, 7.0])
                .take_while(|(flag, metres)| {
                    let [x, y] = ahead(*metres);
                    (flag.coordinates[0] - x).hypot(flag.coordinates[1] - y) < 1e-9
                })
                .count();
            flags[own] += 1;
            rest = &rest[own..];
        }
        assert!(rest.is_empty(), "every flag stands ahead of its house");
    }
    let odds = [0.216, 0.432, 0.288, 0.064];
    for (found, odds) in flags.iter().zip(odds) {
        let expected = f64::from(houses) * odds;
        let error = (expected * (1.0 - odds)).sqrt();
        assert!(
            (f64::from(*found) - expected).abs() < 5.0 * error,
            "{flags:?} of {houses}"
        );
    }
}
