//! Distances between worlds by their objects, without cells.

use std::collections::BTreeMap;

use driftworld_spec::World;

use crate::{SimilarityError, ospa};

/// Distance in metres counted for a missing object; distances between worlds use the same unit for an object's position.
const CUT_OFF: f64 = 10.0;

/// [`ospa`] of the objects of two worlds.
pub(super) fn ospa_between(a: &World, b: &World) -> Result<f64, SimilarityError> {
    let (a, b) = (positions(a), positions(b));
    // In a canonical order of the two, so that the result is symmetric to the last bit.
    let (a, b) = if a > b { (b, a) } else { (a, b) };
    ospa(&a, &b, CUT_OFF)
}

/// Class and position of each object, sorted.
fn positions(world: &World) -> Vec<(String, [f64; 2])> {
    let objects = world.objects.iter();
    let mut positions: Vec<_> = objects
        .map(|object| (object.class.to_lowercase(), object.coordinates))
        .collect();
    positions.sort_by(|a, b| a.partial_cmp(b).expect("positions are numbers"));
    positions
}

/// Number of objects of each class.
pub(super) fn counts_of(world: &World) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for object in &world.objects {
        *counts.entry(object.class.to_lowercase()).or_default() += 1;
    }
    counts
}
