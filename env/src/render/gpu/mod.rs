//! [`GpuRenderer`]: renders many images at once on a GPU.
//!
//! The images of a batch are tiles of one large target. All objects with the same mesh, in any tile, are drawn together and
//! clipped at the edges of their tiles; all images are read back in one buffer.

mod adapter;
mod atlas;
mod device;
mod instances;
mod library;
mod pass;
mod pipelines;
mod survey;
mod tile;
mod unpack;

use rayon::prelude::*;

pub(super) use survey::survey;

use self::atlas::{Grid, Planes};
use self::device::Device;
use self::instances::TileContents;
use self::pass::{Pass, Stage, pass_limits};
use super::compose::CATEGORY_BITS;
use super::cpu::{CpuRenderer, average};
use super::frame::Frame;
use super::hand::Hand;
use super::picture::Picture;
use super::target::Target;
use crate::EnvError;
use crate::camera::Camera;
use crate::scene::Scene;

/// Renders scenes on a GPU. Reuses its buffers.
///
/// Images equal those of [`CpuRenderer`] except for single pixels at edges, because each adapter rounds slightly differently.
/// The natural style is rendered by [`CpuRenderer`]. Draws one batch at a time, on the calling thread and rayon's threads.
#[derive(Debug)]
pub struct GpuRenderer {
    device: Device,
    stage: Stage,
    contents: Vec<TileContents>,
    hand: Hand,
}

/// An image to render, or only its colours with several samples per pixel.
#[derive(Clone, Copy, Debug)]
struct Job {
    picture: usize,
    size: [u32; 2],
    planes: Planes,
    /// Whether the highest byte of a pixel's word has its class beside its category; otherwise the class follows from the item.
    with_class: bool,
    /// Samples per pixel along each side.
    samples: u32,
}

impl GpuRenderer {
    /// A renderer on the first adapter that renders a small test image: a GPU, or with `or_software`, if none works, software
    /// emulation of one, such as Mesa's llvmpipe.
    ///
    /// # Errors
    /// [`EnvError::NoGpu`], with the adapters that were tried and why each failed, if none works.
    pub fn new(or_software: bool) -> Result<Self, EnvError> {
        adapter::open_first(or_software, Self::tested)
    }

    /// A renderer on this device, if it renders a small test image.
    fn tested(device: Device) -> Result<Self, EnvError> {
        let stage = Stage::new(&device);
        device.check()?;
        let mut renderer = Self {
            device,
            stage,
            contents: Vec::new(),
            hand: Hand::default(),
        };
        let scene = Scene::from_world(&driftworld_spec::World::default());
        renderer.render(&scene, &Camera::overview(&scene), &mut Frame::new(16, 16))?;
        Ok(renderer)
    }

    /// The adapter's name, as reported by its driver.
    pub fn adapter_name(&self) -> &str {
        &self.device.info.name
    }

    /// The graphics API in use: `vulkan`, `metal` or `dx12`.
    pub fn backend(&self) -> &'static str {
        self.device.info.backend.to_str()
    }

    /// Whether the adapter is software emulation of a GPU.
    pub fn is_software(&self) -> bool {
        adapter::is_software(&self.device.info)
    }

    /// Renders all images of a frame.
    ///
    /// # Errors
    /// The errors of [`GpuRenderer::draw_batch`].
    pub fn render(&mut self, scene: &Scene, camera: &Camera, frame: &mut Frame) -> Result<(), EnvError> {
        if frame.width == 0 || frame.height == 0 {
            return Ok(());
        }
        self.draw(scene, camera, &mut frame.target())
    }

    /// Renders the images that the target requests.
    ///
    /// # Errors
    /// The errors of [`GpuRenderer::draw_batch`].
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, target: &mut Target<'_>) -> Result<(), EnvError> {
        self.draw_batch(&mut [Picture {
            scene,
            camera: *camera,
            target: target.reborrow(),
        }])
    }

    /// Draws carried objects onto the colour image, on the CPU.
    pub(super) fn draw_carried(&mut self, scene: &Scene, carried: &[u32], target: &mut Target<'_>) {
        self.hand.draw(scene, carried, target);
    }

    /// Renders many images; images of the same size are rendered together. The natural style is rendered on the CPU.
    ///
    /// # Errors
    /// Before anything is drawn, [`EnvError::PictureSize`] as for [`CpuRenderer::draw`](super::CpuRenderer::draw), and
    /// [`EnvError::GpuPicture`] for images too large for this adapter. [`EnvError::Gpu`] if the device fails; some images may
    /// be stale then.
    pub fn draw_batch(&mut self, pictures: &mut [Picture<'_>]) -> Result<(), EnvError> {
        let mut jobs = Vec::with_capacity(pictures.len());
        for (index, picture) in pictures.iter().enumerate() {
            picture.target.check()?;
            if picture.scene.natural.is_none() {
                jobs.extend(jobs_for(index, picture));
            }
        }
        let max_side = self.device.limits.max_texture_dimension_2d;
        for job in &jobs {
            let single = Grid::new(job.size, 1, max_side);
            let room = self.device.limits.max_buffer_size;
            if single.is_none_or(|grid| atlas::bytes_back(grid, job.planes) > room) {
                let adapter = self.device.info.name.clone();
                return Err(EnvError::GpuPicture {
                    width: job.size[0],
                    height: job.size[1],
                    most: max_side,
                    adapter,
                });
            }
        }
        jobs.sort_by_key(|job| (job.size, job.planes));
        let [max_tiles, _] = pass_limits(&self.device.limits);
        for alike in jobs.chunk_by(|a, b| (a.size, a.planes) == (b.size, b.planes)) {
            let mut rest = alike;
            while let Some(first) = rest.first() {
                let grid = Grid::new(first.size, rest.len(), max_side);
                let count = grid.map_or(1, Grid::capacity).min(rest.len()).min(max_tiles);
                let (now, later) = rest.split_at(count);
                self.draw_pass(now, pictures)?;
                rest = later;
            }
        }
        let is_natural = |picture: &&mut Picture<'_>| picture.scene.natural.is_some();
        let (mut natural, plain): (Vec<_>, Vec<_>) = pictures.iter_mut().partition(is_natural);
        for picture in plain {
            picture.target.apply_fog_to_depth(&picture.scene.light);
        }
        natural
            .par_iter_mut()
            .try_for_each_init(CpuRenderer::new, |renderer, picture| {
                renderer.draw(picture.scene, &picture.camera, &mut picture.target)
            })
    }

    /// Draws similar jobs in one pass; splits them in half if they contain too many objects.
    fn draw_pass(&mut self, jobs: &[Job], pictures: &mut [Picture<'_>]) -> Result<(), EnvError> {
        let mut contents = std::mem::take(&mut self.contents);
        if contents.len() < jobs.len() {
            contents.resize_with(jobs.len(), TileContents::default);
        }
        let seen: &[Picture<'_>] = pictures;
        let together = contents[..jobs.len()].par_iter_mut().zip(jobs).with_min_len(8);
        together.for_each(|(content, job)| {
            let picture = &seen[job.picture];
            content.gather(picture.scene, &picture.camera, job.size, job.with_class);
        });
        let count: usize = contents[..jobs.len()]
            .iter()
            .map(|content| content.instances.len())
            .sum();
        let [_, max_instances] = pass_limits(&self.device.limits);
        let outcome = if count <= max_instances {
            self.draw_gathered(jobs, pictures, &mut contents[..jobs.len()])
        } else if jobs.len() > 1 {
            let (low, high) = jobs.split_at(jobs.len() / 2);
            self.draw_pass(low, pictures)
                .and_then(|()| self.draw_pass(high, pictures))
        } else {
            let reason = format!("found {count} objects in sight, expected at most {max_instances}");
            Err(self.device.failed(reason))
        };
        self.contents = contents;
        outcome
    }

    fn draw_gathered(
        &mut self,
        jobs: &[Job],
        pictures: &mut [Picture<'_>],
        contents: &mut [TileContents],
    ) -> Result<(), EnvError> {
        let Some(first) = jobs.first() else { return Ok(()) };
        let max_side = self.device.limits.max_texture_dimension_2d;
        let Some(grid) = Grid::new(first.size, jobs.len(), max_side) else {
            return Ok(());
        };
        let fog = jobs
            .iter()
            .any(|job| pictures[job.picture].scene.light.fog_distance.is_some());
        let pass = Pass {
            grid,
            planes: first.planes,
            fog,
            contents,
        };
        self.stage.run(&self.device, pass, |bytes, layout| {
            // Jobs of a pass belong to different images, in order.
            let mut tiles = jobs.iter().enumerate().peekable();
            let work: Vec<_> = pictures
                .iter_mut()
                .enumerate()
                .filter_map(|(index, picture)| Some((tiles.next_if(|(_, job)| job.picture == index)?, picture)))
                .collect();
            work.into_par_iter()
                .with_min_len(4)
                .for_each(|((number, job), picture)| {
                    let (scene, target, corner) = (picture.scene, &mut picture.target, grid.corner(number));
                    if job.samples == 1 {
                        unpack::unpack(bytes, layout, corner, scene, job.with_class, target);
                    } else if let Some(rgb) = &mut target.rgb {
                        let mut points = vec![0; 3 * job.size[0] as usize * job.size[1] as usize];
                        let mut fine = Target::of_colors([job.size[0], job.size[1]], &mut points);
                        unpack::unpack(bytes, layout, corner, scene, job.with_class, &mut fine);
                        average(&points, rgb, target.width as usize, job.samples as usize);
                    }
                });
        })
    }
}

/// The jobs for an image: everything at once, or colours separately if they have several samples per pixel.
fn jobs_for(index: usize, picture: &Picture<'_>) -> impl Iterator<Item = Job> + use<> {
    let target = &picture.target;
    let fits = picture.scene.highest_class < 1 << (8 - CATEGORY_BITS);
    let sampled = target.supersampling > 1 && target.rgb.is_some();
    let labelled = target.category.is_some() || (fits && target.class.is_some());
    let plain = Job {
        picture: index,
        size: [target.width, target.height],
        planes: Planes {
            words: labelled || (target.rgb.is_some() && !sampled),
            depth: target.depth.is_some(),
            items: target.instance.is_some() || (!fits && target.class.is_some()),
        },
        with_class: fits,
        samples: 1,
    };
    let fine = Job {
        size: plain.size.map(|pixels| pixels * target.supersampling),
        planes: Planes {
            words: true,
            depth: false,
            items: false,
        },
        samples: target.supersampling,
        ..plain
    };
    let is_wanted = plain.planes.words || plain.planes.depth || plain.planes.items;
    [is_wanted.then_some(plain), sampled.then_some(fine)]
        .into_iter()
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A renderer on each adapter of this machine, if any.
    fn renderers(features: wgpu::Features) -> Vec<GpuRenderer> {
        let adapters = adapter::all().unwrap_or_default();
        let open = |adapter: &wgpu::Adapter| Device::open(adapter, features).map(GpuRenderer::tested);
        adapters.iter().filter_map(|adapter| open(adapter).ok()?.ok()).collect()
    }

    fn render_several(renderer: &mut GpuRenderer) -> Result<Vec<Frame>, EnvError> {
        let world = driftworld_spec::WorldDraft {
            objects: vec![driftworld_spec::Object::new("tree", [1.0, 4.0]); 3],
            ..Default::default()
        };
        let scene = Scene::from_world(&world.check().expect("the world is valid"));
        let mut frames = vec![Frame::new(40, 30); 5];
        let mut pictures: Vec<_> = (0..)
            .zip(&mut frames)
            .map(|(k, frame)| Picture {
                scene: &scene,
                camera: Camera::first_person([0.0, 0.0], 20.0 * k as f32 - 30.0, 1.0, 60.0),
                target: frame.target(),
            })
            .collect();
        renderer.draw_batch(&mut pictures)?;
        drop(pictures);
        Ok(frames)
    }

    #[test]
    fn adapter_without_clipping_renders_the_same_images() {
        let together = renderers(wgpu::Features::CLIP_DISTANCES).into_iter();
        for (mut clips, mut does_not) in together.zip(renderers(wgpu::Features::empty())) {
            assert!(!does_not.device.has_clip_distances);
            let pairs = render_several(&mut clips)
                .expect("the images render")
                .into_iter()
                .zip(render_several(&mut does_not).expect("the images render"));
            for (a, b) in pairs {
                let differing = a.instance.iter().zip(&b.instance).filter(|(a, b)| a != b).count();
                assert!(differing <= 2, "{differing} of 1200 pixels");
                assert!(a.instance.iter().all(|item| *item <= 3));
            }
        }
    }

    #[test]
    fn lost_device_returns_an_error_without_panic() {
        for mut renderer in renderers(wgpu::Features::CLIP_DISTANCES) {
            renderer.device.card.destroy();
            for _ in 0..2 {
                let error = render_several(&mut renderer).expect_err("the device is lost");
                assert_eq!(error.code(), "env/gpu", "{error}");
            }
        }
    }
}
