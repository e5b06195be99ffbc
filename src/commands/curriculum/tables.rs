//! Tables of a curriculum: the evidence for its variants, and its blocks.

use std::collections::{BTreeMap, BTreeSet};

use crate::curriculum::{Choice, Picked, Steps};
use crate::design::{Evidence, PairOptimum};
use crate::similarity::{Distance, DistanceMatrix};
use crate::spec::{Block, BlockKind, Element, Phase, Regime, Scenario, Variant};

use crate::Failure;
use crate::table::table;
use crate::tasks;

/// Variants in an order, as named in scenarios.
pub(crate) fn choices(variants: &[(String, Variant)], order: &[usize]) -> Vec<Choice> {
    let choice = |index: &usize| Choice::new(&variants[*index].0, variants[*index].1.name());
    order.iter().map(choice).collect()
}

/// The evidence that variants are as requested, in their learning order.
pub(super) fn evidence(evidence: &Evidence, order: &[usize]) -> Result<String, Failure> {
    match evidence {
        Evidence::Probe { picked, element } => probe(picked, order, *element),
        Evidence::Steps { picked, wanted } => steps(picked, wanted),
    }
}

/// The evidence that variants differ from the first in one element only: every distance, with exact zeros marked as such.
fn probe(picked: &[Picked], order: &[usize], element: Element) -> Result<String, Failure> {
    let anchor = &picked[0];
    let mut rows = Vec::new();
    for one in order.iter().map(|index| &picked[*index]) {
        rows.push(row(one, &anchor.distance(one)?));
    }
    Ok(format!(
        "distances from {}, probing the {}: 0 means exactly 0, - means that nothing could differ\n{}\n{}",
        anchor.label(),
        element.name(),
        table(headings(), rows, &[2, 3, 4, 5, 6]),
        made_values(order.iter().map(|index| &picked[*index]))
    ))
}

/// The evidence that each variant is one step from the previous one.
fn steps(picked: &[Picked], wanted: &Steps) -> Result<String, Failure> {
    let mut rows = Vec::new();
    for (index, one) in picked.iter().enumerate() {
        let before = &picked[index.saturating_sub(1)];
        let apart = before.distance(one)?;
        let mut row = row(one, &apart);
        row.push(if index == 0 { String::new() } else { exact(apart.total) });
        rows.push(row);
    }
    let headings = headings().chain(["all together"]);
    let measured = wanted.element.map_or("all together", Element::name);
    Ok(format!(
        "distances from the previous variant, {} ± {} wanted in {}{measured}\n{}\n{}",
        wanted.distance,
        wanted.tolerance,
        if wanted.element.is_some() { "the " } else { "" },
        table(headings, rows, &[2, 3, 4, 5, 6, 7]),
        made_values(picked)
    ))
}

/// The values of each variant that was created, one line per variant; empty if none was created.
fn made_values<'a>(picked: impl IntoIterator<Item = &'a Picked>) -> String {
    let mut lines = String::new();
    for one in picked.into_iter().filter(|one| one.is_made()) {
        let values = one
            .choice
            .values
            .iter()
            .map(|(name, value)| format!("{name} = {value}"));
        let values: Vec<String> = values.collect();
        lines = format!("{lines}{} sets {}\n", one.label(), values.join(", "));
    }
    if lines.is_empty() { lines } else { format!("\n{lines}") }
}

fn headings() -> impl Iterator<Item = &'static str> {
    ["variant", "is"].into_iter().chain(Element::ALL.map(Element::name))
}

fn row(picked: &Picked, apart: &Distance) -> Vec<String> {
    let is = if picked.is_made() { "made" } else { "declared" };
    let elements = Element::ALL.map(|element| apart.element(element).map_or_else(|| "-".to_owned(), exact));
    [picked.label(), is.to_owned()].into_iter().chain(elements).collect()
}

/// A distance with four decimals; "0" without decimals only if it is exactly 0.
fn exact(distance: f64) -> String {
    if distance == 0.0 {
        "0".to_owned()
    } else {
        format!("{distance:.4}")
    }
}

/// The variants learned in a scenario's deployment phase, on one line: their names, and the length of the path.
pub(super) fn path(scenario: &Scenario, matrix: &DistanceMatrix) -> String {
    let learning = |block: &&Block| block.kind == BlockKind::Learning && block.phase == Phase::Deployment;
    let blocks = scenario.blocks.iter().filter(learning);
    let mut stops: Vec<(&str, Option<usize>)> = Vec::new();
    for regime in blocks.flat_map(|block| &block.regimes) {
        let start = (regime.variant_name(), label(matrix, regime, regime.variant_name()));
        let (begins, end) = match &regime.drift {
            None => (true, None),
            Some(drift) => {
                let name = drift.variant_name();
                (
                    drift.from == 0.0,
                    (drift.until == 1.0).then(|| (name, label(matrix, regime, name))),
                )
            }
        };
        // Where one drift ends the next begins.
        if begins && (regime.drift.is_none() || stops.last() != Some(&start)) {
            stops.push(start);
        }
        stops.extend(end);
    }
    let step = |pair: &[(&str, Option<usize>)]| pair[0].1.zip(pair[1].1).map_or(0.0, |(a, b)| matrix.get(a, b));
    let length: f64 = stops.windows(2).map(step).sum();
    let names: Vec<&str> = stops.iter().map(|(name, _)| *name).collect();
    format!("{}; length {length:.4}", names.join(", "))
}

/// The index of a regime's variant in a matrix.
fn label(matrix: &DistanceMatrix, regime: &Regime, name: &str) -> Option<usize> {
    let id = format!("{}#{name}", regime.task);
    matrix.labels().iter().position(|label| *label == id)
}

/// The position of a regime at an experience: at a variant of the matrix, or part of the way between two.
fn place(matrix: &DistanceMatrix, regime: &Regime, experience: u32) -> Option<(usize, usize, f64)> {
    let start = label(matrix, regime, regime.variant_name())?;
    let Some(drift) = &regime.drift else {
        return Some((start, start, 0.0));
    };
    let end = label(matrix, regime, drift.variant_name())?;
    let progress = drift.progress(experience, regime.count);
    Some(if progress == 0.0 {
        (start, start, 0.0)
    } else if progress == 1.0 {
        (end, end, 0.0)
    } else {
        (start, end, progress)
    })
}

/// The distance between two positions; unknown if either is between variants.
fn step(matrix: &DistanceMatrix, from: (usize, usize, f64), to: (usize, usize, f64)) -> Option<f64> {
    if from == to {
        return Some(0.0);
    }
    (from.0 == from.1 && to.0 == to.1).then(|| matrix.get(from.0, to.0))
}

/// The variants learned in a scenario, on one line.
pub(super) fn learned(scenario: &Scenario) -> String {
    let learning = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    let name = |regime: &Regime| match &regime.drift {
        None => regime.variant_name().to_owned(),
        Some(drift) => format!("{} to {}", regime.variant_name(), drift.variant_name()),
    };
    let names: Vec<String> = learning.flat_map(|block| &block.regimes).map(name).collect();
    names.join(", ")
}

/// Whether the optimal behaviour changes between variants: a row per pair.
pub(super) fn optima(found: &[PairOptimum]) -> String {
    let rows = found.iter().map(|pair| {
        let word = if pair.optimum.turned { "yes" } else { "no" };
        let points = |points: f64| format!("{:.1}", points + 0.0);
        [
            format!("{}, {}", pair.a, pair.b),
            word.to_owned(),
            points(pair.optimum.regret),
            points(pair.optimum.regret_in_base),
        ]
    });
    let headings = ["pair", "best changes", "planner of the first loses", "of the second"];
    format!(
        "{}\nHow many points less a planner of one variant earns in worlds of the other than the other's own planner; where \
         nothing changes, nothing has to be forgotten.\n",
        table(headings, rows, &[2, 3])
    )
}

/// The blocks of a scenario as a table, with the distance from the end of each learning block to the start of the next.
pub(super) fn blocks(scenario: &Scenario, measured: Option<(&DistanceMatrix, &str)>) -> String {
    let matrix = measured.map(|(matrix, _)| matrix);
    let by = measured.map_or_else(String::new, |(_, by)| format!(" {by}"));
    let mut before: Option<(usize, usize, f64)> = None;
    let tasks = names_of_tasks(scenario);
    let rows = scenario.blocks.iter().enumerate().map(|(index, block)| {
        let names: Vec<String> = block.regimes.iter().map(|regime| named(regime, &tasks)).collect();
        let mut shown = String::new();
        if block.kind == BlockKind::Learning
            && let Some(matrix) = matrix
        {
            let here = block.regimes.first().and_then(|regime| place(matrix, regime, 0));
            if let Some(apart) = before.zip(here).and_then(|(before, here)| step(matrix, before, here)) {
                shown = format!("{apart:.4}");
            }
            before = block
                .regimes
                .last()
                .and_then(|regime| place(matrix, regime, regime.count.saturating_sub(1)));
        }
        let what = if names.len() > 2 && block.kind == BlockKind::Evaluation {
            format!("all {} variants", names.len())
        } else {
            names.join(", ")
        };
        let experiences = block.num_experiences().to_string();
        [index.to_string(), kind(block).to_owned(), what, experiences, shown]
    });
    table(
        [
            "block",
            "kind",
            "variants",
            "experiences",
            &format!("distance{by} from the last learned"),
        ],
        rows,
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

/// The names of the tasks that a scenario gives as paths.
fn names_of_tasks(scenario: &Scenario) -> BTreeMap<&str, String> {
    let regimes = scenario.blocks.iter().flat_map(|block| &block.regimes);
    let called: BTreeSet<&str> = regimes.map(|regime| regime.task.as_str()).collect();
    called
        .into_iter()
        .map(|called| (called, tasks::name_of(called)))
        .collect()
}

/// A regime's variant, with the destination of a drift.
fn named(regime: &Regime, tasks: &BTreeMap<&str, String>) -> String {
    let task = tasks
        .get(regime.task.as_str())
        .map_or(regime.task.as_str(), String::as_str);
    let name = format!("{task}#{}", regime.variant_name());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn block_distance_is_from_the_previous_blocks_end_to_its_own_start() {
        let at = [0.0_f64, 1.0, 3.0];
        let names = ["t#a", "t#b", "t#c"].map(str::to_owned).to_vec();
        let matrix = DistanceMatrix::measure(names, |a, b| {
            Ok::<_, crate::curriculum::CurriculumError>((at[a] - at[b]).abs() / 4.0)
        });
        let matrix = matrix.unwrap();
        let block =
            |regime: &str| format!(r#"{{ "type": "learning", "regimes": [{{ "task": "t", "count": 4, {regime} }}] }}"#);
        let blocks_of = [
            r#""variant": "a", "drift": { "to": "a", "values": { "x": 1 }, "name": "b", "until": 0.5 }"#,
            r#""variant": "a", "drift": { "to": "a", "values": { "x": 1 }, "name": "b", "from": 0.5 }"#,
            r#""variant": "a", "values": { "x": 1 }, "name": "b""#,
            r#""variant": "c""#,
        ]
        .map(block)
        .join(", ");
        let text = format!(r#"{{ "name": "s", "blocks": [{blocks_of}] }}"#);
        let scenario = Scenario::from_json("s", &text).unwrap();
        let shown = blocks(&scenario, Some((&matrix, "by parameters")));
        let steps: Vec<&str> = shown
            .lines()
            .skip(2)
            .filter_map(|line| line.split_whitespace().last())
            .collect();
        assert_eq!(steps, ["0.0000", "0.0000", "0.5000"], "{shown}");
        assert!(shown.contains("t#a to b, 50% to 100%"), "{shown}");
        assert_eq!(path(&scenario, &matrix), "a, b, b, c; length 0.7500");
    }
}
