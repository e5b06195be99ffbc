//! What a lifetime was, in a handful of numbers.

use driftworld_metrics::{BlockType, Lifetime, LifetimeMetrics};
use maud::{Markup, html};

use super::{count, number};
use crate::words::shown;

/// How much was lived, and by what it is judged.
pub(super) fn facts(lifetime: &Lifetime, metrics: &LifetimeMetrics) -> Markup {
    let learnt = || {
        let regimes = lifetime.regimes().iter();
        regimes.filter(|regime| regime.block_type == BlockType::Train)
    };
    let asleep = learnt().filter(|regime| !regime.is_wake_training()).count();
    let blocks = match asleep {
        0 => count(learnt().count()),
        _ => format!("{} ({} asleep)", count(learnt().count()), count(asleep)),
    };
    let mut facts = Vec::new();
    // How good the agent is comes first: the metrics, scaled by the lifetime's own range, do not say it.
    for (column, means) in &metrics.as_logged {
        for (mean, when) in [(means.learning, "learning"), (means.evaluation, "evaluations")] {
            if let Some(mean) = mean {
                facts.push((format!("mean {}, {when}", shown(column)), number(mean)));
            }
        }
    }
    let counts = [
        ("learning experiences", count(metrics.num_lx)),
        ("evaluation experiences", count(metrics.num_ex)),
        ("tasks", count(lifetime.tasks().len())),
        ("learning blocks", blocks),
        ("scored by", shown(&metrics.metrics_column)),
    ];
    facts.extend(counts.map(|(name, value)| (name.to_owned(), value)));
    html! {
        dl.facts {
            @for (name, value) in &facts {
                div { dt { (name) } dd { (value) } }
            }
        }
    }
}
