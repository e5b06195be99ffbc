//! [`Requirement`]: a condition over parameters that a task states. Its grammar is read in `expression.rs`.

use std::fmt;

use super::expression::{Expression, Kind, Misfit, Term};
use crate::value::Value;

/// A condition over parameters, such as `min_size < max_size and (count <= 5 or light >= 1)`.
///
/// Numbers, `true`, `false`, texts in single quotes, and parameters of type number, integer, heading, boolean, string or color, or
/// `name[0]` of a vector or point; `+ - * / %`, `min(a, b, …)`, `max(a, b, …)`, `abs(a)`, `< <= > >= == !=`, `and`, `or`,
/// `not` and brackets. Colours are equal or not, to each other and to CSS names in quotes, and `distance(a, b)` is how far two are
/// apart in Oklab ([`Color::distance`](crate::Color::distance)). It can neither loop nor read or write anything.
#[derive(Clone, Debug)]
pub struct Requirement {
    text: String,
    expression: Expression,
}

impl Requirement {
    /// Reads a condition; else what is wrong with its text.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        Ok(Self {
            text: text.to_owned(),
            expression: Expression::parse(text)?,
        })
    }

    /// The condition as its author wrote it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The parameters that it speaks of, each once, in the order of the text.
    pub fn names(&self) -> &[String] {
        &self.expression.names
    }

    /// Where it compares what cannot be compared, or is no condition: what was found and expected. `kind_of`: what a name stands for.
    pub(super) fn misfit(&self, kind_of: impl Fn(&str) -> Option<Kind>) -> Option<Misfit> {
        self.expression.misfit(kind_of)
    }

    /// Whether it holds for the given values; `None` where a value is missing, or an operator has no meaning for its operands.
    pub fn holds(&self, value_of: impl Fn(&str) -> Option<Value>) -> Option<bool> {
        let values = self
            .names()
            .iter()
            .map(|name| value_of(name))
            .collect::<Option<Vec<_>>>()?;
        match self.expression.evaluate(&values)? {
            Term::Truth(truth) => Some(truth),
            Term::Number(_) | Term::Text(_) | Term::Color(_) => None,
        }
    }

    /// The values that it speaks of, as messages show them: `a = 1, b = 2`.
    pub fn describe(&self, value_of: impl Fn(&str) -> Option<Value>) -> String {
        let shown = self.names().iter().map(|name| {
            let value = value_of(name).map_or_else(|| "?".to_owned(), |value| value.to_string());
            format!("{name} = {value}")
        });
        let shown = shown.collect::<Vec<_>>().join(", ");
        if shown.is_empty() {
            return format!("{}, which names no parameter", self.text);
        }
        shown
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, expected: Option<bool>) {
        let requirement = Requirement::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let found = requirement.holds(|name| match name {
            "a" => Some(Value::Number(2.0)),
            "b" => Some(Value::Integer(5)),
            "day" => Some(Value::Boolean(true)),
            "order" => Some(Value::Text("random".into())),
            "start" => Some(Value::Point([3.0, 4.0])),
            "good" => Some(Value::Color(crate::Color([1.0, 0.0, 0.0]))),
            "bad" => Some(Value::Color(crate::Color([0.0, 0.0, 1.0]))),
            _ => None,
        });
        assert_eq!(found, expected, "{text}");
    }

    #[test]
    fn conditions_compare_calculate_and_join() {
        check("a < b", Some(true));
        check("a + 3 == b and not (b > 10)", Some(true));
        check("min(a, max(b, 7), 3) * 2 >= max(a, 4) or false", Some(true));
        check("abs(a - b) % 2 == 1 and day", Some(true));
        check("-a < 0", Some(true));
        check("order == 'random'", Some(true));
        check("order != 'random' or not day", Some(false));
        check("a - b - 1 == -4", Some(true));
        check("1 + 2 * 3 == 7 and 2 * 3 + 1 == 7 and 8 / 2 / 2 == 2", Some(true));
        check("a < b and b < 4 or day", Some(true));
        check("day or day and false", Some(true));
        check("start[1] >= 4 and start[0] == 3.0e0", Some(true));
        check("not a < b", Some(false));
    }

    #[test]
    fn colours_are_compared_with_each_other_and_with_names() {
        check("good != bad and good == 'red' and 'blue' == bad", Some(true));
        check("good == bad or good != 'red'", Some(false));
        check("distance(good, bad) > 0.5 and distance(good, 'red') == 0", Some(true));
        check(
            "distance('black', 'white') > 0.999 and distance('black', 'white') < 1.001",
            Some(true),
        );
        check("distance(good, bad) == distance(bad, good)", Some(true));
        check("good < bad", None);
        check("good == 'rde'", None);
        check("good == 3", None);
        check("distance(good, 3) < 1", None);
        check("distance(order, 'red') < 1", None);
        check("good", None);
    }

    #[test]
    fn what_has_no_meaning_or_no_value_holds_neither_way() {
        check("a + b", None);
        check("order < 3", None);
        check("day and a", None);
        check("missing > 1", None);
        check("start == 3", None);
        check("start[2] == 3", None);
    }

    #[track_caller]
    fn refused(text: &str, expected: &str) {
        assert_eq!(Requirement::parse(text).unwrap_err(), expected, "{text}");
    }

    #[test]
    fn a_text_that_is_no_condition_is_refused_at_the_character_at_fault() {
        refused("", "a number, a name or a bracket at character 1, found the end");
        refused("a <", "a number, a name or a bracket at character 4, found the end");
        refused("((a)", "\")\" at character 5, found the end");
        refused("a ; b", "an operator or the end at character 3, found \";\"");
        refused("a b", "an operator or the end at character 3, found \"b\"");
        refused("'open", "a closing ' for the text that begins at character 1");
        refused(
            "fact(3) > 1",
            "one of min, max, abs, distance at character 1, found the function \"fact\"",
        );
        refused("abs(1, 2) > 1", "one value for abs at character 1, found 2");
        refused("distance(a) > 1", "two colours for distance at character 1, found 1");
        refused("a & b", "an operator or the end at character 3, found \"&\"");
        refused(
            "a < b < 3",
            "\"and\" or \"or\" between comparisons at character 7, found \"<\"",
        );
        refused("a = 3", "\"==\" at character 3, found \"=\"");
    }

    #[test]
    fn hostile_texts_are_refused_and_harm_nothing() {
        refused(&"(".repeat(400), "at most 32 brackets or signs inside each other");
        refused(&"-".repeat(400), "at most 32 brackets or signs inside each other");
        refused(&"not ".repeat(100), "at most 32 brackets or signs inside each other");
        refused(&"a + ".repeat(10_000), "at most 500 characters");
    }
}
