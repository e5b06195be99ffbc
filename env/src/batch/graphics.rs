//! Draws the images of a whole batch together, for renderers that are faster that way.

use super::images::{ImagesMut, blank_unrequested};
use super::slot::Slot;
use crate::EnvError;
use crate::render::{Picture, Renderer};

/// Draws the views of the chosen environments' agents.
pub(super) fn draw(
    renderer: &mut Renderer,
    slots: &[Slot],
    images: ImagesMut<'_>,
    is_chosen: impl Fn(usize, &Slot) -> bool,
) -> Result<(), EnvError> {
    let targets = images.targets(slots.len());
    let (mut pictures, carried): (Vec<Picture<'_>>, Vec<&[u32]>) = slots
        .iter()
        .zip(targets)
        .enumerate()
        .filter(|(env, (slot, _))| is_chosen(*env, slot))
        .map(|(_, (slot, mut target))| {
            if let Some(requested) = slot.reduced_modalities() {
                blank_unrequested(&mut target, requested);
            }
            (slot, target)
        })
        .filter(|(_, target)| !target.is_empty())
        .map(|(slot, target)| {
            let picture = Picture {
                scene: slot.environment.scene(),
                camera: slot.environment.camera(),
                target,
            };
            (picture, slot.environment.shown_carried())
        })
        .unzip();
    renderer.draw_batch(&mut pictures)?;
    for (picture, carried) in pictures.iter_mut().zip(carried) {
        renderer.draw_carried(picture.scene, carried, &mut picture.target);
    }
    Ok(())
}
