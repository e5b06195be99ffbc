//! All integration tests of this crate in one program, which is linked only once.

mod at_distance;
mod cases;
mod cells;
mod colors;
mod doors;
mod drawn_layouts;
mod drawn_task;
mod fewest_changes;
mod groups;
mod layouts;
mod mixtures;
#[path = "../../tests/reference_data.rs"]
mod reference_data;
mod statistics;
mod statistics_of_places;
#[path = "../../tests/tier.rs"]
mod tier;
mod variants;
mod worlds;
