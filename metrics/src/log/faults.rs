//! What happens when something is wrong with a log: reading stops at the first fault, validating goes on and lists them.
//!
//! Not here: what is wrong, see `data_file` and `validation`.

use crate::MetricsError;

/// Most faults of a log that are listed one by one.
pub const MAX_LISTED: usize = 100;

/// Takes faults as they are found.
#[derive(Debug)]
pub(super) enum Faults {
    /// The first fault is the answer.
    Stop,
    /// Faults are listed, and those beyond the limit counted.
    List(Listed<MetricsError>),
}

/// Things found, the first [`MAX_LISTED`] of them; the others are counted.
#[derive(Debug, Clone)]
pub(super) struct Listed<T> {
    pub(super) first: Vec<T>,
    pub(super) more: u64,
}

impl<T> Default for Listed<T> {
    fn default() -> Self {
        Self {
            first: Vec::new(),
            more: 0,
        }
    }
}

impl<T> Listed<T> {
    pub(super) fn add(&mut self, found: T) {
        if self.first.len() < MAX_LISTED {
            self.first.push(found);
        } else {
            self.more += 1;
        }
    }
}

impl Faults {
    /// Takes a fault; gives it back as the error that ends the reading where the first fault does.
    pub(super) fn add(&mut self, fault: MetricsError) -> Result<(), MetricsError> {
        match self {
            Self::Stop => Err(fault),
            Self::List(listed) => {
                listed.add(fault);
                Ok(())
            }
        }
    }

    /// The value, or nothing where there is a fault instead, which is taken.
    pub(super) fn sift<T>(&mut self, found: Result<T, MetricsError>) -> Result<Option<T>, MetricsError> {
        match found {
            Ok(value) => Ok(Some(value)),
            Err(fault) => self.add(fault).map(|()| None),
        }
    }
}
