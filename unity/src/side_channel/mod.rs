//! Messages beside actions and observations: how they are packed one after the other, and which channels there are. What the
//! messages of each channel say is read in the files beside this one.

mod engine;
mod payload;
mod settings;

pub(crate) use engine::engine_setting;
pub(crate) use payload::Payload;
pub(crate) use settings::{Setting, environment_parameter, float_property};

use driftworld_env::Channel;

/// A channel's identifier as it travels: its first three groups have their bytes the other way round.
pub(crate) type Guid = [u8; 16];

/// Bytes of a record before its payload: the identifier and the length.
pub(crate) const RECORD_HEAD: usize = 20;

/// The channels that mean something here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SideChannel {
    /// One of L2Explorer's three.
    L2Explorer(Channel),
    /// Window size, quality, speed of time.
    Engine,
    /// Numbers by name, for the world.
    Parameters,
    /// The same in the form of older clients.
    Properties,
    /// Notes on trainings for the maker of the engine.
    Analytics,
}

impl SideChannel {
    /// The channel of that identifier, if it is known.
    pub(crate) fn from_guid(guid: Guid) -> Option<Self> {
        let l2explorer = Channel::ALL.into_iter().find(|channel| guid_of(channel.guid()) == guid);
        let others = [
            ("e951342c-4f7e-11ea-b238-784f4387d1f7", Self::Engine),
            ("534c891e-810f-11ea-a9d0-822485860400", Self::Parameters),
            ("60ccf7d0-4f7e-11ea-b238-784f4387d1f7", Self::Properties),
            ("b664a4a9-d86f-5a5f-95cb-e8353a7e8356", Self::Analytics),
        ];
        l2explorer.map(Self::L2Explorer).or_else(|| {
            let known = others.into_iter().find(|(text, _)| guid_of(text) == guid);
            known.map(|(_, channel)| channel)
        })
    }
}

/// The bytes of an identifier that is written in the usual way. What is no hexadecimal digit counts as none.
pub(crate) fn guid_of(text: &str) -> Guid {
    let digits = text.chars().filter_map(|letter| letter.to_digit(16));
    let mut guid = [0; 16];
    // 32 digits are two to each of the 16 bytes.
    for (place, digit) in digits.take(32).enumerate() {
        guid[place / 2] = guid[place / 2] << 4 | digit as u8;
    }
    guid[..4].reverse();
    guid[4..6].reverse();
    guid[6..8].reverse();
    guid
}

/// An identifier in the usual way.
pub(crate) fn guid_text(mut guid: Guid) -> String {
    guid[..4].reverse();
    guid[4..6].reverse();
    guid[6..8].reverse();
    let digits = format!("{:032x}", u128::from_be_bytes(guid));
    [
        &digits[..8],
        &digits[8..12],
        &digits[12..16],
        &digits[16..20],
        &digits[20..],
    ]
    .join("-")
}

/// One message on one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Record<'a> {
    pub(crate) guid: Guid,
    pub(crate) payload: &'a [u8],
}

/// The records in a run of bytes, up to the first that is not as it says: what follows it cannot be found.
pub(crate) fn records(mut bytes: &[u8]) -> impl Iterator<Item = Result<Record<'_>, String>> {
    std::iter::from_fn(move || {
        if bytes.is_empty() {
            return None;
        }
        let Some((head, rest)) = bytes.split_first_chunk::<RECORD_HEAD>() else {
            let found = bytes.len();
            bytes = &[];
            return Some(Err(format!("found {found} bytes, expected at least {RECORD_HEAD}")));
        };
        let mut guid = [0; 16];
        guid.copy_from_slice(&head[..16]);
        let length = i32::from_le_bytes([head[16], head[17], head[18], head[19]]);
        let payload = usize::try_from(length)
            .ok()
            .and_then(|length| rest.split_at_checked(length));
        let Some((payload, rest)) = payload else {
            bytes = &[];
            let found = rest.len();
            return Some(Err(format!(
                "found a message that claims {length} bytes, of which there are {found}"
            )));
        };
        bytes = rest;
        Some(Ok(Record { guid, payload }))
    })
}

/// Adds a record. Its payload is far shorter than the 2 GiB that a length can say.
pub(crate) fn write_record(bytes: &mut Vec<u8>, channel: &Guid, payload: &[u8]) {
    bytes.extend_from_slice(channel);
    bytes.extend_from_slice(&(payload.len() as i32).to_le_bytes());
    bytes.extend_from_slice(payload);
}

/// A text as a payload: its length in bytes, and its bytes.
pub(crate) fn text_payload(text: &str) -> Vec<u8> {
    let mut payload = Vec::with_capacity(text.len() + 4);
    payload.extend_from_slice(&(text.len() as i32).to_le_bytes());
    payload.extend_from_slice(text.as_bytes());
    payload
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_travel_with_their_first_groups_reversed() {
        let text = "621f0a70-4f87-11ea-a6bf-784f4387d1f7";
        let guid = guid_of(text);
        // As `uuid.UUID(text).bytes_le` of Python has them.
        let expected = [
            0x70, 0x0a, 0x1f, 0x62, 0x87, 0x4f, 0xea, 0x11, 0xa6, 0xbf, 0x78, 0x4f, 0x43, 0x87, 0xd1, 0xf7,
        ];
        assert_eq!(guid, expected);
        assert_eq!(guid_text(guid), text);
        assert_eq!(
            SideChannel::from_guid(guid),
            Some(SideChannel::L2Explorer(Channel::Reset))
        );
        assert_eq!(SideChannel::from_guid([0; 16]), None);
    }

    #[test]
    fn what_is_written_is_read_again() {
        let mut bytes = Vec::new();
        write_record(&mut bytes, &[7; 16], b"abc");
        write_record(&mut bytes, &[8; 16], b"");
        let found: Vec<_> = records(&bytes)
            .collect::<Result<_, _>>()
            .expect("the records are sound");
        let expected = [
            Record {
                guid: [7; 16],
                payload: b"abc".as_slice(),
            },
            Record {
                guid: [8; 16],
                payload: b"".as_slice(),
            },
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn lengths_that_lie_end_the_run() {
        let check = |length: i32, expected: &str| {
            let mut bytes = Vec::new();
            write_record(&mut bytes, &[7; 16], b"abc");
            bytes.extend_from_slice(&[9; 16]);
            bytes.extend_from_slice(&length.to_le_bytes());
            bytes.extend_from_slice(b"xy");
            let found: Vec<_> = records(&bytes).collect();
            assert_eq!(found.len(), 2);
            assert!(found[0].is_ok());
            assert_eq!(found[1], Err(expected.to_owned()));
        };
        check(3, "found a message that claims 3 bytes, of which there are 2");
        check(-1, "found a message that claims -1 bytes, of which there are 2");
        check(
            i32::MAX,
            "found a message that claims 2147483647 bytes, of which there are 2",
        );
        let short: Vec<_> = records(&[1, 2, 3]).collect();
        assert_eq!(short, [Err("found 3 bytes, expected at least 20".to_owned())]);
    }
}
