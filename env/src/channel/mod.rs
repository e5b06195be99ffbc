//! L2Explorer's three channels of JSON messages: a client's requests to a running world, and the answers. The caller handles
//! transport, time and files.

mod category;
mod exchange;
mod message;
mod request;

pub use category::{Category, Level};
pub use exchange::{Channels, Received};
pub use message::{MAX_MESSAGE_BYTES, Outgoing};
pub use request::Screenshot;

use strum::VariantArray;

/// One of the three channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, strum::IntoStaticStr, strum::VariantArray)]
pub enum Channel {
    /// New worlds, and new objects in the current world.
    Reset,
    /// Parts of the world, sent after each step to clients that requested them.
    State,
    /// Screenshots and debug messages.
    Debug,
}

impl Channel {
    /// All channels.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Its name.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The channel's UUID in the original client.
    pub fn guid(self) -> &'static str {
        match self {
            Self::Reset => "621f0a70-4f87-11ea-a6bf-784f4387d1f7",
            Self::State => "37715121-3bce-45ff-966d-680586560a5d",
            Self::Debug => "c5fba0b5-6392-4433-a95f-cdec6b0061e1",
        }
    }

    /// The actions that the channel accepts.
    pub fn actions(self) -> &'static [&'static str] {
        match self {
            Self::Reset => &["reset_environment", "object_create"],
            Self::State => &["get_observers", "set_active_observers"],
            Self::Debug => &["save_screenshot", "get_debug_categories", "set_debug_categories"],
        }
    }

    /// Finds a channel by its name, ignoring case, or by its UUID.
    pub fn from_name(name: &str) -> Option<Self> {
        let matches_name =
            |channel: &Self| channel.name().eq_ignore_ascii_case(name) || channel.guid() == name.to_lowercase();
        Self::ALL.iter().copied().find(matches_name)
    }

    /// The channel that accepts an action.
    pub fn for_action(action: &str) -> Option<Self> {
        let accepts = |channel: &Self| channel.actions().contains(&action);
        Self::ALL.iter().copied().find(accepts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_found_by_name_identifier_and_action() {
        for &channel in Channel::ALL {
            assert_eq!(Channel::from_name(&channel.name().to_uppercase()), Some(channel));
            assert_eq!(Channel::from_name(channel.guid()), Some(channel));
            for action in channel.actions() {
                assert_eq!(Channel::for_action(action), Some(channel));
            }
        }
        assert_eq!(Channel::from_name("Chat"), None);
    }
}
