//! An agent that knows the map, but only that rewards are as in one of several worlds, so it has to find out which.

use driftworld_spec::World;

use super::belief::Belief;
use super::{ExpertRun, Expertise, MAX_EXPERT_STEPS};
use crate::EnvError;
use crate::agents::{Agent, OnRailsAgent, in_space};
use crate::sim::{Environment, Step};

/// Rewards that differ by at most this are equal.
const SAME_REWARD: f64 = 1e-9;

impl Expertise {
    /// An agent in the world `abroad` that knows only that rewards are as in one of `homes`.
    ///
    /// It acts as the expert of the first home does [`abroad`](Self::abroad). After each step it drops the homes in which that
    /// step would have given a different reward or ending, and follows the first remaining one. If none remains, it keeps the
    /// last one it followed. Uncertain rewards are compared using the random draws of this very world, so the agent finds out
    /// sooner than a learner could.
    ///
    /// With one home it is the expert of that home abroad, bit for bit; with none, the expert of the world itself.
    ///
    /// # Errors
    /// Those of [`Expertise::abroad`].
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
    /// let red = draft.check().expect("it is sound");
    /// let purple = red.clone().edit(|world| {
    ///     for object in &mut world.objects {
    ///         object.reward = -object.reward;
    ///     }
    /// }).expect("it is sound");
    /// // It pays 10 to know, costs 10 to be wrong, and 10 less to be wrong first.
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
        let (mut step, mut foreseen) = (Step::default(), Step::default());
        while !truth.ended() && run.steps < self.steps.min(MAX_EXPERT_STEPS) {
            // An expert from elsewhere does not know where the zones are.
            let action = match beliefs.first_mut() {
                Some(belief) => in_space(expert.steer(belief.at(&truth).sim()), truth.sim()),
                None => expert.act(&truth),
            };
            let doubts = beliefs.len() > 1;
            if doubts {
                for belief in &mut beliefs {
                    belief.at(&truth);
                }
            }
            truth.step_into(action, &mut step)?;
            if doubts {
                let mut agrees = Vec::with_capacity(beliefs.len());
                for belief in &mut beliefs {
                    belief.foresee(action, &mut foreseen)?;
                    agrees.push(
                        (foreseen.reward - step.reward).abs() <= SAME_REWARD
                            && (foreseen.success, foreseen.terminated) == (step.success, step.terminated),
                    );
                }
                if agrees.contains(&true) {
                    if !agrees[0] {
                        expert = OnRailsAgent::new();
                    }
                    let mut kept = agrees.into_iter();
                    beliefs.retain(|_| kept.next() == Some(true));
                } else {
                    beliefs.truncate(1);
                }
            }
            for belief in &mut beliefs {
                belief.note(&step);
            }
            run.earned += step.reward;
            run.success |= step.success;
            run.steps += 1;
        }
        Ok(run)
    }
}
