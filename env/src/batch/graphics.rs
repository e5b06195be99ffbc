//! The pictures of a whole batch drawn together, for renderers that like it so. What an environment draws by itself is
//! in `slot.rs`.

use super::images::{ImagesMut, blank_unasked};
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
    let (mut pictures, carried): (Vec<Picture<'_>>, Vec<&[u32]>) = slots
        .iter()
        .zip(targets)
        .enumerate()
        .filter(|(env, (slot, _))| is_chosen(*env, slot))
        .map(|(_, (slot, mut target))| {
            if let Some(asked) = slot.blanks() {
                blank_unasked(&mut target, asked);
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
