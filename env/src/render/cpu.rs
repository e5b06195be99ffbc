//! [`CpuRenderer`] chooses the instruction set, and draws everything visible from near to far.

use super::backdrop::Backdrop;
use super::canvas::Canvas;
use super::compose::{CATEGORY_BITS, Composition, Scratch, Walls};
use super::frame::{CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, Frame};
use super::hand::Hand;
use super::hidden::Hidden;
#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};
use super::lanes::{Lanes, MAX_LANES, Portable};
use super::natural::{Natural, labels_hold_classes};
use super::raster::{ShadingParams, draw_block};
use super::shade::Shader;
use super::target::Target;
use super::view::{NEAR, Pose, View};
use super::visibility::{Drawable, Visible, find, level, sort};
use crate::EnvError;
use crate::assets::Paint;
use crate::camera::Camera;
use crate::scene::{Item, PanelGroup, Scene};

/// Renders scenes on the CPU. Reuses its buffers, and allocates nothing once they are large enough.
///
/// The same scene and camera give the same pixels on every machine, regardless of the instruction set.
#[derive(Clone, Debug, Default)]
pub struct CpuRenderer {
    set: Set,
    pub(super) canvas: Canvas,
    backdrop: Backdrop,
    pub(super) natural: Natural,
    pub(super) order: Vec<Visible>,
    pub(super) offsets: Vec<f32>,
    pub(super) classes: Vec<u16>,
    pub(super) scratch: Scratch,
    /// Colours of all samples, if there are several per pixel.
    points: Vec<u8>,
    hand: Hand,
    pub(super) hidden: Hidden,
}

/// An instruction set of this CPU.
#[derive(Clone, Copy, Debug, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
enum Set {
    Portable(Portable),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl CpuRenderer {
    /// A renderer with the widest instructions of this CPU.
    pub fn new() -> Self {
        Self::default()
    }

    /// One renderer for each instruction set of this CPU, with the set's name; the widest last. All render the same pixels.
    /// Meant for tests and benchmarks.
    pub fn each_instruction_set() -> Vec<(&'static str, Self)> {
        Set::all()
            .into_iter()
            .map(|set| {
                let renderer = Self { set, ..Self::default() };
                (set.into(), renderer)
            })
            .collect()
    }

    /// A renderer with or without culling of everything behind walls; images are the same either way.
    #[cfg(test)]
    pub(super) fn with_culling(mut self, hides: bool) -> Self {
        self.hidden.is_disabled = !hides;
        self
    }

    /// The name of the instruction set in use: `portable`, `avx2` or `avx512`.
    pub fn instruction_set(&self) -> &'static str {
        self.set.into()
    }

    /// Renders all images of a frame.
    pub fn render(&mut self, scene: &Scene, camera: &Camera, frame: &mut Frame) {
        if frame.width > 0 && frame.height > 0 {
            self.run(scene, camera, &mut frame.target());
        }
    }

    /// Renders the images that the target requests.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] unless both sides are 1 to 4096 pixels, `supersampling` is at most 4, there are at most 2²⁶
    /// samples in all, and every image has room for exactly its pixels.
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, target: &mut Target<'_>) -> Result<(), EnvError> {
        target.check()?;
        match target.supersampling {
            0 | 1 => self.run(scene, camera, target),
            samples => self.run_sampled(scene, camera, target, samples),
        }
        Ok(())
    }

    /// Draws these items of the scene, which the agent carries, at the bottom of the target's colour image.
    pub(crate) fn draw_carried(&mut self, scene: &Scene, carried: &[u32], target: &mut Target<'_>) {
        self.hand.draw(scene, carried, target);
    }

    /// Renders colours as the mean of several samples, and everything else with one.
    fn run_sampled(&mut self, scene: &Scene, camera: &Camera, target: &mut Target<'_>, samples: u32) {
        if let Some(rgb) = target.rgb.take() {
            let mut points = std::mem::take(&mut self.points);
            let (width, height) = (target.width * samples, target.height * samples);
            points.resize(3 * width as usize * height as usize, 0);
            let mut fine = Target::of_colors([width, height], &mut points);
            self.run(scene, camera, &mut fine);
            average(&points, rgb, target.width as usize, samples as usize);
            self.points = points;
            if !target.is_empty() {
                self.run(scene, camera, target);
            }
            target.rgb = Some(rgb);
        } else {
            self.run(scene, camera, target);
        }
    }

    fn run(&mut self, scene: &Scene, camera: &Camera, target: &mut Target<'_>) {
        self.run_with_set(scene, camera, target);
        target.apply_fog_to_depth(&scene.light);
    }

    fn run_with_set(&mut self, scene: &Scene, camera: &Camera, target: &mut Target<'_>) {
        match self.set {
            Set::Portable(lanes) => self.draw_any(lanes, scene, camera, target),
            #[cfg(target_arch = "x86_64")]
            #[expect(
                unsafe_code,
                reason = "the value in the set proves that the processor has the instructions"
            )]
            // SAFETY: an `Avx2` exists only if `avx2` was detected.
            Set::Avx2(lanes) => unsafe { self.draw_avx2(lanes, scene, camera, target) },
            #[cfg(target_arch = "x86_64")]
            #[expect(
                unsafe_code,
                reason = "the value in the set proves that the processor has the instructions"
            )]
            // SAFETY: an `Avx512` exists only if `avx512f` and `avx512bw` were detected; both include AVX2.
            Set::Avx512(lanes) => unsafe { self.draw_avx512(lanes, scene, camera, target) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn draw_avx2(&mut self, lanes: Avx2, scene: &Scene, camera: &Camera, target: &mut Target<'_>) {
        self.draw_any(lanes, scene, camera, target);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,avx512f,avx512bw")]
    fn draw_avx512(&mut self, lanes: Avx512, scene: &Scene, camera: &Camera, target: &mut Target<'_>) {
        self.draw_any(lanes, scene, camera, target);
    }

    #[inline(always)]
    fn draw_any<L: Lanes>(&mut self, lanes: L, scene: &Scene, camera: &Camera, target: &mut Target<'_>) {
        if let Some(looks) = &scene.natural {
            if target.instance.is_some() || (target.class.is_some() && !labels_hold_classes(scene)) {
                self.draw_natural::<L, true>(lanes, scene, looks, camera, target);
            } else {
                self.draw_natural::<L, false>(lanes, scene, looks, camera, target);
            }
            return;
        }
        // If labels have no room for class and category together, pixels store their item.
        let fits = scene.highest_class < 1 << (8 - CATEGORY_BITS);
        if target.instance.is_some() || (target.class.is_some() && !fits) {
            self.draw_with::<L, true>(lanes, scene, camera, target);
        } else {
            self.draw_with::<L, false>(lanes, scene, camera, target);
        }
    }

    #[inline(always)]
    fn draw_with<L: Lanes, const ITEMS: bool>(
        &mut self,
        lanes: L,
        scene: &Scene,
        camera: &Camera,
        target: &mut Target<'_>,
    ) {
        let (width, height) = (target.width as usize, target.height as usize);
        let view = View::new(camera, width, height);
        let shader = Shader::new(&scene.light);
        let walls = Walls::around(scene, &view, &shader);
        self.canvas.clear(width, height, ITEMS);
        let mut order = std::mem::take(&mut self.order);
        find(scene, &view, walls.is_some(), &mut order);
        sort(&mut order);
        self.hidden.clear(&view);
        for &visible in &order {
            match visible.drawable {
                Drawable::Item(index) => {
                    let item = &scene.items[index as usize];
                    if self.hidden.hides_item(item, &view) {
                        continue;
                    }
                    self.draw_item::<L, ITEMS>(lanes, item, index, visible, &view, &shader, scene);
                }
                Drawable::Panels(index) => {
                    let group = &scene.panels[index as usize];
                    if self.hidden.hides_panels(group, &view) {
                        continue;
                    }
                    self.draw_panels::<L, ITEMS>(lanes, group, visible, &view, &shader, scene);
                    self.hidden.record(group, &view);
                }
            }
        }
        self.order = order;
        self.backdrop.prepare(lanes, scene, &view, &shader, height);
        self.measure_columns(&view, width);
        self.classes.clear();
        if ITEMS && target.class.is_some() {
            self.classes.extend(scene.items.iter().map(|item| item.class_id));
        }
        let composition = Composition {
            canvas: &self.canvas,
            backdrop: &self.backdrop,
            walls,
            view,
            offsets: &self.offsets,
            fog_distance: scene.light.fog_distance,
            classes: &self.classes,
        };
        composition.write::<L, ITEMS>(lanes, &mut self.scratch, target);
    }

    /// Computes the columns' offsets from the image's middle, padded to whole vectors.
    pub(super) fn measure_columns(&mut self, view: &View, width: usize) {
        self.offsets.clear();
        let padded = width.next_multiple_of(MAX_LANES);
        self.offsets
            .extend((0..padded).map(|column| view.offset(0, column as f32)));
    }

    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "an item, and everything on which its look depends"
    )]
    fn draw_item<L: Lanes, const ITEMS: bool>(
        &mut self,
        lanes: L,
        item: &Item,
        index: u32,
        visible: Visible,
        view: &View,
        shader: &Shader,
        scene: &Scene,
    ) {
        let at = view.placement(&Pose::of(item), scene.light.direction);
        let label = if ITEMS {
            0
        } else {
            u32::from(item.class_id) << CATEGORY_BITS
        };
        let mut params = ShadingParams {
            color: [0.0; 3],
            ambient: shader.ambient,
            label: (label | u32::from(category(item))) << 24,
            item: index + 1,
            may_need_clipping: visible.nearest < NEAR,
        };
        for material in level(item, visible, view) {
            let color = match material.paint {
                Paint::Main(own) => item.color.unwrap_or(own),
                Paint::Fixed(color) => color,
            };
            params.color = shader.in_light(color);
            for block in &material.blocks {
                draw_block::<L, ITEMS, _>(lanes, &mut self.canvas, block, &at, &params);
            }
        }
    }

    #[inline(always)]
    fn draw_panels<L: Lanes, const ITEMS: bool>(
        &mut self,
        lanes: L,
        group: &PanelGroup,
        visible: Visible,
        view: &View,
        shader: &Shader,
        scene: &Scene,
    ) {
        let at = view.placement(&Pose::of_panels(group, view), scene.light.direction);
        let params = ShadingParams {
            color: shader.in_light(group.color),
            ambient: shader.ambient,
            label: u32::from(CATEGORY_MAP) << 24,
            item: 0,
            may_need_clipping: visible.nearest < NEAR,
        };
        for block in &group.blocks {
            draw_block::<L, ITEMS, _>(lanes, &mut self.canvas, block, &at, &params);
        }
    }
}

impl Default for Set {
    fn default() -> Self {
        let sets = Self::all();
        sets[sets.len() - 1]
    }
}

impl Set {
    /// The instruction sets of this CPU, the widest last.
    fn all() -> Vec<Self> {
        let portable = Self::Portable(Portable);
        #[cfg(target_arch = "x86_64")]
        {
            let mut sets = vec![portable];
            sets.extend(Avx2::detect().map(Self::Avx2));
            sets.extend(Avx512::detect().map(Self::Avx512));
            sets
        }
        #[cfg(not(target_arch = "x86_64"))]
        vec![portable]
    }
}

/// Averages `samples` × `samples` samples per pixel, rounded.
pub(super) fn average(points: &[u8], rgb: &mut [u8], width: usize, samples: usize) {
    let row_length = 3 * width * samples;
    let count = (samples * samples) as u32;
    for (rows, out) in points
        .chunks_exact(row_length * samples)
        .zip(rgb.chunks_exact_mut(3 * width))
    {
        for (index, byte) in out.iter_mut().enumerate() {
            let first = index / 3 * 3 * samples + index % 3;
            let starts = (0..samples).flat_map(|row| (0..samples).map(move |k| row * row_length + first + 3 * k));
            let sum: u32 = starts.map(|at| u32::from(rows[at])).sum();
            *byte = ((sum + count / 2) / count) as u8;
        }
    }
}

/// The reward category of an item.
pub(crate) fn category(item: &Item) -> u8 {
    match item.reward {
        _ if item.building => CATEGORY_BUILDING,
        reward if reward > 0.0 => CATEGORY_POSITIVE,
        reward if reward < 0.0 => CATEGORY_NEGATIVE,
        _ => CATEGORY_NEUTRAL,
    }
}
