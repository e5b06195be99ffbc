//! [`Session`]: runs a world and answers a client's messages.

mod action;
mod album;
mod messages;

use std::collections::BTreeMap;

use driftworld_env::{Action, Catalogue, Channels, EndedBy, Environment, Event, Recorder, Recording, Step, Warning};
use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{GameMode, World};
use prost::Message;

use action::action;
use album::Album;

use crate::behavior::{ACTION_LENGTH, BEHAVIOR, behavior, words};
use crate::client::Client;
use crate::error::UnityError;
use crate::observation::{PictureForm, observations};
use crate::outbox::{MAX_OUTGOING_BYTES, Outbox};
use crate::parameters::Parameters;
use crate::protocol::{
    AgentInfoProto, CommandProto, ListAgentInfoProto, UnityOutputProto, UnityRlCapabilitiesProto,
    UnityRlInitializationInputProto, UnityRlInitializationOutputProto, UnityRlInputProto, UnityRlOutputProto,
};
use crate::remarks::{About, Remarks};
use crate::screenshots::Screenshots;

/// The version of the protocol. Every client of version 1 accepts 1.0.0; newer features are announced as capabilities.
const COMMUNICATION_VERSION: &str = "1.0.0";

/// Maximum number of bytes of a message besides observations and side channel messages.
const ENVELOPE: usize = 4096;

/// Initial settings of a session.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// The world until the client resets to another one.
    pub world: World,
    /// Layouts that replace the built-in ones.
    pub maps: MapLibrary,
    /// The models that worlds may refer to.
    pub catalogue: Catalogue,
    /// The form of images.
    pub pictures: PictureForm,
}

/// The result of a command.
#[derive(Clone, Debug, PartialEq)]
pub enum Turn {
    /// The world's output.
    Output(Box<UnityOutputProto>),
    /// The client quits.
    Quit,
}

/// The description of actions and observations that a client receives at the start, and again whenever it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Announced {
    words: [&'static str; ACTION_LENGTH],
    num_rows: Option<usize>,
    picture_size: [u32; 2],
    state_len: usize,
}

/// A world for one client.
///
/// # Example
/// ```
/// use driftworld_unity::protocol::{CommandProto, UnityRlInitializationInputProto, UnityRlInputProto};
/// use driftworld_unity::{BEHAVIOR, Screenshots, Session, Setup, Turn};
/// let mut session = Session::new(Setup::default(), Screenshots::new("screenshots"), || "2026-01-01T00:00:00Z".to_owned());
/// session.begin(&UnityRlInitializationInputProto {
///     communication_version: "1.0.0".to_owned(),
///     package_version: "0.16.0".to_owned(),
///     ..UnityRlInitializationInputProto::default()
/// })?;
/// let reset = UnityRlInputProto { command: CommandProto::Reset.into(), ..UnityRlInputProto::default() };
/// let Turn::Output(output) = session.answer(&reset)? else { panic!("a reset does not end a session") };
/// let agent = &output.rl_output.expect("there is an agent").agent_infos[BEHAVIOR].value[0];
/// assert_eq!(agent.observations[1].shape, [84, 84, 3]);
/// # Ok::<(), driftworld_unity::UnityError>(())
/// ```
pub struct Session {
    environment: Environment,
    /// The photographs of the world's objects, if the world is made for photographs.
    album: Option<Album>,
    channels: Channels,
    /// The world that a reset starts.
    start: World,
    maps: MapLibrary,
    parameters: Parameters,
    client: Client,
    pictures: PictureForm,
    screenshots: Screenshots,
    clock: Box<dyn Fn() -> String>,
    /// Number of episodes since the start of the session.
    episodes: i32,
    outbox: Outbox,
    remarks: Remarks,
    /// The behaviour as announced to the client.
    announced: Option<Announced>,
    /// Records episodes, if requested; finished ones go to `recordings`.
    recorder: Option<Recorder>,
    recordings: Vec<Recording>,
}

impl Session {
    /// Creates a session with the world at its start. `clock` returns the time in ISO 8601, for messages.
    pub fn new(setup: Setup, screenshots: Screenshots, clock: impl Fn() -> String + 'static) -> Self {
        // A world that was saved while running is reset to its start, because clients start episodes.
        let start = Environment::new(setup.world).world().clone().with_maps(&setup.maps);
        let mut session = Self {
            environment: Environment::with_catalogue(start.clone(), setup.catalogue),
            album: None,
            channels: Channels::new(&start).with_maps(setup.maps.clone()),
            start,
            maps: setup.maps,
            parameters: Parameters::default(),
            client: Client::default(),
            pictures: setup.pictures,
            screenshots,
            clock: Box::new(clock),
            episodes: 0,
            outbox: Outbox::default(),
            remarks: Remarks::default(),
            announced: None,
            recorder: None,
            recordings: Vec::new(),
        };
        // Worlds that messages reset to get their warnings from the channels.
        for warning in session.environment.warnings() {
            if warning != Warning::ForPhotographs {
                session.remarks.make(About::Worlds, &format!("world: {warning}"));
            }
        }
        session.open_album();
        session
    }

    /// The first message to a client.
    pub fn greeting() -> UnityOutputProto {
        UnityOutputProto {
            rl_output: None,
            rl_initialization_output: Some(UnityRlInitializationOutputProto {
                name: "L2Explorer".to_owned(),
                communication_version: COMMUNICATION_VERSION.to_owned(),
                brain_parameters: Vec::new(),
                package_version: format!("driftworld {}", env!("CARGO_PKG_VERSION")),
                capabilities: Some(UnityRlCapabilitiesProto {
                    base_rl_capabilities: true,
                    hybrid_actions: true,
                    ..UnityRlCapabilitiesProto::default()
                }),
            }),
        }
    }

    /// Reads the client's first message.
    ///
    /// # Errors
    /// [`UnityError::ClientVersion`] for a client with a different major version of the protocol.
    pub fn begin(&mut self, identity: &UnityRlInitializationInputProto) -> Result<(), UnityError> {
        self.client = Client::new(identity)?;
        if identity.seed != 0 {
            let remark = format!(
                "seed {}: not used, because a world has its own random numbers: the same world and actions give the same episode",
                identity.seed
            );
            self.remarks.make(About::Settings, &remark);
        }
        Ok(())
    }

    /// Carries out a client's command.
    ///
    /// Settings are applied first, then the command RESET, messages, and the command STEP. So settings apply to a reset in the same
    /// input, and objects are created in the new world. A STEP whose messages reset to another world returns the new world's start,
    /// because the action was meant for the old one.
    ///
    /// # Errors
    /// [`UnityError`] for unknown commands and actions, and for actions that cannot be carried out. Messages that cannot be
    /// understood get an answer or a remark.
    pub fn answer(&mut self, input: &UnityRlInputProto) -> Result<Turn, UnityError> {
        let Ok(command) = CommandProto::try_from(input.command) else {
            return Err(UnityError::UnknownCommand(input.command));
        };
        let messages = self.take_settings(&input.side_channel);
        if command == CommandProto::Reset {
            self.restart();
        }
        let before = self.recorder.as_ref().filter(|_| !messages.is_empty());
        let before = before.map(|recorder| (recorder.recording(&self.environment, None), self.environment.state()));
        let was_reset = self.receive(&messages);
        if let Some((recording, state)) = before {
            self.note_change(recording, &state, was_reset);
        }
        let agent_params = &self.environment.world().agent_params;
        let agents = match command {
            CommandProto::Quit => return Ok(Turn::Quit),
            CommandProto::Step if !was_reset => {
                let action = action(&input.agent_actions, agent_params)?;
                self.step(action)?
            }
            CommandProto::Step | CommandProto::Reset => {
                self.episodes += 1;
                let first = self.decision(0.0, 0)?;
                self.check_end_fits(&first)?;
                vec![first]
            }
        };
        Ok(Turn::Output(Box::new(self.output(agents))))
    }

    /// Starts recording, for [`Session::take_recordings`]. Photographs are not recorded.
    pub fn record(&mut self) {
        self.recorder = Some(Recorder::from_now(&self.environment));
    }

    /// The episodes finished since the last call.
    pub fn take_recordings(&mut self) -> Vec<Recording> {
        std::mem::take(&mut self.recordings)
    }

    /// Ends the recording of the current episode. Call it when no step follows.
    pub fn end_recording(&mut self) {
        self.keep_recording(None);
    }

    /// Records how messages changed the world: not at all, during the episode, or by a new world.
    fn note_change(&mut self, recording: Recording, before: &World, was_reset: bool) {
        if was_reset {
            if !recording.actions.is_empty() {
                self.recordings.push(recording);
            }
            self.recorder = Some(Recorder::from_now(&self.environment));
        } else if self.environment.state() != *before
            && let Some(recorder) = &mut self.recorder
        {
            recorder.edit(&self.environment);
        }
    }

    /// Stores the current episode if it has any steps, and starts the next one in the current world.
    fn keep_recording(&mut self, ended_by: Option<EndedBy>) {
        let Some(recorder) = &self.recorder else { return };
        if recorder.num_steps() > 0 {
            self.recordings.push(recorder.recording(&self.environment, ended_by));
        }
        self.recorder = Some(Recorder::from_now(&self.environment));
    }

    /// Remarks for the user of the executable since the last call, one per line.
    pub fn take_remarks(&mut self) -> Vec<String> {
        self.remarks.take()
    }

    /// Restarts the world with the current parameters.
    fn restart(&mut self) {
        // Keeps an episode that is left before its end; a finished one has already been stored.
        self.keep_recording(None);
        let mut world = self.start.clone();
        if !self.parameters.is_empty() {
            // Each number is valid on its own, but may be invalid in this world.
            match self.parameters.try_world(world.clone()) {
                Ok(changed) => world = changed,
                Err(problem) => {
                    let remark =
                        format!("environment parameters: left out in a world for which they are invalid: {problem}");
                    self.remarks.make(About::Worlds, &remark);
                }
            }
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.begin(world.clone());
        }
        self.environment.reset(world);
        self.open_album();
    }

    /// Opens the album at the first photograph, if the world is made for photographs.
    pub(super) fn open_album(&mut self) {
        let world = self.environment.world();
        self.album = None;
        if world.game_mode != GameMode::CollectImages {
            return;
        }
        match Album::open(world, self.environment.scene().catalogue()) {
            Ok(album) => self.album = Some(album),
            Err(reason) => {
                let remark = format!("collect_images: {reason}; the world runs as in mode learn");
                self.remarks.make(About::Worlds, &remark);
            }
        }
    }

    /// Carries out an action. If it ends the episode, the start of the next one follows in the same output, as in Unity.
    fn step(&mut self, action: Action) -> Result<Vec<AgentInfoProto>, UnityError> {
        let mut agent;
        if let Some(album) = &mut self.album {
            let is_over = !album.advance();
            agent = self.decision(0.0, 0)?;
            (agent.done, agent.max_step_reached) = (is_over, is_over);
        } else {
            let step = self.environment.step(action)?;
            if let Some(recorder) = &mut self.recorder {
                recorder.step(action);
            }
            let time = (self.clock)();
            for message in self.channels.after_step(&self.environment, &step, &time) {
                self.send(&message);
            }
            agent = self.decision(step.reward, collected(&step))?;
            (agent.done, agent.max_step_reached) = (step.ended(), step.truncated);
            if agent.done {
                self.keep_recording(step.ended_by);
            }
        }
        if !agent.done {
            return Ok(vec![agent]);
        }
        self.restart();
        self.episodes += 1;
        Ok(vec![agent, self.decision(0.0, 0)?])
    }

    /// Checks that the end of an episode and the start of the next fit into one message. Images sent as floats always have the
    /// same size, so this check reports the error at the start instead of during training.
    fn check_end_fits(&self, agent: &AgentInfoProto) -> Result<(), UnityError> {
        let world = self.environment.world();
        let can_end = self.album.is_some()
            || world.step_limit().is_some()
            || !world.rules.success.is_empty()
            || !world.rules.failure.is_empty();
        let found = 2 * agent.encoded_len() + ENVELOPE;
        if self.pictures == PictureForm::Floats && can_end && found > MAX_OUTGOING_BYTES {
            return Err(UnityError::TooLarge(found));
        }
        Ok(())
    }

    /// The agent's current state, before its next action.
    fn decision(&mut self, reward: f64, collected: usize) -> Result<AgentInfoProto, UnityError> {
        let (pictures, client) = (self.pictures, self.client);
        let observations = if let Some(album) = &mut self.album {
            let mut state = album.state(self.environment.world());
            // The announced length.
            state.resize(1 + self.environment.world().agent_params.state_len(), 0.0);
            observations(album.picture()?, state, pictures, client)?
        } else {
            let mut state = vec![collected as f32];
            state.extend(self.environment.state_vector());
            observations(self.environment.observe(), state, pictures, client)?
        };
        Ok(AgentInfoProto {
            // Clients do not accept infinity.
            reward: (reward as f32).clamp(f32::MIN, f32::MAX),
            done: false,
            max_step_reached: false,
            id: self.episodes,
            observations,
        })
    }

    fn output(&mut self, agents: Vec<AgentInfoProto>) -> UnityOutputProto {
        let agent = &self.environment.world().agent_params;
        let announced_now = Announced {
            words: words(agent),
            num_rows: agent.num_actions(),
            picture_size: agent.picture_size(),
            state_len: agent.state_len(),
        };
        let description = (self.announced != Some(announced_now)).then(|| UnityRlInitializationOutputProto {
            brain_parameters: vec![behavior(agent, self.client)],
            ..UnityRlInitializationOutputProto::default()
        });
        self.announced = Some(announced_now);
        let mut rl_output = UnityRlOutputProto {
            agent_infos: BTreeMap::from([(BEHAVIOR.to_owned(), ListAgentInfoProto { value: agents })]),
            side_channel: Vec::new(),
        };
        let room = MAX_OUTGOING_BYTES.saturating_sub(rl_output.encoded_len() + ENVELOPE);
        rl_output.side_channel = self.outbox.take(room);
        let num_dropped = self.outbox.take_num_dropped();
        if num_dropped > 0 {
            let remark = format!("{num_dropped} messages were left out: they do not fit next to the observations");
            self.remarks.make_once(About::Refusals, "left out", &remark);
        }
        UnityOutputProto {
            rl_output: Some(rl_output),
            rl_initialization_output: description,
        }
    }
}

/// The number, from 1, of the object that a step collected: the last one that paid or was destroyed; 0 for none.
fn collected(step: &Step) -> usize {
    let is_collected = |event: &&Event| event.destroyed || event.reward != 0.0;
    let last = step.events.iter().rfind(is_collected);
    last.map_or(0, |event| event.object + 1)
}
