//! The clock for timestamps in logs: the system clock, or a stopped one, so that repeated runs are byte-identical.

use driftworld_metrics::Timestamp;

/// The environment variable that stops the clock.
pub const VARIABLE: &str = "DRIFTWORLD_CLOCK";

/// Microseconds since 1970 of the first and last valid stamps: the years 1 to 9999.
const STAMPS: std::ops::RangeInclusive<i64> = -62_135_596_800_000_000..=253_402_300_799_999_999;

/// The source of the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The system clock.
    System,
    /// A stopped clock.
    Stopped(Timestamp),
}

/// The variable does not hold a valid time.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{VARIABLE}: found {found:?}, expected a UTC time such as 2026-01-31T12:00:00Z, in the years 1 to 9999; unset it \
     to use the system clock"
)]
pub struct ClockError {
    /// The variable's value.
    pub found: String,
}

impl Clock {
    /// The system clock, or the time in `DRIFTWORLD_CLOCK`, which then stamps every row.
    ///
    /// # Errors
    /// [`ClockError`] if that is not a valid time.
    pub fn from_environment() -> Result<Self, ClockError> {
        match std::env::var_os(VARIABLE) {
            None => Ok(Self::System),
            Some(found) => Self::stopped(&found.to_string_lossy()),
        }
    }

    fn stopped(found: &str) -> Result<Self, ClockError> {
        let time = found.parse::<jiff::Timestamp>().ok();
        let stamp = time.and_then(|time| Timestamp::from_unix_micros(time.as_microsecond()).ok());
        stamp.map(Self::Stopped).ok_or_else(|| ClockError {
            found: found.to_owned(),
        })
    }

    /// The current time. A system clock outside the valid years gives the nearest valid stamp.
    #[expect(clippy::missing_panics_doc, reason = "the time is clamped to the type's range")]
    pub fn now(self) -> Timestamp {
        match self {
            Self::Stopped(stamp) => stamp,
            Self::System => Timestamp::from_unix_micros(micros(std::time::SystemTime::now()))
                .expect("the time was clamped to the years 1 to 9999"),
        }
    }
}

/// Microseconds since 1970, within the range of stamps.
fn micros(now: std::time::SystemTime) -> i64 {
    let as_micros = |since: std::time::Duration| i64::try_from(since.as_micros()).unwrap_or(i64::MAX);
    let micros = match now.duration_since(std::time::UNIX_EPOCH) {
        Ok(since) => as_micros(since),
        Err(before) => -as_micros(before.duration()),
    };
    micros.clamp(*STAMPS.start(), *STAMPS.end())
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, UNIX_EPOCH};

    use super::*;

    #[test]
    fn stopped_clock_shows_the_given_time() {
        let check = |text: &str, expected: &str| {
            let clock = Clock::stopped(text).expect("it is a time");
            assert_eq!(clock.now().to_string(), expected);
        };
        check("2020-09-13T12:26:40Z", "20200913T122640.000000");
        check("2020-09-13T14:26:40.5+02:00", "20200913T122640.500000");
        for wrong in ["", "now", "2020-09-13", "1600000000", "2020-13-01T00:00:00Z"] {
            let error = Clock::stopped(wrong).expect_err(wrong).to_string();
            assert!(error.contains(&format!("DRIFTWORLD_CLOCK: found {wrong:?}")), "{error}");
        }
    }

    #[test]
    fn clock_out_of_range_gives_the_nearest_stamp() {
        let stamp = |now| Timestamp::from_unix_micros(micros(now)).map(|stamp| stamp.to_string());
        let year = Duration::from_hours(8766);
        assert!(stamp(UNIX_EPOCH - year).is_ok_and(|stamp| stamp == "19681231T180000.000000"));
        assert!(stamp(UNIX_EPOCH + 20_000 * year).is_ok_and(|stamp| stamp.starts_with("99991231")));
        assert!(stamp(UNIX_EPOCH - 20_000 * year).is_ok_and(|stamp| stamp.starts_with("00010101")));
    }
}
