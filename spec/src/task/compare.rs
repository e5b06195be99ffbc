//! [`Compare`]: how a task compares its variants, by measures and weights of parameters.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter::{Domain, Parameter, Role};
use super::template::Source;
use crate::distribution::{Distribution, Number};
use crate::error::Problem;
use crate::value::{ParameterType, Value};

/// How two values of a parameter are compared, and how much that counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "weight": 2, "measure": "log_ratio" },
    { "costs": [[0, 0.2, 1], [0.2, 0, 1], [1, 1, 0]] },
]))]
pub struct Compare {
    /// Weight of the parameter among those that affect the same element; 1 if absent, 0 leaves it out.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub weight: f64,
    /// The measure; the default of the parameter's type if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measure: Option<MeasureName>,
    /// For choices: the distance between each pair, with one row per choice, in the order of the choices; divided by the
    /// largest distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 1000))]
    pub costs: Option<Vec<Vec<f64>>>,
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            weight: 1.0,
            measure: None,
            costs: None,
        }
    }
}

/// A measure of the distance between two values or two distributions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum MeasureName {
    /// Numbers: the difference, divided by the declared range. The default for numbers.
    Difference,
    /// Numbers above 0: the logarithm of their ratio, divided by that of the range's ends. For scales, where doubling counts
    /// as much as halving.
    LogRatio,
    /// Numbers: the difference divided by the larger of the two, then by the maximum in the range. So every number
    /// has the maximum distance from 0.
    RelativeDifference,
    /// Any type: 0 if the values are equal, 1 otherwise.
    SameOrNot,
    /// Colours, also as the transport cost between random colours: Euclidean distance in sRGB, as in the L2Explorer paper.
    Srgb,
    /// Colours: Euclidean distance in CIELAB.
    Cie76,
    /// Colours: CIEDE2000. Not a metric.
    Ciede2000,
    /// Colours: Euclidean distance in Oklab. The default for colours.
    Oklab,
    /// Colours: the difference in lightness plus the distance in a and b of CIELAB, after Abasi et al. For large differences.
    Hyab,
    /// Distributions of numbers, points or colours: minimum transport cost. Their default.
    #[serde(rename = "wasserstein_1")]
    #[strum(serialize = "wasserstein_1")]
    Wasserstein1,
    /// Distributions of numbers, points or colours: the root of the minimum squared transport cost.
    #[serde(rename = "wasserstein_2")]
    #[strum(serialize = "wasserstein_2")]
    Wasserstein2,
    /// Distributions: the largest difference between the probabilities that they assign to any set.
    TotalVariation,
    /// Distributions: the Hellinger distance.
    Hellinger,
    /// Distributions: the root of the Jensen–Shannon divergence.
    JensenShannon,
    /// Distributions of numbers: the root of the energy distance.
    Energy,
    /// Distributions of points: the root of the minimum squared transport cost between normal distributions with the same means
    /// and spreads.
    BuresWasserstein,
    /// Layouts: the walls present in only one of them, as a share of the walls in either. Doors and letters do not count.
    WallJaccard,
    /// Layouts: how much walking distances differ, as a share of the longer one. Doors and letters do not count.
    WalkingDistance,
    /// Layouts: how far the mass of the walls must be moved, in units of the arena's side. Doors and letters do not count.
    WallTransport,
}

impl MeasureName {
    /// Its name in documents.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The measures that fit a distribution, unless this one does. `kind` is the parameter's type.
    pub(super) fn misfit_of_draws(self, drawn: &Distribution<Number>, kind: ParameterType) -> Option<&'static str> {
        let is_color = self.is_of_colors();
        let overlaps = matches!(self, Self::TotalVariation | Self::Hellinger | Self::JensenShannon);
        let moves = matches!(self, Self::Wasserstein1 | Self::Wasserstein2);
        let (fits, allowed) = match Draws::of(drawn, kind) {
            _ if self == Self::SameOrNot => return None,
            Draws::Colors => (
                is_color || moves,
                "wasserstein_1, wasserstein_2, oklab, srgb, cie76, ciede2000, hyab or same_or_not, since colours from a \
                 continuum are compared by their distance",
            ),
            Draws::ListedColors => (
                is_color || moves || overlaps,
                "wasserstein_1, wasserstein_2, total_variation, hellinger, jensen_shannon, a measure of colours or same_or_not",
            ),
            Draws::Points => (
                moves || self == Self::BuresWasserstein,
                "wasserstein_1, wasserstein_2, bures_wasserstein or same_or_not, since points are compared by their distance",
            ),
            Draws::Shares => (
                self == Self::Wasserstein1,
                "wasserstein_1 or same_or_not, since shares are compared by how much of them moves",
            ),
            Draws::Headings => (
                self == Self::Wasserstein1 || overlaps,
                "wasserstein_1, total_variation, hellinger, jensen_shannon or same_or_not, since headings are \
                 compared around the circle",
            ),
            Draws::Texts => (
                overlaps,
                "total_variation, hellinger, jensen_shannon or same_or_not, since there is no distance between words",
            ),
            Draws::Numbers => (
                moves || overlaps || self == Self::Energy,
                "wasserstein_1, wasserstein_2, total_variation, hellinger, jensen_shannon, energy or \
                 same_or_not",
            ),
        };
        (!fits).then_some(allowed)
    }

    fn is_of_colors(self) -> bool {
        matches!(
            self,
            Self::Srgb | Self::Cie76 | Self::Ciede2000 | Self::Oklab | Self::Hyab
        )
    }

    /// The kind of parameter that this measure needs, unless the given parameter fits.
    fn misfit(self, parameter: &Parameter) -> Option<&'static str> {
        let by_distribution = parameter.role == Role::Randomized || parameter.kind == ParameterType::Distribution;
        let of_numbers = !by_distribution && matches!(parameter.kind, ParameterType::Number | ParameterType::Integer);
        if by_distribution {
            let mut misfits = distributions(parameter).map(|own| self.misfit_of_draws(own, parameter.kind));
            if let Some(misfit) = misfits.find_map(|misfit| misfit) {
                return Some(misfit);
            }
        }
        let (fits, wanted) = match self {
            Self::SameOrNot => return None,
            Self::Difference | Self::RelativeDifference => (
                of_numbers,
                "a variant parameter of type number or integer for this measure",
            ),
            Self::LogRatio => (
                of_numbers && always_positive(parameter),
                "a variant parameter of type number or integer with values above 0, for this measure",
            ),
            Self::Srgb | Self::Cie76 | Self::Ciede2000 | Self::Oklab | Self::Hyab => (
                parameter.kind == ParameterType::Color || by_distribution,
                "a parameter of type color, or one whose distributions draw colours, for this measure",
            ),
            Self::WallJaccard | Self::WalkingDistance | Self::WallTransport => (
                parameter.kind == ParameterType::Layout,
                "a variant parameter of type layout for this measure",
            ),
            Self::Wasserstein1
            | Self::Wasserstein2
            | Self::TotalVariation
            | Self::Hellinger
            | Self::JensenShannon
            | Self::Energy
            | Self::BuresWasserstein => (
                by_distribution,
                "a randomized parameter, or one of type distribution, for this measure",
            ),
        };
        (!fits).then_some(wanted)
    }
}

/// The distributions that a parameter declares: its own, or its possible values. If it is drawn from another parameter,
/// `Check::measure_fits` checks the measure against that parameter's distributions.
fn distributions(parameter: &Parameter) -> impl Iterator<Item = &Distribution<Number>> {
    let own = match &parameter.distribution {
        Some(Source::Distribution(distribution)) => Some(&**distribution),
        Some(Source::Param(_) | Source::Case(_) | Source::Value(_)) | None => None,
    };
    own.into_iter().chain(parameter.distributions())
}

/// The kind of value that a distribution draws, as far as measures distinguish it.
#[derive(PartialEq)]
enum Draws {
    Numbers,
    Headings,
    Points,
    Shares,
    Texts,
    ListedColors,
    Colors,
}

impl Draws {
    fn of(distribution: &Distribution<Number>, kind: ParameterType) -> Self {
        let is_word = |value: &Value| value.as_number().is_none();
        match distribution {
            _ if distribution.draws_colors() => Self::Colors,
            _ if distribution.is_planar() => Self::Points,
            Distribution::Dirichlet { .. } => Self::Shares,
            Distribution::VonMises { .. } => Self::Headings,
            _ if kind == ParameterType::Heading => Self::Headings,
            Distribution::Mixture { parts, .. } if parts.iter().any(|part| Self::of(part, kind) == Self::Headings) => {
                Self::Headings
            }
            Distribution::Mixture { parts, .. } => parts.first().map_or(Self::Numbers, |part| Self::of(part, kind)),
            Distribution::Choice { .. } | Distribution::Constant { .. } if kind == ParameterType::Color => {
                Self::ListedColors
            }
            Distribution::Choice { values, .. } if values.iter().any(is_word) => Self::Texts,
            Distribution::Constant { value } if is_word(value) => Self::Texts,
            _ => Self::Numbers,
        }
    }
}

fn always_positive(parameter: &Parameter) -> bool {
    match parameter.domain() {
        Some(Domain::Range([low, _])) => low > 0.0,
        Some(Domain::Choices(choices)) => choices.iter().all(|choice| choice.as_number().is_some_and(|x| x > 0.0)),
        None => false,
    }
}

impl Compare {
    /// Checks beyond the schema: the measure fits the parameter, and the costs are a distance.
    pub(crate) fn problems(&self, pointer: &str, parameter: &Parameter) -> Vec<Problem> {
        let mut problems = Vec::new();
        if let Some(measure) = self.measure
            && let Some(expected) = measure.misfit(parameter)
        {
            let at = format!("{pointer}/measure");
            problems.push(Problem::new("spec/compare", at, measure.name(), expected));
        }
        if let Some(costs) = &self.costs {
            let at = format!("{pointer}/costs");
            if self.measure.is_some() {
                let found = "costs and a measure";
                problems.push(Problem::new("spec/compare", &at, found, "one of the two"));
            }
            problems.extend(cost_problem(costs, parameter, &at));
        }
        problems
    }
}

/// The first problem of a table of costs.
fn cost_problem(costs: &[Vec<f64>], parameter: &Parameter, pointer: &str) -> Option<Problem> {
    let wrong = |at: String, found: String, expected: &str| Some(Problem::new("spec/compare", at, found, expected));
    let Some(choices) = &parameter.choices else {
        let found = "costs for a parameter without choices".to_owned();
        return wrong(pointer.to_owned(), found, "a variant parameter with choices");
    };
    let names: BTreeSet<String> = choices.iter().map(ToString::to_string).collect();
    if names.len() < choices.len() {
        let found = "costs for choices with a duplicate".to_owned();
        return wrong(pointer.to_owned(), found, "each choice once");
    }
    if costs.len() != choices.len() {
        let found = format!("{} rows", costs.len());
        return wrong(
            pointer.to_owned(),
            found,
            &format!("{}, one for each choice", choices.len()),
        );
    }
    for (a, row) in costs.iter().enumerate() {
        let at = format!("{pointer}/{a}");
        if row.len() != choices.len() {
            let found = format!("{} numbers", row.len());
            return wrong(at, found, &format!("{}, one for each choice", choices.len()));
        }
        for (b, cost) in row.iter().enumerate() {
            let at = format!("{at}/{b}");
            if *cost < 0.0 {
                return wrong(at, cost.to_string(), "a number of at least 0");
            }
            if a == b && *cost != 0.0 {
                return wrong(at, cost.to_string(), "0, the distance of a choice from itself");
            }
            if b < a && *cost != costs[b][a] {
                let expected = format!("{}, as at /{b}/{a}: costs must be symmetric", costs[b][a]);
                return wrong(at, cost.to_string(), &expected);
            }
        }
    }
    if costs.iter().flatten().all(|cost| *cost == 0.0) && choices.len() > 1 {
        let found = "costs that are all 0".to_owned();
        return wrong(pointer.to_owned(), found, "at least one above 0, or a weight of 0");
    }
    None
}

#[cfg(test)]
mod tests;
