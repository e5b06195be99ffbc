//! Renders text with the font's own subpixel glyph positions.
//!
//! The plotting library itself draws each glyph at a whole pixel and ignores its left side bearing, which makes words
//! fall apart ("ob jects").

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, Glyph, GlyphId, PxScale, ScaleFont, point};

use super::{Picture, TextLine};

static FONT: LazyLock<FontRef<'static>> =
    LazyLock::new(|| FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).expect("the embedded font is valid"));

/// Width of the outline around glyphs, as a share of the font size.
const RIM: f32 = 0.11;

/// Converts a font size to `ab_glyph`'s scale, which measures a font from its descender to its ascender.
fn scale(size: f32) -> PxScale {
    let em = FONT.units_per_em().unwrap_or(1000.0);
    PxScale::from(size * FONT.height_unscaled() / em)
}

/// The glyphs of a text, each with its position on a line that starts at 0, and the width of that line.
fn layout(text: &str, size: f32) -> (Vec<(GlyphId, f32)>, f32) {
    let font = FONT.as_scaled(scale(size));
    let (mut layout, mut x) = (Vec::new(), 0.0);
    let mut before: Option<GlyphId> = None;
    for c in text.chars() {
        let glyph = font.glyph_id(c);
        x += before.map_or(0.0, |before| font.kern(before, glyph));
        layout.push((glyph, x));
        x += font.h_advance(glyph);
        before = Some(glyph);
    }
    (layout, x)
}

/// The width of a text in pixels at font size `size`, according to the font.
pub fn text_width(text: &str, size: f32) -> f32 {
    layout(text, size).1
}

/// Draws a text, turned around its anchor.
pub(super) fn draw(picture: &mut Picture, words: &TextLine) {
    if let Some(rim) = words.rim {
        let rim_width = RIM * words.size;
        let slanted = rim_width * 0.7;
        let around = TextLine {
            color: rim,
            rim: None,
            ..words.clone()
        };
        for by in [
            [rim_width, 0.0],
            [-rim_width, 0.0],
            [0.0, rim_width],
            [0.0, -rim_width],
            [slanted, slanted],
            [-slanted, slanted],
            [slanted, -slanted],
            [-slanted, -slanted],
        ] {
            let at = [words.at[0] + by[0], words.at[1] + by[1]];
            draw_once(picture, &TextLine { at, ..around.clone() });
        }
    }
    draw_once(picture, words);
}

fn draw_once(picture: &mut Picture, words: &TextLine) {
    let [along, down] = words.offset();
    let turned = !words.turns.is_multiple_of(4);
    // Turned text is rendered at the origin, and its pixels are rotated.
    let origin = if turned { [0.0, 0.0] } else { words.at };
    for (id, x) in layout(&words.text, words.size).0 {
        let glyph: Glyph =
            id.with_scale_and_position(scale(words.size), point(origin[0] + along + x, origin[1] + down));
        let Some(outline) = FONT.outline_glyph(glyph) else {
            continue;
        };
        let bounds = outline.px_bounds();
        let (left, top) = (bounds.min.x as i64, bounds.min.y as i64);
        outline.draw(|dx, dy, share| {
            let (x, y) = (left + i64::from(dx), top + i64::from(dy));
            let [ax, ay] = words.at.map(|at| at as i64);
            let (x, y) = match words.turns % 4 {
                1 => (ax - y - 1, ay + x),
                2 => (ax - x - 1, ay - y - 1),
                3 => (ax + y, ay - x - 1),
                _ => (x, y),
            };
            if let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) {
                // Light fonts look too light on white, so this darkens them.
                let share = share.clamp(0.0, 1.0);
                let share = share + 0.4 * share * (1.0 - share);
                if x < picture.width as usize && y < picture.height as usize {
                    picture.blend(x, y, words.color, share);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First and last column of each run of columns with ink.
    fn runs(picture: &Picture) -> Vec<[usize; 2]> {
        let width = picture.width as usize;
        let inked = |x: usize| (0..picture.height as usize).any(|y| picture.rgb[(y * width + x) * 3] < 240);
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for x in (0..width).filter(|x| inked(*x)) {
            match runs.last_mut() {
                Some(run) if run[1] + 1 == x => run[1] = x,
                _ => runs.push([x, x]),
            }
        }
        runs
    }

    /// Each glyph's outline in the font, as left and right edge in pixels.
    fn outlines(text: &str, size: f32) -> Vec<[f32; 2]> {
        let placed = layout(text, size).0.into_iter();
        let outline = |(id, x): (GlyphId, f32)| {
            let bounds = FONT.outline(id)?.bounds;
            let unit = size / FONT.units_per_em().expect("the font has units per em");
            Some([x + bounds.min.x * unit, x + bounds.max.x * unit])
        };
        placed.filter_map(outline).collect()
    }

    /// Gaps between letters are at most two pixels wider than the font's: on each side, the ink may fall short by one.
    #[test]
    fn words_do_not_fall_apart() {
        for text in [
            "find_objects",
            "fit it",
            "Blue cubes close together",
            "the map of distances",
            "1.0.11,5",
        ] {
            for size in [9.0, 10.5, 12.0, 13.0, 16.0, 22.0, 31.0] {
                let mut picture = Picture::blank(500, 60);
                draw(&mut picture, &TextLine::new(text, [4.3, 10.0], size, [0, 0, 0]));
                let (runs, outlines) = (runs(&picture), outlines(text, size));
                // The font's own gap that contains the middle of the empty columns; below 0 where letters overlap.
                let fonts_gap = |middle: f32| {
                    let gaps = outlines.windows(2).map(|pair| [pair[0][1], pair[1][0]]);
                    let here = gaps.filter(|[end, start]| *end - 1.5 < middle && middle < *start + 1.5);
                    here.map(|[end, start]| start - end).fold(0.0, f32::max)
                };
                for pair in runs.windows(2) {
                    let gap = (pair[1][0] - pair[0][1] - 1) as f32;
                    let expected = fonts_gap((pair[0][1] + pair[1][0] + 1) as f32 / 2.0 - 4.3);
                    assert!(
                        gap <= expected + 2.0,
                        "{text} at {size}: {gap} for {expected} at {pair:?}"
                    );
                }
                let (first, last) = (runs[0][0] as f32, runs[runs.len() - 1][1] as f32);
                let whole = outlines[outlines.len() - 1][1] - outlines[0][0];
                assert!((last - first + 1.0 - whole).abs() < 2.0, "{text} at {size}");
            }
        }
    }

    #[test]
    fn text_width_is_proportional_to_the_font_size() {
        let one = text_width("objects", 10.0);
        assert!((text_width("objects", 30.0) - 3.0 * one).abs() < 1e-3);
        assert!(one > 25.0 && one < 45.0, "{one}");
        assert!(text_width("", 10.0).abs() < f32::EPSILON);
    }

    #[test]
    fn text_stays_at_its_anchor() {
        for turns in 0..4 {
            let mut picture = Picture::blank(120, 120);
            let words = TextLine::new("anchored", [60.0, 60.0], 14.0, [0, 0, 0]);
            let words = TextLine {
                turns,
                ..words.anchored(super::super::Side::Middle, super::super::Level::Middle)
            };
            draw(&mut picture, &words);
            let inked = |index: &usize| picture.rgb[index * 3] < 128;
            let dark: Vec<usize> = (0..120 * 120).filter(inked).collect();
            let mean =
                |of: fn(usize) -> usize| dark.iter().map(|index| of(*index) as f32).sum::<f32>() / dark.len() as f32;
            assert!(
                (mean(|i| i % 120) - 60.0).abs() < 4.0 && (mean(|i| i / 120) - 60.0).abs() < 4.0,
                "{turns}"
            );
        }
    }
}
