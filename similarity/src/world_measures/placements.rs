//! [`Placements`]: the positions of objects in many worlds, as one distribution per class.

use std::collections::{BTreeMap, BTreeSet};

use driftworld_spec::{Element, World};

use crate::combined::{Distance, Part, Weights};
use crate::distribution::Method;
use crate::{SimilarityError, earth_movers_distance};

/// Distance in metres that counts as 1, as in distances between worlds.
const METRES_PER_UNIT: f64 = 10.0;

/// The positions of the objects of each class in many worlds of one variant: the actual distribution of positions, after walls
/// and rejected placements have changed the declared one.
#[derive(Clone, Debug, Default)]
pub struct Placements {
    by_class: BTreeMap<String, Vec<[f64; 2]>>,
    worlds: usize,
}

impl Placements {
    /// The positions of all objects in these worlds. The case of a class is ignored.
    pub fn of(worlds: &[World]) -> Self {
        let mut by_class: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
        for object in worlds.iter().flat_map(|world| &world.objects) {
            let class = object.class.to_lowercase();
            by_class.entry(class).or_default().push(object.coordinates);
        }
        for positions in by_class.values_mut() {
            positions.sort_by(|a, b| a.partial_cmp(b).expect("positions are numbers"));
        }
        let worlds = worlds.len();
        Self { by_class, worlds }
    }

    /// The distance between two sets of positions, class by class: the mean distance by which an object moves, in tens of metres,
    /// with the minimum work that turns one distribution into the other (Wasserstein-1 of all positions together, exact). A
    /// class that only one set has counts as 1.
    ///
    /// Classes are added up. The number of objects in a class does not matter: sets with different numbers of objects in the
    /// same positions are 0 apart. A metric between sets of positions of the same classes; if the classes differ, the triangle
    /// inequality may fail. Everything else in the worlds is ignored. `weights`: supplies the weight of the state.
    ///
    /// # Errors
    /// [`SimilarityError::Empty`] if one has no world, [`SimilarityError::TooMany`] above
    /// [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) objects of a class.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::{Placements, Weights};
    /// use driftworld_spec::{Object, World};
    /// let at = |x: f64| World::default().edit(|world| world.objects.push(Object::new("tree", [x, 0.0])));
    /// let (near, far) = (Placements::of(&[at(1.0)?, at(2.0)?]), Placements::of(&[at(7.0)?, at(6.0)?]));
    /// assert_eq!(near.distance(&far, &Weights::default())?.total, 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn distance(&self, other: &Self, weights: &Weights) -> Result<Distance, SimilarityError> {
        if self.worlds == 0 || other.worlds == 0 {
            return Err(SimilarityError::Empty);
        }
        let mut parts = Vec::new();
        let classes: BTreeSet<&String> = self.by_class.keys().chain(other.by_class.keys()).collect();
        for class in classes {
            let (raw, counts) = match (self.by_class.get(class), other.by_class.get(class)) {
                (Some(a), Some(b)) => {
                    // In a canonical order of the two, so that the result is symmetric to the last bit.
                    let (a, b) = if a > b { (b, a) } else { (a, b) };
                    let distance = earth_movers_distance(a, b)?;
                    (distance, distance / METRES_PER_UNIT)
                }
                _ => (METRES_PER_UNIT, 1.0),
            };
            let count = self.worlds.min(other.worlds);
            parts.push(Part {
                method: Some(Method::Samples { count }),
                raw,
                ..Part::of(
                    &format!("{class} positions"),
                    Element::S,
                    "earth mover's distance / 10 m",
                    counts,
                )
            });
        }
        Ok(Distance::new(parts, weights))
    }
}

#[cfg(test)]
mod tests {
    use driftworld_spec::Object;
    use proptest::prelude::*;

    use super::*;

    fn worlds(places: &[Vec<(u8, [f64; 2])>]) -> Vec<World> {
        let world = |own: &Vec<(u8, [f64; 2])>| {
            let objects = own
                .iter()
                .map(|(class, place)| Object::new(["tree", "bush"][usize::from(*class)], *place));
            World::default()
                .edit(|world| world.objects = objects.collect())
                .unwrap()
        };
        places.iter().map(world).collect()
    }

    fn drawn() -> impl Strategy<Value = Vec<Vec<(u8, [f64; 2])>>> {
        let place = (0_u8..2, [-20.0..20.0, -20.0..20.0]);
        prop::collection::vec(prop::collection::vec(place, 0..4), 1..4)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

        #[test]
        fn placements_distance_satisfies_the_metric_axioms_in_any_order(a in drawn(), b in drawn(), c in drawn()) {
            let [of_a, of_b, of_c] = [&a, &b, &c].map(|places| Placements::of(&worlds(places)));
            let d = |a: &Placements, b: &Placements| a.distance(b, &Weights::default()).unwrap().total;
            prop_assert_eq!(d(&of_a, &of_a), 0.0);
            prop_assert_eq!(d(&of_a, &of_b), d(&of_b, &of_a));
            let mut shuffled = a.clone();
            shuffled.reverse();
            for world in &mut shuffled {
                world.reverse();
            }
            prop_assert_eq!(d(&of_a, &of_b), d(&Placements::of(&worlds(&shuffled)), &of_b));
            // A class that only one has counts as 1 at any distance, so it is a metric only if all have the same classes.
            let classes = |of: &Placements| of.by_class.keys().cloned().collect::<Vec<_>>();
            if classes(&of_a) == classes(&of_b) && classes(&of_b) == classes(&of_c) {
                prop_assert!(d(&of_a, &of_c) <= d(&of_a, &of_b) + d(&of_b, &of_c) + 1e-9);
            }
            let twice = [a.clone(), a.clone()].concat();
            prop_assert!(d(&of_a, &Placements::of(&worlds(&twice))) < 1e-12);
        }

        #[test]
        fn common_shift_counts_by_its_length(a in drawn(), east in -30.0..30.0_f64) {
            let moved: Vec<Vec<_>> =
                a.iter().map(|world| world.iter().map(|(class, [x, y])| (*class, [x + east, *y])).collect()).collect();
            let (before, after) = (Placements::of(&worlds(&a)), Placements::of(&worlds(&moved)));
            let classes = before.by_class.len() as f64;
            let found = before.distance(&after, &Weights::default()).unwrap().total;
            prop_assert!((found - classes * east.abs() / METRES_PER_UNIT).abs() < 1e-9);
        }
    }

    #[test]
    fn empty_placements_are_refused() {
        let (none, one) = (Placements::of(&[]), Placements::of(&[World::default()]));
        assert!(matches!(
            none.distance(&one, &Weights::default()),
            Err(SimilarityError::Empty)
        ));
        assert_eq!(one.distance(&one, &Weights::default()).unwrap().total, 0.0);
    }
}
