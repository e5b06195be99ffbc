//! Checks sources of values: references are known, have the required type, and stay in range.

use super::super::parameter::{Domain, Parameter, Role};
use super::super::scope::{Scope, Unsettled};
use super::super::template::Source;
use super::Check;
use crate::describe::plain_number;
use crate::distribution::{Distribution, Number, ParamRef};
use crate::error::{Problem, first_of};
use crate::value::{ParameterType, Value};

impl Check<'_> {
    /// Whether a distribution's references name numbers, and every variant can draw from it.
    pub(super) fn distribution(&mut self, pointer: &str, distribution: &Distribution<Number>) -> bool {
        let before = self.problems.len();
        let mut references = Vec::new();
        for number in distribution.numbers() {
            match number {
                Number::Param(reference) => references.push(reference),
                Number::Case(case) => self.number_case(pointer, &case),
                Number::Literal(_) => {}
            }
        }
        let mut references = &references[..];
        while let Some(reference) = references.first() {
            if let Some(rest) = after_whole_color(references) {
                self.color_reference(pointer, reference);
                references = rest;
            } else {
                self.number_reference(pointer, reference);
                references = &references[1..];
            }
        }
        if self.problems.len() > before {
            return false;
        }
        let source = Source::Distribution(Box::new(distribution.clone()));
        let fault = self.variants.iter().find_map(|(name, values)| {
            let (found, expected) = match Scope::new(self.parameters, values).outcomes(&source) {
                Ok(outcomes) => outcomes.iter().find_map(|(law, _)| law.fault())?,
                Err(Unsettled::NoCase(found, _)) => (found, "a case for it"),
                Err(_) => return None,
            };
            Some((name.clone(), found, expected))
        });
        if let Some((variant, found, expected)) = fault {
            let found = format!("{found} in variant {variant:?}");
            self.report(Problem::new("spec/distribution", pointer, found, expected));
        }
        self.problems.len() == before
    }

    /// Checks a colour in a distribution: a fixed or variant colour, or three numbers.
    fn color_reference(&mut self, pointer: &str, first_channel: &ParamRef) {
        let unsuitable = self.parameters.get(&first_channel.param).filter(|parameter| {
            let is_color = parameter.kind == ParameterType::Color;
            let has_three = parameter.kind == ParameterType::Vector && parameter.vector_length() == Some(3);
            parameter.role != Role::Randomized && !is_color && !has_three
        });
        let Some(parameter) = unsuitable else {
            return self.number_reference(pointer, first_channel);
        };
        let found = format!(
            "the parameter {:?} of type {}",
            first_channel.param,
            parameter.kind.name()
        );
        self.report(Problem::new("spec/type", pointer, found, "a parameter of type color"));
    }

    /// Checks a number in a distribution or a group's margin: it may refer only to a fixed or variant number.
    pub(super) fn number_reference(&mut self, pointer: &str, reference: &ParamRef) {
        let name = &reference.param;
        let Some(parameter) = self.parameters.get(name) else {
            return self.unknown_parameter(pointer, name);
        };
        if parameter.role == Role::Randomized {
            let found = format!("the randomized parameter {name:?}");
            let advice = "the numbers of a distribution stay the same within a variant";
            self.report(Problem::new("spec/role", pointer, found, "a fixed or variant parameter").advise(advice));
        } else if let Some(kind) = self.kind_at(pointer, reference)
            && !kind.fits(ParameterType::Number)
            && kind != ParameterType::Heading
        {
            let found = format!("the parameter {name:?} of type {}", kind.name());
            self.report(Problem::new("spec/type", pointer, found, "a parameter of type number"));
        }
    }

    /// The type of a reference to a known parameter; reports an index out of range.
    fn kind_at(&mut self, pointer: &str, reference: &ParamRef) -> Option<ParameterType> {
        let parameter = self.parameters.get(&reference.param)?;
        let Some(index) = reference.index else {
            return Some(parameter.kind);
        };
        let length = match parameter.kind {
            ParameterType::Point => Some(2),
            ParameterType::Color => Some(3),
            ParameterType::Vector => parameter.vector_length().or_else(|| {
                let source = parameter.distribution.as_ref()?;
                // The shortest possible length.
                let lengths = self.distributions_of(source).into_iter().map(|law| law.vector_length());
                lengths.min().flatten()
            }),
            _ => None,
        };
        if length.is_some_and(|length| index < length) {
            return Some(ParameterType::Number);
        }
        let found = match length {
            Some(length) => format!("index {index} of {:?}, which has {length} numbers", reference.param),
            None => format!("an index into {:?} of type {}", reference.param, parameter.kind.name()),
        };
        self.report(Problem::new(
            "spec/index",
            pointer,
            found,
            "an index, from 0, into a vector, point or colour",
        ));
        None
    }

    pub(super) fn unknown_parameter(&mut self, pointer: &str, name: &str) {
        // A parameter that the schema rejected still counts as declared.
        let refused = self
            .unsound
            .parameters
            .iter()
            .filter(|name| !self.parameters.contains_key(*name));
        let known: Vec<&str> = self.parameters.keys().chain(refused).map(String::as_str).collect();
        let expected = if known.is_empty() {
            "a declared parameter; there is none".into()
        } else {
            format!("one of {}", first_of(&known))
        };
        let problem = Problem::new(
            "spec/unknown-parameter",
            pointer,
            format!("the unknown parameter {name:?}"),
            expected,
        );
        self.report(problem.suggest(name, known));
    }

    /// Whether a source is known and yields the required type.
    pub(super) fn source(&mut self, pointer: &str, source: &Source, kind: ParameterType) -> bool {
        match source {
            Source::Case(_) => {
                let leaves = source.leaves().into_iter();
                let sound = leaves.fold(self.cases(pointer, source), |sound, (place, leaf)| {
                    self.source(&format!("{pointer}{place}"), leaf, kind) && sound
                });
                sound && self.has_outcomes(pointer, source)
            }
            Source::Value(value) => {
                let fits = value.cast(kind).is_some();
                self.type_matches(pointer, fits, value.to_string(), kind)
            }
            Source::Param(reference) => {
                let name = &reference.param;
                if !self.parameters.contains_key(name) {
                    self.unknown_parameter(pointer, name);
                    return false;
                }
                match self.kind_at(pointer, reference) {
                    None => false,
                    Some(ParameterType::Distribution) => self.all_yield(pointer, source, kind),
                    Some(found) => {
                        let text = format!("the parameter {reference} of type {}", found.name());
                        self.type_matches(pointer, found.fits(kind), text, kind)
                    }
                }
            }
            Source::Distribution(distribution) => {
                self.distribution(pointer, distribution) && self.all_yield(pointer, source, kind)
            }
        }
    }

    fn all_yield(&mut self, pointer: &str, source: &Source, kind: ParameterType) -> bool {
        let laws = self.distributions_of(source);
        match laws.iter().find(|law| !law.yields(kind)) {
            Some(other) => self.type_matches(pointer, false, format!("the distribution {}", other.name()), kind),
            None => self.stands_alone(pointer, source),
        }
    }

    /// Whether a source's draws are independent of earlier objects: points taken in turn or kept apart are for groups only.
    fn stands_alone(&mut self, pointer: &str, source: &Source) -> bool {
        let grouped = self
            .distributions_of(source)
            .into_iter()
            .find(|law| law.needs_group() && !(pointer == START && is_of_cells(law)));
        if let Some(cells) = grouped.as_ref().filter(|law| law.draws_cells()) {
            let expected = "a group's placement, or the agent's start (without room, walk and of_group)";
            self.report(Problem::new("spec/type", pointer, cells.name(), expected));
        } else if let Some(grouped) = &grouped {
            let advice = "write \"order\": \"random\", or a choice of points, to draw one of them";
            let found = format!("{}, which depends on the objects placed before", grouped.name());
            self.report(
                Problem::new("spec/type", pointer, found, "a distribution with independent draws").advise(advice),
            );
        }
        grouped.is_none()
    }

    fn type_matches(&mut self, pointer: &str, fits: bool, found: String, kind: ParameterType) -> bool {
        if !fits {
            self.report(Problem::new(
                "spec/type",
                pointer,
                found,
                format!("a value of type {}", kind.name()),
            ));
        }
        fits
    }

    /// All distributions of a source: its own, or the possible values of a parameter of type distribution.
    pub(super) fn distributions_of(&self, source: &Source) -> Vec<Distribution<Number>> {
        match source {
            Source::Case(_) => {
                let leaves = source.leaves().into_iter();
                leaves.flat_map(|(_, leaf)| self.distributions_of(leaf)).collect()
            }
            Source::Value(value) => vec![Distribution::Constant { value: value.clone() }],
            Source::Distribution(distribution) => vec![(**distribution).clone()],
            Source::Param(reference) => {
                let parameter = self.parameters.get(&reference.param).into_iter();
                parameter
                    .flat_map(|parameter| parameter.distributions().cloned())
                    .collect()
            }
        }
    }

    /// All values of this type that a source is known to produce: ends of ranges and supports, choices, defaults.
    pub(super) fn candidates(&self, source: &Source, kind: ParameterType) -> Vec<Value> {
        let turned = |value: Value| {
            if kind == ParameterType::Heading {
                value.cast(kind)
            } else {
                Some(value)
            }
        };
        match source {
            Source::Case(_) => {
                let leaves = source.leaves().into_iter();
                leaves.flat_map(|(_, leaf)| self.candidates(leaf, kind)).collect()
            }
            Source::Distribution(_) | Source::Value(_) => self.ends(source).into_iter().filter_map(turned).collect(),
            Source::Param(reference) => {
                let Some(parameter) = self.parameters.get(&reference.param) else {
                    return Vec::new();
                };
                if parameter.kind == ParameterType::Distribution {
                    return self.ends(source).into_iter().filter_map(turned).collect();
                }
                let values = self.candidates_of_parameter(parameter).into_iter();
                values.filter_map(|value| value.at(reference.index)).collect()
            }
        }
    }

    /// All values that a parameter is known to have.
    pub(super) fn candidates_of_parameter(&self, parameter: &Parameter) -> Vec<Value> {
        let typed = |value: &Value| parameter.typed(value);
        let mut values: Vec<Value> = parameter
            .default
            .iter()
            .chain(&parameter.value)
            .filter_map(typed)
            .collect();
        match parameter.domain() {
            Some(Domain::Range(ends)) => values.extend(ends.map(|end| parameter.at_end(end))),
            Some(Domain::Choices(choices)) => values.extend(choices),
            None => {}
        }
        if let Some(source) = &parameter.distribution {
            values.extend(self.ends(source).iter().filter_map(typed));
        }
        values
    }

    /// The extreme values of a source's distributions, over all variants.
    fn ends(&self, source: &Source) -> Vec<Value> {
        let distributions = self.distributions_of(source);
        let sources = distributions.into_iter().map(|law| Source::Distribution(Box::new(law)));
        let outcomes_per_source = sources.flat_map(|source| {
            let outcomes = |(_, values): &(String, _)| Scope::new(self.parameters, values).outcomes(&source).ok();
            self.variants.iter().filter_map(outcomes).flatten().collect::<Vec<_>>()
        });
        let values = outcomes_per_source.flat_map(|(distribution, _)| {
            let example = distribution.example();
            distribution.support().unwrap_or_default().into_iter().chain([example])
        });
        values.collect()
    }

    /// Whether everything that a source can produce is in the allowed range.
    pub(super) fn in_range(&mut self, pointer: &str, candidates: &[Value], [low, high]: [f64; 2]) -> bool {
        let numbers = candidates.iter().flat_map(|value| match value {
            Value::Point(_) | Value::Vector(_) => value.as_vector().unwrap_or_default().to_vec(),
            other => other.as_number().into_iter().collect(),
        });
        let outside = numbers.into_iter().find(|number| !(low..=high).contains(number));
        if let Some(number) = outside {
            let found = format!("a source that can give {}", plain_number(number));
            let expected = if low == f64::MIN {
                format!("at most {high}")
            } else {
                format!("numbers in {low}..{high}")
            };
            let advice = "narrow the parameter's range or the distribution";
            self.report(Problem::new("spec/range", pointer, found, expected).advise(advice));
        }
        outside.is_none()
    }
}

/// Pointer to the agent's start.
const START: &str = "/world/agent_params/coordinates";

/// Whether a distribution draws cells independently of the agent and of groups.
fn is_of_cells(law: &Distribution<Number>) -> bool {
    matches!(
        law,
        Distribution::Cells {
            of_group: false,
            room: None,
            walk: None,
            ..
        }
    )
}

/// The references after the first three, if those are the channels of one colour parameter.
fn after_whole_color(references: &[ParamRef]) -> Option<&[ParamRef]> {
    let (channels, rest) = references.split_first_chunk::<3>()?;
    let of_one = |(k, channel): (usize, &ParamRef)| channel.param == channels[0].param && channel.index == Some(k);
    channels.iter().enumerate().all(of_one).then_some(rest)
}

impl Parameter {
    /// An end of the range as a value of the parameter's type.
    pub(crate) fn at_end(&self, end: f64) -> Value {
        match self.kind {
            ParameterType::Integer => Value::Integer(end.ceil() as i64),
            ParameterType::Vector => Value::Vector(vec![end; self.vector_length().unwrap_or(1)]),
            ParameterType::Heading => Value::Number(end.rem_euclid(360.0)),
            _ => Value::Number(end),
        }
    }
}
