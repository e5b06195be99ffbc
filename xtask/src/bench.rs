//! `cargo xtask bench`, and the `benches` stage that runs each bench once so that none rots. What is measured stands in the
//! `benches/` folder of each crate and in `driftworld bench`.

use crate::error::XtaskError;
use crate::process::AS_TESTED;
use crate::process::{cargo, run};
use crate::workspace::Workspace;

/// The benches of one part of the house.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Suite {
    Generator,
    Similarity,
    Env,
    Metrics,
    Unity,
}

impl Suite {
    pub(crate) const ALL: [Self; 5] = [Self::Generator, Self::Similarity, Self::Env, Self::Metrics, Self::Unity];

    /// The word after `bench`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Generator => "generator",
            Self::Similarity => "similarity",
            Self::Env => "env",
            Self::Metrics => "metrics",
            Self::Unity => "unity",
        }
    }

    /// The suite of that name, if there is one.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|suite| suite.name() == name)
    }

    /// The crates whose criterion benches belong to it.
    fn packages(self) -> &'static [&'static str] {
        match self {
            Self::Generator => &["driftworld-spec", "driftworld-generator"],
            Self::Similarity => &["driftworld-similarity"],
            Self::Env => &["driftworld-env"],
            Self::Metrics => &["driftworld-metrics"],
            Self::Unity => &["driftworld-unity"],
        }
    }
}

/// Measures: criterion's benches, then the figures that `driftworld bench` prints.
pub(crate) fn measure(workspace: &Workspace, suites: &[Suite]) -> Result<(), XtaskError> {
    for suite in suites {
        for package in suite.packages() {
            run(cargo(workspace, &["bench", "--package", package]))?;
        }
        match suite {
            // With a client it is measured by `unity/benches/client.py`, which wants a Python with mlagents-envs.
            Suite::Unity => {}
            Suite::Generator | Suite::Similarity | Suite::Env | Suite::Metrics => run(cargo(
                workspace,
                &["run", "--release", "--quiet", "--", "bench", suite.name()],
            ))?,
        }
    }
    Ok(())
}

/// Runs every bench once, unoptimised: whether it still works, not how fast.
pub(crate) fn stage(workspace: &Workspace) -> Result<(), XtaskError> {
    run(cargo(
        workspace,
        &[&["test", "--bench", "*", "--quiet"], &AS_TESTED[..]].concat(),
    ))
}
