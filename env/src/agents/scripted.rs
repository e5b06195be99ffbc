//! [`ScriptedAgent`] plays a script of fixed actions and walks to named objects.

use driftworld_spec::Object;

use super::planner::{Act, Planner, can_interact};
use super::script::{Command, Until, parse};
use super::steering::in_space;
use super::{Agent, OnRailsAgent};
use crate::EnvError;
use crate::polygon::distance;
use crate::sim::{Action, Environment, ObjectState};

/// Maximum number of interactions with an object that does not react.
const MAX_INTERACTIONS: u32 = 10;

/// Plays a script from the start in every episode. A script has one command per line; `#` begins a comment. After the last line
/// the agent stands still.
///
/// | line | effect |
/// |---|---|
/// | `step [N] [A B C \| ROW]` | takes N steps (1) with action A B C (0 0 0), or with a row of the action table, as in the console |
/// | `action [-c N] -a A B C \| ROW` | the same, with options |
/// | `touch NAME [N]` | walks to the nearest object of this tag or unique name until it touches it, for at most N steps (300) |
/// | `interact NAME [N]` | walks there and interacts until the object reacts, at most 10 times |
/// | `near NAME METRES [N]` | walks there until its centre is nearer than METRES |
/// | `tour [N]` | acts like [`OnRailsAgent`] until nothing worth visiting is left |
/// | `repeat` | restarts the script; only as the last line |
/// A walk to an absent object takes no steps. Walks work in every action space; the actions of `step` and `action` are passed
/// to the world unchanged.
///
/// # Example
/// ```
/// use driftworld_env::{Agent, Environment, ScriptedAgent};
/// use driftworld_spec::World;
/// let mut agent = ScriptedAgent::parse("ahead", "step 3 10 0 0")?;
/// let mut environment = Environment::new(World::default());
/// for _ in 0..5 {
///     let action = agent.act(&environment);
///     environment.step(action)?;
/// }
/// assert_eq!(environment.agent().position, [0.0, 3.0], "three steps ahead, then it stands still");
/// # Ok::<(), driftworld_env::EnvError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ScriptedAgent {
    commands: Vec<Command>,
    /// Index of the current command.
    current: usize,
    /// Steps that the current command has taken so far.
    steps: u32,
    walk: Option<Walk>,
    /// Finds the ways of walks. Boxed because it is large.
    planner: Box<Planner>,
    rails: OnRailsAgent,
}

/// A walk in progress.
#[derive(Clone, Debug)]
struct Walk {
    /// Index of the object.
    object: u32,
    /// The object's state when the walk began.
    before: ObjectState,
    /// Number of steps in which the agent has interacted within reach, or touched it if it cannot interact.
    num_interactions: u32,
}

impl ScriptedAgent {
    /// Parses a script. Error messages refer to it as `name`, usually its path.
    ///
    /// # Errors
    /// [`EnvError::BadScript`], with the first faulty line, if the script is invalid.
    pub fn parse(name: &str, text: &str) -> Result<Self, EnvError> {
        Ok(Self {
            commands: parse(name, text)?,
            current: 0,
            steps: 0,
            walk: None,
            planner: Box::default(),
            rails: OnRailsAgent::new(),
        })
    }

    /// Whether the script has finished and the agent stands still.
    pub fn is_over(&self) -> bool {
        self.current >= self.commands.len()
    }

    fn next(&mut self) {
        self.current += 1;
        self.steps = 0;
        self.walk = None;
        self.rails = OnRailsAgent::new();
    }

    /// The current command's action for this step; `None` once the command is finished.
    fn run_command(&mut self, environment: &Environment) -> Option<Action> {
        match self.commands[self.current].clone() {
            Command::Act { action, steps } => (self.steps < steps).then_some(action),
            Command::Tour { steps } => {
                let continues = self.steps < steps && !OnRailsAgent::is_done(environment.sim());
                continues.then(|| self.rails.act(environment))
            }
            Command::Go { name, until, steps } => {
                let numbers = (self.steps < steps).then(|| self.go(environment, &name, until))??;
                Some(in_space(numbers, environment.sim()))
            }
            Command::Repeat => None,
        }
    }

    fn go(&mut self, environment: &Environment, name: &str, until: Until) -> Option<[f64; 3]> {
        let sim = environment.sim();
        if self.walk.is_none() {
            let object = nearest(environment, name)?;
            self.walk = Some(Walk {
                object,
                before: sim.objects()[object as usize].clone(),
                num_interactions: 0,
            });
        }
        let walk = self.walk.as_mut()?;
        if walk.is_over(environment, until) {
            return None;
        }
        let act = match until {
            Until::Touched => Act::Touch,
            Until::Interacted => Act::Use,
            Until::Near(_) => Act::Near,
        };
        let numbers = self.planner.approach(sim, walk.object, act);
        let pushes = !can_interact(sim.world) && sim.state.touches(walk.object as usize);
        walk.num_interactions += u32::from(numbers[2] > 0.5 || pushes);
        Some(numbers)
    }
}

impl Walk {
    fn is_over(&self, environment: &Environment, until: Until) -> bool {
        let index = self.object as usize;
        let current = &environment.objects()[index];
        let has_reacted = |before: &ObjectState| {
            current.present != before.present
                || current.collected != before.collected
                || current.reward != before.reward
        };
        match until {
            Until::Touched => has_reacted(&self.before) || environment.sim().state.touches(index),
            Until::Interacted => has_reacted(&self.before) || self.num_interactions >= MAX_INTERACTIONS,
            Until::Near(metres) => {
                !current.present || distance(environment.agent().position, current.position) < metres
            }
        }
    }
}

impl Agent for ScriptedAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        // Goes through the script at most once, since a loop of commands that take no steps would never end.
        for _ in 0..=self.commands.len() {
            if self.is_over() {
                break;
            }
            if let Some(action) = self.run_command(environment) {
                self.steps += 1;
                return action;
            }
            let repeats = self.commands[self.current] == Command::Repeat;
            self.next();
            if repeats {
                self.current = 0;
            }
        }
        in_space([0.0; 3], environment.sim())
    }

    fn begin(&mut self, _seed: u64) {
        self.next();
        self.current = 0;
        self.planner.begin();
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}

/// The nearest present object with this tag or unique name.
fn nearest(environment: &Environment, name: &str) -> Option<u32> {
    let here = environment.agent().position;
    let has_name = |object: &Object| {
        [&object.tag, &object.unique_name]
            .into_iter()
            .flatten()
            .any(|own| own == name)
    };
    let objects = environment
        .world()
        .objects
        .iter()
        .zip(environment.objects())
        .enumerate();
    objects
        .filter(|(_, (object, state))| state.present && has_name(object))
        .map(|(index, (_, state))| (index as u32, distance(here, state.position)))
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
        .map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::{ActionSpace, Stimulus, World, WorldDraft};

    /// Coins north and east of the agent, a switch to the west.
    fn world() -> World {
        let mut world = WorldDraft::default();
        for (tag, at) in [("coin", [0.0, 8.0]), ("coin", [12.0, 0.0]), ("switch", [-6.0, 0.0])] {
            let mut object = Object::new("geometric", at);
            object.tag = Some(tag.to_owned());
            object.reward = 1.0;
            if tag == "coin" {
                object.reward_once_stimulus = vec![Stimulus::AgentCollide];
                object.destroy_stimulus = vec![Stimulus::AgentCollide];
            } else {
                object.reward_stimulus = vec![Stimulus::AgentInteract];
            }
            world.objects.push(object);
        }
        world.check().expect("the world is valid")
    }

    /// Return and final position after playing a script for this many steps.
    fn play(world: World, script: &str, steps: u32) -> (f64, [f32; 2]) {
        let mut agent = ScriptedAgent::parse("script", script).expect("the script is valid");
        let mut environment = Environment::new(world);
        for _ in 0..steps {
            let action = agent.act(&environment);
            environment.step(action).expect("the action fits");
        }
        (environment.episode_return(), environment.agent().position)
    }

    #[test]
    fn walk_goes_to_the_nearest_object_and_ends_on_touch() {
        let (earned, at) = play(world(), "touch coin\nstep 100", 120);
        assert_eq!(earned, 1.0);
        assert!(at[0].abs() < 0.5 && at[1] > 6.0, "{at:?}");
        assert_eq!(play(world(), "touch coin\ntouch coin", 120).0, 2.0);
    }

    #[test]
    fn interact_sets_off_a_switch_that_touch_does_not() {
        assert_eq!(play(world(), "touch switch", 60).0, 0.0);
        assert_eq!(play(world(), "interact switch", 60).0, 1.0);
    }

    #[test]
    fn interact_ends_where_the_agent_cannot_interact() {
        let world = world().edit(|world| world.agent_params.interact = false);
        let (_, at) = play(
            world.expect("the world is valid"),
            "interact switch\nstep 30 -10 0 0",
            60,
        );
        assert!(at[0] > 0.0, "{at:?}");
    }

    #[test]
    fn near_stops_at_the_given_distance() {
        let (earned, [x, _]) = play(world(), "near switch 3", 60);
        assert_eq!(earned, 0.0);
        assert!((-4.2..-2.9).contains(&x), "{x}");
    }

    #[test]
    fn repeat_restarts_and_a_script_without_steps_stands_still() {
        assert_eq!(play(world(), "touch coin\nrepeat", 120).0, 2.0);
        assert_eq!(play(world(), "touch nobody\nrepeat", 5), (0.0, [0.0, 0.0]));
    }

    #[test]
    fn walks_fit_a_world_with_an_action_table() {
        let table = world().edit(|world| world.agent_params.actions = ActionSpace::DefaultDiscrete);
        assert_eq!(play(table.expect("the world is valid"), "touch coin", 120).0, 1.0);
    }

    #[test]
    fn episode_restarts_the_script() {
        let mut agent = ScriptedAgent::parse("script", "step 2 10 0 0").expect("the script is valid");
        let environment = Environment::new(World::default());
        for _ in 0..3 {
            agent.act(&environment);
        }
        assert!(agent.is_over());
        agent.begin(1);
        assert_eq!(agent.act(&environment), Action::Continuous([10.0, 0.0, 0.0]));
    }
}
