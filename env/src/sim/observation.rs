//! Views of a running world: the agent's observation, its camera, and images from any camera.

use driftworld_spec::World;

use super::environment::Environment;
use super::state::SimState;
use crate::EnvError;
use crate::camera::Camera;
use crate::render::{CpuRenderer, Frame, Target};

impl Environment {
    /// The agent's current view, at the world's observation size. Rendered on demand.
    ///
    /// If a GPU fails, the CPU renders instead.
    pub fn observe(&mut self) -> &Frame {
        let [width, height] = self.world.agent_params.picture_size();
        let mut frame = std::mem::replace(&mut self.frame, Frame::new(0, 0));
        if [frame.width, frame.height] != [width, height] {
            frame = Frame::new(width, height);
        }
        if self.draw_into(frame.target()).is_err() {
            // With several samples per pixel, drawing may fail; `render` uses one sample per pixel.
            let mut renderer = CpuRenderer::new();
            renderer.render(self.scene(), &self.camera(), &mut frame);
            self.draw_carried(&mut renderer, &mut frame.target());
        }
        self.frame = frame;
        &self.frame
    }

    /// Renders the agent's view into images of any size; images that are not in the target stay unchanged.
    pub(crate) fn draw_into(&mut self, target: Target) -> Result<(), EnvError> {
        let mut target = Target {
            supersampling: self.world.agent_params.supersampling,
            ..target
        };
        let camera = self.camera();
        self.renderer.draw(&self.views.scene, &camera, &mut target)?;
        let carried = carried_to_show(&self.world, &self.state);
        self.renderer.draw_carried(&self.views.scene, carried, &mut target);
        Ok(())
    }

    /// The indices of the carried objects to show in images of the agent's view; empty unless the world shows them.
    pub(crate) fn shown_carried(&self) -> &[u32] {
        carried_to_show(&self.world, &self.state)
    }

    /// If the world shows carried objects, draws them at the bottom of the target's colour image, which shows the agent's view.
    /// Other images stay unchanged.
    pub fn draw_carried(&self, renderer: &mut CpuRenderer, target: &mut Target<'_>) {
        renderer.draw_carried(&self.views.scene, self.shown_carried(), target);
    }

    /// The agent's current view, at any size, with one sample per pixel.
    ///
    /// # Errors
    /// The errors of [`Environment::render`].
    pub fn observe_at(&mut self, width: u32, height: u32) -> Result<Frame, EnvError> {
        let mut frame = self.render(&self.camera(), width, height)?;
        let carried = carried_to_show(&self.world, &self.state);
        self.renderer
            .draw_carried(&self.views.scene, carried, &mut frame.target());
        Ok(frame)
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

    /// An image of any size from any camera.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] unless both sides are 1 to 4096 pixels; on a GPU, also the errors of
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

/// The carried objects, if the world shows them.
fn carried_to_show<'a>(world: &World, state: &'a SimState) -> &'a [u32] {
    if world.agent_params.show_carried {
        state.carried()
    } else {
        &[]
    }
}
