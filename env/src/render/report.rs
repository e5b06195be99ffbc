//! What there is to draw with on this machine, each tried with a small picture. Who prints it is not known here.

use super::kind::RendererKind;

/// The renderers of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RendererReport {
    /// The processor's instruction set in use: `portable`, `avx2` or `avx512`.
    pub instruction_set: &'static str,
    /// Whether this build can draw on graphics cards: the feature `gpu`.
    pub has_gpu_feature: bool,
    /// Every adapter, in the order in which they are tried.
    pub adapters: Vec<AdapterReport>,
    /// Why there is no adapter, if there is none.
    pub no_adapter: Option<String>,
    /// What [`RendererKind::Auto`] takes.
    pub auto: RendererKind,
}

/// One graphics adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Its name, as the driver gives it.
    pub name: String,
    /// The graphics interface: `vulkan`, `metal` or `dx12`.
    pub backend: String,
    /// What kind of thing it is, in words.
    pub kind: String,
    /// The driver's name and version.
    pub driver: String,
    /// Whether it is software that stands in for a graphics card.
    pub is_software: bool,
    /// Why it cannot be used, if so.
    pub problem: Option<String>,
}

#[cfg(not(feature = "gpu"))]
/// Why a build without the feature `gpu` has no adapter, and what to do.
pub(super) const NO_FEATURE: &str =
    "this build has no GPU renderer; build it with `cargo build --release --features gpu`";

impl RendererReport {
    /// Tries everything with a small picture.
    pub fn make() -> Self {
        #[cfg(feature = "gpu")]
        let found = super::gpu::survey();
        #[cfg(not(feature = "gpu"))]
        let found: Result<Vec<AdapterReport>, String> = Err(NO_FEATURE.to_owned());
        let (adapters, no_adapter) = match found {
            Ok(adapters) => (adapters, None),
            Err(reason) => (Vec::new(), Some(reason)),
        };
        let takes = |adapter: &AdapterReport| adapter.problem.is_none() && !adapter.is_software;
        Self {
            instruction_set: super::cpu::CpuRenderer::new().instruction_set(),
            has_gpu_feature: cfg!(feature = "gpu"),
            auto: if adapters.iter().any(takes) {
                RendererKind::Gpu
            } else {
                RendererKind::Cpu
            },
            adapters,
            no_adapter,
        }
    }
}
