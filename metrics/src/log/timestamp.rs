//! Time stamps in the log's format: `20200913T122640.000000`. The caller passes in the time.

use std::fmt;
use std::str::FromStr;

use jiff::SignedDuration;
use jiff::civil::{DateTime, datetime};

use crate::MetricsError;

const EPOCH: DateTime = datetime(1970, 1, 1, 0, 0, 0, 0);

/// A valid time stamp in the years 1 to 9999, to the microsecond, without a time zone. Earlier time stamps compare as smaller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Timestamp {
    /// Microseconds since 1 January 1970, in the time zone of the writer's clock.
    micros: i64,
}

impl Timestamp {
    /// The time stamp at a number of microseconds since 1970-01-01T00:00:00.
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
        match moment(micros) {
            Some(_) => Ok(Self { micros }),
            None => Err(MetricsError::Timestamp(format!("{micros} microseconds after 1970"))),
        }
    }

    /// Microseconds since 1970-01-01T00:00:00 of the writer's clock.
    pub fn unix_micros(self) -> i64 {
        self.micros
    }

    /// Seconds from `earlier` to `self`; negative if `self` is earlier.
    pub fn seconds_since(self, earlier: Self) -> f64 {
        (self.micros - earlier.micros) as f64 / 1e6
    }
}

impl FromStr for Timestamp {
    type Err = MetricsError;

    /// Reads `YYYYMMDDTHHMMSS.f` with one to six digits after the point.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        parse(text).ok_or_else(|| MetricsError::Timestamp(format!("{text:?}")))
    }
}

impl fmt::Display for Timestamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let moment = moment(self.micros).expect("timestamps lie in the years 1 to 9999");
        write!(f, "{}", moment.strftime("%Y%m%dT%H%M%S.%6f"))
    }
}

fn parse(text: &str) -> Option<Timestamp> {
    let (date_and_time, fraction) = text.as_bytes().split_at_checked("YYYYMMDDTHHMMSS.".len())?;
    if date_and_time[8] != b'T' || date_and_time[15] != b'.' || !(1..=6).contains(&fraction.len()) {
        return None;
    }
    let two_digits = |at: usize| Some(number(&date_and_time[at..at + 2])? as i8);
    let year = number(&date_and_time[..4]).filter(|year| *year >= 1)? as i16;
    // Missing digits are zeros.
    let nanos = (fraction.len()..9).fold(number(fraction)?, |nanos, _| nanos * 10) as i32;
    let moment = DateTime::new(
        year,
        two_digits(4)?,
        two_digits(6)?,
        two_digits(9)?,
        two_digits(11)?,
        two_digits(13)?,
        nanos,
    )
    .ok()?;
    let micros = moment.duration_since(EPOCH).as_micros() as i64;
    Some(Timestamp { micros })
}

/// The date and time at this number of microseconds since the epoch; `None` outside the years 1 to 9999.
fn moment(micros: i64) -> Option<DateTime> {
    let moment = EPOCH.checked_add(SignedDuration::from_micros(micros)).ok();
    moment.filter(|moment| moment.year() >= 1)
}

/// Parses digits; `None` for anything else.
fn number(digits: &[u8]) -> Option<i64> {
    digits.iter().try_fold(0, |number, digit| {
        digit.is_ascii_digit().then(|| number * 10 + i64::from(digit - b'0'))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn only_valid_dates_and_times_are_accepted() {
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
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn every_microsecond_round_trips(micros in -60_000_000_000_000_000_i64..250_000_000_000_000_000) {
            let stamp = Timestamp::from_unix_micros(micros).unwrap();
            prop_assert_eq!(stamp.to_string().parse::<Timestamp>().unwrap(), stamp);
        }

        #[test]
        fn only_valid_dates_round_trip(year in 1_i64..10_000, month in 0_i64..14, day in 0_i64..33) {
            let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
            let last = match month {
                2 => 28 + i64::from(is_leap),
                4 | 6 | 9 | 11 => 30,
                1..=12 => 31,
                _ => 0,
            };
            let text = format!("{year:04}{month:02}{day:02}T000000.000000");
            let found = text.parse::<Timestamp>().ok().map(|stamp| stamp.to_string());
            prop_assert_eq!(found, (1..=last).contains(&day).then_some(text));
        }

        #[test]
        fn no_text_makes_the_parser_panic(text in "\\PC{0,24}") {
            let _ = text.parse::<Timestamp>();
        }
    }
}
