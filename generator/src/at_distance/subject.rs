//! [`Subject`]: the parameters that may change to reach a target distance.

use driftworld_spec::{Domain, Element, Parameter, ParameterType, Role, Variant, nearest};

use crate::GeneratorError;

/// The parameters that may change to reach a target distance.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// The variant parameters that affect only this element of the decision process.
    Element(Element),
    /// These variant parameters.
    Parameters(Vec<String>),
}

impl Subject {
    /// Names of the parameters that may change, in the task's order.
    pub fn parameters<'a>(&self, from: &'a Variant) -> Vec<&'a str> {
        self.free(from).map(|(name, _)| name).collect()
    }

    fn free<'a>(&self, from: &'a Variant) -> impl Iterator<Item = Free<'a>> {
        declared(from).filter(move |(name, parameter)| match self {
            Self::Element(element) => parameter.affects_only(*element),
            Self::Parameters(names) => names.iter().any(|wanted| wanted == name),
        })
    }
}

/// The variant parameters of a variant's task.
fn declared(from: &Variant) -> impl Iterator<Item = Free<'_>> {
    let parameters = from
        .task()
        .parameters()
        .iter()
        .map(|(name, parameter)| (name.as_str(), parameter));
    parameters.filter(|(_, parameter)| parameter.role == Role::Variant)
}

/// A parameter that may change: its name and declaration.
pub(super) type Free<'a> = (&'a str, &'a Parameter);

/// The parameters that may change: those that move continuously, and those with a list of choices.
pub(super) struct FreeParameters<'a> {
    pub(super) smooth: Vec<Free<'a>>,
    pub(super) listed: Vec<Free<'a>>,
    /// Parameters that decide which others are read, or are read only under a condition.
    pub(super) tied: Vec<&'a str>,
    /// Whether the distance may grow unevenly when all numbers move together: one decides which parameters are read, or moves
    /// in integer steps.
    pub(super) is_bent: bool,
}

pub(super) fn parameters_of<'a>(from: &'a Variant, subject: &Subject) -> Result<FreeParameters<'a>, GeneratorError> {
    if let Subject::Parameters(names) = subject {
        let known: Vec<&str> = declared(from).map(|(name, _)| name).collect();
        if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
            let advice = nearest(unknown, known).map_or_else(String::new, |near| format!(" (did you mean {near:?}?)"));
            return Err(GeneratorError::NothingToVary {
                variant: from.id(),
                asked: format!("variant parameter named {unknown}{advice}"),
            });
        }
    }
    let free: Vec<Free> = subject.free(from).collect();
    if free.is_empty() {
        let asked = match subject {
            Subject::Element(element) => format!("parameters that affect {} alone", element.letter()),
            Subject::Parameters(names) => format!("variant parameters named {}", names.join(", ")),
        };
        return Err(GeneratorError::NothingToVary {
            variant: from.id(),
            asked,
        });
    }
    let conditions = || {
        from.task()
            .parameters()
            .values()
            .filter_map(|parameter| parameter.read_if.as_ref())
    };
    let is_word = |text: &str, name: &str| {
        let mut words = text.split(|character: char| !(character.is_alphanumeric() || character == '_'));
        words.any(|word| word == name)
    };
    let decides = |name: &str| conditions().any(|text| is_word(text, name));
    let tied = free
        .iter()
        .filter(|(name, parameter)| parameter.read_if.is_some() || decides(name))
        .map(|(name, _)| *name)
        .collect();
    let (smooth, listed): (Vec<Free>, Vec<Free>) = free
        .into_iter()
        .partition(|(_, parameter)| matches!(parameter.domain(), Some(Domain::Range(_))));
    let is_whole = |parameter: &Parameter| parameter.kind == ParameterType::Integer && smooth.len() > 1;
    Ok(FreeParameters {
        tied,
        is_bent: smooth
            .iter()
            .any(|(name, parameter)| decides(name) || is_whole(parameter)),
        smooth,
        listed,
    })
}
