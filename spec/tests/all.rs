//! All integration tests of this crate in one program, which is linked only once.

mod advice;
mod all_at_once;
mod any_text;
mod cases;
mod codes;
mod distributions;
mod documents;
mod json_parameters;
mod l2explorer;
mod layouts;
mod models;
mod mutations;
mod names;
#[path = "../../tests/reference_data.rs"]
mod reference_data;
mod requirements;
mod schemas;
mod tasks;
#[path = "../../tests/tier.rs"]
mod tier;
