//! [`Environment::step`]: applies an action over its time steps, and computes the reward and the end of the episode.

use driftworld_spec::{ActionModel, LastEvent, ZoneEnd};

use super::action::{Action, Intent};
use super::agent_motion::apply_action;
use super::energy::use_energy;
use super::environment::Environment;
use super::event::{EndedBy, Step};
use super::interactions::{Objects, apply_stimuli};
use super::motion::move_objects;
use super::respawn::respawn;
use super::reward;
use super::sim_ref::SimRef;
use super::termination::check_termination;
use super::zones::{apply_zones, slowed};
use crate::EnvError;

impl Environment {
    /// Steps the agent: in each time step it turns and moves, and the objects that it meets react.
    ///
    /// # Errors
    /// [`EnvError`] if the action is invalid or the episode has ended; nothing is changed then.
    pub fn step(&mut self, action: Action) -> Result<Step, EnvError> {
        let mut step = Step::default();
        self.step_into(action, &mut step)?;
        Ok(step)
    }

    /// Like [`Environment::step`], but reuses the memory of `step`.
    ///
    /// # Errors
    /// The errors of [`Environment::step`]; `step` is unchanged then.
    pub fn step_into(&mut self, action: Action, step: &mut Step) -> Result<(), EnvError> {
        let numbers = self.numbers(action)?;
        let intent = self.intent(numbers);
        self.step_by(intent, step);
        Ok(())
    }

    /// Takes one step with a command for the body, independent of the action space.
    pub(crate) fn step_by(&mut self, mut intent: Intent, step: &mut Step) {
        step.clear();
        let potential_before = reward::potential(&self.world, &self.state);
        step.reward = self.world.rules.step_reward;
        let pay = self.world.rules.reward_per_second * self.world.agent_params.time_step;
        let max_ticks = self.world.max_ticks().unwrap_or(u64::MAX);
        for _ in 0..self.world.agent_params.frame_skip.max(1) {
            step.reward += pay;
            let zone = self.tick(intent, step);
            check_termination(&self.world, &self.state, self.had_targets, zone, step);
            if step.terminated || self.state.ticks >= max_ticks {
                break;
            }
            intent.interact = false;
        }
        let state = &mut self.state;
        state.steps = state.steps.saturating_add(1);
        state.unshaped += step.reward;
        let steps_are_over = self.world.max_steps > 0 && state.steps >= self.world.max_steps;
        step.truncated = !step.terminated && (steps_are_over || state.ticks >= max_ticks);
        if step.truncated {
            let limit = if steps_are_over { EndedBy::Steps } else { EndedBy::Time };
            step.ended_by = Some(limit);
        }
        if let Some(shaping) = reward::shaping(&self.world, state, potential_before, step.terminated) {
            step.reward += shaping;
        }
        state.earned += step.reward;
        state.last_reward = step.reward;
        state.last_event = step.events.last().map(|event| LastEvent {
            stimulus: event.stimulus,
            reward: event.reward,
            destroyed: event.destroyed,
        });
        state.ended = step.ended();
    }

    /// Checks whether the action could be carried out now.
    ///
    /// # Errors
    /// The errors of [`Environment::step`].
    pub fn check(&self, action: Action) -> Result<(), EnvError> {
        self.numbers(action).map(drop)
    }

    /// The numbers of the action, if it can be carried out now.
    pub(super) fn numbers(&self, action: Action) -> Result<[f64; 3], EnvError> {
        if self.state.ended {
            return Err(EnvError::Ended);
        }
        action.numbers(&self.world)
    }

    /// The agent's command. In a world on rails, the policy gives it instead of the action.
    pub(super) fn intent(&mut self, numbers: [f64; 3]) -> Intent {
        let Self {
            world, state, views, ..
        } = self;
        let agent = &world.agent_params;
        match &mut self.rails {
            Some(policy) => Intent::new(
                ActionModel::ByVelocity,
                policy.steer(SimRef { world, state, views }),
                agent,
            ),
            None => Intent::new(agent.action_model, numbers, agent),
        }
    }

    /// Runs one time step; returns how a zone ends the episode, if one does.
    fn tick(&mut self, intent: Intent, step: &mut Step) -> Option<ZoneEnd> {
        let Self {
            world,
            state,
            views,
            encounters,
            stimuli,
            ..
        } = self;
        state.ticks += 1;
        encounters.clear();
        let intent = slowed(intent, state, &views.zones);
        apply_action(world, state, views, intent, encounters);
        use_energy(world, state, views);
        respawn(world, state, views, encounters);
        move_objects(world, state, views, encounters);
        let objects = Objects {
            world,
            tags: &self.tags,
        };
        apply_stimuli(objects, state, views, intent, encounters, stimuli, step);
        apply_zones(world, state, views, step)
    }
}
