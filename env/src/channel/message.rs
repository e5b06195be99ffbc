//! One message: read leniently, written strictly. What it asks for is done in `exchange.rs`.

use driftworld_spec::nearest;
use serde_json::{Map, Value, json};

use super::Channel;

/// The longest message that is read, in bytes: as long as the longest document.
pub const MAX_MESSAGE_BYTES: usize = driftworld_spec::MAX_BYTES;

/// The longest token, in characters; a UUID has 36.
const LONGEST_TOKEN: usize = 100;

/// The token of no message.
const NO_TOKEN: &str = "00000000-0000-0000-0000-000000000000";

/// The most texts in the payload of one error.
const MOST_TEXTS: usize = 20;

/// A message to the client.
#[derive(Clone, Debug, PartialEq)]
pub struct Outgoing {
    /// Where it goes.
    pub channel: Channel,
    /// What it says: `ok`, `error`, `state`, `debug_message`, …
    pub action: &'static str,
    /// What belongs to it, if anything.
    pub payload: Option<Value>,
    /// Its own token, in the form of a UUID.
    pub token: String,
    /// The token of the message that it answers, if it answers one that had one.
    pub req_token: Option<String>,
    /// When it was made, by the time that the caller gave.
    pub time: String,
}

impl Outgoing {
    /// The message as one line of JSON, with every key: clients of the original index them without asking.
    ///
    /// What answers nobody has a `req_token` of zeros, what has no payload one that is `null`.
    pub fn to_json(&self) -> String {
        json!({
            "token": self.token,
            "req_token": self.req_token.as_deref().unwrap_or(NO_TOKEN),
            "msg_time": self.time,
            "action": self.action,
            "payload": self.payload,
        })
        .to_string()
    }
}

/// Why a message is refused: texts for the payload of the `error` that answers it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal(Vec<String>);

impl Refusal {
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self(vec![text.into()])
    }

    /// All problems of a payload; their places in the text are those of our own copy, and are left out.
    pub(super) fn of_document(error: &driftworld_spec::SpecError) -> Self {
        let problems = error.problems();
        if problems.is_empty() {
            return Self::new(error.to_string());
        }
        let mut texts: Vec<String> = problems
            .iter()
            .take(MOST_TEXTS)
            .map(|problem| {
                let mut problem = problem.clone();
                (problem.line, problem.column) = (0, 0);
                format!("payload {problem}")
            })
            .collect();
        if problems.len() > MOST_TEXTS {
            let at_least = if error.has_more() { "at least " } else { "" };
            let more = problems.len() - MOST_TEXTS;
            texts.push(format!("payload: and {at_least}{more} more"));
        }
        Self(texts)
    }

    pub(super) fn texts(&self) -> &[String] {
        &self.0
    }
}

/// A message from the client. What it may leave out, and keys that nobody knows, do no harm.
#[derive(Clone, Debug)]
pub(super) struct Message {
    pub(super) token: Option<String>,
    pub(super) action: String,
    /// `null` is as if it were not there.
    pub(super) payload: Option<Value>,
    /// Everything, for what some clients put beside `action`.
    pub(super) all: Map<String, Value>,
}

impl Message {
    /// Reads a message. With the refusal comes the token, where there was one to be read.
    pub(super) fn parse(text: &str) -> Result<Self, (Option<String>, Refusal)> {
        let refuse = |text: String| Err((None, Refusal::new(text)));
        if text.len() > MAX_MESSAGE_BYTES {
            return refuse(format!(
                "message: found {} bytes, expected at most {MAX_MESSAGE_BYTES}",
                text.len()
            ));
        }
        let mut all = match serde_json::from_str(text.trim_start_matches('\u{feff}')) {
            Ok(Value::Object(all)) => all,
            Ok(other) => {
                return refuse(format!(
                    "message: found {}, expected an object with an action",
                    kind(&other)
                ));
            }
            Err(error) => return refuse(format!("message: not valid JSON: {error}")),
        };
        let token = match all.get("token") {
            None | Some(Value::Null) => None,
            Some(Value::String(token)) if token.chars().count() <= LONGEST_TOKEN => Some(token.clone()),
            Some(Value::String(_)) => {
                return refuse(format!(
                    "token: found a longer text, expected at most {LONGEST_TOKEN} characters"
                ));
            }
            Some(other) => return refuse(format!("token: found {}, expected a text such as a UUID", kind(other))),
        };
        let refuse = |text: String| Err((token.clone(), Refusal::new(text)));
        // The original's client tells the time without a zone; nothing depends on it.
        if let Some(time) = all.get("msg_time").filter(|time| !time.is_string() && !time.is_null()) {
            return refuse(format!("msg_time: found {}, expected a text in ISO 8601", kind(time)));
        }
        let action = match all.get("action") {
            Some(Value::String(action)) => action.trim().to_lowercase(),
            Some(other) => return refuse(format!("action: found {}, expected a text", kind(other))),
            None => return refuse("message: found no action, expected one".to_owned()),
        };
        let payload = all.remove("payload").filter(|payload| !payload.is_null());
        Ok(Self {
            token,
            action,
            payload,
            all,
        })
    }

    /// The payload, or the refusal of a message that cannot do without.
    pub(super) fn payload(&self, expected: &str) -> Result<&Value, Refusal> {
        let missing = || Refusal::new(format!("payload: found none, expected {expected}"));
        self.payload.as_ref().ok_or_else(missing)
    }
}

/// The refusal of a word that is not among those known.
pub(super) fn unknown(what: &str, word: &str, known: &[&str]) -> Refusal {
    let short: String = word.chars().take(60).collect();
    let near = nearest(&short, known).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    Refusal::new(format!(
        "{what}: found {short:?}, expected one of {}{near}",
        known.join(", ")
    ))
}

/// What kind of value it is.
pub(super) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let (_, refusal) = Message::parse(text).expect_err("the message cannot be read");
        assert!(refusal.texts()[0].contains(expected), "{refusal:?}");
    }

    #[test]
    fn what_clients_leave_out_is_not_missed() {
        let message = Message::parse(
            "\u{feff}{ \"action\": \" Get_Observers\", \"msg_time\": \"2020-03-01T12:00:00.123\", \"payload\": null }",
        )
        .expect("the message is as clients send them");
        assert_eq!((message.action.as_str(), message.token), ("get_observers", None));
        assert_eq!(message.payload, None);
    }

    #[test]
    fn what_is_no_message_is_refused() {
        check("", "not valid JSON");
        check("[1]", "found a list, expected an object");
        check("{}", "found no action");
        check(r#"{ "action": 3 }"#, "action: found a number");
        check(r#"{ "action": "x", "token": {} }"#, "token: found an object");
        check(r#"{ "action": "x", "msg_time": 5 }"#, "msg_time: found a number");
        check(
            &format!(r#"{{ "action": "x", "token": "{}" }}"#, "t".repeat(101)),
            "at most 100",
        );
        check(&"[".repeat(100_000), "not valid JSON");
    }

    #[test]
    fn a_refusal_knows_the_token_it_answers() {
        let (token, _) = Message::parse(r#"{ "token": "abc" }"#).expect_err("there is no action");
        assert_eq!(token.as_deref(), Some("abc"));
    }
}
