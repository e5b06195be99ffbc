//! Pictures in a terminal: coloured half blocks if colours are available, else plain characters.

use std::fmt::Write;
use std::io::IsTerminal;

use crate::env::{CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, Frame};

use crate::spec::Modality;

/// Width in columns if the terminal's width is unknown.
const DEFAULT_COLUMNS: u32 = 80;

/// Characters from dark to bright.
const SHADES: &[u8] = b" .:-=+*#%@";

/// The terminal's capabilities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Screen {
    pub(super) colors: bool,
    columns: u32,
    rows: u32,
}

impl Screen {
    /// Monochrome characters, 80 per line: for anything but a terminal.
    pub(super) const PLAIN: Self = Self {
        colors: false,
        columns: DEFAULT_COLUMNS,
        rows: u32::MAX,
    };

    /// The capabilities of standard output. No colours with `NO_COLOR` or `TERM=dumb`.
    pub(crate) fn of_this_terminal() -> Self {
        if !std::io::stdout().is_terminal() {
            return Self::PLAIN;
        }
        let set = |name: &str| std::env::var(name).is_ok_and(|value| !value.is_empty());
        let dumb = std::env::var("TERM").is_ok_and(|term| term == "dumb");
        let size = terminal_size::terminal_size();
        let (columns, rows) = size.map_or((DEFAULT_COLUMNS, u32::MAX), |(width, height)| {
            (u32::from(width.0).max(8), u32::from(height.0).max(4))
        });
        Self {
            colors: !dumb && !set("NO_COLOR"),
            columns: columns.min(400),
            rows,
        }
    }

    /// Width and height, in pixels, of a picture with this aspect ratio (width over height). A character cell is one pixel wide
    /// and two pixels high.
    pub(super) fn size(&self, aspect: f32, requested: Option<u32>) -> [u32; 2] {
        let max_columns = match requested {
            Some(columns) => columns as f32,
            // One line is reserved for the prompt.
            None => (self.columns as f32).min(self.rows.saturating_sub(1) as f32 * 2.0 * aspect),
        };
        let columns = max_columns.clamp(1.0, 4096.0);
        let lines = (columns / aspect / 2.0).round().clamp(1.0, 2048.0);
        [columns as u32, lines as u32 * 2]
    }
}

/// The picture in colours: the upper half of each character is one pixel, the lower half another.
pub(super) fn half_blocks(width: u32, rgb: &[u8]) -> String {
    let mut text = String::new();
    let row_length = 3 * width as usize;
    for rows in rgb.chunks_exact(2 * row_length) {
        let (upper, lower) = rows.split_at(row_length);
        let mut last = None;
        for pair in upper.chunks_exact(3).zip(lower.chunks_exact(3)) {
            if last != Some(pair) {
                let ([r, g, b], [x, y, z]) = ([pair.0[0], pair.0[1], pair.0[2]], [pair.1[0], pair.1[1], pair.1[2]]);
                write!(text, "\x1b[38;2;{r};{g};{b};48;2;{x};{y};{z}m").expect("writing to a String does not fail");
                last = Some(pair);
            }
            text.push('▀');
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// A colour for an id: consecutive ids get very different colours, 0 is black.
pub(super) fn color_of(id: u32) -> [u8; 3] {
    if id == 0 {
        return [0; 3];
    }
    // Rotate the hue by the golden angle per id.
    let hue = (id as f32 * 0.618_034).fract() * 6.0;
    [5.0, 3.0, 1.0].map(|shift| {
        let k = (shift + hue) % 6.0;
        (255.0 * (1.0 - 0.75 * k.min(4.0 - k).clamp(0.0, 1.0))) as u8
    })
}

/// A frame as text. Colours and depth are shades; categories are ` .B+o-` for sky, map, building, positive, zero and
/// negative reward; classes and instances are the last digit of their ids.
pub(super) fn ascii_picture(frame: &Frame, kind: Modality) -> String {
    let width = frame.width as usize;
    let character = |at: usize| match kind {
        Modality::Rgb | Modality::Depth => {
            shade(brightness(frame, kind, at).midpoint(brightness(frame, kind, at + width)))
        }
        Modality::Segmentation => match frame.category[at] {
            CATEGORY_MAP => '.',
            CATEGORY_BUILDING => 'B',
            CATEGORY_POSITIVE => '+',
            CATEGORY_NEUTRAL => 'o',
            CATEGORY_NEGATIVE => '-',
            _ => ' ',
        },
        Modality::Class => digit(u32::from(frame.class[at])),
        Modality::Instance => digit(frame.instance[at]),
    };
    let mut text = String::new();
    for row in (0..frame.height as usize / 2 * 2).step_by(2) {
        let line: String = (0..width).map(|column| character(row * width + column)).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

fn digit(id: u32) -> char {
    match id {
        0 => '.',
        id => char::from_digit(id % 10, 10).unwrap_or('?'),
    }
}

/// The brightness of a pixel, 0 to 255.
fn brightness(frame: &Frame, kind: Modality, at: usize) -> u32 {
    if kind == Modality::Depth {
        return (frame.depth[at] * 2.55).min(255.0) as u32;
    }
    let [r, g, b] = [0, 1, 2].map(|channel| u32::from(frame.rgb[3 * at + channel]));
    (299 * r + 587 * g + 114 * b) / 1000
}

fn shade(brightness: u32) -> char {
    char::from(SHADES[(brightness as usize * SHADES.len() / 256).min(SHADES.len() - 1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pixels_share_a_character_and_colour_codes_are_not_repeated() {
        let text = half_blocks(2, &[1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6]);
        assert_eq!(text, "\x1b[38;2;1;2;3;48;2;4;5;6m▀▀\x1b[0m\n");
    }

    #[test]
    fn shades_go_from_dark_to_bright() {
        let mut frame = Frame::new(3, 2);
        frame.rgb = vec![
            0, 0, 0, 128, 128, 128, 255, 255, 255, 0, 0, 0, 128, 128, 128, 255, 255, 255,
        ];
        assert_eq!(ascii_picture(&frame, Modality::Rgb), " +@\n");
        frame.category = vec![0, 1, 3, 0, 0, 0];
        assert_eq!(ascii_picture(&frame, Modality::Segmentation), " .+\n");
    }

    #[test]
    fn picture_fits_the_terminal() {
        let screen = Screen {
            colors: true,
            columns: 100,
            rows: 21,
        };
        assert_eq!(screen.size(1.0, None), [40, 40], "20 lines of two pixels");
        assert_eq!(screen.size(4.0, None), [100, 26], "100 columns");
        assert_eq!(screen.size(1.0, Some(30)), [30, 30], "the requested width");
        assert_eq!(Screen::PLAIN.size(1.0, None), [80, 80]);
    }

    #[test]
    fn neighbouring_numbers_have_distant_colours() {
        for id in 1..50 {
            let (a, b) = (color_of(id), color_of(id + 1));
            let difference: i32 = a.iter().zip(b).map(|(a, b)| (i32::from(*a) - i32::from(b)).abs()).sum();
            assert!(difference > 100, "{id}: {a:?} {b:?}");
        }
    }
}
