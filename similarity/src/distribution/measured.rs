//! [`Measured`]: a distance between distributions, with the method that found it.

use std::fmt::{Display, Formatter, Result};

use serde::{Deserialize, Serialize};

/// A distance between two distributions, with the method that found it.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::{Method, wasserstein_1};
/// use driftworld_spec::Distribution::Normal;
/// let distance = wasserstein_1(&Normal { mean: 0.0, std: 1.0 }, &Normal { mean: 3.0, std: 1.0 }).unwrap();
/// assert_eq!((distance.value, distance.method), (3.0, Method::Closed));
/// assert_eq!(distance.method.to_string(), "by closed form");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The number, in the measure's unit.
    pub value: f64,
    /// The method.
    #[serde(rename = "how")]
    pub method: Method,
}

/// The method by which a number was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// A formula, exact except for rounding.
    Closed,
    /// A sum over the possible values, exact except for rounding and for values with a probability below 1e-15.
    Atoms,
    /// Numerical integration.
    Quadrature {
        /// Estimated maximum error, in the number's unit.
        tolerance: f64,
    },
    /// Points or numbers sampled to represent each distribution.
    Samples {
        /// Sample size of each.
        count: usize,
    },
}

impl Measured {
    pub(crate) fn closed(value: f64) -> Self {
        let method = Method::Closed;
        Self { value, method }
    }

    pub(crate) fn atoms(value: f64) -> Self {
        let method = Method::Atoms;
        Self { value, method }
    }

    pub(crate) fn quadrature(value: f64, tolerance: f64) -> Self {
        let method = Method::Quadrature { tolerance };
        Self { value, method }
    }

    pub(crate) fn samples(value: f64, count: usize) -> Self {
        let method = Method::Samples { count };
        Self { value, method }
    }

    /// The result of a formula on numbers with this total error: counts as quadrature unless the error is 0.
    pub(crate) fn within(value: f64, tolerance: f64) -> Self {
        if tolerance > 0.0 {
            Self::quadrature(value, tolerance)
        } else {
            Self::closed(value)
        }
    }

    /// The error of a quadrature; 0 for other methods.
    pub(crate) fn tolerance(self) -> f64 {
        match self.method {
            Method::Quadrature { tolerance } => tolerance,
            _ => 0.0,
        }
    }

    /// Clamps the value to this range.
    pub(crate) fn clamped(self, low: f64, high: f64) -> Self {
        let value = self.value.clamp(low, high);
        Self { value, ..self }
    }

    /// The square root, with its error derived from the error of the square.
    pub(crate) fn root(self) -> Self {
        let value = self.value.max(0.0).sqrt();
        let method = match self.method {
            Method::Quadrature { tolerance } => Method::Quadrature {
                tolerance: if tolerance == 0.0 {
                    0.0
                } else {
                    tolerance.sqrt().min(tolerance / value)
                },
            },
            other => other,
        };
        Self { value, method }
    }

    /// Multiplies the number and its error by a factor.
    pub(crate) fn times(self, factor: f64) -> Self {
        let method = match self.method {
            Method::Quadrature { tolerance } => Method::Quadrature {
                tolerance: tolerance * factor,
            },
            other => other,
        };
        let value = self.value * factor;
        Self { value, method }
    }
}

impl Display for Method {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Closed => f.write_str("by closed form"),
            Self::Atoms => f.write_str("by sum over values"),
            Self::Quadrature { tolerance } => write!(f, "by quadrature within {tolerance:.0e}"),
            Self::Samples { count: 1 } => write!(f, "by 1 sample"),
            Self::Samples { count } => write!(f, "by {count} samples"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_of_a_small_square_has_a_larger_error() {
        let root = |value| Measured::quadrature(value, 1e-10).root().method;
        assert_eq!(root(0.25), Method::Quadrature { tolerance: 2e-10 });
        assert_eq!(root(0.0), Method::Quadrature { tolerance: 1e-5 });
        assert_eq!(root(0.25).to_string(), "by quadrature within 2e-10");
    }
}
