//! OSPA: distance between sets of objects, of equal or different size. Distances between grids of taken cells are in the other files; the
//! optimal assignment is found in `assignment.rs`.

use std::collections::BTreeMap;

use driftworld_spec::World;

use crate::assignment::{Assignment, MAX_ASSIGNED};
use crate::{Classes, SimilarityError};

/// Largest cut-off in metres.
const MOST_METRES: f64 = 1e6;

/// Highest order: the powers of the cut-off stay finite.
const HIGHEST_ORDER: f64 = 16.0;

/// Optimal sub-pattern assignment (OSPA): how far objects have to be moved to become others, where a missing object counts as one that is
/// moved by the cut-off.
///
/// With the larger set of n objects and the smaller of m, the cut-off c and the order p:
/// ((min Σ min(c, dᵢ)ᵖ + cᵖ (n − m)) / n)^(1/p), the sum over pairs that fit best and d in metres. Two empty sets are 0 apart, an empty
/// one c from any other. Objects of different classes are c apart, wherever they are.
///
/// A metric between sets in which objects may coincide, in metres, in `0..=c`. A higher order weighs the worst pairs more. Time
/// `O(n³)` at worst, class by class; up to [`MAX_ASSIGNED`] objects of a set.
///
/// Source: Schuhmacher, Vo and Vo 2008, "A consistent metric for performance evaluation of multi-object filters"; the same numbers as
/// `scipy.optimize.linear_sum_assignment` with the formula around it within 1e-9, see `tests/oracle/ospa.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::Ospa;
/// let ospa = Ospa::new(10.0, 1.0)?;
/// // One object is 3 m off, one is missing.
/// let distance = ospa.between_points(&[[0.0, 0.0], [40.0, 0.0]], &[[0.0, 3.0]])?;
/// assert_eq!(distance, (3.0 + 10.0) / 2.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ospa {
    cut_off: f64,
    order: f64,
}

impl Ospa {
    /// With a cut-off in metres, above 0 and up to 1,000,000, and an order of 1 to 16.
    ///
    /// # Errors
    /// [`SimilarityError::BadNumber`] for any other.
    pub fn new(cut_off: f64, order: f64) -> Result<Self, SimilarityError> {
        if !(cut_off > 0.0 && cut_off <= MOST_METRES) {
            return Err(SimilarityError::BadNumber {
                of: "cut-off in metres",
                found: cut_off,
                expected: "a number above 0, at most 1000000",
            });
        }
        if !(1.0..=HIGHEST_ORDER).contains(&order) {
            return Err(SimilarityError::BadNumber {
                of: "order",
                found: order,
                expected: "a number from 1 to 16",
            });
        }
        Ok(Self { cut_off, order })
    }

    /// The distance of two sets of places, in metres.
    ///
    /// # Errors
    /// [`SimilarityError::TooMany`] above [`MAX_ASSIGNED`] objects, [`SimilarityError::BadNumber`] for a coordinate that is
    /// not finite.
    pub fn between_points(&self, a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<f64, SimilarityError> {
        let of_one_class = |points: &[[f64; 2]]| BTreeMap::from([((), points.to_vec())]);
        Ok(self.mean(&self.match_up(&of_one_class(a), &of_one_class(b))?))
    }

    /// The distance of two sets of objects, each a class and a place in metres. Only objects of one class are paired.
    ///
    /// # Errors
    /// As [`Ospa::between_points`].
    pub fn between_objects<C: Ord + Clone>(
        &self,
        a: &[(C, [f64; 2])],
        b: &[(C, [f64; 2])],
    ) -> Result<f64, SimilarityError> {
        Ok(self.mean(&self.match_up(&by_class(a), &by_class(b))?))
    }

    /// The distance of what stands in two worlds, by the centres of the objects.
    ///
    /// # Errors
    /// As [`Ospa::between_points`].
    pub fn between_worlds(&self, a: &World, b: &World, classes: Classes) -> Result<f64, SimilarityError> {
        let objects = |world: &World| -> Vec<(String, [f64; 2])> {
            let class = |class: &str| match classes {
                Classes::Merged => String::new(),
                Classes::Separate => class.to_lowercase(),
            };
            let objects = world.objects.iter();
            objects
                .map(|object| (class(&object.class), object.coordinates))
                .collect()
        };
        self.between_objects(&objects(a), &objects(b))
    }

    /// Generalised OSPA (GOSPA, with α = 2): the same, but summed up instead of averaged, and every missing object and every
    /// surplus one counts cᵖ / 2. (Σ min(c, dᵢ)ᵖ + cᵖ / 2 · (number of objects without partner))^(1/p).
    ///
    /// A metric, in metres, from 0 without bound: it grows with the number of objects that are wrong.
    ///
    /// Source: Rahmathullah, García-Fernández and Svensson 2017, "Generalized optimal sub-pattern assignment metric".
    ///
    /// # Errors
    /// As [`Ospa::between_points`].
    pub fn total_between_objects<C: Ord + Clone>(
        &self,
        a: &[(C, [f64; 2])],
        b: &[(C, [f64; 2])],
    ) -> Result<f64, SimilarityError> {
        let found = self.match_up(&by_class(a), &by_class(b))?;
        let alone = (found.larger + found.smaller - 2 * found.pairs) as f64;
        Ok(self.root(found.sum + self.power(self.cut_off) / 2.0 * alone))
    }

    fn mean(&self, found: &Matched) -> f64 {
        if found.larger == 0 {
            return 0.0;
        }
        let missing = (found.larger - found.pairs) as f64;
        let mean = (found.sum + self.power(self.cut_off) * missing) / found.larger as f64;
        self.root(mean).min(self.cut_off)
    }

    /// Pairs objects within each class: as many as can be, for no pair costs more than two objects without partner.
    fn match_up<C: Ord>(&self, a: &Places<C>, b: &Places<C>) -> Result<Matched, SimilarityError> {
        let (count_a, count_b) = (check(a)?, check(b)?);
        let mut assignment = Assignment::new();
        let mut costs = Vec::new();
        let mut found = Matched {
            larger: count_a.max(count_b),
            smaller: count_a.min(count_b),
            pairs: 0,
            sum: 0.0,
        };
        for (class, from) in a {
            let Some(to) = b.get(class) else { continue };
            costs.clear();
            for [x, y] in from {
                let cost = |to: &[f64; 2]| self.power(libm::hypot(x - to[0], y - to[1]).min(self.cut_off));
                costs.extend(to.iter().map(cost));
            }
            found.sum += assignment.solve(&costs, from.len(), to.len())?;
            found.pairs += from.len().min(to.len());
        }
        Ok(found)
    }

    fn power(&self, metres: f64) -> f64 {
        match self.order {
            1.0 => metres,
            2.0 => metres * metres,
            order => libm::pow(metres, order),
        }
    }

    fn root(&self, power: f64) -> f64 {
        match self.order {
            1.0 => power,
            2.0 => power.sqrt(),
            order => libm::pow(power, 1.0 / order),
        }
    }
}

type Places<C> = BTreeMap<C, Vec<[f64; 2]>>;

/// What came of pairing two sets.
struct Matched {
    larger: usize,
    smaller: usize,
    pairs: usize,
    /// Of the powers of the distances of pairs, in the power of metres.
    sum: f64,
}

fn by_class<C: Ord + Clone>(objects: &[(C, [f64; 2])]) -> Places<C> {
    let mut classes = Places::new();
    for (class, place) in objects {
        classes.entry(class.clone()).or_default().push(*place);
    }
    classes
}

/// How many there are.
fn check<C>(places: &Places<C>) -> Result<usize, SimilarityError> {
    let found = places.values().map(Vec::len).sum();
    if found > MAX_ASSIGNED {
        return Err(SimilarityError::TooMany {
            found,
            limit: MAX_ASSIGNED,
        });
    }
    match places.values().flatten().flatten().find(|metres| !metres.is_finite()) {
        Some(&found) => Err(SimilarityError::BadNumber {
            of: "coordinate of an object in metres",
            found,
            expected: "a finite number",
        }),
        None => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::Object;
    use proptest::prelude::*;

    fn objects() -> impl Strategy<Value = Vec<(u8, [f64; 2])>> {
        prop::collection::vec((0u8..3, prop::array::uniform2(-10.0..10.0)), 0..6)
    }

    #[test]
    fn cut_offs_and_orders_are_within_bounds() {
        for (cut_off, order) in [
            (0.0, 1.0),
            (f64::NAN, 1.0),
            (2e6, 1.0),
            (1.0, 0.5),
            (1.0, f64::INFINITY),
        ] {
            let error = Ospa::new(cut_off, order).unwrap_err();
            assert!(matches!(error, SimilarityError::BadNumber { .. }), "{error}");
        }
        let error = Ospa::new(1.0, 1.0)
            .unwrap()
            .between_points(&[[f64::NAN, 0.0]], &[])
            .unwrap_err();
        assert!(matches!(error, SimilarityError::BadNumber { .. }), "{error}");
    }

    #[test]
    fn a_rock_is_no_tree_unless_classes_are_merged() {
        let tree = Object::new("tree", [1.0, 1.0]);
        let world = |class: &str| {
            let object = Object {
                class: class.to_owned(),
                ..tree.clone()
            };
            World::default().edit(|world| world.objects.push(object)).unwrap()
        };
        let ospa = Ospa::new(5.0, 2.0).unwrap();
        let between = |classes| ospa.between_worlds(&world("Tree"), &world("rock"), classes).unwrap();
        assert_eq!(between(Classes::Merged), 0.0);
        assert_eq!(between(Classes::Separate), 5.0);
        let same = ospa
            .between_worlds(&world("Tree"), &world("tree"), Classes::Separate)
            .unwrap();
        assert_eq!(same, 0.0);
    }

    proptest! {
        #[test]
        fn both_are_metrics(
            a in objects(), b in objects(), c in objects(),
            cut_off in 0.5..15.0, order in prop_oneof![Just(1.0), Just(2.0), 1.0..6.0],
        ) {
            let ospa = Ospa::new(cut_off, order).unwrap();
            let mut turned = a.clone();
            turned.reverse();
            for distance in [Ospa::between_objects, Ospa::total_between_objects] {
                let d = |a: &[_], b: &[_]| distance(&ospa, a, b).unwrap();
                prop_assert_eq!(d(&a, &turned), 0.0);
                prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-9);
                prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9);
                prop_assert!(d(&a, &b) >= 0.0);
            }
            prop_assert!(ospa.between_objects(&a, &b).unwrap() <= cut_off);
        }

        #[test]
        fn a_surplus_object_far_away_costs_as_much_as_one_nearby(a in objects(), x in 50.0..100.0) {
            let ospa = Ospa::new(2.0, 1.0).unwrap();
            let with = |x: f64| [a.clone(), vec![(0, [x, 0.0])]].concat();
            let (near, far) = (ospa.between_objects(&a, &with(30.0)).unwrap(), ospa.between_objects(&a, &with(x)).unwrap());
            prop_assert!((near - far).abs() < 1e-12);
        }
    }
}
