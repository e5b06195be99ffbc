//! [`Episode`]: a running world with all actions taken in it, so that it can return to any step; also its map and pictures.

use driftworld::env::{
    Action, Agent, Camera, Environment, EpisodeOrigin, Frame, NetworkAgent, OnRailsAgent, Paint, RandomAgent,
    Recording, RecordingLines, Snapshot, Step, StillAgent, top_down,
};
use driftworld::modality;
use driftworld::spec::{ActionModel, ActionSpace, Modality, World};
use serde_json::{Value, json};

use crate::call::{AgentName, StepInput, View};
use crate::fault::Fault;

/// Number of steps between snapshots.
const SNAPSHOT_INTERVAL: usize = 64;

/// Number of corners of the polygon that stands for a disc on the map.
const DISC_CORNERS: usize = 32;

/// The networks that the page passed, by number.
pub(crate) type Networks = Vec<NetworkAgent>;

/// A new agent; its seed is 0, the default of the command's `--agent-seed`.
pub(crate) fn agent(name: AgentName, networks: &Networks) -> Result<Box<dyn Agent>, Fault> {
    let mut agent: Box<dyn Agent> = match name {
        AgentName::Planner => Box::new(OnRailsAgent::new()),
        AgentName::Random => Box::new(RandomAgent::new(0)),
        AgentName::Still => Box::new(StillAgent),
        AgentName::Network(number) => networks.get(number).and_then(Agent::frozen).ok_or_else(|| {
            Fault::request(format!(
                "agent: found network {number}, expected one that was passed before"
            ))
        })?,
    };
    agent.begin(0);
    Ok(agent)
}

/// A running world with the actions taken in it.
pub(crate) struct Episode {
    environment: Environment,
    actions: Vec<Action>,
    /// Number of steps taken: the current position in `actions`.
    position: usize,
    /// Snapshots, one every [`SNAPSHOT_INTERVAL`] steps, each with the result of the step before it.
    snapshots: Vec<(Snapshot, Step)>,
    step: Step,
    /// The agent that chose the last action, with its state. An agent that takes over starts afresh.
    agent: Option<(AgentName, Box<dyn Agent>)>,
    /// The action that this agent chose last.
    chosen: Option<Action>,
    size: Option<[u32; 2]>,
}

impl Episode {
    pub(crate) fn new(world: World, size: Option<[u32; 2]>) -> Self {
        Self::with_actions(world, Vec::new(), size)
    }

    /// An episode at its start, with actions to replay.
    pub(crate) fn with_actions(world: World, actions: Vec<Action>, size: Option<[u32; 2]>) -> Self {
        let environment = Environment::new(world);
        let start = (environment.snapshot(), Step::default());
        Self {
            environment,
            actions,
            position: 0,
            snapshots: vec![start],
            step: Step::default(),
            agent: None,
            chosen: None,
            size,
        }
    }

    pub(crate) fn actions(&self) -> &[Action] {
        &self.actions
    }

    pub(crate) fn ended(&self) -> bool {
        self.environment.ended()
    }

    /// Takes a step from the current position, and drops the actions after it.
    pub(crate) fn step(&mut self, command: StepInput) -> Result<(), Fault> {
        let action = match command {
            StepInput::Action(action) => action,
            StepInput::Keys { ahead, turn, interact } => {
                let agent = &self.environment.world().agent_params;
                let (speed, rate) = (agent.max_linear_speed, agent.max_angular_speed);
                self.environment.action_near(ahead * speed, turn * rate, interact)
            }
        };
        if self.chosen != Some(action) {
            self.agent = None;
        }
        self.take(action)
    }

    fn take(&mut self, action: Action) -> Result<(), Fault> {
        if self.ended() {
            return Err(Fault::new(
                "env/ended",
                "step: found an episode that has ended, expected one in progress; go back or start again",
            ));
        }
        self.environment.check(action)?;
        self.actions.truncate(self.position);
        self.snapshots.truncate(self.position / SNAPSHOT_INTERVAL + 1);
        self.actions.push(action);
        self.replay_next()
    }

    /// Takes the next action of `actions`.
    fn replay_next(&mut self) -> Result<(), Fault> {
        self.step = self.environment.step(self.actions[self.position])?;
        self.position += 1;
        if self.position == SNAPSHOT_INTERVAL * self.snapshots.len() {
            self.snapshots.push((self.environment.snapshot(), self.step.clone()));
        }
        Ok(())
    }

    /// The action that an agent would take now.
    pub(crate) fn choose(&mut self, name: AgentName, networks: &Networks) -> Result<Action, Fault> {
        let mut current = match self.agent.take() {
            Some((known, agent)) if known == name => agent,
            _ => agent(name, networks)?,
        };
        let action = current.act(&self.environment);
        self.agent = Some((name, current));
        self.chosen = Some(action);
        Ok(action)
    }

    pub(crate) fn act(&mut self, name: AgentName, networks: &Networks) -> Result<(), Fault> {
        let action = self.choose(name, networks)?;
        self.take(action)
    }

    /// Goes to the state after `step` steps, or to the last one if there are fewer.
    pub(crate) fn seek(&mut self, step: usize) -> Result<(), Fault> {
        let step = step.min(self.actions.len());
        self.agent = None;
        let nearest = (step / SNAPSHOT_INTERVAL).min(self.snapshots.len() - 1);
        if step < self.position || nearest * SNAPSHOT_INTERVAL > self.position {
            let (snapshot, last) = &self.snapshots[nearest];
            self.environment.restore(snapshot);
            (self.step, self.position) = (last.clone(), nearest * SNAPSHOT_INTERVAL);
        }
        while self.position < step {
            self.replay_next()?;
        }
        Ok(())
    }

    /// The current state, for the page.
    pub(crate) fn now(&self) -> Value {
        let agent = self.environment.agent();
        let mut now = json!(self.step);
        let state = json!({
            "step": self.position,
            "action": self.position.checked_sub(1).map(|last| self.actions[last]),
            "total": self.environment.episode_return(),
            "seconds": self.environment.seconds(),
            "energy": self.environment.energy(),
            "agent": { "x": agent.position[0], "y": agent.position[1], "heading": agent.heading_deg },
        });
        if let (Value::Object(now), Value::Object(state)) = (&mut now, state) {
            now.extend(state);
        }
        now
    }

    /// The episode up to now as a file of recordings, as written by `driftworld film --record`.
    pub(crate) fn recording(&self) -> String {
        let recording = Recording {
            origin: EpisodeOrigin::default(),
            recorded_by: env!("CARGO_PKG_VERSION").to_owned(),
            world: self.environment.world().clone(),
            edits: Vec::new(),
            actions: self.actions[..self.position].to_vec(),
            reward: self.environment.episode_return(),
            ended_by: self.step.ended_by,
        };
        RecordingLines::header() + &RecordingLines::default().lines(&recording)
    }

    /// The description that the page gets when it opens the episode.
    pub(crate) fn description(&self) -> Value {
        let world = self.environment.world();
        let agent = &world.agent_params;
        let table: Option<Vec<[f64; 3]>> = agent
            .num_actions()
            .map(|rows| (0..rows).filter_map(|row| agent.action_row(row)).collect());
        let kind = match agent.actions {
            ActionSpace::Continuous => "continuous",
            ActionSpace::Normalized => "normalized",
            ActionSpace::DefaultDiscrete | ActionSpace::Discrete(_) => "discrete",
        };
        let names: Vec<String> = match (&table, agent.action_model) {
            (Some(rows), _) => rows.iter().map(|row| row_name(*row)).collect(),
            (None, ActionModel::ByWaypoint) => ["x", "y", "turn"].map(str::to_owned).into(),
            (None, _) => ["ahead", "turn", "interact"].map(str::to_owned).into(),
        };
        let [width, height] = agent.picture_size();
        json!({
            "image_size": width.max(height), "world": world.to_json(),
            "action_space": {
                "kind": kind, "model": agent.action_model, "names": names, "table": table, "can_interact": agent.interact,
                "max_speed": agent.max_linear_speed, "max_turn_rate": agent.max_angular_speed,
                "step_seconds": agent.time_step * f64::from(agent.frame_skip.max(1)),
            },
        })
    }

    /// A picture: its size, and its pixels as RGBA.
    pub(crate) fn frame(
        &mut self,
        view: View,
        modality: Modality,
        size: Option<[u32; 2]>,
    ) -> Result<([u32; 2], Vec<u8>), Fault> {
        let own = self.environment.world().agent_params.picture_size();
        let [width, height] = size.or(self.size).unwrap_or(own);
        if view == View::Above && modality == Modality::Rgb {
            if !(1..=4096).contains(&width) || !(1..=4096).contains(&height) {
                return Err(driftworld::env::EnvError::PictureSize { width, height }.into());
            }
            let agent = self.environment.agent();
            let pose = Some((agent.position, agent.heading_deg));
            let image = top_down(self.environment.scene(), width, height, pose);
            return Ok(([width, height], rgba(&image.rgb)));
        }
        let rgb = |frame: &Frame| rgba(&modality::to_rgb(modality, frame, modality::number_color));
        let pixels = if view == View::Above {
            let camera = Camera::overview(self.environment.scene());
            rgb(&self.environment.render(&camera, width, height)?)
        } else if [width, height] == own {
            rgb(self.environment.observe())
        } else {
            rgb(&self.environment.observe_at(width, height)?)
        };
        Ok(([width, height], pixels))
    }

    /// Everything that the two-dimensional map shows.
    pub(crate) fn map(&self) -> Value {
        let (world, scene) = (self.environment.world(), self.environment.scene());
        let walls = scene
            .walls
            .iter()
            .map(|wall| json!({ "points": [wall.from, wall.to], "closed": false, "color": wall.color }));
        let objects = world.objects.iter().zip(self.environment.objects()).zip(&scene.items);
        let objects = objects.enumerate().map(|(index, ((object, state), item))| {
            let main = item.asset.parts.iter().find_map(|part| match part.paint {
                Paint::Main(color) => Some(color),
                Paint::Fixed(_) => None,
            });
            json!({
                "index": index, "class": object.class, "tag": object.tag, "x": state.position[0], "y": state.position[1],
                "heading": state.heading_deg, "radius": item.body.radius * item.scale, "color": item.color.or(main).unwrap_or([0.5; 3]),
                "reward": state.reward, "present": state.present && item.visible, "carried": state.carried,
                "open": state.open,
            })
        });
        let zones = world.environment_params.zones.iter().map(|zone| {
            let points = match (&zone.disc, &zone.polygon) {
                (Some(disc), _) => (0..DISC_CORNERS)
                    .map(|corner| disc_corner(disc.center, disc.radius, corner))
                    .collect(),
                (None, corners) => corners.clone().unwrap_or_default(),
            };
            json!({ "name": zone.name, "points": points, "color": zone.ground_color(), "visible": zone.visible })
        });
        let [width, depth] = scene.arena_size();
        let agent = self.environment.agent();
        json!({
            "width": width, "depth": depth, "walls": walls.collect::<Vec<_>>(), "objects": objects.collect::<Vec<_>>(),
            "zones": zones.collect::<Vec<_>>(),
            "agent": {
                "x": agent.position[0], "y": agent.position[1], "heading": agent.heading_deg,
                "radius": world.agent_params.agent_width / 2.0,
            },
        })
    }

    /// The outcome of an episode that an agent has played.
    pub(crate) fn outcome(&self) -> Value {
        json!({
            "steps": self.position, "total": self.environment.episode_return(), "success": self.step.success,
            "ended_by": self.step.ended_by, "actions": self.actions(),
        })
    }
}

fn disc_corner([x, y]: [f64; 2], radius: f64, corner: usize) -> [f64; 2] {
    let turn = corner as f64 / DISC_CORNERS as f64 * std::f64::consts::TAU;
    [x + radius * libm::cos(turn), y + radius * libm::sin(turn)]
}

/// The name of a row of the action table, such as `ahead right`.
fn row_name([speed, turn, interact]: [f64; 3]) -> String {
    let along = if speed > 0.0 { "ahead" } else { "back" };
    let turn = (turn != 0.0).then_some(if turn > 0.0 { "right" } else { "left" });
    let words: Vec<&str> = [
        (speed != 0.0).then_some(along),
        turn,
        (interact > 0.5).then_some("interact"),
    ]
    .into_iter()
    .flatten()
    .collect();
    if words.is_empty() {
        "wait".to_owned()
    } else {
        words.join(" ")
    }
}

/// Opaque RGBA pixels.
fn rgba(rgb: &[u8]) -> Vec<u8> {
    let mut pixels = vec![255; rgb.len() / 3 * 4];
    for (pixel, rgb) in pixels.chunks_exact_mut(4).zip(rgb.chunks_exact(3)) {
        pixel[..3].copy_from_slice(rgb);
    }
    pixels
}
