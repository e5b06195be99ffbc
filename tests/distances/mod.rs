//! Tests the laws of distances (`docs/similarity.md`) on built-in tasks, random specs and random worlds, and the audit findings
//! that led to them, one test each.

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
