//! Reads named numbers: environment parameters, and the float properties of older clients.

use super::Payload;

/// A named number for the world.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setting {
    pub(crate) key: String,
    pub(crate) value: f32,
}

/// Maximum length of a parameter's name, in bytes.
const MAX_KEY_BYTES: usize = 200;

/// Reads an environment parameter; samplers are refused.
pub(crate) fn environment_parameter(bytes: &[u8]) -> Result<Setting, String> {
    let mut payload = Payload::new(bytes);
    let key = key(&mut payload)?;
    match payload.int()? {
        0 => Ok(Setting {
            value: payload.float()?,
            key,
        }),
        1 => Err(format!(
            "{key:?}: found a sampler, expected a number: draw values for each reset in the client, or with a task spec"
        )),
        other => Err(format!("{key:?}: found type {other}, expected 0, a number")),
    }
}

/// Reads a float property.
pub(crate) fn float_property(bytes: &[u8]) -> Result<Setting, String> {
    let mut payload = Payload::new(bytes);
    let key = key(&mut payload)?;
    payload.float().map(|value| Setting { key, value })
}

fn key(payload: &mut Payload) -> Result<String, String> {
    let key = payload.text()?;
    if key.len() > MAX_KEY_BYTES {
        return Err(format!(
            "found a name of {} bytes, expected at most {MAX_KEY_BYTES}",
            key.len()
        ));
    }
    Ok(key.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::side_channel::text_payload;

    fn bytes(key: &str, words: &[[u8; 4]]) -> Vec<u8> {
        let mut bytes = text_payload(key);
        bytes.extend(words.concat());
        bytes
    }

    #[test]
    fn both_forms_are_read() {
        let value = 2.5_f32.to_le_bytes();
        let expected = Ok(Setting {
            key: "frame_skip".to_owned(),
            value: 2.5,
        });
        assert_eq!(environment_parameter(&bytes("frame_skip", &[[0; 4], value])), expected);
        assert_eq!(float_property(&bytes("frame_skip", &[value])), expected);
    }

    #[test]
    fn samplers_and_broken_messages_are_refused() {
        let check = |bytes: &[u8], expected: &str| {
            let error = environment_parameter(bytes).expect_err("the message is invalid");
            assert!(error.contains(expected), "{error}");
        };
        check(&bytes("light", &[1_i32.to_le_bytes()]), "\"light\": found a sampler");
        check(&bytes("light", &[7_i32.to_le_bytes()]), "\"light\": found type 7");
        check(
            &bytes("a\nb", &[7_i32.to_le_bytes()]),
            "\"a\\nb\": found type 7, expected 0, a number",
        );
        check(&bytes("light", &[[0; 4]]), "expected 4 for a number");
        check(&bytes(&"k".repeat(201), &[[0; 4], [0; 4]]), "at most 200");
    }
}
