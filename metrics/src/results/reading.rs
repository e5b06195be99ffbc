//! The one-word reading of a value, shared by tables, pages, JSON and Python.

use serde::{Deserialize, Serialize};

use super::{Direction, NullBand};
use crate::repeats::Interval;

/// Maximum p-value at which an effect is reported.
pub const MAX_P_VALUE: f64 = 0.05;

/// Minimum share, by size, of the effects for tasks, or for pairs of tasks, that must have the same sign as the lifetime's
/// effect; below it, the effect is mixed.
pub const MIN_AGREEING_SHARE: f64 = 0.75;

/// The reading of a metric's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reading {
    /// More than noise, and better than no effect.
    Good,
    /// More than noise, and worse than no effect.
    Bad,
    /// More than noise, but tasks or pairs of them disagree.
    Mixed,
    /// Not more than noise, or no effect at all.
    Unclear,
    /// Without a null band, so there is nothing to compare a single lifetime with.
    Untested,
    /// Too few lifetimes for an interval.
    TooFew,
    /// Based on negative performances, for which neither ratio nor contrast is meaningful.
    Undefined,
}

impl Reading {
    /// The reading of one lifetime's value, from its null band and the values of tasks, or pairs of them, behind it. `None` for
    /// a metric without a neutral value, such as a mean performance.
    ///
    /// Good and bad as in [`NullBand::reading`]; mixed if less than [`MIN_AGREEING_SHARE`] of the effects in `parts`, by size, is
    /// on the value's side.
    ///
    /// ```
    /// use driftworld_metrics::{Direction, Reading};
    ///
    /// let good = Direction::HigherThan(1.0);
    /// assert_eq!(Reading::of_lifetime(good, None, &[1.2, 1.4]), Some(Reading::Untested));
    /// assert_eq!(Reading::of_lifetime(Direction::Higher, None, &[50.0]), None);
    /// ```
    pub fn of_lifetime(good: Direction, band: Option<&NullBand>, parts: &[f64]) -> Option<Self> {
        let Some(band) = band else {
            return good.neutral().map(|_| Self::Untested);
        };
        let found = band.reading(good);
        let (Self::Good | Self::Bad, Some(neutral)) = (found, good.neutral()) else {
            return Some(found);
        };
        let effects = || parts.iter().map(|part| part - neutral);
        let agreeing: f64 = effects()
            .filter(|effect| effect * (band.value - neutral) > 0.0)
            .map(f64::abs)
            .sum();
        let all: f64 = effects().map(f64::abs).sum();
        Some(if agreeing < MIN_AGREEING_SHARE * all {
            Self::Mixed
        } else {
            found
        })
    }

    /// The reading of several lifetimes' values: good or bad if the interval over lifetimes lies on that side of the neutral value
    /// and, for a metric that has one, the null band of their mean agrees. `None` as for one lifetime.
    pub fn of_lifetimes(good: Direction, band: Option<&NullBand>, interval: Option<Interval>) -> Option<Self> {
        let neutral = good.neutral()?;
        let Some(interval) = interval else {
            return Some(Self::TooFew);
        };
        if interval.contains(neutral) {
            return Some(Self::Unclear);
        }
        let found = good.side(interval.low);
        let band_disagrees = band.is_some_and(|band| band.reading(good) != found);
        Some(if band_disagrees { Self::Unclear } else { found })
    }

    /// The reading in the metric's own words: `helps`, `forgets`, `mixed`, `no clear effect`.
    ///
    /// ```
    /// use driftworld_metrics::Reading;
    ///
    /// assert_eq!(Reading::Bad.word("perf_maintenance_mrlep"), "forgets");
    /// assert_eq!(Reading::Bad.word("of_my_own"), "bad");
    /// ```
    pub fn word(self, metric: &str) -> &'static str {
        let is = |name: &str| metric.starts_with(name);
        let is_against_expert = is("ste_rel_perf") || is("sample_efficiency");
        let [better, worse] = match () {
            () if is("perf_recovery") => ["relearns faster", "relearns slower"],
            () if is("perf_maintenance") => ["keeps", "forgets"],
            () if is("forward_transfer") || is("backward_transfer") => ["helps", "interferes"],
            () if is_against_expert => ["beats the expert", "below the expert"],
            () => ["good", "bad"],
        };
        match self {
            Self::Good => better,
            Self::Bad => worse,
            Self::Mixed => "mixed",
            Self::Unclear if is_against_expert => "no clear difference",
            Self::Unclear => "no clear effect",
            Self::Untested => "not tested",
            Self::TooFew => "too few lifetimes",
            Self::Undefined => "not defined",
        }
    }
}

/// Notes for readers if contrast and ratio of the same transfer have different readings, given the reading of each metric: one
/// for forward transfer, one for backward transfer, each with the name of the ratio.
pub(crate) fn disagreements(reading: impl Fn(&str) -> Option<Reading>) -> Vec<(String, String)> {
    let of = |direction: &str| {
        let names = ["contrast", "ratio"].map(|measure| format!("{direction}_transfer_{measure}"));
        let [contrast, ratio] = [reading(&names[0])?, reading(&names[1])?];
        (contrast != ratio).then(|| {
            let sentence = format!(
                "{direction} transfer: the contrast says {:?}, the ratio {:?}; prefer the contrast, as a mean of \
                 ratios is above 1 even if nothing is transferred, and one pair of tasks that began near its minimum \
                 may decide it",
                contrast.word(&names[0]),
                ratio.word(&names[1])
            );
            let [_, name] = names;
            (name, sentence)
        })
    };
    ["forward", "backward"].into_iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::Exchanged;
    use super::*;

    fn band(value: f64, p: f64, standard_error: Option<f64>) -> NullBand {
        NullBand {
            value,
            low: -0.1,
            high: 0.1,
            p,
            exchanged: Exchanged::Worlds,
            standard_error,
        }
    }

    const GOOD: Direction = Direction::HigherThan(0.0);

    fn any_band() -> impl Strategy<Value = NullBand> {
        let errors = proptest::option::of(0.0..0.5);
        (-0.5..0.5, 0.0..0.2, errors).prop_map(|(value, p, error)| band(value, p, error))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn effect_is_reported_only_beyond_noise(band in any_band(), parts in proptest::collection::vec(-1.0..1.0, 0..6)) {
            let found = Reading::of_lifetime(GOOD, Some(&band), &parts).expect("there is a neutral value");
            if matches!(found, Reading::Good | Reading::Bad | Reading::Mixed) {
                prop_assert!(band.is_outside() && band.p <= MAX_P_VALUE);
                prop_assert!(band.standard_error.is_none_or(|error| band.value.abs() >= 2.0 * error));
                prop_assert_eq!(found == Reading::Good && band.value <= 0.0, false);
                prop_assert_eq!(found == Reading::Bad && band.value >= 0.0, false);
            }
        }

        #[test]
        fn reading_depends_on_the_good_direction(band in any_band(), parts in proptest::collection::vec(-1.0..1.0, 0..6)) {
            let opposite = match Reading::of_lifetime(GOOD, Some(&band), &parts) {
                Some(Reading::Good) => Some(Reading::Bad),
                Some(Reading::Bad) => Some(Reading::Good),
                other => other,
            };
            prop_assert_eq!(Reading::of_lifetime(Direction::LowerThan(0.0), Some(&band), &parts), opposite);
        }

        #[test]
        fn several_lifetimes_need_interval_and_band_to_agree(band in any_band(), ends in [-1.0..1.0, -1.0..1.0_f64]) {
            let interval = Interval { low: ends[0].min(ends[1]), high: ends[0].max(ends[1]) };
            let alone = Reading::of_lifetimes(GOOD, None, Some(interval)).expect("there is a neutral value");
            let found = Reading::of_lifetimes(GOOD, Some(&band), Some(interval)).expect("there is a neutral value");
            prop_assert!(found == Reading::Unclear || found == alone && found == band.reading(GOOD));
            prop_assert_eq!(alone == Reading::Unclear, interval.contains(0.0));
        }
    }

    #[test]
    fn effect_is_mixed_unless_three_quarters_of_the_effects_agree() {
        let check = |parts: &[f64], expected: Reading| {
            let found = Reading::of_lifetime(GOOD, Some(&band(-0.4, 0.002, Some(0.02))), parts);
            assert_eq!(found, Some(expected), "{parts:?}");
        };
        check(&[], Reading::Bad);
        check(&[-0.4], Reading::Bad);
        // A task that hardly changed hardly counts.
        check(&[-0.743, -0.688, 0.016], Reading::Bad);
        check(&[-0.9, 0.29], Reading::Bad);
        check(&[-0.9, 0.31], Reading::Mixed);
    }

    #[test]
    fn disagreement_of_contrast_and_ratio_gives_one_note() {
        let found = disagreements(|name| match name {
            "forward_transfer_contrast" => Some(Reading::Unclear),
            "forward_transfer_ratio" | "backward_transfer_ratio" => Some(Reading::Good),
            _ => None,
        });
        let [(ratio, sentence)] = found.as_slice() else {
            panic!("{found:?}")
        };
        assert_eq!(ratio, "forward_transfer_ratio");
        assert!(
            sentence.starts_with(
                "forward transfer: the contrast says \"no clear effect\", the ratio \"helps\"; prefer the contrast"
            ),
            "{sentence}"
        );
        assert!(disagreements(|_| Some(Reading::Bad)).is_empty());
    }
}
