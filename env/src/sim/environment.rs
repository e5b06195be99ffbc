//! [`Environment`]: a world that runs. Bodies are in `body.rs`, pictures in `render`, who acts in `agents`.

use std::sync::Arc;

use driftworld_spec::{ActionModel, GameMode, MotionModel, Object, World};

use super::action::{Action, Intent};
use super::body::Ground;
use super::chance::Seed;
use super::episode::{AgentState, Episode, ObjectState, wrapped};
use super::event::{Step, Warning};
use crate::EnvError;
use crate::agents::Agent;
use crate::camera::Camera;
use crate::render::{CpuRenderer, Frame};
use crate::scene::Scene;

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
    /// The world at its start, and with it what was spawned later.
    pub(super) world: Arc<World>,
    pub(super) seed: Seed,
    pub(super) scene: Scene,
    pub(super) ground: Ground,
    pub(super) episode: Episode,
    pub(super) had_targets: bool,
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
        Ok(Self::build(Arc::new(world), CpuRenderer::new(), Frame::new(size, size)))
    }

    /// Leaves this world for another, or for the same from its start; buffers for pictures are kept.
    ///
    /// # Errors
    /// As [`Environment::new`]; on error this world goes on.
    pub fn reset(&mut self, world: World) -> Result<(), EnvError> {
        self.start(Arc::new(world));
        Ok(())
    }

    pub(super) fn start(&mut self, world: Arc<World>) {
        let size = world.agent_params.observation_size;
        let mut frame = std::mem::replace(&mut self.frame, Frame::new(0, 0));
        if (frame.width, frame.height) != (size, size) {
            frame = Frame::new(size, size);
        }
        *self = Self::build(world, std::mem::take(&mut self.renderer), frame);
    }

    fn build(world: Arc<World>, renderer: CpuRenderer, frame: Frame) -> Self {
        let scene = Scene::from_world(&world);
        let ground = Ground::new(&world, &scene);
        let seed = Seed::of(&world);
        let mut environment = Self {
            episode: Episode::new(&world, &seed),
            had_targets: world.objects.iter().any(Object::is_target),
            world,
            seed,
            scene,
            ground,
            renderer,
            frame,
        };
        environment.take_stock();
        environment
    }

    /// Notes what is touched and near now, as no news.
    pub(super) fn take_stock(&mut self) {
        let agent = self.episode.agent;
        self.ground.touching(agent.position, &mut self.episode.contacts);
        for index in 0..self.episode.objects.len() {
            self.episode.objects[index].in_range = self.is_in_range(index);
        }
    }

    /// The world as it was at its start, and behind its objects those that were spawned since.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Where the agent is.
    pub fn agent(&self) -> AgentState {
        self.episode.agent
    }

    /// The objects as they are now, in the world's order.
    pub fn objects(&self) -> &[ObjectState] {
        &self.episode.objects
    }

    /// What there is to see now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Steps since the start.
    pub fn num_steps(&self) -> u32 {
        self.episode.steps
    }

    /// The sum of rewards since the start.
    pub fn episode_return(&self) -> f64 {
        self.episode.earned
    }

    /// Whether the episode is over, so that a reset must come before the next step.
    pub fn ended(&self) -> bool {
        self.episode.ended
    }

    /// The agent's position in metres, heading in degrees and velocity in metres per second, as one list.
    pub fn state_vector(&self) -> [f32; 5] {
        let [x, y] = self.episode.agent.position;
        let [vx, vy] = self.episode.agent.velocity;
        [x, y, self.episode.agent.heading_deg, vx, vy]
    }

    /// What this world asks for that is not as its author may think.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.world.game_mode == GameMode::CollectImages {
            warnings.push(Warning::ForPhotographs);
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
        if self.episode.ended {
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
        self.episode.steps += 1;
        self.episode.earned += step.reward;
        self.judge(&mut step);
        self.episode.ended = step.ended();
        Ok(step)
    }

    fn intent(&mut self, numbers: [f64; 3]) -> Intent {
        let Some(mut rails) = self.episode.rails.take() else {
            return Intent::new(self.world.agent_params.action_model, numbers, &self.world.agent_params);
        };
        let numbers = match rails.act(self) {
            Action::Continuous(numbers) => numbers,
            Action::Discrete(_) => [0.0; 3],
        };
        self.episode.rails = Some(rails);
        Intent::new(ActionModel::ByVelocity, numbers, &self.world.agent_params)
    }

    /// Turns and moves the agent; hands back the objects it met on the way.
    fn carry_out(&mut self, intent: Intent) -> Vec<u32> {
        let start = self.episode.agent.position;
        self.episode.agent.heading_deg = wrapped(self.episode.agent.heading_deg + intent.turn_deg);
        let by = match intent.towards {
            Some((point, reach)) => {
                let way = [point[0] - start[0], point[1] - start[1]];
                let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
                let share = if length > reach { reach / length } else { 1.0 };
                way.map(|metres| metres * share)
            }
            None => self.episode.agent.forward().map(|part| part * intent.ahead),
        };
        let motion = self.ground.slide(start, by);
        self.episode.agent.position = motion.position;
        let seconds = self.world.agent_params.time_step as f32;
        self.episode.agent.velocity = [0, 1].map(|axis| (self.episode.agent.position[axis] - start[axis]) / seconds);
        motion.met
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
            self.episode.agent.position,
            self.episode.agent.heading_deg,
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
