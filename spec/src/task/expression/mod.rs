//! The grammar of conditions: reading and evaluating expressions. What they are for is said in `require.rs`.
//!
//! Written here because the crates at hand do not serve (docs/decisions/0005-requirements.md): this one needs no memory beyond
//! its text, cannot loop, and says at which character a text goes wrong.

mod kinds;
mod token;

use crate::Color;
use crate::value::Value;
pub(super) use kinds::{Kind, Misfit};
use token::{Token, tokens};

/// The longest text, in characters.
const MAX_CHARACTERS: usize = 500;

/// The most brackets and signs that may stand inside each other.
const MAX_DEPTH: usize = 32;

/// An expression over named values.
#[derive(Clone, Debug)]
pub(super) struct Expression {
    /// The names, each once, in the order of the text.
    pub(super) names: Vec<String>,
    root: Node,
}

/// What an expression comes to.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Term {
    Number(f64),
    Truth(bool),
    Text(String),
    Color(Color),
}

impl Term {
    /// The colour that it is, or that CSS gives its name to.
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
    /// The value of a name, or the number at a place of it.
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

/// What an operator between two parts does.
#[derive(Clone, Copy, Debug)]
enum Operator {
    /// Joins conditions.
    Join(fn(bool, bool) -> bool),
    /// Compares numbers.
    Compare(fn(f64, f64) -> bool),
    /// Whether two things of one kind are equal, or are not.
    Equal(bool),
    /// Calculates.
    Calculate(fn(f64, f64) -> f64),
}

/// The symbol of an operator, how tightly it binds, and what it does.
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

/// What a function makes of its values.
#[derive(Clone, Copy, Debug)]
enum Made {
    OfNumbers(fn(&[f64]) -> f64),
    /// How far two colours are apart.
    Distance,
}

/// The name of a function, how many values it takes where that is not any number of them, in words too, and what it makes of them.
type Function = (&'static str, Option<(usize, &'static str)>, Made);

/// The functions.
static FUNCTIONS: [Function; 4] = [
    (
        "min",
        None,
        Made::OfNumbers(|all| all.iter().copied().fold(f64::INFINITY, f64::min)),
    ),
    (
        "max",
        None,
        Made::OfNumbers(|all| all.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
    ),
    ("abs", Some((1, "one value")), Made::OfNumbers(|all| all[0].abs())),
    ("distance", Some((2, "two colours")), Made::Distance),
];

/// How tightly `not` binds: looser than a comparison.
const NOT: u8 = 3;
/// How tightly comparisons bind; they do not chain.
const COMPARISON: u8 = 4;
/// How tightly a sign binds.
const SIGN: u8 = 7;

impl Expression {
    /// Reads an expression; else what was expected, where, and what was found.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
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

    /// The value, given those of [`Expression::names`]; `None` where an operator has no meaning for its operands.
    pub(super) fn evaluate(&self, values: &[Value]) -> Option<Term> {
        self.root.evaluate(values)
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
            Self::Call((_, _, Made::Distance), nodes) => {
                let color = |node: &Self| node.evaluate(values)?.color();
                let (a, b) = (color(nodes.first()?)?, color(nodes.get(1)?)?);
                Some(Term::Number(a.distance(b)))
            }
            Self::Call((_, _, Made::OfNumbers(of)), nodes) => {
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

/// The operator that a token is.
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
        // The last token is the end, and nothing goes beyond it.
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

    /// An expression whose operators all bind tighter than `floor` (precedence climbing).
    fn expression(&mut self, floor: u8, depth: usize) -> Result<Node, String> {
        if depth > MAX_DEPTH {
            return Err(format!("at most {MAX_DEPTH} brackets or signs inside each other"));
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
