//! Splits a condition into tokens.

/// A piece of the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Text(String),
    Word(String),
    Symbol(&'static str),
    /// A character that has no meaning in conditions.
    Unknown(char),
    End,
}

impl Token {
    /// The token, for messages.
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Number(number) => format!("{number}"),
            Self::Text(text) => format!("'{text}'"),
            Self::Word(word) => format!("{word:?}"),
            Self::Symbol(symbol) => format!("{symbol:?}"),
            Self::Unknown(character) => format!("\"{character}\""),
            Self::End => "the end".to_owned(),
        }
    }
}

/// The symbols; each comes before its prefixes.
const SYMBOLS: [&str; 17] = [
    "<=", ">=", "==", "!=", "<", ">", "=", "+", "-", "*", "/", "%", "(", ")", "[", "]", ",",
];

/// The tokens of a text, each with the position of its first character, from 1.
pub(super) fn tokens(text: &str) -> Result<Vec<(usize, Token)>, String> {
    let characters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    while at < characters.len() {
        let start = at;
        let first = characters[at];
        let run = |from: usize, inside: fn(char) -> bool| {
            from + characters[from..]
                .iter()
                .take_while(|character| inside(**character))
                .count()
        };
        if first.is_whitespace() {
            at += 1;
            continue;
        }
        let token = if first == '\'' {
            let end = run(at + 1, |character| character != '\'');
            if end == characters.len() {
                return Err(format!(
                    "a closing ' for the text that begins at character {}",
                    start + 1
                ));
            }
            at = end + 1;
            Token::Text(characters[start + 1..end].iter().collect())
        } else if first.is_ascii_digit() || first == '.' {
            at = run(at, |character| character.is_ascii_alphanumeric() || character == '.');
            // An exponent may have a sign.
            if matches!(characters[at - 1], 'e' | 'E') && matches!(characters.get(at), Some('-' | '+')) {
                at = run(at + 1, |character| character.is_ascii_digit());
            }
            let word: String = characters[start..at].iter().collect();
            let number = word.parse().ok().filter(|number: &f64| number.is_finite());
            Token::Number(number.ok_or_else(|| format!("a number at character {}, found {word:?}", start + 1))?)
        } else if first.is_alphabetic() || first == '_' {
            at = run(at, |character| character.is_alphanumeric() || character == '_');
            Token::Word(characters[start..at].iter().collect())
        } else {
            let rest: String = characters[at..characters.len().min(at + 2)].iter().collect();
            let symbol = SYMBOLS.into_iter().find(|symbol| rest.starts_with(symbol));
            at += symbol.map_or(1, str::len);
            symbol.map_or(Token::Unknown(first), Token::Symbol)
        };
        tokens.push((start + 1, token));
    }
    tokens.push((characters.len() + 1, Token::End));
    Ok(tokens)
}
