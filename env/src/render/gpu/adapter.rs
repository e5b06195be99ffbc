//! Lists GPU adapters in order of preference, opens the first one that works, and explains why others do not.

use crate::EnvError;

use super::device::Device;

/// All adapters of this machine, best first; if there are none, the error from the graphics APIs.
pub(super) fn all() -> Result<Vec<wgpu::Adapter>, String> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    // No debug layers, which are slow and do not affect the image.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    if adapters.is_empty() {
        let options = wgpu::RequestAdapterOptions::default();
        let message = pollster::block_on(instance.request_adapter(&options));
        return Err(message.map_or_else(|error| shortened(&error.to_string()), |_| "no adapter".to_owned()));
    }
    Ok(adapters)
}

/// wgpu's message about a machine without adapters, shortened to the APIs that this system and build support.
fn shortened(message: &str) -> String {
    let (what, why) = message.split_once("; ").unwrap_or((message, ""));
    let is_irrelevant = |part: &&str| part.ends_with("not compiled in") || part.ends_with("not requested");
    let why: Vec<&str> = why
        .split(", ")
        .filter(|part| !part.is_empty() && !is_irrelevant(part))
        .collect();
    if why.is_empty() {
        return message.to_owned();
    }
    format!("{}: {}", what.to_lowercase(), why.join(", "))
}

/// Opens the first adapter for which `test` succeeds; software emulation of a GPU comes last, and only if it is wanted.
///
/// # Errors
/// [`EnvError::NoGpu`], with the adapters that were tried, if none works.
pub(super) fn open_first<T>(or_software: bool, test: impl Fn(Device) -> Result<T, EnvError>) -> Result<T, EnvError> {
    let adapters = all().map_err(|reason| EnvError::NoGpu { tried: vec![reason] })?;
    let mut tried = Vec::new();
    for adapter in adapters {
        let info = adapter.get_info();
        let outcome = if !or_software && is_software(&info) {
            Err("is software".to_owned())
        } else {
            Device::open(&adapter, wgpu::Features::CLIP_DISTANCES)
                .and_then(|device| test(device).map_err(|error| error.to_string()))
        };
        match outcome {
            Ok(tested) => return Ok(tested),
            Err(reason) => tried.push(format!("{} ({}): {reason}", info.name, info.backend)),
        }
    }
    Err(EnvError::NoGpu { tried })
}

pub(super) fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
}

fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// An adapter's type as text.
pub(super) fn kind_name(info: &wgpu::AdapterInfo) -> &'static str {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete graphics card",
        wgpu::DeviceType::IntegratedGpu => "integrated graphics",
        wgpu::DeviceType::VirtualGpu => "virtual graphics card",
        wgpu::DeviceType::Other => "of unknown kind",
        wgpu::DeviceType::Cpu => "software",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_names_only_apis_that_could_be_used() {
        for (message, expected) in [
            (
                "No suitable adapter found; noop not requested, vulkan drivers could not be loaded, metal support not compiled in",
                "no suitable adapter found: vulkan drivers could not be loaded",
            ),
            ("Nothing; gl not requested", "Nothing; gl not requested"),
            ("Nothing", "Nothing"),
        ] {
            assert_eq!(shortened(message), expected);
        }
    }

    #[test]
    fn software_comes_last() {
        use wgpu::DeviceType::{Cpu, DiscreteGpu, IntegratedGpu, Other, VirtualGpu};
        let mut kinds = [Cpu, Other, VirtualGpu, DiscreteGpu, IntegratedGpu];
        kinds.sort_by_key(|kind| rank(*kind));
        assert_eq!(kinds, [DiscreteGpu, IntegratedGpu, VirtualGpu, Other, Cpu]);
    }
}
