//! One picture of several that are drawn together. How they are drawn is the renderers'.

use super::target::Target;
use crate::camera::Camera;
use crate::scene::Scene;

/// What to draw, from where, and into which images.
#[derive(Debug)]
pub struct Picture<'a> {
    /// What there is to see.
    pub scene: &'a Scene,
    /// From where it is seen.
    pub camera: Camera,
    /// The images to fill.
    pub target: Target<'a>,
}
