//! Saturation: the best performance that data reach, and how long they take to reach it.
//!
//! Not here: performance at the end, see `terminal_performance`.

use crate::SmoothingMethod;
use crate::preprocess::smoothed;

/// Best performance and where it is first reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Saturation {
    /// Largest smoothed performance.
    pub(super) value: f64,
    /// Experiences before it, from 0.
    pub(super) experiences: usize,
}

/// Saturation of one performance per experience; of no experience at all, 0 after 0.
///
/// QUIRK: the data are smoothed once more with a flat window of default length, on top of the smoothing they had as
/// a step of preprocessing, and whatever smoothing was chosen there.
///
/// Additions run in a fixed order, so the result is the same on every machine. Where several windows would tie in
/// exact arithmetic, rounding says which is the first maximum, and the reference's rounding may say another.
pub(super) fn of(per_experience: &[f64]) -> Saturation {
    let smooth = smoothed(per_experience, None, SmoothingMethod::Flat);
    let first = Saturation {
        value: smooth.first().copied().unwrap_or(0.0),
        experiences: 0,
    };
    smooth.iter().enumerate().fold(first, |best, (experiences, &value)| {
        if value > best.value {
            Saturation { value, experiences }
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_maximum_counts() {
        let check = |values: &[f64], value: f64, experiences: usize| {
            assert_eq!(of(values), Saturation { value, experiences });
        };
        check(&[4.0], 4.0, 0);
        check(&[1.0, 3.0, 2.0, 3.0], 3.0, 1);
        check(&[-2.0, -1.0], -1.0, 1);
        // Fifteen values are smoothed with a window of three.
        let mut late_peak = [0.0; 15];
        late_peak[7] = 3.0;
        check(&late_peak, 1.0, 7);
    }
}
