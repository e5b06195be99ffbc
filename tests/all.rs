//! All integration tests of this crate in one program, so that only one is linked.

mod builtin_tasks;
mod command;
mod curricula;
mod distances;
mod example_worlds;
mod fields;
mod files_below;
mod held_actions;
mod instruction_sets;
mod limits;
mod limits_docs;
mod looks_alone;
mod pages;
mod paired_chance;
mod recordings;
mod reference_data;
mod task_docs;
mod tier;

/// Whether to test the case with this number: one in `of` cases in the quick tier, all cases in the full tier.
fn is_turn(number: usize, of: usize) -> bool {
    tier::quick_or_full(number.is_multiple_of(of), true)
}
