//! Types and ranges of the values that a distribution can draw.

use super::Distribution;
use super::moments::cut;
use crate::value::{ParameterType, Value};

/// Maximum number of values to list for a distribution or a parameter.
pub(crate) const MAX_ATOMS: usize = 1000;

impl<N> Distribution<N> {
    /// Whether all its draws can be used where a value of this type is expected.
    pub fn yields(&self, kind: ParameterType) -> bool {
        match self {
            // Only listed values can be checked where they are used.
            Self::Constant { .. } | Self::Choice { .. } if kind == ParameterType::Json => true,
            Self::Constant { value } => value.cast(kind).is_some(),
            Self::Choice { values, .. } => values.iter().all(|value| value.cast(kind).is_some()),
            Self::Mixture { parts, .. } => parts.iter().all(|part| part.yields(kind)),
            _ if kind == ParameterType::Json => false,
            Self::Bernoulli { .. } => kind == ParameterType::Boolean,
            Self::IntegerUniform { .. } | Self::Binomial { .. } | Self::Poisson { .. } | Self::Geometric { .. } => {
                ParameterType::Integer.fits(kind)
            }
            Self::VonMises { .. } => kind == ParameterType::Heading,
            Self::Dirichlet { .. } => kind == ParameterType::Vector,
            _ if self.draws_colors() => kind == ParameterType::Color,
            _ if self.is_planar() => kind == ParameterType::Point,
            _ => ParameterType::Number.fits(kind),
        }
    }

    /// The length of the vectors that it draws; `None` if it draws none, or vectors of different lengths.
    pub fn vector_length(&self) -> Option<usize> {
        let common = |mut lengths: Vec<Option<usize>>| {
            lengths.dedup();
            if let [length] = lengths[..] { length } else { None }
        };
        match self {
            Self::Dirichlet { alpha } => Some(alpha.len()),
            Self::Constant { value } => value.as_vector().map(<[f64]>::len),
            Self::Choice { values, .. } => {
                common(values.iter().map(|value| value.as_vector().map(<[f64]>::len)).collect())
            }
            Self::Mixture { parts, .. } => common(parts.iter().map(Self::vector_length).collect()),
            _ => None,
        }
    }
}

impl Distribution<f64> {
    /// Its smallest and largest number, corners of a box around its points or colours, or all values of a choice; `None` if
    /// unbounded.
    pub fn support(&self) -> Option<Vec<Value>> {
        let numbers = |low: f64, high: f64| Some(vec![Value::Number(low), Value::Number(high)]);
        let counts = |low: f64, high: f64| Some(vec![Value::Integer(low as i64), Value::Integer(high as i64)]);
        let corners = |low: [f64; 2], high: [f64; 2]| Some(vec![Value::Point(low), Value::Point(high)]);
        match self {
            Self::Constant { value } => Some(vec![value.clone()]),
            Self::Choice { values, .. } => Some(values.clone()),
            Self::Uniform { low, high }
            | Self::TruncatedNormal { low, high, .. }
            | Self::Triangular { low, high, .. } => numbers(*low, *high),
            Self::Beta { low, high, .. } => numbers(low.unwrap_or(0.0), high.unwrap_or(1.0)),
            Self::Perturb {
                value,
                noise,
                low,
                high,
            } => numbers(cut(value - noise, *low, *high), cut(value + noise, *low, *high)),
            Self::VonMises { .. } => numbers(0.0, 360.0),
            Self::IntegerUniform { low, high } => counts(*low, *high),
            Self::Binomial { n, .. } => counts(0.0, *n),
            Self::Bernoulli { .. } => Some(vec![Value::Boolean(false), Value::Boolean(true)]),
            // The corners: one share is 1.
            Self::Dirichlet { alpha } => {
                let corner =
                    |full: usize| Value::Vector((0..alpha.len()).map(|k| f64::from(u8::from(k == full))).collect());
                Some((0..alpha.len()).map(corner).collect())
            }
            Self::Box { low, high } | Self::Grid { low, high, .. } | Self::PoissonDisc { low, high, .. } => {
                corners(*low, *high)
            }
            Self::Disc { center: [x, y], radius }
            | Self::Annulus {
                center: [x, y],
                outer: radius,
                ..
            } => corners([x - radius, y - radius], [x + radius, y + radius]),
            Self::ColorUniform { .. }
            | Self::ColorNormal { .. }
            | Self::ColorPerturb { .. }
            | Self::ColorHsv { .. } => Some(self.color_box()?.map(Value::Color).to_vec()),
            Self::Points { values, .. } => Some(values.iter().copied().map(Value::Point).collect()),
            Self::Mixture { parts, .. } => {
                let each = parts.iter().map(Self::support).collect::<Option<Vec<_>>>()?;
                Some(each.into_iter().flatten().collect())
            }
            Self::Normal { .. }
            | Self::LogNormal { .. }
            | Self::Exponential { .. }
            | Self::Poisson { .. }
            | Self::Geometric { .. }
            | Self::Gaussian { .. }
            | Self::Cells { .. } => None,
        }
    }

    /// Its values with their probabilities, if it draws from a list of at most [`MAX_ATOMS`].
    pub(crate) fn atoms(&self) -> Option<Vec<(Value, f64)>> {
        let shares = |count: usize, weights: &Option<Vec<f64>>| {
            let weights = weights.clone().unwrap_or_else(|| vec![1.0; count]);
            let total: f64 = weights.iter().sum();
            weights.into_iter().map(move |weight| weight / total)
        };
        let atoms: Vec<(Value, f64)> = match self {
            Self::Constant { value } => vec![(value.clone(), 1.0)],
            Self::Choice { values, weights } => {
                let shares = shares(values.len(), weights);
                values.iter().cloned().zip(shares).collect()
            }
            Self::Bernoulli { p } => vec![(Value::Boolean(false), 1.0 - p), (Value::Boolean(true), *p)],
            Self::IntegerUniform { low, high } if high - low < MAX_ATOMS as f64 => {
                let count = high - low + 1.0;
                (*low as i64..=*high as i64)
                    .map(|whole| (Value::Integer(whole), 1.0 / count))
                    .collect()
            }
            Self::Mixture { parts, weights } => {
                let mut all = Vec::new();
                for (part, share) in parts.iter().zip(shares(parts.len(), weights)) {
                    all.extend(part.atoms()?.into_iter().map(|(value, own)| (value, own * share)));
                }
                all
            }
            _ => return None,
        };
        (atoms.len() <= MAX_ATOMS).then_some(atoms)
    }

    /// A value that it can draw, used to check templates.
    pub(crate) fn example(&self) -> Value {
        match self {
            Self::Poisson { .. } | Self::Geometric { .. } => Value::Integer(0),
            Self::Gaussian { mean, .. } => Value::Point(*mean),
            Self::Cells { .. } => Value::Point([0.0; 2]),
            Self::Mixture { parts, .. } => parts[0].example(),
            other => other
                .support()
                .and_then(|values| values.into_iter().next())
                .or_else(|| other.quantile(0.5).map(Value::Number))
                .unwrap_or(Value::Number(0.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choice_yields_the_type_of_all_its_values() {
        let colors: Distribution = serde_json::from_str(r#"{"choice": {"values": ["red", [0, 0, 1]]}}"#).unwrap();
        assert!(colors.yields(ParameterType::Color) && !colors.yields(ParameterType::String));
    }

    #[test]
    fn headings_come_from_numbers_and_directions() {
        let von_mises: Distribution = serde_json::from_str(r#"{"von_mises": {"mean": 0, "kappa": 1}}"#).unwrap();
        let uniform: Distribution = serde_json::from_str(r#"{"uniform": {"low": 0, "high": 360}}"#).unwrap();
        assert!(von_mises.yields(ParameterType::Heading) && !von_mises.yields(ParameterType::Number));
        assert!(uniform.yields(ParameterType::Heading) && uniform.yields(ParameterType::Number));
    }
}
