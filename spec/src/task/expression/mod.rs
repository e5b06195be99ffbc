//! [`Requirement`]: parses and evaluates a task's conditions over parameters.
//!
//! Implemented here because existing crates do not fit (docs/decisions/0005-requirements.md): this parser needs memory only in
//! proportion to the text, cannot loop, and reports the character at which a text is wrong.

mod kinds;
mod token;

use std::fmt;

use crate::Color;
use crate::value::Value;
pub(super) use kinds::Kind;
use token::{Token, tokens};

/// Maximum length of a condition in characters.
const MAX_CHARACTERS: usize = 500;

/// Maximum nesting depth of brackets and signs.
const MAX_DEPTH: usize = 32;

/// A condition over parameters, such as `min_size < max_size and (count <= 5 or light >= 1)`.
///
/// It consists of numbers, `true`, `false`, strings in single quotes, parameters of type number, integer, heading, boolean,
/// string or color, `name[0]` of a vector or point, `+ - * / %`, `min(a, b, …)`, `max(a, b, …)`, `abs(a)`, `< <= > >= == !=`,
/// `and`, `or`, `not` and brackets. Colours can only be tested for equality, with each other and with CSS names in quotes;
/// `distance(a, b)` is the distance between two colours in Oklab ([`Color::distance`](crate::Color::distance)). A condition
/// cannot loop, and does no I/O.
#[derive(Clone, Debug)]
pub struct Requirement {
    text: String,
    /// The parameters that it names, without duplicates, in the order of the text.
    names: Vec<String>,
    root: Node,
}

/// The value of an expression.
#[derive(Clone, Debug, PartialEq)]
enum Term {
    Number(f64),
    Truth(bool),
    Text(String),
    Color(Color),
}

impl Term {
    /// The colour that it is or names.
    fn color(&self) -> Option<Color> {
        match self {
            Self::Color(color) => Some(*color),
            Self::Text(name) => Color::from_name(name),
            _ => None,
        }
    }
}

#[derive(Clone, Debug)]
enum Node {
    Constant(Term),
    /// The value of a name, or one of its components.
    Name(usize, Option<usize>),
    Unary(Unary, Box<Node>),
    Binary(&'static Binary, Box<Node>, Box<Node>),
    Call(&'static Function, Vec<Node>),
}

#[derive(Clone, Copy, Debug)]
enum Unary {
    Minus,
    Not,
}

/// The operation of a binary operator.
#[derive(Clone, Copy, Debug)]
enum Operator {
    /// Combines conditions.
    Join(fn(bool, bool) -> bool),
    /// Compares numbers.
    Compare(fn(f64, f64) -> bool),
    /// Tests two values of one type for equality (`true`) or inequality (`false`).
    Equal(bool),
    /// Arithmetic.
    Calculate(fn(f64, f64) -> f64),
}

/// Symbol, precedence and operation of an operator.
type Binary = (&'static str, u8, Operator);

/// The operators.
static BINARY: [Binary; 13] = [
    ("or", 1, Operator::Join(|a, b| a || b)),
    ("and", 2, Operator::Join(|a, b| a && b)),
    ("<", COMPARISON, Operator::Compare(|a, b| a < b)),
    ("<=", COMPARISON, Operator::Compare(|a, b| a <= b)),
    (">", COMPARISON, Operator::Compare(|a, b| a > b)),
    (">=", COMPARISON, Operator::Compare(|a, b| a >= b)),
    ("==", COMPARISON, Operator::Equal(true)),
    ("!=", COMPARISON, Operator::Equal(false)),
    ("+", 5, Operator::Calculate(|a, b| a + b)),
    ("-", 5, Operator::Calculate(|a, b| a - b)),
    ("*", 6, Operator::Calculate(|a, b| a * b)),
    ("/", 6, Operator::Calculate(|a, b| a / b)),
    ("%", 6, Operator::Calculate(|a, b| a % b)),
];

/// The operation of a function.
#[derive(Clone, Copy, Debug)]
enum Body {
    OfNumbers(fn(&[f64]) -> f64),
    /// The distance between two colours.
    Distance,
}

/// A function: its name, its number of arguments, both as a number and in words (`None` for any number), and its operation.
type Function = (&'static str, Option<(usize, &'static str)>, Body);

/// The functions.
static FUNCTIONS: [Function; 4] = [
    (
        "min",
        None,
        Body::OfNumbers(|all| all.iter().copied().fold(f64::INFINITY, f64::min)),
    ),
    (
        "max",
        None,
        Body::OfNumbers(|all| all.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
    ),
    // The parser guarantees exactly one value.
    ("abs", Some((1, "one value")), Body::OfNumbers(|all| all[0].abs())),
    ("distance", Some((2, "two colours")), Body::Distance),
];

/// Precedence of `not`: lower than the precedence of a comparison.
const NOT: u8 = 3;
/// Precedence of comparisons; they do not chain.
const COMPARISON: u8 = 4;
/// Precedence of a sign.
const SIGN: u8 = 7;

impl Requirement {
    /// Parses a condition; the error says what was expected, where, and what was found.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        if text.chars().count() > MAX_CHARACTERS {
            return Err(format!("at most {MAX_CHARACTERS} characters"));
        }
        let mut parser = Parser {
            tokens: tokens(text)?,
            next: 0,
            names: Vec::new(),
        };
        let root = parser.expression(0, 0)?;
        match parser.peek() {
            (_, Token::End) => Ok(Self {
                text: text.to_owned(),
                names: parser.names,
                root,
            }),
            (at, Token::Symbol("=")) => Err(format!("\"==\" at character {at}, found \"=\"")),
            (at, token) => Err(format!(
                "an operator or the end at character {at}, found {}",
                token.describe()
            )),
        }
    }

    /// The condition as its author wrote it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The parameters that it names, without duplicates, in the order of the text.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Whether it holds for the given values; `None` if a value is missing, or an operator is undefined for its operands.
    pub fn holds(&self, value_of: impl Fn(&str) -> Option<Value>) -> Option<bool> {
        let values = self
            .names()
            .iter()
            .map(|name| value_of(name))
            .collect::<Option<Vec<_>>>()?;
        match self.root.evaluate(&values)? {
            Term::Truth(truth) => Some(truth),
            Term::Number(_) | Term::Text(_) | Term::Color(_) => None,
        }
    }

    /// The values of its parameters, for messages: `a = 1, b = 2`.
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

impl Node {
    fn evaluate(&self, values: &[Value]) -> Option<Term> {
        match self {
            Self::Constant(term) => Some(term.clone()),
            Self::Name(name, index) => match values.get(*name)?.at(*index)? {
                Value::Boolean(truth) => Some(Term::Truth(truth)),
                Value::Text(text) => Some(Term::Text(text)),
                Value::Color(color) => Some(Term::Color(color)),
                other => other.as_number().map(Term::Number),
            },
            Self::Unary(operator, node) => match (operator, node.evaluate(values)?) {
                (Unary::Minus, Term::Number(number)) => Some(Term::Number(-number)),
                (Unary::Not, Term::Truth(truth)) => Some(Term::Truth(!truth)),
                _ => None,
            },
            Self::Binary((_, _, operator), a, b) => operator.apply(&a.evaluate(values)?, &b.evaluate(values)?),
            Self::Call((_, _, Body::Distance), nodes) => {
                let color = |node: &Self| node.evaluate(values)?.color();
                let (a, b) = (color(nodes.first()?)?, color(nodes.get(1)?)?);
                Some(Term::Number(a.distance(b)))
            }
            Self::Call((_, _, Body::OfNumbers(of)), nodes) => {
                let number = |node: &Self| match node.evaluate(values)? {
                    Term::Number(number) => Some(number),
                    _ => None,
                };
                let numbers = nodes.iter().map(number).collect::<Option<Vec<f64>>>()?;
                Some(Term::Number(of(&numbers)))
            }
        }
    }
}

impl Operator {
    fn apply(self, a: &Term, b: &Term) -> Option<Term> {
        Some(match (self, a, b) {
            (Self::Join(of), Term::Truth(a), Term::Truth(b)) => Term::Truth(of(*a, *b)),
            (Self::Compare(of), Term::Number(a), Term::Number(b)) => Term::Truth(of(*a, *b)),
            (Self::Calculate(of), Term::Number(a), Term::Number(b)) => Term::Number(of(*a, *b)),
            (Self::Equal(wanted), Term::Color(_), _) | (Self::Equal(wanted), _, Term::Color(_)) => {
                Term::Truth((a.color()? == b.color()?) == wanted)
            }
            (Self::Equal(wanted), Term::Number(_), Term::Number(_))
            | (Self::Equal(wanted), Term::Truth(_), Term::Truth(_))
            | (Self::Equal(wanted), Term::Text(_), Term::Text(_)) => Term::Truth((a == b) == wanted),
            _ => return None,
        })
    }
}

/// The operator of a token.
fn binary(token: &Token) -> Option<&'static Binary> {
    let symbol = match token {
        Token::Symbol(symbol) => *symbol,
        Token::Word(word) => word.as_str(),
        _ => return None,
    };
    BINARY.iter().find(|(known, ..)| *known == symbol)
}

struct Parser {
    tokens: Vec<(usize, Token)>,
    next: usize,
    names: Vec<String>,
}

impl Parser {
    fn peek(&self) -> (usize, &Token) {
        // The last token is `End`, and the parser never reads beyond it.
        let (at, token) = &self.tokens[self.next];
        (*at, token)
    }

    fn take(&mut self) -> (usize, Token) {
        let taken = self.tokens[self.next].clone();
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        taken
    }

    fn expect(&mut self, symbol: &'static str) -> Result<(), String> {
        match self.take() {
            (_, Token::Symbol(found)) if found == symbol => Ok(()),
            (at, token) => Err(format!("{symbol:?} at character {at}, found {}", token.describe())),
        }
    }

    /// An expression with operators that all bind tighter than `floor` (precedence climbing).
    fn expression(&mut self, floor: u8, depth: usize) -> Result<Node, String> {
        if depth > MAX_DEPTH {
            return Err(format!("at most {MAX_DEPTH} nested brackets or signs"));
        }
        let mut left = self.operand(depth)?;
        while let Some(operator @ &(_, binding, _)) = binary(self.peek().1) {
            if binding <= floor {
                if binding == COMPARISON && floor == COMPARISON {
                    let (at, token) = self.peek();
                    let found = token.describe();
                    return Err(format!(
                        "\"and\" or \"or\" between comparisons at character {at}, found {found}"
                    ));
                }
                break;
            }
            self.take();
            let right = self.expression(binding, depth + 1)?;
            left = Node::Binary(operator, Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    fn operand(&mut self, depth: usize) -> Result<Node, String> {
        let (at, token) = self.take();
        match token {
            Token::Number(number) => Ok(Node::Constant(Term::Number(number))),
            Token::Text(text) => Ok(Node::Constant(Term::Text(text))),
            Token::Symbol("-") => Ok(Node::Unary(Unary::Minus, Box::new(self.expression(SIGN, depth + 1)?))),
            Token::Symbol("(") => {
                let inner = self.expression(0, depth + 1)?;
                self.expect(")")?;
                Ok(inner)
            }
            Token::Word(word) => self.word(at, word, depth),
            other => Err(format!(
                "a number, a name or a bracket at character {at}, found {}",
                other.describe()
            )),
        }
    }

    fn word(&mut self, at: usize, word: String, depth: usize) -> Result<Node, String> {
        match word.as_str() {
            "true" => return Ok(Node::Constant(Term::Truth(true))),
            "false" => return Ok(Node::Constant(Term::Truth(false))),
            "not" => return Ok(Node::Unary(Unary::Not, Box::new(self.expression(NOT, depth + 1)?))),
            "and" | "or" => {
                return Err(format!(
                    "a number, a name or a bracket at character {at}, found {word:?}"
                ));
            }
            _ => {}
        }
        if *self.peek().1 == Token::Symbol("(") {
            return self.call(at, &word, depth);
        }
        let name = self.names.iter().position(|name| *name == word).unwrap_or_else(|| {
            self.names.push(word);
            self.names.len() - 1
        });
        if *self.peek().1 != Token::Symbol("[") {
            return Ok(Node::Name(name, None));
        }
        self.take();
        let index = match self.take() {
            (_, Token::Number(number)) if number.fract() == 0.0 && number < 100.0 => number as usize,
            (at, token) => return Err(format!("an index from 0 at character {at}, found {}", token.describe())),
        };
        self.expect("]")?;
        Ok(Node::Name(name, Some(index)))
    }

    fn call(&mut self, at: usize, word: &str, depth: usize) -> Result<Node, String> {
        let Some(function @ (name, arity, _)) = FUNCTIONS.iter().find(|(name, ..)| *name == word) else {
            return Err(format!(
                "one of min, max, abs, distance at character {at}, found the function {word:?}"
            ));
        };
        self.expect("(")?;
        let mut nodes = vec![self.expression(0, depth + 1)?];
        while *self.peek().1 == Token::Symbol(",") {
            self.take();
            nodes.push(self.expression(0, depth + 1)?);
        }
        self.expect(")")?;
        if let Some((_, wanted)) = arity.filter(|(count, _)| *count != nodes.len()) {
            return Err(format!("{wanted} for {name} at character {at}, found {}", nodes.len()));
        }
        Ok(Node::Call(function, nodes))
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
    fn conditions_compare_calculate_and_combine() {
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
    fn undefined_or_missing_value_gives_none() {
        check("a + b", None);
        check("order < 3", None);
        check("day and a", None);
        check("missing > 1", None);
        check("start == 3", None);
        check("start[2] == 3", None);
    }

    #[track_caller]
    fn check_error(text: &str, expected: &str) {
        assert_eq!(Requirement::parse(text).unwrap_err(), expected, "{text}");
    }

    #[test]
    fn syntax_error_reports_its_character() {
        check_error("", "a number, a name or a bracket at character 1, found the end");
        check_error("a <", "a number, a name or a bracket at character 4, found the end");
        check_error("((a)", "\")\" at character 5, found the end");
        check_error("a ; b", "an operator or the end at character 3, found \";\"");
        check_error("a b", "an operator or the end at character 3, found \"b\"");
        check_error("'open", "a closing ' for the text that begins at character 1");
        check_error(
            "fact(3) > 1",
            "one of min, max, abs, distance at character 1, found the function \"fact\"",
        );
        check_error("abs(1, 2) > 1", "one value for abs at character 1, found 2");
        check_error("distance(a) > 1", "two colours for distance at character 1, found 1");
        check_error("a & b", "an operator or the end at character 3, found \"&\"");
        check_error(
            "a < b < 3",
            "\"and\" or \"or\" between comparisons at character 7, found \"<\"",
        );
        check_error("a = 3", "\"==\" at character 3, found \"=\"");
    }

    #[test]
    fn hostile_text_is_refused() {
        check_error(&"(".repeat(400), "at most 32 nested brackets or signs");
        check_error(&"-".repeat(400), "at most 32 nested brackets or signs");
        check_error(&"not ".repeat(100), "at most 32 nested brackets or signs");
        check_error(&"a + ".repeat(10_000), "at most 500 characters");
    }
}
