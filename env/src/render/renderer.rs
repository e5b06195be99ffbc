//! [`Renderer`]: either the CPU or the GPU renderer.

use super::cpu::CpuRenderer;
use super::frame::Frame;
#[cfg(feature = "gpu")]
use super::gpu::GpuRenderer;
use super::kind::RendererKind;
use super::picture::Picture;
#[cfg(not(feature = "gpu"))]
use super::report::NO_FEATURE;
use super::target::Target;
use crate::EnvError;
use crate::camera::Camera;
use crate::scene::Scene;

/// Renders scenes on the CPU or a GPU.
#[derive(Debug, Default)]
pub struct Renderer(Inner);

#[derive(Debug)]
enum Inner {
    Cpu(Box<CpuRenderer>),
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuRenderer>),
}

impl Default for Inner {
    fn default() -> Self {
        Self::Cpu(Box::default())
    }
}

impl Renderer {
    /// A renderer of this kind.
    ///
    /// # Errors
    /// [`EnvError::NoGpu`] if a GPU is requested and none works, or this build does not support GPUs.
    pub fn new(kind: RendererKind) -> Result<Self, EnvError> {
        match kind {
            RendererKind::Cpu => Ok(Self::default()),
            RendererKind::Gpu => Self::on_gpu(true),
            RendererKind::Auto => Ok(Self::on_gpu(false).unwrap_or_default()),
        }
    }

    /// A renderer on a GPU; with `or_software`, falls back to software emulation of one.
    #[cfg(feature = "gpu")]
    fn on_gpu(or_software: bool) -> Result<Self, EnvError> {
        Ok(Self(Inner::Gpu(Box::new(GpuRenderer::new(or_software)?))))
    }

    #[cfg(not(feature = "gpu"))]
    fn on_gpu(_or_software: bool) -> Result<Self, EnvError> {
        let tried = vec![NO_FEATURE.to_owned()];
        Err(EnvError::NoGpu { tried })
    }

    /// The renderer in use: never [`RendererKind::Auto`].
    pub fn kind(&self) -> RendererKind {
        match &self.0 {
            Inner::Cpu(_) => RendererKind::Cpu,
            #[cfg(feature = "gpu")]
            Inner::Gpu(_) => RendererKind::Gpu,
        }
    }

    /// The device in use, as text: the instruction set, or the adapter and its graphics API.
    pub fn device(&self) -> String {
        match &self.0 {
            Inner::Cpu(renderer) => format!("processor ({})", renderer.instruction_set()),
            #[cfg(feature = "gpu")]
            Inner::Gpu(renderer) => format!("{} ({})", renderer.adapter_name(), renderer.backend()),
        }
    }

    /// Renders all images of a frame.
    ///
    /// # Errors
    /// The errors of [`Renderer::draw_batch`].
    #[cfg_attr(
        not(feature = "gpu"),
        expect(clippy::unnecessary_wraps, reason = "same signature as with the feature")
    )]
    pub fn render(&mut self, scene: &Scene, camera: &Camera, frame: &mut Frame) -> Result<(), EnvError> {
        match &mut self.0 {
            Inner::Cpu(renderer) => {
                renderer.render(scene, camera, frame);
                Ok(())
            }
            #[cfg(feature = "gpu")]
            Inner::Gpu(renderer) => renderer.render(scene, camera, frame),
        }
    }

    /// Renders the images that the target requests.
    ///
    /// # Errors
    /// The errors of [`Renderer::draw_batch`].
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, target: &mut Target<'_>) -> Result<(), EnvError> {
        match &mut self.0 {
            Inner::Cpu(renderer) => renderer.draw(scene, camera, target),
            #[cfg(feature = "gpu")]
            Inner::Gpu(renderer) => renderer.draw(scene, camera, target),
        }
    }

    /// Draws these items of the scene, which the agent carries, at the bottom of the target's colour image.
    pub(crate) fn draw_carried(&mut self, scene: &Scene, carried: &[u32], target: &mut Target<'_>) {
        match &mut self.0 {
            Inner::Cpu(renderer) => renderer.draw_carried(scene, carried, target),
            #[cfg(feature = "gpu")]
            Inner::Gpu(renderer) => renderer.draw_carried(scene, carried, target),
        }
    }

    /// Renders many images; a GPU renders those of the same size together.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] for sizes out of range. On a GPU also [`EnvError::GpuPicture`] for images too large for it,
    /// and [`EnvError::Gpu`] if it fails; some images may be stale then.
    pub fn draw_batch(&mut self, pictures: &mut [Picture<'_>]) -> Result<(), EnvError> {
        match &mut self.0 {
            Inner::Cpu(renderer) => pictures
                .iter_mut()
                .try_for_each(|picture| renderer.draw(picture.scene, &picture.camera, &mut picture.target)),
            #[cfg(feature = "gpu")]
            Inner::Gpu(renderer) => renderer.draw_batch(pictures),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cpu_renderer_is_always_available() {
        let renderer = Renderer::new(RendererKind::Cpu).expect("the CPU renderer always works");
        assert_eq!(renderer.kind(), RendererKind::Cpu);
        assert!(renderer.device().starts_with("processor ("));
        let automatic = Renderer::new(RendererKind::Auto).expect("the CPU renderer always works");
        assert_ne!(automatic.kind(), RendererKind::Auto);
    }

    #[cfg(not(feature = "gpu"))]
    #[test]
    fn missing_gpu_feature_error_says_how_to_build_it() {
        let error = Renderer::new(RendererKind::Gpu).expect_err("this build has no GPU renderer");
        assert!(error.to_string().contains("--features gpu"), "{error}");
    }
}
