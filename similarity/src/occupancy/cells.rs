//! [`Occupancy`]: worlds as sets of taken cells, without an extent. Grids of a fixed extent, which are quicker, are in `grid.rs`.

use std::collections::BTreeSet;

use driftworld_spec::World;

/// The cells of a square grid in which objects stand, by class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occupancy {
    cells: BTreeSet<(String, i32, i32)>,
}

impl Occupancy {
    /// The cells of a world's objects by their centres. `cell` is the side of a cell in metres, above 0; with `merged`
    /// classes are not told apart.
    pub fn of_world(world: &World, cell: f64, classes: Classes) -> Self {
        let index = |metres: f64| (metres / cell.max(1e-3)).floor() as i32;
        let cells = world.objects.iter().map(|object| {
            let class = if classes == Classes::Merged {
                String::new()
            } else {
                object.class.to_lowercase()
            };
            (class, index(object.coordinates[0]), index(object.coordinates[1]))
        });
        Self { cells: cells.collect() }
    }

    /// How many cells are taken.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether nothing stands anywhere.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }
}

/// Whether objects of different classes in one cell are the same to an occupancy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Classes {
    /// Each class has a grid of its own.
    Separate,
    /// All share one grid.
    Merged,
}

/// Share of the cells taken in either world that are not taken in both: 1 − |A ∩ B| / |A ∪ B|.
///
/// A metric in `0..=1`; two empty worlds are 0 apart. Source: Jaccard 1912; Kosub 2019 for the triangle inequality.
pub fn jaccard_distance(a: &Occupancy, b: &Occupancy) -> f64 {
    let common = a.cells.intersection(&b.cells).count();
    let all = a.len() + b.len() - common;
    if all == 0 {
        0.0
    } else {
        1.0 - common as f64 / all as f64
    }
}

/// Number of cells that are taken in one world only. A metric in `0..=|A| + |B|`.
pub fn hamming_distance(a: &Occupancy, b: &Occupancy) -> usize {
    a.cells.symmetric_difference(&b.cells).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::Object;
    use proptest::prelude::*;

    fn world(places: &[(u8, i8, i8)]) -> World {
        let object = |(class, x, y): &(u8, i8, i8)| {
            Object::new(
                ["tree", "rock"][*class as usize % 2],
                [f64::from(*x) + 0.5, f64::from(*y) + 0.5],
            )
        };
        World {
            objects: places.iter().map(object).collect(),
            ..World::default()
        }
    }

    fn occupancy() -> impl Strategy<Value = Occupancy> {
        prop::collection::vec((0u8..2, -3i8..3, -3i8..3), 0..8)
            .prop_map(|places| Occupancy::of_world(&world(&places), 1.0, Classes::Separate))
    }

    #[test]
    fn half_of_the_cells_in_common_is_two_thirds_apart() {
        let grid = |places| Occupancy::of_world(&world(places), 1.0, Classes::Separate);
        let (a, b) = (grid(&[(0, 0, 0), (0, 1, 0)]), grid(&[(0, 0, 0), (0, 2, 0)]));
        assert!((jaccard_distance(&a, &b) - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(hamming_distance(&a, &b), 2);
        assert_eq!(jaccard_distance(&grid(&[]), &grid(&[])), 0.0);
    }

    #[test]
    fn merged_classes_are_one_grid() {
        let grid = |places, classes| Occupancy::of_world(&world(places), 1.0, classes);
        let (a, b) = ([(0, 0, 0)], [(1, 0, 0)]);
        assert_eq!(
            jaccard_distance(&grid(&a, Classes::Merged), &grid(&b, Classes::Merged)),
            0.0
        );
        assert_eq!(
            jaccard_distance(&grid(&a, Classes::Separate), &grid(&b, Classes::Separate)),
            1.0
        );
    }

    proptest! {
        #[test]
        fn both_are_metrics(a in occupancy(), b in occupancy(), c in occupancy()) {
            prop_assert_eq!(jaccard_distance(&a, &a), 0.0);
            prop_assert_eq!(jaccard_distance(&a, &b), jaccard_distance(&b, &a));
            prop_assert!(jaccard_distance(&a, &c) <= jaccard_distance(&a, &b) + jaccard_distance(&b, &c) + 1e-12);
            prop_assert!((0.0..=1.0).contains(&jaccard_distance(&a, &b)));
            prop_assert!(hamming_distance(&a, &c) <= hamming_distance(&a, &b) + hamming_distance(&b, &c));
        }
    }
}
