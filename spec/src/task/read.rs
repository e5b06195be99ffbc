//! Decides, by `read_if`, whether anything reads a parameter in a variant, and looks up its readers in the task. A parameter
//! that nothing reads does not count in distances.

use std::borrow::Cow;
use std::sync::Arc;

use super::{Readers, TaskSpec, Variant};
use crate::value::Value;

impl TaskSpec {
    /// The readers of a parameter; no readers for an unknown name.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::TaskSpec;
    /// let text = r#"{ "name": "t", "parameters": {
    ///     "widest": { "role": "variant", "type": "number", "affects": ["S"], "range": [1, 90], "default": 45 },
    ///     "heading": { "role": "randomized", "type": "heading", "affects": ["S"],
    ///                  "distribution": { "uniform": { "low": 0, "high": { "param": "widest" } } } } },
    ///   "world": { "agent_params": { "heading": { "param": "heading" } } } }"#;
    /// let task = TaskSpec::from_json("inline", text)?;
    /// assert!(task.readers("heading").worlds && task.readers("widest").are_draws_alone());
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn readers(&self, parameter: &str) -> &Readers {
        static NO_READERS: Readers = Readers {
            worlds: false,
            draws: Vec::new(),
        };
        let readers = self.readers.get_or_init(|| self.document.readers());
        readers.get(parameter).unwrap_or(&NO_READERS)
    }
}

impl Variant {
    /// Whether anything reads a parameter in this variant: decided by its `read_if`, and true without one.
    pub fn reads(&self, parameter: &str) -> bool {
        let value_of = |name: &str| self.value(name).cloned();
        let condition = self.task().read_conditions.get(parameter);
        condition.is_none_or(|condition| condition.holds(value_of) != Some(false))
    }

    /// The variant with all parameters that nothing reads set to their defaults, unless this would make a distribution invalid.
    /// It may violate a requirement.
    #[must_use]
    pub fn as_read(&self) -> Self {
        let mut read = self.values().clone();
        for name in self.task().read_conditions.keys() {
            if let (Some(value), Some(place)) = (self.value_as_read(name), read.get_mut(name)) {
                *place = value.into_owned();
            }
        }
        if read == *self.values() {
            return self.clone();
        }
        let read = Self::new(Arc::clone(self.task()), self.name(), read);
        let is_drawn = |name: &String| read.distribution(name).is_none_or(|own| own.fault().is_none());
        if self.task().parameters().keys().all(is_drawn) {
            read
        } else {
            self.clone()
        }
    }

    /// The effective value of a fixed or variant parameter: the default if nothing reads it in this variant. `None` for a
    /// randomized or unknown parameter.
    pub fn value_as_read(&self, parameter: &str) -> Option<Cow<'_, Value>> {
        let value = self.value(parameter)?;
        if self.reads(parameter) {
            return Some(Cow::Borrowed(value));
        }
        let declared = self.task().parameters().get(parameter)?;
        let default = declared.default.as_ref().and_then(|default| declared.typed(default));
        Some(default.map_or(Cow::Borrowed(value), Cow::Owned))
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use crate::{TaskSpec, Value};

    fn text(read_if: &str) -> String {
        format!(
            r#"{{ "name": "t", "parameters": {{
            "trigger": {{ "role": "variant", "type": "string", "affects": ["T"], "choices": ["touch", "near"], "default": "touch" }},
            "reach": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [0, 9], "default": 1, "read_if": "{read_if}" }},
            "drawn": {{ "role": "randomized", "type": "number", "affects": ["T"],
                        "distribution": {{ "uniform": {{ "low": 0, "high": {{ "param": "high" }} }} }} }},
            "high": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [1, 9], "default": 1 }} }},
          "world": {{ "environment_params": {{ "light_intensity": {{ "param": "drawn" }} }} }},
          "variants": {{ "idle": {{ "reach": 5 }}, "near": {{ "trigger": "near", "reach": 5 }} }} }}"#
        )
    }

    #[test]
    fn parameter_that_nothing_reads_has_its_default() {
        let task = TaskSpec::from_json("t", &text("trigger == 'near'")).unwrap();
        let read = |variant: &str| {
            task.variant(variant)
                .unwrap()
                .value_as_read("reach")
                .map(Cow::into_owned)
        };
        assert_eq!(read("idle"), Some(Value::Number(1.0)));
        assert_eq!(read("near"), Some(Value::Number(5.0)));
        assert!(task.variant("near").unwrap().reads("reach") && !task.variant("idle").unwrap().reads("reach"));
    }

    #[test]
    fn readers_are_worlds_and_draws() {
        let task = TaskSpec::from_json("t", &text("trigger == 'near'")).unwrap();
        assert!(task.readers("high").are_draws_alone());
        assert_eq!(task.readers("high").draws, ["drawn"]);
        assert!(task.readers("drawn").worlds && !task.readers("reach").worlds);
    }

    #[test]
    fn read_if_may_not_name_randomized_parameters() {
        let error_for = |read_if: &str| {
            TaskSpec::from_json("t", &text(read_if)).map_or_else(|error| error.to_string(), |_| String::new())
        };
        assert_eq!(error_for("reach > 0 or trigger == 'near'"), "");
        for (wrong, expected) in [
            ("drawn > 1", "a fixed or variant parameter"),
            ("triger == 'near'", "trigger"),
            ("trigger ==", "/parameters/reach/read_if"),
            ("reach + 1", "found a number in \"reach + 1\", expected a condition"),
            ("trigger == 'neer'", "did you mean 'near'?"),
        ] {
            assert!(error_for(wrong).contains(expected), "{wrong}: {}", error_for(wrong));
        }
    }
}
