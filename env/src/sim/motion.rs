//! Moves the objects that move by themselves, for one time step.

use driftworld_spec::World;

use super::budget::{self, SharedBudget};
use super::encounters::Encounters;
use super::mover::View;
use super::state::SimState;
use super::views::Views;

/// Moves every object that moves by itself, and records its encounters.
pub(super) fn move_objects(world: &World, state: &mut SimState, views: &mut Views, encounters: &mut Encounters) {
    if state.movers.is_empty() {
        return;
    }
    views.bodies.place_agent(state.agent.position);
    let half = views.scene.arena_size().map(|side| side / 2.0);
    let seconds = world.agent_params.time_step as f32;
    let agent = state.agent.position;
    let count = budget::MOVERS + budget::PER_MOVER * state.movers.len() as u64;
    let mut budget = SharedBudget::new(count, state.movers.len(), state.ticks);
    for (number, mover) in state.movers.iter_mut().enumerate() {
        let index = mover.object;
        let (object, own) = (&world.objects[index], &mut state.objects[index]);
        if !own.present {
            continue;
        }
        let from = own.position;
        let view = View {
            position: from,
            heading_deg: own.heading_deg,
            agent,
            half,
            seconds,
        };
        if let Some(stride) = mover.decide(object, view) {
            let turn = [own.heading_deg, stride.heading_deg];
            let pose = views.bodies.push(index as u32, stride.by, turn, budget.at(number));
            if let Some(pose) = pose {
                (own.position, own.heading_deg) = pose;
                views.sync_object(index, object, own);
                mover.report_motion(stride.by, [0, 1].map(|axis| own.position[axis] - from[axis]));
            }
        }
        let actual = [0, 1].map(|axis| own.position[axis] - from[axis]);
        let has_moved = actual != [0.0; 2];
        if has_moved {
            encounters.moved.push((index, from));
        }
        // The agent and a ghost move simultaneously; a solid body moves after the agent and stops in front of it.
        let path_start = if object.solid { agent } else { views.bodies.path_start() };
        if has_moved || !object.solid {
            views.bodies.record_if_touched_in_motion(
                index as u32,
                actual,
                [path_start, agent],
                &mut encounters.met_objects,
            );
        }
    }
    #[cfg(test)]
    (encounters.num_queries += count - budget.left());
}
