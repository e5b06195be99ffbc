//! [`Target`]: the caller's buffers for images, one slice per requested modality.

use driftworld_spec::{MAX_POINTS, Modality};

use super::frame::Frame;
use crate::EnvError;
use crate::scene::Light;

/// The images to fill; those that are `None` are not computed. Row 0 is at the top.
#[derive(Debug, Default)]
pub struct Target<'a> {
    /// Width in pixels, 1 to 4096.
    pub width: u32,
    /// Height in pixels, 1 to 4096.
    pub height: u32,
    /// Samples per pixel along each side, whose mean is the colour, 1 to 4; 0 means 1.
    pub supersampling: u32,
    /// Colour, `(height, width, 3)` bytes, sRGB.
    pub rgb: Option<&'a mut [u8]>,
    /// Distance along the view axis in metres, `(height, width)`; [`FAR_DEPTH`](super::FAR_DEPTH) for the sky.
    pub depth: Option<&'a mut [f32]>,
    /// Reward category, `(height, width)`.
    pub category: Option<&'a mut [u8]>,
    /// Class number of the object, or 0 for none, `(height, width)`.
    pub class: Option<&'a mut [u16]>,
    /// Item index plus 1, or 0 for none, `(height, width)`.
    pub instance: Option<&'a mut [u32]>,
}

impl<'a> Target<'a> {
    /// A target for colours alone.
    pub fn of_colors([width, height]: [u32; 2], rgb: &'a mut [u8]) -> Self {
        Self {
            width,
            height,
            rgb: Some(rgb),
            ..Self::default()
        }
    }

    /// The same images, reborrowed.
    pub fn reborrow(&mut self) -> Target<'_> {
        Target {
            width: self.width,
            height: self.height,
            supersampling: self.supersampling,
            rgb: self.rgb.as_deref_mut(),
            depth: self.depth.as_deref_mut(),
            category: self.category.as_deref_mut(),
            class: self.class.as_deref_mut(),
            instance: self.instance.as_deref_mut(),
        }
    }

    /// The target with only the images of these modalities.
    #[must_use]
    pub fn only(mut self, modalities: &[Modality]) -> Self {
        let wanted = |modality: Modality| modalities.contains(&modality);
        self.rgb = self.rgb.filter(|_| wanted(Modality::Rgb));
        self.depth = self.depth.filter(|_| wanted(Modality::Depth));
        self.category = self.category.filter(|_| wanted(Modality::Segmentation));
        self.class = self.class.filter(|_| wanted(Modality::Class));
        self.instance = self.instance.filter(|_| wanted(Modality::Instance));
        self
    }

    /// # Errors
    /// [`EnvError::PictureSize`] unless both sides are 1 to 4096 pixels, `supersampling` is at most 4, there are at most 2²⁶
    /// samples in all, and every image has room for exactly its pixels.
    pub(super) fn check(&self) -> Result<(), EnvError> {
        let (width, height) = (self.width, self.height);
        if self.is_valid() {
            Ok(())
        } else {
            Err(EnvError::PictureSize { width, height })
        }
    }

    /// Whether sizes are in range and every slice has one element per pixel (three bytes for colour).
    fn is_valid(&self) -> bool {
        let pixels = self.width as usize * self.height as usize;
        let fits = |length: Option<usize>, each: usize| length.is_none_or(|length| length == pixels * each);
        (1..=4096).contains(&self.width)
            && (1..=4096).contains(&self.height)
            && self.supersampling <= 4
            && pixels as u64 * u64::from(self.supersampling).pow(2) <= MAX_POINTS
            && fits(self.rgb.as_ref().map(|rgb| rgb.len()), 3)
            && fits(self.depth.as_ref().map(|depth| depth.len()), 1)
            && fits(self.category.as_ref().map(|category| category.len()), 1)
            && fits(self.class.as_ref().map(|class| class.len()), 1)
            && fits(self.instance.as_ref().map(|instance| instance.len()), 1)
    }

    /// Shortens depths according to visibility in fog, if depth images include fog.
    pub(super) fn apply_fog_to_depth(&mut self, light: &Light) {
        let (Some(depth), Some(fog), true) = (&mut self.depth, light.fog_distance, light.fog_in_depth) else {
            return;
        };
        for metres in depth.iter_mut() {
            *metres = *metres * fog / (*metres * *metres + fog * fog).sqrt();
        }
    }

    /// Whether nothing is requested.
    pub(crate) fn is_empty(&self) -> bool {
        self.rgb.is_none() && self.depth.is_none() && !self.has_labels()
    }

    /// Whether any segmentation is requested.
    #[inline(always)]
    pub(super) fn has_labels(&self) -> bool {
        self.category.is_some() || self.class.is_some() || self.instance.is_some()
    }
}

impl Frame {
    /// All images of this frame.
    pub fn target(&mut self) -> Target<'_> {
        Target {
            width: self.width,
            height: self.height,
            supersampling: 1,
            rgb: Some(&mut self.rgb),
            depth: Some(&mut self.depth),
            category: Some(&mut self.category),
            class: Some(&mut self.class),
            instance: Some(&mut self.instance),
        }
    }
}
