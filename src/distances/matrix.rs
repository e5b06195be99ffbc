//! All distances among variants, labelled with their names.

use driftworld_similarity::{DistanceMatrix, Placements, SimilarityError, VariantMeasure, Weights, Worlds};
use driftworld_spec::{By, Variant, World};
use rayon::prelude::*;

use super::pairs::{Means, Pairs, world_measure};
use super::{DistancesError, NAME_IT, Sample, Scale};

/// All distances among variants, labelled with their names; computed in parallel.
///
/// By parameters, with the weights that the task declares, overridden by `lay_over`; the matrix is a metric if the task's
/// measures are. By other measures, worlds of each variant are drawn as in `sample` and paired by index, so the
/// distance of two variants depends only on them and on `sample`, not on the rest of the list. If `sample` gives no
/// measure, the variants' task decides.
///
/// # Errors
/// [`DistancesError::By`] for parameters of variants of several tasks, and if several tasks have no measure given;
/// [`DistancesError::Generator`] for worlds that cannot be drawn, [`DistancesError::Similarity`] for too many variants or from
/// `lay_over`; otherwise as [`between`](super::between).
///
/// # Example
/// ```
/// use driftworld::distances::{By, Sample, variant_matrix};
/// use driftworld::tasks;
/// let named = |name: &str| Ok::<_, tasks::TaskError>((name.to_owned(), tasks::variant(name)?));
/// let variants = [named("find_objects#blue")?, named("find_objects#dusk")?];
/// let matrix = variant_matrix(&variants, &Sample::by(By::Parameters), Ok)?;
/// assert!(matrix.get(0, 1) > 0.0 && matrix.properties().is_metric());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn variant_matrix(
    variants: &[(String, Variant)],
    sample: &Sample,
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    variant_matrix_while(variants, sample, lay_over, || true)
}

/// Like [`variant_matrix`], for variants with the names of their tasks; labels look like `find_objects#red`.
///
/// # Errors
/// As [`variant_matrix`].
pub fn labelled_matrix(
    variants: &[(String, Variant)],
    sample: &Sample,
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    let label = |(task, variant): &(String, Variant)| (format!("{task}#{}", variant.name()), variant.clone());
    variant_matrix(&variants.iter().map(label).collect::<Vec<_>>(), sample, lay_over)
}

/// Like [`variant_matrix`], but cancelled as soon as `go_on`, which is called before each pair, returns false.
///
/// # Errors
/// As [`variant_matrix`]; [`DistancesError::Interrupted`] if it was cancelled.
pub fn variant_matrix_while(
    variants: &[(String, Variant)],
    sample: &Sample,
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
    go_on: impl Fn() -> bool + Sync,
) -> Result<DistanceMatrix, DistancesError> {
    let asked = || {
        if go_on() {
            Ok(())
        } else {
            Err(DistancesError::Interrupted)
        }
    };
    let labels: Vec<String> = variants.iter().map(|(label, _)| label.clone()).collect();
    let first = variants.first().map(|(_, first)| first.task());
    let of_one_task = |task| variants.iter().all(|(_, variant)| variant.task().is_same_as(task));
    let task = first.filter(|task| of_one_task(task));
    let by = match (sample.by, task) {
        (Some(By::Parameters) | None, None) if first.is_some() => {
            return Err(DistancesError::By {
                found: "variants of several tasks".to_owned(),
                expected: NAME_IT,
            });
        }
        (Some(by), _) => by,
        (None, task) => task.map_or(By::Parameters, |task| task.compare_by()),
    };
    // Labels are checked before anything is drawn.
    DistanceMatrix::check_labels(&labels)?;
    let weights = lay_over(task.map_or_else(Weights::default, |task| Weights::of_task(task)))?;
    if let (By::Parameters, Some(task)) = (by, task) {
        let measure = VariantMeasure::new(task, weights);
        let unit = match sample.scale {
            Scale::Share if measure.has_diameter() => measure.diameter(),
            _ => 1.0,
        };
        let apart = |a: usize, b: usize| {
            asked()?;
            Ok::<_, DistancesError>(measure.between(&variants[a].1, &variants[b].1)?.total / unit)
        };
        let matrix = DistanceMatrix::measure(labels, apart)?.with_properties(measure.properties());
        return Ok(matrix);
    }
    sample.check_scale(by)?;
    Sample::check_count(by, sample.count(by))?;
    let count = sample.count(by) as usize;
    let drawn: Vec<Vec<World>> = variants
        .iter()
        .map(|(_, variant)| {
            asked()?;
            sample.draw(variant, count as u64)
        })
        .collect::<Result<_, _>>()?;
    if by == By::Worlds {
        let worlds = Worlds::new(&drawn.concat(), weights);
        let pairs = |a: usize, b: usize| (0..count).map(move |k| (a * count + k, b * count + k));
        let apart = |a: usize, b: usize| {
            asked()?;
            Ok::<_, DistancesError>(pairs(a, b).map(|(a, b)| worlds.distance(a, b)).sum::<f64>() / count as f64)
        };
        return DistanceMatrix::measure(labels, apart);
    }
    if by == By::Placements {
        let placements: Vec<Placements> = drawn.iter().map(|worlds| Placements::of(worlds)).collect();
        let apart = |a: usize, b: usize| {
            asked()?;
            Ok::<_, DistancesError>(placements[a].distance(&placements[b], &weights)?.total)
        };
        return DistanceMatrix::measure(labels, apart);
    }
    // One world of each variant at a time, because their prepared data are large.
    let size = variants.len();
    let pairs: Vec<(usize, usize)> = (0..size).flat_map(|a| (a + 1..size).map(move |b| (a, b))).collect();
    let mut means: Vec<Means> = pairs.iter().map(|_| Means::new(by)).collect();
    for k in 0..count {
        let worlds: Vec<World> = drawn.iter().map(|of_one| of_one[k].clone()).collect();
        asked()?;
        let ready = Pairs::new(by, &worlds, &sample.catalogue)?;
        pairs.par_iter().zip(&mut means).try_for_each(|((a, b), mean)| {
            asked()?;
            mean.add(&ready.between(*a, *b)?);
            Ok::<_, DistancesError>(())
        })?;
    }
    let at = |a: usize, b: usize| {
        let (a, b) = (a.min(b), a.max(b));
        a * size - a * (a + 1) / 2 + (b - a - 1)
    };
    let matrix = DistanceMatrix::measure(labels, |a, b| {
        Ok::<_, DistancesError>(means[at(a, b)].distance(&weights).total)
    })?;
    Ok(match world_measure(by) {
        // A mean of pseudometrics is a pseudometric.
        Some(measure) => matrix.with_properties(measure.properties_among(drawn.iter().flatten())),
        None => matrix,
    })
}
