//! Checks look-ups: they read known parameters with values that can be listed, every value has a case, and there are no cycles.

use std::collections::BTreeSet;

use super::super::parameter::{Parameter, Role};
use super::super::scope::{Scope, Unsettled};
use super::super::template::Source;
use super::Check;
use crate::describe::escape;
use crate::distribution::{Case, Distribution, MAX_ATOMS, Number};
use crate::error::{Problem, first_of};
use crate::value::{ParameterType, Value};

impl Check<'_> {
    /// Reports randomized parameters whose look-ups form a cycle, and marks them, and everything that reads them, as unsound.
    pub(super) fn cycles(&mut self) {
        let parameters = self.parameters;
        let reads = |name: &str| -> Vec<String> {
            let own = parameters
                .get(name)
                .and_then(|parameter| parameter.distribution.as_ref());
            own.map(Source::names).unwrap_or_default()
        };
        let (mut cyclic, mut done) = (Vec::new(), BTreeSet::new());
        for start in parameters.keys() {
            // A path of names, each with the names that remain to be followed from it.
            let mut path = vec![(start.clone(), reads(start))];
            while let Some((_, next)) = path.last_mut() {
                let Some(name) = next.pop() else {
                    done.extend(path.pop().map(|(name, _)| name));
                    continue;
                };
                if let Some(first) = path.iter().position(|(known, _)| *known == name) {
                    let names: Vec<String> = path[first..].iter().map(|(name, _)| name.clone()).collect();
                    let shown = format!("a cycle: {} reads {name}", names.join(" reads "));
                    let pointer = format!("/parameters/{}/distribution", escape(&name));
                    let expected = "look-ups that do not read themselves";
                    cyclic.push((names, Problem::new("spec/case-cycle", pointer, shown, expected)));
                } else if !done.contains(&name) {
                    let to_visit = reads(&name);
                    path.push((name, to_visit));
                }
            }
        }
        if cyclic.is_empty() {
            return;
        }
        for (names, problem) in cyclic {
            self.unsound.parameters.extend(names);
            self.report(problem);
        }
        for _ in 0..parameters.len() {
            let reads_unsound = |name: &&String| reads(name).iter().any(|read| self.unsound.parameters.contains(read));
            let names: Vec<String> = parameters.keys().filter(reads_unsound).cloned().collect();
            self.unsound.parameters.extend(names);
        }
    }

    /// Whether every look-up of a source reads valid parameters and has a case for each value.
    pub(super) fn cases(&mut self, pointer: &str, source: &Source) -> bool {
        let before = self.problems.len();
        for (place, case) in source.cases() {
            self.case(&format!("{pointer}{place}"), case);
        }
        self.problems.len() == before
    }

    /// Whether the outcomes of a look-up over random values can be enumerated in every variant.
    pub(super) fn has_outcomes(&mut self, pointer: &str, source: &Source) -> bool {
        let fault = self.variants.iter().find_map(|(name, values)| {
            match Scope::new(self.parameters, values).outcomes(source) {
                Err(Unsettled::NoCase(found, expected)) => Some((format!("{found} in variant {name:?}"), expected)),
                Ok(_) | Err(_) => None,
            }
        });
        let Some((found, expected)) = fault else { return true };
        self.report(Problem::new("spec/case", pointer, found, expected));
        false
    }

    /// Checks a look-up of numbers in a distribution or margin.
    pub(super) fn number_case(&mut self, pointer: &str, case: &Case<Number>) {
        self.case(pointer, case);
        for (_, number) in case.entries() {
            match number {
                Number::Literal(_) => {}
                Number::Param(reference) => self.number_reference(pointer, reference),
                Number::Case(inner) => self.number_case(pointer, inner),
            }
        }
    }

    /// Whether none of these parameters is randomized; reports the first that is.
    pub(super) fn reads_no_draw(&mut self, pointer: &str, names: &[impl AsRef<str>]) -> bool {
        let is_drawn = |name: &&str| {
            let parameter = self.parameters.get(*name);
            parameter.is_some_and(|parameter| parameter.role == Role::Randomized)
        };
        let drawn = names.iter().map(AsRef::as_ref).find(is_drawn);
        if let Some(drawn) = drawn {
            let found = format!("the randomized parameter {drawn:?}");
            self.report(Problem::new(
                "spec/role",
                pointer,
                found,
                "a fixed or variant parameter",
            ));
        }
        drawn.is_none()
    }

    /// Checks a distribution that is the value of a parameter: its look-ups must not read randomized parameters.
    pub(super) fn parameter_distribution(&mut self, pointer: &str, distribution: &Distribution<Number>) {
        if self.distribution(pointer, distribution) {
            let numbers = distribution.numbers();
            let names: Vec<&str> = numbers.iter().flat_map(Number::names).collect();
            self.reads_no_draw(pointer, &names);
        }
    }

    fn case<T>(&mut self, pointer: &str, case: &Case<T>) {
        let name = &case.by.param;
        let at = format!("{pointer}/case");
        let Some(parameter) = self.parameters.get(name) else {
            return self.unknown_parameter(&at, name);
        };
        if case.by.index.is_some() {
            let found = format!("one number of {name:?}");
            return self.report(Problem::new("spec/index", at, found, "a whole parameter"));
        }
        let values = self.listed(parameter);
        if values.is_none() && parameter.role == Role::Randomized {
            let found = format!("the parameter {name:?}, whose values cannot be listed");
            let expected = "one that is drawn from a list: choice, bernoulli, integer_uniform or a look-up";
            return self.report(Problem::new("spec/case", at, found, expected));
        }
        let words: Vec<String> = values.iter().flatten().map(|value| parameter.shown(value)).collect();
        let mut covered = Vec::new();
        for key in case.of.keys() {
            let value = parameter.at_key(key);
            let is_known = |value: &Value| values.as_ref().is_none_or(|values| values.contains(value));
            if let Some(value) = value.filter(is_known) {
                covered.push(value);
            } else {
                let expected = if words.is_empty() {
                    format!("a {}", parameter.kind.name())
                } else {
                    format!("a value of {name:?}, one of {}", first_of(&words))
                };
                let pointer = format!("{pointer}/of/{}", escape(key));
                self.report(Problem::new("spec/case", pointer, format!("{key:?}"), expected).suggest(key, &words));
            }
        }
        let missing: Vec<&String> = values
            .iter()
            .flatten()
            .zip(&words)
            .filter(|(value, _)| !covered.contains(value))
            .map(|(_, word)| word)
            .collect();
        if case.otherwise.is_none() && (values.is_none() || !missing.is_empty()) {
            let found = if values.is_none() {
                format!("no \"else\" for {name:?}, which may have any value in its range")
            } else {
                format!("no case for {}", first_of(&missing))
            };
            let expected = format!("a case for every value of {name:?}, or \"else\"");
            self.report(Problem::new("spec/case", pointer, found, expected));
        }
    }

    /// Every value that a parameter can have, without duplicates; `None` if they cannot be listed.
    fn listed(&self, parameter: &Parameter) -> Option<Vec<Value>> {
        let mut all: Vec<Value> = Vec::new();
        match (&parameter.choices, parameter.range, &parameter.distribution) {
            (_, _, Some(source)) => {
                for law in self.distributions_of(source) {
                    let law = Source::Distribution(Box::new(law));
                    for (_, values) in &self.variants {
                        for (law, _) in Scope::new(self.parameters, values).outcomes(&law).ok()? {
                            all.extend(law.atoms()?.into_iter().map(|(value, _)| value));
                        }
                    }
                }
                for (_, leaf) in source.leaves() {
                    if let Source::Param(reference) = leaf {
                        let other = self.parameters.get(&reference.param)?;
                        if other.kind != ParameterType::Distribution {
                            all.extend(self.listed(other)?);
                        }
                    }
                }
            }
            (Some(choices), _, _) => all.extend(choices.iter().cloned()),
            (None, Some([low, high]), _)
                if parameter.kind == ParameterType::Integer && high - low < MAX_ATOMS as f64 =>
            {
                all.extend((low as i64..=high as i64).map(Value::Integer));
            }
            (None, Some(_), _) => return None,
            (None, None, None) => all.extend(parameter.value.clone()),
        }
        let mut listed = Vec::new();
        for value in all.iter().filter_map(|value| parameter.typed(value)) {
            if !listed.contains(&value) {
                listed.push(value);
            }
        }
        Some(listed)
    }
}
