//! Properties of the measures between worlds.

mod by_hand;

use driftworld_spec::{Color, Element, Object, World};
use proptest::prelude::*;

use super::*;
use crate::{ColorMeasure, MetricProperties, Raster, SimilarityError, Weights};

const COLORS: [&str; 3] = ["red", "tan", "navy"];

/// Class, position and colour: two classes, one of them with varying case, positions inside and outside an arena of 12 × 8 m,
/// often in the same cell.
type Thing = (&'static str, [f64; 2], Option<Color>);

fn things() -> impl Strategy<Value = Vec<Thing>> {
    let class = prop::sample::select(vec!["tree", "Tree", "rock"]);
    let metres = prop_oneof![-7.0..7.0_f64, prop::sample::select(vec![-3.5, -1.0, 0.5, 2.0])];
    let color = prop::option::of(prop::sample::select(COLORS.to_vec()));
    let color = color.prop_map(|name| name.and_then(Color::from_name));
    prop::collection::vec((class, prop::array::uniform2(metres), color), 0..5)
}

fn world(things: &[Thing]) -> World {
    let object = |(class, place, color): &Thing| Object {
        color: *color,
        ..Object::new(*class, *place)
    };
    let world = World::default().edit(|world| {
        world.environment_params.map_size = [12.0, 8.0];
        world.objects = things.iter().map(object).collect();
    });
    world.unwrap()
}

fn between(measure: WorldMeasure, a: &[Thing], b: &[Thing]) -> f64 {
    measure.between(&world(a), &world(b)).unwrap()
}

#[test]
fn names_round_trip_and_unknown_names_are_refused() {
    for measure in WorldMeasure::all() {
        let name = measure.name();
        assert_eq!(WorldMeasure::from_name(measure.kind(), Some(name)), Some(measure));
    }
    assert_eq!(WorldMeasure::from_name("occupancy", Some("emd")), None);
    assert_eq!(WorldMeasure::from_name("colors", Some("rgb")), None);
    assert_eq!(WorldMeasure::from_name("objects", Some("jaccard")), None);
    let names: Vec<_> = WorldMeasure::all().map(WorldMeasure::name).collect();
    let expected = "earth_movers jaccard hausdorff chamfer ospa counts srgb cie76 ciede2000 oklab hyab";
    assert_eq!(names.join(" "), expected);
    let defaults = ["occupancy", "objects", "colors", "rewards"].map(|kind| WorldMeasure::from_name(kind, None));
    let oklab = WorldMeasure::Colors(ColorMeasure::Oklab);
    assert_eq!(
        defaults,
        [
            Some(WorldMeasure::EarthMovers),
            Some(WorldMeasure::Ospa),
            Some(oklab),
            None
        ]
    );
}

#[test]
fn empty_world_has_the_documented_distances() {
    let tree = ("tree", [0.5, 0.5], Color::from_name("red"));
    let some = [tree, ("tree", [2.5, 0.5], None), ("rock", [0.5, 0.5], None)];
    // 12 × 8 cells of 1 m.
    let diameter = libm::hypot(11.0, 7.0);
    for measure in WorldMeasure::all() {
        assert_eq!(between(measure, &[], &[]), 0.0, "{}", measure.name());
        let expected = match measure.name() {
            "earth_movers" => 2.0 * diameter,
            "hausdorff" | "chamfer" => diameter,
            "ospa" => 10.0,
            _ => 1.0,
        };
        let found = between(measure, &[], &some);
        assert!((found - expected).abs() < 1e-12, "{}: {found}", measure.name());
    }
}

#[test]
fn colours_of_the_model_are_ignored() {
    let (red, plain) = (("tree", [0.0; 2], Color::from_name("red")), ("tree", [0.0; 2], None));
    for measure in ColorMeasure::ALL {
        let d = |a: &[Thing], b: &[Thing]| between(WorldMeasure::Colors(*measure), a, b);
        assert_eq!(d(&[red], &[red, plain]), 0.0);
        assert_eq!(d(&[plain], &[]), 0.0);
        assert_eq!(d(&[plain], &[red]), 1.0);
    }
}

#[test]
fn sets_of_worlds_are_compared_pairwise_in_one_element() {
    let at = |x: f64| world(&[("tree", [x, 0.0], None)]);
    let (a, b) = ([at(0.0), at(0.0), at(5.0)], [at(1.0), at(3.0)]);
    let weights = Weights::default().with(Element::S, 3.0).unwrap();
    let ospa = WorldMeasure::Ospa;
    let found = world_sets_measure_distance(&a, &b, ospa, &weights).unwrap();
    assert_eq!((found.element(Element::S), found.total), (Some(2.0), 6.0));
    assert_eq!(
        (found.parts[0].name.as_str(), found.parts[0].measure),
        ("objects", "ospa in metres")
    );
    assert_eq!(found.element(Element::O), None);
    let none = world_sets_measure_distance(&a, &[], ospa, &weights).unwrap_err();
    assert_eq!(none, SimilarityError::Empty);
}

#[test]
fn cells_grow_until_all_classes_fit() {
    let with = |classes: usize, side: f64| {
        let objects = (0..classes).map(|index| Object::new(format!("kind {index}"), [0.5, 0.5]));
        let world = World::default().edit(|world| {
            world.environment_params.map_size = [side; 2];
            world.objects = objects.collect();
        });
        world.unwrap()
    };
    let cell = |classes, side| Raster::fitting(&[&with(classes, side)]).unwrap().shape().cell();
    assert_eq!((cell(11, 300.0), cell(12, 300.0), cell(100, 300.0)), (1.0, 2.0, 4.0));
    let emd = WorldMeasure::EarthMovers;
    assert!(emd.between(&with(100, 300.0), &with(0, 300.0)).unwrap().is_finite());
    let among = |worlds: &[World]| emd.properties_among(worlds);
    assert_eq!(among(&[]), MetricProperties::Pseudometric);
    assert_eq!(
        among(&[with(2, 300.0), with(11, 300.0)]),
        MetricProperties::Pseudometric
    );
    assert_eq!(among(&[with(2, 300.0), with(12, 300.0)]), MetricProperties::Distance);
    assert_eq!(among(&[with(2, 300.0), with(2, 299.0)]), MetricProperties::Distance);
    let ospa = WorldMeasure::Ospa;
    assert_eq!(
        ospa.properties_among(&[with(2, 300.0), with(2, 299.0)]),
        MetricProperties::Pseudometric
    );
}

#[test]
fn larger_arena_can_violate_the_triangle_inequality() {
    let arena = |side: f64, trees: usize| {
        let world = World::default().edit(|world| {
            world.environment_params.map_size = [side; 2];
            world.objects = vec![Object::new("tree", [0.5, 0.5]); trees];
        });
        world.unwrap()
    };
    let d = |a, b| WorldMeasure::EarthMovers.between(a, b).unwrap();
    let (tree, none, wide) = (arena(10.0, 1), arena(10.0, 0), arena(100.0, 0));
    assert!(d(&tree, &none) + d(&none, &wide) < d(&tree, &wide));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn measures_are_symmetric_and_0_between_equals(a in things(), b in things(), turn in 0_usize..5) {
        let mut rotated = a.clone();
        rotated.rotate_left(turn.min(a.len()));
        for measure in WorldMeasure::all() {
            let d = |a: &[Thing], b: &[Thing]| between(measure, a, b);
            prop_assert_eq!(d(&a, &rotated), 0.0, "{}", measure.name());
            prop_assert_eq!(d(&a, &b), d(&b, &a), "{}", measure.name());
            prop_assert_eq!(d(&a, &b), d(&rotated, &b), "{}", measure.name());
            prop_assert!(d(&a, &b).is_finite() && d(&a, &b) >= 0.0);
            if !measure.label().ends_with("in metres") {
                prop_assert!(d(&a, &b) <= 1.0, "{}", measure.name());
            }
        }
    }

    #[test]
    fn declared_triangle_inequality_holds(a in things(), b in things(), c in things()) {
        for measure in WorldMeasure::all().filter(|measure| measure.properties().keeps_triangles()) {
            let d = |a: &[Thing], b: &[Thing]| between(measure, a, b);
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9, "{}", measure.name());
        }
    }

    #[test]
    fn distance_never_falls_as_a_lone_object_moves_away(from in -6.0..6.0_f64, distances in prop::array::uniform2(0.0..6.0_f64)) {
        let (near, far) = (distances[0].min(distances[1]), distances[0].max(distances[1]));
        for measure in WorldMeasure::all() {
            let moved = |distance: f64| {
                let at = |x: f64| [("tree", [x.min(6.0), 1.0], None)];
                between(measure, &at(from), &at(from + distance))
            };
            prop_assert!(moved(near) <= moved(far) + 1e-12, "{}", measure.name());
        }
    }

    #[test]
    fn transport_never_falls_as_one_of_several_objects_moves_away(
        others in things(),
        from in -6.0..6.0_f64,
        distances in prop::array::uniform2(0.0..6.0_f64),
    ) {
        let (near, far) = (distances[0].min(distances[1]), distances[0].max(distances[1]));
        let work = WorldMeasure::EarthMovers;
        for measure in [work, WorldMeasure::Ospa] {
            let with = |x: f64| [others.clone(), vec![("tree", [x.min(6.0), 1.0], None)]].concat();
            let moved = |distance: f64| between(measure, &with(from), &with(from + distance));
            prop_assert!(moved(near) <= moved(far) + 1e-9, "{}", measure.name());
        }
    }

    #[test]
    fn class_equal_in_both_worlds_changes_no_sum_or_maximum(
        a in things(), b in things(), more in things(),
    ) {
        let with = |things: &[Thing]| -> Vec<Thing> {
            let more = more.iter().map(|(_, place, color)| ("lamp", *place, *color));
            more.chain(things.iter().copied()).collect()
        };
        for measure in [WorldMeasure::EarthMovers, WorldMeasure::Hausdorff] {
            prop_assert_eq!(between(measure, &a, &b), between(measure, &with(&a), &with(&b)), "{}", measure.name());
        }
    }
}
