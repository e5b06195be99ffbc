//! The poses from which worlds are compared by pictures.

use driftworld_env::{Catalogue, Environment};
use driftworld_spec::World;

use super::{GRID_SIDE, HEADINGS};
use crate::distances::DistancesError;

/// A position and a direction of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    /// Metres east and north of the arena's centre.
    pub(crate) position: [f64; 2],
    /// Degrees clockwise from north (+y).
    pub(crate) heading_deg: f64,
}

/// Poses that are free in all of these worlds.
///
/// The rectangle around the centre that all arenas share is divided into 4 × 4 cells. The agent stands at the centre of each
/// cell and looks in 4 directions, north first. Cells with a blocked centre in any world (by a wall, a forbidden region or a
/// solid object) are left out. The order is row by row from the south-west.
///
/// # Errors
/// [`DistancesError::NoPlace`] if no cell is left.
pub(crate) fn poses(worlds: &[&World], catalogue: &Catalogue) -> Result<Vec<Pose>, DistancesError> {
    let sizes = worlds.iter().map(|world| world.environment_params.arena_size());
    let [width, depth] = sizes.fold([f64::INFINITY; 2], |smallest, size| {
        [smallest[0].min(size[0]), smallest[1].min(size[1])]
    });
    let mut environments: Vec<Environment> = worlds
        .iter()
        .map(|world| Environment::with_catalogue((*world).clone(), catalogue.clone()))
        .collect();
    let middle = |cell: u32, side: f64| side * ((f64::from(cell) + 0.5) / f64::from(GRID_SIDE) - 0.5);
    let mut poses = Vec::new();
    for (row, column) in (0..GRID_SIDE).flat_map(|row| (0..GRID_SIDE).map(move |column| (row, column))) {
        let position = [middle(column, width), middle(row, depth)];
        // There is no arena without worlds.
        if environments.is_empty()
            || environments
                .iter_mut()
                .any(|environment| environment.teleport(position, 0.0).is_err())
        {
            continue;
        }
        poses.extend((0..HEADINGS).map(|k| Pose {
            position,
            heading_deg: 360.0 * f64::from(k) / f64::from(HEADINGS),
        }));
    }
    if poses.is_empty() {
        let tried = GRID_SIDE * GRID_SIDE;
        return Err(DistancesError::NoPlace { tried });
    }
    Ok(poses)
}
