//! [`Outbox`]: queues messages and releases them in batches no larger than a client accepts.

use std::collections::VecDeque;

use uuid::Uuid;

use crate::side_channel::{RECORD_HEAD, write_record};

/// Maximum length of an outgoing message, in bytes: the default limit of gRPC servers.
pub(crate) const MAX_OUTGOING_BYTES: usize = 4 << 20;

/// Maximum number of queued messages: if a client requests more than it accepts, later ones are dropped.
const MAX_QUEUED: usize = 10_000;

/// Messages to the client, in sending order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outbox {
    queue: VecDeque<(Uuid, Vec<u8>)>,
    /// Number of messages dropped since the last query.
    num_dropped: usize,
}

impl Outbox {
    /// Appends a message.
    pub(crate) fn push(&mut self, channel: Uuid, payload: Vec<u8>) {
        if self.queue.len() < MAX_QUEUED {
            self.queue.push_back((channel, payload));
        } else {
            self.num_dropped += 1;
        }
    }

    /// Takes messages that fit into `limit` bytes; the rest stays queued. Drops messages too long to fit on their own.
    pub(crate) fn take(&mut self, limit: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        while let Some((channel, payload)) = self.queue.front() {
            let length = payload.len() + RECORD_HEAD;
            if length > limit {
                self.num_dropped += 1;
            } else if bytes.len() + length > limit {
                break;
            } else {
                write_record(&mut bytes, *channel, payload);
            }
            self.queue.pop_front();
        }
        bytes
    }

    /// The number of messages dropped since the last call.
    pub(crate) fn take_num_dropped(&mut self) -> usize {
        std::mem::take(&mut self.num_dropped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::side_channel::records;

    fn lengths(bytes: &[u8]) -> Vec<usize> {
        records(bytes)
            .map(|record| record.expect("our own records are valid").payload.len())
            .collect()
    }

    #[test]
    fn oversized_messages_are_dropped_and_others_wait() {
        let mut outbox = Outbox::default();
        for length in [10, 200, 30, 40] {
            outbox.push(Uuid::nil(), vec![0; length]);
        }
        assert_eq!(lengths(&outbox.take(75)), [10]);
        assert_eq!(outbox.take_num_dropped(), 1, "the message of 200 bytes was dropped");
        assert_eq!(lengths(&outbox.take(100)), [30]);
        assert_eq!(lengths(&outbox.take(100)), [40]);
        assert!(outbox.take(100).is_empty());
        assert_eq!(outbox.take_num_dropped(), 0);
    }

    #[test]
    fn queue_length_is_limited() {
        let mut outbox = Outbox::default();
        for _ in 0..MAX_QUEUED + 5 {
            outbox.push(Uuid::nil(), Vec::new());
        }
        assert_eq!(outbox.take_num_dropped(), 5);
        assert_eq!(lengths(&outbox.take(usize::MAX)).len(), MAX_QUEUED);
    }
}
