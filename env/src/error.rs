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
    /// A batch of no environments, or of too many.
    #[error("batch: found {found} environments, expected 1 to {most}")]
    BatchSize {
        /// Environments asked for.
        found: usize,
        /// The most there can be.
        most: usize,
    },
    /// Threads that the system does not give.
    #[error("batch: {wanted} threads cannot be had: {reason}; ask for fewer (num_threads)")]
    BatchThreads {
        /// Threads asked for.
        wanted: usize,
        /// What the system says.
        reason: String,
    },
    /// A list with not one entry for each environment.
    #[error("batch: found {found} entries, expected {num_envs}, one for each environment; nothing was changed")]
    BatchLength {
        /// Entries handed in.
        found: usize,
        /// Environments there are.
        num_envs: usize,
    },
    /// The number of an environment that the batch does not have.
    #[error("batch: found environment {found}, expected 0 to {}", num_envs - 1)]
    NoSuchEnv {
        /// The number asked for.
        found: usize,
        /// Environments there are.
        num_envs: usize,
    },
    /// An action that an environment of a batch cannot carry out.
    #[error("environment {env} of the batch: {error}")]
    BatchAction {
        /// Number of the environment.
        env: usize,
        /// What is wrong.
        error: Box<Self>,
    },
    /// A world source without a world.
    #[error("environment {env} of the batch: no world for episode {episode}: {reason}")]
    BatchWorld {
        /// Number of the environment.
        env: usize,
        /// Number of its episode.
        episode: u64,
        /// What the source says.
        reason: String,
    },
    /// A world with other images than the first world of its batch.
    #[error(
        "environment {env} of the batch: its world asks for {found}, expected {expected} as for environment 0; give the worlds \
         of a batch the same agent_params.observation_size and modalities"
    )]
    BatchImages {
        /// Number of the environment.
        env: usize,
        /// What its world asks for.
        found: String,
        /// What the batch makes.
        expected: String,
    },
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
            Self::BatchSize { .. } => "env/batch-size",
            Self::BatchThreads { .. } => "env/batch-threads",
            Self::BatchLength { .. } => "env/batch-length",
            Self::NoSuchEnv { .. } => "env/no-such-env",
            Self::BatchAction { .. } => "env/batch-action",
            Self::BatchWorld { .. } => "env/batch-world",
            Self::BatchImages { .. } => "env/batch-images",
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
            EnvError::BatchSize { found: 0, most: 65_536 },
            EnvError::BatchThreads {
                wanted: 100_000,
                reason: "out of memory".to_owned(),
            },
            EnvError::BatchLength { found: 3, num_envs: 4 },
            EnvError::NoSuchEnv { found: 4, num_envs: 4 },
            EnvError::BatchAction {
                env: 2,
                error: Box::new(EnvError::Ended),
            },
            EnvError::BatchWorld {
                env: 2,
                episode: 7,
                reason: "the disk is full".to_owned(),
            },
            EnvError::BatchImages {
                env: 2,
                found: "64 × 64 pixels of Rgb".to_owned(),
                expected: "84 × 84 pixels of Rgb, Depth".to_owned(),
            },
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
