//! Measures all distances among variants, as a labelled matrix.

use std::collections::BTreeMap;

use driftworld_similarity::{DistanceMatrix, Placements, SimilarityError, VariantMeasure, Weights, Worlds};
use driftworld_spec::{By, Variant, World};
use rayon::prelude::*;

use super::pairs::{Means, Pairs, world_measure};
use super::{DistancesError, MEASURE_REQUIRED, Sample, Scale};

/// All distances among variants, labelled with their names; computed in parallel.
///
/// By parameters, with the weights that the task declares, overridden by `reweigh`; the matrix is a metric if the task's
/// measures are. By other measures, worlds of each variant are drawn as in `sample` and paired by index, so the
/// distance of two variants depends only on them and on `sample`, not on the rest of the list. If `sample` gives no
/// measure, the variants' task decides.
///
/// # Errors
/// [`DistancesError::By`] for parameters of variants of several tasks, and if several tasks have no measure given;
/// [`DistancesError::Generator`] for worlds that cannot be drawn, [`DistancesError::Similarity`] for too many variants or from
/// `reweigh`; otherwise as [`between`](super::between).
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
    reweigh: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    variant_matrix_while(variants, sample, reweigh, || true)
}

/// Like [`variant_matrix`], but takes variants with the names of their tasks; labels are such as `find_objects#red`.
///
/// # Errors
/// As [`variant_matrix`].
pub fn labelled_matrix(
    variants: &[(String, Variant)],
    sample: &Sample,
    reweigh: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    let label = |(task, variant): &(String, Variant)| (format!("{task}#{}", variant.name()), variant.clone());
    variant_matrix(&variants.iter().map(label).collect::<Vec<_>>(), sample, reweigh)
}

/// Like [`variant_matrix`], but cancelled as soon as `keep_going`, which is called before each pair, returns false.
///
/// # Errors
/// As [`variant_matrix`]; [`DistancesError::Interrupted`] if it was cancelled.
pub fn variant_matrix_while(
    variants: &[(String, Variant)],
    sample: &Sample,
    reweigh: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
    keep_going: impl Fn() -> bool + Sync,
) -> Result<DistanceMatrix, DistancesError> {
    let check_cancelled = || {
        if keep_going() {
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
                expected: MEASURE_REQUIRED,
            });
        }
        (_, task) => sample.measure(task.map_or(By::Parameters, |task| task.compare_by())),
    };
    // Check the labels before drawing worlds.
    DistanceMatrix::check_labels(&labels)?;
    let weights = reweigh(task.map_or_else(Weights::default, |task| Weights::of_task(task)))?;
    if let (By::Parameters, Some(task)) = (by, task) {
        let measure = VariantMeasure::new(task, weights);
        let unit = match sample.scale {
            Scale::Share if measure.has_diameter() => measure.diameter(),
            _ => 1.0,
        };
        let distance = |a: usize, b: usize| {
            check_cancelled()?;
            Ok::<_, DistancesError>(measure.between(&variants[a].1, &variants[b].1)?.total / unit)
        };
        let matrix = DistanceMatrix::measure(labels, distance)?.with_properties(measure.properties());
        return Ok(matrix);
    }
    sample.check_scale(by)?;
    Sample::check_count(by, sample.count(by))?;
    let count = sample.count(by) as usize;
    let drawn: Vec<Vec<World>> = variants
        .iter()
        .map(|(_, variant)| {
            check_cancelled()?;
            sample.draw(variant, count as u64)
        })
        .collect::<Result<_, _>>()?;
    if by == By::Worlds {
        let worlds = Worlds::new(&drawn.concat(), weights);
        let pairs = |a: usize, b: usize| (0..count).map(move |k| (a * count + k, b * count + k));
        let distance = |a: usize, b: usize| {
            check_cancelled()?;
            Ok::<_, DistancesError>(pairs(a, b).map(|(a, b)| worlds.distance(a, b)).sum::<f64>() / count as f64)
        };
        return DistanceMatrix::measure(labels, distance);
    }
    if by == By::Placements {
        let placements: Vec<Placements> = drawn.iter().map(|worlds| Placements::of(worlds)).collect();
        let distance = |a: usize, b: usize| {
            check_cancelled()?;
            Ok::<_, DistancesError>(placements[a].distance(&placements[b], &weights)?.total)
        };
        return DistanceMatrix::measure(labels, distance);
    }
    // Prepare one world of each variant at a time, because the prepared data are large.
    let size = variants.len();
    let pairs = (0..size).flat_map(|a| (a + 1..size).map(move |b| (a, b)));
    let mut means: BTreeMap<(usize, usize), Means> = pairs.map(|pair| (pair, Means::new(by))).collect();
    for k in 0..count {
        let worlds: Vec<World> = drawn.iter().map(|worlds| worlds[k].clone()).collect();
        check_cancelled()?;
        let prepared = Pairs::new(by, &worlds, &sample.catalogue)?;
        means.par_iter_mut().try_for_each(|((a, b), mean)| {
            check_cancelled()?;
            mean.add(&prepared.between(*a, *b)?);
            Ok::<_, DistancesError>(())
        })?;
    }
    let matrix = DistanceMatrix::measure(labels, |a, b| {
        Ok::<_, DistancesError>(means[&(a.min(b), a.max(b))].distance(&weights).total)
    })?;
    Ok(match world_measure(by) {
        // A mean of pseudometrics is a pseudometric.
        Some(measure) => matrix.with_properties(measure.properties_among(drawn.iter().flatten())),
        None => matrix,
    })
}
