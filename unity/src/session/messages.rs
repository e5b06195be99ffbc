//! Handles side channel messages of a session.

use driftworld_env::{Channel, Outgoing, Received, Screenshot};
use driftworld_text::ascii_json;

use super::Session;
use crate::observation::png;
use crate::parameters::Parameters;
use crate::remarks::About;
use crate::side_channel::{
    Payload, Setting, SideChannel, engine_setting, environment_parameter, float_property, id_of, records, text_payload,
};

/// Maximum number of messages handled per batch.
const MAX_MESSAGES: usize = 1000;

/// Maximum number of values in the JSON texts of one batch of messages, enough for a world of about twenty thousand objects.
/// Parsing that many brackets takes half a gigabyte of memory; without the limit, 4 MB of brackets took 2.8 GB. While texts are
/// being parsed, a disconnected client is not noticed.
const MAX_VALUES: usize = 400_000;

/// Maximum number of messages that are examined per batch, so that those beyond [`MAX_MESSAGES`] can be refused one by one.
const MAX_EXAMINED: usize = 10_000;

/// Maximum number of screenshot pixels per batch, enough for two of the largest screenshots. While they are rendered, a
/// disconnected client is not noticed.
const MAX_SCREENSHOT_PIXELS: u64 = 2 << 24;

/// An L2Explorer message: its channel, and its text or the reason why the text was refused.
pub(super) type ReceivedText<'a> = (Channel, Result<&'a str, String>);

impl Session {
    /// Applies the settings among the messages, and returns the others.
    pub(super) fn take_settings<'a>(&mut self, bytes: &'a [u8]) -> Vec<ReceivedText<'a>> {
        let mut responses = Vec::new();
        let mut values = MAX_VALUES;
        for (number, record) in records(bytes).enumerate() {
            if number == MAX_MESSAGES {
                let remark = format!("messages: found more than {MAX_MESSAGES} in one go; the others are refused");
                self.remarks.make(About::Refusals, &remark);
            }
            if number == MAX_EXAMINED {
                break;
            }
            let record = match record {
                Ok(record) => record,
                Err(reason) => {
                    let remark = format!("messages: {reason}; it is ignored, and so is what follows");
                    self.remarks.make(About::Refusals, &remark);
                    break;
                }
            };
            let side_channel = SideChannel::from_id(record.id);
            if number >= MAX_MESSAGES {
                if let Some(SideChannel::L2Explorer(channel)) = side_channel {
                    let reason = format!("found more than {MAX_MESSAGES} in one go, expected the rest in later steps");
                    responses.push((channel, Err(reason)));
                }
                continue;
            }
            match side_channel {
                Some(SideChannel::L2Explorer(channel)) => {
                    let text = Payload::new(record.payload).text();
                    responses.push((channel, text.and_then(|text| bounded(text, &mut values))));
                }
                Some(SideChannel::Engine) => self.take_engine_setting(record.payload),
                Some(SideChannel::Parameters) => {
                    self.take_setting("environment parameter", environment_parameter(record.payload));
                }
                Some(SideChannel::Properties) => self.take_setting("float property", float_property(record.payload)),
                Some(SideChannel::Analytics) => {}
                None => {
                    let remark = format!("messages on the unknown channel {} are ignored", record.id);
                    self.remarks.make(About::Settings, &remark);
                }
            }
        }
        responses
    }

    fn take_engine_setting(&mut self, payload: &[u8]) {
        match engine_setting(payload) {
            Ok((name, remark)) => self.remarks.make_once(About::Settings, name, &remark),
            Err(reason) => {
                let remark = format!("engine configuration: {reason}; it is ignored");
                self.remarks.make(About::Settings, &remark);
            }
        }
    }

    fn take_setting(&mut self, kind: &str, setting: Result<Setting, String>) {
        match setting {
            Ok(setting) => {
                if let Err(reason) = self.parameters.set(&setting) {
                    let remark = format!("{kind}: {reason}");
                    // For an unknown name, one remark is enough, whatever the values.
                    let key = if Parameters::knows(&setting.key) {
                        remark.clone()
                    } else {
                        format!("{kind} {}", setting.key)
                    };
                    self.remarks.make_once(About::Settings, &key, &remark);
                }
            }
            Err(reason) => self.remarks.make(About::Settings, &format!("{kind}: {reason}")),
        }
    }

    /// Handles the requests in messages; returns whether one of them reset the world.
    pub(super) fn receive(&mut self, messages: &[ReceivedText]) -> bool {
        let mut was_reset = false;
        let mut pixels = 0;
        for (channel, text) in messages {
            let time = (self.clock)();
            let received = match text {
                Ok(text) => self.channels.receive(&mut self.environment, *channel, text, &time),
                Err(reason) => Received {
                    messages: vec![self.channels.refuse(*channel, reason, &time)],
                    ..Received::default()
                },
            };
            for remark in &received.remarks {
                self.remarks
                    .make(About::Worlds, &format!("{} channel: {remark}", channel.name()));
            }
            if received.reset {
                self.adopt_world();
                was_reset = true;
            }
            for message in &received.messages {
                self.send(message);
            }
            if let Some(screenshot) = received.screenshot {
                pixels += u64::from(screenshot.width) * u64::from(screenshot.height);
                let written = if pixels <= MAX_SCREENSHOT_PIXELS {
                    self.draw(&screenshot)
                } else {
                    Err("found more pictures than are drawn in one go, expected the rest in later steps".to_owned())
                };
                if let Ok(path) = &written {
                    self.remarks.make(About::Settings, &format!("screenshot: {path}"));
                }
                let answer = self.channels.answer_screenshot(&screenshot, written.map(drop), &time);
                self.send(&answer);
            }
        }
        was_reset
    }

    /// Adopts the world of a reset message, with the current parameters.
    fn adopt_world(&mut self) {
        self.start = self.environment.world().clone().with_maps(&self.maps);
        if !self.parameters.is_empty() || self.start != *self.environment.world() {
            self.restart();
        } else {
            self.open_album();
        }
    }

    /// Renders and writes a screenshot; returns its path.
    fn draw(&mut self, screenshot: &Screenshot) -> Result<String, String> {
        let size = [screenshot.width, screenshot.height];
        // At the observations' size the screenshot is an observation, with the same antialiasing.
        let png = if size == self.environment.world().agent_params.picture_size() {
            png(size, &self.environment.observe().rgb)
        } else {
            let frame = self.environment.observe_at(size[0], size[1]);
            png(size, &frame.map_err(|error| error.to_string())?.rgb)
        };
        let png = png.map_err(|error| error.to_string())?;
        let path = self.screenshots.write(&screenshot.filename, &png)?;
        Ok(path.display().to_string())
    }

    /// Sends an L2Explorer message. Refusals also cause a remark, because the original client ignores answers.
    pub(super) fn send(&mut self, message: &Outgoing) {
        if let Some(texts) = message.refusal() {
            let channel = message.channel.name();
            let remark = format!("{channel} channel: a message was refused: {texts}");
            self.remarks.make(About::Refusals, &remark);
        }
        let payload = text_payload(&ascii_json(&message.to_json()));
        self.outbox.push(id_of(message.channel), payload);
    }
}

/// The text, unless it has more values than `left`. Commas and brackets in strings count as well.
fn bounded<'a>(text: &'a str, left: &mut usize) -> Result<&'a str, String> {
    let found = text.bytes().filter(|byte| matches!(byte, b',' | b'[' | b'{')).count();
    let Some(rest) = left.checked_sub(found) else {
        return Err(format!(
            "found about {found} values, expected at most {left} of the {MAX_VALUES} in one go; load larger worlds with --world"
        ));
    };
    *left = rest;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_json_is_equivalent() {
        let json = r#"{"a":"20° – 𝄞\n"}"#;
        let text = ascii_json(json);
        assert!(text.is_ascii(), "{text}");
        let read = |text: &str| serde_json::from_str::<serde_json::Value>(text).expect("the text is still valid JSON");
        assert_eq!(read(&text), read(json));
    }
}
