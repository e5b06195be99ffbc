//! One step of a world: the action, its time steps, what the rules make of them. What touching things does is in `interactions.rs`,
//! endings are in `termination.rs`.

use driftworld_spec::{ActionModel, LastEvent};

use super::action::{Action, Intent};
use super::environment::Environment;
use super::event::Step;
use super::state::wrapped;
use crate::EnvError;

impl Environment {
    /// Lets the agent act for one step: in each of its time steps it turns, moves, and what it meets answers.
    ///
    /// # Errors
    /// [`EnvError`] for an action that cannot be carried out, or after the end; nothing is changed then.
    pub fn step(&mut self, action: Action) -> Result<Step, EnvError> {
        let mut step = Step::default();
        self.step_into(action, &mut step)?;
        Ok(step)
    }

    /// As [`Environment::step`], into a step whose memory is used again.
    ///
    /// # Errors
    /// Those of [`Environment::step`]; `step` is as it was then.
    pub fn step_into(&mut self, action: Action, step: &mut Step) -> Result<(), EnvError> {
        let numbers = self.numbers(action)?;
        let mut intent = self.intent(numbers);
        step.clear();
        let potential_before = self.potential();
        step.reward = self.world.rules.step_reward;
        let pay = self.world.rules.reward_per_second * self.world.agent_params.time_step;
        let max_ticks = self.world.max_ticks().unwrap_or(u64::MAX);
        for _ in 0..self.world.agent_params.frame_skip.max(1) {
            step.reward += pay;
            self.tick(intent, step);
            self.check_termination(step);
            if step.terminated || self.episode.ticks >= max_ticks {
                break;
            }
            intent.interact = false;
        }
        self.episode.steps = self.episode.steps.saturating_add(1);
        self.episode.unshaped += step.reward;
        let steps_are_over = self.world.max_steps > 0 && self.episode.steps >= self.world.max_steps;
        step.truncated = !step.terminated && (steps_are_over || self.episode.ticks >= max_ticks);
        if let Some(shaping) = &self.world.rules.shaping {
            let after = if step.terminated { 0.0 } else { self.potential() };
            step.reward += shaping.discount * after - potential_before;
        }
        self.episode.earned += step.reward;
        self.episode.last_reward = step.reward;
        self.episode.last_event = step.events.last().map(|event| LastEvent {
            stimulus: event.stimulus,
            reward: event.reward,
            destroyed: event.destroyed,
        });
        self.episode.ended = step.ended();
        Ok(())
    }

    /// Whether the action could be carried out now.
    ///
    /// # Errors
    /// Those of [`Environment::step`].
    pub fn check(&self, action: Action) -> Result<(), EnvError> {
        self.numbers(action).map(drop)
    }

    /// What the action says, if it can be carried out now.
    fn numbers(&self, action: Action) -> Result<[f64; 3], EnvError> {
        if self.episode.ended {
            return Err(EnvError::Ended);
        }
        action.numbers(&self.world)
    }

    fn intent(&mut self, numbers: [f64; 3]) -> Intent {
        let agent = &self.world.agent_params;
        let Some(mut rails) = self.episode.rails.take() else {
            return Intent::new(agent.action_model, numbers, agent);
        };
        let numbers = rails.steer(self);
        self.episode.rails = Some(rails);
        Intent::new(ActionModel::ByVelocity, numbers, &self.world.agent_params)
    }

    /// One time step.
    fn tick(&mut self, intent: Intent, step: &mut Step) {
        self.episode.ticks += 1;
        self.apply_action(intent);
        self.respawn();
        self.move_objects();
        self.apply_stimuli(intent, step);
    }

    /// Turns and moves the agent, and notes the objects it meets on the way.
    fn apply_action(&mut self, intent: Intent) {
        let start = self.episode.agent.position;
        self.episode.agent.heading_deg = wrapped(self.episode.agent.heading_deg + intent.turn_deg);
        let by = match intent.towards {
            Some((point, reach)) => {
                let way = [point[0] - start[0], point[1] - start[1]];
                let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
                let share = if length > reach { reach / length } else { 1.0 };
                way.map(|metres| metres * share)
            }
            None => self.episode.agent.forward().map(|part| part * intent.ahead),
        };
        self.scratch.met.clear();
        self.scratch.moved.clear();
        self.scratch.arrived.clear();
        let by = self.push_bodies(by);
        let position = self.ground.slide(start, by);
        let objects = &self.world.objects;
        let movers = &self.episode.movers;
        // Ghosts that move are met where both ways lead, which is known when they have moved.
        let moves = |object: u32| {
            movers
                .binary_search_by_key(&(object as usize), |mover| mover.object)
                .is_ok()
        };
        let skipped = |object: u32| !objects[object as usize].solid && moves(object);
        self.ground.note_passed(&mut self.scratch.met, skipped);
        self.scratch.kept.clear();
        let contacts = self.episode.contacts.iter().copied();
        let ground = &self.ground;
        self.scratch
            .kept
            .extend(contacts.filter(|index| ground.is_still_touched(*index, position)));
        self.episode.agent.position = position;
        let seconds = self.world.agent_params.time_step as f32;
        self.episode.agent.velocity = [0, 1].map(|axis| (position[axis] - start[axis]) / seconds);
    }
}
