//! What can go wrong while a world runs.

/// Everything that can go wrong in this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvError {
    /// An action holds NaN or infinity.
    #[error("action: found {found:?}, expected three finite numbers; nothing was changed")]
    NotFinite {
        /// The action.
        found: [f64; 3],
    },
    /// An action is the number of a row that the world's table does not have.
    #[error("action: found row {found}, expected 0 to {last} of the world's action table; nothing was changed")]
    NoSuchAction {
        /// The row asked for.
        found: usize,
        /// The last row there is.
        last: usize,
    },
    /// A discrete action in a world whose actions are continuous.
    #[error("action: found row {found}, expected three numbers; this world has no action table (agent_params.actions)")]
    NotDiscrete {
        /// The row asked for.
        found: usize,
    },
    /// A step after the episode has ended.
    #[error("step: the episode has ended, expected a reset first")]
    Ended,
    /// A picture of a size that cannot be.
    #[error("picture: found {width} × {height} pixels, expected 1 to 4096 each way")]
    PictureSize {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
}

impl EnvError {
    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => "env/not-finite",
            Self::NoSuchAction { .. } => "env/no-such-action",
            Self::NotDiscrete { .. } => "env/not-discrete",
            Self::Ended => "env/ended",
            Self::PictureSize { .. } => "env/picture-size",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_error_has_its_message() {
        let errors = [
            EnvError::NotFinite {
                found: [1.0, f64::INFINITY, 0.0],
            },
            EnvError::NoSuchAction { found: 7, last: 6 },
            EnvError::NotDiscrete { found: 2 },
            EnvError::Ended,
            EnvError::PictureSize { width: 0, height: 5000 },
        ];
        let said: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(said.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(EnvError::code).collect();
        let all: BTreeSet<&str> = include_str!("error.rs")
            .split('"')
            .filter(|word| word.starts_with("env/") && word.len() > 4)
            .collect();
        assert_eq!(covered, all, "every code has a case here");
    }
}
