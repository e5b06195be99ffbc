//! Runs the simulator from arbitrary states, one macro action at a time.

use driftworld_spec::{ActionModel, World};

use crate::EnvError;
use crate::agents::in_space;
use crate::assets::Catalogue;
use crate::sim::{Environment, Snapshot, Step};

/// Number of macro actions: ahead, ahead and left, ahead and right, left, right, and interact.
pub const NUM_MACRO_ACTIONS: usize = 6;

/// Result of one macro action.
#[derive(Clone, Copy, Debug)]
pub(super) struct MacroResult {
    pub(super) place: [f32; 2],
    pub(super) heading_deg: f32,
    pub(super) reward: f64,
    pub(super) ended: bool,
}

/// Runs macro actions in one world, which is restored to its start each time.
pub(super) struct Walker {
    environment: Environment,
    start: Snapshot,
    step: Step,
    /// World steps per macro action.
    steps: u32,
}

impl Walker {
    /// A walker for this world without time limits; uncertain rewards pay their mean.
    pub(super) fn new(world: &World, seconds: f64, catalogue: &Catalogue) -> Result<Self, EnvError> {
        let endless = world.clone().edit(|world| {
            (world.max_steps, world.max_seconds, world.progress) = (0, 0.0, None);
            for object in &mut world.objects {
                if object.reward_probability < 1.0 {
                    object.reward *= object.reward_probability;
                    object.reward_probability = 1.0;
                }
            }
        });
        let endless = endless.map_err(|problem| EnvError::BadWorld { problem })?;
        let agent = &endless.agent_params;
        let step_seconds = agent.time_step * f64::from(agent.frame_skip.max(1));
        let steps = (seconds / step_seconds - 1e-6).ceil().max(1.0) as u32;
        let environment = Environment::with_catalogue(endless, catalogue.clone());
        Ok(Self {
            start: environment.snapshot(),
            environment,
            step: Step::default(),
            steps,
        })
    }

    /// Whether all actions have the same effect.
    pub(super) fn ignores_actions(&self) -> bool {
        let model = self.environment.world().agent_params.action_model;
        matches!(model, ActionModel::OnRails | ActionModel::None)
    }

    /// Whether the agent fits at a position in metres.
    pub(super) fn can_stand(&mut self, place: [f64; 2]) -> bool {
        self.environment.restore(&self.start);
        self.environment.teleport(place, 0.0).is_ok()
    }

    /// Runs a macro action from a pose, with everything else as at the start.
    pub(super) fn walk(&mut self, place: [f64; 2], heading_deg: f64, action: usize) -> Result<MacroResult, EnvError> {
        self.environment.restore(&self.start);
        self.environment.teleport(place, heading_deg)?;
        let (mut reward, mut ended) = (0.0, false);
        for step in 0..self.steps {
            let command = in_space(self.command(action, step == 0), self.environment.sim());
            self.environment.step_into(command, &mut self.step)?;
            reward += self.step.reward;
            if self.step.terminated {
                ended = true;
                break;
            }
        }
        let agent = self.environment.agent();
        Ok(MacroResult {
            place: agent.position,
            heading_deg: agent.heading_deg,
            reward,
            ended,
        })
    }

    /// Speed, turn rate and interaction of a macro action.
    fn command(&self, action: usize, is_first: bool) -> [f64; 3] {
        debug_assert!(action < NUM_MACRO_ACTIONS);
        let agent = &self.environment.world().agent_params;
        let (speed, turn) = (agent.max_linear_speed, agent.max_angular_speed);
        match action {
            0 => [speed, 0.0, 0.0],
            1 => [speed, -turn, 0.0],
            2 => [speed, turn, 0.0],
            3 => [0.0, -turn, 0.0],
            4 => [0.0, turn, 0.0],
            _ => [0.0, 0.0, if is_first && agent.interact { 1.0 } else { 0.0 }],
        }
    }
}
