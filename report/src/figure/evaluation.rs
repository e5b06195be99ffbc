//! The figure of evaluations: the mean of each with its 95 % interval, one panel per task with all its variants, and the blocks in
//! which each was learned.

use driftworld_metrics::student_reach;
use indexmap::IndexMap;
use plotters::prelude::*;

use super::palette::{FAINT, INK, Look};
use super::panels::{Grid, MAX_PANELS};
use super::paper::{Area, Axes, Drawn, Entry, Paper, Sample, chart, draw_mark};
use super::scene::{Scene, Stretch, joined, roomy, task_entry};

/// Maximum number of variants that share a panel; with more, each gets its own, because they would hide each other.
const MAX_VARIANTS: usize = 5;
/// Maximum number of points in all panels together; with more, neighbouring points are merged.
const MAX_POINTS: usize = 3000;

/// Tasks whose evaluations share a panel.
struct Cluster {
    name: String,
    tasks: Vec<usize>,
}

/// The evaluated tasks, with variants of the same task together.
fn clusters(scene: &Scene) -> Vec<Cluster> {
    let mut evaluated = vec![false; scene.names.len()];
    for stretch in scene.stretches.iter().filter(|stretch| !stretch.learns()) {
        evaluated[stretch.task] = true;
    }
    let mut found: IndexMap<&str, Vec<usize>> = IndexMap::new();
    let tasks = scene.lifetime.tasks().iter().enumerate();
    for (task, name) in tasks.filter(|(task, _)| evaluated[*task]) {
        let variants = found.entry(name.split('_').next().unwrap_or(name));
        variants.or_default().push(task);
    }
    let alone = |task: usize| Cluster {
        name: scene.names[task].clone(),
        tasks: vec![task],
    };
    let panels = |(name, tasks): (&str, Vec<usize>)| match tasks.len() {
        2..=MAX_VARIANTS => vec![Cluster {
            name: match scene.names[tasks[0]].split_once('#') {
                Some((task, _)) => task.to_owned(),
                None => crate::words::shown(name),
            },
            tasks,
        }],
        _ => tasks.into_iter().map(alone).collect(),
    };
    found.into_iter().flat_map(panels).collect()
}

fn entries(scene: &Scene, clusters: &[Cluster]) -> Vec<Entry> {
    // A panel with a single task is already named.
    let drawn = clusters.iter().take(MAX_PANELS);
    let drawn = drawn.filter(|cluster| cluster.tasks.len() > 1);
    let mut entries: Vec<Entry> = drawn
        .flat_map(|cluster| cluster.tasks.iter())
        .map(|task| task_entry((*task, &scene.names[*task])))
        .take(super::scene::MAX_TASKS)
        .collect();
    entries.push(Entry::new("while it was learned", Sample::Tint(FAINT.light)));
    entries.extend(Entry::rest(clusters.len(), MAX_PANELS, " tasks"));
    entries
}

pub(super) fn height(scene: &Scene, paper: &Paper) -> i32 {
    let clusters = clusters(scene);
    paper.head_height(&entries(scene, &clusters)) + Grid::of(clusters.len(), paper).height()
}

pub(super) fn draw<DB: DrawingBackend>(scene: &Scene, area: &Area<DB>, paper: &Paper) -> Drawn<DB> {
    let clusters = clusters(scene);
    let below = paper.head(area, &entries(scene, &clusters))?;
    let grid = Grid::of(clusters.len(), paper);
    let drawn = || clusters.iter().take(MAX_PANELS);
    let num_tasks: usize = drawn().map(|cluster| cluster.tasks.len()).sum();
    let columns = grid.pixel_columns(paper).min((MAX_POINTS / num_tasks.max(1)) as i32);
    let points: Vec<Vec<Point>> = drawn().map(|cluster| points(scene, cluster, columns)).collect();
    let ends = points
        .iter()
        .flatten()
        .flat_map(|point| [point.mean - point.half_width, point.mean + point.half_width]);
    let y = roomy(ends);
    for ((cluster, points), panel) in clusters.iter().zip(&points).zip(grid.areas(&below)) {
        let axes = Axes {
            x: scene.span.clone(),
            y: y.clone(),
            x_name: scene.x_name(),
            y_name: (&cluster.name, INK.light),
            labels: grid.labels(),
        };
        let mut chart = chart(&panel, &axes)?;
        for task in &cluster.tasks {
            let learned = scene
                .stretches
                .iter()
                .filter(|stretch| stretch.task == *task && stretch.learns());
            let color = Look::of(*task).color.mix(0.14).filled();
            let blocks = joined(learned, scene.gap(grid.pixel_columns(paper))).into_iter();
            chart.draw_series(blocks.map(|x| Rectangle::new([(x.start, y.start), (x.end, y.end)], color)))?;
        }
        for task in &cluster.tasks {
            let of_task = || points.iter().filter(|point| point.task == *task);
            let look = Look::of(*task);
            let line = of_task().map(|point| (point.x, point.mean));
            chart.draw_series([PathElement::new(
                line.collect::<Vec<_>>(),
                look.color.mix(0.55).stroke_width(2),
            )])?;
            let bars = of_task().filter(|point| point.half_width > 0.0).map(|point| {
                let ends = [
                    (point.x, point.mean - point.half_width),
                    (point.x, point.mean + point.half_width),
                ];
                PathElement::new(ends.to_vec(), Paper::stroke(look.color, 1.5))
            });
            chart.draw_series(bars)?;
            let positions: Vec<(i32, i32)> = of_task()
                .map(|point| chart.backend_coord(&(point.x, point.mean)))
                .collect();
            let (left, top) = panel.get_base_pixel();
            for (x, y) in positions {
                draw_mark(&panel, look, (x - left, y - top), Paper::dots(3))?;
            }
        }
    }
    Ok(())
}

/// The mean of an evaluation.
struct Point {
    task: usize,
    x: f64,
    mean: f64,
    half_width: f64,
}

/// Mean, and half-width of Student's 95 % interval: 0 for a single sample, which has no interval.
fn mean_and_half_width(samples: &[f64]) -> (f64, f64) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    if samples.len() < 2 {
        return (mean, 0.0);
    }
    let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
    (mean, student_reach(0.95, n - 1.0) * (squares / (n - 1.0) / n).sqrt())
}

/// The evaluations of a cluster's tasks; those in the same block or pixel column are merged.
fn points(scene: &Scene, cluster: &Cluster, columns: i32) -> Vec<Point> {
    let column = scene.column(columns);
    let of_task = |task: usize| -> Vec<Point> {
        let evaluated: Vec<&Stretch> = (scene
            .stretches
            .iter()
            .filter(|stretch| stretch.task == task && !stretch.learns()))
        .collect();
        evaluated
            .chunk_by(|a, b| a.regime.block_num == b.regime.block_num || column(a.middle()) == column(b.middle()))
            .map(|group| {
                let samples: Vec<f64> = group
                    .iter()
                    .flat_map(|stretch| stretch.regime.performance.iter().copied())
                    .collect();
                let (mean, half_width) = mean_and_half_width(&samples);
                let x = group.iter().map(|stretch| stretch.middle()).sum::<f64>() / group.len() as f64;
                Point {
                    task,
                    x,
                    mean,
                    half_width,
                }
            })
            .collect()
    };
    cluster.tasks.iter().flat_map(|task| of_task(*task)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_match_student() {
        let check = |samples: &[f64], expected: (f64, f64)| {
            let found = mean_and_half_width(samples);
            assert!((found.0 - expected.0).abs() < 1e-12, "{samples:?}");
            assert!((found.1 - expected.1).abs() < 1e-3, "{samples:?}: {}", found.1);
        };
        check(&[4.0], (4.0, 0.0));
        check(&[1.0, 3.0], (2.0, 12.706));
        // scipy.stats.t.interval(0.95, 4, loc=3, scale=scipy.stats.sem([1, 2, 3, 4, 5])) is 1.0368 to 4.9632.
        check(&[1.0, 2.0, 3.0, 4.0, 5.0], (3.0, 1.9632));
        check(&[2.0; 100], (2.0, 0.0));
    }
}
