//! Chooses the best of many goals with a single flood from the agent, which ends when no goal farther out can be better.

use std::cmp::Reverse;

use driftworld_spec::World;

use super::flood::{DIAGONAL, STRAIGHT};
use super::marks::Marks;
use super::occupancy::{BLOCKED, Paths};
use super::route::Route;
use crate::scene::Scene;

/// Maximum number of cells that belong to goals in one choice. If there are more, only the nearest goals by straight-line
/// distance are considered.
const MAX_MARKS: usize = 2_000_000;

/// A candidate destination.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Goal {
    /// Index of the object that stands there: paths to it do not avoid it.
    pub(super) object: u32,
    /// Its position in metres.
    pub(super) place: [f32; 2],
    /// Probability that it pays, above 0. A goal that pays half the time is worth as much as a certain one twice as far away.
    pub(super) probability: f32,
}

impl Route {
    /// The goal with the smallest ratio of path length to probability, from a position; ties go to the first.
    ///
    /// Paths avoid all objects in `avoided` except their goal. Discards the previous route.
    pub(super) fn nearest(
        &mut self,
        world: &World,
        scene: &Scene,
        from: [f32; 2],
        goals: &[Goal],
        avoided: &[u32],
    ) -> Option<usize> {
        self.occupancy.block(world, scene, avoided);
        let grid = self.occupancy.grid();
        self.marks.begin(grid);
        let considered = self.goals_to_consider(from, goals);
        for number in considered.iter().copied() {
            let goal = &goals[number];
            self.marks.add(grid.cell_at(goal.place), number);
            for cell in self
                .occupancy
                .disc(goal.object)
                .into_iter()
                .flat_map(|disc| disc.cells(grid))
            {
                self.marks.add(cell, number);
            }
        }
        let here = self.open_cell(from);
        self.begin(here);
        // For each goal a lower bound on its distance: the distance at which the flood first reaches the goal's cell or the
        // ground that the goal's own object blocks.
        let mut least: Vec<Option<u32>> = vec![None; goals.len()];
        let likeliest = goals.iter().map(|goal| goal.probability).fold(0.0, f32::max);
        let (mut best, mut farthest, mut num_unseen) = (f32::INFINITY, 0, considered.len());
        let mut seen = Vec::new();
        loop {
            let marks = &self.marks;
            let spread = self.flood.spread(&Paths::<true>(&self.occupancy), |cell| {
                marks.of(cell, |number| seen.push(number));
            });
            let Some(distance) = spread else { break };
            for number in seen.drain(..) {
                if least[number].is_none() {
                    least[number] = Some(distance);
                    num_unseen -= 1;
                    // Beyond the flood's edge, distances belong to real paths, though maybe not the shortest.
                    let length = self.length(&goals[number], distance);
                    farthest = farthest.max(length);
                    best = best.min(self.metres(length) / goals[number].probability);
                }
            }
            if self.metres(distance) / likeliest > best || num_unseen == 0 && distance >= farthest {
                break;
            }
        }
        // Every path that may be the best now lies within the flood.
        let mut costs = Vec::with_capacity(goals.len());
        for (number, goal) in goals.iter().enumerate() {
            if let Some(least) = least[number]
                && self.metres(least) / goal.probability <= best
            {
                let length = self.length(goal, least);
                costs.push((number, self.metres(length) / goal.probability));
            }
        }
        let nearest = costs.into_iter().min_by(|(_, a), (_, b)| a.total_cmp(b));
        nearest.map(|(number, _)| number)
    }

    /// The numbers of the goals to consider, in ascending order: all, unless they have too many cells.
    fn goals_to_consider(&self, from: [f32; 2], goals: &[Goal]) -> Vec<usize> {
        let grid = self.occupancy.grid();
        let num_cells = |goal: &Goal| 1 + self.occupancy.disc(goal.object).map_or(0, |disc| disc.num_cells(grid));
        let total: usize = goals.iter().map(num_cells).sum();
        let mut numbers: Vec<usize> = (0..goals.len()).collect();
        if total <= MAX_MARKS {
            return numbers;
        }
        let cost = |number: &usize| {
            let Goal { place, probability, .. } = goals[*number];
            let [x, y] = [place[0] - from[0], place[1] - from[1]];
            (x * x + y * y).sqrt() / probability
        };
        numbers.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        let mut budget = MAX_MARKS;
        let mut fits = |number: &usize| {
            let rest = budget.checked_sub(num_cells(&goals[*number]));
            budget = rest.unwrap_or(0);
            rest.is_some()
        };
        let count = numbers.iter().take_while(|number| fits(number)).count().max(1);
        numbers.truncate(count);
        numbers.sort_unstable();
        numbers
    }

    /// Length of the path to a goal, which may cross the ground that the goal's own object blocks. The flood reached that
    /// ground, or the goal, at the distance `least`.
    ///
    /// Searches outwards from the goal until the rest of the path lies outside that ground; its length comes from the flood.
    fn length(&mut self, goal: &Goal, least: u32) -> u32 {
        let (occupancy, flood) = (&self.occupancy, &self.flood);
        let grid = occupancy.grid();
        let start = grid.cell_at(goal.place);
        let Some(own) = occupancy.disc(goal.object) else {
            return flood.cost(start);
        };
        let Marks {
            back,
            touched,
            open,
            searches_left,
            ..
        } = &mut self.marks;
        let mut best = if occupancy.is_closed(start) {
            u32::MAX
        } else {
            flood.cost(start)
        };
        open.clear();
        open.push(Reverse((0, start)));
        back[start] = 0;
        touched.push(start);
        while let Some(Reverse((distance, cell))) = open.pop() {
            // The rest of the path crosses the goal's own ground, whose distance from the agent is at least `least`.
            if distance.saturating_add(least) >= best {
                break;
            }
            if distance > back[cell] {
                continue;
            }
            let Some(rest) = searches_left.checked_sub(1) else {
                break;
            };
            *searches_left = rest;
            for (step, is_diagonal) in grid.around() {
                let other = cell.wrapping_add_signed(step);
                if occupancy.is_closed(other) {
                    continue;
                }
                let is_blocked = occupancy.count(other) > u32::from(own.covers(other, grid));
                let cost = if is_diagonal { DIAGONAL } else { STRAIGHT } * if is_blocked { BLOCKED } else { 1 };
                let through = distance + cost;
                if through < back[other] {
                    if back[other] == u32::MAX {
                        touched.push(other);
                    }
                    back[other] = through;
                    open.push(Reverse((through, other)));
                    best = best.min(through.saturating_add(flood.cost(other)));
                }
            }
        }
        touched.drain(..).for_each(|cell| back[cell] = u32::MAX);
        best
    }
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Object, Wall, WorldDraft};
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    /// Reference implementation that shares only the step costs with the real one. Without queue, rim or marks, it relaxes all
    /// cells until nothing changes.
    struct SlowPlan {
        cells: [i64; 2],
        side: f32,
        corner: [f32; 2],
        tenths: Vec<f64>,
    }

    impl SlowPlan {
        fn to(world: &World, scene: &Scene, goal: [f32; 2], avoided: &[u32]) -> Self {
            let [width, depth] = scene.arena_size();
            let side = (width.max(depth) / 256.0).max(0.5);
            let cells = [width, depth].map(|metres| ((metres / side).ceil() as i64).max(1));
            let corner = [-width / 2.0, -depth / 2.0];
            let mut plan = Self {
                cells,
                side,
                corner,
                tenths: vec![f64::INFINITY; (cells[0] * cells[1]) as usize],
            };
            let is_blocked: Vec<bool> = (0..cells[0] * cells[1])
                .map(|cell| plan.is_blocked(plan.centre(cell), world, scene, avoided))
                .collect();
            let start = plan.cell(goal);
            plan.tenths[start] = 0.0;
            loop {
                let mut changed = false;
                for cell in 0..cells[0] * cells[1] {
                    let weight = if is_blocked[cell as usize] { 40.0 } else { 1.0 };
                    for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                        let [x, y] = [cell % cells[0] + dx, cell / cells[0] + dy];
                        if (dx, dy) == (0, 0) || x < 0 || y < 0 || x >= cells[0] || y >= cells[1] {
                            continue;
                        }
                        let step = if dx != 0 && dy != 0 { 14.0 } else { 10.0 };
                        let through = plan.tenths[(y * cells[0] + x) as usize] + step * weight;
                        if through < plan.tenths[cell as usize] {
                            plan.tenths[cell as usize] = through;
                            changed = true;
                        }
                    }
                }
                if !changed {
                    return plan;
                }
            }
        }

        fn centre(&self, cell: i64) -> [f32; 2] {
            let place = |axis: usize, index: i64| self.corner[axis] + (index as f32 + 0.5) * self.side;
            [place(0, cell % self.cells[0]), place(1, cell / self.cells[0])]
        }

        fn cell(&self, place: [f32; 2]) -> usize {
            let [x, y] = [0, 1].map(|axis| {
                let index = ((place[axis] - self.corner[axis]) / self.side).floor() as i64;
                index.clamp(0, self.cells[axis] - 1)
            });
            (y * self.cells[0] + x) as usize
        }

        fn metres(&self, from: [f32; 2]) -> f64 {
            self.tenths[self.cell(from)] / 10.0 * f64::from(self.side)
        }

        fn is_blocked(&self, at: [f32; 2], world: &World, scene: &Scene, avoided: &[u32]) -> bool {
            let body = world.agent_params.agent_width as f32 / 2.0;
            let margin = body + 0.15;
            let distance = |[x, y]: [f32; 2]| ((at[0] - x).powi(2) + (at[1] - y).powi(2)).sqrt();
            let is_at_rim = (0..2).any(|axis| -self.corner[axis] - at[axis].abs() < body);
            let is_at_object = avoided.iter().any(|&index| {
                let item = &scene.items[index as usize];
                let place = world.objects[index as usize].coordinates.map(|metres| metres as f32);
                distance(place) < item.body.collider.radius() * item.scale + margin
            });
            let is_at_wall = world.environment_params.walls.iter().any(|wall| {
                let corners: Vec<[f32; 2]> = wall.polygon.iter().map(|corner| corner.map(|m| m as f32)).collect();
                // Convex and counter-clockwise, as generated below.
                let edges = corners.iter().zip(corners.iter().cycle().skip(1));
                let left = |a: &[f32; 2], b: &[f32; 2]| (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
                edges.clone().all(|(a, b)| left(a, b) > 0.0)
                    || edges.clone().any(|(a, b)| {
                        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                        let along = ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy);
                        let along = along.clamp(0.0, 1.0);
                        distance([a[0] + along * dx, a[1] + along * dy]) < margin
                    })
            });
            is_at_rim || is_at_object || is_at_wall
        }
    }

    /// A rotated rectangle.
    fn wall() -> impl Strategy<Value = Wall> {
        ([-12.0..=12.0, -12.0..=12.0f64], [0.3..=5.0, 0.3..=5.0f64], 0.0..=3.2f64).prop_map(|(centre, half, turn)| {
            let (sin, cos) = (libm::sin(turn), libm::cos(turn));
            let corner = |[x, y]: [f64; 2]| [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos];
            let [x, y] = half;
            Wall {
                polygon: [[-x, -y], [x, -y], [x, y], [-x, y]].map(corner).to_vec(),
                height: None,
                color: None,
            }
        })
    }

    /// An arena with walls and cubes of all sizes, some of them in clusters or inside walls.
    fn world() -> impl Strategy<Value = World> {
        let cube = ([-13.0..=13.0, -13.0..=13.0], 0.3..=4.0f64, 0.0..=1.0).prop_map(|(place, scale, chance)| {
            let mut cube = Object::new("cube", place);
            (cube.scale, cube.reward_probability) = (scale, chance);
            cube
        });
        (
            [5.0..=27.0, 5.0..=27.0f64],
            vec(wall(), 0..4),
            vec(cube, 1..9),
            0.2..=2.0f64,
        )
            .prop_map(|(size, walls, objects, width)| {
                let mut world = WorldDraft::with_objects(objects);
                world.environment_params.map_size = size;
                world.environment_params.walls = walls;
                world.agent_params.agent_width = width;
                world.check().expect("the world is valid")
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 96)))]

        /// One instance is reused for several worlds, as agents do, and avoids only some of the objects.
        #[test]
        fn path_lengths_and_nearest_goal_match_a_slow_reference(
            worlds in vec((world(), [-13.0..=13.0, -13.0..=13.0f32], any::<u16>()), 1..3),
        ) {
            let mut route = Route::default();
            for (world, from, solid) in worlds {
                let scene = Scene::from_world(&world);
                let chosen = (0..world.objects.len() as u32).filter(|index| solid >> index & 1 == 1);
                let avoided: Vec<u32> = chosen.collect();
                let goals: Vec<Goal> = (0..world.objects.len())
                    .map(|index| Goal {
                        object: index as u32,
                        place: scene.items[index].position,
                        probability: world.objects[index].reward_probability.max(0.01) as f32,
                    })
                    .collect();
                let mut costs = Vec::new();
                for goal in &goals {
                    let others: Vec<u32> = avoided.iter().copied().filter(|index| *index != goal.object).collect();
                    let slow = SlowPlan::to(&world, &scene, goal.place, &others);
                    route.lead(&world, &scene, goal.place, &others);
                    // Queries near and far, so that the flood has to grow.
                    for from in [goal.place.map(|metres| metres * 0.5), from, [12.0, -12.0]] {
                        let cell = route.occupancy.grid().cell_at(from);
                        let found = route.reach(cell);
                        let (found, expected) = (f64::from(route.metres(found)), slow.metres(from));
                        prop_assert!((found - expected).abs() <= 1e-4 * expected, "{} for {}", found, expected);
                    }
                    costs.push(slow.metres(from) / f64::from(goal.probability));
                }
                let chosen = route.nearest(&world, &scene, from, &goals, &avoided).expect("there are goals");
                let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
                prop_assert!(costs[chosen] <= least * (1.0 + 1e-6), "{} is chosen: {:?}", chosen, costs);
            }
        }
    }
}
