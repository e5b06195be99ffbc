//! Pictures of scenes. The CPU renderer is the default and needs no driver; one for GPUs will stand beside it.

mod background;
mod cpu;
mod frame;
mod shade;
mod top_down;

pub use cpu::CpuRenderer;
pub use frame::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, FAR_DEPTH,
    Frame, category_color, depth_to_gray,
};
pub use top_down::{Image, top_down};
