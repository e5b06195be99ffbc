//! The colours of figures and tasks, and their replacements on dark pages.

use std::fmt::Write;

use plotters::style::RGBColor;

use crate::drawing::Rgb;

/// A colour of figures, as drawn and as shown on a page in dark mode.
pub(super) struct Tone {
    pub(super) light: RGBColor,
    dark: &'static str,
}

impl Tone {
    const fn new(light: RGBColor, dark: &'static str) -> Self {
        Self { light, dark }
    }
}

/// Text, and marks on the timeline and on strips.
pub(super) const INK: Tone = Tone::new(RGBColor(38, 42, 48), "#e6e8eb");
/// Secondary text, axis ticks, and the curves of experts.
pub(super) const FAINT: Tone = Tone::new(RGBColor(95, 101, 109), "#a3a9b1");
/// Grid lines, axes and borders.
pub(super) const RIM: Tone = Tone::new(RGBColor(221, 224, 229), "#363c44");
/// The background of evaluations.
pub(super) const SHADE: Tone = Tone::new(RGBColor(238, 240, 243), "#262b31");
/// Evaluations on the timeline.
pub(super) const FROZEN: Tone = Tone::new(RGBColor(150, 154, 160), "#7c838c");

/// The colours of tasks, which most colour-blind readers can distinguish (Okabe and Ito). Their black is used as ink, and their
/// yellow, too faint on white, is darkened.
pub(super) const TASKS: [Tone; 7] = [
    Tone::new(RGBColor(0, 114, 178), "#4a9fe0"),
    Tone::new(RGBColor(230, 159, 0), "#f0b429"),
    Tone::new(RGBColor(0, 158, 115), "#2bc196"),
    Tone::new(RGBColor(213, 94, 0), "#f27d3e"),
    Tone::new(RGBColor(86, 180, 233), "#9ad8fa"),
    Tone::new(RGBColor(204, 121, 167), "#e29bc4"),
    Tone::new(RGBColor(148, 132, 20), "#c3b23c"),
];

/// CSS rules that adapt figures to dark mode.
///
/// The plotting library writes colours as attributes, which rules of a style sheet override.
pub(crate) fn dark_rules() -> String {
    let mut rules = String::new();
    for tone in [&INK, &FAINT, &RIM, &SHADE, &FROZEN].into_iter().chain(&TASKS) {
        let RGBColor(r, g, b) = tone.light;
        for what in ["fill", "stroke"] {
            let _ = write!(rules, "svg [{what}=\"#{r:02X}{g:02X}{b:02X}\"]{{{what}:{}}}", tone.dark);
        }
    }
    rules
}

/// The colour of the task at this index of a list.
pub(crate) fn task_color(task: usize) -> Rgb {
    let RGBColor(r, g, b) = TASKS[task % TASKS.len()].light;
    [r, g, b]
}

/// The shape of a task's marks: colours repeat after seven tasks, shapes after five times seven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    Disc,
    Square,
    Diamond,
    Triangle,
    Cross,
}

/// A task's look in every figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Look {
    pub(super) color: RGBColor,
    pub(super) mark: Mark,
}

impl Look {
    /// The look of the task at this index of the lifetime's list.
    pub(super) fn of(task: usize) -> Self {
        const MARKS: [Mark; 5] = [Mark::Disc, Mark::Square, Mark::Diamond, Mark::Triangle, Mark::Cross];
        Self {
            color: TASKS[task % TASKS.len()].light,
            mark: MARKS[task / TASKS.len() % MARKS.len()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_five_tasks_look_different() {
        let looks: Vec<Look> = (0..35).map(Look::of).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "task {index}");
        }
        assert_eq!(Look::of(35), looks[0]);
    }

    #[test]
    fn every_colour_changes_in_dark_mode() {
        let rules = dark_rules();
        assert!(rules.contains("svg [fill=\"#0072B2\"]{fill:#4a9fe0}"));
        assert_eq!(rules.matches("stroke=").count(), 12);
    }
}
