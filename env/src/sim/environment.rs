//! [`Environment`]: a world that runs. Bodies are in `body.rs`, pictures in `render`, who acts in `agents`.

use driftworld_spec::{ActionModel, EndCondition, GameMode, MotionModel, Object, Stimulus, World};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::action::{Action, Intent};
use super::body::Ground;
use super::event::{Event, Step, Warning};
use super::motion::Mover;
use crate::EnvError;
use crate::agents::{Agent, OnRailsAgent};
use crate::camera::Camera;
use crate::render::{CpuRenderer, Frame};
use crate::scene::Scene;

/// Where the agent is and how it moves.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct AgentState {
    /// Position in metres.
    pub position: [f32; 2],
    /// Heading in degrees, 0..360, clockwise from +y.
    pub heading_deg: f32,
    /// Velocity over the last step in metres per second.
    pub velocity: [f32; 2],
}

impl AgentState {
    /// The direction in which the agent looks: length 1.
    pub fn forward(&self) -> [f32; 2] {
        let heading = self.heading_deg.to_radians();
        [libm::sinf(heading), libm::cosf(heading)]
    }
}

/// One object while its world runs.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectState {
    /// What a triggering pays now; 0 once it has paid what pays once.
    pub reward: f64,
    /// Whether it is still there.
    pub present: bool,
    /// Whether it has paid, or was destroyed: places in a sequence count on it.
    pub collected: bool,
    pub(super) in_range: bool,
}

/// A world that runs: reset, step, look.
///
/// Everything is deterministic: the same world and the same actions give the same rewards, poses and pixels.
///
/// # Example
/// ```
/// use driftworld_env::{Action, Environment};
/// use driftworld_spec::World;
/// let mut environment = Environment::new(World::default())?;
/// let step = environment.step(Action::Continuous([10.0, 0.0, 0.0]))?;
/// assert_eq!(environment.agent().position, [0.0, 1.0], "10 m/s for 0.1 s along +y");
/// assert_eq!(step.reward, 0.0);
/// # Ok::<(), driftworld_env::EnvError>(())
/// ```
pub struct Environment {
    pub(super) world: World,
    pub(super) scene: Scene,
    pub(super) ground: Ground,
    pub(super) objects: Vec<ObjectState>,
    pub(super) agent: AgentState,
    pub(super) steps: u32,
    episode_return: f64,
    had_targets: bool,
    ended: bool,
    pub(super) chance: ChaCha8Rng,
    /// Objects in contact at the end of the last step, in rising order.
    contacts: Vec<u32>,
    /// The objects that move by themselves.
    pub(super) movers: Vec<Mover>,
    /// Destroyed objects that come back, with the number of steps after which they do.
    pub(super) returning: Vec<(usize, u64)>,
    rails: Option<OnRailsAgent>,
    renderer: CpuRenderer,
    frame: Frame,
}

impl Environment {
    /// A world at its start.
    ///
    /// # Errors
    /// None today: a checked world can always start. The signature leaves room for worlds that name libraries of assets.
    pub fn new(world: World) -> Result<Self, EnvError> {
        let size = world.agent_params.observation_size;
        Ok(Self::build(world, CpuRenderer::new(), Frame::new(size, size)))
    }

    /// Leaves this world for another, or for the same from its start; buffers for pictures are kept.
    ///
    /// # Errors
    /// As [`Environment::new`]; on error this world goes on.
    pub fn reset(&mut self, world: World) -> Result<(), EnvError> {
        let size = world.agent_params.observation_size;
        let mut frame = std::mem::replace(&mut self.frame, Frame::new(0, 0));
        if (frame.width, frame.height) != (size, size) {
            frame = Frame::new(size, size);
        }
        *self = Self::build(world, std::mem::take(&mut self.renderer), frame);
        Ok(())
    }

    fn build(world: World, renderer: CpuRenderer, frame: Frame) -> Self {
        let scene = Scene::from_world(&world);
        let ground = Ground::new(&world, &scene);
        let start = &world.agent_params;
        let agent = AgentState {
            position: start.coordinates.map(|metres| metres as f32),
            heading_deg: (start.heading as f32).rem_euclid(360.0),
            velocity: [0.0; 2],
        };
        let state = |object: &Object| ObjectState {
            reward: object.reward,
            present: true,
            collected: false,
            in_range: false,
        };
        let mut environment = Self {
            objects: world.objects.iter().map(state).collect(),
            had_targets: world.objects.iter().any(Object::is_target),
            chance: chance(&world),
            rails: (start.action_model == ActionModel::OnRails).then(OnRailsAgent::new),
            contacts: Vec::new(),
            movers: Mover::all(&world),
            returning: Vec::new(),
            steps: 0,
            episode_return: 0.0,
            ended: false,
            world,
            scene,
            ground,
            agent,
            renderer,
            frame,
        };
        // What is touched or near at the start is no news.
        environment.ground.touching(agent.position, &mut environment.contacts);
        for index in 0..environment.objects.len() {
            environment.objects[index].in_range = environment.is_in_range(index);
        }
        environment
    }

    /// The world as it was at its start.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Where the agent is.
    pub fn agent(&self) -> AgentState {
        self.agent
    }

    /// The objects as they are now, in the world's order.
    pub fn objects(&self) -> &[ObjectState] {
        &self.objects
    }

    /// What there is to see now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Steps since the start.
    pub fn num_steps(&self) -> u32 {
        self.steps
    }

    /// The sum of rewards since the start.
    pub fn episode_return(&self) -> f64 {
        self.episode_return
    }

    /// Whether the episode is over, so that a reset must come before the next step.
    pub fn ended(&self) -> bool {
        self.ended
    }

    /// The agent's position in metres, heading in degrees and velocity in metres per second, as one list.
    pub fn state_vector(&self) -> [f32; 5] {
        let [x, y] = self.agent.position;
        let [vx, vy] = self.agent.velocity;
        [x, y, self.agent.heading_deg, vx, vy]
    }

    /// What this world asks for that is not as its author may think.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.world.game_mode == GameMode::CollectImages {
            warnings.push(Warning::NoImageCollection);
        }
        for (index, (object, item)) in self.world.objects.iter().zip(&self.scene.items).enumerate() {
            if !item.asset.known {
                let (class, model) = (object.class.clone(), object.model.0.clone());
                warnings.push(Warning::UnknownAsset {
                    object: index,
                    class,
                    model,
                });
            }
            let patrols_nowhere = object.motion_model == MotionModel::Patrol && object.waypoints.is_empty();
            if object.motion_model != MotionModel::Stationary && (object.speed == 0.0 || patrols_nowhere) {
                warnings.push(Warning::StandsStill { object: index });
            }
        }
        warnings
    }

    /// Lets the agent act for one time step: it turns, moves, and what it meets answers.
    ///
    /// # Errors
    /// [`EnvError`] for an action that cannot be carried out, or after the end; nothing is changed then.
    pub fn step(&mut self, action: Action) -> Result<Step, EnvError> {
        if self.ended {
            return Err(EnvError::Ended);
        }
        let numbers = action.numbers(&self.world.agent_params.actions)?;
        let intent = self.intent(numbers);
        let distance_before = self.shaping_distance();
        let met = self.carry_out(intent);
        self.bring_back();
        self.move_objects();
        let mut step = Step {
            reward: self.world.rules.step_reward,
            ..Step::default()
        };
        self.answer(intent, met, &mut step);
        if let (Some(shaping), Some(before), Some(after)) =
            (&self.world.rules.shaping, distance_before, self.shaping_distance())
        {
            step.reward += shaping.scale * (before - after);
        }
        self.steps += 1;
        self.episode_return += step.reward;
        self.judge(&mut step);
        self.ended = step.ended();
        Ok(step)
    }

    fn intent(&mut self, numbers: [f64; 3]) -> Intent {
        let Some(mut rails) = self.rails.take() else {
            return Intent::new(self.world.agent_params.action_model, numbers, &self.world.agent_params);
        };
        let numbers = match rails.act(self) {
            Action::Continuous(numbers) => numbers,
            Action::Discrete(_) => [0.0; 3],
        };
        self.rails = Some(rails);
        Intent::new(ActionModel::ByVelocity, numbers, &self.world.agent_params)
    }

    /// Turns and moves the agent; hands back the objects it met on the way.
    fn carry_out(&mut self, intent: Intent) -> Vec<u32> {
        let start = self.agent.position;
        self.agent.heading_deg = (self.agent.heading_deg + intent.turn_deg).rem_euclid(360.0);
        let by = match intent.towards {
            Some((point, reach)) => {
                let way = [point[0] - start[0], point[1] - start[1]];
                let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
                let share = if length > reach { reach / length } else { 1.0 };
                way.map(|metres| metres * share)
            }
            None => self.agent.forward().map(|part| part * intent.ahead),
        };
        let motion = self.ground.slide(start, by);
        self.agent.position = motion.position;
        let seconds = self.world.agent_params.time_step as f32;
        self.agent.velocity = [0, 1].map(|axis| (self.agent.position[axis] - start[axis]) / seconds);
        motion.met
    }

    /// Finds what the step set off, and pays for it.
    fn answer(&mut self, intent: Intent, met: Vec<u32>, step: &mut Step) {
        let mut touching = Vec::new();
        self.ground.touching(self.agent.position, &mut touching);
        let mut triggered: Vec<(u32, Stimulus)> = Vec::new();
        let new_contacts = met.into_iter().chain(touching.iter().copied());
        triggered.extend(
            new_contacts
                .filter(|index| !self.contacts.contains(index))
                .map(|index| (index, Stimulus::AgentCollide)),
        );
        self.contacts = touching;
        if intent.interact {
            let reached = self.ground.in_reach(self.agent.position, self.agent.forward());
            triggered.extend(reached.into_iter().map(|index| (index, Stimulus::AgentInteract)));
        }
        for index in 0..self.objects.len() {
            let now = self.is_in_range(index);
            if now && !self.objects[index].in_range {
                triggered.push((index as u32, Stimulus::AgentInRange));
            }
            self.objects[index].in_range = now;
        }
        triggered.sort_unstable();
        triggered.dedup();
        for (index, stimulus) in triggered {
            self.trigger(index as usize, stimulus, step);
        }
    }

    /// One stimulus on one object: what it pays, whether it destroys.
    fn trigger(&mut self, index: usize, stimulus: Stimulus, step: &mut Step) {
        if !self.objects[index].present {
            return;
        }
        let object = &self.world.objects[index];
        let once = object.reward_once_stimulus.contains(&stimulus);
        let pays = (once || object.reward_stimulus.contains(&stimulus)) && self.is_due(object.order);
        let destroyed = object.destroy_stimulus.contains(&stimulus);
        let lucky =
            object.reward_probability >= 1.0 || (pays && self.chance.random::<f64>() < object.reward_probability);
        let reward = if pays && lucky { self.objects[index].reward } else { 0.0 };
        step.reward += reward;
        let state = &mut self.objects[index];
        state.collected |= pays || (destroyed && object.order.is_none());
        if pays && once {
            state.reward = 0.0;
            self.scene.items[index].reward = 0.0;
        }
        if destroyed {
            state.present = false;
            self.scene.items[index].visible = false;
            self.ground.remove(index as u32);
            self.contacts.retain(|contact| *contact != index as u32);
            if let Some(respawn) = &object.respawn {
                let steps = (respawn.delay / self.world.agent_params.time_step).ceil() as u64;
                self.returning.push((index, u64::from(self.steps) + 1 + steps.max(1)));
            }
        }
        step.events.push(Event {
            object: index,
            tag: object.tag.clone(),
            stimulus,
            reward,
            destroyed,
        });
    }

    /// Whether all objects with a lower place in the sequence have been collected.
    fn is_due(&self, order: Option<u32>) -> bool {
        let Some(order) = order else { return true };
        let lower = |object: &Object| object.order.is_some_and(|other| other < order);
        self.world
            .objects
            .iter()
            .zip(&self.objects)
            .all(|(object, state)| !lower(object) || state.collected)
    }

    /// Centre to centre in 3D: the agent's at half its height, the object's at half of its own.
    fn is_in_range(&self, index: usize) -> bool {
        let reach = self.world.objects[index].range_stimulus_distance as f32;
        if reach <= 0.0 || !self.objects[index].present {
            return false;
        }
        let item = &self.scene.items[index];
        let [dx, dy] = [0, 1].map(|axis| item.position[axis] - self.agent.position[axis]);
        let dz = (item.asset.height * item.scale - self.world.agent_params.agent_height as f32) / 2.0;
        dx * dx + dy * dy + dz * dz < reach * reach
    }

    /// Metres to the nearest object of the tag that the world's shaping names.
    fn shaping_distance(&self) -> Option<f64> {
        let tag = &self.world.rules.shaping.as_ref()?.toward;
        let [x, y] = self.agent.position;
        let drawn = self
            .world
            .objects
            .iter()
            .zip(&self.scene.items)
            .filter(|(object, _)| object.tag.as_ref() == Some(tag));
        drawn
            .map(|(_, item)| {
                let (dx, dy) = (f64::from(item.position[0] - x), f64::from(item.position[1] - y));
                (dx * dx + dy * dy).sqrt()
            })
            .min_by(f64::total_cmp)
    }

    /// Whether the step ended the episode, and how.
    fn judge(&self, step: &mut Step) {
        let rules = &self.world.rules;
        step.success = rules.success.iter().any(|condition| self.holds(condition, step));
        let failed = !step.success && rules.failure.iter().any(|condition| self.holds(condition, step));
        step.terminated = step.success || failed;
        step.truncated = !step.terminated && self.world.max_steps > 0 && self.steps >= self.world.max_steps;
    }

    fn holds(&self, condition: &EndCondition, step: &Step) -> bool {
        match condition {
            EndCondition::AllCollected => {
                let left = |(object, state): (&Object, &ObjectState)| {
                    object.is_target() && state.present && state.reward > 0.0
                };
                self.had_targets && !self.world.objects.iter().zip(&self.objects).any(left)
            }
            EndCondition::Touch(tag) => step
                .events
                .iter()
                .any(|event| event.stimulus != Stimulus::AgentInRange && event.tag.as_deref() == Some(tag.as_str())),
            EndCondition::ReturnAtLeast(bound) => self.episode_return >= *bound,
            EndCondition::ReturnAtMost(bound) => self.episode_return <= *bound,
        }
    }

    /// What the agent sees now, at the world's observation size. Drawn when asked for, never before.
    pub fn observe(&mut self) -> &Frame {
        let camera = self.camera();
        self.renderer.render(&self.scene, &camera, &mut self.frame);
        &self.frame
    }

    /// The agent's camera.
    pub fn camera(&self) -> Camera {
        let agent = &self.world.agent_params;
        Camera::first_person(
            self.agent.position,
            self.agent.heading_deg,
            agent.agent_height as f32,
            agent.field_of_view as f32,
        )
    }

    /// A picture of any size from any camera.
    ///
    /// # Errors
    /// [`EnvError::PictureSize`] unless both sides are 1 to 4096 pixels.
    pub fn render(&mut self, camera: &Camera, width: u32, height: u32) -> Result<Frame, EnvError> {
        if !(1..=4096).contains(&width) || !(1..=4096).contains(&height) {
            return Err(EnvError::PictureSize { width, height });
        }
        let mut frame = Frame::new(width, height);
        self.renderer.render(&self.scene, camera, &mut frame);
        Ok(frame)
    }
}

/// The world's own chance, which bandit arms and returning objects draw from: it depends on the world alone.
fn chance(world: &World) -> ChaCha8Rng {
    let mut seed = [0; 32];
    if world
        .objects
        .iter()
        .any(|object| object.reward_probability < 1.0 || object.respawn.is_some())
    {
        let hash = world.hash();
        seed.iter_mut()
            .zip(hash.bytes())
            .for_each(|(byte, letter)| *byte = letter);
    }
    ChaCha8Rng::from_seed(seed)
}
