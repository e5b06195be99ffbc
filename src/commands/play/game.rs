//! [`Game`]: a world that advances with key presses and real time.

use crate::Failure;
use crate::env::{Catalogue, EndedBy, Environment, EpisodeOrigin, Recorder, Recording, Renderer, Step};
use crate::episode_frames::{events_of, facts, map_of, number};
use crate::report::picture::Picture;
use crate::spec::World;

use super::keys::{Held, Key};

/// The view of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    Agent,
    Both,
    Above,
}

/// A world being played.
pub(super) struct Game {
    world: World,
    origin: EpisodeOrigin,
    environment: Environment,
    recorder: Recorder,
    /// Finished episodes.
    recordings: Vec<Recording>,
    held: Held,
    shown: Shown,
    /// Seconds between two steps, and the time of the next step.
    pace: f64,
    next_step_at: f64,
    path: Vec<[f32; 2]>,
    last: Option<Step>,
    last_event: String,
    /// Whether the world pauses while no key is held, because its agent has no null action.
    waits: bool,
}

impl Game {
    /// A new game, with a step every `pace` seconds.
    pub(super) fn new(
        world: World,
        origin: EpisodeOrigin,
        catalogue: Catalogue,
        renderer: Renderer,
        pace: f64,
    ) -> Self {
        let mut environment = Environment::with_catalogue(world.clone(), catalogue);
        environment.set_renderer(renderer);
        let agent = &world.agent_params;
        let rows = (0..agent.num_actions().unwrap_or(0)).filter_map(|row| agent.action_row(row));
        let does_nothing = |row: [f64; 3]| row[0] == 0.0 && row[1] == 0.0 && row[2] <= 0.5;
        let waits = agent.num_actions().is_some() && !rows.into_iter().any(does_nothing);
        let mut game = Self {
            world,
            origin,
            environment,
            recorder: Recorder::default(),
            recordings: Vec::new(),
            held: Held::default(),
            shown: Shown::Agent,
            pace,
            next_step_at: 0.0,
            path: Vec::new(),
            last: None,
            last_event: String::new(),
            waits,
        };
        game.begin();
        game
    }

    fn begin(&mut self) {
        self.environment.reset(self.world.clone());
        self.recorder.begin(self.world.clone());
        self.path = vec![self.environment.agent().position];
        (self.last, self.last_event) = (None, String::new());
    }

    /// Handles a key press at the time `now`, in seconds; returns whether the picture changes.
    pub(super) fn press(&mut self, key: Key, now: f64) -> bool {
        match key {
            Key::View => {
                self.shown = match self.shown {
                    Shown::Agent => Shown::Both,
                    Shown::Both => Shown::Above,
                    Shown::Above => Shown::Agent,
                };
            }
            Key::Restart => {
                self.save_recording();
                self.begin();
            }
            _ => {
                self.held.press(key, now);
                return false;
            }
        }
        true
    }

    /// Takes a step if one is due; returns whether it did.
    pub(super) fn advance(&mut self, now: f64) -> Result<bool, Failure> {
        if now < self.next_step_at || self.environment.ended() {
            return Ok(false);
        }
        let Some((along, turn, interact)) = self.held.take(now).or((!self.waits).then_some((0.0, 0.0, false))) else {
            return Ok(false);
        };
        // Missed steps after a pause are not made up for.
        self.next_step_at = (self.next_step_at + self.pace).max(now);
        let agent = &self.world.agent_params;
        let (speed, rate) = (agent.max_linear_speed, agent.max_angular_speed);
        let action = self.environment.action_near(along * speed, turn * rate, interact);
        let step = self.environment.step(action)?;
        self.recorder.step(action);
        self.path.push(self.environment.agent().position);
        let events = events_of(self.environment.world(), &step).words.join(", ");
        if !events.is_empty() {
            self.last_event = events;
        }
        self.last = Some(step);
        Ok(true)
    }

    /// The current picture, within these pixel dimensions.
    pub(super) fn picture(&mut self, width: u32, height: u32) -> Result<Picture, Failure> {
        let size = width.min(height);
        match self.shown {
            Shown::Agent => self.view(width, height),
            Shown::Above => Ok(map_of(&self.environment, [size; 2], &self.path)),
            Shown::Both => {
                let side = (width / 2).min(height).max(1);
                let (view, map) = (self.view(side, side)?, map_of(&self.environment, [side; 2], &self.path));
                let mut both = Picture::blank(2 * side, side);
                both.paste(&view, 0, 0);
                both.paste(&map, side, 0);
                Ok(both)
            }
        }
    }

    fn view(&mut self, width: u32, height: u32) -> Result<Picture, Failure> {
        Picture::smooth([width, height], |[width, height]| {
            Ok(self.environment.observe_at(width, height)?.rgb)
        })
    }

    /// The status line: steps, time, return, carried objects, the last event.
    pub(super) fn status(&self) -> String {
        let end = self.last.as_ref().filter(|step| step.ended());
        let mut parts = vec![format!("step {}", self.environment.num_steps())];
        if let Some(step) = &self.last {
            parts.push(format!("reward {}", number(step.reward, "+")));
        }
        parts.extend(facts(&self.environment, end));
        if !self.last_event.is_empty() {
            parts.push(self.last_event.clone());
        }
        parts.join(" · ")
    }

    /// The played episodes, including the current one.
    pub(super) fn into_recordings(mut self) -> Vec<Recording> {
        self.save_recording();
        self.recordings
    }

    fn save_recording(&mut self) {
        let ended_by: Option<EndedBy> = self.last.as_ref().and_then(|step| step.ended_by);
        let mut recording = self.recorder.recording(&self.environment, ended_by);
        recording.origin = EpisodeOrigin {
            experience: self.recordings.len() as u64,
            ..self.origin.clone()
        };
        self.recordings.push(recording);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::env::Replay;
    use crate::generator::Sampler;
    use crate::spec::ActionSpace;
    use crate::tasks;

    fn game(actions: ActionSpace) -> Game {
        let world = Sampler::new(&tasks::variant("find_objects#red").unwrap(), 0)
            .world(0)
            .unwrap();
        let world = world.edit(|world| world.agent_params.actions = actions).unwrap();
        let pace = world.agent_params.time_step;
        Game::new(
            world,
            EpisodeOrigin::default(),
            Catalogue::default(),
            Renderer::default(),
            pace,
        )
    }

    #[test]
    fn game_moves_the_agent_by_keys_and_can_be_replayed() {
        let mut game = game(ActionSpace::Normalized);
        let start = game.environment.agent().position;
        assert!(!game.press(Key::Ahead, 0.0), "a key alone changes no picture");
        assert!(game.advance(0.0).unwrap());
        assert!(!game.advance(0.04).unwrap(), "the next step is not due");
        assert!(game.advance(0.1).unwrap());
        let walked = game.environment.agent().position;
        assert_ne!(start, walked);
        // The key is no longer held, but the world moves on.
        assert!(game.advance(1.0).unwrap());
        assert_eq!(game.environment.agent().position, walked);
        assert_eq!(game.environment.num_steps(), 3);
        assert!(
            game.status().starts_with("step 3 · reward −0.1 · 0.3 s · return −0.3"),
            "{}",
            game.status()
        );
        assert!(game.press(Key::View, 1.0) && game.press(Key::Restart, 1.0));
        assert_eq!(
            (game.environment.num_steps(), game.environment.agent().position),
            (0, start)
        );
        game.press(Key::Left, 2.0);
        game.advance(2.0).unwrap();
        for (width, height) in [(40, 22), (9, 30), (1, 1)] {
            let picture = game.picture(width, height).unwrap();
            assert!(picture.width <= width.max(2) && picture.height <= height);
        }
        let recordings = game.into_recordings();
        assert_eq!(recordings.len(), 2);
        for (number, recording) in (0..).zip(&recordings) {
            assert_eq!(
                (recording.origin.experience, recording.actions.len()),
                (number, [3, 1][number as usize])
            );
            let mut replay = Replay::new(recording, &Catalogue::default());
            while replay.step().unwrap().is_some() {}
            replay.check().unwrap();
        }
    }

    #[test]
    fn world_without_a_null_action_waits_for_keys() {
        let mut game = game(ActionSpace::Discrete(vec![[5.0, 0.0, 0.0], [0.0, 45.0, 0.0]]));
        assert!(!game.advance(0.0).unwrap());
        game.press(Key::Right, 0.5);
        assert!(game.advance(0.5).unwrap());
        assert_eq!(
            game.recorder.recording(&game.environment, None).actions,
            [crate::env::Action::Discrete(1)]
        );
    }
}
