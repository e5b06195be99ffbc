//! Displays readings and the names of metrics. Colour and sign only repeat the word, which comes from the metrics.

use driftworld_metrics::{Direction, Reading};
use driftworld_text::capitalized;
use maud::{Markup, html};

/// A judgement of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Verdict {
    /// `good`, `bad` or `even`.
    pub(super) class: &'static str,
    pub(super) sign: &'static str,
    pub(super) word: &'static str,
}

impl Verdict {
    /// The verdict for a reading, in the metric's own words.
    pub(super) fn of(reading: Reading, metric: &str) -> Self {
        let (class, sign) = match reading {
            Reading::Good => ("good", "▲"),
            Reading::Bad => ("bad", "▼"),
            _ => ("even", "●"),
        };
        let word = reading.word(metric);
        Self { class, sign, word }
    }
}

/// A verdict for a table.
pub(super) fn pill(verdict: Verdict) -> Markup {
    html! { span class={ "verdict " (verdict.class) } { span aria-hidden="true" { (verdict.sign) " " } (verdict.word) } }
}

/// Minimum difference from the neutral value that is tinted in the table of pairs.
const MIN_PAIR_EFFECT: f64 = 0.05;

/// Which side of the neutral value a pair of tasks lies on, if the metric over all pairs shows an effect.
pub(super) fn of_pair(value: f64, good: Direction, whole: Option<Reading>) -> Reading {
    let has_effect = matches!(whole, Some(Reading::Good | Reading::Bad | Reading::Mixed));
    let is_large_enough = good
        .neutral()
        .is_some_and(|neutral| (value - neutral).abs() >= MIN_PAIR_EFFECT);
    if has_effect && is_large_enough {
        good.side(value)
    } else {
        Reading::Unclear
    }
}

/// Explains which values are good, in a few words.
pub(super) fn good_from(name: &str, direction: Direction) -> String {
    let neutral_is = if name.starts_with("ste_rel_perf") || name.starts_with("sample_efficiency") {
        "equal to the expert"
    } else {
        "no effect"
    };
    match direction {
        Direction::Higher => "the higher the better".to_owned(),
        Direction::Lower => "the lower the better".to_owned(),
        Direction::HigherThan(neutral) => format!("{neutral_is} at {neutral}, good above"),
        Direction::LowerThan(neutral) => format!("{neutral_is} at {neutral}, good below"),
    }
}

/// The closest measure in the literature, and how it differs.
pub(super) fn in_papers(name: &str) -> Option<&'static str> {
    match name {
        "avg_eval_perf" => Some("average performance over the lifetime; ACC, in the first table, is the final average"),
        "perf_maintenance_mrlep" => Some("BWT (Lopez-Paz and Ranzato 2017), but over all later evaluations"),
        "forward_transfer_contrast" => Some("FWT (Lopez-Paz and Ranzato 2017), but as change over sum"),
        "backward_transfer_contrast" => Some("not BWT, which is maintenance: the effect on each task learned before"),
        _ => None,
    }
}

/// The name of a metric in words; user-defined names are split at underscores.
pub(super) fn title(name: &str) -> String {
    let known = match name {
        "perf_recovery" => "Performance recovery",
        "avg_train_perf" => "Performance while learning",
        "avg_eval_perf" => "Performance in evaluations",
        "perf_maintenance_mrlep" => "Maintenance since learning, by evaluations",
        "perf_maintenance_mrtlp" => "Maintenance since the end of learning",
        "forward_transfer_ratio" => "Forward transfer, ratio",
        "backward_transfer_ratio" => "Backward transfer, ratio",
        "forward_transfer_contrast" => "Forward transfer, contrast",
        "backward_transfer_contrast" => "Backward transfer, contrast",
        "ste_rel_perf" => "Performance relative to the expert",
        "sample_efficiency" => "Sample efficiency",
        _ => return capitalized(&crate::words::shown(name).replace('_', " ")),
    };
    known.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reading_has_its_word_and_sign() {
        let check = |reading: Reading, metric: &str, expected: &str| {
            let found = Verdict::of(reading, metric);
            assert_eq!(format!("{} {}", found.sign, found.word), expected);
        };
        check(Reading::Good, "forward_transfer_ratio", "▲ helps");
        check(Reading::Bad, "perf_maintenance_mrtlp", "▼ forgets");
        check(Reading::Mixed, "forward_transfer_ratio", "● mixed");
        check(Reading::Unclear, "ste_rel_perf", "● no clear difference");
        check(Reading::Untested, "perf_recovery", "● not tested");
        check(Reading::Bad, "of_my_own", "▼ bad");
    }

    #[test]
    fn pair_is_tinted_if_all_pairs_show_an_effect_and_it_is_clearly_on_one_side() {
        let check = |value: f64, whole: Option<Reading>, expected: Reading| {
            assert_eq!(of_pair(value, Direction::HigherThan(1.0), whole), expected, "{value}");
        };
        check(1.2, Some(Reading::Good), Reading::Good);
        check(0.8, Some(Reading::Good), Reading::Bad);
        check(0.8, Some(Reading::Mixed), Reading::Bad);
        check(1.04, Some(Reading::Good), Reading::Unclear);
        check(1.2, Some(Reading::Unclear), Reading::Unclear);
        check(1.2, None, Reading::Unclear);
        assert_eq!(
            of_pair(0.8, Direction::LowerThan(1.0), Some(Reading::Good)),
            Reading::Good
        );
    }

    #[test]
    fn good_direction_is_in_the_metrics_words() {
        let above = Direction::HigherThan(1.0);
        assert_eq!(
            good_from("sample_efficiency", above),
            "equal to the expert at 1, good above"
        );
        assert_eq!(good_from("forward_transfer_ratio", above), "no effect at 1, good above");
    }

    #[test]
    fn metrics_have_names_in_words() {
        assert_eq!(title("sample_efficiency"), "Sample efficiency");
        assert_eq!(title("of_my_own"), "Of my own");
        assert_eq!(title(""), "");
    }
}
