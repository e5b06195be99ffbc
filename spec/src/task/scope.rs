//! [`Scope`]: known values of a task's parameters, used to resolve sources and look-ups.

use indexmap::IndexMap;

use super::parameter::{Parameter, Role};
use super::template::Source;
use crate::distribution::{Case, Distribution, Number, ParamRef};
use crate::error::first_of;
use crate::value::{ParameterType, Value};

/// Maximum number of combinations of the draws that a look-up reads.
const MAX_COMBINATIONS: usize = 4096;

/// Known values of a task's parameters: a variant's values, and the randomized parameters drawn so far.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) parameters: &'a IndexMap<String, Parameter>,
    pub(crate) values: &'a IndexMap<String, Value>,
    pub(crate) drawn: &'a [(&'a str, Value)],
}

/// The result of resolving a source in a variant.
#[derive(Clone, Debug, PartialEq)]
pub enum Resolved {
    /// The same value in every world.
    Value(Value),
    /// The value of this randomized parameter, or one of its components.
    Randomized(ParamRef),
    /// A separate draw.
    Draw(Distribution),
}

/// Why a source cannot be resolved.
#[derive(Debug)]
pub(crate) enum Unsettled {
    /// A look-up reads this randomized parameter, and its value is not known.
    Drawn(String),
    /// A look-up has no case for a value: what was found and expected.
    NoCase(String, String),
    /// The draws read by look-ups cannot be enumerated, or a reference names no number.
    Unknown,
}

impl<'a> Scope<'a> {
    pub(crate) fn new(parameters: &'a IndexMap<String, Parameter>, values: &'a IndexMap<String, Value>) -> Self {
        let drawn = &[];
        Self {
            parameters,
            values,
            drawn,
        }
    }

    fn value(&self, name: &str) -> Option<&Value> {
        let drawn = self.drawn.iter().find(|(known, _)| *known == name);
        drawn.map(|(_, value)| value).or_else(|| self.values.get(name))
    }

    fn choose<'c, T>(&self, case: &'c Case<T>) -> Result<&'c T, Unsettled> {
        let name = &case.by.param;
        let parameter = self.parameters.get(name).ok_or(Unsettled::Unknown)?;
        let value = self.value(name).ok_or_else(|| match parameter.role {
            Role::Randomized => Unsettled::Drawn(name.clone()),
            Role::Fixed | Role::Variant => Unsettled::Unknown,
        })?;
        let of_value = case
            .of
            .iter()
            .find(|(key, _)| parameter.at_key(key).as_ref() == Some(value));
        of_value
            .map(|(_, case)| case)
            .or(case.otherwise.as_ref())
            .ok_or_else(|| {
                let keys: Vec<&String> = case.of.keys().collect();
                Unsettled::NoCase(
                    format!("{name} = {value}"),
                    format!("a value with a case, one of {}", first_of(&keys)),
                )
            })
    }

    /// The value of a literal, a reference or a look-up.
    pub(crate) fn number(&self, number: &Number) -> Result<f64, Unsettled> {
        match number {
            Number::Literal(number) => Ok(*number),
            Number::Param(reference) => {
                let value = self.values.get(&reference.param).ok_or(Unsettled::Unknown)?;
                let number = value.at(reference.index).and_then(|value| value.as_number());
                number.ok_or(Unsettled::Unknown)
            }
            Number::Case(case) => self.number(self.choose(case)?),
        }
    }

    /// A distribution with every number resolved.
    pub(crate) fn settle(&self, distribution: &Distribution<Number>) -> Result<Distribution, Unsettled> {
        distribution.try_map(&mut |number| self.number(number))
    }

    /// Resolves a source.
    pub(crate) fn resolve(&self, source: &Source) -> Result<Resolved, Unsettled> {
        match source {
            Source::Case(case) => self.resolve(self.choose(case)?),
            Source::Value(value) => Ok(Resolved::Value(value.clone())),
            Source::Distribution(distribution) => self.settle(distribution).map(Resolved::Draw),
            Source::Param(reference) => match self.values.get(&reference.param) {
                None => Ok(Resolved::Randomized(reference.clone())),
                Some(Value::Distribution(distribution)) => self.settle(distribution).map(Resolved::Draw),
                Some(value) => value.at(reference.index).map(Resolved::Value).ok_or(Unsettled::Unknown),
            },
        }
    }

    /// The distributions of a source over all outcomes of the draws that its look-ups read: without duplicates, with their
    /// probabilities.
    pub(crate) fn outcomes(&self, source: &Source) -> Result<Vec<(Distribution, f64)>, Unsettled> {
        let mut outcomes = Outcomes::default();
        self.add_outcomes(source, 1.0, &mut outcomes)?;
        Ok(outcomes.found)
    }

    fn add_outcomes(&self, source: &Source, weight: f64, outcomes: &mut Outcomes) -> Result<(), Unsettled> {
        let distribution_of = |name: &str| {
            let parameter = self.parameters.get(name).ok_or(Unsettled::Unknown)?;
            Ok((parameter, parameter.distribution.as_ref().ok_or(Unsettled::Unknown)?))
        };
        let mut unsettled = match self.resolve(source) {
            Ok(Resolved::Randomized(reference)) => {
                return self.add_outcomes(distribution_of(&reference.param)?.1, weight, outcomes);
            }
            Ok(Resolved::Value(value)) => return outcomes.add(Distribution::Constant { value }, weight),
            Ok(Resolved::Draw(distribution)) => return outcomes.add(distribution, weight),
            Err(Unsettled::Drawn(name)) => name,
            Err(other) => return Err(other),
        };
        // The parameter may itself have a look-up, so the earliest draw is resolved first.
        for _ in 0..self.parameters.len() {
            let (parameter, own) = distribution_of(&unsettled)?;
            let atoms = match self.resolve(own) {
                Err(Unsettled::Drawn(earlier)) => {
                    unsettled = earlier;
                    continue;
                }
                Err(other) => return Err(other),
                Ok(Resolved::Value(value)) => vec![(value, 1.0)],
                Ok(Resolved::Draw(distribution)) => distribution.atoms().ok_or(Unsettled::Unknown)?,
                Ok(Resolved::Randomized(_)) => return Err(Unsettled::Unknown),
            };
            for (value, probability) in atoms {
                let mut drawn = self.drawn.to_vec();
                drawn.push((&unsettled, parameter.typed(&value).ok_or(Unsettled::Unknown)?));
                let deeper = Scope { drawn: &drawn, ..*self };
                deeper.add_outcomes(source, weight * probability, outcomes)?;
            }
            return Ok(());
        }
        Err(Unsettled::Unknown)
    }
}

/// The distributions found so far, without duplicates, with their probabilities, and the number of combinations.
#[derive(Default)]
struct Outcomes {
    found: Vec<(Distribution, f64)>,
    num_combinations: usize,
}

impl Outcomes {
    fn add(&mut self, distribution: Distribution, weight: f64) -> Result<(), Unsettled> {
        self.num_combinations += 1;
        add_weight(&mut self.found, distribution, weight);
        if self.num_combinations > MAX_COMBINATIONS {
            let expected = format!("at most {MAX_COMBINATIONS} combinations");
            let found = format!("draws with more than {MAX_COMBINATIONS} combinations");
            return Err(Unsettled::NoCase(found, expected));
        }
        Ok(())
    }
}

/// Adds the weight to an existing entry, or adds an entry.
fn add_weight<T: PartialEq>(found: &mut Vec<(T, f64)>, new: T, weight: f64) {
    match found.iter_mut().find(|(known, _)| *known == new) {
        Some((_, known)) => *known += weight,
        None => found.push((new, weight)),
    }
}

/// One distribution for all outcomes: a list if all are lists, otherwise a mixture.
pub(crate) fn merged(mut outcomes: Vec<(Distribution, f64)>) -> Distribution {
    if outcomes.len() == 1 {
        return outcomes.remove(0).0;
    }
    let lists: Option<Vec<_>> = outcomes
        .iter()
        .map(|(law, weight)| Some((law.atoms()?, *weight)))
        .collect();
    let Some(lists) = lists else {
        let (parts, weights) = outcomes.into_iter().unzip();
        let weights = Some(weights);
        return Distribution::Mixture { parts, weights };
    };
    let mut all: Vec<(Value, f64)> = Vec::new();
    for (value, weight) in lists
        .into_iter()
        .flat_map(|(atoms, weight)| atoms.into_iter().map(move |(value, own)| (value, own * weight)))
    {
        add_weight(&mut all, value, weight);
    }
    let (values, weights) = all.into_iter().unzip();
    let weights = Some(weights);
    Distribution::Choice { values, weights }
}

impl Parameter {
    /// The value of this parameter that a look-up's key denotes.
    pub(crate) fn at_key(&self, key: &str) -> Option<Value> {
        match self.kind {
            ParameterType::Boolean | ParameterType::Integer | ParameterType::Number => {
                serde_json::from_str::<Value>(key).ok()?.cast(self.kind)
            }
            ParameterType::String | ParameterType::Color => Value::Text(key.to_owned()).cast(self.kind),
            _ => {
                let choices = self.choices.as_ref()?;
                choices.named(&Value::Text(key.to_owned()))?.cast(self.kind)
            }
        }
    }
}
