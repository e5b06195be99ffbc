//! The distributions that a task's declared ranges and choices allow, regardless of its variants.

use std::collections::BTreeSet;
use std::sync::Arc;

use indexmap::IndexMap;

use super::TaskSpec;
use super::parameter::{Domain, Parameter, Role};
use super::variant::{Variant, violated_requirement};
use super::variant_spec::DEFAULT_VARIANT;
use crate::distribution::Distribution;
use crate::value::{ParameterType, Value};

/// Maximum number of combinations of values.
const MAX_ENDS: usize = 256;

impl TaskSpec {
    /// The distributions of a parameter at the range ends and choices of all parameters that it depends on, in all
    /// combinations, without duplicates; beyond 256 combinations each parameter varies alone, with the others at their
    /// defaults. Skips invalid distributions, and combinations that violate a requirement that involves only these and
    /// fixed parameters. Ignores declared variants. Empty for a parameter without a distribution.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::TaskSpec;
    /// let text = r#"{ "name": "t", "parameters": {
    ///     "widest": { "role": "variant", "type": "number", "affects": ["S"], "range": [1, 90], "default": 45 },
    ///     "heading": { "role": "randomized", "type": "heading", "affects": ["S"],
    ///                  "distribution": { "uniform": { "low": 0, "high": { "param": "widest" } } } } } }"#;
    /// assert_eq!(TaskSpec::from_json("inline", text)?.distributions_at_ends("heading").len(), 3);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn distributions_at_ends(self: &Arc<Self>, parameter: &str) -> Vec<Distribution> {
        let dependencies = self.dependencies(parameter);
        let ends: Vec<(&String, Vec<Value>)> = self
            .parameters()
            .iter()
            .filter(|(name, declared)| declared.role == Role::Variant && dependencies.contains(name.as_str()))
            .map(|(name, declared)| (name, ends_of(declared)))
            .collect();
        let mut found: Vec<Distribution> = Vec::new();
        for values in combinations(&ends).into_iter().chain([IndexMap::new()]) {
            if let Some(distribution) = self
                .distribution_at(parameter, values)
                .filter(|new| !found.contains(new))
            {
                found.push(distribution);
            }
        }
        found
    }

    /// A parameter, and everything that its distribution depends on.
    fn dependencies<'a>(&'a self, parameter: &'a str) -> BTreeSet<&'a str> {
        let mut found = BTreeSet::from([parameter]);
        loop {
            let known = found.len();
            for name in self.parameters().keys() {
                if self
                    .readers(name)
                    .draws
                    .iter()
                    .any(|drawn| found.contains(drawn.as_str()))
                {
                    found.insert(name);
                }
            }
            if found.len() == known {
                return found;
            }
        }
    }

    fn distribution_at(self: &Arc<Self>, parameter: &str, changed: IndexMap<String, Value>) -> Option<Distribution> {
        let mut values = IndexMap::new();
        for (name, declared) in self.parameters() {
            let fixed_or_default = declared.value.as_ref().or(declared.default.as_ref());
            if let Some(value) = fixed_or_default.and_then(|value| declared.typed(value)) {
                values.insert(name.clone(), value);
            }
        }
        let mut known = values.clone();
        known.retain(|name, _| self.parameters()[name].role == Role::Fixed);
        known.extend(changed.clone());
        if !changed.is_empty() && violated_requirement(self.requirements(), &known).is_some() {
            return None;
        }
        values.extend(changed);
        let distribution = Variant::new(Arc::clone(self), DEFAULT_VARIANT, values).distribution(parameter)?;
        distribution.fault().is_none().then_some(distribution)
    }
}

/// The ends of a range or all choices; for a vector, all corners or, if there are too many, only the first and the last.
fn ends_of(parameter: &Parameter) -> Vec<Value> {
    match parameter.domain() {
        Some(Domain::Choices(choices)) => choices,
        Some(Domain::Range(ends)) if parameter.kind == ParameterType::Vector => {
            let length = parameter.vector_length().unwrap_or(1);
            let corner = |bits: usize| Value::Vector((0..length).map(|at| ends[bits >> at.min(63) & 1]).collect());
            match u32::try_from(length) {
                Ok(few) if few <= MAX_ENDS.ilog2() => (0..1 << few).map(corner).collect(),
                _ => ends.map(|end| Value::Vector(vec![end; length])).to_vec(),
            }
        }
        Some(Domain::Range(ends)) => {
            let numbers = ends.into_iter().map(Value::Number);
            numbers.filter_map(|end| end.cast(parameter.kind)).collect()
        }
        None => Vec::new(),
    }
}

/// All combinations of values, or one value at a time.
fn combinations(ends: &[(&String, Vec<Value>)]) -> Vec<IndexMap<String, Value>> {
    let count = ends
        .iter()
        .try_fold(1_usize, |count, (_, values)| count.checked_mul(values.len()));
    if count.is_none_or(|count| count > MAX_ENDS) {
        let alone = ends.iter().flat_map(|(name, values)| {
            let one = |value: &Value| IndexMap::from([((*name).clone(), value.clone())]);
            values.iter().map(one)
        });
        return alone.take(MAX_ENDS).collect();
    }
    let mut all = vec![IndexMap::new()];
    for (name, values) in ends {
        let extended = all.iter().flat_map(|known: &IndexMap<String, Value>| {
            values.iter().map(|value| {
                let mut more = known.clone();
                more.insert((*name).clone(), value.clone());
                more
            })
        });
        all = extended.collect();
    }
    all
}
