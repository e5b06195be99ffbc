//! What is shown of a curriculum: the proof of its variants, its blocks. The picture is `timeline.rs`'s.

use driftworld::curriculum::{Choice, Picked, Steps};
use driftworld::similarity::{Distance, DistanceMatrix};
use driftworld::spec::{Block, BlockKind, Element, Phase, Regime, Scenario, Variant};

use super::choose::Chosen;
use crate::commands::Failure;
use crate::commands::table::{table, wide_table};

/// Variants in an order, as a scenario names them.
pub(crate) fn choices(variants: &[(String, Variant)], order: &[usize]) -> Vec<Choice> {
    let choice = |index: &usize| Choice::new(&variants[*index].0, variants[*index].1.name());
    order.iter().map(choice).collect()
}

/// The proof that variants differ from the first in one element only: every distance, 0 as such where it is exactly that.
pub(super) fn probe(picked: &[&Picked], anchor: &Picked, element: Element) -> Result<String, Failure> {
    let mut rows = Vec::new();
    for one in picked {
        rows.push(row(one, &anchor.distance(one)?));
    }
    Ok(format!(
        "distances from {}, probing the {}: 0 is exactly 0, - is where nothing could differ\n{}\n",
        anchor.choice.id(),
        element.name(),
        wide_table(headings(), rows, &[2, 3, 4, 5, 6])
    ))
}

/// The proof that each variant is a step from the one before.
pub(super) fn steps(picked: &[Picked], wanted: &Steps) -> Result<String, Failure> {
    let mut rows = Vec::new();
    for (index, one) in picked.iter().enumerate() {
        let before = &picked[index.saturating_sub(1)];
        let apart = before.distance(one)?;
        let mut row = row(one, &apart);
        row.push(if index == 0 { String::new() } else { exact(apart.total) });
        rows.push(row);
    }
    let mut headings = headings();
    headings.push("all together".to_owned());
    let measured = wanted.element.map_or("all together", Element::name);
    Ok(format!(
        "distances from the variant before, {} ± {} wanted in {}{measured}\n{}\n",
        wanted.distance,
        wanted.tolerance,
        if wanted.element.is_some() { "the " } else { "" },
        wide_table(headings, rows, &[2, 3, 4, 5, 6, 7])
    ))
}

fn headings() -> Vec<String> {
    let elements = Element::ALL.map(|element| element.name().to_owned());
    ["variant", "is"]
        .map(str::to_owned)
        .into_iter()
        .chain(elements)
        .collect()
}

fn row(picked: &Picked, apart: &Distance) -> Vec<String> {
    let is = if picked.is_made() { "made" } else { "declared" };
    let elements = Element::ALL.map(|element| apart.element(element).map_or_else(|| "-".to_owned(), exact));
    [picked.choice.id(), is.to_owned()]
        .into_iter()
        .chain(elements)
        .collect()
}

/// A distance to four places; 0 without places only where it is nothing else.
fn exact(distance: f64) -> String {
    if distance == 0.0 {
        "0".to_owned()
    } else {
        format!("{distance:.4}")
    }
}

/// An order in a line: names, and how long the way is.
pub(super) fn path(chosen: &Chosen, order: &[usize]) -> String {
    let names: Vec<&str> = order.iter().map(|index| chosen.variants[*index].name()).collect();
    let length: f64 = order.windows(2).map(|pair| chosen.matrix.get(pair[0], pair[1])).sum();
    format!("{}; length {length:.4}", names.join(", "))
}

/// The variants that a scenario learns, in a line.
pub(super) fn learned(scenario: &Scenario) -> String {
    let learning = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    let names: Vec<&str> = learning
        .flat_map(|block| &block.regimes)
        .map(Regime::variant_name)
        .collect();
    names.join(", ")
}

/// The blocks of a scenario as a table, with the distance of each learning block from the one before.
pub(crate) fn blocks(scenario: &Scenario, matrix: Option<&DistanceMatrix>) -> String {
    let mut before: Option<usize> = None;
    let rows = scenario.blocks.iter().enumerate().map(|(index, block)| {
        let names: Vec<String> = block.regimes.iter().map(named).collect();
        let mut step = String::new();
        if block.kind == BlockKind::Learning
            && let Some(matrix) = matrix
        {
            let first = block
                .regimes
                .first()
                .map(|r| format!("{}#{}", r.task, r.variant_name()));
            let here = matrix.labels().iter().position(|label| first.as_ref() == Some(label));
            if let (Some(a), Some(b)) = (before, here) {
                step = format!("{:.4}", matrix.get(a, b));
            }
            before = here.or(before);
        }
        let what = if names.len() > 2 && block.kind == BlockKind::Evaluation {
            format!("all {} variants", names.len())
        } else {
            names.join(", ")
        };
        let experiences = block.num_experiences().to_string();
        [index.to_string(), kind(block).to_owned(), what, experiences, step]
    });
    table(
        [
            "block",
            "kind",
            "variants",
            "experiences",
            "distance from the last learned",
        ],
        rows.collect(),
        &[0, 3, 4],
    )
}

fn kind(block: &Block) -> &'static str {
    match (block.phase, block.kind) {
        (Phase::PreDeployment, BlockKind::Learning) => "learning before deployment",
        (Phase::PreDeployment, BlockKind::Evaluation) => "evaluation before deployment",
        (Phase::Deployment, BlockKind::Learning) => "learning",
        (Phase::Deployment, BlockKind::Evaluation) => "evaluation",
    }
}

/// A regime's variant, and where it drifts.
fn named(regime: &Regime) -> String {
    let name = format!("{}#{}", regime.task, regime.variant_name());
    match &regime.drift {
        None => name,
        Some(drift) => format!(
            "{name} to {}, {:.0}% to {:.0}%",
            drift.variant_name(),
            100.0 * drift.from,
            100.0 * drift.until
        ),
    }
}
