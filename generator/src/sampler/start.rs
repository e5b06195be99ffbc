//! Places the agent in a cell of a layout. A start given as a point or a distribution of points is a hole in the world's
//! template, filled like any other.

use driftworld_spec::{CellKind, Distribution, Legend, WorldDraft};

use super::Sampler;
use crate::GeneratorError;
use crate::cells::Cells;
use crate::clearance::FreeSpace;
use crate::compiled::Start;

impl Sampler {
    /// Places the agent in a cell: as set by the task or the letters of the layout, otherwise in any cell.
    pub(super) fn start_in_cell(
        &self,
        world: &mut WorldDraft,
        free_space: &FreeSpace,
        index: u64,
        attempt: u32,
    ) -> Result<(), GeneratorError> {
        let Some(start) = &self.compiled.start else {
            return Ok(());
        };
        let layout = world.environment_params.layout.as_ref();
        let plan = free_space.plan.as_deref();
        let by_letters;
        let mut is_default = false;
        let (asked, stream) = match start {
            Start::Cells(drawn) => (&drawn.distribution, &drawn.stream),
            Start::Default(stream) => {
                if plan.is_none_or(|plan| plan.cells.is_empty()) {
                    return Ok(());
                }
                let is_start =
                    |letter: &char| layout.is_some_and(|layout| layout.meaning(*letter) == Some(Legend::Start));
                let letters = plan.iter().flat_map(|plan| &plan.cells).filter_map(|cell| cell.letter);
                let letters: String = letters.filter(is_start).collect();
                is_default = letters.is_empty();
                by_letters = Distribution::Cells {
                    kind: CellKind::Any,
                    letter: Some(letters).filter(|letters| !letters.is_empty()),
                    of_group: false,
                    room: None,
                    walk: None,
                    jitter: None,
                };
                (&by_letters, stream)
            }
        };
        let radius = world.agent_params.agent_width / 2.0;
        let is_free =
            |place: [f64; 2], middle: [f64; 2]| place == middle || free_space.clearance(place, radius) >= radius;
        let mut rng = stream.at(index, 0, attempt);
        let found = Cells::find(plan, layout, asked, "", world.agent_params.coordinates)
            .and_then(|mut cells| {
                if is_default {
                    cells.exclude_letters();
                }
                cells.take(&mut rng, is_free).map_err(|(_, reason)| reason)
            })
            .map_err(|reason| GeneratorError::NoStartCell {
                world: self.id(index),
                reason,
            })?;
        world.agent_params.coordinates = found.place;
        Ok(())
    }
}
