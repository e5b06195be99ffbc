//! Side channel messages: their encoding, and the channels.

mod engine;
mod payload;
mod settings;

pub(crate) use engine::engine_setting;
pub(crate) use payload::Payload;
pub(crate) use settings::{Setting, environment_parameter, float_property};

use driftworld_env::Channel;
use uuid::{Uuid, uuid};

/// Number of bytes of a record before its payload: identifier and length.
pub(crate) const RECORD_HEAD: usize = 20;

/// The known channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SideChannel {
    /// One of L2Explorer's three channels.
    L2Explorer(Channel),
    /// Window size, quality, time scale.
    Engine,
    /// Named numbers for the world.
    Parameters,
    /// Named numbers in the form of older clients.
    Properties,
    /// Training analytics for Unity Technologies.
    Analytics,
}

impl SideChannel {
    /// The channel with this identifier, if it is known.
    pub(crate) fn from_id(id: Uuid) -> Option<Self> {
        const OTHERS: [(Uuid, SideChannel); 4] = [
            (uuid!("e951342c-4f7e-11ea-b238-784f4387d1f7"), SideChannel::Engine),
            (uuid!("534c891e-810f-11ea-a9d0-822485860400"), SideChannel::Parameters),
            (uuid!("60ccf7d0-4f7e-11ea-b238-784f4387d1f7"), SideChannel::Properties),
            (uuid!("b664a4a9-d86f-5a5f-95cb-e8353a7e8356"), SideChannel::Analytics),
        ];
        let l2explorer = Channel::ALL.iter().copied().find(|channel| id_of(*channel) == id);
        let other = || OTHERS.into_iter().find(|(known, _)| *known == id);
        l2explorer
            .map(Self::L2Explorer)
            .or_else(|| other().map(|(_, channel)| channel))
    }
}

/// The identifier of one of L2Explorer's channels.
pub(crate) fn id_of(channel: Channel) -> Uuid {
    Uuid::try_parse(channel.guid()).expect("all three are valid UUIDs, see the test below")
}

/// One message on one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Record<'a> {
    pub(crate) id: Uuid,
    pub(crate) payload: &'a [u8],
}

/// The records in a sequence of bytes, up to the first malformed one, after which no record can be located.
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
        // The head consists of a 16-byte identifier, with its first groups in little-endian order, and a 4-byte length.
        let (id, length) = head.split_at(16);
        let id = Uuid::from_bytes_le(std::array::from_fn(|index| id[index]));
        let length = i32::from_le_bytes(std::array::from_fn(|index| length[index]));
        let payload = usize::try_from(length)
            .ok()
            .and_then(|length| rest.split_at_checked(length));
        let Some((payload, rest)) = payload else {
            bytes = &[];
            let found = rest.len();
            return Some(Err(format!(
                "found a message that claims {length} bytes, with {found} left"
            )));
        };
        bytes = rest;
        Some(Ok(Record { id, payload }))
    })
}

/// Appends a record. Its payload is far shorter than the 2 GiB limit of the length field.
pub(crate) fn write_record(bytes: &mut Vec<u8>, id: Uuid, payload: &[u8]) {
    bytes.extend_from_slice(&id.to_bytes_le());
    bytes.extend_from_slice(&(payload.len() as i32).to_le_bytes());
    bytes.extend_from_slice(payload);
}

/// Encodes a string as a payload: its length in bytes, then its bytes.
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
    fn identifiers_are_encoded_in_little_endian_groups() {
        for &channel in Channel::ALL {
            assert_eq!(
                SideChannel::from_id(id_of(channel)),
                Some(SideChannel::L2Explorer(channel))
            );
        }
        assert_eq!(SideChannel::from_id(Uuid::nil()), None);
        let mut bytes = Vec::new();
        write_record(&mut bytes, id_of(Channel::Reset), b"");
        // Python's `uuid.UUID("621f0a70-4f87-11ea-a6bf-784f4387d1f7").bytes_le`.
        let expected = [
            0x70, 0x0a, 0x1f, 0x62, 0x87, 0x4f, 0xea, 0x11, 0xa6, 0xbf, 0x78, 0x4f, 0x43, 0x87, 0xd1, 0xf7,
        ];
        assert_eq!(bytes[..16], expected);
    }

    #[test]
    fn records_round_trip() {
        let mut bytes = Vec::new();
        write_record(&mut bytes, Uuid::from_bytes([7; 16]), b"abc");
        write_record(&mut bytes, Uuid::from_bytes([8; 16]), b"");
        let found: Vec<_> = records(&bytes)
            .collect::<Result<_, _>>()
            .expect("the records are valid");
        let expected = [
            Record {
                id: Uuid::from_bytes([7; 16]),
                payload: b"abc".as_slice(),
            },
            Record {
                id: Uuid::from_bytes([8; 16]),
                payload: b"".as_slice(),
            },
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn wrong_lengths_end_the_sequence() {
        let check = |length: i32, expected: &str| {
            let mut bytes = Vec::new();
            write_record(&mut bytes, Uuid::from_bytes([7; 16]), b"abc");
            bytes.extend_from_slice(&[9; 16]);
            bytes.extend_from_slice(&length.to_le_bytes());
            bytes.extend_from_slice(b"xy");
            let found: Vec<_> = records(&bytes).collect();
            assert_eq!(found.len(), 2);
            assert!(found[0].is_ok());
            assert_eq!(found[1], Err(expected.to_owned()));
        };
        check(3, "found a message that claims 3 bytes, with 2 left");
        check(-1, "found a message that claims -1 bytes, with 2 left");
        check(i32::MAX, "found a message that claims 2147483647 bytes, with 2 left");
        let short: Vec<_> = records(&[1, 2, 3]).collect();
        assert_eq!(short, [Err("found 3 bytes, expected at least 20".to_owned())]);
    }
}
