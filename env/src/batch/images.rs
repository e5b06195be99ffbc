//! Images of many environments, with one buffer per modality.

use driftworld_spec::{Modality, StateFeature, World};

use super::options::MAX_BATCH_BYTES;
use crate::EnvError;
use crate::render::{DepthForm, FAR_DEPTH, Target, gray, millimetres};

/// The layout of a batch's images; all environments share it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageLayout {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples per pixel along each side, whose mean is the colour.
    pub supersampling: u32,
    /// The modalities.
    pub modalities: Vec<Modality>,
    /// Features of the state vectors.
    pub state_features: Vec<StateFeature>,
    /// Length of the instruction, which follows the features in the state vector.
    pub instruction_len: usize,
}

impl ImageLayout {
    /// The layout that a world requests.
    pub fn of(world: &World) -> Self {
        let agent = &world.agent_params;
        Self {
            width: agent.picture_size()[0],
            height: agent.picture_size()[1],
            supersampling: agent.supersampling,
            modalities: agent.modalities.clone(),
            state_features: agent.state_features.clone(),
            instruction_len: agent.instruction.len(),
        }
    }

    /// Checks that a world's images fit this layout: they have the same size, and no modality that the layout lacks.
    pub(super) fn check(&self, env: usize, world: &World) -> Result<(), EnvError> {
        let agent = &world.agent_params;
        if [self.width, self.height] == agent.picture_size()
            && self.supersampling == agent.supersampling
            && agent
                .modalities
                .iter()
                .all(|requested| self.modalities.contains(requested))
            && self.state_features == agent.state_features
            && self.instruction_len == agent.instruction.len()
        {
            return Ok(());
        }
        Err(EnvError::BatchImages {
            env,
            found: Self::of(world).to_string(),
            expected: self.to_string(),
        })
    }

    /// Bytes of one environment's images.
    pub(super) fn bytes(&self, form: DepthForm) -> u64 {
        let depth_bytes = match form {
            DepthForm::Metres => 4,
            DepthForm::Millimetres => 4 + 2,
            DepthForm::Gray => 4 + 1,
        };
        let bytes_per_pixel = |modality: &Modality| match modality {
            Modality::Rgb => 3,
            Modality::Depth => depth_bytes,
            Modality::Segmentation => 1,
            Modality::Class => 2,
            Modality::Instance => 4,
        };
        self.modalities.iter().map(bytes_per_pixel).sum::<u64>() * self.num_pixels() as u64
    }

    /// Pixels of one image.
    pub fn num_pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

impl std::fmt::Display for ImageLayout {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} × {} pixels", self.width, self.height)?;
        if self.supersampling > 1 {
            write!(f, " ({0} × {0} points each)", self.supersampling)?;
        }
        f.write_str(" of")?;
        for (k, modality) in self.modalities.iter().enumerate() {
            let comma = if k == 0 { "" } else { "," };
            write!(f, "{comma} {modality:?}")?;
        }
        f.write_str(if self.modalities.is_empty() { " nothing" } else { "" })?;
        if self.instruction_len > 0 {
            write!(f, ", instructions of length {}", self.instruction_len)?;
        }
        if self.state_features == StateFeature::CLASSIC {
            return Ok(());
        }
        f.write_str(", states of")?;
        for (k, feature) in self.state_features.iter().enumerate() {
            write!(f, "{} {feature:?}", if k == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

/// The images of all environments of a batch, one after another; row 0 on top. Modalities that the layout lacks have empty
/// buffers. A modality of the layout that an environment's world does not request is 0 everywhere.
#[derive(Clone, Debug)]
pub struct Images {
    /// Sizes and modalities.
    pub layout: ImageLayout,
    /// Colour, `(num_envs, height, width, 3)` bytes, sRGB.
    pub rgb: Vec<u8>,
    /// Distance along the view axis in metres, `(num_envs, height, width)`.
    pub depth: Vec<f32>,
    /// Depth in millimetres, `(num_envs, height, width)`; only in [`DepthForm::Millimetres`].
    pub depth_millimetres: Vec<u16>,
    /// Depth as grey, `(num_envs, height, width)`; only in [`DepthForm::Gray`].
    pub depth_gray: Vec<u8>,
    /// Reward category, `(num_envs, height, width)`.
    pub category: Vec<u8>,
    /// Object class, `(num_envs, height, width)`.
    pub class: Vec<u16>,
    /// Object index plus 1, or 0 for none, `(num_envs, height, width)`.
    pub instance: Vec<u32>,
}

impl Images {
    /// Blank images for environments whose episodes have not begun.
    ///
    /// # Errors
    /// [`EnvError::BatchMemory`] if memory is not available.
    pub(super) fn new(layout: ImageLayout, num_envs: usize, form: DepthForm) -> Result<Self, EnvError> {
        let pixels = |modality: Modality| {
            let is_wanted = usize::from(layout.modalities.contains(&modality));
            is_wanted * num_envs * layout.num_pixels()
        };
        let depth = pixels(Modality::Depth);
        Ok(Self {
            rgb: filled(0, 3 * pixels(Modality::Rgb))?,
            depth: filled(FAR_DEPTH, depth)?,
            depth_millimetres: filled(u16::MAX, usize::from(form == DepthForm::Millimetres) * depth)?,
            depth_gray: filled(u8::MAX, usize::from(form == DepthForm::Gray) * depth)?,
            category: filled(0, pixels(Modality::Segmentation))?,
            class: filled(0, pixels(Modality::Class))?,
            instance: filled(0, pixels(Modality::Instance))?,
            layout,
        })
    }

    /// A mutable view of all images.
    pub(super) fn view(&mut self) -> ImagesMut<'_> {
        ImagesMut {
            size: [self.layout.width, self.layout.height],
            supersampling: self.layout.supersampling,
            rgb: &mut self.rgb,
            depth: &mut self.depth,
            depth_millimetres: &mut self.depth_millimetres,
            depth_gray: &mut self.depth_gray,
            category: &mut self.category,
            class: &mut self.class,
            instance: &mut self.instance,
        }
    }
}

/// A mutable view of the images of some of a batch's environments.
pub(super) struct ImagesMut<'a> {
    size: [u32; 2],
    supersampling: u32,
    rgb: &'a mut [u8],
    depth: &'a mut [f32],
    depth_millimetres: &'a mut [u16],
    depth_gray: &'a mut [u8],
    category: &'a mut [u8],
    class: &'a mut [u16],
    instance: &'a mut [u32],
}

impl<'a> ImagesMut<'a> {
    /// One render target per environment.
    pub(super) fn targets(self, num_envs: usize) -> impl Iterator<Item = Target<'a>> {
        let mut rest = Some(self);
        (0..num_envs).map_while(move |_| {
            let (one, more) = rest.take()?.split(1);
            rest = Some(more);
            Some(one.whole())
        })
    }

    fn whole(self) -> Target<'a> {
        Target {
            width: self.size[0],
            height: self.size[1],
            supersampling: self.supersampling,
            rgb: non_empty(self.rgb),
            depth: non_empty(self.depth),
            category: non_empty(self.category),
            class: non_empty(self.class),
            instance: non_empty(self.instance),
        }
    }

    /// Splits off the images of the first environments.
    pub(super) fn split(mut self, num_envs: usize) -> (Self, Self) {
        let pixels = num_envs * self.size[0] as usize * self.size[1] as usize;
        let rest = Self {
            size: self.size,
            supersampling: self.supersampling,
            rgb: self.rgb.split_off_mut(3 * pixels..).unwrap_or_default(),
            depth: self.depth.split_off_mut(pixels..).unwrap_or_default(),
            depth_millimetres: self.depth_millimetres.split_off_mut(pixels..).unwrap_or_default(),
            depth_gray: self.depth_gray.split_off_mut(pixels..).unwrap_or_default(),
            category: self.category.split_off_mut(pixels..).unwrap_or_default(),
            class: self.class.split_off_mut(pixels..).unwrap_or_default(),
            instance: self.instance.split_off_mut(pixels..).unwrap_or_default(),
        };
        (self, rest)
    }

    /// Converts the rendered depth of one environment, by its index in this view, to the chosen format.
    pub(super) fn convert_depth(&mut self, env: usize) {
        let pixels = self.size[0] as usize * self.size[1] as usize;
        let drawn = env * pixels..(env + 1) * pixels;
        if !self.depth_millimetres.is_empty() {
            millimetres(&self.depth[drawn.clone()], &mut self.depth_millimetres[drawn.clone()]);
        }
        if !self.depth_gray.is_empty() {
            gray(&self.depth[drawn.clone()], &mut self.depth_gray[drawn]);
        }
    }

    /// The images of one environment, by its index in this view.
    pub(super) fn target(&mut self, env: usize) -> Target<'_> {
        let pixels = self.size[0] as usize * self.size[1] as usize;
        Target {
            width: self.size[0],
            height: self.size[1],
            supersampling: self.supersampling,
            rgb: one(self.rgb, env, 3 * pixels),
            depth: one(self.depth, env, pixels),
            category: one(self.category, env, pixels),
            class: one(self.class, env, pixels),
            instance: one(self.instance, env, pixels),
        }
    }
}

/// Clears the images that a world does not request, and removes them from the render target.
pub(super) fn blank_unrequested(target: &mut Target<'_>, requested: &[Modality]) {
    fn blank<T: Default + Clone>(image: &mut Option<&mut [T]>, is_requested: bool) {
        if !is_requested && let Some(image) = image.take() {
            image.fill(T::default());
        }
    }
    let is_requested = |modality| requested.contains(&modality);
    blank(&mut target.rgb, is_requested(Modality::Rgb));
    blank(&mut target.depth, is_requested(Modality::Depth));
    blank(&mut target.category, is_requested(Modality::Segmentation));
    blank(&mut target.class, is_requested(Modality::Class));
    blank(&mut target.instance, is_requested(Modality::Instance));
}

/// A buffer of `length` copies of a value.
///
/// # Errors
/// [`EnvError::BatchMemory`] if memory is not available. The caller chooses the size, so running out must not abort the
/// process.
pub(super) fn filled<T: Clone>(value: T, length: usize) -> Result<Vec<T>, EnvError> {
    let mut buffer = Vec::new();
    buffer.try_reserve_exact(length).map_err(|_| EnvError::BatchMemory {
        found: (length * size_of::<T>()) as u64,
        most: MAX_BATCH_BYTES,
    })?;
    buffer.resize(length, value);
    Ok(buffer)
}

fn non_empty<T>(all: &mut [T]) -> Option<&mut [T]> {
    (!all.is_empty()).then_some(all)
}

/// One environment's slice of a buffer; `None` if the buffer is empty.
fn one<T>(all: &mut [T], env: usize, length: usize) -> Option<&mut [T]> {
    (!all.is_empty()).then(|| &mut all[env * length..(env + 1) * length])
}
