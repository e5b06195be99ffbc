//! [`LayoutShape`]: the walls of a layout as a raster, with the paths between them, so that layouts are compared by geometry
//! and not by notation.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use driftworld_spec::Plan;

use crate::SimilarityError;
use crate::occupancy::{Grid, GridShape, grid_earth_movers_distance};
use crate::scalar::relative_difference;

/// Cells of the raster along each side of the arena.
const SIDE: usize = 96;

/// Number of points, along each side of the arena, between which path lengths are measured.
const POINTS_PER_SIDE: usize = 6;

/// Cells per side of the coarser raster for wall transport; each covers 3 × 3 fine cells.
const COARSE: usize = 32;

/// Path length if there is no path.
const NO_PATH: u32 = (SIDE * SIDE) as u32;

/// A layout prepared for comparison: a raster of 96 × 96 cells with the heights of the walls that reach into them, the
/// path lengths between the free cells nearest to 6 × 6 points, and marks: letters of cells and colours of
/// walls. Positions are relative to the arena's sides, so its size does not matter. Details smaller than a cell of the
/// raster are ignored.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutShape {
    /// Wall heights in metres; 0 without a wall.
    walls: Vec<f32>,
    /// Path lengths in steps, from each point to each later one.
    paths: Vec<u32>,
    /// Letters and colours, each with its position.
    marks: BTreeSet<String>,
}

impl LayoutShape {
    /// The shape of a plan in an arena with these sides in metres; `wall_height` is for walls without one. Takes a millisecond.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::LayoutShape;
    /// use driftworld_spec::{Layout, Maze};
    /// let layout = |standing| Layout { maze: Some(Maze::default()), standing, ..Layout::default() };
    /// let [open, half, all] = [0.0, 0.5, 1.0].map(|standing| LayoutShape::of(&layout(standing).plan(7), [24.0, 24.0], 4.0));
    /// assert_eq!(all.distance(&all), 0.0);
    /// assert!(open.ways_distance(&all) > open.ways_distance(&half));
    /// assert!(half.walls_distance(&all) > 0.0);
    /// ```
    pub fn of(plan: &Plan, arena: [f64; 2], wall_height: f64) -> Self {
        let mut walls = vec![0.0_f32; SIDE * SIDE];
        for wall in &plan.walls {
            let height = wall.height.unwrap_or(wall_height) as f32;
            // In raster cells.
            let corners: Vec<[f64; 2]> = wall
                .polygon
                .iter()
                .map(|corner| [0, 1].map(|axis| (corner[axis] / arena[axis] + 0.5) * SIDE as f64))
                .collect();
            let ends = |axis: usize| {
                let along = corners.iter().map(|corner| corner[axis]);
                let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                    [low.min(at), high.max(at)]
                });
                let whole = |at: f64| at.clamp(0.0, SIDE as f64) as usize;
                whole(low - 1.0)..whole(high + 2.0)
            };
            for row in ends(1) {
                for column in ends(0) {
                    let middle = [column as f64 + 0.5, row as f64 + 0.5];
                    let cell = &mut walls[row * SIDE + column];
                    if *cell < height && touches(&corners, middle) {
                        *cell = height;
                    }
                }
            }
        }
        let paths = path_lengths(&walls);
        // Ten-thousandths of the sides, rounded down. Corners of layouts lie at ratios of small numbers; the irrational
        // offset keeps these away from the steps of `floor`, where rounding errors would decide.
        let whole = |share: f64| (share * 1e4 + std::f64::consts::FRAC_1_SQRT_2).floor();
        let share = |[x, y]: [f64; 2]| format!("{} {}", whole(x / arena[0]), whole(y / arena[1]));
        let letters = plan.cells.iter().filter_map(|cell| Some((cell.letter?, cell.center)));
        let letters = letters.map(|(letter, center)| format!("{letter} {}", share(center)));
        let colors = plan.walls.iter().filter_map(|wall| {
            let corners: Vec<String> = wall.polygon.iter().copied().map(share).collect();
            Some(format!(
                "{} {}",
                wall.color?.0.map(|channel| format!("{channel:.4}")).join(" "),
                corners.join(" ")
            ))
        });
        let marks = letters.chain(colors).collect();
        Self { walls, paths, marks }
    }

    /// The shape of an arena without walls.
    pub fn open() -> &'static Self {
        static OPEN: LazyLock<LayoutShape> = LazyLock::new(|| LayoutShape::of(&Plan::default(), [1.0; 2], 1.0));
        &OPEN
    }

    /// Jaccard distance of the walls, weighted by their heights: the wall mass that only one layout has, as a share of the mass
    /// that either has, 0..1. A metric (Soergel's). If all walls have the same height, it is the share of wall cells that only
    /// one layout has.
    pub fn walls_distance(&self, other: &Self) -> f64 {
        let pairs = || {
            self.walls
                .iter()
                .zip(&other.walls)
                .map(|(a, b)| (f64::from(*a), f64::from(*b)))
        };
        let either: f64 = pairs().map(|(a, b)| a.max(b)).sum();
        let only_one: f64 = pairs().map(|(a, b)| (a - b).abs()).sum();
        if either > 0.0 { only_one / either } else { 0.0 }
    }

    /// The difference in paths: the mean, over all pairs of points, of the difference of the two lengths divided by the larger,
    /// 0..1. A metric of path lengths: 0 if all are equal.
    pub fn ways_distance(&self, other: &Self) -> f64 {
        let pairs = self.paths.iter().zip(&other.paths);
        let sum: f64 = pairs
            .map(|(a, b)| relative_difference(f64::from(*a), f64::from(*b)))
            .sum();
        sum / self.paths.len().max(1) as f64
    }

    /// Jaccard distance of the marks: letters of cells and colours of walls that only one layout has in the same place, as a
    /// share of those that either has, 0..1. A metric.
    pub fn marks_distance(&self, other: &Self) -> f64 {
        let either = self.marks.union(&other.marks).count();
        let both = self.marks.intersection(&other.marks).count();
        (either - both) as f64 / either.max(1) as f64
    }

    /// Wall transport: the mean distance by which the mass of walls has to be moved, in sides of the arena, 0..√2. The earth
    /// mover's distance (Wasserstein-1) of rasters of 32 × 32 cells. Each layout has a total mass of 1, distributed by how much
    /// of a cell its walls touch, and their heights.
    ///
    /// A metric on wall positions; it ignores the amount of wall and the common height, which
    /// [`LayoutShape::walls_distance`] measures. Moving a wall by a quarter of the arena costs a quarter of its share
    /// of the mass, while the Jaccard distance of two positions that do not overlap is the same however near they are.
    /// A layout without walls has no mass to move and is √2 from every layout with walls. Not part of
    /// [`LayoutShape::distance`].
    ///
    /// Exact, by network simplex.
    ///
    /// # Errors
    /// [`SimilarityError::BadMass`] for heights that are not finite, which shapes from [`LayoutShape::of`] never have.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::LayoutShape;
    /// use driftworld_spec::{Layout, LayoutWall};
    /// // A wall of 4 m in an arena of 32 m, 16 m further to the east each time.
    /// let [west, east] = [-8.0, 8.0].map(|x| {
    ///     let wall = LayoutWall { from: Some([x + 0.5, -2.0]), to: Some([x + 0.5, 2.0]), thickness: Some(0.5), ..LayoutWall::default() };
    ///     let layout = Layout { walls: Some(vec![wall]), ..Layout::default() };
    ///     LayoutShape::of(&layout.plan(0), [32.0; 2], 2.0)
    /// });
    /// assert!((west.transport_distance(&east)? - 0.5).abs() < 1e-12);
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn transport_distance(&self, other: &Self) -> Result<f64, SimilarityError> {
        let [a, b] = [self.coarse()?, other.coarse()?];
        match (a.total() > 0.0, b.total() > 0.0) {
            (true, true) => grid_earth_movers_distance(&a, &b),
            (false, false) => Ok(0.0),
            _ => Ok(std::f64::consts::SQRT_2),
        }
    }

    /// The mass of the walls, 1 in total, on the coarser raster of an arena whose side is 1.
    fn coarse(&self) -> Result<Grid, SimilarityError> {
        const FINE: usize = SIDE / COARSE;
        let mut masses = vec![0.0; COARSE * COARSE];
        for (cell, height) in self.walls.iter().enumerate() {
            let (row, column) = (cell / SIDE / FINE, cell % SIDE / FINE);
            masses[row * COARSE + column] += f64::from(*height);
        }
        let shape = GridShape::new(COARSE, COARSE, 1, 1.0 / COARSE as f64)?;
        Ok(Grid::new(shape, masses)?.normalised())
    }

    /// Walls, paths and marks together, 0..3. A metric.
    pub fn distance(&self, other: &Self) -> f64 {
        self.walls_distance(other) + self.ways_distance(other) + self.marks_distance(other)
    }
}

/// Margin by which a wall's squared distance from the middle of a cell must be below the square of half a cell to touch the
/// cell: walls on raster lines touch only the cells on their own side, regardless of rounding.
const ROUNDING: f64 = 1e-9;

/// Whether a polygon contains a point, or comes nearer to it than half a cell.
fn touches(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let Some(mut from) = corners.last().copied() else {
        return false;
    };
    let (mut inside, mut least) = (false, f64::INFINITY);
    for &to in corners {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let squared = (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
        let along = (((x - from[0]) * dx + (y - from[1]) * dy) / squared).clamp(0.0, 1.0);
        let (ex, ey) = (x - from[0] - along * dx, y - from[1] - along * dy);
        least = least.min(ex * ex + ey * ey);
        if (from[1] > y) != (to[1] > y) && x < dx * (y - from[1]) / dy + from[0] {
            inside = !inside;
        }
        from = to;
    }
    inside || least < 0.25 - ROUNDING
}

/// Steps from a cell to every other one through cells that `may_enter` allows; [`NO_PATH`] to unreachable ones.
///
/// Avoids iterators for speed: each layout needs dozens of these searches, and tests run many of them unoptimised.
fn steps(from: usize, may_enter: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut steps = vec![NO_PATH; SIDE * SIDE];
    steps[from] = 0;
    // Every cell reached, nearest first; those before `done` have been expanded.
    let mut reached = Vec::with_capacity(SIDE * SIDE);
    reached.push(from);
    let mut done = 0;
    while done < reached.len() {
        let cell = reached[done];
        done += 1;
        let (column, row, next_steps) = (cell % SIDE, cell / SIDE, steps[cell] + 1);
        let mut go_to = |next: usize| {
            if steps[next] == NO_PATH && may_enter(next) {
                steps[next] = next_steps;
                reached.push(next);
            }
        };
        if column + 1 < SIDE {
            go_to(cell + 1);
        }
        if row + 1 < SIDE {
            go_to(cell + SIDE);
        }
        if column > 0 {
            go_to(cell - 1);
        }
        if row > 0 {
            go_to(cell - SIDE);
        }
    }
    steps
}

/// Path lengths between the free cells nearest to the points, from each to each later one.
fn path_lengths(walls: &[f32]) -> Vec<u32> {
    let places: Vec<usize> = (0..POINTS_PER_SIDE * POINTS_PER_SIDE)
        .map(|number| {
            let at = |index: usize| (2 * index + 1) * SIDE / (2 * POINTS_PER_SIDE);
            let middle = at(number / POINTS_PER_SIDE) * SIDE + at(number % POINTS_PER_SIDE);
            if walls[middle] == 0.0 {
                return middle;
            }
            let near = steps(middle, |_| true);
            let free = (0..walls.len()).filter(|cell| walls[*cell] == 0.0);
            free.min_by_key(|cell| near[*cell]).unwrap_or(middle)
        })
        .collect();
    let mut paths = Vec::with_capacity(places.len() * (places.len() - 1) / 2);
    for (number, from) in places.iter().enumerate() {
        let steps = steps(*from, |cell| walls[cell] == 0.0);
        paths.extend(places[number + 1..].iter().map(|to| steps[*to]));
    }
    paths
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Layout, LayoutWall, Maze, Rooms};
    use proptest::prelude::*;

    use super::*;

    /// The neighbours of a cell within the raster.
    fn neighbours(cell: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (cell % SIDE, cell / SIDE);
        [
            (column + 1 < SIDE).then_some(cell + 1),
            (row + 1 < SIDE).then_some(cell + SIDE),
            (column > 0).then(|| cell - 1),
            (row > 0).then(|| cell - SIDE),
        ]
        .into_iter()
        .flatten()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// A cell's step count is one more than its least neighbour's; a cell without a reached neighbour is unreachable.
        #[test]
        fn steps_are_one_more_than_the_least_neighbour(
            walls in prop::collection::vec(prop::bool::weighted(0.35), SIDE * SIDE),
            from in 0..SIDE * SIDE,
        ) {
            let found = steps(from, |cell| !walls[cell]);
            prop_assert_eq!(found[from], 0);
            for cell in (0..SIDE * SIDE).filter(|cell| *cell != from) {
                let least = neighbours(cell).map(|near| found[near]).min().unwrap_or(NO_PATH);
                let expected = if walls[cell] || least == NO_PATH { NO_PATH } else { least + 1 };
                prop_assert_eq!(found[cell], expected, "cell {}", cell);
            }
        }
    }

    fn layouts() -> impl Strategy<Value = Layout> {
        let maze = (2_u32..9, 0.0..=1.0, 0_u64..999).prop_map(|(side, braid, seed)| Layout {
            maze: Some(Maze {
                cells: [side, side],
                braid,
                seed: Some(seed),
                ..Maze::default()
            }),
            ..Layout::default()
        });
        let rooms = (1_u32..4, 0.0..=1.0, 0_u64..999).prop_map(|(side, loops, seed)| Layout {
            rooms: Some(Rooms {
                grid: [side, 2],
                loops,
                seed: Some(seed),
                ..Rooms::default()
            }),
            ..Layout::default()
        });
        prop_oneof![maze, rooms]
    }

    fn shape(layout: &Layout) -> LayoutShape {
        LayoutShape::of(
            &layout.plan(0),
            layout.size().expect("mazes and rooms have a size"),
            4.0,
        )
    }

    /// Puts a wall into a cell of the coarser raster, by column and row.
    fn fill(walls: &mut [f32], [column, row]: [usize; 2], height: f32) {
        const FINE: usize = SIDE / COARSE;
        for y in 0..FINE {
            for x in 0..FINE {
                walls[(row * FINE + y) * SIDE + column * FINE + x] += height;
            }
        }
    }

    /// The share of the mass in each cell of the coarser raster.
    fn shares(shape: &LayoutShape) -> Vec<[f64; 3]> {
        const FINE: usize = SIDE / COARSE;
        let all: f64 = shape.walls.iter().copied().map(f64::from).sum();
        let cells = (0..COARSE * COARSE).map(|cell| {
            let [column, row] = [cell % COARSE, cell / COARSE];
            let places = (0..FINE * FINE).map(|k| (row * FINE + k / FINE) * SIDE + column * FINE + k % FINE);
            let mass: f64 = places.map(|place| f64::from(shape.walls[place])).sum();
            [column as f64, row as f64, if all > 0.0 { mass / all } else { 0.0 }]
        });
        cells.collect()
    }

    fn same_shares(a: &LayoutShape, b: &LayoutShape) -> bool {
        shares(a)
            .iter()
            .zip(shares(b))
            .all(|(a, b)| (a[2] - b[2]).abs() < 1e-12)
    }

    /// Wasserstein-1 of the masses projected onto one axis, 0 for columns, in sides of the arena.
    fn area_between_sums(a: &LayoutShape, b: &LayoutShape, axis: usize) -> f64 {
        let along = |shape: &LayoutShape| {
            let mut sums = vec![0.0; COARSE];
            for cell in shares(shape) {
                sums[cell[axis] as usize] += cell[2];
            }
            sums
        };
        let (mut between, mut area) = (0.0_f64, 0.0);
        for (a, b) in along(a).into_iter().zip(along(b)) {
            between += a - b;
            area += between.abs();
        }
        area / COARSE as f64
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]

        /// On a line the earth mover's distance is the area between the cumulative sums; in the plane it is at least the
        /// distance along each axis.
        #[test]
        fn transport_on_a_line_is_the_area_between_cumulative_sums(
            rows in prop::array::uniform2(prop::collection::vec(0_u8..9, COARSE)), lines in any::<bool>(), other in layouts(),
        ) {
            let shapes = rows.map(|row| {
                let mut walls = vec![0.0_f32; SIDE * SIDE];
                for (at, height) in row.into_iter().enumerate() {
                    fill(&mut walls, if lines { [at, 5] } else { [5, at] }, f32::from(height));
                }
                LayoutShape { walls, ..LayoutShape::open().clone() }
            });
            let [a, b] = &shapes;
            if shapes.iter().all(|shape| shape.walls.iter().any(|height| *height > 0.0)) {
                let found = a.transport_distance(b).expect("heights are finite");
                let expected = area_between_sums(a, b, usize::from(!lines));
                prop_assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
                let other = shape(&other);
                if other.walls.iter().any(|height| *height > 0.0) {
                    let found = a.transport_distance(&other).expect("heights are finite");
                    for axis in [0, 1] {
                        prop_assert!(found >= area_between_sums(a, &other, axis) - 1e-9);
                    }
                }
            }
        }

        #[test]
        fn wall_transport_is_a_metric_of_wall_positions(a in layouts(), b in layouts(), c in layouts(), times in 1_u8..9) {
            let [a, b, c] = [a, b, c].map(|layout| shape(&layout));
            let between = |a: &LayoutShape, b: &LayoutShape| a.transport_distance(b).expect("heights are finite");
            prop_assert_eq!(between(&a, &a), 0.0);
            prop_assert!((between(&a, &b) - between(&b, &a)).abs() < 1e-12);
            prop_assert!(between(&a, &c) <= between(&a, &b) + between(&b, &c) + 1e-12);
            prop_assert!(between(&a, &b) <= std::f64::consts::SQRT_2);
            let stand = a.walls.iter().any(|height| *height > 0.0);
            prop_assert_eq!(between(&a, LayoutShape::open()), if stand { std::f64::consts::SQRT_2 } else { 0.0 });
            // A common factor of heights does not matter; the distribution of mass does.
            let higher = LayoutShape { walls: a.walls.iter().map(|height| height * f32::from(times)).collect(), ..a.clone() };
            prop_assert!(between(&a, &higher) < 1e-12);
            prop_assert_eq!(between(&a, &b) < 1e-12, same_shares(&a, &b));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn layout_distance_is_a_metric(a in layouts(), b in layouts(), c in layouts()) {
            let [a, b, c] = [a, b, c].map(|layout| shape(&layout));
            prop_assert_eq!(a.distance(&a), 0.0);
            prop_assert_eq!(a.distance(&b).to_bits(), b.distance(&a).to_bits());
            prop_assert!(a.distance(&c) <= a.distance(&b) + b.distance(&c) + 1e-12);
        }

        #[test]
        fn moving_a_wall_costs_distance_times_its_share(
            (still, moved) in (1_u8..6, 1_u8..6), from in [0..32_usize, 0..32_usize], to in [0..32_usize, 0..32_usize],
        ) {
            let all = f64::from(still) + f64::from(moved);
            // Common mass stays: no plan is cheaper than one that leaves it.
            let at = |place: [usize; 2]| {
                let mut walls = vec![0.0_f32; SIDE * SIDE];
                fill(&mut walls, [7, 9], f32::from(still));
                fill(&mut walls, place, f32::from(moved));
                LayoutShape { walls, ..LayoutShape::open().clone() }
            };
            let way = |axis: usize| (from[axis] as f64 - to[axis] as f64) / COARSE as f64;
            let found = at(from).transport_distance(&at(to)).expect("heights are finite");
            let expected = libm::hypot(way(0), way(1)) * f64::from(moved) / all;
            prop_assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        }

        #[test]
        fn notation_of_a_layout_does_not_matter(layout in layouts()) {
            let plan = layout.plan(0);
            let walls = plan.walls.iter().map(|wall| LayoutWall {
                polygon: Some(wall.polygon.clone()),
                height: wall.height,
                ..LayoutWall::default()
            });
            let single = Layout { walls: Some(walls.collect()), ..Layout::default() };
            let single = LayoutShape::of(&single.plan(0), plan.size, 4.0);
            prop_assert_eq!(single.distance(&shape(&layout)), 0.0);
        }

        /// The cell size of a text layout changes nothing, and if the raster has whole cells for every letter it equals the
        /// text.
        #[test]
        fn cell_size_of_a_text_layout_does_not_matter(
            (columns, rows) in (prop::sample::select(vec![3_usize, 4, 5, 6, 7, 8, 9, 11, 12, 13, 16, 24, 31, 32, 48, 96]), 2_usize..33),
            walls in prop::collection::vec(any::<bool>(), 96 * 33), metres in 0.1..40.0_f64,
        ) {
            let is_wall = |column: usize, row: usize| walls[row * 96 + column] || (column, row) == (0, 0);
            let lines = (0..rows).map(|row| (0..columns).map(|column| if is_wall(column, row) { '#' } else { 'x' }).collect());
            let lines: Vec<String> = lines.collect();
            let at = |metres: f64| {
                let layout = serde_json::json!({ "text": lines, "cell": metres, "legend": { "x": "floor" } });
                shape(&serde_json::from_value(layout).expect("a layout of text"))
            };
            let [one, other] = [at(1.0), at(metres)];
            prop_assert_eq!(&one, &other);
            if SIDE.is_multiple_of(columns) && SIDE.is_multiple_of(rows) {
                for (cell, height) in one.walls.iter().enumerate() {
                    let (row, column) = (SIDE - 1 - cell / SIDE, cell % SIDE);
                    let expected = is_wall(column * columns / SIDE, row * rows / SIDE);
                    prop_assert_eq!(*height > 0.0, expected, "column {}, row {} of the raster", column, row);
                }
            }
        }

        #[test]
        fn distance_grows_as_fewer_walls_stand(layout in layouts(), more in 0.0..=1.0, less in 0.0..=1.0) {
            let standing = |standing| shape(&Layout { standing, ..layout.clone() });
            let (all, many, few) = (standing(1.0), standing(more), standing(more * less));
            prop_assert!(all.walls_distance(&few) >= all.walls_distance(&many));
            prop_assert_eq!(standing(0.0), LayoutShape::open().clone());
        }
    }
}
