//! Samples the objects of a group: their number, kinds, positions and headings. `placement.rs` finds free positions.

use driftworld_spec::{Distribution, Turns, Value, WorldDraft};

use super::Sampler;
use crate::GeneratorError;
use crate::cells::FreePlace;
use crate::compiled::{Address, FacingRule, Group, GroupCount};
use crate::placement::{Anchor, PlacementContext, Request};

impl Sampler {
    /// Places the objects of a group around one anchor.
    pub(super) fn place(
        &self,
        number: usize,
        group: &Group,
        anchor: Anchor,
        anchor_number: u64,
        draft: &mut Draft,
    ) -> Result<(), GeneratorError> {
        let index = draft.index;
        // Each anchor has its own random numbers, so that adding an object around one anchor does not move objects around
        // others.
        let first = anchor_number << 32;
        let count = count_of(group, first, draft);
        let found = draft.world.objects.len().saturating_add(count as usize);
        self.check_count(found, index)?;
        let failed = |turn: u64, (tries, reason): (u32, String)| GeneratorError::NoPlace {
            world: self.id(index),
            group: group.name.clone(),
            object: turn as u32 + 1,
            count,
            tries,
            reason,
        };
        let asked = &*group.placement.resolve(draft.values);
        let mut cells = match asked {
            Distribution::Cells { .. } if count > 0 => {
                let layout = draft.world.environment_params.layout.as_ref();
                let cells = draft.context.cells(layout, asked, &group.name);
                Some(cells.map_err(|reason| failed(0, (0, reason)))?)
            }
            _ => None,
        };
        let mut turns = asked.num_turns().map(Turns::new);
        for turn in 0..u64::from(count) {
            let mut object = self.fill(&group.object, Address::first(index, first + turn), draft.values)?;
            if let Some(seeds) = &group.seeds {
                object.seed = object.seed.or_else(|| Some(seeds.seed(first + turn)));
            }
            let mut rng = group.placement.stream.at(index, first + turn, 0);
            // The agent must fit between the object and the wall. A body is about as wide as its scale; walls are thinner than
            // agents.
            let doorway_clearance = 1.5 * draft.world.agent_params.agent_width + object.scale / 2.0;
            let is_free = !object.solid || draft.context.allows_doorways(asked, cells.as_ref(), doorway_clearance);
            let request = Request {
                placement: asked,
                margins: &group.margins,
                anchor,
                group: number,
                doorway_clearance: if is_free { 0.0 } else { doorway_clearance },
                number: turn,
            };
            let found = match &mut cells {
                Some(cells) => draft.context.find_in_cells(&request, cells, &mut rng),
                None => draft
                    .context
                    .find(&request, turns.as_mut(), &mut rng)
                    .map(|place| FreePlace {
                        place,
                        spot: None,
                        heading: None,
                    }),
            };
            let FreePlace {
                place, heading: along, ..
            } = found.map_err(|tried| failed(turn, tried))?;
            object.coordinates = place;
            object.heading = along.unwrap_or(object.heading);
            if place.iter().any(|metres| metres.abs() > 300.0) {
                // This happens only without a minimum distance to walls, so that the arena itself is the limit.
                return Err(self.out_of_range(
                    index,
                    &format!("group/{}/placement", group.name),
                    place,
                    [-300.0, 300.0],
                ));
            }
            let towards = match &group.facing {
                None => None,
                Some(FacingRule::Random(stream)) => {
                    object.heading = 360.0 * stream.at(index, first + turn, 0).unit();
                    None
                }
                Some(FacingRule::Agent) => Some(draft.world.agent_params.coordinates),
                Some(FacingRule::Middle) => Some(anchor.at),
                Some(FacingRule::Point(point)) => Some(*point),
                Some(FacingRule::Group(group)) => draft.context.group(*group).nearest(place),
            };
            if let Some(to) = towards.filter(|to| *to != place) {
                object.heading = heading(place, to);
            }
            draft.world.objects.push(object);
        }
        Ok(())
    }
}

/// A world under construction.
pub(super) struct Draft<'a, 'g> {
    pub(super) index: u64,
    pub(super) values: &'a [Value],
    pub(super) context: &'a mut PlacementContext<'g>,
    pub(super) world: &'a mut WorldDraft,
}

/// The number of objects of a group around an anchor; the first has index `first`.
fn count_of(group: &Group, first: u64, draft: &Draft<'_, '_>) -> u32 {
    match &group.count {
        GroupCount::Fixed(count) => *count,
        GroupCount::Drawn(fill) => fill.with(Address::first(draft.index, first), draft.values, whole),
    }
}

/// Converts a drawn count to an integer. Saturates, because a count beyond `u32` is too large in any case.
fn whole(value: &Value) -> u32 {
    value
        .as_integer()
        .map_or(0, |count| u32::try_from(count.max(0)).unwrap_or(u32::MAX))
}

/// The heading in degrees from one position to another.
fn heading([x, y]: [f64; 2], [to_x, to_y]: [f64; 2]) -> f64 {
    let turned = libm::atan2(to_x - x, to_y - y).to_degrees().rem_euclid(360.0);
    // A tiny negative angle would round up to 360.
    if turned >= 360.0 { 0.0 } else { turned }
}
