//! [`ticks_of`]: durations in time steps.

/// Number of time steps until `seconds` have passed: at least one.
pub(super) fn ticks_of(seconds: f64, time_step: f64) -> u64 {
    // Subtracts a little, because 0.1 is inexact in binary, but 60 s must be 600 time steps of 0.1 s.
    ((seconds / time_step - 1e-6).ceil() as u64).max(1)
}
