//! The positions of evaluation blocks among learning blocks.

use std::collections::BTreeSet;

use serde::Deserialize;

use crate::CurriculumError;

/// When the agent is evaluated.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Evaluate {
    /// Before the first learning block and after each.
    Every,
    /// Before the first and after the last.
    Ends,
    /// After these numbers of learning blocks; 0 is before the first.
    #[serde(skip)]
    After(Vec<u32>),
}

impl Evaluate {
    /// The numbers of learning blocks after which the agent is evaluated.
    pub(super) fn positions(&self, num_blocks: u32) -> Result<BTreeSet<u32>, CurriculumError> {
        match self {
            Self::Every => Ok((0..=num_blocks).collect()),
            Self::Ends => Ok(BTreeSet::from([0, num_blocks])),
            Self::After(positions) => match positions.iter().find(|position| **position > num_blocks) {
                Some(found) => Err(CurriculumError::NoSuchPlace {
                    found: *found,
                    last: num_blocks,
                }),
                None => Ok(positions.iter().copied().collect()),
            },
        }
    }
}
