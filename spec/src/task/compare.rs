//! [`Compare`]: what a task says of how its variants are compared: by which measure, at which weight. The measures are `similarity`'s.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter::{Domain, Parameter, Role};
use super::template::Source;
use crate::error::Problem;
use crate::value::{ParameterType, Value};

/// How two values of a parameter are compared, and how much that counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "weight": 2, "measure": "log_ratio" },
    { "costs": [[0, 0.2, 1], [0.2, 0, 1], [1, 1, 0]] },
]))]
pub struct Compare {
    /// What the parameter weighs among those that touch the same element; 1 if absent, 0 leaves it out.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub weight: f64,
    /// The measure; that of the parameter's type if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measure: Option<MeasureName>,
    /// For choices: how far each is from each, a row for every choice in their order; divided by the largest when it counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 1000))]
    pub costs: Option<Vec<Vec<f64>>>,
}

fn one() -> f64 {
    1.0
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

/// A measure of how far two values, or two distributions, are apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum MeasureName {
    /// Numbers: the difference over the declared range. What numbers have if nothing is said.
    Difference,
    /// Numbers above 0: the logarithm of their ratio, over that of the range. For scales, where twice is as far as half.
    LogRatio,
    /// Any type: 0 if they are the same, 1 if not.
    SameOrNot,
    /// Colours, and the ways of drawn ones: Euclidean in sRGB, as in the L2Explorer paper.
    Srgb,
    /// Colours: Euclidean in CIELAB.
    Cie76,
    /// Colours: CIEDE2000. Not a metric.
    Ciede2000,
    /// Colours: Euclidean in Oklab. What colours have if nothing is said.
    Oklab,
    /// Distributions of numbers or colours: least work. What they have if nothing is said.
    #[serde(rename = "wasserstein_1")]
    #[strum(serialize = "wasserstein_1")]
    Wasserstein1,
    /// Distributions of numbers or colours: least squared work, its root.
    #[serde(rename = "wasserstein_2")]
    #[strum(serialize = "wasserstein_2")]
    Wasserstein2,
    /// Distributions: the largest difference of the probabilities that they give to any set.
    TotalVariation,
    /// Distributions: Hellinger's distance.
    Hellinger,
    /// Distributions: the root of Jensen and Shannon's divergence.
    JensenShannon,
}

impl MeasureName {
    /// The name as documents write it.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// What measures there are for colours out of a continuum, which have no probabilities to compare; `None` if this is one.
    pub(super) fn misfit_of_drawn_colors(self) -> Option<&'static str> {
        matches!(self, Self::TotalVariation | Self::Hellinger | Self::JensenShannon).then_some(
            "wasserstein_1, wasserstein_2, oklab, srgb, cie76, ciede2000 or same_or_not, since colours out of a continuum are \
             compared by how far they are apart",
        )
    }

    /// What parameters must be for this measure; `None` if this one is.
    fn misfit(self, parameter: &Parameter) -> Option<&'static str> {
        use MeasureName::{
            Cie76, Ciede2000, Difference, Hellinger, JensenShannon, LogRatio, Oklab, SameOrNot, Srgb, TotalVariation,
            Wasserstein1, Wasserstein2,
        };
        let by_distribution = parameter.role == Role::Randomized || parameter.kind == ParameterType::Distribution;
        let numeric = matches!(parameter.kind, ParameterType::Number | ParameterType::Integer);
        let wanted = match self {
            SameOrNot => return None,
            Difference if numeric && !by_distribution => return None,
            LogRatio if numeric && !by_distribution && always_positive(parameter) => return None,
            Srgb | Cie76 | Ciede2000 | Oklab if parameter.kind == ParameterType::Color || gives_colors(parameter) => {
                return None;
            }
            TotalVariation | Hellinger | JensenShannon if gives_colors(parameter) => {
                return self.misfit_of_drawn_colors();
            }
            Wasserstein1 | Wasserstein2 | TotalVariation | Hellinger | JensenShannon if by_distribution => return None,
            Difference => "a variant parameter of type number or integer for it",
            LogRatio => "a variant parameter of type number or integer whose values are all above 0 for it",
            Srgb | Cie76 | Ciede2000 | Oklab => {
                "a parameter of type color, or one whose distributions draw colours, for it"
            }
            Wasserstein1 | Wasserstein2 | TotalVariation | Hellinger | JensenShannon => {
                "a randomized parameter, or one of type distribution for it"
            }
        };
        Some(wanted)
    }
}

/// Whether colours out of a continuum are drawn: by the parameter's own distribution, or by one that it may be.
fn gives_colors(parameter: &Parameter) -> bool {
    let own = match &parameter.distribution {
        Some(Source::Distribution(distribution)) => distribution.draws_colors(),
        // Then the measure stands where that parameter is declared.
        Some(Source::Param(_)) | None => false,
    };
    let values = parameter
        .value
        .iter()
        .chain(&parameter.default)
        .chain(parameter.choices.iter().flatten());
    own || values
        .into_iter()
        .any(|value| matches!(value, Value::Distribution(distribution) if distribution.draws_colors()))
}

fn always_positive(parameter: &Parameter) -> bool {
    match parameter.domain() {
        Some(Domain::Range([low, _])) => low > 0.0,
        Some(Domain::Choices(choices)) => choices.iter().all(|choice| choice.as_number().is_some_and(|x| x > 0.0)),
        None => false,
    }
}

impl Compare {
    /// What the schema cannot say: a measure that does not fit the parameter, costs that are none.
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
                let found = "costs beside a measure";
                problems.push(Problem::new("spec/compare", &at, found, "one of the two"));
            }
            problems.extend(cost_problem(costs, parameter, &at));
        }
        problems
    }
}

/// The first thing that is wrong with a table of costs.
fn cost_problem(costs: &[Vec<f64>], parameter: &Parameter, pointer: &str) -> Option<Problem> {
    let wrong = |at: String, found: String, expected: &str| Some(Problem::new("spec/compare", at, found, expected));
    let Some(choices) = &parameter.choices else {
        let found = "costs of a parameter without choices".to_owned();
        return wrong(pointer.to_owned(), found, "a variant parameter with choices");
    };
    let names: BTreeSet<String> = choices.iter().map(ToString::to_string).collect();
    if names.len() < choices.len() {
        let found = "costs of choices of which one stands twice".to_owned();
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
                return wrong(at, cost.to_string(), "0: a choice is no distance from itself");
            }
            if b < a && *cost != costs[b][a] {
                let expected = format!("{}, as at /{b}/{a}: as far there as back", costs[b][a]);
                return wrong(at, cost.to_string(), &expected);
            }
        }
    }
    if costs.iter().flatten().all(|cost| *cost == 0.0) && choices.len() > 1 {
        let found = "costs that are all 0".to_owned();
        return wrong(pointer.to_owned(), found, "some that are not, or a weight of 0");
    }
    None
}

/// What each element of the decision process weighs in a task's distances; 1 where nothing is said.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "R": 2, "O": 0.5 }]))]
pub struct ElementWeights {
    /// The states.
    #[serde(rename = "S", default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub state: f64,
    /// The actions.
    #[serde(rename = "A", default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub action: f64,
    /// The transitions.
    #[serde(rename = "T", default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub transition: f64,
    /// The rewards.
    #[serde(rename = "R", default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub reward: f64,
    /// The observations.
    #[serde(rename = "O", default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub observation: f64,
}

impl Default for ElementWeights {
    fn default() -> Self {
        Self {
            state: 1.0,
            action: 1.0,
            transition: 1.0,
            reward: 1.0,
            observation: 1.0,
        }
    }
}

impl ElementWeights {
    /// In the order of [`Element::ALL`](crate::Element::ALL).
    pub fn to_array(self) -> [f64; 5] {
        [self.state, self.action, self.transition, self.reward, self.observation]
    }

    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use crate::TaskSpec;

    fn check(compare: &str, parameter: &str, expected: &str) {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{ "p": {{ "affects": ["O"], "compare": {compare}, {parameter} }} }} }}"#
        );
        let said = TaskSpec::from_json("t.json", &text).map_or_else(|error| error.to_string(), |_| String::new());
        let said = said.split_once(" (").map_or("", |(_, said)| said);
        assert_eq!(said, expected);
    }

    const NUMBER: &str = r#""role": "variant", "type": "number", "range": [0, 1], "default": 0"#;
    const WORDS: &str = r#""role": "variant", "type": "string", "choices": ["a", "b", "c"], "default": "a""#;

    #[test]
    fn a_measure_fits_the_parameter_that_it_compares() {
        check(r#"{ "measure": "difference", "weight": 3 }"#, NUMBER, "");
        check(r#"{ "measure": "same_or_not" }"#, WORDS, "");
        check(
            r#"{ "measure": "log_ratio" }"#,
            NUMBER,
            "/parameters/p/compare/measure): found log_ratio, expected a variant parameter of type number or integer whose values are all above 0 for it",
        );
        check(
            r#"{ "measure": "ciede2000" }"#,
            WORDS,
            "/parameters/p/compare/measure): found ciede2000, expected a parameter of type color, or one whose distributions draw colours, for it",
        );
        check(
            r#"{ "measure": "hellinger" }"#,
            NUMBER,
            "/parameters/p/compare/measure): found hellinger, expected a randomized parameter, or one of type distribution for it",
        );
        let drawn = r#""role": "randomized", "type": "number", "distribution": { "uniform": { "low": 0, "high": 1 } }"#;
        check(r#"{ "measure": "hellinger" }"#, drawn, "");
    }

    #[test]
    fn drawn_colours_are_compared_by_how_far_they_are_apart() {
        let drawn = r#""role": "randomized", "type": "color", "distribution": { "color_normal": { "mean": "red", "std": 0.1 } }"#;
        let law = r#""role": "variant", "type": "distribution", "choices": [{ "color_hsv": {} }], "default": { "color_hsv": {} }"#;
        for parameter in [drawn, law] {
            for fits in [
                "srgb",
                "cie76",
                "ciede2000",
                "oklab",
                "wasserstein_1",
                "wasserstein_2",
                "same_or_not",
            ] {
                check(&format!(r#"{{ "measure": "{fits}" }}"#), parameter, "");
            }
            for odd in ["total_variation", "hellinger", "jensen_shannon"] {
                let said = format!(
                    "/parameters/p/compare/measure): found {odd}, expected wasserstein_1, wasserstein_2, oklab, srgb, cie76, ciede2000 or \
                     same_or_not, since colours out of a continuum are compared by how far they are apart"
                );
                check(&format!(r#"{{ "measure": "{odd}" }}"#), parameter, &said);
            }
        }
        let words =
            r#""role": "randomized", "type": "color", "distribution": { "choice": { "values": ["red", "blue"] } }"#;
        check(r#"{ "measure": "total_variation" }"#, words, "");
    }

    #[test]
    fn a_measure_looks_at_the_distributions_that_another_parameter_may_be() {
        let text = r#"{ "name": "t", "parameters": {
            "law": { "role": "variant", "type": "distribution", "affects": ["O"], "choices": [{ "color_hsv": {} }], "default": { "color_hsv": {} } },
            "p": { "role": "randomized", "type": "color", "affects": ["O"], "distribution": { "param": "law" },
                   "compare": { "measure": "hellinger" } } } }"#;
        let said = TaskSpec::from_json("t.json", text).map_or_else(|error| error.to_string(), |_| String::new());
        assert!(
            said.contains("(/parameters/p/compare/measure): found hellinger, expected wasserstein_1"),
            "{said}"
        );
    }

    #[test]
    fn costs_are_distances_among_the_choices() {
        check(r#"{ "costs": [[0, 1, 2], [1, 0, 1.5], [2, 1.5, 0]] }"#, WORDS, "");
        let wrong = |costs: &str, at: &str, said: &str| {
            check(
                &format!(r#"{{ "costs": {costs} }}"#),
                WORDS,
                &format!("/parameters/p/compare/costs{at}): {said}"),
            );
        };
        wrong("[[0, 1], [1, 0]]", "", "found 2 rows, expected 3, one for each choice");
        wrong(
            "[[0, 1, 1], [1, 0], [1, 1, 0]]",
            "/1",
            "found 2 numbers, expected 3, one for each choice",
        );
        wrong(
            "[[0, 1, 1], [2, 0, 1], [1, 1, 0]]",
            "/1/0",
            "found 2, expected 1, as at /0/1: as far there as back",
        );
        wrong(
            "[[0, 1, 1], [1, 3, 1], [1, 1, 0]]",
            "/1/1",
            "found 3, expected 0: a choice is no distance from itself",
        );
        wrong(
            "[[0, -1, 1], [-1, 0, 1], [1, 1, 0]]",
            "/0/1",
            "found -1, expected a number of at least 0",
        );
        wrong(
            "[[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
            "",
            "found costs that are all 0, expected some that are not, or a weight of 0",
        );
        check(
            r#"{ "costs": [[0]] }"#,
            NUMBER,
            "/parameters/p/compare/costs): found costs of a parameter without choices, expected a variant parameter with choices",
        );
        check(
            r#"{ "costs": [[0, 1], [1, 0]] }"#,
            r#""role": "variant", "type": "string", "choices": ["a", "a"], "default": "a""#,
            "/parameters/p/compare/costs): found costs of choices of which one stands twice, expected each choice once",
        );
        check(
            r#"{ "measure": "same_or_not", "costs": [[0, 1, 1], [1, 0, 1], [1, 1, 0]] }"#,
            WORDS,
            "/parameters/p/compare/costs): found costs beside a measure, expected one of the two",
        );
    }
}
