//! Looking at a running world: the agent's observation, its camera, pictures from anywhere. How they are drawn is in `render`.

use super::environment::Environment;
use crate::EnvError;
use crate::camera::Camera;
use crate::render::{Frame, Target};

impl Environment {
    /// What the agent sees now, at the world's observation size, in all modalities. Drawn when asked for, never before.
    pub fn observe(&mut self) -> &Frame {
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
        if self.renderer.draw(&self.scene, &camera, &mut target).is_err() {
            // Only for so many points that no buffer holds them: then one a pixel.
            self.renderer.render(&self.scene, &camera, &mut self.frame);
        }
        &self.frame
    }

    /// The agent's camera.
    pub fn camera(&self) -> Camera {
        let agent = &self.world.agent_params;
        Camera::first_person(
            self.episode.agent.position,
            self.episode.agent.heading_deg,
            agent.agent_height as f32,
            agent.field_of_view as f32,
        )
    }

    /// A picture of any size from any camera.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] unless both sides are 1 to 4096 pixels.
    pub fn render(&mut self, camera: &Camera, width: u32, height: u32) -> Result<Frame, EnvError> {
        if !(1..=4096).contains(&width) || !(1..=4096).contains(&height) {
            return Err(EnvError::PictureSize { width, height });
        }
        let mut frame = Frame::new(width, height);
        self.renderer.render(&self.scene, camera, &mut frame);
        Ok(frame)
    }
}
