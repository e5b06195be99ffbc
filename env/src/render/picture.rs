//! [`Picture`]: one of several images that are rendered together.

use super::target::Target;
use crate::camera::Camera;
use crate::scene::Scene;

/// A scene, a camera, and the images to fill.
#[derive(Debug)]
pub struct Picture<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera.
    pub camera: Camera,
    /// The images to fill.
    pub target: Target<'a>,
}
