//! The paper that a figure is drawn on: its sizes, text, axes and legend.

#![expect(
    clippy::disallowed_methods,
    reason = "ticks and arrows of a figure, rounded to pixels"
)]

use std::ops::Range;
use std::sync::Once;

use driftworld_text::short;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};

use super::options::Layout;
use super::palette::{FAINT, INK, Look, Mark, RIM};

pub(super) type Area<DB> = DrawingArea<DB, Shift>;
pub(super) type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub(super) type Drawn<DB, T = ()> = Result<T, DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// Dots of the drawing per layout pixel along one side: the library only draws at integer coordinates.
const DOTS: i32 = 2;
/// Heights, in pixels of the layout.
const TITLE: i32 = 34;
const ENTRY: i32 = 21;

/// A layout with its measurements.
#[derive(Debug, Clone)]
pub(super) struct Paper {
    pub(super) layout: Layout,
    /// The title, if the figure stands alone.
    pub(super) title: Option<String>,
}

/// A name in the legend, with its mark.
pub(super) struct Entry {
    name: String,
    sample: Sample,
}

impl Entry {
    pub(super) fn new(name: impl Into<String>, sample: Sample) -> Self {
        let name = name.into();
        Self { name, sample }
    }

    /// The entry that gives the number of things not drawn; `None` if all are. `noun` follows the number and "more".
    pub(super) fn rest(total: usize, drawn: usize, noun: &str) -> Option<Self> {
        let rest = || Self::new(format!("and {} more{noun}, not drawn", total - drawn), Sample::Nothing);
        (total > drawn).then(rest)
    }
}

/// The sample before a name in the legend.
#[derive(Clone, Copy)]
pub(super) enum Sample {
    Task(Look),
    Line(RGBColor),
    Area(RGBColor),
    /// A translucent area.
    Tint(RGBColor),
    Nothing,
}

impl Paper {
    /// The width, in pixels of the layout.
    pub(super) fn width(&self) -> i32 {
        match self.layout {
            Layout::Wide => 960,
            Layout::Narrow => 360,
        }
    }

    pub(super) fn is_narrow(&self) -> bool {
        self.layout == Layout::Narrow
    }

    /// Converts a length in layout pixels to dots.
    pub(super) fn dots(length: i32) -> i32 {
        length * DOTS
    }

    /// A stroke of this width in layout pixels.
    pub(super) fn stroke(color: RGBColor, width: f64) -> ShapeStyle {
        color.stroke_width((width * f64::from(DOTS)).round() as u32)
    }

    /// A text style of this size in pixels, anchored at a side.
    pub(super) fn words(size: i32, color: RGBColor, side: HPos, height: VPos) -> TextStyle<'static> {
        ("sans-serif", font_size(size))
            .into_font()
            .color(&color)
            .pos(Pos::new(side, height))
    }

    /// Positions of the legend's names, as left edge and line, and the number of lines.
    fn legend_positions(&self, entries: &[Entry]) -> (Vec<(i32, i32)>, i32) {
        let (mut left, mut line) = (0, 0);
        let mut legend_positions = Vec::new();
        for entry in entries {
            let width = text_width(&entry.name, 12) + 40;
            if left > 0 && left + width > self.width() - 16 {
                (left, line) = (0, line + 1);
            }
            legend_positions.push((left, line));
            left += width;
        }
        (legend_positions, if entries.is_empty() { 0 } else { line + 1 })
    }

    /// Height of the title and the legend together.
    pub(super) fn head_height(&self, entries: &[Entry]) -> i32 {
        let title = if self.title.is_some() { TITLE } else { 0 };
        title + self.legend_positions(entries).1 * ENTRY + 6
    }

    /// Draws the title and the legend; returns the area below.
    pub(super) fn head<DB: DrawingBackend>(&self, area: &Area<DB>, entries: &[Entry]) -> Drawn<DB, Area<DB>> {
        let mut top = 0;
        if let Some(title) = &self.title {
            let style = Self::words(16, INK.light, HPos::Left, VPos::Center);
            area.draw_text(title, &style, (Self::dots(8), Self::dots(TITLE / 2 + 2)))?;
            top = TITLE;
        }
        for (entry, (left, line)) in entries.iter().zip(self.legend_positions(entries).0) {
            let (x, y) = (Self::dots(left + 8), Self::dots(top + line * ENTRY + ENTRY / 2 + 2));
            let after = sample(area, entry.sample, (x, y))?;
            let style = Self::words(12, INK.light, HPos::Left, VPos::Center);
            area.draw_text(&entry.name, &style, (x + after, y))?;
        }
        Ok(area.split_vertically(Self::dots(self.head_height(entries))).1)
    }
}

/// Draws the sample before a name; returns its width in dots.
fn sample<DB: DrawingBackend>(area: &Area<DB>, sample: Sample, (x, y): (i32, i32)) -> Drawn<DB, i32> {
    let d = Paper::dots;
    let (half, style) = match sample {
        Sample::Task(Look { color, .. }) | Sample::Line(color) => (d(1), color.filled()),
        Sample::Area(color) => (d(6), color.filled()),
        Sample::Tint(color) => (d(6), color.mix(0.25).filled()),
        Sample::Nothing => return Ok(0),
    };
    area.draw(&Rectangle::new([(x, y - half), (x + d(16), y + half)], style))?;
    if let Sample::Task(look) = sample {
        draw_mark(area, look, (x + d(8), y), d(4))?;
    }
    Ok(d(22))
}

/// Draws a straight line, in pixels of the area.
pub(super) fn line<DB: DrawingBackend>(area: &Area<DB>, ends: [(i32, i32); 2], style: ShapeStyle) -> Drawn<DB> {
    area.draw(&PathElement::new(ends, style))
}

/// Draws a task's mark, in pixels of the area.
pub(super) fn draw_mark<DB: DrawingBackend>(area: &Area<DB>, look: Look, (x, y): (i32, i32), r: i32) -> Drawn<DB> {
    let (style, far) = (look.color.filled(), r * 4 / 3);
    match look.mark {
        Mark::Disc => area.draw(&Circle::new((x, y), r, style)),
        Mark::Cross => {
            let (long, thin) = (r * 5 / 4, (r / 3).max(1));
            area.draw(&Rectangle::new([(x - long, y - thin), (x + long, y + thin)], style))?;
            area.draw(&Rectangle::new([(x - thin, y - long), (x + thin, y + long)], style))
        }
        Mark::Square => area.draw(&Polygon::new(
            [(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
            style,
        )),
        Mark::Diamond => area.draw(&Polygon::new(
            [(x - far, y), (x, y - far), (x + far, y), (x, y + far)],
            style,
        )),
        Mark::Triangle => area.draw(&Polygon::new([(x - far, y + r), (x, y - far), (x + far, y + r)], style)),
    }
}

/// A pair of axes.
pub(super) struct Axes<'a> {
    pub(super) x: Range<f64>,
    pub(super) y: Range<f64>,
    pub(super) x_name: &'a str,
    /// Horizontal text above the vertical axis, with its colour: the axis's name, or the panel's.
    pub(super) y_name: (&'a str, RGBColor),
    /// Approximate number of labels along each axis.
    pub(super) labels: [usize; 2],
}

/// Draws a pair of axes with a faint grid and no border.
pub(super) fn chart<'a, DB: DrawingBackend + 'a>(area: &'a Area<DB>, axes: &Axes) -> Drawn<DB, Chart<'a, DB>> {
    let d = Paper::dots;
    let name = Paper::words(12, axes.y_name.1, HPos::Left, VPos::Center);
    area.draw_text(axes.y_name.0, &name, (d(8), d(10)))?;
    let widest = [axes.y.start, axes.y.end]
        .map(|end| text_width(&label(end, &axes.y), 11) + 12)
        .into_iter()
        .fold(0, i32::max);
    let mut chart = ChartBuilder::on(area)
        .margin_top(d(24))
        .margin_right(d(16))
        .margin_left(d(4))
        .x_label_area_size(d(if axes.x_name.is_empty() { 22 } else { 40 }))
        .y_label_area_size(d(widest.max(42)))
        .build_cartesian_2d(axes.x.clone(), axes.y.clone())?;
    let labels = ("sans-serif", font_size(11)).into_font().color(&FAINT.light);
    chart
        .configure_mesh()
        .disable_x_mesh()
        .bold_line_style(RIM.light)
        .light_line_style(TRANSPARENT)
        .axis_style(RIM.light)
        .set_all_tick_mark_size(d(3))
        .label_style(labels)
        .axis_desc_style(("sans-serif", font_size(12)).into_font().color(&FAINT.light))
        .x_labels(axes.labels[0])
        .y_labels(axes.labels[1])
        .x_label_formatter(&|value| label(*value, &axes.x))
        .y_label_formatter(&|value| label(*value, &axes.y))
        .x_desc(axes.x_name)
        .draw()?;
    Ok(chart)
}

/// Draws a curve through points; a single point becomes a dot, because a line would be invisible.
pub(super) fn curve<DB: DrawingBackend>(chart: &mut Chart<DB>, points: Vec<(f64, f64)>, color: RGBColor) -> Drawn<DB> {
    if let [only] = points[..] {
        chart.draw_series([Circle::new(only, Paper::dots(2), color.filled())])?;
    } else {
        chart.draw_series([PathElement::new(points, Paper::stroke(color, 2.0))])?;
    }
    Ok(())
}

/// A label on an axis of this range, with enough digits to differ from its neighbours.
pub(super) fn label(value: f64, range: &Range<f64>) -> String {
    let (largest, span) = (range.start.abs().max(range.end.abs()), range.end - range.start);
    // Keep the short form as long as it resolves a twentieth of the axis.
    let seen = match largest {
        size if size >= 1e9 => 1e7,
        size if size >= 1e6 => 1e4,
        size if size >= 1e4 => 100.0,
        _ => 1e-4,
    };
    // Remove the rounding error of a sum that should be 0.
    let value = if value.abs() < span * 1e-9 { 0.0 } else { value };
    if span / 20.0 >= seen || span.is_nan() || span <= 0.0 {
        return number(value);
    }
    let digits = (-(span / 10.0).log10().floor()).clamp(0.0, 9.0) as usize;
    let text = if largest >= 1e15 {
        let digits = (largest / (span / 10.0)).log10().ceil().clamp(1.0, 15.0) as usize;
        format!("{value:.digits$e}")
    } else if span < 1e-8 && largest < 1e-7 {
        format!("{value:.1e}")
    } else if span < 1e-8 {
        // As many digits as an f64 has.
        short(value, 15)
    } else {
        format!("{value:.digits$}")
    };
    text.replace('-', "−")
}

/// A number without an axis: round numbers stay short.
pub(crate) fn number(value: f64) -> String {
    let trimmed = |value: f64, digits: usize| short(value, digits).replace('-', "−");
    match value.abs() {
        0.0 => "0".to_owned(),
        size if !(1e-4..1e12).contains(&size) => format!("{value:.1e}").replace('-', "−"),
        size if size >= 1e9 => trimmed(value / 1e9, 2) + "G",
        size if size >= 1e6 => trimmed(value / 1e6, 2) + "M",
        size if size >= 1e4 => trimmed(value / 1e3, 1) + "k",
        _ => trimmed(value, 4),
    }
}

/// The font size in the library's units: the library measures from a font's descender to its ascender, which exceeds the CSS
/// font size.
fn font_size(pixels: i32) -> f64 {
    f64::from(pixels * DOTS) * 1.24
}

/// Approximate width of a text in layout pixels; it leaves room for readers with a different font.
pub(super) fn text_width(text: &str, size: i32) -> i32 {
    load_font();
    let font = ("sans-serif", f64::from(size) * 1.24).into_font();
    let width = font.box_size(text).map_or(0, |(width, _)| width as i32);
    // Characters missing from the font are measured as 0 wide.
    width.max(text.chars().count() as i32 * size * 2 / 5) * 11 / 10
}

/// Registers the embedded font, so that figures look the same on machines with and without fonts.
pub(super) fn load_font() {
    static LOADED: Once = Once::new();
    LOADED.call_once(|| {
        let loaded = register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
        debug_assert!(loaded.is_ok(), "the embedded font is valid");
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axis_labels_are_short() {
        let check = |value: f64, expected: &str| assert_eq!(number(value), expected);
        check(0.0, "0");
        check(-0.5, "−0.5");
        check(100.0, "100");
        check(0.000_01, "1.0e−5");
        check(2000.0, "2000");
        check(12_500.0, "12.5k");
        check(1_000_000.0, "1M");
        check(3.1e9, "3.1G");
    }

    #[test]
    fn close_axis_labels_far_from_zero_differ() {
        let check = |range: Range<f64>, values: [f64; 2], expected: [&str; 2]| {
            assert_eq!(values.map(|value| label(value, &range)), expected);
        };
        check(1e9..1e9 + 10.0, [1e9 + 2.0, 1e9 + 4.0], ["1000000002", "1000000004"]);
        check(1e9..1e9 + 1000.0, [1e9, 1e9 + 200.0], ["1000000000", "1000000200"]);
        check(0.0..1e9, [2e8, 4e8], ["200M", "400M"]);
        check(0.0..2e-4, [1e-4, 1.2e-4], ["0.00010", "0.00012"]);
        check(0.0..101.0, [0.0, 20.0], ["0", "20"]);
        check(-0.5..0.5, [-5.6e-17, 0.2], ["0", "0.2"]);
        check(1.0..1.0 + 1e-11, [1.0, 1.0 + 2e-12], ["1", "1.000000000002"]);
        check(20_000.0..20_100.0, [20_020.0, 20_040.0], ["20020", "20040"]);
    }

    #[test]
    fn names_that_do_not_fit_move_to_the_next_line() {
        let paper = Paper {
            layout: Layout::Narrow,
            title: None,
        };
        let entry = |name: &str| Entry {
            name: name.to_owned(),
            sample: Sample::Nothing,
        };
        let (legend_positions, lines) = paper.legend_positions(&["a", "b", &"long ".repeat(9)].map(entry));
        assert_eq!(lines, 2);
        assert_eq!(
            (legend_positions[0].1, legend_positions[1].1, legend_positions[2]),
            (0, 0, (0, 1))
        );
        assert!(legend_positions[1].0 > legend_positions[0].0);
        assert_eq!(paper.legend_positions(&[]).1, 0);
    }
}
