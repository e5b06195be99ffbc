//! All integration tests of this crate, as one program: it is linked once.

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
mod statistics;
mod statistics_of_places;
#[path = "../../tests/tier.rs"]
mod tier;
mod variants;
mod worlds;
