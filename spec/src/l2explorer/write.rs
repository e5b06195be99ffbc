//! Writing a [`World`] as a reset file of L2Explorer, with a warning for every kind of thing that the dialect cannot say.
//! Old keys and spellings are never written, and nothing is made up in place of what is left out.

use indexmap::IndexMap;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use super::left_out::LeftOut;
use super::{PARTS, Part, map_of};
use crate::describe::describe;
use crate::layout::Layout;
use crate::warning::Warning;
use crate::world::{EnvironmentParams, World, WorldDraft};

impl World {
    /// The world as a reset file of the original: indented JSON with a final newline, and a warning for each kind of loss.
    ///
    /// The file holds the original's keys and no others. What it has no key for and is not at its default is left out,
    /// with one warning that names all these keys and whose pointer leads to the first. What becomes something else has
    /// a warning of its own; objects that lose the same thing share one, which counts them. The arena of a layout keeps
    /// its size. [`World::from_l2explorer`] reads the file back as this world with what was left out at its default.
    /// `schema` is not part of a world and goes without a warning.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Object, WorldDraft};
    /// let mut tree = Object::new("tree", [3.0, 4.0]);
    /// tree.heading = 90.0;
    /// let world = WorldDraft { objects: vec![tree], ..WorldDraft::default() }.check()?;
    /// let (text, warnings) = world.to_l2explorer();
    /// assert!(text.contains("\"class\": \"tree\""));
    /// assert_eq!(
    ///     warnings[0].to_string(),
    ///     "world (/objects/0/heading): left out, L2Explorer has no such key: /objects/*/heading"
    /// );
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn to_l2explorer(&self) -> (String, Vec<Warning>) {
        let mut writer = Writer::default();
        let payload = writer.world(self);
        let mut text = serde_json::to_string_pretty(&payload).expect("a JSON value always serialises");
        text.push('\n');
        (text, writer.warnings())
    }
}

/// What many objects may lose in the same way.
#[derive(PartialEq, Eq, Hash)]
struct Loss {
    /// What of the object it is: `heading`, `class`, …
    what: &'static str,
    /// What is made of it.
    becomes: &'static str,
}

/// How many objects had a loss, and where the first one stands.
struct LossCount {
    count: usize,
    first: String,
}

#[derive(Default)]
pub(super) struct Writer {
    pub(super) left_out: LeftOut,
    warnings: Vec<Warning>,
    /// In the order in which the kinds of loss were met first.
    losses: IndexMap<Loss, LossCount>,
}

impl Writer {
    fn world(&mut self, world: &World) -> Json {
        let full = map_of(world);
        let mut payload = Map::new();
        for key in &PARTS.world.original {
            let value = match *key {
                "environment_params" => Some(self.environment(&world.environment_params)),
                "agent_params" => Some(self.part("/agent_params", &PARTS.agent, &world.agent_params)),
                "objects" => Some(self.objects(&world.objects)),
                "max_steps" => Some(json!(self.max_steps(world))),
                key => full.get(key).cloned(),
            };
            payload.extend(value.map(|value| ((*key).to_owned(), value)));
        }
        self.part("/rules", &PARTS.rules, &world.rules);
        for key in changed(&PARTS.world, &full) {
            match key {
                "rules" | "max_seconds" => {}
                "progress" => {
                    let text = "progress: left out; the file is a start from where things are now";
                    self.warnings.push(warning("/progress".to_owned(), text.to_owned()));
                }
                key => self.left_out.key(format!("/{key}")),
            }
        }
        Json::Object(payload)
    }

    /// The limit in the original's steps, each of which is a time step.
    fn max_steps(&mut self, world: &World) -> u32 {
        if world.max_seconds == 0.0 {
            return world.max_steps;
        }
        // The time step is the original's own there, since it cannot be said; what it was is lost with a warning of its own.
        let mut timed = WorldDraft {
            max_steps: world.max_steps,
            max_seconds: world.max_seconds,
            ..WorldDraft::default()
        };
        timed.max_steps = timed.step_limit().unwrap_or(0).min(1_000_000_000);
        let (seconds, steps) = (describe(&json!(world.max_seconds)), timed.max_steps);
        let text = format!("max_seconds ({seconds}): written as max_steps {steps}, L2Explorer counts steps");
        self.warnings.push(warning("/max_seconds".to_owned(), text));
        steps
    }

    /// The original's keys of the arena, which is as large as its layout.
    fn environment(&mut self, environment: &EnvironmentParams) -> Json {
        let mut sized = environment.clone();
        if let Some(size) = environment.layout.as_ref().and_then(Layout::size) {
            sized.map_size = size;
        }
        self.part("/environment_params", &PARTS.environment, &sized)
    }

    /// The original's keys of a part of the world; those of ours that are not at their defaults are left out.
    fn part(&mut self, at: &str, known: &Part, part: &impl Serialize) -> Json {
        let full = map_of(part);
        for key in changed(known, &full) {
            self.left_out.key(format!("{at}/{key}"));
        }
        let original = known.original.iter().filter_map(|key| Some((*key, full.get(*key)?)));
        original.map(|(key, value)| (key.to_owned(), value.clone())).collect()
    }

    pub(super) fn lose(&mut self, index: usize, key: &str, what: &'static str, becomes: &'static str) {
        let lost = self.losses.entry(Loss { what, becomes }).or_insert_with(|| LossCount {
            count: 0,
            first: format!("/objects/{index}/{key}"),
        });
        lost.count += 1;
    }

    /// The summary of what is left out, then the other warnings in the order of the world's parts; the objects' stand
    /// last, as the objects do.
    fn warnings(self) -> Vec<Warning> {
        let of_objects = self.losses.into_iter().map(|(Loss { what, becomes }, lost)| {
            let text = match lost.count {
                1 => format!("{what} of this object: {becomes}"),
                count => format!("{what} of {count} objects, this one first: {becomes}"),
            };
            warning(lost.first, text)
        });
        let summary = self.left_out.summary().into_iter();
        summary.chain(self.warnings).chain(of_objects).collect()
    }
}

/// Our own keys whose value is not the default; a key that the default does not write has a value only where it differs.
pub(super) fn changed<'a>(part: &'a Part, full: &'a Map<String, Json>) -> impl Iterator<Item = &'static str> + 'a {
    let ours = part.ours.iter().filter_map(|key| Some((*key, full.get(*key)?)));
    let changed = ours.filter(|(key, value)| part.defaults.get(*key) != Some(*value));
    changed.map(|(key, _)| key)
}

pub(super) fn warning(pointer: String, text: String) -> Warning {
    Warning {
        name: "world".to_owned(),
        pointer,
        line: 0,
        column: 0,
        text,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::{ActionModel, ActionSpace, Color, EndCondition, Modality, Object, Stimulus, Wall};

    pub(in crate::l2explorer) fn check(world: &WorldDraft, expected: &[&str]) {
        let world = world.clone().check().unwrap();
        let warnings: Vec<String> = world.to_l2explorer().1.iter().map(ToString::to_string).collect();
        assert_eq!(warnings, expected);
    }

    pub(in crate::l2explorer) fn with_objects(objects: Vec<Object>) -> WorldDraft {
        WorldDraft {
            objects,
            ..WorldDraft::default()
        }
    }

    #[test]
    fn what_the_original_knows_is_written_with_its_keys_and_no_warning() {
        let mut bag = Object::new("bag", [1.0, 2.5]);
        bag.reward = 5.0;
        bag.reward_stimulus = vec![Stimulus::AgentInRange];
        bag.range_stimulus_distance = 2.0;
        bag.unique_name = Some("the bag".into());
        let mut world = with_objects(vec![bag]);
        world.agent_params.action_model = ActionModel::OnRails;
        check(&world, &[]);
        let (text, _) = world.check().unwrap().to_l2explorer();
        assert!(
            text.ends_with("}\n") && text.contains("\n  \"max_steps\": 0,\n"),
            "{text}"
        );
        let json: Json = serde_json::from_str(&text).unwrap();
        assert_eq!(
            json,
            json!({
                "game_mode": "learn",
                "max_steps": 0,
                "environment_params": {
                    "bounding_wall_color": [0.72, 0.68, 0.60],
                    "light_intensity": 2.3,
                    "predefined_map": 0,
                    "map_size": [100.0, 100.0]
                },
                "agent_params": {
                    "action_model": "onrails",
                    "agent_height": 1.0,
                    "agent_width": 1.0,
                    "max_linear_speed": 10.0,
                    "max_angular_speed": 90.0,
                    "observation_size": 84,
                    "coordinates": [0.0, 0.0],
                    "heading": 0.0
                },
                "objects": [{
                    "class": "bag",
                    "model": "1",
                    "coordinates": [1.0, 2.5],
                    "color": [0.0, 0.0, 0.0],
                    "motion_model": "stationary",
                    "reward": 5.0,
                    "reward_stimulus": ["AgentInRange"],
                    "range_stimulus_distance": 2.0,
                    "unique_name": "the bag"
                }]
            })
        );
    }

    #[test]
    fn what_only_our_arena_agent_and_rules_have_is_left_out_with_one_summary() {
        let mut world = WorldDraft::default();
        let environment = &mut world.environment_params;
        environment.wall_height = 6.0;
        environment.walls = vec![Wall {
            polygon: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            height: None,
            color: None,
        }];
        environment.sun_direction = [0.0, 0.0, 1.0];
        environment.light_color = Color([1.0, 1.0, 1.0]);
        environment.ambient_light = 0.5;
        environment.sky_color = Color([0.0, 0.0, 1.0]);
        environment.ground_color = Color([0.0, 1.0, 0.0]);
        let agent = &mut world.agent_params;
        agent.time_step = 0.05;
        agent.field_of_view = 90.0;
        agent.modalities = vec![Modality::Rgb];
        agent.actions = ActionSpace::Discrete(vec![[1.0, 0.0, 0.0]]);
        world.rules.step_reward = -0.1;
        world.rules.success = vec![EndCondition::AllCollected];
        check(
            &world,
            &[
                "world (/environment_params/wall_height): left out, L2Explorer has no such keys: \
                 /environment_params/wall_height, /environment_params/walls, /environment_params/sun_direction, \
                 /environment_params/light_color, /environment_params/ambient_light, /environment_params/sky_color, \
                 /environment_params/ground_color, /agent_params/time_step, /agent_params/field_of_view, \
                 /agent_params/modalities, /agent_params/actions, /rules/step_reward, /rules/success",
            ],
        );
    }
}
