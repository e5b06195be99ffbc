//! How far apart two worlds are by one measure alone: by where things stand, by which things there are, or by their
//! colours. All that worlds differ in, added up, is in `combined/`; the measures themselves are in `occupancy/`,
//! `scalar/` and `color/`.

mod colors;
mod measure;
mod objects;
mod occupancy;
mod placements;
mod sets;

pub use measure::WorldMeasure;
pub use placements::Placements;
pub use sets::world_sets_measure_distance;

#[cfg(test)]
mod tests;
