//! `--agent`: parses the agent that runs a scenario or a world.

use std::path::PathBuf;
use std::str::FromStr;

use crate::env::{Agent, NetworkAgent, OnRailsAgent, RandomAgent, SarsaAgent, ScriptedAgent, StillAgent};
use crate::spec::{MAX_BYTES, nearest};
use driftworld_text::ShownPath;

use crate::checksum::checksum;
use crate::{Failure, documents};

/// An agent named on the command line.
#[derive(Clone, Debug, PartialEq, Eq, strum::AsRefStr)]
#[strum(serialize_all = "lowercase")]
pub(crate) enum AgentArg {
    /// Acts at random.
    Random,
    /// Stands still.
    Still,
    /// Knows the map and visits what pays.
    Onrails,
    /// Learns by linear Sarsa(λ) from its observations.
    Sarsa,
    /// Follows the script in this file.
    Scripted(PathBuf),
    /// Uses the network in this file.
    Net(PathBuf),
}

impl AgentArg {
    /// Help text of the argument.
    pub(crate) const HELP: &'static str = "The agent: random, still, onrails (the planner: knows the map and visits what pays), sarsa (a small learner), scripted:FILE (a script), or net:FILE (a network that a learner in Python has exported)";

    /// The agent's name in logs.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Scripted(path) | Self::Net(path) => format!("{}:{}", self.as_ref(), path.shown()),
            _ => self.as_ref().to_owned(),
        }
    }

    /// Creates the agent.
    pub(crate) fn agent(&self) -> Result<NamedAgent, Failure> {
        let (agent, fingerprint): (Box<dyn Agent>, _) = match self {
            Self::Random => (Box::new(RandomAgent::new(0)), None),
            Self::Still => (Box::new(StillAgent), None),
            Self::Onrails => (Box::new(OnRailsAgent::new()), None),
            Self::Sarsa => {
                let policy = SarsaAgent::POLICY.to_owned();
                (Box::new(SarsaAgent::new()), Some(("policy", policy)))
            }
            Self::Scripted(path) => {
                let text = documents::text(path)?;
                let agent = ScriptedAgent::parse(&path.display().to_string(), &text)?;
                (Box::new(agent), Some(("script", checksum(text.as_bytes()))))
            }
            Self::Net(path) => {
                let bytes = driftworld_files::read(path, MAX_BYTES as u64)?;
                let agent = NetworkAgent::parse(&path.display().to_string(), &bytes)?;
                (Box::new(agent), Some(("network", checksum(&bytes))))
            }
        };
        Ok(NamedAgent {
            name: self.name(),
            agent,
            fingerprint,
        })
    }
}

/// An agent ready to run.
pub(crate) struct NamedAgent {
    /// Its name in logs.
    pub(crate) name: String,
    pub(crate) agent: Box<dyn Agent>,
    /// Entry for the plan's fingerprint, with its key: the checksum of the agent's file, or its policy while learning.
    pub(crate) fingerprint: Option<(&'static str, String)>,
}

impl FromStr for AgentArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            Some(("scripted", file)) if !file.is_empty() => Ok(Self::Scripted(file.into())),
            Some(("net", file)) if !file.is_empty() => Ok(Self::Net(file.into())),
            None if text == "random" => Ok(Self::Random),
            None if text == "still" => Ok(Self::Still),
            // Tables call it "planner" and "expert".
            None if ["onrails", "planner", "expert"].contains(&text) => Ok(Self::Onrails),
            None if text == "sarsa" => Ok(Self::Sarsa),
            _ => {
                let near = nearest(text, ["random", "still", "onrails", "sarsa", "scripted", "net"]);
                let near = match near.as_deref() {
                    Some(near @ ("scripted" | "net")) => format!("; did you mean \"{near}:FILE\"?"),
                    Some(near) => format!("; did you mean {near:?}?"),
                    None => String::new(),
                };
                Err(format!(
                    "found {text:?}, expected random, still, onrails, sarsa, scripted:FILE or net:FILE{near}"
                ))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agent_parses_from_its_name_and_keeps_the_file() {
        assert_eq!("random".parse(), Ok(AgentArg::Random));
        assert_eq!("onrails".parse(), Ok(AgentArg::Onrails));
        assert_eq!("expert".parse(), Ok(AgentArg::Onrails));
        assert_eq!("planner".parse(), Ok(AgentArg::Onrails));
        assert_eq!("sarsa".parse(), Ok(AgentArg::Sarsa));
        assert_eq!("scripted:a:b.txt".parse(), Ok(AgentArg::Scripted("a:b.txt".into())));
        assert_eq!("net:a:b.txt".parse(), Ok(AgentArg::Net("a:b.txt".into())));
        assert_eq!(AgentArg::Scripted("a.txt".into()).name(), "scripted:a.txt");
    }

    #[test]
    fn misspelt_agent_error_lists_the_agents() {
        let error = |text: &str| text.parse::<AgentArg>().expect_err("there is no such agent");
        let expected = "expected random, still, onrails, sarsa, scripted:FILE or net:FILE; did you mean";
        assert_eq!(error("onrail"), format!("found \"onrail\", {expected} \"onrails\"?"));
        assert_eq!(
            error("scripted"),
            format!("found \"scripted\", {expected} \"scripted:FILE\"?")
        );
        assert_eq!(error("net"), format!("found \"net\", {expected} \"net:FILE\"?"));
        assert_eq!(
            error("bot"),
            "found \"bot\", expected random, still, onrails, sarsa, scripted:FILE or net:FILE"
        );
    }
}
