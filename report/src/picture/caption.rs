//! Captions: a few facts above an image, in as many lines as they need at its width.

use super::lines::cut;
use super::{Drawing, INK, Picture, TextLine, text_lines, text_width};

/// Font sizes: the normal one, and the one above images narrower than [`NARROW`].
const FONT_SIZE: f32 = 15.0;
const SMALL_FONT_SIZE: f32 = 11.0;
const NARROW: u32 = 200;

/// Margin to the left and right of the text.
const MARGIN: f32 = 6.0;
/// Margin above the text.
const TOP_MARGIN: u32 = 5;
/// Separator between two facts on a line.
const SEPARATOR: &str = " · ";

/// Maximum number of lines of a caption; the rest is cut off.
pub const MAX_CAPTION_LINES: usize = 6;

fn font_size(width: u32) -> f32 {
    if width < NARROW { SMALL_FONT_SIZE } else { FONT_SIZE }
}

/// Arranges facts in at most [`MAX_CAPTION_LINES`] lines for an image of this width. Facts stay whole if they fit, otherwise
/// [`text_lines`] breaks them.
pub fn caption_lines(facts: &[String], width: u32) -> Vec<String> {
    let size = font_size(width);
    let room = (width as f32 - 2.0 * MARGIN).max(0.0);
    let fits = |text: &str| text_width(text, size) <= room;
    let mut lines: Vec<String> = Vec::new();
    for fact in facts {
        let joined = lines.last().map(|line| format!("{line}{SEPARATOR}{fact}"));
        match (lines.last_mut(), joined) {
            (Some(line), Some(joined)) if fits(&joined) => *line = joined,
            _ => lines.extend(text_lines(fact, size, room)),
        }
    }
    if lines.len() > MAX_CAPTION_LINES {
        lines.truncate(MAX_CAPTION_LINES);
        if let Some(last) = lines.last_mut() {
            *last = cut(&format!("{last} …"), size, room);
        }
    }
    lines
}

impl Picture {
    /// The image with facts above it, in a space of `num_lines` lines ([`caption_lines`]), so that all images of a film have the
    /// same size, however long their captions are.
    #[must_use]
    pub fn captioned(&self, facts: &[String], num_lines: usize) -> Self {
        let size = font_size(self.width);
        let line_height = (size * 1.25).ceil() as u32;
        let height = line_height * num_lines as u32 + TOP_MARGIN;
        let mut words = Drawing::blank(self.width, height);
        let lines = caption_lines(facts, self.width).into_iter().take(num_lines);
        for (number, line) in (0u32..).zip(lines) {
            let top = (number * line_height + TOP_MARGIN) as f32;
            words.write(TextLine::new(line, [MARGIN, top], size, INK));
        }
        let mut captioned = Self::blank(self.width, self.height + height);
        captioned.paste(&words.to_picture(), 0, 0);
        captioned.paste(self, 0, height);
        captioned
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn facts(of: &[&str]) -> Vec<String> {
        of.iter().map(|fact| (*fact).to_owned()).collect()
    }

    #[test]
    fn facts_continue_on_further_lines_above_narrow_images() {
        let facts = facts(&["12.3 s", "return −100.7", "touches the red things: +100.0"]);
        assert_eq!(
            caption_lines(&facts, 480),
            ["12.3 s · return −100.7 · touches the red things: +100.0"]
        );
        assert_eq!(
            caption_lines(&facts, 240),
            ["12.3 s · return −100.7", "touches the red things: +100.0"]
        );
        assert_eq!(
            caption_lines(&facts, 84),
            ["12.3 s", "return −100.7", "touches the", "red things:", "+100.0"]
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// No line is wider than its image, and above all but the narrowest images no word is lost or moved.
        #[test]
        fn no_line_is_too_wide_and_no_word_is_lost(
            facts in prop::collection::vec("[a-z0-9+−.]{1,9}( [a-z0-9]{1,9}){0,3}", 1..5),
            width in 1u32..700,
        ) {
            let lines = caption_lines(&facts, width);
            let room = width as f32;
            prop_assert!(lines.iter().all(|line| text_width(line, font_size(width)) <= room));
            if width >= 100 && lines.len() < MAX_CAPTION_LINES {
                let words = |text: &str| -> Vec<String> {
                    text.split_whitespace().filter(|word| *word != "·").map(str::to_owned).collect()
                };
                prop_assert_eq!(words(&lines.join(" ")), words(&facts.join(" ")));
            }
        }

        /// Images of one size and one number of lines get the same size, whatever their captions say.
        #[test]
        fn captioned_images_of_a_film_have_one_size(width in 1u32..300, num_lines in 0usize..6, fact in "[a-z ]{0,80}") {
            let picture = Picture::blank(width, 20);
            let (one, other) = (picture.captioned(&[fact], num_lines), picture.captioned(&[], num_lines));
            prop_assert_eq!((one.width, one.height), (other.width, other.height));
            prop_assert_eq!(one.width, width);
        }
    }
}
