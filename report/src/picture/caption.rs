//! Captions: a few facts above an image, in as many lines as they need at its width.

use super::lines::cut;
use super::{Drawing, INK, Picture, TextLine, text_lines, text_width};

/// Font sizes, normal and above images narrower than [`NARROW`].
const LETTERS: f32 = 15.0;
const SMALL_LETTERS: f32 = 11.0;
const NARROW: u32 = 200;

/// Margin to the left and right of the text.
const MARGIN: f32 = 6.0;
/// Margin above the text.
const ABOVE: u32 = 5;
/// Separator between two facts on a line.
const PARTED: &str = " · ";

/// Maximum number of lines of a caption; the rest is cut off.
pub const MAX_CAPTION_LINES: usize = 6;

fn letters(width: u32) -> f32 {
    if width < NARROW { SMALL_LETTERS } else { LETTERS }
}

/// Breaks facts into lines for an image of this width: facts stay whole if they fit, otherwise [`text_lines`] breaks them. At
/// most [`MAX_CAPTION_LINES`].
pub fn caption_lines(facts: &[String], width: u32) -> Vec<String> {
    let size = letters(width);
    let room = (width as f32 - 2.0 * MARGIN).max(0.0);
    let fits = |text: &str| text_width(text, size) <= room;
    let mut lines: Vec<String> = Vec::new();
    for fact in facts {
        let beside = lines.last().map(|line| format!("{line}{PARTED}{fact}"));
        match (lines.last_mut(), beside) {
            (Some(line), Some(beside)) if fits(&beside) => *line = beside,
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
    /// The image with facts above it, in space for `num_lines` lines ([`caption_lines`]): all images of a film have the same
    /// space, however long their captions.
    #[must_use]
    pub fn captioned(&self, facts: &[String], num_lines: usize) -> Self {
        let size = letters(self.width);
        let line_height = (size * 1.25).ceil() as u32;
        let height = line_height * num_lines as u32 + ABOVE;
        let mut words = Drawing::blank(self.width, height);
        let lines = caption_lines(facts, self.width).into_iter().take(num_lines);
        for (number, line) in (0u32..).zip(lines) {
            let top = (number * line_height + ABOVE) as f32;
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

        /// No line is wider than its image, and except above the narrowest every word is there, in order.
        #[test]
        fn no_line_is_too_wide_and_no_word_is_lost(
            facts in prop::collection::vec("[a-z0-9+−.]{1,9}( [a-z0-9]{1,9}){0,3}", 1..5),
            width in 1u32..700,
        ) {
            let lines = caption_lines(&facts, width);
            let room = width as f32;
            prop_assert!(lines.iter().all(|line| text_width(line, letters(width)) <= room));
            if width >= 100 && lines.len() < MAX_CAPTION_LINES {
                let words = |text: &str| -> Vec<String> {
                    text.split_whitespace().filter(|word| *word != "·").map(str::to_owned).collect()
                };
                prop_assert_eq!(words(&lines.join(" ")), words(&facts.join(" ")));
            }
        }

        /// Images of one size and one number of lines stay the same size, whatever their captions.
        #[test]
        fn captioned_images_of_a_film_have_one_size(width in 1u32..300, num_lines in 0usize..6, said in "[a-z ]{0,80}") {
            let picture = Picture::blank(width, 20);
            let (one, other) = (picture.captioned(&[said], num_lines), picture.captioned(&[], num_lines));
            prop_assert_eq!((one.width, one.height), (other.width, other.height));
            prop_assert_eq!(one.width, width);
        }
    }
}
