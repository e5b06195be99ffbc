//! Encodes an episode as the fragment of an address. The fragment is the base64url of the format's version, a checksum,
//! and deflated data: a line of JSON with the world and the outcome, then a number for each step.
//!
//! Actions of three numbers would take 24 bytes a step. But the planner and the random agent repeat their actions
//! exactly, so a step takes a few bits: the number of the agent that chose it, or an index into a list of actions.

use std::io::{Read, Write};

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use driftworld::env::{Action, Agent, Environment};
use driftworld::spec::Style;
use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use serde::{Deserialize, Serialize};

use crate::call::{AgentName, Link};
use crate::episode::agent;
use crate::fault::Fault;
use crate::request::{TaskCache, WorldRequest, in_style};

/// The version of the format.
const FORMAT: u8 = 1;

/// Maximum number of steps in a link.
pub(crate) const MAX_LINK_STEPS: usize = 20_000;

/// Maximum length of a fragment, and of its unpacked data in bytes.
const MAX_FRAGMENT: usize = 1 << 18;
const MAX_UNPACKED: u64 = 1 << 22;

/// The agents that repeat their actions exactly. Each has two step numbers: one for continuing, and one for starting afresh.
const AGENTS: [AgentName; 2] = [AgentName::Planner, AgentName::Random];
/// Step numbers below this belong to agents; subtracting it from any other gives an index into the list of actions.
const LISTED: u64 = 2 * AGENTS.len() as u64;

/// The line of JSON.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Header {
    /// The version of Driftworld.
    by: String,
    request: WorldRequest,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    looks: Option<Style>,
    steps: usize,
    /// The first characters of the world's hash.
    hash: String,
    /// The bits of the return, in hexadecimal.
    total: String,
    /// The actions that steps refer to by index.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    listed: Vec<Action>,
}

/// The agents that can continue at the current step, by index into [`AGENTS`].
#[derive(Default)]
struct AgentStates([Option<Box<dyn Agent>>; AGENTS.len()]);

impl AgentStates {
    /// The action of an agent that continues (even numbers) or starts afresh (odd). Afterwards, only this agent can continue.
    fn act(&mut self, number: usize, environment: &Environment) -> Option<Action> {
        let (index, is_new) = (number / 2, number % 2 == 1);
        let mut acting = if is_new {
            Some(agent(AGENTS[index], &Vec::new()).ok()?)
        } else {
            self.0[index].take()
        }?;
        let action = acting.act(environment);
        *self = Self::default();
        self.0[index] = Some(acting);
        Some(action)
    }
}

fn same(a: Action, b: Action) -> bool {
    match (a, b) {
        (Action::Discrete(a), Action::Discrete(b)) => a == b,
        (Action::Continuous(a), Action::Continuous(b)) => a.map(f64::to_bits) == b.map(f64::to_bits),
        _ => false,
    }
}

/// Encodes an episode as a fragment.
pub(crate) fn encode(tasks: &mut TaskCache, link: Link) -> Result<String, Fault> {
    let steps = link.actions.len();
    if steps > MAX_LINK_STEPS {
        return Err(Fault::new(
            "link/too-long",
            format!("link: found {steps} steps, expected at most {MAX_LINK_STEPS}; record the episode in a file"),
        ));
    }
    let world = tasks.world(&link.request)?;
    let hash = short_hash(&world.hash());
    let mut environment = Environment::new(in_style(world, link.looks)?);
    let (mut agents, mut listed, mut numbers) = (AgentStates::default(), Vec::<Action>::new(), Vec::new());
    for action in link.actions {
        // For a discrete action, an index is as short as an agent's number, and faster to decode.
        let number = match action {
            Action::Discrete(_) => None,
            Action::Continuous(_) => agent_number(&mut agents, &environment, action),
        };
        numbers.push(number.unwrap_or_else(|| {
            agents = AgentStates::default();
            let known = listed.iter().position(|known| same(*known, action));
            LISTED
                + known.unwrap_or_else(|| {
                    listed.push(action);
                    listed.len() - 1
                }) as u64
        }));
        environment.step(action)?;
    }
    let header = Header {
        by: env!("CARGO_PKG_VERSION").to_owned(),
        request: link.request,
        looks: link.looks,
        steps,
        hash,
        total: bits(environment.episode_return()),
        listed,
    };
    let mut data = serde_json::to_vec(&header).expect("keys are strings, and numbers were checked by steps");
    data.push(b'\n');
    for number in numbers {
        push_number(&mut data, number);
    }
    let mut deflater = DeflateEncoder::new(Vec::new(), Compression::best());
    let packed = deflater.write_all(&data).and_then(|()| deflater.finish());
    let packed = packed.expect("writing into memory cannot fail");
    let mut bytes = vec![FORMAT];
    bytes.extend(crc32fast::hash(&packed).to_le_bytes());
    bytes.extend(packed);
    Ok(URL_SAFE_NO_PAD.encode(bytes))
}

/// The step number of an agent that would also have chosen this action.
fn agent_number(agents: &mut AgentStates, environment: &Environment, action: Action) -> Option<u64> {
    for index in 0..AGENTS.len() {
        // Try an agent that acted until now as continuing, then as starting afresh.
        let first = 2 * index + usize::from(agents.0[index].is_none());
        for number in first..2 * index + 2 {
            let mut trial = AgentStates::default();
            if number % 2 == 0 {
                trial.0[index] = agents.0[index].take();
            }
            if trial.act(number, environment).is_some_and(|next| same(next, action)) {
                *agents = trial;
                return Some(number as u64);
            }
        }
    }
    None
}

/// Decodes an episode from a fragment, and replays it to check that the world and the return are those of the link.
pub(crate) fn decode(tasks: &mut TaskCache, fragment: &str) -> Result<Link, Fault> {
    let (header, mut numbers) = unpack(fragment)?;
    let other_version = |what: &str| {
        Fault::new(
            "link/version",
            format!(
                "link: found {what} made by Driftworld {}, expected one made by {}; open it with the version that made it",
                printable(&header.by),
                env!("CARGO_PKG_VERSION")
            ),
        )
    };
    let world = tasks
        .world(&header.request)
        .map_err(|fault| other_version(&format!("an episode ({}) that was", fault.message)))?;
    if short_hash(&world.hash()) != header.hash {
        return Err(other_version("a different world in an episode"));
    }
    let mut environment = Environment::new(in_style(world, header.looks)?);
    let (mut agents, mut actions) = (AgentStates::default(), Vec::with_capacity(header.steps));
    for _ in 0..header.steps {
        let number = pop_number(&mut numbers).ok_or_else(damaged)?;
        let action = if number < LISTED {
            agents.act(number as usize, &environment)
        } else {
            agents = AgentStates::default();
            let listed = header.listed.get((number - LISTED) as usize);
            listed.copied()
        };
        let action = action.ok_or_else(damaged)?;
        if environment.ended() || environment.step(action).is_err() {
            return Err(other_version("steps that are impossible here in an episode"));
        }
        actions.push(action);
    }
    if !numbers.is_empty() {
        return Err(damaged());
    }
    if bits(environment.episode_return()) != header.total {
        return Err(other_version("different rewards in an episode"));
    }
    Ok(Link {
        request: header.request,
        looks: header.looks,
        actions,
    })
}

/// Unpacks a fragment into the line of JSON and the step numbers.
fn unpack(fragment: &str) -> Result<(Header, std::collections::VecDeque<u8>), Fault> {
    if fragment.len() > MAX_FRAGMENT {
        return Err(damaged());
    }
    let bytes = URL_SAFE_NO_PAD.decode(fragment).map_err(|_| damaged())?;
    let (&format, rest) = bytes.split_first().ok_or_else(damaged)?;
    let (sum, packed) = rest.split_first_chunk::<4>().ok_or_else(damaged)?;
    if u32::from_le_bytes(*sum) != crc32fast::hash(packed) {
        return Err(damaged());
    }
    if format != FORMAT {
        return Err(Fault::new(
            "link/version",
            "this link was made by another version of Driftworld, or was changed; open it with the version that made it, \
             or copy all of it",
        ));
    }
    let mut all = Vec::new();
    let read = DeflateDecoder::new(packed).take(MAX_UNPACKED + 1).read_to_end(&mut all);
    read.map_err(|_| damaged())?;
    if all.len() as u64 > MAX_UNPACKED {
        return Err(damaged());
    }
    let end = all.iter().position(|byte| *byte == b'\n').ok_or_else(damaged)?;
    let header: Header = serde_json::from_slice(&all[..end]).map_err(|_| damaged())?;
    if header.steps > MAX_LINK_STEPS {
        return Err(damaged());
    }
    Ok((header, all.drain(end + 1..).collect()))
}

/// One message serves all kinds of damage, because knowing the kind would not help to repair a link.
fn damaged() -> Fault {
    Fault::new("link/damaged", "this link is incomplete or was changed; copy all of it")
}

/// The first characters of an untrusted text, for messages.
fn printable(text: &str) -> String {
    text.chars().filter(char::is_ascii_graphic).take(20).collect()
}

fn short_hash(hash: &str) -> String {
    hash.chars().take(12).collect()
}

fn bits(number: f64) -> String {
    format!("{:x}", number.to_bits())
}

/// Writes seven bits per byte, the lowest first.
fn push_number(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

fn pop_number(bytes: &mut std::collections::VecDeque<u8>) -> Option<u64> {
    let mut number = 0;
    for place in 0..9 {
        let byte = bytes.pop_front()?;
        number |= u64::from(byte & 0x7f) << (7 * place);
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}
