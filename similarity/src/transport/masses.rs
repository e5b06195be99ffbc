//! [`Units`]: checked masses as whole numbers, so that moving them never rounds.

use crate::SimilarityError;

/// Maximum difference between the sums of both sides, as a share of the larger.
const MAX_SUM_DIFFERENCE: f64 = 1e-9;

/// The larger sum is about 2 to this power in units: a mass of at least a 128th of the whole loses no bit.
const BITS: i32 = 60;

/// Masses of both sides in whole units of equal size.
#[derive(Clone, Debug)]
pub(crate) struct Units {
    /// One per origin, including zeros.
    pub(crate) from: Vec<i64>,
    /// One per destination; the sums are equal.
    pub(crate) to: Vec<i64>,
    /// The mass of one unit.
    pub(crate) unit: f64,
}

impl Units {
    /// Checks the masses and rounds them to units. A difference in the sums due to rounding is taken off the largest mass.
    pub(crate) fn of(from: &[f64], to: &[f64]) -> Result<Self, SimilarityError> {
        let (a, b) = (sum("from", from)?, sum("to", to)?);
        if (a - b).abs() > MAX_SUM_DIFFERENCE * a.max(b) {
            return Err(SimilarityError::UnequalMasses { from: a, to: b });
        }
        let scale = power_of_two(a.max(b));
        let whole = |masses: &[f64]| masses.iter().map(|mass| (mass * scale).round() as i64).collect();
        let (mut from, mut to): (Vec<i64>, Vec<i64>) = (whole(from), whole(to));
        let excess = from.iter().sum::<i64>() - to.iter().sum::<i64>();
        let heavier = if excess > 0 { &mut from } else { &mut to };
        if let Some(largest) = heavier.iter_mut().max() {
            *largest -= excess.abs();
        }
        Ok(Self {
            from,
            to,
            unit: 1.0 / scale,
        })
    }
}

/// The sum of masses after checking them.
pub(crate) fn sum(side: &'static str, masses: &[f64]) -> Result<f64, SimilarityError> {
    for (index, &found) in masses.iter().enumerate() {
        if !(0.0..=1e200).contains(&found) {
            return Err(SimilarityError::BadMass { side, index, found });
        }
    }
    Ok(masses.iter().sum())
}

/// The power of two that scales a sum to 2^59..2^60; 1 for a sum of 0.
fn power_of_two(sum: f64) -> f64 {
    if sum < 1e-250 {
        return 1.0;
    }
    let exponent = libm::frexp(sum).1;
    libm::ldexp(1.0, BITS - exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_have_the_same_number_of_units() {
        let thirds = [1.0 / 3.0; 3];
        let tenths = [0.1; 10];
        let units = Units::of(&thirds, &tenths).unwrap();
        assert_eq!(units.from.iter().sum::<i64>(), units.to.iter().sum::<i64>());
        let back: f64 = units
            .from
            .iter()
            .map(|&units_here| units_here as f64 * units.unit)
            .sum();
        assert!((back - 1.0).abs() < 1e-15);
    }

    #[test]
    fn whole_masses_stay_in_proportion() {
        let units = Units::of(&[3.0, 0.0, 1.0], &[2.0, 2.0]).unwrap();
        assert_eq!(units.from, [3 * units.from[2], 0, units.from[2]]);
        assert_eq!(units.to, [2 * units.from[2]; 2]);
    }

    #[test]
    fn invalid_masses_are_refused() {
        for invalid in [-1.0, f64::NAN, f64::INFINITY] {
            let found = Units::of(&[1.0, invalid], &[1.0]).unwrap_err();
            assert_eq!(found.code(), "similarity/bad-mass", "{invalid}");
        }
        let found = Units::of(&[1.0], &[1.5]).unwrap_err();
        assert_eq!(found.code(), "similarity/unequal-masses");
        assert!(Units::of(&[], &[0.0]).is_ok());
    }
}
