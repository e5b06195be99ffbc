//! [`Payload`]: reads numbers and strings from a message's bytes, never past their end.

/// The unread rest of a message.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Payload<'a>(&'a [u8]);

impl<'a> Payload<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// Reads an integer.
    pub(crate) fn int(&mut self) -> Result<i32, String> {
        self.word().map(i32::from_le_bytes)
    }

    /// Reads a float.
    pub(crate) fn float(&mut self) -> Result<f32, String> {
        self.word().map(f32::from_le_bytes)
    }

    /// Reads a string: its length in bytes, then its bytes.
    pub(crate) fn text(&mut self) -> Result<&'a str, String> {
        let length = self.int()?;
        let split = usize::try_from(length)
            .ok()
            .and_then(|length| self.0.split_at_checked(length));
        let Some((text, rest)) = split else {
            let found = self.0.len();
            return Err(format!("found a string that claims {length} bytes, with {found} left"));
        };
        self.0 = rest;
        std::str::from_utf8(text).map_err(|error| format!("found a string that is not UTF-8: {error}"))
    }

    fn word(&mut self) -> Result<[u8; 4], String> {
        let Some((word, rest)) = self.0.split_first_chunk::<4>() else {
            return Err(format!("found {} bytes, expected 4 for a number", self.0.len()));
        };
        self.0 = rest;
        Ok(*word)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::side_channel::text_payload;

    #[test]
    fn payloads_round_trip() {
        let mut bytes = text_payload("häuser");
        bytes.extend_from_slice(&(-3_i32).to_le_bytes());
        bytes.extend_from_slice(&0.5_f32.to_le_bytes());
        let mut payload = Payload::new(&bytes);
        assert_eq!(payload.text().as_deref(), Ok("häuser"));
        assert_eq!(payload.int(), Ok(-3));
        assert_eq!(payload.float(), Ok(0.5));
        assert_eq!(payload.int(), Err("found 0 bytes, expected 4 for a number".to_owned()));
    }

    #[test]
    fn payload_is_never_read_past_its_end() {
        let check = |bytes: &[u8], expected: &str| {
            let error = Payload::new(bytes)
                .text()
                .expect_err("the payload contains no valid text");
            assert!(error.starts_with(expected), "{error}");
        };
        check(&[5, 0, 0, 0, b'a'], "found a string that claims 5 bytes, with 1 left");
        check(&[255, 255, 255, 255, b'a'], "found a string that claims -1 bytes");
        check(&[1, 0, 0, 0, 0xff], "found a string that is not UTF-8");
        check(&[1, 0], "found 2 bytes, expected 4");
    }
}
