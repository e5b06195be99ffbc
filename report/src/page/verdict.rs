//! What the value of a metric says, in a word and a sign: the colour only repeats them. Which way is good is the metrics' to say.

use driftworld_metrics::{Direction, Interval, NullBand, Reading};

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

const fn even(word: &'static str) -> Verdict {
    Verdict {
        class: "even",
        sign: "●",
        word,
    }
}

/// Values of tasks, or of pairs of them, below which one lifetime says nothing.
const FEWEST: usize = 3;
/// A metric that a user added has no least effect: what is shown differs or does not.
const LEAST_OF_RATIOS: f64 = 0.05;
const LEAST_OF_POINTS: f64 = 1.0;
const LEAST_OF_EXPERIENCES: f64 = 1.0;

/// The least distance from the neutral value that is called an effect in one lifetime. `scaled`: whether performances are 1 to 101.
fn least_effect(name: &str, scaled: bool) -> f64 {
    match name {
        _ if name.starts_with("perf_recovery") => LEAST_OF_EXPERIENCES,
        _ if name.starts_with("perf_maintenance") && scaled => LEAST_OF_POINTS,
        _ if is_of_pairs(name) || is_against_expert(name) => LEAST_OF_RATIOS,
        _ => 0.0,
    }
}

fn is_of_pairs(name: &str) -> bool {
    name.contains("transfer")
}

/// Whether the neutral value is the expert's own.
fn is_against_expert(name: &str) -> bool {
    name.starts_with("ste_rel_perf") || name.starts_with("sample_efficiency")
}

/// How words are chosen, for those who read the table.
pub(super) fn rule(scaled: bool) -> String {
    let points = if scaled {
        format!(", {LEAST_OF_POINTS} of 101 points for maintenance")
    } else {
        String::new()
    };
    format!(
        "Words like “helps” need at least {FEWEST} tasks, or pairs of tasks, with a value, and a lifetime's value that differs \
         from no effect by {LEAST_OF_RATIOS} for ratios and contrasts{points}, {LEAST_OF_EXPERIENCES} experience for recovery. \
         “mixed” means that fewer than three in four tasks or pairs agree."
    )
}

/// The value at which a metric says that nothing happened.
pub(super) fn neutral(direction: Direction) -> Option<f64> {
    match direction {
        Direction::HigherThan(neutral) | Direction::LowerThan(neutral) => Some(neutral),
        Direction::Higher | Direction::Lower => None,
    }
}

/// Judges a value; `None` where there is nothing to hold it against.
pub(super) fn of(name: &str, value: f64, direction: Direction, scaled: bool) -> Option<Verdict> {
    let neutral = neutral(direction)?;
    if (value - neutral).abs() < least_effect(name, scaled) {
        return Some(even(if is_against_expert(name) {
            "about equal"
        } else {
            "no clear effect"
        }));
    }
    side(name, value, direction)
}

/// On which side of the neutral value a value is, as it is shown.
fn side(name: &str, value: f64, direction: Direction) -> Option<Verdict> {
    let neutral = neutral(direction)?;
    // What looks the same when it is shown is called the same.
    if super::number(value) == super::number(neutral) {
        return Some(even(if is_against_expert(name) { "equal" } else { "no effect" }));
    }
    let [better, worse] = words(name);
    let higher_is_better = !matches!(direction, Direction::LowerThan(_));
    Some(if (value > neutral) == higher_is_better {
        good(better)
    } else {
        bad(worse)
    })
}

/// Judges the value of a lifetime beside those of its tasks: of a few of these nothing is said, and unless three in four say the
/// same, it is mixed.
pub(super) fn of_lifetime(
    name: &str,
    value: f64,
    tasks: &[f64],
    direction: Direction,
    scaled: bool,
) -> Option<Verdict> {
    let (found, neutral) = (of(name, value, direction, scaled)?, neutral(direction)?);
    if found.class == "even" {
        return Some(found);
    }
    if tasks.len() < FEWEST {
        return Some(even("too few values to tell"));
    }
    let agreeing = tasks
        .iter()
        .filter(|task| (**task - neutral) * (value - neutral) > 0.0)
        .count();
    if agreeing * 4 < tasks.len() * 3 {
        return Some(even("mixed"));
    }
    Some(found)
}

/// Names no effect that permuted evaluations show as well.
pub(super) fn beside_null(found: Verdict, band: Option<NullBand>, direction: Direction) -> Verdict {
    match band.map(|band| band.reading(direction)) {
        Some(Reading::Unclear) if found.class != "even" => even("within its null band"),
        _ => found,
    }
}

/// Judges an interval: nothing can be told where it holds the value that means no effect.
pub(super) fn of_interval(name: &str, interval: Interval, direction: Direction) -> Option<Verdict> {
    let neutral = neutral(direction)?;
    if interval.contains(neutral) {
        return Some(even(if is_against_expert(name) {
            "no clear difference"
        } else {
            "no clear effect"
        }));
    }
    side(name, interval.low, direction)
}

/// Which way is good, in a few words.
pub(super) fn good_from(name: &str, direction: Direction) -> String {
    let neutral_is = if is_against_expert(name) {
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
    use driftworld_metrics::Exchanged;

    use super::*;

    #[test]
    fn a_value_is_judged_where_it_is_clearly_away_from_the_neutral_one() {
        let check = |name: &str, value: f64, expected: &str| {
            let found = of(name, value, Direction::HigherThan(1.0), true).expect("there is a neutral value");
            assert_eq!(format!("{} {}", found.sign, found.word), expected);
        };
        check("forward_transfer_ratio", 1.2, "▲ helps");
        check("forward_transfer_ratio", 0.8, "▼ interferes");
        check("forward_transfer_ratio", 1.04, "● no clear effect");
        check("ste_rel_perf", 1.000_4, "● about equal");
        check("of_my_own", 3.0, "▲ good");
        check("of_my_own", 1.000_4, "● no effect");
        assert_eq!(of("avg_eval_perf", 3.0, Direction::Higher, true), None);
        let lower = of("of_my_own", 3.0, Direction::LowerThan(1.0), true).expect("there is a neutral value");
        assert_eq!(lower.word, "bad");
    }

    #[test]
    fn points_are_of_a_scale_and_experiences_are_whole() {
        let check = |name: &str, value: f64, scaled: bool, expected: &str| {
            let found = of(name, value, Direction::HigherThan(0.0), scaled).expect("there is a neutral value");
            assert_eq!(found.word, expected, "{name} {value}");
        };
        check("perf_maintenance_mrlep", 0.041, true, "no clear effect");
        check("perf_maintenance_mrlep", 0.041, false, "keeps");
        check("perf_maintenance_mrlep", -1.2, true, "forgets");
        check("perf_recovery", 0.9, true, "no clear effect");
        check("perf_recovery", -1.5, false, "relearns slower");
        check("forward_transfer_contrast", 0.03, true, "no clear effect");
    }

    #[test]
    fn what_is_good_is_said_in_the_words_of_the_metric() {
        let above = Direction::HigherThan(1.0);
        assert_eq!(
            good_from("sample_efficiency", above),
            "equal to the expert at 1, good above"
        );
        assert_eq!(good_from("forward_transfer_ratio", above), "no effect at 1, good above");
    }

    #[test]
    fn a_value_is_mixed_unless_three_in_four_tasks_agree() {
        let check = |tasks: &[f64], expected: &str| {
            let found = of_lifetime("ste_rel_perf", 1.2, tasks, Direction::HigherThan(1.0), true);
            assert_eq!(found.expect("there is a neutral value").word, expected, "{tasks:?}");
        };
        check(&[], "too few values to tell");
        check(&[1.9, 1.3], "too few values to tell");
        check(&[1.9, 1.3, 1.1], "beats the expert");
        check(&[1.9, 1.3, 1.1, 0.6], "beats the expert");
        check(&[2.5, 1.3, 1.0, 0.6], "mixed");
        check(&[2.5, 0.9, 0.8], "mixed");
    }

    #[test]
    fn inside_its_null_band_a_value_is_even() {
        let check = |low: f64, expected: &str| {
            let band = NullBand {
                value: 1.2,
                low,
                high: low + 0.3,
                p: 0.5,
                exchanged: Exchanged::Worlds,
                standard_error: None,
            };
            let above = Direction::HigherThan(1.0);
            let found = of("forward_transfer_ratio", band.value, above, true).expect("there is a neutral value");
            assert_eq!(beside_null(found, Some(band), above).word, expected);
            assert_eq!(beside_null(found, None, above), found);
        };
        check(0.95, "within its null band");
        check(0.8, "helps");
    }

    #[test]
    fn an_interval_around_no_effect_tells_nothing() {
        let check = |low: f64, high: f64, expected: &str| {
            let found = of_interval("ste_rel_perf", Interval { low, high }, Direction::HigherThan(1.0));
            assert_eq!(found.expect("there is a neutral value").word, expected);
        };
        check(0.9, 1.3, "no clear difference");
        check(1.01, 1.02, "beats the expert");
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
