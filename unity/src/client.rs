//! [`Client`]: a client's capabilities, from its first message.

use crate::error::UnityError;
use crate::protocol::UnityRlInitializationInputProto;

/// The protocol features that a client understands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Client {
    /// Continuous numbers have their own list, and behaviours have an `action_spec` (since protocol version 1.3).
    pub(crate) hybrid_actions: bool,
    /// Images are (channels, height, width) instead of (height, width, channels). The protocol has no flag for this; packages
    /// since 1.0 expect it.
    pub(crate) channels_first: bool,
}

impl Client {
    /// Reads a client's first message.
    ///
    /// # Errors
    /// [`UnityError::ClientVersion`] unless it speaks version 1 of the protocol.
    pub(crate) fn new(first_message: &UnityRlInitializationInputProto) -> Result<Self, UnityError> {
        if major(&first_message.communication_version) != Some(1) {
            let found = first_message.communication_version.chars().take(40).collect();
            return Err(UnityError::ClientVersion(found));
        }
        let capabilities = first_message.capabilities.unwrap_or_default();
        Ok(Self {
            hybrid_actions: capabilities.hybrid_actions,
            channels_first: major(&first_message.package_version).is_some_and(|major| major >= 1),
        })
    }
}

/// The major number of a version.
fn major(version: &str) -> Option<u32> {
    version.split('.').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::UnityRlCapabilitiesProto;

    fn first_message(communication: &str, package: &str, hybrid: bool) -> UnityRlInitializationInputProto {
        UnityRlInitializationInputProto {
            seed: 0,
            communication_version: communication.to_owned(),
            package_version: package.to_owned(),
            capabilities: Some(UnityRlCapabilitiesProto {
                hybrid_actions: hybrid,
                ..UnityRlCapabilitiesProto::default()
            }),
        }
    }

    #[test]
    fn capabilities_follow_the_clients_generation() {
        let check = |communication: &str, package: &str, hybrid: bool, expected: (bool, bool)| {
            let client =
                Client::new(&first_message(communication, package, hybrid)).expect("the client uses version 1");
            assert_eq!((client.hybrid_actions, client.channels_first), expected, "{package}");
        };
        check("1.0.0", "0.16.0", false, (false, false));
        check("1.5.0", "0.28.0", true, (true, false));
        check("1.5.0", "1.1.0", true, (true, true));
        check("1.5.0", "2.0.0.dev0", true, (true, true));
        check("1.0.0", "", false, (false, false));
    }

    #[test]
    fn other_major_versions_are_refused() {
        for version in ["0.15.0", "2.0.0", "", "API-12"] {
            let error =
                Client::new(&first_message(version, "0.15.0", false)).expect_err("the version is not supported");
            assert_eq!(error.code(), "unity/client-version");
        }
    }
}
