//! `--agent`: which of the agents lives a scenario or a world, and how its name is read. What agents do is `env`'s.

use std::str::FromStr;

use driftworld::env::{Agent, OnRailsAgent, RandomAgent};
use driftworld::spec::nearest;

use super::Failure;

/// The built-in agents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Who {
    /// Acts at random.
    Random,
    /// Knows the map and tours what pays.
    Onrails,
}

impl Who {
    /// What the help says of the argument.
    pub(crate) const HELP: &'static str = "Who lives it: random or onrails (knows the map and tours what pays)";

    /// What logs call the agent.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Random => "random".to_owned(),
            Self::Onrails => "onrails".to_owned(),
        }
    }

    /// The agent at the start of its life.
    #[expect(clippy::unnecessary_wraps, reason = "an agent from a file may fail")]
    pub(crate) fn agent(&self) -> Result<Box<dyn Agent>, Failure> {
        Ok(match self {
            Self::Random => Box::new(RandomAgent::new(0)),
            Self::Onrails => Box::new(OnRailsAgent::new()),
        })
    }
}

impl FromStr for Who {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "random" => Ok(Self::Random),
            "onrails" => Ok(Self::Onrails),
            _ => {
                let near = nearest(text, ["random", "onrails"]);
                let near = near.map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
                Err(format!("found {text:?}, expected random or onrails{near}"))
            }
        }
    }
}
