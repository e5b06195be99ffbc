//! [`Outbox`]: messages that wait to be sent, and no more of them in one go than a client accepts. What they say is decided
//! elsewhere.

use std::collections::VecDeque;

use uuid::Uuid;

use crate::side_channel::{RECORD_HEAD, write_record};

/// The longest message that is sent, in bytes: what gRPC servers accept where nobody says otherwise.
pub(crate) const MAX_OUTGOING_BYTES: usize = 4 << 20;

/// The most records that may wait: who asks for more than it takes is told less.
const MOST_WAITING: usize = 10_000;

/// Messages to the client, in the order in which they go.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outbox {
    waiting: VecDeque<(Uuid, Vec<u8>)>,
    /// How many were left out since somebody asked.
    left_out: usize,
}

impl Outbox {
    /// Puts a message at the end.
    pub(crate) fn push(&mut self, channel: Uuid, payload: Vec<u8>) {
        if self.waiting.len() < MOST_WAITING {
            self.waiting.push_back((channel, payload));
        } else {
            self.left_out += 1;
        }
    }

    /// Takes what fits into that many bytes; the rest waits. A message that would not fit alone is left out.
    pub(crate) fn take(&mut self, room: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        while let Some((channel, payload)) = self.waiting.front() {
            let length = payload.len() + RECORD_HEAD;
            if length > room {
                self.left_out += 1;
            } else if bytes.len() + length > room {
                break;
            } else {
                write_record(&mut bytes, *channel, payload);
            }
            self.waiting.pop_front();
        }
        bytes
    }

    /// How many messages were left out since this was asked last.
    pub(crate) fn take_left_out(&mut self) -> usize {
        std::mem::take(&mut self.left_out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::side_channel::records;

    fn lengths(bytes: &[u8]) -> Vec<usize> {
        records(bytes)
            .map(|record| record.expect("what is sent can be read").payload.len())
            .collect()
    }

    #[test]
    fn what_does_not_fit_waits_and_what_never_fits_is_left_out() {
        let mut outbox = Outbox::default();
        for length in [10, 200, 30, 40] {
            outbox.push(Uuid::nil(), vec![0; length]);
        }
        assert_eq!(lengths(&outbox.take(75)), [10]);
        assert_eq!(outbox.take_left_out(), 1, "the one of 200");
        assert_eq!(lengths(&outbox.take(100)), [30]);
        assert_eq!(lengths(&outbox.take(100)), [40]);
        assert!(outbox.take(100).is_empty());
        assert_eq!(outbox.take_left_out(), 0);
    }

    #[test]
    fn there_is_an_end_to_waiting() {
        let mut outbox = Outbox::default();
        for _ in 0..MOST_WAITING + 5 {
            outbox.push(Uuid::nil(), Vec::new());
        }
        assert_eq!(outbox.take_left_out(), 5);
        assert_eq!(lengths(&outbox.take(usize::MAX)).len(), MOST_WAITING);
    }
}
