//! All integration tests of this crate, as one program: it is linked once.

mod builtin_tasks;
mod command;
mod curricula;
mod distances;
mod example_worlds;
mod fields;
mod held_actions;
mod limits;
mod limits_docs;
mod looks_alone;
mod pages;
mod paired_chance;
mod recordings;
mod task_docs;
mod tier;
