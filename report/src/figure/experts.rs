//! The figure of experts: each task's learning blocks joined end to end, compared with the runs of its single-task expert.

use plotters::prelude::*;

use super::palette::{FAINT, INK, Look, RIM};
use super::panels::{Grid, MAX_PANELS};
use super::paper::{Area, Axes, Drawn, Entry, Paper, Sample, chart, curve};
use super::scene::{Scene, roomy};
use super::thinning;

/// Maximum number of runs drawn per expert.
const MAX_RUNS: usize = 12;
/// Maximum number of pixel columns of all curves together: the more curves, the fewer columns each has.
const MAX_COLUMNS: usize = 16_000;
/// Maximum number of borders drawn between blocks.
const MAX_BORDERS: usize = 60;

/// One task with its curves.
struct Panel {
    task: usize,
    own: Vec<f64>,
    borders: Vec<f64>,
    runs: Vec<Vec<f64>>,
}

/// Whether any learned task has an expert.
pub(super) fn any(scene: &Scene) -> bool {
    let mut tasks = scene.lifetime.tasks().iter();
    tasks.any(|task| scene.lifetime.expert_curves(task).next().is_some())
}

/// The learned tasks with an expert.
fn panels(scene: &Scene) -> Vec<Panel> {
    let tasks = scene.lifetime.tasks().iter().enumerate();
    let panel = |(task, name): (usize, &String)| {
        let runs: Vec<Vec<f64>> = scene.lifetime.expert_curves(name).take(MAX_RUNS).collect();
        let learned: Vec<&[f64]> = (scene.lifetime.regimes_of(name))
            .filter(|regime| regime.is_wake_training())
            .map(|regime| regime.performance.as_slice())
            .collect();
        let ends = learned.iter().scan(0.0, |sum, block| {
            *sum += block.len() as f64;
            Some(*sum)
        });
        (!runs.is_empty() && !learned.is_empty()).then(|| Panel {
            task,
            borders: ends.take(learned.len() - 1).take(MAX_BORDERS).collect(),
            own: learned.concat(),
            runs,
        })
    };
    tasks.filter_map(panel).collect()
}

fn entries(panels: &[Panel]) -> Vec<Entry> {
    let first = panels.first().map_or(0, |panel| panel.task);
    let mut entries = vec![
        Entry::new("this agent, in the task's colour", Sample::Line(Look::of(first).color)),
        Entry::new("an expert's run", Sample::Line(FAINT.light)),
    ];
    entries.extend(Entry::rest(panels.len(), MAX_PANELS, " tasks"));
    entries
}

pub(super) fn height(scene: &Scene, paper: &Paper) -> i32 {
    let panels = panels(scene);
    paper.head_height(&entries(&panels)) + Grid::of(panels.len(), paper).height()
}

pub(super) fn draw<DB: DrawingBackend>(scene: &Scene, area: &Area<DB>, paper: &Paper) -> Drawn<DB> {
    let panels = panels(scene);
    let below = paper.head(area, &entries(&panels))?;
    let grid = Grid::of(panels.len(), paper);
    let values = panels
        .iter()
        .flat_map(|panel| panel.own.iter().chain(panel.runs.iter().flatten()).copied());
    let y = roomy(values);
    let num_curves: usize = panels.iter().take(MAX_PANELS).map(|panel| panel.runs.len() + 1).sum();
    let columns = f64::from(grid.pixel_columns(paper).min((MAX_COLUMNS / num_curves.max(1)) as i32));
    for (panel, panel_area) in panels.iter().zip(grid.areas(&below)) {
        let lengths = panel.runs.iter().map(Vec::len).chain([panel.own.len()]);
        let longest = lengths.fold(2, usize::max) as f64;
        let axes = Axes {
            x: 0.0..longest,
            y: y.clone(),
            x_name: "experience of learning the task",
            y_name: (&scene.names[panel.task], INK.light),
            labels: grid.labels(),
        };
        let mut chart = chart(&panel_area, &axes)?;
        let border = |x: &f64| PathElement::new(vec![(*x, y.start), (*x, y.end)], Paper::stroke(RIM.light, 1.0));
        chart.draw_series(panel.borders.iter().map(border))?;
        let thin = |curve: &[f64]| {
            let points: Vec<(f64, f64)> = curve.iter().enumerate().map(|(x, y)| (x as f64, *y)).collect();
            thinning::line(&points, |x| (x / longest * columns) as i64)
        };
        for run in &panel.runs {
            chart.draw_series([PathElement::new(thin(run), Paper::stroke(FAINT.light, 1.5))])?;
        }
        curve(&mut chart, thin(&panel.own), Look::of(panel.task).color)?;
    }
    Ok(())
}
