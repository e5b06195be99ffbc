//! The figure of raw values over the lifetime, with the smoothed curve: as points if there is room, otherwise as the area that
//! they cover.

use driftworld_metrics::Lifetime;
use plotters::prelude::*;

use super::learning::{COLUMNS, axes, shade};
use super::palette::Look;
use super::paper::{Area, Drawn, Paper, chart, curve};
use super::scene::{Scene, Stretch, roomy};
use super::thinning;
use crate::words::shown;

/// Maximum number of points drawn individually, in wide and in narrow figures.
const MAX_POINTS: [usize; 2] = [2400, 700];

pub(super) fn height(scene: &Scene, paper: &Paper) -> i32 {
    paper.head_height(&scene.entries()) + if paper.is_narrow() { 240 } else { 320 }
}

pub(super) fn draw<DB: DrawingBackend>(scene: &Scene, area: &Area<DB>, paper: &Paper) -> Drawn<DB> {
    let below = paper.head(area, &scene.entries())?;
    let values = scene
        .stretches
        .iter()
        .flat_map(|stretch| stretch.regime.raw.iter().copied());
    let name = shown(scene.column);
    let columns = COLUMNS[usize::from(paper.is_narrow())];
    let axes = axes(scene, paper, roomy(values), &name);
    let mut chart = chart(&below, &axes)?;
    shade(scene, &mut chart, &axes.y, columns)?;
    let num_points: usize = scene.stretches.iter().map(|stretch| stretch.regime.len()).sum();
    let as_points = num_points <= MAX_POINTS[usize::from(paper.is_narrow())];
    let column = scene.column(columns);
    // About one and a half pixels in each direction; anything smaller is invisible.
    let min_size = (
        (axes.x.end - axes.x.start) / f64::from(columns) * 1.5,
        (axes.y.end - axes.y.start) / 120.0,
    );
    for learning in [false, true] {
        for stretch in scene.drawn(learning, columns) {
            let color = Look::of(stretch.task).color;
            let raw = stretch.points(&stretch.regime.raw);
            if as_points {
                let size = if paper.is_narrow() { 2 } else { 3 };
                chart.draw_series(raw.iter().map(|at| Circle::new(*at, size, color.mix(0.35).filled())))?;
            } else {
                let outline = thinning::outline(&raw, &column, min_size);
                chart.draw_series([Polygon::new(outline, color.mix(0.3).filled())])?;
            }
        }
    }
    for stretch in scene.drawn(true, columns) {
        let points = stretch.points(&smoothed(scene.lifetime, stretch));
        let line = thinning::line(&points, &column);
        curve(&mut chart, line, Look::of(stretch.task).color)?;
    }
    Ok(())
}

/// The smoothed and clamped performances of a stretch, converted back to the log's unit.
fn smoothed(lifetime: &Lifetime, stretch: &Stretch) -> Vec<f64> {
    let range = lifetime
        .normalization_data_range()
        .and_then(|ranges| ranges.get(&stretch.regime.task_name));
    let back = |value: &f64| match range {
        Some(range) if range.max > range.min => range.min + (value - 1.0) / 100.0 * (range.max - range.min),
        Some(range) => range.min,
        None => *value,
    };
    stretch.regime.performance.iter().map(back).collect()
}
