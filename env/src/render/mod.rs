//! Renders scenes. The CPU renderer is the default and needs no driver; the GPU renderer requires the feature `gpu`.
#![expect(
    clippy::inline_always,
    reason = "vector code must be inlined into a function that enables its instruction set"
)]

mod backdrop;
mod canvas;
mod compose;
mod compose_natural;
mod cpu;
mod daylight;
mod depth;
mod frame;
#[cfg(feature = "gpu")]
mod gpu;
mod hand;
mod hidden;
mod kind;
mod lanes;
mod material;
mod natural;
mod patch;
mod picture;
mod raster;
mod renderer;
mod report;
mod rows;
mod shade;
mod shadows;
mod sky;
mod surfaces;
mod target;
mod top_down;
mod view;
mod visibility;

pub use cpu::CpuRenderer;
pub use depth::{DepthForm, depth_to_gray};
pub(crate) use depth::{gray, millimetres};
pub use frame::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, FAR_DEPTH,
    Frame, category_color,
};
#[cfg(feature = "gpu")]
pub use gpu::GpuRenderer;
pub use kind::RendererKind;
pub use picture::Picture;
pub use renderer::Renderer;
pub use report::{AdapterReport, RendererReport};
pub use target::Target;
pub use top_down::{Image, top_down, top_down_scale, top_down_with_way};
