//! Tests every adapter of this machine for a report, by comparing its image with the CPU renderer's.

use super::super::cpu::CpuRenderer;
use super::super::frame::Frame;
use super::super::report::AdapterReport;
use super::device::Device;
use super::{GpuRenderer, adapter};
use crate::camera::Camera;
use crate::scene::Scene;
use driftworld_spec::{Object, WorldDraft};

/// Side of the test image, in pixels.
const SIDE: u32 = 64;

/// Share of colour bytes that must match the CPU's image, within a tolerance.
const MIN_MATCHING_SHARE: f64 = 0.98;

/// Every adapter with its test result, or the reason why there is none.
pub(in super::super) fn survey() -> Result<Vec<AdapterReport>, String> {
    Ok(adapter::all()?.iter().map(report).collect())
}

fn report(adapter: &wgpu::Adapter) -> AdapterReport {
    let info = adapter.get_info();
    AdapterReport {
        name: info.name.clone(),
        backend: info.backend.to_str().to_owned(),
        kind: adapter::kind_name(&info).to_owned(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        is_software: adapter::is_software(&info),
        problem: check_rendering(adapter).err(),
    }
}

/// Renders a small image and compares it with the CPU renderer's.
fn check_rendering(adapter: &wgpu::Adapter) -> Result<(), String> {
    let device = Device::open(adapter, wgpu::Features::CLIP_DISTANCES)?;
    let mut renderer = GpuRenderer::tested(device).map_err(|error| error.to_string())?;
    let world = WorldDraft::with_objects(vec![Object::new("tree", [0.0, 8.0]), Object::new("cube", [2.0, 5.0])]);
    let scene = Scene::from_world(&world.check().map_err(|error| error.to_string())?);
    let camera = Camera::first_person([0.0, 0.0], 0.0, 1.0, 60.0);
    let (mut rendered, mut expected) = (Frame::new(SIDE, SIDE), Frame::new(SIDE, SIDE));
    renderer
        .render(&scene, &camera, &mut rendered)
        .map_err(|error| error.to_string())?;
    CpuRenderer::new().render(&scene, &camera, &mut expected);
    let pairs = rendered.rgb.iter().zip(&expected.rgb);
    let matching_share = pairs.filter(|(a, b)| a.abs_diff(**b) <= 3).count() as f64 / rendered.rgb.len() as f64;
    if matching_share < MIN_MATCHING_SHARE {
        return Err(format!(
            "draws a different image: only {:.1} % of its colour bytes are as expected",
            100.0 * matching_share
        ));
    }
    Ok(())
}
