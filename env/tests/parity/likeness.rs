//! Measures how similar two images of the same view are, and creates a renderer on this machine's adapter.

use std::io::Write as _;
use std::path::Path;

use driftworld_env::{Frame, GpuRenderer};

/// A renderer on this machine's adapter, if there is one.
pub(crate) fn gpu() -> Option<GpuRenderer> {
    match GpuRenderer::new(true) {
        Ok(renderer) => Some(renderer),
        Err(error)
            if std::env::var_os("DRIFTWORLD_REQUIRE_GPU").is_some_and(|value| value != "0" && !value.is_empty()) =>
        {
            panic!("DRIFTWORLD_REQUIRE_GPU=1: {error}")
        }
        Err(error) => {
            // `println` is not used, because the test harness hides its output for passing tests.
            let _ = writeln!(std::io::stderr(), "skipped: {error}");
            None
        }
    }
}

/// Similarity of two images.
#[derive(Debug)]
pub(crate) struct Likeness {
    pub(crate) colors: f64,
    pub(crate) classes: f64,
    pub(crate) instances: f64,
    pub(crate) categories: f64,
    pub(crate) depths: f64,
}

pub(crate) fn share(count: usize, of: usize) -> f64 {
    if of == 0 { 1.0 } else { count as f64 / of as f64 }
}

pub(crate) fn likeness(found: &Frame, expected: &Frame) -> Likeness {
    let pixels = expected.depth.len();
    let same = |alike: &dyn Fn(usize) -> bool| share((0..pixels).filter(|&pixel| alike(pixel)).count(), pixels);
    let smooth: Vec<usize> = (0..pixels).filter(|&pixel| !is_silhouette(expected, pixel)).collect();
    let near = |&&pixel: &&usize| (found.depth[pixel] - expected.depth[pixel]).abs() <= 0.01 * expected.depth[pixel];
    Likeness {
        colors: same(&|pixel| (3 * pixel..3 * pixel + 3).all(|byte| found.rgb[byte].abs_diff(expected.rgb[byte]) <= 3)),
        classes: same(&|pixel| found.class[pixel] == expected.class[pixel]),
        instances: same(&|pixel| found.instance[pixel] == expected.instance[pixel]),
        categories: same(&|pixel| found.category[pixel] == expected.category[pixel]),
        depths: share(smooth.iter().filter(near).count(), smooth.len()),
    }
}

/// Whether depth changes by more than 3 % between a pixel and a neighbour.
fn is_silhouette(frame: &Frame, pixel: usize) -> bool {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let (x, y) = (pixel % width, pixel / width);
    let depth = frame.depth[pixel];
    let around = |at: usize, most: usize| at.saturating_sub(1)..=(at + 1).min(most - 1);
    around(y, height).any(|y| {
        around(x, width).any(|x| {
            let other = frame.depth[y * width + x];
            (other - depth).abs() > 0.03 * depth.min(other)
        })
    })
}

/// Writes an image, the expected one, and their difference, side by side, for inspection after a failure.
pub(crate) fn write_difference(name: &str, found: &Frame, expected: &Frame) -> std::path::PathBuf {
    let (width, height) = (expected.width as usize, expected.height as usize);
    let mut rgb = Vec::with_capacity(9 * width * height);
    for y in 0..height {
        let row = 3 * width * y..3 * width * (y + 1);
        rgb.extend(&found.rgb[row.clone()]);
        rgb.extend(&expected.rgb[row.clone()]);
        rgb.extend(row.map(|byte| found.rgb[byte].abs_diff(expected.rgb[byte]).saturating_mul(20)));
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
    let file = std::fs::File::create(&path).expect("cargo made the folder");
    let mut encoder = png::Encoder::new(file, 3 * width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("there is a header");
    writer
        .write_image_data(&rgb)
        .expect("the buffer has the announced size");
    path
}
