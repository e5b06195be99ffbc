//! Pictures of scenes. The CPU renderer is the default and needs no driver.
#![expect(
    clippy::inline_always,
    reason = "what works on vectors must end up inside a function that has their instruction set"
)]

mod backdrop;
mod canvas;
mod compose;
mod cpu;
mod frame;
mod lanes;
mod raster;
mod shade;
mod target;
mod top_down;
mod view;

pub use cpu::CpuRenderer;
pub use frame::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, FAR_DEPTH,
    Frame, category_color, depth_to_gray,
};
pub use target::Target;
pub use top_down::{Image, top_down};
