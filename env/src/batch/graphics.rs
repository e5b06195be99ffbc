//! The pictures of a whole batch drawn together, for renderers that like it so. What an environment draws by itself is
//! in `slot.rs`.

use super::images::ImagesMut;
use super::slot::Slot;
use crate::EnvError;
use crate::render::{Picture, Renderer};

/// Draws what the chosen environments' agents see.
pub(super) fn draw(
    renderer: &mut Renderer,
    slots: &[Slot],
    images: ImagesMut<'_>,
    is_chosen: impl Fn(usize, &Slot) -> bool,
) -> Result<(), EnvError> {
    let targets = images.targets(slots.len());
    let mut pictures: Vec<Picture<'_>> = slots
        .iter()
        .zip(targets)
        .enumerate()
        .filter(|(env, (slot, target))| !target.is_empty() && is_chosen(*env, slot))
        .map(|(_, (slot, target))| Picture {
            scene: slot.environment.scene(),
            camera: slot.environment.camera(),
            target,
        })
        .collect();
    renderer.draw_batch(&mut pictures)
}
