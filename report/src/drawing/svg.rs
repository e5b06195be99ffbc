//! Drawings as SVG files.

use base64::prelude::{BASE64_STANDARD, Engine as _};

use super::{Drawing, Rgb, Shape, Side, TextLine};
use crate::ReportError;

/// The whole file.
pub(super) fn file(drawing: &Drawing) -> Result<String, ReportError> {
    let (width, height) = (drawing.width, drawing.height);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"Ubuntu, 'Segoe UI', Helvetica, Arial, sans-serif\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    shapes(&mut text, drawing)?;
    text.push_str("</svg>\n");
    Ok(text)
}

fn shapes(text: &mut String, drawing: &Drawing) -> Result<(), ReportError> {
    for shape in &drawing.shapes {
        let element = match shape {
            Shape::Area { points, color, alpha } => format!(
                "<polygon points=\"{}\" fill=\"{}\"{}/>\n",
                coordinates(points),
                hex(*color),
                opacity("fill", *alpha)
            ),
            Shape::Line {
                points,
                width,
                color,
                alpha,
                dash,
            } => format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{}{}/>\n",
                coordinates(points),
                hex(*color),
                short(*width),
                dash.map_or(String::new(), |dash| format!(" stroke-dasharray=\"{}\"", short(dash))),
                opacity("stroke", *alpha)
            ),
            Shape::Disc {
                middle: [x, y],
                radius,
                color,
                alpha,
            } => format!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"{}/>\n",
                short(*x),
                short(*y),
                short(*radius),
                hex(*color),
                opacity("fill", *alpha)
            ),
            Shape::Text(words) => text_element(words),
            Shape::Inner { at: [x, y], drawing } => {
                let (width, height) = (drawing.width, drawing.height);
                let mut inner = format!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\">\n");
                shapes(&mut inner, drawing)?;
                inner + "</svg>\n"
            }
            Shape::Pixels(picture) => format!(
                "<image width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
                picture.width,
                picture.height,
                BASE64_STANDARD.encode(picture.to_png()?)
            ),
        };
        text.push_str(&element);
    }
    Ok(())
}

/// A text element that keeps its measured width in any font.
fn text_element(words: &TextLine) -> String {
    let width = words.width();
    if width <= 0.0 {
        return String::new();
    }
    let [x, y] = [words.at[0], words.at[1] + words.offset()[1]];
    let anchor = match words.side {
        Side::Left => "",
        Side::Middle => " text-anchor=\"middle\"",
        Side::Right => " text-anchor=\"end\"",
    };
    let turn = match words.turns % 4 {
        0 => String::new(),
        turns => format!(
            " transform=\"rotate({} {} {})\"",
            90 * u32::from(turns),
            short(words.at[0]),
            short(words.at[1])
        ),
    };
    let rim = words.rim.map_or(String::new(), |rim| {
        format!(
            " stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
            hex(rim),
            short(0.22 * words.size)
        )
    });
    format!(
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\" textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\"{anchor}{turn}{rim}>{}</text>\n",
        short(x),
        short(y),
        short(words.size),
        hex(words.color),
        short(width),
        escaped(&words.text)
    )
}

fn escaped(text: &str) -> String {
    let safe = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    safe.replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}

fn coordinates(points: &[[f32; 2]]) -> String {
    let coordinate = |point: &[f32; 2]| format!("{},{}", short(point[0]), short(point[1]));
    points.iter().map(coordinate).collect::<Vec<_>>().join(" ")
}

fn opacity(what: &str, alpha: f32) -> String {
    driftworld_text::when(alpha < 1.0, || format!(" {what}-opacity=\"{}\"", short(alpha)))
}

fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A number with at most two decimals.
fn short(number: f32) -> String {
    driftworld_text::short(f64::from(number), 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Picture;

    #[test]
    fn texts_are_escaped() {
        let mut drawing = Drawing::blank(90, 20);
        drawing.write(TextLine::new("a<b>&\u{0}\"c\"", [1.0, 2.0], 12.0, [1, 2, 3]));
        drawing.put(Picture::blank(2, 2), [3, 4]);
        let svg = drawing.to_svg().expect("the file can be written");
        assert!(svg.contains(">a&lt;b&gt;&amp;"), "{svg}");
        assert!(!svg.contains('\u{0}') && !svg.contains("<b>"), "{svg}");
        assert!(svg.contains("<svg x=\"3\" y=\"4\" width=\"2\" height=\"2\">") && svg.contains("base64,iVBOR"));
    }
}
