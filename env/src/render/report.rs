//! [`RendererReport`]: the renderers of this machine, each tested with a small image.

use super::kind::RendererKind;

/// The renderers of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RendererReport {
    /// The CPU instruction set in use: `portable`, `avx2` or `avx512`.
    pub instruction_set: &'static str,
    /// Whether this build supports GPUs: the feature `gpu`.
    pub has_gpu_feature: bool,
    /// Every adapter, in order of preference.
    pub adapters: Vec<AdapterReport>,
    /// Why there is no adapter, if there is none.
    pub no_adapter: Option<String>,
    /// The renderer that [`RendererKind::Auto`] chooses.
    pub auto: RendererKind,
}

/// One graphics adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Its name, as reported by the driver.
    pub name: String,
    /// The graphics API: `vulkan`, `metal` or `dx12`.
    pub backend: String,
    /// Its type, as text.
    pub kind: String,
    /// The driver's name and version.
    pub driver: String,
    /// Whether it is software emulation of a GPU.
    pub is_software: bool,
    /// Why it cannot be used; `None` if it can.
    pub problem: Option<String>,
}

#[cfg(not(feature = "gpu"))]
/// The reason why a build without the feature `gpu` has no adapter, and how to build with it.
pub(super) const NO_FEATURE: &str =
    "this build has no GPU renderer; build it with `cargo build --release --features gpu`";

impl RendererReport {
    /// Tests every renderer with a small image.
    pub fn make() -> Self {
        #[cfg(feature = "gpu")]
        let found = super::gpu::survey();
        #[cfg(not(feature = "gpu"))]
        let found: Result<Vec<AdapterReport>, String> = Err(NO_FEATURE.to_owned());
        let (adapters, no_adapter) = match found {
            Ok(adapters) => (adapters, None),
            Err(reason) => (Vec::new(), Some(reason)),
        };
        let is_usable = |adapter: &AdapterReport| adapter.problem.is_none() && !adapter.is_software;
        Self {
            instruction_set: super::cpu::CpuRenderer::new().instruction_set(),
            has_gpu_feature: cfg!(feature = "gpu"),
            auto: if adapters.iter().any(is_usable) {
                RendererKind::Gpu
            } else {
                RendererKind::Cpu
            },
            adapters,
            no_adapter,
        }
    }
}
