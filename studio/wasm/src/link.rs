//! Encodes an episode as the fragment of an address: base64url of the format's version, a checksum, and deflated data:
//! a line of JSON with the world and the outcome, then a number for each step.
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

use crate::call::{AgentName, Link, Taken};
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

/// The agents that repeat their actions exactly. Each has two numbers: one for continuing, and one for starting anew.
const AGENTS: [AgentName; 2] = [AgentName::Planner, AgentName::Random];
/// Step numbers below this are those of agents; larger ones are indices into the list of actions, plus this.
const LISTED: u64 = 2 * AGENTS.len() as u64;

/// The contents of the line of JSON.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Header {
    /// The version of Driftworld.
    by: String,
    request: WorldRequest,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    looks: Option<Style>,
    steps: usize,
    /// The beginning of the world's hash.
    hash: String,
    /// The bits of the return, in hexadecimal.
    total: String,
    /// The actions that steps refer to by index.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    listed: Vec<Taken>,
}

/// The agents that are queried during an episode for the actions they would take.
#[derive(Default)]
struct Asked([Option<Box<dyn Agent>>; AGENTS.len()]);

impl Asked {
    /// The action of an agent that continues (even numbers) or starts anew (odd). Then only this agent can continue.
    fn act(&mut self, number: usize, environment: &Environment) -> Option<Action> {
        let (own, is_new) = (number / 2, number % 2 == 1);
        let mut acting = if is_new {
            Some(agent(AGENTS[own], &Vec::new()).ok()?)
        } else {
            self.0[own].take()
        }?;
        let action = acting.act(environment);
        *self = Self::default();
        self.0[own] = Some(acting);
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
pub(crate) fn encoded(tasks: &mut TaskCache, link: Link) -> Result<String, Fault> {
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
    let (mut asked, mut listed, mut numbers) = (Asked::default(), Vec::<Action>::new(), Vec::new());
    for taken in &link.actions {
        let action = Action::from(*taken);
        // An index for a discrete action is as short as an agent's number, and faster to decode.
        let number = match action {
            Action::Discrete(_) => None,
            Action::Continuous(_) => chosen_again(&mut asked, &environment, action),
        };
        numbers.push(number.unwrap_or_else(|| {
            asked = Asked::default();
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
        listed: listed.into_iter().map(Taken::from).collect(),
    };
    let mut unpacked = serde_json::to_vec(&header).expect("keys are strings, and numbers were checked by steps");
    unpacked.push(b'\n');
    for number in numbers {
        push_number(&mut unpacked, number);
    }
    let mut deflater = DeflateEncoder::new(Vec::new(), Compression::best());
    let packed = deflater.write_all(&unpacked).and_then(|()| deflater.finish());
    let packed = packed.expect("writing into memory cannot fail");
    let mut bytes = vec![FORMAT];
    bytes.extend(crc32fast::hash(&packed).to_le_bytes());
    bytes.extend(packed);
    Ok(URL_SAFE_NO_PAD.encode(bytes))
}

/// The number of an agent that would also have chosen this action.
fn chosen_again(asked: &mut Asked, environment: &Environment, action: Action) -> Option<u64> {
    for own in 0..AGENTS.len() {
        // An agent that acted until now continues; if its action differs, it may have started anew.
        let first = 2 * own + usize::from(asked.0[own].is_none());
        for number in first..2 * own + 2 {
            let mut trying = Asked::default();
            if number % 2 == 0 {
                trying.0[own] = asked.0[own].take();
            }
            if trying.act(number, environment).is_some_and(|would| same(would, action)) {
                *asked = trying;
                return Some(number as u64);
            }
        }
    }
    None
}

/// Decodes an episode from a fragment, and replays it to check that it is the same.
pub(crate) fn decoded(tasks: &mut TaskCache, fragment: &str) -> Result<Link, Fault> {
    let (header, mut numbers) = unpacked(fragment)?;
    let other = |what: &str| {
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
        .map_err(|fault| other(&format!("an episode ({}) that was", fault.message)))?;
    if short_hash(&world.hash()) != header.hash {
        return Err(other("a world that is not the one here, in an episode"));
    }
    let mut environment = Environment::new(in_style(world, header.looks)?);
    let (mut asked, mut actions) = (Asked::default(), Vec::with_capacity(header.steps));
    for _ in 0..header.steps {
        let number = pop_number(&mut numbers).ok_or_else(damaged)?;
        let action = if number < LISTED {
            asked.act(number as usize, &environment)
        } else {
            asked = Asked::default();
            let listed = header.listed.get((number - LISTED) as usize);
            listed.copied().map(Action::from)
        };
        let action = action.ok_or_else(damaged)?;
        if environment.ended() || environment.step(action).is_err() {
            return Err(other("steps that cannot be taken here, in an episode"));
        }
        actions.push(Taken::from(action));
    }
    if !numbers.is_empty() {
        return Err(damaged());
    }
    if bits(environment.episode_return()) != header.total {
        return Err(other("rewards that are not paid here, in an episode"));
    }
    Ok(Link {
        request: header.request,
        looks: header.looks,
        actions,
    })
}

/// Unpacks a fragment: the line of JSON, and the numbers.
fn unpacked(fragment: &str) -> Result<(Header, std::collections::VecDeque<u8>), Fault> {
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

/// The message is the same for all kinds of damage: knowing the kind does not help to repair a link.
fn damaged() -> Fault {
    Fault::new("link/damaged", "this link is cut or was changed; copy all of it")
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
