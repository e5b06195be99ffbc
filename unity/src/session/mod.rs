//! [`Session`]: what a world answers to what a client says. How messages beside commands are taken is in `messages.rs`; how all
//! of it travels, in `serve.rs`.

mod messages;

use std::collections::BTreeMap;

use driftworld_env::{Action, Channels, Environment, Event, Step};
use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{ActionSpace, World};
use prost::Message;

use crate::behavior::{ACTION_LENGTH, BEHAVIOR, behavior, words};
use crate::client::Client;
use crate::error::UnityError;
use crate::observation::{PictureForm, observations};
use crate::outbox::{MAX_OUTGOING_BYTES, Outbox};
use crate::parameters::Parameters;
use crate::protocol::unity_rl_input_proto::ListAgentActionProto;
use crate::protocol::unity_rl_output_proto::ListAgentInfoProto;
use crate::protocol::{
    AgentInfoProto, CommandProto, UnityOutputProto, UnityRlCapabilitiesProto, UnityRlInitializationInputProto,
    UnityRlInitializationOutputProto, UnityRlInputProto, UnityRlOutputProto,
};
use crate::remarks::{About, Remarks};
use crate::screenshots::Screenshots;

/// The version of the protocol: every client of version 1 accepts the first, and what newer ones can do beyond it they say.
const COMMUNICATION_VERSION: &str = "1.0.0";

/// Bytes of a message that are neither observations nor messages beside them.
const ENVELOPE: usize = 4096;

/// What a session begins with.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// The world until the client resets to one of its own.
    pub world: World,
    /// Layouts that take the place of the built-in ones.
    pub maps: MapLibrary,
    /// How pictures travel.
    pub pictures: PictureForm,
}

/// What comes of a command.
#[derive(Clone, Debug, PartialEq)]
pub enum Turn {
    /// What happened.
    Output(Box<UnityOutputProto>),
    /// The client is done.
    Quit,
}

/// What a client is told of the behaviour once, and again when it is not so any more: what the numbers of an action mean, and how
/// many numbers observations have.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Announced {
    words: [&'static str; ACTION_LENGTH],
    picture_size: [u32; 2],
    state_len: usize,
}

/// One client's world.
///
/// # Example
/// ```
/// use driftworld_unity::protocol::{CommandProto, UnityRlInitializationInputProto, UnityRlInputProto};
/// use driftworld_unity::{BEHAVIOR, Screenshots, Session, Setup, Turn};
/// let mut session = Session::new(Setup::default(), Screenshots::new("screenshots"), || "2026-01-01T00:00:00Z".to_owned())?;
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
    channels: Channels,
    /// What a reset begins.
    start: World,
    maps: MapLibrary,
    parameters: Parameters,
    client: Client,
    pictures: PictureForm,
    screenshots: Screenshots,
    clock: Box<dyn Fn() -> String>,
    /// Episodes since the start of the session.
    episodes: i32,
    outbox: Outbox,
    remarks: Remarks,
    /// What the client knows of the behaviour.
    announced: Option<Announced>,
}

impl Session {
    /// A session whose world is at its start. `clock` tells the time in ISO 8601, for messages.
    ///
    /// # Errors
    /// [`UnityError::Env`] for a world that cannot start; none today.
    pub fn new(
        setup: Setup,
        screenshots: Screenshots,
        clock: impl Fn() -> String + 'static,
    ) -> Result<Self, UnityError> {
        let Setup { world, maps, pictures } = setup;
        // A world that was written down while it ran is taken back to its start: clients begin episodes.
        let mut start = Environment::new(world)?.world().clone();
        maps.apply(&mut start);
        Ok(Self {
            environment: Environment::new(start.clone())?,
            channels: Channels::new(&start),
            start,
            maps,
            parameters: Parameters::default(),
            client: Client::default(),
            pictures,
            screenshots,
            clock: Box::new(clock),
            episodes: 0,
            outbox: Outbox::default(),
            remarks: Remarks::default(),
            announced: None,
        })
    }

    /// The first thing said to a client.
    pub fn greeting(&self) -> UnityOutputProto {
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

    /// Hears who the client is.
    ///
    /// # Errors
    /// [`UnityError::ClientVersion`] for a client of another major version of the protocol.
    pub fn begin(&mut self, said: &UnityRlInitializationInputProto) -> Result<(), UnityError> {
        self.client = Client::new(said)?;
        if said.seed != 0 {
            let remark = format!(
                "seed {}: not used, the chance of a world is its own: the same world and actions give the same episode",
                said.seed
            );
            self.remarks.make(About::Settings, remark);
        }
        Ok(())
    }

    /// Does what the client says.
    ///
    /// Settings come first, then the command RESET, then messages, then the command STEP: what is set counts for the reset beside
    /// it, and what is put into a world goes into the new one. A STEP whose messages reset to another world shows its start; the
    /// action was meant for the old one.
    ///
    /// # Errors
    /// [`UnityError`] for commands and actions that there are not, and for actions that cannot be carried out. Messages that
    /// cannot be understood are answered, or remarked.
    pub fn answer(&mut self, input: &UnityRlInputProto) -> Result<Turn, UnityError> {
        let Ok(command) = CommandProto::try_from(input.command) else {
            return Err(UnityError::UnknownCommand { found: input.command });
        };
        let messages = self.take_settings(&input.side_channel);
        if command == CommandProto::Reset {
            self.restart()?;
        }
        let is_renewed = self.receive(&messages)?;
        let agents = match command {
            CommandProto::Quit => return Ok(Turn::Quit),
            CommandProto::Step if !is_renewed => self.step(action(&input.agent_actions)?)?,
            CommandProto::Step | CommandProto::Reset => {
                self.episodes += 1;
                let first = self.decision(0.0, 0)?;
                self.check_end_fits(&first)?;
                vec![first]
            }
        };
        Ok(Turn::Output(Box::new(self.output(agents))))
    }

    /// What the user of the executable should know since the last time, a line each.
    pub fn take_remarks(&mut self) -> Vec<String> {
        self.remarks.take()
    }

    /// Begins the world anew, with what has been set.
    fn restart(&mut self) -> Result<(), UnityError> {
        let mut world = self.start.clone();
        if !self.parameters.is_empty() {
            // Each number alone is sound; together with this world they may not be.
            match self.parameters.try_world(world.clone()) {
                Ok(changed) => world = changed,
                Err(problem) => {
                    let remark =
                        format!("environment parameters: left out for a world that they do not suit: {problem}");
                    self.remarks.make(About::Worlds, remark);
                }
            }
        }
        if matches!(
            world.agent_params.actions,
            ActionSpace::Discrete(_) | ActionSpace::DefaultDiscrete
        ) {
            let remark = "world: its table of actions is not used, clients are told of three numbers".to_owned();
            self.remarks.make(About::Worlds, remark);
        }
        Ok(self.environment.reset(world)?)
    }

    /// Carries out an action; an episode that it ends is followed by the start of the next one, as Unity has it.
    fn step(&mut self, action: [f64; ACTION_LENGTH]) -> Result<Vec<AgentInfoProto>, UnityError> {
        let step = self.environment.step(Action::Continuous(action))?;
        let time = (self.clock)();
        for message in self.channels.after_step(&self.environment, &step, &time) {
            self.send(&message);
        }
        let mut agent = self.decision(step.reward, collected(&step))?;
        if !step.ended() {
            return Ok(vec![agent]);
        }
        agent.done = true;
        agent.max_step_reached = step.truncated;
        self.restart()?;
        self.episodes += 1;
        Ok(vec![agent, self.decision(0.0, 0)?])
    }

    /// The end of an episode and the start of the next travel in one message. Floats are always as many: where two of them will not
    /// fit, that is said at the start, not in the midst of a training.
    fn check_end_fits(&self, agent: &AgentInfoProto) -> Result<(), UnityError> {
        let world = self.environment.world();
        let can_end = world.max_steps > 0 || !world.rules.success.is_empty() || !world.rules.failure.is_empty();
        let (found, limit) = (2 * agent.encoded_len() + ENVELOPE, MAX_OUTGOING_BYTES);
        if self.pictures == PictureForm::Floats && can_end && found > limit {
            return Err(UnityError::TooLarge { found, limit });
        }
        Ok(())
    }

    /// The agent as it is now, before its next action.
    fn decision(&mut self, reward: f64, collected: usize) -> Result<AgentInfoProto, UnityError> {
        let mut state = vec![collected as f32];
        state.extend(self.environment.state_vector());
        let (pictures, client) = (self.pictures, self.client);
        Ok(AgentInfoProto {
            // Clients take no infinity.
            reward: (reward as f32).clamp(f32::MIN, f32::MAX),
            done: false,
            max_step_reached: false,
            id: self.episodes,
            observations: observations(self.environment.observe(), state, pictures, client)?,
        })
    }

    fn output(&mut self, agents: Vec<AgentInfoProto>) -> UnityOutputProto {
        let agent = &self.environment.world().agent_params;
        let now = Announced {
            words: words(agent),
            picture_size: agent.picture_size(),
            state_len: agent.state_len(),
        };
        let news = (self.announced != Some(now)).then(|| UnityRlInitializationOutputProto {
            brain_parameters: vec![behavior(agent, self.client)],
            ..UnityRlInitializationOutputProto::default()
        });
        self.announced = Some(now);
        let mut rl_output = UnityRlOutputProto {
            agent_infos: BTreeMap::from([(BEHAVIOR.to_owned(), ListAgentInfoProto { value: agents })]),
            side_channel: Vec::new(),
        };
        let room = MAX_OUTGOING_BYTES.saturating_sub(rl_output.encoded_len() + ENVELOPE);
        rl_output.side_channel = self.outbox.take(room);
        let left_out = self.outbox.take_left_out();
        if left_out > 0 {
            let remark = format!("{left_out} messages were left out: they do not fit beside the observations");
            self.remarks.make_once(About::Refusals, "left out", remark);
        }
        UnityOutputProto {
            rl_output: Some(rl_output),
            rl_initialization_output: news,
        }
    }
}

/// The one agent's action; without any, it does nothing.
fn action(actions: &BTreeMap<String, ListAgentActionProto>) -> Result<[f64; ACTION_LENGTH], UnityError> {
    let mut numbers = [0.0; ACTION_LENGTH];
    for (behavior, ListAgentActionProto { value }) in actions {
        let ([action], BEHAVIOR) = (value.as_slice(), behavior.as_str()) else {
            return Err(UnityError::WrongAgent {
                behavior: behavior.chars().take(60).collect(),
                found: value.len(),
            });
        };
        let found = if action.continuous_actions.is_empty() {
            &action.vector_actions
        } else {
            &action.continuous_actions
        };
        if found.len() != ACTION_LENGTH {
            return Err(UnityError::ActionLength { found: found.len() });
        }
        numbers = std::array::from_fn(|place| f64::from(found[place]));
    }
    Ok(numbers)
}

/// The object that a step collected, by its number from 1: the last that paid or was destroyed; 0 for none.
fn collected(step: &Step) -> usize {
    let is_collected = |event: &&Event| event.destroyed || event.reward != 0.0;
    let last = step.events.iter().rfind(is_collected);
    last.map_or(0, |event| event.object + 1)
}
