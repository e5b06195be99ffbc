//! Captions: a line of words above a picture.

use super::{Drawing, INK, Picture, TextLine};

/// Pixels of a caption.
pub const CAPTION_HEIGHT: u32 = 24;

impl Picture {
    /// The picture with a line of words above it, as wide as it is: what does not fit is cut off.
    #[must_use]
    pub fn captioned(&self, words: &str) -> Self {
        let mut line = Drawing::blank(self.width, CAPTION_HEIGHT);
        line.write(TextLine::new(words, [6.0, 5.0], 15.0, [INK.0, INK.1, INK.2]));
        let mut captioned = Self::blank(self.width, self.height + CAPTION_HEIGHT);
        captioned.paste(&line.to_picture(), 0, 0);
        captioned.paste(self, 0, CAPTION_HEIGHT);
        captioned
    }
}
