//! [`Frame`]: the output of a render, with one buffer per modality, and the meaning of its values.

/// Depth of the sky, and the maximum depth, in metres.
pub const FAR_DEPTH: f32 = 1000.0;

/// Reward category: sky.
pub const CATEGORY_SKY: u8 = 0;
/// Reward category: ground, walls and regions.
pub const CATEGORY_MAP: u8 = 1;
/// Reward category: objects of class `building`.
pub const CATEGORY_BUILDING: u8 = 2;
/// Reward category: objects with a positive reward.
pub const CATEGORY_POSITIVE: u8 = 3;
/// Reward category: objects without reward.
pub const CATEGORY_NEUTRAL: u8 = 4;
/// Reward category: objects with a negative reward.
pub const CATEGORY_NEGATIVE: u8 = 5;

/// An image in all modalities; row 0 on top. Buffers are reused.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Colour, `(height, width, 3)` bytes, sRGB.
    pub rgb: Vec<u8>,
    /// Distance along the view axis in metres, `(height, width)`; [`FAR_DEPTH`] for the sky.
    pub depth: Vec<f32>,
    /// Reward category, `(height, width)`.
    pub category: Vec<u8>,
    /// Class number of the object, or 0 for none, `(height, width)`.
    pub class: Vec<u16>,
    /// Item index plus 1, or 0 for none, `(height, width)`.
    pub instance: Vec<u32>,
}

impl Frame {
    /// A black frame of this size.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            rgb: vec![0; pixels * 3],
            depth: vec![FAR_DEPTH; pixels],
            category: vec![0; pixels],
            class: vec![0; pixels],
            instance: vec![0; pixels],
        }
    }
}

/// The colour of a reward category in L2Explorer.
pub fn category_color(category: u8) -> [u8; 3] {
    match category {
        CATEGORY_MAP => [255, 255, 255],
        CATEGORY_BUILDING => [178, 255, 178],
        CATEGORY_POSITIVE => [0, 255, 255],
        CATEGORY_NEUTRAL => [255, 178, 178],
        CATEGORY_NEGATIVE => [255, 0, 255],
        _ => [0, 0, 0],
    }
}
