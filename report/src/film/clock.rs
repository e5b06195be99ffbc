//! [`Delays`]: times in whole units whose sums stay near those in seconds.

/// How long pictures are shown, in whole units.
#[derive(Debug)]
pub(super) struct Delays {
    units_per_second: f64,
    /// Seconds, and units that were given out.
    seconds: f64,
    units: u64,
}

impl Delays {
    pub(super) fn new(units_per_second: f64) -> Self {
        Self {
            units_per_second,
            seconds: 0.0,
            units: 0,
        }
    }

    /// The units of the next picture.
    pub(super) fn next(&mut self, seconds: f64) -> u16 {
        self.seconds += seconds.max(0.0);
        let units = (self.seconds * self.units_per_second).round() as u64;
        let next = u16::try_from(units - self.units).unwrap_or(u16::MAX);
        self.units = units;
        next
    }
}
