//! An agent that knows the map but not which of several worlds has the true rewards, so that it has to find out.

use driftworld_spec::World;

use super::belief::Belief;
use super::{ExpertRun, Expertise, MAX_EXPERT_STEPS};
use crate::EnvError;
use crate::agents::{Agent, OnRailsAgent, in_space};
use crate::sim::{Environment, Step};

/// Rewards that differ by at most this count as equal.
const SAME_REWARD: f64 = 1e-9;

impl Expertise {
    /// An agent in the world `abroad` that knows only that its rewards are those of one of `homes`.
    ///
    /// It acts as the expert of the first home does [`abroad`](Self::abroad). After each step it drops the homes in which that
    /// step would have given a different reward or ending, and follows the first of the rest. If none remains, it keeps the one
    /// it followed. Uncertain rewards are compared using this world's own random draws, so the agent finds out sooner than a
    /// learner could.
    ///
    /// With one home, the result is that of [`abroad`](Self::abroad), bit for bit; with none, that of
    /// [`at_home`](Self::at_home).
    ///
    /// # Errors
    /// The errors of [`Expertise::abroad`].
    ///
    /// # Example
    /// ```
    /// use driftworld_env::Expertise;
    /// use driftworld_spec::{Color, Object, Stimulus, WorldDraft};
    /// let mut draft = WorldDraft { max_steps: 200, ..WorldDraft::default() };
    /// for (place, blue, reward) in [([0.0, 6.0], 0.0, 10.0), ([6.0, 0.0], 1.0, -10.0)] {
    ///     let mut cube = Object::new("geometric", place);
    ///     (cube.color, cube.reward) = (Some(Color([1.0, 0.0, blue])), reward);
    ///     cube.reward_once_stimulus = vec![Stimulus::AgentCollide];
    ///     draft.objects.push(cube);
    /// }
    /// let red = draft.check().expect("the world is valid");
    /// let purple = red.clone().edit(|world| {
    ///     for object in &mut world.objects {
    ///         object.reward = -object.reward;
    ///     }
    /// }).expect("the world is valid");
    /// // Knowing earns 10, a wrong belief -10, and finding out 0.
    /// let expertise = Expertise::default();
    /// assert_eq!(expertise.at_home(&purple)?.earned, 10.0);
    /// assert_eq!(expertise.abroad(&red, &purple)?.earned, -10.0);
    /// assert_eq!(expertise.finding_out(&[&red, &purple], &purple)?.earned, 0.0);
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn finding_out(&self, homes: &[&World], abroad: &World) -> Result<ExpertRun, EnvError> {
        let beliefs = homes.iter().map(|home| Belief::new(home, abroad, &self.catalogue));
        let mut beliefs: Vec<Belief> = beliefs.collect::<Result<_, _>>()?;
        let mut truth = Environment::with_catalogue(abroad.clone(), self.catalogue.clone());
        let (mut expert, mut run) = (OnRailsAgent::new(), ExpertRun::default());
        let (mut step, mut predicted) = (Step::default(), Step::default());
        while !truth.ended() && run.steps < self.steps.min(MAX_EXPERT_STEPS) {
            // An expert of another world does not know where the zones are.
            let action = match beliefs.first_mut() {
                Some(belief) => in_space(expert.steer(belief.at(&truth).sim()), truth.sim()),
                None => expert.act(&truth),
            };
            let has_alternatives = beliefs.len() > 1;
            if has_alternatives {
                for belief in &mut beliefs {
                    belief.at(&truth);
                }
            }
            truth.step_into(action, &mut step)?;
            if has_alternatives {
                let mut matches = Vec::with_capacity(beliefs.len());
                for belief in &mut beliefs {
                    belief.predict(action, &mut predicted)?;
                    matches.push(
                        (predicted.reward - step.reward).abs() <= SAME_REWARD
                            && (predicted.success, predicted.terminated) == (step.success, step.terminated),
                    );
                }
                if matches.contains(&true) {
                    if !matches[0] {
                        expert = OnRailsAgent::new();
                    }
                    let mut matched = matches.into_iter();
                    beliefs.retain(|_| matched.next() == Some(true));
                } else {
                    beliefs.truncate(1);
                }
            }
            for belief in &mut beliefs {
                belief.record(&step);
            }
            run.earned += step.reward;
            run.success |= step.success;
            run.steps += 1;
        }
        Ok(run)
    }
}
