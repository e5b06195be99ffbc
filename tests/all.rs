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

/// Whether a case is tried: in the quick tier one of so many, in the full tier all.
fn is_turn(number: usize, of: usize) -> bool {
    tier::quick_or_full(number.is_multiple_of(of), true)
}
