//! The timeline: the lifetime's blocks, one row per task, with the distances between neighbouring learning blocks above.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::palette::{FAINT, FROZEN, INK, Look, RIM, TASKS};
use super::paper::{Area, Drawn, Entry, Paper, Sample, draw_mark, line, number, text_width};
use super::scene::{Scene, Stretch};

/// Maximum number of rows; further tasks are left out.
const MAX_ROWS: usize = super::scene::MAX_TASKS;
/// Height of the strip of distances, in pixels of the layout.
const STRIP: i32 = 76;
/// Height of a learning bar.
const BAR: i32 = 18;
/// Height of the axis.
const AXIS: i32 = 44;

/// Positions, in pixels of the layout below the legend.
struct Plan {
    left: i32,
    right: i32,
    strip: i32,
    row: i32,
    rows: usize,
}

impl Plan {
    fn of(scene: &Scene, paper: &Paper) -> Self {
        let rows = scene.names.len().min(MAX_ROWS);
        let longest = scene
            .names
            .iter()
            .take(rows)
            .map(|name| text_width(name, 12))
            .max()
            .unwrap_or(0);
        Self {
            left: if paper.is_narrow() { 12 } else { (longest + 32).min(300) },
            right: paper.width() - 16,
            strip: if scene.options.distances.is_some() { STRIP } else { 0 },
            // Narrow paper has no room beside the bars, so names go above them.
            row: if paper.is_narrow() { 42 } else { 30 },
            rows,
        }
    }

    fn middle(&self, row: usize, paper: &Paper) -> i32 {
        let above = if paper.is_narrow() {
            self.row - BAR / 2 - 4
        } else {
            self.row / 2
        };
        self.strip + row as i32 * self.row + above
    }

    /// The ends of a line across the chart, in dots.
    fn across(&self, y: i32) -> [(i32, i32); 2] {
        [self.left, self.right].map(|x| (Paper::dots(x), y))
    }

    fn bottom(&self) -> i32 {
        self.strip + self.rows as i32 * self.row + 4
    }
}

fn entries(scene: &Scene) -> Vec<Entry> {
    let mut entries = vec![
        Entry::new("learning, in the task's colour", Sample::Area(TASKS[0].light)),
        Entry::new("evaluation, frozen", Sample::Line(FROZEN.light)),
    ];
    entries.extend(Entry::rest(scene.names.len(), MAX_ROWS, " tasks"));
    entries
}

pub(super) fn height(scene: &Scene, paper: &Paper) -> i32 {
    paper.head_height(&entries(scene)) + Plan::of(scene, paper).bottom() + AXIS
}

pub(super) fn draw<DB: DrawingBackend>(scene: &Scene, area: &Area<DB>, paper: &Paper) -> Drawn<DB> {
    let below = paper.head(area, &entries(scene))?;
    let plan = Plan::of(scene, paper);
    let d = Paper::dots;
    let per_x = f64::from(d(plan.right - plan.left)) / (scene.span.end - scene.span.start);
    let x = |value: f64| d(plan.left) + ((value - scene.span.start) * per_x).round() as i32;
    for (row, name) in scene.names.iter().take(plan.rows).enumerate() {
        let y = d(plan.middle(row, paper));
        line(&below, plan.across(y), RIM.light.stroke_width(1))?;
        name_row(&below, &plan, paper, row, name)?;
    }
    let columns = plan.right - plan.left;
    let drawn = [false, true].map(|learning| scene.drawn(learning, columns)).concat();
    for stretch in drawn.into_iter().filter(|stretch| stretch.task < plan.rows) {
        let (range, y) = (stretch.range(), d(plan.middle(stretch.task, paper)));
        let (half, color) = if stretch.learns() {
            (d(BAR / 2), Look::of(stretch.task).color)
        } else {
            (d(3), FROZEN.light)
        };
        // Stretches too short to see are drawn one pixel wide.
        let (start, end) = (x(range.start), x(range.end).max(x(range.start) + d(1)));
        below.draw(&Rectangle::new([(start, y - half), (end, y + half)], color.filled()))?;
    }
    axis(&below, scene, &plan, paper, &x)?;
    draw_distances(&below, scene, &plan, &x)
}

/// Draws a task's name with its mark, beside or above its row.
fn name_row<DB: DrawingBackend>(area: &Area<DB>, plan: &Plan, paper: &Paper, row: usize, name: &str) -> Drawn<DB> {
    let d = Paper::dots;
    let (mark, x, side, above) = if paper.is_narrow() {
        (plan.left + 5, plan.left + 14, HPos::Left, BAR / 2 + 10)
    } else {
        (13, plan.left - 12, HPos::Right, 0)
    };
    let y = plan.middle(row, paper) - above;
    draw_mark(area, Look::of(row), (d(mark), d(y)), d(4))?;
    area.draw_text(name, &Paper::words(12, INK.light, side, VPos::Center), (d(x), d(y)))
}

fn axis<DB: DrawingBackend>(
    area: &Area<DB>,
    scene: &Scene,
    plan: &Plan,
    paper: &Paper,
    x: &impl Fn(f64) -> i32,
) -> Drawn<DB> {
    let d = Paper::dots;
    let y = d(plan.bottom());
    line(area, plan.across(y), FAINT.light.stroke_width(2))?;
    let marks = plotters::coord::types::RangedCoordf64::from(scene.span.clone());
    let max_marks = if paper.is_narrow() { 5 } else { 10 };
    for value in plotters::coord::ranged1d::Ranged::key_points(&marks, max_marks) {
        let at = x(value);
        line(area, [(at, y), (at, y + d(4))], FAINT.light.stroke_width(2))?;
        let style = Paper::words(11, FAINT.light, HPos::Center, VPos::Top);
        area.draw_text(&number(value), &style, (at, y + d(6)))?;
    }
    let style = Paper::words(12, FAINT.light, HPos::Center, VPos::Top);
    area.draw_text(
        scene.x_name(),
        &style,
        (d(i32::midpoint(plan.left, plan.right)), y + d(23)),
    )
}

/// Draws a stem at each change between learning blocks, with a height proportional to their distance, and the number if it fits.
fn draw_distances<DB: DrawingBackend>(
    area: &Area<DB>,
    scene: &Scene,
    plan: &Plan,
    x: &impl Fn(f64) -> i32,
) -> Drawn<DB> {
    let Some(distances) = &scene.options.distances else {
        return Ok(());
    };
    let d = Paper::dots;
    let (base, tallest) = (d(STRIP - 14), d(STRIP - 46));
    let style = Paper::words(12, FAINT.light, HPos::Left, VPos::Center);
    area.draw_text("distance between neighbours", &style, (d(8), d(8)))?;
    line(area, plan.across(base), RIM.light.stroke_width(1))?;
    let largest = distances.iter().flatten().copied().fold(0.0, f64::max);
    let learned: Vec<&Stretch> = scene
        .stretches
        .iter()
        .filter(|stretch| stretch.regime.is_wake_training())
        .collect();
    let (mut free_from, mut stem_from) = (i32::MIN, i32::MIN);
    for (pair, distance) in learned.windows(2).zip(distances) {
        let at = x(f64::midpoint(pair[0].range().end, pair[1].range().start));
        if at < stem_from {
            continue;
        }
        stem_from = at + d(1);
        let share = distance.map_or(0.0, |distance| if largest > 0.0 { distance / largest } else { 0.0 });
        let top = base - (f64::from(tallest) * share).round() as i32;
        let label = distance.map_or("?".to_owned(), |distance| format!("{distance:.2}"));
        if distance.is_some() {
            line(area, [(at, base), (at, top)], INK.light.stroke_width(d(1) as u32))?;
            area.draw(&Circle::new((at, top), d(3), INK.light.filled()))?;
        }
        let half = d(text_width(&label, 11)) / 2;
        if at - half >= free_from {
            let style = Paper::words(11, INK.light, HPos::Center, VPos::Bottom);
            area.draw_text(&label, &style, (at, top - d(5)))?;
            free_from = at + half + d(2);
        }
    }
    Ok(())
}
