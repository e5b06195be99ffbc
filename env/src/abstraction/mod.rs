//! Turns a world into a finite, deterministic decision process: cells × headings, with transitions from the simulator.

mod grid;
#[cfg(test)]
mod tests;
mod walker;

use driftworld_spec::World;
use rayon::prelude::*;

pub use grid::{NUM_HEADINGS, StateGrid};
pub use walker::NUM_MACRO_ACTIONS;

use crate::EnvError;
use crate::assets::Catalogue;
use walker::{MacroResult, Walker};

/// Maximum number of states of a [`WorldAbstraction`].
pub const MAX_ABSTRACT_STATES: usize = 1 << 20;

/// Maximum duration of a macro action in seconds.
pub const MAX_MACRO_SECONDS: f64 = 60.0;

/// Settings for computing a [`WorldAbstraction`].
#[derive(Clone, Debug)]
pub struct Abstraction {
    /// Side of a cell in metres, above 0; 2 by default.
    pub cell: f64,
    /// Seconds of simulated time for which an action is held, above 0 to [`MAX_MACRO_SECONDS`]; 0.5 by default. Rounded up to
    /// whole steps of the world.
    pub seconds: f64,
    /// Side lengths in metres of the area that the cells cover; by default the world's arena.
    pub area: Option<[f64; 2]>,
    /// The catalogue of assets.
    pub catalogue: Catalogue,
}

impl Default for Abstraction {
    fn default() -> Self {
        Self {
            cell: 2.0,
            seconds: 0.5,
            area: None,
            catalogue: Catalogue::default(),
        }
    }
}

/// Transition and reward tables of a world.
///
/// A state is a cell and a heading. Each action starts with everything else as at the start of the world: every object is
/// present, pays its initial reward, and begins its motion. So the tables reflect walls, the agent's body and speed, the time
/// step, the duration of actions, the action model, solid and pushed objects, and rewards. Objects that an action collects,
/// pushes or moves are reset afterwards. Step and time limits are ignored. Rules about the return see only the reward of this
/// one action. Uncertain rewards pay their mean.
///
/// Actions are in the order listed at [`NUM_MACRO_ACTIONS`]; each is performed at the agent's full speed, with the nearest row
/// if the world has an action table. An agent that cannot interact stands still instead.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldAbstraction {
    /// Maps between states and poses.
    pub grid: StateGrid,
    /// Number of states, including the end.
    pub states: usize,
    /// Number of actions: [`NUM_MACRO_ACTIONS`].
    pub actions: usize,
    /// `(states · actions,)`, row-major by state: the successor state. The end leads to itself. An action that lands where the
    /// agent has no room leads to the nearest neighbouring state with room, or stays in its state.
    pub successors: Vec<u32>,
    /// `(states · actions,)`: the reward of the action, in points.
    pub rewards: Vec<f64>,
    /// `(states · actions,)`: the agent's pose after the action, before it is rounded to a state: x and y in metres, heading in
    /// degrees.
    pub landings: Vec<[f32; 3]>,
    /// `(states,)`: whether the agent fits at the centre of the state's cell.
    pub standable: Vec<bool>,
    /// The state in which the world starts.
    pub start: usize,
}

impl WorldAbstraction {
    /// Whether each state can be reached from the start: `(states,)`.
    pub fn reached(&self) -> Vec<bool> {
        let mut reached = vec![false; self.states];
        let mut open = vec![self.start];
        reached[self.start] = true;
        while let Some(state) = open.pop() {
            for next in &self.successors[state * self.actions..][..self.actions] {
                let next = *next as usize;
                if !std::mem::replace(&mut reached[next], true) {
                    open.push(next);
                }
            }
        }
        reached
    }
}

impl Abstraction {
    /// Computes a world's tables. Runs in parallel; the result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`EnvError::BadAbstraction`] for settings out of range, [`EnvError::TooManyStates`] above [`MAX_ABSTRACT_STATES`].
    ///
    /// # Example
    /// ```
    /// use driftworld_env::Abstraction;
    /// use driftworld_spec::World;
    /// let found = Abstraction::default().of(&World::default())?;
    /// let start = found.start * found.actions;
    /// assert_eq!(found.landings[start][2], 0.0, "the first action moves ahead without turning");
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn of(&self, world: &World) -> Result<WorldAbstraction, EnvError> {
        let grid = self.grid(world)?;
        let cells = (grid.states() - 1) / NUM_HEADINGS;
        let walker = || Walker::new(world, self.seconds, &self.catalogue);
        let mut first = walker()?;
        let open: Vec<bool> = (0..cells)
            .map(|cell| {
                grid.pose(cell * NUM_HEADINGS)
                    .is_some_and(|(place, _)| first.can_stand(place))
            })
            .collect();
        drop(first);
        let walk_cell = |walker: &mut Result<Walker, EnvError>, cell: usize| {
            let walker = walker.as_mut().map_err(|error| error.clone())?;
            walk_cell(walker, grid, cell, open[cell])
        };
        let results: Vec<Vec<MacroResult>> = (0..cells)
            .into_par_iter()
            .map_init(walker, walk_cell)
            .collect::<Result<_, _>>()?;
        Ok(tables(world, grid, &open, &results))
    }

    fn grid(&self, world: &World) -> Result<StateGrid, EnvError> {
        let check = |what: &'static str, found: f64, most: f64| {
            if found > 0.0 && found <= most {
                return Ok(());
            }
            Err(EnvError::BadAbstraction { what, found, most })
        };
        check("cell", self.cell, 1e6)?;
        check("seconds", self.seconds, MAX_MACRO_SECONDS)?;
        let area = self.area.unwrap_or_else(|| world.environment_params.arena_size());
        for side in area {
            check("area", side, 1e9)?;
        }
        let grid = StateGrid::over(area, self.cell);
        let found = grid.states();
        if found > MAX_ABSTRACT_STATES {
            return Err(EnvError::TooManyStates {
                found,
                most: MAX_ABSTRACT_STATES,
            });
        }
        Ok(grid)
    }
}

/// Results of all actions from a cell's states, ordered by heading, then by action.
fn walk_cell(walker: &mut Walker, grid: StateGrid, cell: usize, is_open: bool) -> Result<Vec<MacroResult>, EnvError> {
    let mut results = Vec::with_capacity(NUM_HEADINGS * NUM_MACRO_ACTIONS);
    for heading in 0..NUM_HEADINGS {
        let Some((place, heading_deg)) = grid.pose(cell * NUM_HEADINGS + heading) else {
            continue;
        };
        let stays = MacroResult {
            place: place.map(|metres| metres as f32),
            heading_deg: heading_deg as f32,
            reward: 0.0,
            ended: false,
        };
        for action in 0..NUM_MACRO_ACTIONS {
            let done = match results.last() {
                _ if !is_open => stays,
                Some(last) if action > 0 && walker.ignores_actions() => *last,
                _ => walker.walk(place, heading_deg, action)?,
            };
            results.push(done);
        }
    }
    Ok(results)
}

fn tables(world: &World, grid: StateGrid, open: &[bool], results: &[Vec<MacroResult>]) -> WorldAbstraction {
    let (states, actions) = (grid.states(), NUM_MACRO_ACTIONS);
    let mut found = WorldAbstraction {
        grid,
        states,
        actions,
        successors: Vec::with_capacity(states * actions),
        rewards: Vec::with_capacity(states * actions),
        landings: Vec::with_capacity(states * actions),
        standable: Vec::with_capacity(states),
        start: 0,
    };
    for (cell, of_cell) in results.iter().enumerate() {
        found.standable.extend([open[cell]; NUM_HEADINGS]);
        for (index, result) in of_cell.iter().enumerate() {
            let from = cell * NUM_HEADINGS + index / actions;
            let place = result.place.map(f64::from);
            let next = if result.ended {
                grid.end()
            } else {
                standable_state(grid, open, place, f64::from(result.heading_deg), from)
            };
            found.successors.push(next as u32);
            found.rewards.push(result.reward);
            found
                .landings
                .push([result.place[0], result.place[1], result.heading_deg]);
        }
    }
    found.successors.extend([grid.end() as u32; NUM_MACRO_ACTIONS]);
    found.rewards.extend([0.0; NUM_MACRO_ACTIONS]);
    found.landings.extend([[0.0; 3]; NUM_MACRO_ACTIONS]);
    found.standable.push(true);
    let agent = &world.agent_params;
    let nominal = grid.state_at(agent.coordinates, agent.heading);
    found.start = standable_state(grid, open, agent.coordinates, agent.heading, nominal);
    found
}

/// The state of a pose. If the agent does not fit in that cell, the state in the nearest of the eight surrounding cells in
/// which it fits; `otherwise` if there is none.
fn standable_state(grid: StateGrid, open: &[bool], place: [f64; 2], heading_deg: f64, otherwise: usize) -> usize {
    let own = grid.state_at(place, heading_deg);
    if open[own / NUM_HEADINGS] {
        return own;
    }
    let offsets = [-1.0, 0.0, 1.0];
    let around = offsets.iter().flat_map(|y| offsets.iter().map(move |x| [*x, *y]));
    let distance = |state: usize| {
        grid.pose(state).map_or(f64::INFINITY, |(middle, _)| {
            (middle[0] - place[0]).powi(2) + (middle[1] - place[1]).powi(2)
        })
    };
    around
        .map(|[x, y]| grid.state_at([place[0] + x * grid.cell, place[1] + y * grid.cell], heading_deg))
        .filter(|state| open[state / NUM_HEADINGS])
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        .unwrap_or(otherwise)
}
