//! Computes distances, elements and orders, and formats them for the page.

use driftworld::distances::{self, Sample, Side};
use driftworld::elements::{ElementsRequest, elements_of};
use driftworld::similarity::{DistanceMatrix, Method, OrderOptions, classical_map, order};
use driftworld::spec::{By, Element, Variant};
use serde_json::{Value, json};

use crate::call::Selection;
use crate::fault::Fault;
use crate::request::TaskCache;

/// The distance between two variants or worlds.
pub(crate) fn distance(a: &Side, b: &Side, by: Option<By>, worlds: Option<u64>, seed: u64) -> Result<Value, Fault> {
    let sample = Sample {
        by,
        worlds,
        seed,
        ..Sample::default()
    };
    let found = distances::between(a, b, &sample, Ok)?;
    let elements = Element::ALL.iter().zip(found.distance.elements);
    let elements: serde_json::Map<String, Value> = elements
        .map(|(element, distance)| (element.letter().to_owned(), json!(distance)))
        .collect();
    Ok(json!({
        "by": found.by, "unit": unit(found.by), "description": found.description, "total": found.distance.total, "elements": elements,
        "parts": found.distance.parts,
    }))
}

/// The meaning of a measure's numbers, in a sentence or two.
fn unit(by: By) -> &'static str {
    match by {
        By::Parameters => {
            "1 is one parameter moved over its whole range. A parameter that counts for several elements is added once."
        }
        By::Worlds => "Each part has its own unit, such as 10 m, half a turn, 100 points, or black instead of white.",
        By::Pictures => "1 is black instead of white, on objects or around them; the maximum is 2.",
        By::PicturesWhole => "1 is black instead of white everywhere.",
        By::PicturesStructure => "0 means the same edges and textures, 1 the opposite ones.",
        By::Occupancy => "In metres: how far objects would have to move on average, summed over their classes.",
        By::OccupancyJaccard => "1 means that no place is occupied in both.",
        By::OccupancyHausdorff => "In metres: the largest distance from an occupied place to the nearest of the other.",
        By::OccupancyChamfer => "In metres: the mean distance from occupied places to the nearest one of the other.",
        By::Placements => "1 is 10 m on average, or a class of objects that one of the two lacks; classes are summed.",
        By::Objects => "In metres: the mean distance between matched objects; an unmatched one counts 10 m.",
        By::ObjectsCounts => "1 means that no object has a counterpart.",
        By::Colors | By::ColorsSrgb | By::ColorsCie76 | By::ColorsCiede2000 | By::ColorsHyab => {
            "1 means that every object's colours are as far apart as two colours can be."
        }
        By::Rewards => "0 means the same goal, about 0.7 an unrelated one, 1 the opposite one.",
        By::Dynamics => "1 is 100 points, 10 m or half a turn of difference after the same action, on average.",
        By::DynamicsBisimulation => "1 is a difference of 100 points per action, if both do the same.",
        By::Behavior => "1 means that the other's planner earns 100 points less per episode than the world's own.",
        By::BehaviorSuccess => {
            "1 means that a planner always succeeds in its own worlds, and never in those of the other."
        }
    }
}

/// The elements in which two variants of a task differ, with a witness of each.
pub(crate) fn elements(
    tasks: &mut TaskCache,
    name_or_text: &str,
    [a, b]: [&str; 2],
    worlds: u64,
    seed: u64,
) -> Result<Value, Fault> {
    let task = tasks.task(name_or_text)?;
    let request = ElementsRequest {
        worlds,
        seed,
        ..ElementsRequest::between(task.name(), a, b)
    };
    let found = elements_of(&task, &request)?;
    let Some(variant) = found.variants.first() else {
        return Err(Fault::request("elements: found one variant, expected two"));
    };
    let measured = variant.measured.iter().map(|measured| {
        let witness = &measured.witness;
        let message = format!("{}: {} versus {}", witness.what, witness.a, witness.b);
        json!({ "element": measured.element, "message": message, "witness": witness })
    });
    Ok(json!({
        "parameters": variant.parameters, "declared": variant.declared, "measured": measured.collect::<Vec<_>>(),
        "contradictions": variant.contradictions.iter().map(|one| &one.message).collect::<Vec<_>>(),
        "idle": variant.idle, "verdict": variant.verdict,
    }))
}

/// All distances among variants, and the measure.
fn measure_distances(tasks: &mut TaskCache, selection: &Selection) -> Result<(DistanceMatrix, By), Fault> {
    let task = tasks.task(&selection.task)?;
    let variants: Vec<Variant> = match &selection.variants {
        None => task.all_variants(),
        Some(names) => names.iter().map(|name| task.variant(name)).collect::<Result<_, _>>()?,
    };
    let by = selection.by.unwrap_or_else(|| distances::fitting(&variants));
    let named: Vec<(String, Variant)> = (variants.into_iter())
        .map(|variant| (variant.name().to_owned(), variant))
        .collect();
    let sample = Sample {
        worlds: selection.worlds,
        ..Sample::by(by)
    };
    Ok((distances::variant_matrix(&named, &sample, Ok)?, by))
}

/// All distances among variants, and a two-dimensional map of them.
pub(crate) fn matrix(tasks: &mut TaskCache, selection: &Selection) -> Result<Value, Fault> {
    let (matrix, by) = measure_distances(tasks, selection)?;
    let map = classical_map(&matrix);
    let rows: Vec<Vec<f64>> = matrix.values().rows().into_iter().map(|row| row.to_vec()).collect();
    Ok(json!({ "by": by, "labels": matrix.labels(), "rows": rows, "points": map.points, "shown": map.explained }))
}

/// Orders variants.
pub(crate) fn order_variants(
    tasks: &mut TaskCache,
    selection: &Selection,
    method: Option<Method>,
    start: Option<&str>,
    seed: u64,
) -> Result<Value, Fault> {
    let (matrix, by) = measure_distances(tasks, selection)?;
    let method = method.unwrap_or_else(|| Method::default_for(matrix.len()));
    let index_of = |start: &str| {
        let found = matrix.labels().iter().position(|label| label == start);
        found.ok_or_else(|| {
            Fault::request(format!(
                "start: found {start:?}, expected one of {}",
                matrix.labels().join(", ")
            ))
        })
    };
    let options = OrderOptions {
        first: start.map(index_of).transpose()?,
        seed,
        ..OrderOptions::default()
    };
    let found = order(&matrix, method, &options)?;
    let labels: Vec<&String> = found.indices.iter().map(|index| &matrix.labels()[*index]).collect();
    Ok(json!({ "method": method, "by": by, "labels": labels, "steps": found.steps, "length": found.length }))
}
