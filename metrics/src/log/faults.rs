//! The policy for faults of a log: reading stops at the first, validation lists them all.

use crate::MetricsError;

/// Maximum number of faults, and of warnings, that are listed for a log.
pub const MAX_LISTED: usize = 100;

/// Collects faults as they are found.
#[derive(Debug)]
pub(super) enum Faults {
    /// Stops at the first fault.
    Stop,
    /// Lists faults, and counts those beyond the limit.
    List(Listed<MetricsError>),
}

/// The first [`MAX_LISTED`] things found; the others are only counted.
#[derive(Debug, Clone)]
pub(super) struct Listed<T> {
    pub(super) first: Vec<T>,
    pub(super) num_more: u64,
}

impl<T> Default for Listed<T> {
    fn default() -> Self {
        Self {
            first: Vec::new(),
            num_more: 0,
        }
    }
}

impl<T> Listed<T> {
    pub(super) fn add(&mut self, found: T) {
        if self.first.len() < MAX_LISTED {
            self.first.push(found);
        } else {
            self.num_more += 1;
        }
    }
}

impl Faults {
    /// Adds a fault; returns it as an error if reading stops at the first.
    pub(super) fn add(&mut self, fault: MetricsError) -> Result<(), MetricsError> {
        match self {
            Self::Stop => Err(fault),
            Self::List(listed) => {
                listed.add(fault);
                Ok(())
            }
        }
    }

    /// Returns the value, or adds the fault and returns `None`.
    pub(super) fn check<T>(&mut self, found: Result<T, MetricsError>) -> Result<Option<T>, MetricsError> {
        match found {
            Ok(value) => Ok(Some(value)),
            Err(fault) => self.add(fault).map(|()| None),
        }
    }
}
