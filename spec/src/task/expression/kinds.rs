//! Checks the types of a condition's parts without their values, and finds parts with incompatible types.

use super::{Binary, Body, Node, Operator, Requirement, Term, Unary};
use crate::Color;
use crate::error::first_of;
use crate::suggest::nearest;
use crate::task::parameter::{Parameter, Role};
use crate::value::{ParameterType, Value};

/// The type of a name.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::task) enum Kind {
    Number,
    Truth,
    /// A string, with all its possible values if they are known.
    Text(Option<Vec<String>>),
    Color,
    /// A list of this length, whose numbers have an index: `start[0]`. The word is its name in messages.
    List(&'static str, Option<usize>),
}

impl Kind {
    /// The type of a parameter; `None` for distributions, layouts and JSON.
    pub(in crate::task) fn of(parameter: &Parameter) -> Option<Self> {
        let texts = || {
            let choices = parameter.choices.as_ref().filter(|_| parameter.role == Role::Variant)?;
            Some(choices.iter().filter_map(Value::as_text).map(str::to_owned).collect())
        };
        match parameter.kind {
            ParameterType::Number | ParameterType::Integer | ParameterType::Heading => Some(Self::Number),
            ParameterType::Boolean => Some(Self::Truth),
            ParameterType::String => Some(Self::Text(texts())),
            ParameterType::Color => Some(Self::Color),
            ParameterType::Point => Some(Self::List("a point", Some(2))),
            ParameterType::Vector => Some(Self::List("a vector", parameter.vector_length())),
            ParameterType::Distribution | ParameterType::Layout | ParameterType::Json => None,
        }
    }

    fn describe(&self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Truth => "true or false",
            Self::Text(_) => "text",
            Self::Color => "a colour",
            Self::List(word, _) => word,
        }
    }

    /// Whether it is a colour, or a string that can only be the name of a colour.
    fn is_color(&self) -> bool {
        match self {
            Self::Color => true,
            Self::Text(Some(all)) => all.iter().all(|text| Color::from_name(text).is_some()),
            _ => false,
        }
    }
}

/// What was found and what was expected.
pub(in crate::task) type Misfit = (String, String);

impl Requirement {
    /// The first part that cannot be compared, or the whole if it is not a condition. `kind_of` returns the type of a name;
    /// names without a type are not checked.
    pub(in crate::task) fn misfit(&self, kind_of: impl Fn(&str) -> Option<Kind>) -> Option<Misfit> {
        let check = Check {
            names: &self.names,
            kind_of,
        };
        match check.kind(&self.root) {
            Err(misfit) => Some(misfit),
            Ok(None | Some(Kind::Truth)) => None,
            Ok(Some(other)) => {
                let found = check.shown(&self.root, &other);
                Some((found, "a condition, such as a comparison with < or ==".to_owned()))
            }
        }
    }
}

struct Check<'a, F> {
    names: &'a [String],
    kind_of: F,
}

impl<F: Fn(&str) -> Option<Kind>> Check<'_, F> {
    /// The type of a part; `None` if it contains an unknown name.
    fn kind(&self, node: &Node) -> Result<Option<Kind>, Misfit> {
        match node {
            Node::Constant(term) => Ok(Some(match term {
                Term::Number(_) => Kind::Number,
                Term::Truth(_) => Kind::Truth,
                Term::Text(text) => Kind::Text(Some(vec![text.clone()])),
                Term::Color(_) => Kind::Color,
            })),
            Node::Name(name, index) => self.named(&self.names[*name], *index),
            Node::Unary(Unary::Minus, inner) => {
                self.all(&[inner], "-", "a number after -", |kind| *kind == Kind::Number)?;
                Ok(Some(Kind::Number))
            }
            Node::Unary(Unary::Not, inner) => {
                self.all(&[inner], "not", "a condition after not", |kind| *kind == Kind::Truth)?;
                Ok(Some(Kind::Truth))
            }
            Node::Binary(operator, a, b) => self.binary(operator, a, b).map(Some),
            Node::Call((name, _, made), nodes) => {
                let nodes: Vec<&Node> = nodes.iter().collect();
                match made {
                    Body::Distance => {
                        let expected = "two colours, such as distance(good, 'red')";
                        self.all(&nodes, name, expected, Kind::is_color)?;
                    }
                    Body::OfNumbers(_) => {
                        self.all(&nodes, name, &format!("numbers in {name}"), |kind| {
                            *kind == Kind::Number
                        })?;
                    }
                }
                Ok(Some(Kind::Number))
            }
        }
    }

    fn named(&self, name: &str, index: Option<usize>) -> Result<Option<Kind>, Misfit> {
        let Some(kind) = (self.kind_of)(name) else {
            return Ok(None);
        };
        let numbers = match &kind {
            Kind::List(_, numbers) => *numbers,
            Kind::Color => Some(3),
            _ => Some(0),
        };
        match (index, &kind, numbers) {
            (None, Kind::List(word, _), _) => Err((
                format!("{name} ({word})"),
                format!("one of its numbers, such as {name}[0]"),
            )),
            (None, _, _) => Ok(Some(kind)),
            (Some(_), _, Some(0)) => {
                let found = format!("an index of {name} ({})", kind.describe());
                Err((found, format!("{name} without an index")))
            }
            (Some(index), _, Some(numbers)) if index >= numbers => Err((
                format!("{name}[{index}]"),
                format!("an index from 0 to {}", numbers - 1),
            )),
            (Some(_), _, _) => Ok(Some(Kind::Number)),
        }
    }

    fn binary(&self, (symbol, _, operator): &Binary, a: &Node, b: &Node) -> Result<Kind, Misfit> {
        let both_are = |wanted: &Kind, word: &str| {
            let expected = format!("{word} on both sides of {symbol}");
            self.all(&[a, b], symbol, &expected, |kind| kind == wanted)
        };
        match operator {
            Operator::Join(_) => both_are(&Kind::Truth, "conditions")?,
            Operator::Compare(_) => both_are(&Kind::Number, "numbers")?,
            Operator::Calculate(_) => return both_are(&Kind::Number, "numbers").map(|()| Kind::Number),
            Operator::Equal(_) => {
                if let (Some(first), Some(second)) = (self.kind(a)?, self.kind(b)?) {
                    self.comparable((a, &first), (b, &second), symbol)?;
                }
            }
        }
        Ok(Kind::Truth)
    }

    /// Checks that two parts can be equal: of one type, a colour and a colour's name, or a string and one of its choices.
    fn comparable(&self, a: (&Node, &Kind), b: (&Node, &Kind), symbol: &str) -> Result<(), Misfit> {
        match (a.1, b.1) {
            (Kind::Text(Some(first)), Kind::Text(Some(second))) => {
                self.is_choice(a.0, (b.0, second))?;
                self.is_choice(b.0, (a.0, first))
            }
            (Kind::Number, Kind::Number) | (Kind::Truth, Kind::Truth) | (Kind::Text(_), Kind::Text(_)) => Ok(()),
            (Kind::Color, other) | (other, Kind::Color) if other.is_color() => Ok(()),
            (Kind::Color, Kind::Text(_)) | (Kind::Text(_), Kind::Color) => {
                let (text, kind) = if *a.1 == Kind::Color { b } else { a };
                let expected = format!("a colour or the CSS name of one next to {symbol}, such as 'red'");
                Err((self.shown(text, kind), expected))
            }
            _ => {
                let found = format!("{} {symbol} {}", self.shown(a.0, a.1), self.shown(b.0, b.1));
                let expected = format!("two numbers, texts, colours or truth values on both sides of {symbol}");
                Err((found, expected))
            }
        }
    }

    /// Rejects a quoted string that is not among a name's possible values.
    fn is_choice(&self, text: &Node, (other, all): (&Node, &[String])) -> Result<(), Misfit> {
        let (Node::Constant(Term::Text(text)), Node::Name(name, _)) = (text, other) else {
            return Ok(());
        };
        if all.contains(text) {
            return Ok(());
        }
        let name = &self.names[*name];
        let suggestion = nearest(text, all.iter());
        let suggestion = suggestion.map_or_else(String::new, |near| format!(" (did you mean '{near}'?)"));
        let quoted: Vec<String> = all.iter().map(|choice| format!("'{choice}'")).collect();
        let expected = format!("one of the choices of {name}: {}{suggestion}", first_of(&quoted));
        Err((format!("'{text}' next to {name}"), expected))
    }

    /// Succeeds if all parts fit; otherwise the error names the first that does not.
    fn all(&self, nodes: &[&Node], symbol: &str, expected: &str, fits: impl Fn(&Kind) -> bool) -> Result<(), Misfit> {
        for node in nodes {
            let Some(kind) = self.kind(node)? else { continue };
            if !fits(&kind) {
                return Err((
                    format!("{} next to {symbol}", self.shown(node, &kind)),
                    expected.to_owned(),
                ));
            }
        }
        Ok(())
    }

    /// A part, for messages.
    fn shown(&self, node: &Node, kind: &Kind) -> String {
        match node {
            Node::Constant(Term::Text(text)) => format!("'{text}'"),
            Node::Constant(Term::Number(number)) => format!("{number}"),
            Node::Constant(Term::Truth(truth)) => format!("{truth}"),
            Node::Name(name, None) => format!("{} ({})", self.names[*name], kind.describe()),
            Node::Name(name, Some(index)) => format!("{}[{index}] ({})", self.names[*name], kind.describe()),
            _ => kind.describe().to_owned(),
        }
    }
}
