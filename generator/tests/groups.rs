//! Tests groups around each other, with their distances and headings, and requirements, sequences and maps from files.
//! `statistics_of_places.rs` tests the statistics of positions.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use std::sync::Arc;

use driftworld_generator::{GeneratorError, Sampler, Sequence, sample};
use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{Object, TaskSpec, Value, World};

use crate::reference_data::reference;

fn load(text: &str) -> Arc<TaskSpec> {
    TaskSpec::from_json("task.json", text).unwrap_or_else(|error| panic!("{error}"))
}

fn sampler(task: &Arc<TaskSpec>, seed: u64) -> Sampler {
    Sampler::new(
        &task.variant("default").expect("the defaults meet every requirement"),
        seed,
    )
}

fn world(task: &Arc<TaskSpec>, index: u64) -> World {
    sampler(task, 7).world(index).unwrap_or_else(|error| panic!("{error}"))
}

fn tagged<'a>(world: &'a World, tag: &str) -> Vec<&'a Object> {
    world
        .objects
        .iter()
        .filter(|object| object.tag.as_deref() == Some(tag))
        .collect()
}

fn distance(a: &Object, b: &Object) -> f64 {
    (a.coordinates[0] - b.coordinates[0]).hypot(a.coordinates[1] - b.coordinates[1])
}

/// A task with houses surrounded by fences that face them, trees that keep away from the houses, rocks that face the nearest
/// tree, and bags that face the agent.
fn village(fences: &str) -> Arc<TaskSpec> {
    load(&format!(
        r#"{{ "version": 2, "name": "village", "groups": [
          {{ "name": "houses", "count": 4, "object": {{ "class": "building" }}, "separation": 30, "facing": "random",
             "placement": {{ "box": {{ "low": [-45, -45], "high": [45, 45] }} }} }},
          {{ "name": "fences", "count": {fences}, "around": "houses", "facing": "middle", "object": {{ "class": "fence" }},
             "placement": {{ "annulus": {{ "center": [0, 0], "inner": 6, "outer": 9 }} }}, "separation": 1,
             "keep_out": {{ "walls": 0, "agent": 0 }} }},
          {{ "name": "trees", "count": 20, "object": {{ "class": "tree" }}, "facing": {{ "point": [50, 50] }},
             "placement": {{ "box": {{ "low": [-49, -49], "high": [49, 49] }} }}, "keep_out": {{ "groups": {{ "houses": 12 }} }} }},
          {{ "name": "rocks", "count": 10, "object": {{ "class": "rock" }}, "facing": {{ "group": "trees" }},
             "placement": {{ "disc": {{ "center": [0, 0], "radius": 45 }} }} }},
          {{ "name": "bags", "count": 3, "object": {{ "class": "bag" }}, "facing": "agent",
             "placement": {{ "disc": {{ "center": [0, 0], "radius": 45 }} }} }} ] }}"#
    ))
}

/// Absolute difference between an object's heading and the direction to a point, in degrees.
fn heading_error(object: &Object, point: [f64; 2]) -> f64 {
    let [x, y] = object.coordinates;
    let expected = (point[0] - x).atan2(point[1] - y).to_degrees();
    ((object.heading - expected + 180.0).rem_euclid(360.0) - 180.0).abs()
}

#[test]
fn groups_around_others_keep_their_distances_and_headings() {
    for index in 0..50 {
        let world = world(&village("3"), index);
        let (houses, trees) = (tagged(&world, "houses"), tagged(&world, "trees"));
        for (number, fence) in tagged(&world, "fences").into_iter().enumerate() {
            let house = houses[number / 3];
            assert!(
                (6.0..=9.0).contains(&distance(fence, house)),
                "{index}: {}",
                distance(fence, house)
            );
            assert!(heading_error(fence, house.coordinates) < 1e-6);
        }
        for tree in &trees {
            assert!(houses.iter().all(|house| distance(tree, house) >= 12.0));
            assert!(heading_error(tree, [50.0, 50.0]) < 1e-6);
        }
        for rock in tagged(&world, "rocks") {
            let nearest = trees
                .iter()
                .min_by(|a, b| distance(rock, a).total_cmp(&distance(rock, b)));
            assert!(heading_error(rock, nearest.expect("there are trees").coordinates) < 1e-6);
        }
        assert!(
            tagged(&world, "bags")
                .into_iter()
                .all(|bag| heading_error(bag, [0.0, 0.0]) < 1e-6)
        );
    }
}

#[test]
fn one_more_object_around_each_anchor_moves_no_other_object() {
    let (few, more) = (world(&village("3"), 5), world(&village("4"), 5));
    let first_fences = |world: &World, house: usize, count: usize| -> Vec<Object> {
        let fences = tagged(world, "fences");
        fences[house * count..house * count + 3]
            .iter()
            .map(|fence| (*fence).clone())
            .collect()
    };
    for house in 0..4 {
        assert_eq!(first_fences(&few, house, 3), first_fences(&more, house, 4));
    }
}

#[test]
fn group_around_an_unknown_group_is_refused_with_known_names() {
    let error = TaskSpec::from_json(
        "t.json",
        r#"{ "name": "t", "version": 2, "groups": [
          { "name": "houses", "count": 1, "object": { "class": "building" }, "placement": { "disc": { "center": [0, 0], "radius": 5 } } },
          { "name": "fences", "count": 1, "around": "house", "object": { "class": "fence" },
            "placement": { "disc": { "center": [0, 0], "radius": 5 } } } ] }"#,
    )
    .expect_err("there is no group named house");
    insta::assert_snapshot!(error);
}

const SIZES: &str = r#"{ "version": 2, "name": "sizes", "parameters": {
    "low": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high": 1 } } },
    "high": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high": 1 } } },
    "gap": { "role": "variant", "type": "number", "affects": ["S"], "range": [0, 2], "default": 0.5 } },
  "require": ["low + gap < high"],
  "variants": { "possible": {}, "impossible": { "gap": 1.5 } } }"#;

#[test]
fn worlds_that_break_a_requirement_are_redrawn_and_the_others_unchanged() {
    let task = load(SIZES);
    let free = load(&SIZES.replace(r#""require": ["low + gap < high"],"#, ""));
    let (restricted, free) = (sampler(&task, 7), sampler(&free, 7));
    let mut unchanged = 0;
    for index in 0..500 {
        let number = |values: &[(&str, Value)], position: usize| values[position].1.as_number().expect("a number");
        let values = restricted
            .values(index)
            .expect("one in eight draws meets the requirement");
        assert!(number(&values, 0) + 0.5 < number(&values, 1), "{index}");
        let first_draw = free.values(index).expect("no requirements");
        if number(&first_draw, 0) + 0.5 < number(&first_draw, 1) {
            assert_eq!(
                values, first_draw,
                "{index}: a first draw that meets the requirement is kept"
            );
            unchanged += 1;
        }
    }
    assert!((30..100).contains(&unchanged), "about one in eight: {unchanged}");
}

#[test]
fn a_requirement_that_never_holds_is_an_error_with_the_last_values() {
    let task = load(SIZES);
    let impossible = task
        .variant("impossible")
        .expect("loading cannot detect it, as the values are random");
    let error = sample(&impossible, 7, 0).expect_err("the gap is wider than the range");
    assert!(matches!(error, GeneratorError::Requirement { .. }));
    insta::assert_snapshot!(error);
}

const SPREAD: &str = r#"{ "version": 2, "name": "spread", "parameters": {
    "light": { "role": "randomized", "type": "number", "affects": ["O"], "distribution": { "uniform": { "low": 0, "high": 4 } } },
    "look": { "role": "randomized", "type": "heading", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high": 360 } } },
    "start": { "role": "randomized", "type": "point", "affects": ["S"], "distribution": { "box": { "low": [0, 0], "high": [16, 16] } } },
    "model": { "role": "randomized", "type": "string", "affects": ["S"], "distribution": { "choice": { "values": ["1", "2"] } } } } }"#;

/// Number of worlds in each of `count` bins.
fn histogram(
    sampler: &Sampler,
    worlds: std::ops::Range<u64>,
    bin_of: impl Fn(&[(&str, Value)]) -> usize,
    count: usize,
) -> Vec<usize> {
    let mut bins = vec![0; count];
    for index in worlds {
        bins[bin_of(&sampler.values(index).expect("no requirements"))] += 1;
    }
    bins
}

#[test]
fn sequences_spread_numbers_and_points_evenly_with_random_access() {
    let task = load(SPREAD);
    let light = |values: &[(&str, Value)]| (values[0].1.as_number().expect("it is a number") * 16.0) as usize;
    let cell = |values: &[(&str, Value)]| match values[2].1 {
        Value::Point([x, y]) => (x as usize / 4) * 4 + y as usize / 4,
        _ => usize::MAX,
    };
    let sobol = sampler(&task, 3).with_sequence(Sequence::Sobol);
    assert_eq!(histogram(&sobol, 64..128, light, 64), vec![1; 64]);
    assert_eq!(
        histogram(&sobol, 0..64, cell, 16),
        vec![4; 16],
        "points are spread over both coordinates together"
    );
    let cube = sampler(&task, 3).with_sequence(Sequence::LatinHypercube { first: 10, count: 64 });
    assert_eq!(histogram(&cube, 10..74, light, 64), vec![1; 64]);
    let independent = sampler(&task, 3);
    assert_ne!(histogram(&independent, 64..128, light, 64), vec![1; 64]);
    // Choices are not numeric, so they are drawn independently.
    let model = |sampler: &Sampler, index| sampler.values(index).expect("no requirements")[3].1.clone();
    assert!((0..64).all(|index| model(&sobol, index) == model(&independent, index)));
    let repeated = sampler(&task, 3).with_sequence(Sequence::Sobol);
    assert_eq!(
        repeated.values(100).expect("no requirements"),
        sobol.values(100).expect("no requirements")
    );
    assert_ne!(
        sampler(&task, 4)
            .with_sequence(Sequence::Sobol)
            .values(100)
            .expect("no requirements"),
        sobol.values(100).expect("no requirements")
    );
}

/// Winding number of a polygon around a point, summed from angles as an independent oracle. It is odd inside, even if the
/// polygon touches itself.
fn winding_number(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    let angles = polygon.iter().zip(next).map(|(a, b)| {
        let angle = (b[1] - y).atan2(b[0] - x) - (a[1] - y).atan2(a[0] - x);
        (angle + 9.0 * std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI
    });
    angles.sum::<f64>() / std::f64::consts::TAU
}

#[test]
fn maps_file_replaces_built_in_layouts_and_keeps_its_regions_free() {
    let Some(path) = reference("l2explorer/predefined_maps.json") else {
        return;
    };
    let text = std::fs::read_to_string(path).expect("the original's maps are text");
    let maps = Arc::new(MapLibrary::from_json("maps.json", &text).unwrap_or_else(|error| panic!("{error}")));
    let task = load(
        r#"{ "version": 2, "name": "maps",
             "world": { "environment_params": { "predefined_map": { "integer_uniform": { "low": 0, "high": 4 } } },
                        "agent_params": { "coordinates": { "box": { "low": [-99, -99], "high": [99, 99] } } } },
             "groups": [{ "name": "rocks", "count": 300, "object": { "class": "rock" }, "keep_out": { "walls": 0.5 },
                          "placement": { "box": { "low": [-100, -100], "high": [100, 100] } } }] }"#,
    );
    let sampler = sampler(&task, 7).with_maps(Arc::clone(&maps));
    let mut seen = std::collections::BTreeSet::new();
    for index in 0..40 {
        let world = sampler.world(index).unwrap_or_else(|error| panic!("{error}"));
        let map = world.environment_params.predefined_map;
        seen.insert(map);
        let layout = maps
            .layouts()
            .find(|layout| layout.id == map)
            .expect("the file has all five maps");
        assert_eq!(
            world.environment_params.map_regions.as_deref(),
            Some(&layout.excluded_regions[..])
        );
        let start = world.agent_params.coordinates;
        assert!(
            layout
                .excluded_regions
                .iter()
                .all(|region| winding_number(&region.0, start).round() as i64 % 2 == 0),
            "{start:?}"
        );
        for object in &world.objects {
            for region in &layout.excluded_regions {
                let turns = winding_number(&region.0, object.coordinates);
                assert!(
                    turns.round() as i64 % 2 == 0,
                    "map {map}: {:?} is inside {region:?}",
                    object.coordinates
                );
            }
        }
        let reread = World::from_json("w", &world.to_json()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(reread, world, "the world's document contains its map");
    }
    assert_eq!(seen.len(), 5);
}

#[test]
fn an_agent_never_starts_inside_a_region_that_cannot_be_entered() {
    let inside =
        load(r#"{ "version": 2, "name": "inside", "world": { "environment_params": { "predefined_map": 1 } } }"#);
    let error = sampler(&inside, 7)
        .world(0)
        .expect_err("the ridge of the backslash lies on the origin");
    assert!(matches!(error, GeneratorError::NoStart { tries: 1, .. }));
    insta::assert_snapshot!(error);
    let never = load(
        r#"{ "version": 2, "name": "never", "world": { "environment_params": { "predefined_map": 1 },
             "agent_params": { "coordinates": { "disc": { "center": [0, 0], "radius": 1 } } } } }"#,
    );
    let error = sampler(&never, 7)
        .world(0)
        .expect_err("the whole disc lies inside the ridge");
    assert!(matches!(error, GeneratorError::NoStart { tries: 1000, .. }), "{error}");
}

/// A task with a row of stalls that are placed in turn, and with fixtures that may block some positions.
fn row(placement: &str, count: u32, fixtures: &str) -> Arc<TaskSpec> {
    load(&format!(
        r#"{{ "version": 2, "name": "row", "world": {{ "environment_params": {{ "map_size": [60, 60] }}, "objects": [{fixtures}],
            "agent_params": {{ "coordinates": [0, -20] }} }},
          "groups": [{{ "name": "stalls", "count": {count}, "object": {{ "class": "table" }}, "separation": 1.5,
            "keep_out": {{ "agent": 0 }}, "placement": {placement} }}] }}"#
    ))
}

fn positions(world: &World) -> Vec<[f64; 2]> {
    tagged(world, "stalls")
        .iter()
        .map(|object| object.coordinates)
        .collect()
}

#[test]
fn object_with_its_position_taken_takes_the_next_free_one() {
    let list = r#"{ "points": { "values": [[0, 0], [4, 0], [8, 0], [12, 0]] } }"#;
    let blocked = r#"{ "class": "rock", "coordinates": [4, 1] }"#;
    assert_eq!(
        positions(&world(&row(list, 3, ""), 0)),
        [[0.0, 0.0], [4.0, 0.0], [8.0, 0.0]]
    );
    assert_eq!(
        positions(&world(&row(list, 3, blocked), 0)),
        [[0.0, 0.0], [8.0, 0.0], [12.0, 0.0]]
    );
    // If the first position is taken, every object moves on by one; if too few positions are free, sampling fails.
    let first_blocked = r#"{ "class": "rock", "coordinates": [0, 1] }"#;
    assert_eq!(
        positions(&world(&row(list, 3, first_blocked), 0)),
        [[4.0, 0.0], [8.0, 0.0], [12.0, 0.0]]
    );
    let error = sampler(&row(list, 4, blocked), 7).world(0).unwrap_err();
    let GeneratorError::NoPlace { object, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!(*object, 4, "{error}");
    // The same holds on a grid with one position per cell; with jitter, each object tries its own cell first.
    let grid = r#"{ "grid": { "low": [-2, -2], "high": [14, 2], "columns": 4, "rows": 1 } }"#;
    assert_eq!(
        positions(&world(&row(grid, 3, blocked), 0)),
        [[0.0, 0.0], [8.0, 0.0], [12.0, 0.0]]
    );
    let jittered = r#"{ "grid": { "low": [-2, -2], "high": [14, 2], "columns": 4, "rows": 1, "jitter": 0.2 } }"#;
    let cells: Vec<f64> = positions(&world(&row(jittered, 3, blocked), 3))
        .iter()
        .map(|[x, _]| (x / 4.0).round())
        .collect();
    assert_eq!(cells, [0.0, 2.0, 3.0]);
}

#[test]
fn list_too_short_for_its_group_is_refused_on_loading() {
    let error_for = |placement: &str, count: &str| {
        let text = format!(
            r#"{{ "version": 2, "name": "row", "groups": [{{ "name": "stalls", "count": {count}, "object": {{ "class": "table" }},
                "separation": 3, "placement": {placement} }}] }}"#
        );
        TaskSpec::from_json("row.json", &text)
            .err()
            .map(|error| error.to_string())
    };
    let near = r#"{ "points": { "values": [[0, 0], [2, 0], [4, 0], [6, 0]] } }"#;
    assert_eq!(error_for(near, "2"), None);
    let message = error_for(near, "3").expect("only two are 3 m apart");
    assert!(
        message.contains("4 places, with room for 2 objects 3 m apart"),
        "{message}"
    );
    assert!(error_for(near, r#"{ "integer_uniform": { "low": 3, "high": 5 } }"#).is_some());
    assert_eq!(
        error_for(near, r#"{ "integer_uniform": { "low": 1, "high": 5 } }"#),
        None,
        "some worlds have few enough stalls"
    );
    let grid = r#"{ "grid": { "low": [-9, -9], "high": [9, 9], "columns": 6, "rows": 6 } }"#;
    assert_eq!(error_for(grid, "36"), None);
    assert!(error_for(grid, "37").is_some(), "the grid has only 36 cells");
}
