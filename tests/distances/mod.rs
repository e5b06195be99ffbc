//! The laws of distances (`docs/similarity.md`), over the built-in tasks, over drawn specs and over drawn worlds; and
//! the findings of the audit that the laws come from, a test for each. What single measures are is tested in
//! `similarity`.

mod built_in;
mod by_hand;
mod drawn_specs;
mod drawn_worlds;
mod findings;
mod findings_of_worlds;
mod laws_by_parameters;
mod laws_by_worlds;
mod look_ups;
mod matched_by_hand;
mod measures;
