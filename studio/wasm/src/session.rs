//! [`Session`]: holds a page's open episodes, networks and log, and answers its calls.

use std::collections::BTreeMap;

use driftworld::env::NetworkAgent;
use driftworld::spec::By;
use serde_json::{Value, json};

use crate::call::{Call, method};
use crate::compare;
use crate::episode::{Episode, Networks};
use crate::fault::Fault;
use crate::link;
use crate::log::Log;
use crate::request::{TaskCache, in_style, is_text};
use crate::tasks;

/// Maximum number of open episodes: each keeps pictures and snapshots in memory.
const MAX_EPISODES: usize = 64;

/// Everything that a page has open.
#[derive(Default)]
pub struct Session {
    tasks: TaskCache,
    episodes: BTreeMap<u32, Episode>,
    next_id: u32,
    networks: Networks,
    log: Log,
}

impl Session {
    /// Answers a call in JSON; a network or files are passed as bytes. The answer is `{"ok": …}` or `{"error": …}`; the
    /// pixels of a frame are returned as bytes.
    ///
    /// # Example
    /// ```
    /// use driftworld_wasm::Session;
    /// let mut session = Session::default();
    /// let (answer, _) = session.call(r#"{ "call": "open", "request": { "task": "find_objects" } }"#, &[]);
    /// assert!(answer.starts_with(r#"{"ok":{"#));
    /// let (answer, _) = session.call(r#"{ "call": "now", "episode": 9 }"#, &[]);
    /// assert!(answer.starts_with(r#"{"error":{"#));
    /// ```
    pub fn call(&mut self, call: &str, bytes: &[u8]) -> (String, Vec<u8>) {
        let mut pixels = Vec::new();
        let answer = serde_json::from_str(call)
            .map_err(|error| Fault::request(format!("call: found {error}, expected one of those in engine.ts")))
            .and_then(|call| self.answer(call, bytes, &mut pixels));
        let answer = match answer {
            Ok(found) => json!({ "ok": found }),
            Err(fault) => json!({ "error": fault.json() }),
        };
        (answer.to_string(), pixels)
    }

    #[expect(clippy::too_many_lines, reason = "a flat list of calls")]
    fn answer(&mut self, call: Call, bytes: &[u8], pixels: &mut Vec<u8>) -> Result<Value, Fault> {
        Ok(match call {
            Call::Version => json!(env!("CARGO_PKG_VERSION")),
            Call::Tasks => tasks::cards()?,
            Call::Task { task } => {
                let found = self.tasks.task(&task)?;
                let text = if is_text(&task) {
                    &task
                } else {
                    driftworld::tasks::text_by_name(&task).unwrap_or(&task)
                };
                tasks::describe(&found, text)
            }
            Call::Validate { text } => tasks::validate(&text),
            Call::Schema { kind } => tasks::schema_of(&kind)?,
            Call::Sample { request } => json!(self.tasks.world(&request)?.to_json_pretty()),
            Call::Open { request, style, size } => {
                let world = in_style(self.tasks.world(&request)?, style)?;
                self.store(Episode::new(world, size))?
            }
            Call::Step { episode, steps } => {
                let episode = self.episode(episode)?;
                let mut taken = Vec::with_capacity(steps.len());
                for command in steps {
                    if !taken.is_empty() && episode.ended() {
                        break;
                    }
                    episode.step(command)?;
                    taken.push(episode.now());
                }
                Value::Array(taken)
            }
            Call::Choose { episode, agent } => {
                let (episodes, networks) = (&mut self.episodes, &self.networks);
                json!(open(episodes, episode)?.choose(agent, networks)?)
            }
            Call::Act { episode, agent } => {
                let episode = open(&mut self.episodes, episode)?;
                episode.act(agent, &self.networks)?;
                episode.now()
            }
            Call::Seek { episode, step } => {
                let episode = self.episode(episode)?;
                episode.seek(step)?;
                episode.now()
            }
            Call::Now { episode } => self.episode(episode)?.now(),
            Call::Frame {
                episode,
                view,
                modality,
                size,
            } => {
                let ([width, height], data) = self.episode(episode)?.frame(view, modality, size)?;
                *pixels = data;
                json!({ "width": width, "height": height })
            }
            Call::Map { episode } => self.episode(episode)?.map(),
            Call::Actions { episode } => json!(self.episode(episode)?.actions()),
            Call::Recording { episode } => json!(self.episode(episode)?.recording()),
            Call::Close { episode } => json!(self.episodes.remove(&episode).is_some()),
            Call::Network => {
                self.networks.push(NetworkAgent::parse("network", bytes)?);
                json!(self.networks.len() - 1)
            }
            Call::Run { request, agent, steps } => {
                let mut episode = Episode::new(self.tasks.world(&request)?, None);
                for _ in 0..steps {
                    if episode.ended() {
                        break;
                    }
                    episode.act(agent, &self.networks)?;
                }
                episode.outcome()
            }
            Call::Measures => json!(By::names()),
            Call::Distance {
                a,
                b,
                by,
                worlds,
                seed,
                as_worlds,
            } => {
                let a = self.tasks.side(&a, as_worlds)?;
                compare::distance(&a, &self.tasks.side(&b, as_worlds)?, by, worlds, seed)?
            }
            Call::Elements {
                task,
                a,
                b,
                worlds,
                seed,
            } => compare::elements(&mut self.tasks, &task, [&a, &b], worlds, seed)?,
            Call::Matrix(selection) => compare::matrix(&mut self.tasks, &selection)?,
            Call::Order {
                selection,
                method: name,
                start,
                seed,
            } => compare::order_variants(
                &mut self.tasks,
                &selection,
                method(name.as_deref())?,
                start.as_deref(),
                seed,
            )?,
            Call::Log { files } => {
                let (log, found) = Log::read(&files, bytes)?;
                self.log = log;
                found
            }
            Call::OpenLogged {
                experience,
                style,
                size,
            } => {
                let recording = self.log.recording(experience)?;
                if !recording.edits.is_empty() {
                    return Err(Fault::request(format!(
                        "experience: found {experience}, which was changed from outside, expected one that was not; show it with \
                         `driftworld replay`"
                    )));
                }
                let world = in_style(recording.world, style)?;
                self.store(Episode::with_actions(world, recording.actions, size))?
            }
            Call::EncodeLink { link } => json!(link::encode(&mut self.tasks, link)?),
            Call::DecodeLink { fragment } => json!(link::decode(&mut self.tasks, &fragment)?),
        })
    }

    /// Stores an episode, and returns its description with its number.
    fn store(&mut self, episode: Episode) -> Result<Value, Fault> {
        if self.episodes.len() == MAX_EPISODES {
            return Err(Fault::request(format!(
                "open: found {MAX_EPISODES} open episodes, expected fewer; close some"
            )));
        }
        let mut description = episode.description();
        description["id"] = json!(self.next_id);
        self.episodes.insert(self.next_id, episode);
        self.next_id += 1;
        Ok(description)
    }

    fn episode(&mut self, id: u32) -> Result<&mut Episode, Fault> {
        open(&mut self.episodes, id)
    }
}

fn open(episodes: &mut BTreeMap<u32, Episode>, id: u32) -> Result<&mut Episode, Fault> {
    episodes.get_mut(&id).ok_or_else(|| {
        Fault::new(
            "engine/lost",
            format!("episode: found {id}, expected one that is open; open it again"),
        )
    })
}
