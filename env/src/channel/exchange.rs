//! [`Channels`] carries out requests and answers them.

use driftworld_spec::World;
use driftworld_spec::maps::MapLibrary;
use driftworld_text::amount;
use serde_json::{Value, json};

use super::Channel;
use super::category::{Category, Level};
use super::message::{Message, Outgoing, Refusal, unknown};
use super::request::{PARTS, Screenshot, categories, create, parts, remark_of, screenshot};
use crate::{Environment, Step, Warning};

/// The server's end of the three channels. Stores which parts of the world are observed, and which remarks are wanted. The
/// caller transports messages, provides the time, and writes screenshots. A message that is not understood is answered with an
/// `error` and changes nothing. Tokens have the form of a UUID (version 8) and are derived from the world's hash and a count,
/// so that the same messages always give the same answers.
///
/// # Example
/// ```
/// use driftworld_env::{Channel, Channels, Environment};
/// use driftworld_spec::World;
/// let mut environment = Environment::new(World::default());
/// let mut channels = Channels::new(environment.world());
/// let spawn = r#"{ "token": "a", "action": "object_create", "payload": { "class": "tree", "coordinates": [3, 4] } }"#;
/// let answer = channels.receive(&mut environment, Channel::Reset, spawn, "2026-01-01T00:00:00");
/// assert_eq!((answer.messages[0].action, answer.messages[0].req_token.as_deref()), ("ok", Some("a")));
/// assert_eq!(environment.objects().len(), 1);
/// ```
#[derive(Clone, Debug)]
pub struct Channels {
    /// The hash of the world of the last reset.
    world: String,
    /// Layouts that replace the built-in ones in worlds of later resets.
    maps: MapLibrary,
    sent: u64,
    /// The parts that are sent after each step, out of [`PARTS`].
    watched: Vec<&'static str>,
    /// Whether each of [`Category::ALL`] is on.
    active: [bool; 4],
}

/// The result of a message.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Received {
    /// The answers, in order.
    pub messages: Vec<Outgoing>,
    /// A screenshot to be written before [`Channels::answer_screenshot`] answers the request.
    pub screenshot: Option<Screenshot>,
    /// Whether the message has reset the environment to a new world.
    pub reset: bool,
    /// Warnings about a new world or object: unknown keys and unknown assets. The Debug channel sends the same warnings to
    /// clients that listen to `worldmaker`.
    pub remarks: Vec<String>,
}

/// The answer to a message that was understood.
enum Answer {
    Say(&'static str, Option<Value>),
    Picture(Screenshot),
}

const OK: Answer = Answer::Say("ok", None);

impl Channels {
    /// Channels for a world at its start. No parts are observed, and no remarks are wanted.
    pub fn new(world: &World) -> Self {
        Self {
            world: world.hash(),
            maps: MapLibrary::default(),
            sent: 0,
            watched: Vec::new(),
            active: [false; 4],
        }
    }

    /// Replaces the built-in layouts in worlds of later resets.
    #[must_use]
    pub fn with_maps(mut self, maps: MapLibrary) -> Self {
        self.maps = maps;
        self
    }

    /// Whether remarks of a category are wanted.
    pub fn is_active(&self, category: Category) -> bool {
        // One entry for each of `Category::ALL`, in the order of the enum.
        self.active[category as usize]
    }

    /// Turns the remarks of a category on or off, as `set_debug_categories` does.
    pub fn set_active(&mut self, category: Category, active: bool) {
        // One entry per category, as above.
        self.active[category as usize] = active;
    }

    /// The parts of the world that are sent after each step.
    pub fn watched(&self) -> &[&'static str] {
        &self.watched
    }

    /// Carries out the request in a message. `time` is the current time in ISO 8601.
    pub fn receive(&mut self, environment: &mut Environment, channel: Channel, text: &str, time: &str) -> Received {
        let mut received = Received::default();
        let (token, answer) = match Message::parse(text) {
            Ok(message) => {
                let text = format!("{} received {:.40}", channel.name(), message.action);
                let remark = self.remark(Category::Communications, Level::Log, text, time);
                received.messages.extend(remark);
                let answer = self.execute(environment, channel, &message, time, &mut received);
                (message.token, answer)
            }
            Err((token, refusal)) => (token, Err(refusal)),
        };
        let messages = &mut received.messages;
        match answer {
            Ok(Answer::Say(action, payload)) => messages.push(self.message(channel, action, payload, token, time)),
            Ok(Answer::Picture(screenshot)) => received.screenshot = Some(Screenshot { token, ..screenshot }),
            Err(refusal) => {
                // A refusal always has at least one text.
                let text = format!("{} refused: {}", channel.name(), refusal.texts()[0]);
                messages.extend(self.remark(Category::Communications, Level::Error, text, time));
                let payload = Some(json!(refusal.texts()));
                messages.push(self.message(channel, "error", payload, token, time));
            }
        }
        received
    }

    /// The answer to a message that is not text.
    pub fn refuse(&mut self, channel: Channel, reason: &str, time: &str) -> Outgoing {
        let payload = Some(json!([format!("message: {reason}")]));
        self.message(channel, "error", payload, None, time)
    }

    /// The answer to a request for a screenshot, once it has been written or has failed.
    pub fn answer_screenshot(&mut self, screenshot: &Screenshot, written: Result<(), String>, time: &str) -> Outgoing {
        let token = screenshot.token.clone();
        match written {
            Ok(()) => self.message(Channel::Debug, "ok", None, token, time),
            Err(text) => self.message(Channel::Debug, "error", Some(json!([text])), token, time),
        }
    }

    /// Messages to send after a step: remarks on its events, then the observed parts of the world.
    pub fn after_step(&mut self, environment: &Environment, step: &Step, time: &str) -> Vec<Outgoing> {
        let mut messages = Vec::new();
        for event in &step.events {
            let object = &environment.world().objects[event.object];
            let gone = if event.destroyed { ", destroyed" } else { "" };
            let text = format!(
                "{:?} object {} ({}), reward {}{gone}",
                event.stimulus,
                event.object,
                object.class,
                amount(event.reward)
            );
            messages.extend(self.remark(Category::Agent, Level::Log, text, time));
        }
        if step.ended() {
            let ending = match (step.success, step.terminated) {
                (true, _) => "as a success",
                (false, true) => "as a failure",
                (false, false) => "at its last step",
            };
            let (steps, earned) = (environment.num_steps(), amount(environment.episode_return()));
            let text = format!("the episode ended {ending} after {steps} steps, return {earned}");
            messages.extend(self.remark(Category::Academy, Level::Log, text, time));
        }
        if !self.watched.is_empty() {
            let payload = Some(self.state(environment));
            messages.push(self.message(Channel::State, "state", payload, None, time));
        }
        messages
    }

    /// A remark on the Debug channel, if its category is on.
    pub fn remark(
        &mut self,
        category: Category,
        level: Level,
        text: impl Into<String>,
        time: &str,
    ) -> Option<Outgoing> {
        self.is_active(category).then(|| {
            let payload = json!({
                "category": category.name(), "level": <&str>::from(level), "message": text.into(), "stack_trace": "",
            });
            self.message(Channel::Debug, "debug_message", Some(payload), None, time)
        })
    }

    fn execute(
        &mut self,
        environment: &mut Environment,
        channel: Channel,
        message: &Message,
        time: &str,
        received: &mut Received,
    ) -> Result<Answer, Refusal> {
        if let Some(expected) = Channel::for_action(&message.action).filter(|expected| *expected != channel) {
            return Err(Refusal::new(format!(
                "action: found {:?} on the {} channel, expected it on the {} channel",
                message.action,
                channel.name(),
                expected.name()
            )));
        }
        match message.action.as_str() {
            "reset_environment" => {
                let remarks = self.reset(environment, message)?;
                received.reset = true;
                let text = format!("a new episode of world {:.12}", self.world);
                let remark = self.remark(Category::Academy, Level::Log, text, time);
                received.messages.extend(remark);
                self.warn(remarks, time, received);
                Ok(OK)
            }
            "object_create" => {
                let (index, remarks) = create(environment, message)?;
                let text = format!("object {index} is a {}", environment.world().objects[index].class);
                let remark = self.remark(Category::Worldmaker, Level::Log, text, time);
                received.messages.extend(remark);
                self.warn(remarks, time, received);
                Ok(OK)
            }
            "get_observers" => Ok(Answer::Say("observer_list", Some(json!({ "state": PARTS })))),
            "set_active_observers" => {
                self.watched = parts(message)?;
                Ok(OK)
            }
            "save_screenshot" => screenshot(environment, message).map(Answer::Picture),
            "get_debug_categories" => Ok(Answer::Say("debug_categories", Some(json!(Category::names())))),
            "set_debug_categories" => {
                for (category, active) in categories(message)? {
                    self.set_active(category, active);
                }
                Ok(OK)
            }
            other => Err(unknown("action", other, channel.actions())),
        }
    }

    /// Reports remarks on a new world or object to the caller and to listening clients.
    fn warn(&mut self, remarks: Vec<String>, time: &str, received: &mut Received) {
        for text in remarks {
            received.remarks.push(text.clone());
            let remark = self.remark(Category::Worldmaker, Level::Warning, text, time);
            received.messages.extend(remark);
        }
    }

    /// Resets to the world in the payload, and returns remarks on it.
    fn reset(&mut self, environment: &mut Environment, message: &Message) -> Result<Vec<String>, Refusal> {
        let payload = message.payload("a world as in L2Explorer's reset files")?;
        let (world, warnings) = World::from_l2explorer_with("payload", &payload.to_string(), &self.maps)
            .map_err(|error| Refusal::of_document(&error))?;
        let hash = world.hash();
        environment.reset(world);
        self.world = hash;
        // Objects in walls have already been reported while parsing the world, with their positions.
        let mut own = environment.warnings();
        own.retain(|warning| !matches!(warning, Warning::StandsInWall { .. }));
        let own = own.into_iter().map(|warning| warning.to_string());
        Ok(warnings.iter().map(remark_of).chain(own).collect())
    }

    /// The current state of the observed parts of the world. Absent objects are left out; objects without a name get one
    /// derived from their index.
    fn state(&self, environment: &Environment) -> Value {
        let world = environment.world();
        let part = |part: &str| match part {
            "agent_params" => json!(environment.agent_now()),
            "environment_params" => json!(world.environment_params),
            "objects" => objects_now(environment),
            _ => json!(world.game_mode),
        };
        self.watched
            .iter()
            .map(|name| ((*name).to_owned(), part(name)))
            .collect()
    }

    fn message(
        &mut self,
        channel: Channel,
        action: &'static str,
        payload: Option<Value>,
        req_token: Option<String>,
        time: &str,
    ) -> Outgoing {
        self.sent += 1;
        // The token takes 18 of the hash's 64 digits, which is all that UUID version 8 leaves free besides the count.
        let hash = &self.world;
        let token = format!(
            "{}-{}-8{}-8{}-{:012x}",
            &hash[..8],
            &hash[8..12],
            &hash[12..15],
            &hash[15..18],
            self.sent & 0xffff_ffff_ffff
        );
        Outgoing {
            channel,
            action,
            payload,
            token,
            req_token,
            time: time.to_owned(),
        }
    }
}

/// The present objects in their current state, each with a name.
fn objects_now(environment: &Environment) -> Value {
    let states = environment.objects().iter().enumerate();
    let present = states.filter(|(_, state)| state.present);
    let with_name = present.map(|(index, _)| {
        let mut object = environment.object_now(index);
        object.unique_name.get_or_insert_with(|| format!("object-{index}"));
        json!(object)
    });
    Value::Array(with_name.collect())
}
