//! Writes the report as text, and the texts of its picture.

use crate::curriculum::{DirectionReport, TransferReport};
use crate::metrics::{MAX_P_VALUE, TransferMethod};
use crate::similarity::MantelTest;
use driftworld_text::{counted, when};

use crate::report::picture::{Panel, Point};
use crate::table::table;

/// Maximum number of pairs in the table; the others are only counted.
const MAX_PAIRS: usize = 40;

/// The whole report.
pub(super) fn report(report: &TransferReport) -> String {
    let mut text = head(report);
    text.push_str(&pairs(report));
    text.push_str(&tests(report));
    text.push('\n');
    for note in notes(report).into_iter().chain([conclusion(report)]) {
        text.extend(["\n", &note, "\n"]);
    }
    text.truncate(text.trim_end().len());
    text
}

fn head(report: &TransferReport) -> String {
    format!(
        "Does similarity predict transfer? {}; transfer as {}\n\n",
        counted(report.lifetimes, "lifetime"),
        match report.measure {
            TransferMethod::Ratio => "ratio: above 1 learning helped the other variant, below 1 it harmed",
            _ => "contrast, −1 to 1: above 0 learning helped the other variant, below 0 it harmed",
        }
    )
}

fn pairs(report: &TransferReport) -> String {
    let directions = [("forward", &report.forward), ("backward", &report.backward)];
    let all = directions
        .iter()
        .flat_map(|(name, direction)| direction.pairs.iter().map(move |pair| (*name, pair)));
    let rows: Vec<[String; 6]> = all
        .clone()
        .take(MAX_PAIRS)
        .map(|(name, pair)| {
            [
                name.to_owned(),
                pair.from.clone(),
                pair.to.clone(),
                format!("{:.4}", pair.distance),
                format!("{:.4}", pair.transfer),
                pair.lifetimes.to_string(),
            ]
        })
        .collect();
    let head = ["", "learned", "evaluated", "distance", "transfer", "lifetimes"];
    let mut text = table(head, rows, &[3, 4, 5]);
    let more = all.count().saturating_sub(MAX_PAIRS);
    if more > 0 {
        text.extend(["\nand ", &more.to_string(), " more pairs; --json has all"]);
    }
    text + "\n\n"
}

fn tests(report: &TransferReport) -> String {
    let mut rows = Vec::new();
    let mut untested = Vec::new();
    for (name, direction) in [("forward", &report.forward), ("backward", &report.backward)] {
        rows.extend(
            [direction.spearman, direction.pearson]
                .into_iter()
                .flatten()
                .map(|test| {
                    [
                        name.to_owned(),
                        test.method.to_string(),
                        signed(test.correlation),
                        p_value_text(test.p_less, &test),
                        p_value_text(test.p_two_sided, &test),
                        test.pairs.to_string(),
                        test.items.to_string(),
                    ]
                }),
        );
        untested.extend(
            direction
                .untested
                .iter()
                .map(|why| format!("\n{name}: not tested: {why}")),
        );
    }
    let head = [
        "",
        "correlation",
        "value",
        "p (nearer → more)",
        "p (either way)",
        "pairs",
        "variants",
    ];
    table(head, rows, &[2, 3, 4, 5, 6]) + &untested.concat()
}

/// Whether similarity predicts transfer, by the rank test of each direction.
fn conclusion(report: &TransferReport) -> String {
    let answer = |name: &str, direction: &DirectionReport| {
        let test = direction.spearman?;
        let p = p_value_text(test.p_less, &test);
        Some(if test.p_less <= MAX_P_VALUE {
            format!("{name} transfer: yes, nearer variants gained more (p {p}).")
        } else {
            format!("{name} transfer: not shown (p {p}, above {MAX_P_VALUE}); more variants or lifetimes may show it.")
        })
    };
    let answers = [("Forward", &report.forward), ("Backward", &report.backward)];
    let answers: Vec<String> = answers
        .iter()
        .filter_map(|(name, direction)| answer(name, direction))
        .collect();
    answers.join("\n")
}

/// How to read the numbers, and their limits.
fn notes(report: &TransferReport) -> Vec<String> {
    let mut notes = vec![
        "value: below 0, nearer variants transferred more; 0, distance predicted nothing. Spearman compares ranks, \
         Pearson the numbers."
            .to_owned(),
    ];
    if let Some(test) = report.forward.spearman.or(report.backward.spearman) {
        notes.push(format!(
            "p: the share of {} whose correlation is at least as strong. A small p means that random labels seldom do \
             as well. It is not the probability that similarity does not matter, nor a measure of how much it \
             matters. A large p means that this many variants could not show an effect, not that there is none.{}",
            relabellings(&test),
            when(test.exact, || {
                format!(
                    " With {} variants it cannot be below 1/{}.",
                    test.items, test.relabellings
                )
            })
        ));
    }
    if report.learning_orders < 2 {
        notes.push(
            "All lifetimes learned in the same order, so they cannot show whether a variant gained because it was \
             near or because it came early. Add lifetimes in other orders (reversed, random)."
                .to_owned(),
        );
    }
    notes.push(
        "Correlation is not causation: a variant that is easy, or already learned as well as possible, has its own \
         transfer, whichever variants are near."
            .to_owned(),
    );
    for (names, place) in [
        (&report.not_in_logs, "logs"),
        (&report.not_in_matrix, "distance matrix"),
    ] {
        if !names.is_empty() {
            notes.push(format!(
                "Left out because they are not in the {place}: {}.",
                names.join(", ")
            ));
        }
    }
    notes
}

fn relabellings(test: &MantelTest) -> String {
    if test.exact {
        format!("all {} relabellings of the variants", test.relabellings)
    } else {
        format!("{} random relabellings of the variants", test.relabellings)
    }
}

fn signed(value: f64) -> String {
    format!("{value:+.3}")
}

/// A p-value as text; for random relabellings, not below the test's resolution.
fn p_value_text(p: f64, test: &MantelTest) -> String {
    if !test.exact && p <= 1.0 / (test.relabellings + 1) as f64 {
        return format!("≤ {p:.1e}");
    }
    format!("{p:.4}")
}

/// The picture's panels: one for each direction with pairs.
pub(super) fn panels(report: &TransferReport) -> Vec<Panel> {
    let directions = [
        ("Forward: to variants not yet learned", &report.forward),
        ("Backward: to variants learned before", &report.backward),
    ];
    let neutral = if report.measure == TransferMethod::Ratio {
        1.0
    } else {
        0.0
    };
    directions
        .into_iter()
        .filter(|(_, direction)| !direction.pairs.is_empty())
        .map(|(title, direction)| Panel {
            title: title.to_owned(),
            words: summary(direction),
            across: "distance".to_owned(),
            up: format!("transfer ({})", report.measure),
            neutral,
            points: points(direction),
        })
        .collect()
}

fn summary(direction: &DirectionReport) -> String {
    match &direction.spearman {
        Some(test) => format!(
            "Spearman {}; random labels do as well with p = {} (the nearer, the more); {} pairs of {} variants",
            signed(test.correlation),
            p_value_text(test.p_less, test),
            test.pairs,
            test.items
        ),
        None => format!("{}: not tested, see the text", counted(direction.pairs.len(), "pair")),
    }
}

fn points(direction: &DirectionReport) -> Vec<Point> {
    let task = |name: &str| name.rsplit_once('#').map_or(String::new(), |(task, _)| task.to_owned());
    let first = direction.pairs.first().map(|pair| task(&pair.from)).unwrap_or_default();
    let one_task = direction
        .pairs
        .iter()
        .all(|pair| task(&pair.from) == first && task(&pair.to) == first);
    // The task's name is omitted if all variants belong to one task.
    let short = |name: &str| match name.rsplit_once('#') {
        Some((_, variant)) if one_task => variant.to_owned(),
        _ => name.to_owned(),
    };
    let point = |pair: &crate::curriculum::PairTransfer| Point {
        x: pair.distance,
        y: pair.transfer,
        label: format!("{} › {}", short(&pair.from), short(&pair.to)),
    };
    direction.pairs.iter().map(point).collect()
}
