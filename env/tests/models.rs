//! Properties of the models of our own classes: they stand on the ground, fill their colliders, face the right way, and have
//! few triangles.

use std::sync::Arc;

use driftworld_env::{Asset, ColliderShape, asset, model_names};
use driftworld_spec::Model;

const OWN: [&str; 6] = ["door", "key", "switch", "animal", "sign", "furniture"];

fn models(class: &str) -> Vec<(String, Arc<Asset>)> {
    model_names(class)
        .map(|name| (format!("{class} {name}"), asset(class, &Model(name))))
        .collect()
}

/// Minimum and maximum of all corners along an axis.
fn extent(asset: &Asset, axis: usize) -> (f32, f32) {
    let corners = asset.parts.iter().flat_map(|part| &part.mesh.corners);
    corners.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), corner| {
        (low.min(corner[axis]), high.max(corner[axis]))
    })
}

#[test]
fn every_model_stands_on_the_ground_and_fills_its_collider() {
    for (name, asset) in OWN.iter().flat_map(|class| models(class)) {
        let (low, high) = extent(&asset, 2);
        assert!(low.abs() < 0.005, "{name} stands at {low} m");
        assert!((high - asset.height).abs() < 1e-6, "{name}");
        let (half, body_height) = match asset.collider {
            ColliderShape::Box { half: [x, y, z] } => ([x, y], 2.0 * z),
            ColliderShape::Cylinder { radius, half_height } => ([radius, radius], 2.0 * half_height),
            ref other => panic!("{name} has a {other:?}"),
        };
        assert!(
            body_height <= high + 0.01 && body_height > 0.6 * high,
            "{name}: the body is {body_height} m high, the model {high} m"
        );
        for axis in [0, 1] {
            let seen = |axis: usize| {
                let (low, high) = extent(&asset, axis);
                high.max(-low)
            };
            // Objects with a round collider may be flat, such as keys.
            let most = match asset.collider {
                ColliderShape::Cylinder { .. } => seen(0).max(seen(1)),
                _ => seen(axis),
            };
            // The collider does not extend beyond the visible model, and at most a tail, a muzzle, antlers or a frame extend
            // beyond the collider.
            let beyond = most - half[axis];
            assert!(
                beyond > -0.03 && beyond < 0.30 * most + 0.15,
                "{name}, axis {axis}: the model measures {most} m, the collider {} m",
                half[axis]
            );
        }
    }
}

#[test]
fn animals_face_their_heading_and_have_natural_sizes() {
    let height = |name: &str| asset("animal", &Model(name.into())).height;
    let [rabbit, wolf, deer] = ["rabbit", "wolf", "deer"].map(height);
    assert!((0.35..0.5).contains(&rabbit), "up to its ears: {rabbit}");
    assert!((1.0..1.3).contains(&wolf), "up to its ears: {wolf}");
    assert!((2.0..2.5).contains(&deer), "up to its antlers: {deer}");
    for (name, animal) in models("animal") {
        let face = animal.parts.last().expect("a face is drawn last");
        assert!(face.mesh.corners.iter().all(|[_, y, _]| *y > 0.05), "{name} faces back");
        let (left, right) = extent(&animal, 0);
        assert!((left + right).abs() < 0.02, "{name} is symmetric: {left} {right}");
        let (back, front) = extent(&animal, 1);
        assert!(front - back > 1.2 * (right - left), "{name} is longer than wide");
    }
}

#[test]
fn models_have_few_triangles_and_coarse_levels_fewer() {
    for (name, animal) in models("animal") {
        let levels: Vec<(usize, f32)> = animal.levels().collect();
        let [(fine, 0.0), (coarse, error)] = levels[..] else {
            panic!("{name} has the levels {levels:?}")
        };
        assert!((60..=260).contains(&fine), "{name}: {fine} triangles");
        assert!(4 * coarse <= 3 * fine, "{name}: {coarse} of {fine}");
        assert!(
            error > 0.0 && error < 0.15 * animal.height.max(animal.radius),
            "{name}: {error} m"
        );
    }
    for (name, asset) in ["sign", "furniture"].into_iter().flat_map(models) {
        let (most, _) = asset.levels().next().expect("there is a level");
        assert!(most <= 220, "{name}: {most} triangles");
    }
}

#[test]
fn named_models_have_numbers_as_well() {
    for class in ["animal", "sign", "furniture"] {
        for (place, name) in model_names(class).enumerate() {
            let by = |model: String| asset(class, &Model(model));
            assert!(
                Arc::ptr_eq(&by(name.clone()), &by((place + 1).to_string())),
                "{class} {name}"
            );
            assert!(Arc::ptr_eq(
                &by(name.clone()),
                &by(format!(" {} ", name.to_uppercase()))
            ));
        }
        assert!(!asset(class, &Model("0".into())).known && !asset(class, &Model("unicorn".into())).known);
    }
    assert_eq!(model_names("dragon").count(), 0);
}
