//! Time stamps as they stand in logs: `20200913T122640.000000`.
//!
//! Not here: the clock. A caller that has one passes microseconds in.

use std::fmt;
use std::str::FromStr;

use crate::MetricsError;

const MICROS_PER_SECOND: i64 = 1_000_000;
const SECONDS_PER_DAY: i64 = 86_400;

/// A checked time stamp, year 1 to 9999, to the microsecond, without a time zone. Earlier ones compare as less.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Timestamp {
    /// Microseconds since the first of January 1970, of whatever zone the writer's clock showed.
    micros: i64,
}

impl Timestamp {
    /// The time stamp of a number of microseconds since 1970-01-01T00:00:00.
    ///
    /// # Errors
    /// [`MetricsError::Timestamp`] outside the years 1 to 9999.
    ///
    /// ```
    /// # use driftworld_metrics::Timestamp;
    /// let stamp = Timestamp::from_unix_micros(1_600_000_000_000_001)?;
    /// assert_eq!(stamp.to_string(), "20200913T122640.000001");
    /// # Ok::<(), driftworld_metrics::MetricsError>(())
    /// ```
    pub fn from_unix_micros(micros: i64) -> Result<Self, MetricsError> {
        let first = days_from_civil(1, 1, 1) * SECONDS_PER_DAY * MICROS_PER_SECOND;
        let end = days_from_civil(10_000, 1, 1) * SECONDS_PER_DAY * MICROS_PER_SECOND;
        if (first..end).contains(&micros) {
            Ok(Self { micros })
        } else {
            Err(MetricsError::Timestamp {
                found: format!("{micros} microseconds after 1970"),
            })
        }
    }

    /// Microseconds since 1970-01-01T00:00:00 of the writer's clock.
    pub fn unix_micros(self) -> i64 {
        self.micros
    }

    /// Seconds from `earlier` to `self`; negative if `self` is the earlier one.
    pub fn seconds_since(self, earlier: Self) -> f64 {
        (self.micros - earlier.micros) as f64 / MICROS_PER_SECOND as f64
    }
}

impl FromStr for Timestamp {
    type Err = MetricsError;

    /// Reads `YYYYMMDDTHHMMSS.f` with one to six digits after the point.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        parse(text).ok_or_else(|| MetricsError::Timestamp {
            found: format!("{text:?}"),
        })
    }
}

impl fmt::Display for Timestamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = self.micros.div_euclid(MICROS_PER_SECOND);
        let (year, month, day) = civil_from_days(seconds.div_euclid(SECONDS_PER_DAY));
        let of_day = seconds.rem_euclid(SECONDS_PER_DAY);
        let (hour, minute, second) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
        let micros = self.micros.rem_euclid(MICROS_PER_SECOND);
        write!(
            f,
            "{year:04}{month:02}{day:02}T{hour:02}{minute:02}{second:02}.{micros:06}"
        )
    }
}

fn parse(text: &str) -> Option<Timestamp> {
    let (whole, fraction) = text.as_bytes().split_at_checked("YYYYMMDDTHHMMSS.".len())?;
    if whole[8] != b'T' || whole[15] != b'.' || !(1..=6).contains(&fraction.len()) {
        return None;
    }
    let (year, month, day) = (number(&whole[..4])?, number(&whole[4..6])?, number(&whole[6..8])?);
    let (hour, minute, second) = (number(&whole[9..11])?, number(&whole[11..13])?, number(&whole[13..15])?);
    if year < 1 || !(1..=12).contains(&month) || !(1..=days_in_month(year, month)).contains(&day) {
        return None;
    }
    if hour > 23 || minute > 59 || second > 59 {
        return None;
    }
    // Missing digits are zeros.
    let micros = (fraction.len()..6).fold(number(fraction)?, |micros, _| micros * 10);
    let seconds = days_from_civil(year, month, day) * SECONDS_PER_DAY + hour * 3600 + minute * 60 + second;
    Some(Timestamp {
        micros: seconds * MICROS_PER_SECOND + micros,
    })
}

/// The number that a few digits stand for; `None` where there is anything else.
fn number(digits: &[u8]) -> Option<i64> {
    digits.iter().try_fold(0, |number, digit| {
        digit.is_ascii_digit().then(|| number * 10 + i64::from(digit - b'0'))
    })
}

fn days_in_month(year: i64, month: i64) -> i64 {
    match month {
        2 if year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Days from 1970-01-01 to a date of the Gregorian calendar. Years are counted from March, so that the leap day is
/// the last of its year and months before it have a fixed length pattern (153 days in five months).
fn days_from_civil(year: i64, month: i64, day: i64) -> i64 {
    let (year, month_from_march) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    let (era, year_of_era) = (year.div_euclid(400), year.rem_euclid(400));
    let day_of_year = (153 * month_from_march + 2) / 5 + day - 1;
    era * 146_097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719_468
}

/// The inverse of [`days_from_civil`] for dates that exist.
fn civil_from_days(days: i64) -> (i64, i64, i64) {
    let days = days + 719_468;
    let (era, day_of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 {
        month_from_march + 3
    } else {
        month_from_march - 9
    };
    (era * 400 + year_of_era + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn only_days_and_times_that_exist_are_stamps() {
        let check = |text: &str, expected: Option<&str>| {
            assert_eq!(
                text.parse::<Timestamp>().ok().map(|stamp| stamp.to_string()).as_deref(),
                expected,
                "{text}"
            );
        };
        check("20201020T235720.363688", Some("20201020T235720.363688"));
        check("20200229T000000.5", Some("20200229T000000.500000"));
        check("20210229T000000.0", None);
        check("19000229T000000.0", None);
        check("20001301T000000.0", None);
        check("20000100T000000.0", None);
        check("20000101T240000.0", None);
        check("20000101T006000.0", None);
        check("20000101T000060.0", None);
        check("20000101T000000", None);
        check("20000101T000000.", None);
        check("20000101T000000.1234567", None);
        check("2000-101T000000.0", None);
        check("+2000101T000000.0", None);
        check("2000010éT000000.0", None);
        check("", None);
    }

    #[test]
    fn seconds_between_stamps_cross_midnight_and_leap_days() {
        let stamp = |text: &str| text.parse::<Timestamp>().unwrap();
        assert_eq!(
            stamp("20200229T000000.5").seconds_since(stamp("20200228T235959.0")),
            1.5
        );
        assert_eq!(stamp("19700101T000000.0").unix_micros(), 0);
        assert!(Timestamp::from_unix_micros(i64::MAX).is_err());
    }

    proptest! {
        #[test]
        fn every_microsecond_survives_writing_and_reading(micros in -60_000_000_000_000_000_i64..250_000_000_000_000_000) {
            let stamp = Timestamp::from_unix_micros(micros).unwrap();
            prop_assert_eq!(stamp.to_string().parse::<Timestamp>().unwrap(), stamp);
        }

        #[test]
        fn days_that_exist_are_those_that_come_back(year in 1_i64..10_000, month in 0_i64..14, day in 0_i64..33) {
            let exists = (1..=12).contains(&month) && (1..=days_in_month(year, month)).contains(&day);
            prop_assert_eq!(civil_from_days(days_from_civil(year, month, day)) == (year, month, day), exists);
        }

        #[test]
        fn no_text_makes_the_parser_panic(text in "\\PC{0,24}") {
            let _ = text.parse::<Timestamp>();
        }
    }
}
