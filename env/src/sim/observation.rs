//! Looking at a running world: the agent's observation, its camera, pictures from anywhere. How they are drawn is in
//! `render`.

use super::environment::Environment;
use crate::EnvError;
use crate::camera::Camera;
use crate::render::{CpuRenderer, Frame, Target};

impl Environment {
    /// What the agent sees now, at the world's observation size. Drawn when asked for, never before.
    ///
    /// Should a graphics card fail, the processor draws in its place; [`Environment::try_observe`] says so instead.
    pub fn observe(&mut self) -> &Frame {
        if self.draw_observation().is_err() {
            let camera = self.camera();
            // On the processor: only for so many points that no buffer holds them, then one a pixel.
            CpuRenderer::new().render(&self.views.scene, &camera, &mut self.frame);
        }
        &self.frame
    }

    /// As [`Environment::observe`], but nothing takes the place of a graphics card that fails.
    ///
    /// # Errors
    /// As [`Renderer::draw_batch`](crate::Renderer::draw_batch).
    pub fn try_observe(&mut self) -> Result<&Frame, EnvError> {
        self.draw_observation()?;
        Ok(&self.frame)
    }

    fn draw_observation(&mut self) -> Result<(), EnvError> {
        let agent = &self.world.agent_params;
        let ([width, height], supersampling) = (agent.picture_size(), agent.supersampling);
        if (self.frame.width, self.frame.height) != (width, height) {
            self.frame = Frame::new(width, height);
        }
        let camera = self.camera();
        let mut target = Target {
            supersampling,
            ..self.frame.target()
        };
        self.renderer.draw(&self.views.scene, &camera, &mut target)
    }

    /// The agent's camera.
    pub fn camera(&self) -> Camera {
        let agent = &self.world.agent_params;
        Camera::first_person(
            self.state.agent.position,
            self.state.agent.heading_deg,
            agent.agent_height as f32,
            agent.field_of_view as f32,
        )
    }

    /// A picture of any size from any camera.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] unless both sides are 1 to 4096 pixels; on a graphics card, as
    /// [`Renderer::draw_batch`](crate::Renderer::draw_batch).
    pub fn render(&mut self, camera: &Camera, width: u32, height: u32) -> Result<Frame, EnvError> {
        if !(1..=4096).contains(&width) || !(1..=4096).contains(&height) {
            return Err(EnvError::PictureSize { width, height });
        }
        let mut frame = Frame::new(width, height);
        self.renderer.render(&self.views.scene, camera, &mut frame)?;
        Ok(frame)
    }
}
