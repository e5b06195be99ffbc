//! Messages of L2Explorer's channels in the console: parses them from text, and shows the answers.

use std::path::Path;

use crate::env::{Channel, Outgoing};
use crate::spec::nearest;
use serde_json::Value;

use super::arguments::Picture;
use super::session::{Session, to_text};
use crate::documents;
use crate::spec::Modality;

/// Maximum number of characters of a message that is shown in full.
const MAX_SHOWN: usize = 600;

impl Session<'_> {
    /// Sends the messages in a text, or in the file that it names.
    pub(super) fn send(&mut self, text: &str) -> Result<String, String> {
        let inline = text.starts_with(['{', '[']);
        let read = if inline {
            Ok(text.to_owned())
        } else {
            documents::text(Path::new(text))
        };
        let (mut lines, mut refused) = (Vec::new(), None);
        for (channel, message) in messages(&read.map_err(to_text)?) {
            let time = self.time();
            let received = self.channels.receive(&mut self.environment, channel, &message, &time);
            if received.reset {
                self.start = self.environment.world().clone();
            }
            let mut answers = received.messages;
            if let Some(picture) = received.screenshot {
                let size = Some([picture.width, picture.height]);
                let written = self.screenshot(&picture.filename, (Picture::Seen(Modality::Rgb), size));
                lines.extend(written.iter().cloned());
                answers.push(self.channels.answer_screenshot(&picture, written.map(drop), &time));
            }
            lines.extend(answers.iter().map(shown));
            refused = refused.or(answers.iter().find_map(Outgoing::refusal));
        }
        match refused {
            None => Ok(lines.join("\n")),
            // The answers to accepted messages are shown, too.
            Some(text) => Err(format!("the message was refused: {text}\n{}", lines.join("\n"))),
        }
    }
}

/// The messages of a text: one message, a message with its channel (`{"channel", "message"}`), or a list of these under `tests`.
///
/// A message without a channel goes to the channel that knows its action. Text that is not a message is passed on
/// unchanged; its channel refuses it.
fn messages(text: &str) -> Vec<(Channel, String)> {
    let Ok(mut json) = serde_json::from_str::<Value>(text) else {
        return vec![(Channel::Reset, text.to_owned())];
    };
    match json.get_mut("tests").map(Value::take) {
        Some(Value::Array(list)) => list.into_iter().map(message).collect(),
        _ => vec![message(json)],
    }
}

fn message(mut json: Value) -> (Channel, String) {
    let named = json.get("channel").and_then(Value::as_str).and_then(Channel::from_name);
    let json = match json.get_mut("message") {
        Some(inner) => inner.take(),
        None => json,
    };
    let action = json.get("action").and_then(Value::as_str).unwrap_or_default();
    let action = action.trim().to_lowercase();
    // A misspelt action goes to the intended channel, whose answer then shows the spelling.
    let corrected = || nearest(&action, Channel::ALL.iter().flat_map(|channel| channel.actions()));
    let channel = named
        .or_else(|| Channel::for_action(&action))
        .or_else(|| Channel::for_action(&corrected()?));
    (channel.unwrap_or(Channel::Reset), json.to_string())
}

/// A message to the client as a line: debug messages as text, others as JSON after their channel.
pub(super) fn shown(message: &Outgoing) -> String {
    if let ("debug_message", Some(payload)) = (message.action, &message.payload) {
        let field = |key: &str| payload[key].as_str().unwrap_or_default();
        return format!("[{}] {}: {}", field("category"), field("level"), field("message"));
    }
    let json = message.to_json();
    let length = json.chars().count();
    if length <= MAX_SHOWN {
        return format!("<- {} {json}", message.channel.name());
    }
    let first: String = json.chars().take(MAX_SHOWN).collect();
    format!("<- {} {first}… ({length} characters in all)", message.channel.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_go_to_the_channel_of_their_action() {
        let check = |text: &str, expected: &[Channel]| {
            let found: Vec<Channel> = messages(text).into_iter().map(|(channel, _)| channel).collect();
            assert_eq!(found, expected, "{text}");
        };
        check(r#"{ "action": "Get_Observers" }"#, &[Channel::State]);
        check(
            r#"{ "channel": "debug", "message": { "action": "get_observers" } }"#,
            &[Channel::Debug],
        );
        check(
            r#"{ "tests": [{ "action": "save_screenshot" }, { "channel": "State", "message": {} }] }"#,
            &[Channel::Debug, Channel::State],
        );
        check("no JSON", &[Channel::Reset]);
        check("3", &[Channel::Reset]);
    }
}
