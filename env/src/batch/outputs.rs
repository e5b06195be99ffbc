//! Outputs of a batch: observations, rewards and flags, with one buffer each.

use super::images::{ImageLayout, Images, ImagesMut, filled};
use crate::EnvError;
use crate::render::DepthForm;

/// Observations, rewards and flags of all environments, one after another.
#[derive(Clone, Debug)]
pub struct Outputs {
    /// The agents' images.
    pub images: Images,
    /// The state vectors, `(num_envs, state_len)`.
    pub states: Vec<f32>,
    /// Length of one state vector.
    pub state_len: usize,
    /// Reward of the last step, `(num_envs,)`; 0 in a reset.
    pub rewards: Vec<f64>,
    /// Whether the last step terminated the episode, `(num_envs,)`.
    pub terminated: Vec<bool>,
    /// Whether the last step truncated the episode, `(num_envs,)`.
    pub truncated: Vec<bool>,
    /// Whether the last step ended the episode as a success, `(num_envs,)`.
    pub success: Vec<bool>,
}

/// A mutable view of [`Outputs`] for some environments.
pub(super) struct OutputsMut<'a> {
    pub(super) images: ImagesMut<'a>,
    states: &'a mut [f32],
    state_len: usize,
    rewards: &'a mut [f64],
    terminated: &'a mut [bool],
    truncated: &'a mut [bool],
    success: &'a mut [bool],
}

impl Outputs {
    /// Blank outputs for environments whose episodes have not begun.
    ///
    /// # Errors
    /// [`EnvError::BatchMemory`] if memory is not available.
    pub(super) fn new(
        layout: &ImageLayout,
        form: DepthForm,
        state_len: usize,
        num_envs: usize,
    ) -> Result<Self, EnvError> {
        Ok(Self {
            images: Images::new(layout.clone(), num_envs, form)?,
            states: filled(0.0, num_envs * state_len)?,
            state_len,
            rewards: filled(0.0, num_envs)?,
            terminated: filled(false, num_envs)?,
            truncated: filled(false, num_envs)?,
            success: filled(false, num_envs)?,
        })
    }

    /// Size of the outputs in bytes.
    pub(super) fn bytes(layout: &ImageLayout, form: DepthForm, state_len: usize, num_envs: usize) -> u64 {
        let flags = size_of::<f64>() + 3 * size_of::<bool>();
        let numbers = (state_len * size_of::<f32>() + flags) as u64;
        (layout.bytes(form) + numbers).saturating_mul(num_envs as u64)
    }

    pub(super) fn view(&mut self) -> OutputsMut<'_> {
        OutputsMut {
            images: self.images.view(),
            states: &mut self.states,
            state_len: self.state_len,
            rewards: &mut self.rewards,
            terminated: &mut self.terminated,
            truncated: &mut self.truncated,
            success: &mut self.success,
        }
    }
}

impl OutputsMut<'_> {
    /// Splits off the outputs of the first environments.
    pub(super) fn split(mut self, num_envs: usize) -> (Self, Self) {
        let (images, more_images) = self.images.split(num_envs);
        let rest = Self {
            images: more_images,
            states: self
                .states
                .split_off_mut(num_envs * self.state_len..)
                .unwrap_or_default(),
            state_len: self.state_len,
            rewards: self.rewards.split_off_mut(num_envs..).unwrap_or_default(),
            terminated: self.terminated.split_off_mut(num_envs..).unwrap_or_default(),
            truncated: self.truncated.split_off_mut(num_envs..).unwrap_or_default(),
            success: self.success.split_off_mut(num_envs..).unwrap_or_default(),
        };
        (Self { images, ..self }, rest)
    }

    /// The state vector of one environment, by its index in this view.
    pub(super) fn state(&mut self, env: usize) -> &mut [f32] {
        &mut self.states[env * self.state_len..(env + 1) * self.state_len]
    }

    /// Stores a step's reward and flags.
    pub(super) fn record(&mut self, env: usize, step: &crate::sim::Step) {
        self.rewards[env] = step.reward;
        self.terminated[env] = step.terminated;
        self.truncated[env] = step.truncated;
        self.success[env] = step.success;
    }
}
