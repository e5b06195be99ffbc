//! The figure of learning curves over the lifetime, with evaluations shaded and dotted lines between the means of each task's
//! evaluations.

use std::ops::Range;

use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::palette::{FAINT, Look, SHADE};
use super::paper::{Area, Axes, Chart, Drawn, Paper, chart, curve, draw_mark};
use super::scene::{MAX_TASKS, Scene, Stretch, joined, roomy};
use super::thinning;

/// Pixel columns between the axes, in wide and in narrow figures.
pub(super) const COLUMNS: [i32; 2] = [900, 300];
/// Maximum number of evaluations joined by dotted lines; if there are more, thin solid lines join them.
const MAX_DOTTED: usize = 90;

pub(super) fn height(scene: &Scene, paper: &Paper) -> i32 {
    paper.head_height(&scene.entries()) + if paper.is_narrow() { 260 } else { 340 }
}

/// Axes over the whole lifetime.
pub(super) fn axes<'a>(scene: &Scene, paper: &Paper, y: Range<f64>, name: &'a str) -> Axes<'a> {
    Axes {
        x: scene.span.clone(),
        y,
        x_name: scene.x_name(),
        y_name: (name, FAINT.light),
        labels: if paper.is_narrow() { [4, 5] } else { [9, 6] },
    }
}

/// Shades the evaluations in grey.
pub(super) fn shade<DB: DrawingBackend>(
    scene: &Scene,
    chart: &mut Chart<DB>,
    y: &Range<f64>,
    columns: i32,
) -> Drawn<DB> {
    let evaluated = scene.stretches.iter().filter(|stretch| !stretch.learns());
    let shades = joined(evaluated, scene.gap(columns)).into_iter();
    let boxes = shades.map(|x| Rectangle::new([(x.start, y.start), (x.end, y.end)], SHADE.light.filled()));
    chart.draw_series(boxes)?;
    Ok(())
}

pub(super) fn draw<DB: DrawingBackend>(scene: &Scene, area: &Area<DB>, paper: &Paper) -> Drawn<DB> {
    let below = paper.head(area, &scene.entries())?;
    let columns = COLUMNS[usize::from(paper.is_narrow())];
    let learned = scene.drawn(true, columns);
    let evaluated = scene.drawn(false, columns);
    let values = learned
        .iter()
        .flat_map(|stretch| stretch.regime.performance.iter().copied());
    let name = scene.performance_name();
    let y = roomy(values.chain(evaluated.iter().map(|stretch| stretch.mean())));
    let axes = axes(scene, paper, y, &name);
    let mut chart = chart(&below, &axes)?;
    shade(scene, &mut chart, &axes.y, columns)?;
    if scene.options.show_eval_lines {
        for task in 0..scene.names.len().min(MAX_TASKS) {
            let of_task = evaluated.iter().filter(|stretch| stretch.task == task);
            let means: Vec<(f64, f64)> = of_task.map(|stretch| (stretch.middle(), stretch.mean())).collect();
            join(&mut chart, Look::of(task), means, evaluated.len() <= MAX_DOTTED)?;
        }
    }
    let column = scene.column(columns);
    for stretch in &learned {
        let line = thinning::line(&stretch.points(&stretch.regime.performance), &column);
        curve(&mut chart, line, Look::of(stretch.task).color)?;
    }
    let marked = |stretch: &&&Stretch| !stretch.learns() || scene.names.len() > super::palette::TASKS.len();
    let radius = Paper::dots(if evaluated.len() > 240 { 2 } else { 3 });
    let positions: Vec<((i32, i32), Look)> = (evaluated.iter().chain(&learned).filter(marked))
        .map(|stretch| {
            let at = chart.backend_coord(&(stretch.middle(), stretch.mean()));
            (at, Look::of(stretch.task))
        })
        .collect();
    let (left, top) = area.get_base_pixel();
    for ((x, y), look) in positions {
        draw_mark(area, look, (x - left, y - top), radius)?;
    }
    Ok(())
}

/// A line from evaluation to evaluation, dotted or thin.
fn join<DB: DrawingBackend>(chart: &mut Chart<DB>, look: Look, means: Vec<(f64, f64)>, dotted: bool) -> Drawn<DB> {
    if means.len() < 2 {
        return Ok(());
    }
    if dotted {
        let style = Paper::stroke(look.color, 1.5);
        let dashes = DashedPathElement::new(means, Paper::dots(2), Paper::dots(4), style);
        chart.draw_series([dashes])?;
    } else {
        let style = look.color.mix(0.6).stroke_width(Paper::dots(1) as u32);
        chart.draw_series([PathElement::new(means, style)])?;
    }
    Ok(())
}
