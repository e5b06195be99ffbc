//! Parses incoming messages leniently, and writes outgoing ones strictly.

use driftworld_spec::nearest;
use serde_json::{Map, Value, json};

use super::Channel;

/// Maximum size of an incoming message in bytes, the same as for documents.
pub const MAX_MESSAGE_BYTES: usize = driftworld_spec::MAX_BYTES;

/// Maximum length of a token in characters; a UUID has 36.
const MAX_TOKEN_CHARS: usize = 100;

/// The `req_token` of a message that does not answer a request.
const NO_TOKEN: &str = "00000000-0000-0000-0000-000000000000";

/// Maximum number of problems in the payload of an error; one more string says how many were left out.
const MAX_TEXTS: usize = 20;

/// A message to the client.
#[derive(Clone, Debug, PartialEq)]
pub struct Outgoing {
    /// The channel on which it is sent.
    pub channel: Channel,
    /// The action: `ok`, `error`, `state`, `debug_message`, …
    pub action: &'static str,
    /// The payload, if any.
    pub payload: Option<Value>,
    /// Its token, in the form of a UUID.
    pub token: String,
    /// The token of the request that it answers, if any.
    pub req_token: Option<String>,
    /// The time at which it was created, as given by the caller.
    pub time: String,
}

impl Outgoing {
    /// The reasons for a refusal, in one string; `None` for other messages.
    pub fn refusal(&self) -> Option<String> {
        let texts = self.payload.as_ref().filter(|_| self.action == "error")?.as_array()?;
        let texts: Vec<&str> = texts.iter().filter_map(Value::as_str).collect();
        Some(texts.join("; "))
    }

    /// The message as one line of JSON, with every key, because clients of the original environment access them
    /// unconditionally.
    ///
    /// Without a message to answer, `req_token` is all zeros; without a payload, `payload` is `null`.
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

/// The reasons for refusing a message: the strings in the payload of the `error` that answers it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal(Vec<String>);

impl Refusal {
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self(vec![text.into()])
    }

    /// All problems of a payload, without their positions in the text, which would refer to our own copy.
    pub(super) fn of_document(error: &driftworld_spec::SpecError) -> Self {
        let problems = error.problems();
        if problems.is_empty() {
            return Self::new(error.to_string());
        }
        let mut texts: Vec<String> = problems
            .iter()
            .take(MAX_TEXTS)
            .map(|problem| {
                let mut problem = problem.clone();
                (problem.line, problem.column) = (0, 0);
                format!("payload {problem}")
            })
            .collect();
        if problems.len() > MAX_TEXTS {
            let at_least = if error.has_more() { "at least " } else { "" };
            let more = problems.len() - MAX_TEXTS;
            texts.push(format!("payload: and {at_least}{more} more"));
        }
        Self(texts)
    }

    pub(super) fn texts(&self) -> &[String] {
        &self.0
    }
}

/// A message from the client. Optional keys may be missing, and unknown ones are ignored.
#[derive(Clone, Debug)]
pub(super) struct Message {
    pub(super) token: Option<String>,
    pub(super) action: String,
    /// `null` counts as missing.
    pub(super) payload: Option<Value>,
    /// All keys of the message, because some clients put values next to `action` instead of into the payload.
    pub(super) all: Map<String, Value>,
}

impl Message {
    /// Parses a message. A refusal includes the message's token if it could be read.
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
            Some(Value::String(token)) if token.chars().count() <= MAX_TOKEN_CHARS => Some(token.clone()),
            Some(Value::String(_)) => {
                return refuse(format!(
                    "token: found a longer string, expected at most {MAX_TOKEN_CHARS} characters"
                ));
            }
            Some(other) => return refuse(format!("token: found {}, expected a string like a UUID", kind(other))),
        };
        let refuse = |text: String| Err((token.clone(), Refusal::new(text)));
        // The original client sends times without a time zone; nothing depends on them.
        if let Some(time) = all.get("msg_time").filter(|time| !time.is_string() && !time.is_null()) {
            return refuse(format!("msg_time: found {}, expected a string in ISO 8601", kind(time)));
        }
        let action = match all.get("action") {
            Some(Value::String(action)) => action.trim().to_lowercase(),
            Some(other) => return refuse(format!("action: found {}, expected a string", kind(other))),
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

    /// The payload, or a refusal if it is missing.
    pub(super) fn payload(&self, expected: &str) -> Result<&Value, Refusal> {
        let missing = || Refusal::new(format!("payload: found none, expected {expected}"));
        self.payload.as_ref().ok_or_else(missing)
    }
}

/// The refusal of an unknown word, with a suggestion.
pub(super) fn unknown(what: &str, word: &str, known: &[&str]) -> Refusal {
    let short: String = word.chars().take(60).collect();
    let near = nearest(&short, known).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    Refusal::new(format!(
        "{what}: found {short:?}, expected one of {}{near}",
        known.join(", ")
    ))
}

/// The JSON type of a value.
pub(super) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let (_, refusal) = Message::parse(text).expect_err("the message is malformed");
        assert!(refusal.texts()[0].contains(expected), "{refusal:?}");
    }

    #[test]
    fn optional_keys_may_be_missing() {
        let message = Message::parse(
            "\u{feff}{ \"action\": \" Get_Observers\", \"msg_time\": \"2020-03-01T12:00:00.123\", \"payload\": null }",
        )
        .expect("the message is valid");
        assert_eq!((message.action.as_str(), message.token), ("get_observers", None));
        assert_eq!(message.payload, None);
    }

    #[test]
    fn malformed_messages_are_refused() {
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
    fn refusal_keeps_the_token_of_its_message() {
        let (token, _) = Message::parse(r#"{ "token": "abc" }"#).expect_err("the message has no action");
        assert_eq!(token.as_deref(), Some("abc"));
    }
}
