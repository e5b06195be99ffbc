//! What the value of a metric says, in a word and a sign: the colour only repeats them. Which way is good is the metrics' to say.

use driftworld_metrics::{Direction, Interval};

/// A judgement of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Verdict {
    /// `good`, `bad` or `even`.
    pub(super) class: &'static str,
    pub(super) sign: &'static str,
    pub(super) word: &'static str,
}

const fn good(word: &'static str) -> Verdict {
    Verdict {
        class: "good",
        sign: "▲",
        word,
    }
}

const fn bad(word: &'static str) -> Verdict {
    Verdict {
        class: "bad",
        sign: "▼",
        word,
    }
}

const EVEN: Verdict = Verdict {
    class: "even",
    sign: "●",
    word: "no effect",
};

/// The value at which a metric says that nothing happened.
pub(super) fn neutral(direction: Direction) -> Option<f64> {
    match direction {
        Direction::HigherThan(neutral) | Direction::LowerThan(neutral) => Some(neutral),
        Direction::Higher | Direction::Lower => None,
    }
}

/// Judges a value as it is shown; `None` where there is nothing to hold it against.
pub(super) fn of(name: &str, value: f64, direction: Direction) -> Option<Verdict> {
    let neutral = neutral(direction)?;
    // What looks the same when it is shown is called the same.
    if super::number(value) == super::number(neutral) {
        return Some(EVEN);
    }
    let [better, worse] = words(name);
    let higher_is_better = !matches!(direction, Direction::LowerThan(_));
    Some(if (value > neutral) == higher_is_better {
        good(better)
    } else {
        bad(worse)
    })
}

/// Judges the value of a lifetime beside those of its tasks: unless three in four of these say the same, it is mixed.
pub(super) fn of_lifetime(name: &str, value: f64, tasks: &[f64], direction: Direction) -> Option<Verdict> {
    let (found, neutral) = (of(name, value, direction)?, neutral(direction)?);
    let agreeing = tasks
        .iter()
        .filter(|task| (**task - neutral) * (value - neutral) > 0.0)
        .count();
    if found.class != EVEN.class && agreeing * 4 < tasks.len() * 3 {
        return Some(Verdict { word: "mixed", ..EVEN });
    }
    Some(found)
}

/// Judges an interval: nothing can be told where it holds the value that means no effect.
pub(super) fn of_interval(name: &str, interval: Interval, direction: Direction) -> Option<Verdict> {
    let neutral = neutral(direction)?;
    if interval.contains(neutral) {
        return Some(Verdict {
            word: "not told from no effect",
            ..EVEN
        });
    }
    of(name, interval.low, direction)
}

/// Which way is good, in a few words.
pub(super) fn good_from(direction: Direction) -> String {
    match direction {
        Direction::Higher => "the higher the better".to_owned(),
        Direction::Lower => "the lower the better".to_owned(),
        Direction::HigherThan(neutral) => format!("no effect at {neutral}, good above"),
        Direction::LowerThan(neutral) => format!("no effect at {neutral}, good below"),
    }
}

/// What a value on the good side of the neutral one says, and one on the other.
fn words(name: &str) -> [&'static str; 2] {
    match name {
        _ if name.starts_with("perf_recovery") => ["relearns faster", "relearns slower"],
        _ if name.starts_with("perf_maintenance") => ["keeps", "forgets"],
        _ if name.contains("transfer") => ["helps", "interferes"],
        _ if name.starts_with("ste_rel_perf") => ["beats the expert", "below the expert"],
        _ if name.starts_with("sample_efficiency") => ["beats the expert", "below the expert"],
        _ => ["good", "bad"],
    }
}

/// The name of a metric in words; those of users are taken apart at their underscores.
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
        _ => {
            let mut words = crate::words::shown(name).replace('_', " ");
            if let Some(first) = words.get_mut(..1) {
                first.make_ascii_uppercase();
            }
            return words;
        }
    };
    known.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_judged_by_what_is_shown_of_it() {
        let check = |name: &str, value: f64, expected: &str| {
            let found = of(name, value, Direction::HigherThan(1.0)).expect("there is a neutral value");
            assert_eq!(format!("{} {}", found.sign, found.word), expected);
        };
        check("forward_transfer_ratio", 1.2, "▲ helps");
        check("forward_transfer_ratio", 0.8, "▼ interferes");
        check("ste_rel_perf", 1.000_4, "● no effect");
        check("of_my_own", 3.0, "▲ good");
        assert_eq!(of("avg_eval_perf", 3.0, Direction::Higher), None);
        let lower = of("of_my_own", 3.0, Direction::LowerThan(1.0)).expect("there is a neutral value");
        assert_eq!(lower.word, "bad");
    }

    #[test]
    fn a_value_is_mixed_unless_three_in_four_tasks_agree() {
        let check = |tasks: &[f64], expected: &str| {
            let found = of_lifetime("ste_rel_perf", 1.2, tasks, Direction::HigherThan(1.0));
            assert_eq!(found.expect("there is a neutral value").word, expected, "{tasks:?}");
        };
        check(&[], "beats the expert");
        check(&[1.9, 1.3, 1.1, 0.6], "beats the expert");
        check(&[2.5, 1.3, 1.0, 0.6], "mixed");
        check(&[2.5, 0.9, 0.8], "mixed");
    }

    #[test]
    fn an_interval_around_no_effect_tells_nothing() {
        let check = |low: f64, high: f64, expected: &str| {
            let found = of_interval("ste_rel_perf", Interval { low, high }, Direction::HigherThan(1.0));
            assert_eq!(found.expect("there is a neutral value").word, expected);
        };
        check(0.9, 1.3, "not told from no effect");
        check(1.1, 1.3, "beats the expert");
        check(0.7, 0.9, "below the expert");
    }

    #[test]
    fn metrics_have_names_in_words() {
        assert_eq!(title("sample_efficiency"), "Sample efficiency");
        assert_eq!(title("of_my_own"), "Of my own");
        assert_eq!(title(""), "");
    }
}
