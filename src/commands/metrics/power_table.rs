//! Table of the statistical power of the given lifetimes.

use crate::metrics::{MAX_POWER_LIFETIMES, MetricPower};
use crate::table::table;

use super::tables::number;

/// A row per metric; `None` without metrics.
pub(super) fn power(found: &[MetricPower]) -> Option<String> {
    let effect = found.first()?.effect;
    let rows = found.iter().map(|row| {
        let [a, b] = row.deviations.map(number);
        let [num_a, num_b] = row.lifetimes;
        [
            row.headline.name.to_string(),
            if row.deviations[0] == row.deviations[1] {
                a
            } else {
                format!("{a}, {b}")
            },
            if num_a == num_b {
                num_a.to_string()
            } else {
                format!("{num_a}, {num_b}")
            },
            row.power
                .map_or_else(|| "does not vary".to_owned(), |power| format!("{power:.2}")),
            match (row.power, row.lifetimes_needed) {
                (None, _) => String::new(),
                (_, None) => format!("over {MAX_POWER_LIFETIMES}"),
                (_, Some(num)) => num.to_string(),
            },
            row.smallest_effect.map_or_else(String::new, number),
        ]
    });
    let power = format!("power for {effect}");
    let needed = format!("lifetimes for {effect}");
    let headings = ["metric", "sd", "lifetimes", &*power, &*needed, "smallest effect"];
    Some(format!(
        "{}\nFor a difference of {effect} in the metric's own unit between two agents, by Welch's t test at 5%: the power with \
         these lifetimes; how many lifetimes of each agent have a power of 80%; and the smallest difference that these lifetimes \
         show with a power of 80%. A single agent is compared with one that varies as much. Nothing can be said about a metric \
         that does not vary between these lifetimes.",
        table(headings, rows, &[1, 2, 3, 4, 5])
    ))
}
