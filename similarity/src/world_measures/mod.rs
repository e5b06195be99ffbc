//! Distances between worlds by a single measure: of occupancy, of objects, or of colours.

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
