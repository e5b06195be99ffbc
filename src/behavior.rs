//! [`behavior`]: compares two variants by what their experts earn in each other's worlds.

use driftworld_env::{Catalogue, ExpertRun, Expertise};
use driftworld_generator::Sampler;
use driftworld_spec::{Variant, World};
use rayon::prelude::*;

use crate::Failure;
use crate::failure::within;

/// Maximum number of pairs of worlds, also for pictures and dynamics.
pub const MAX_BEHAVIOR_WORLDS: u64 = 1_000;

/// Points of regret that count as a distance of 1.
pub(crate) const POINTS: f64 = 100.0;

/// The runs of the experts in one pair of worlds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpertPair {
    /// The expert of `a` in its own world.
    pub a_in_a: ExpertRun,
    /// The expert of `b` in the world of `a`.
    pub b_in_a: ExpertRun,
    /// The expert of `b` in its own world.
    pub b_in_b: ExpertRun,
    /// The expert of `a` in the world of `b`.
    pub a_in_b: ExpertRun,
}

impl ExpertPair {
    /// How many points fewer `b`'s expert earns in `a`'s world than that world's own expert; negative if more.
    pub fn regret_in_a(&self) -> f64 {
        self.a_in_a.earned - self.b_in_a.earned
    }

    /// How many points fewer `a`'s expert earns in `b`'s world than that world's own expert; negative if more.
    pub fn regret_in_b(&self) -> f64 {
        self.b_in_b.earned - self.a_in_b.earned
    }

    /// Success rate of each world's own expert minus the success rate of the other's, −1 to 1.
    pub fn success_difference(&self) -> f64 {
        let successes = |run: ExpertRun| f64::from(u8::from(run.success));
        (successes(self.a_in_a) - successes(self.b_in_a) + successes(self.b_in_b) - successes(self.a_in_b)) / 2.0
    }
}

/// How well the experts of two variants do in each other's worlds.
#[derive(Clone, Debug, PartialEq)]
pub struct BehaviorOutcome {
    /// `(regret_in_a + regret_in_b) / 2` in units of 100 points, at least 0.
    pub distance: f64,
    /// How much less the expert of `b` earns in worlds of `a` than their own expert, in points, on average.
    pub regret_in_a: f64,
    /// How much less the expert of `a` earns in worlds of `b`.
    pub regret_in_b: f64,
    /// Mean of [`ExpertPair::success_difference`], −1 to 1.
    pub success_difference: f64,
    /// The runs in each pair of worlds, `(worlds,)`.
    pub pairs: Vec<ExpertPair>,
}

/// Runs the experts of two variants in each other's worlds.
///
/// Draws `worlds` worlds of each variant, 1 to [`MAX_BEHAVIOR_WORLDS`], under one seed, and pairs world `i` of one with
/// world `i` of the other. In a foreign world an expert knows where everything is, but expects the rewards of its own
/// world; [`Expertise::abroad`] describes this in detail.
///
/// The distance is symmetric, and 0 from a variant to itself. It may be 0 between different variants, and violate the triangle
/// inequality. Experts are greedy: they visit the nearest rewarding object first. If the foreign expert's route happens to be
/// better, the regret is negative.
///
/// # Errors
/// [`Failure`] if a world cannot be drawn, or `worlds` is out of range.
///
/// # Example
/// ```
/// use driftworld::{behavior::behavior, env::Catalogue, tasks};
/// let [red, penalty] = ["find_objects#red", "find_objects#penalty"].map(|name| tasks::variant(name).unwrap());
/// let found = behavior(&red, &penalty, 2, 0, &Catalogue::default()).unwrap();
/// assert!(found.distance > 0.0);
/// ```
pub fn behavior(
    a: &Variant,
    b: &Variant,
    worlds: u64,
    seed: u64,
    catalogue: &Catalogue,
) -> Result<BehaviorOutcome, Failure> {
    within("worlds", worlds, 1..=MAX_BEHAVIOR_WORLDS)?;
    let expertise = Expertise {
        catalogue: catalogue.clone(),
        ..Expertise::default()
    };
    let (sampler_a, sampler_b) = (Sampler::new(a, seed), Sampler::new(b, seed));
    let pairs: Vec<ExpertPair> = (0..worlds)
        .into_par_iter()
        .map(|index| exchange(&expertise, &sampler_a.world(index)?, &sampler_b.world(index)?))
        .collect::<Result<_, Failure>>()?;
    Ok(outcome(pairs))
}

/// Runs the expert of each world in both worlds.
fn exchange(expertise: &Expertise, a: &World, b: &World) -> Result<ExpertPair, Failure> {
    Ok(ExpertPair {
        a_in_a: expertise.at_home(a)?,
        b_in_a: expertise.abroad(b, a)?,
        b_in_b: expertise.at_home(b)?,
        a_in_b: expertise.abroad(a, b)?,
    })
}

fn outcome(pairs: Vec<ExpertPair>) -> BehaviorOutcome {
    let mean = |of: fn(&ExpertPair) -> f64| pairs.iter().map(of).sum::<f64>() / pairs.len().max(1) as f64;
    let (regret_in_a, regret_in_b) = (mean(ExpertPair::regret_in_a), mean(ExpertPair::regret_in_b));
    BehaviorOutcome {
        distance: (f64::midpoint(regret_in_a, regret_in_b) / POINTS).max(0.0),
        regret_in_a,
        regret_in_b,
        success_difference: mean(ExpertPair::success_difference),
        pairs,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tasks;

    fn between(a: &str, b: &str, worlds: u64) -> BehaviorOutcome {
        let [a, b] = [a, b].map(|name| tasks::variant(name).expect("it is built in"));
        behavior(&a, &b, worlds, 0, &Catalogue::default()).expect("both can be drawn")
    }

    #[test]
    fn variant_has_distance_0_from_itself() {
        let found = between("find_objects#red", "find_objects#red", 2);
        let numbers = [
            found.distance,
            found.regret_in_a,
            found.regret_in_b,
            found.success_difference,
        ];
        assert_eq!(numbers, [0.0; 4]);
        assert!(
            found
                .pairs
                .iter()
                .all(|pair| pair.a_in_a == pair.b_in_a && pair.a_in_a.earned > 0.0)
        );
    }

    #[test]
    fn behavior_is_symmetric() {
        let there = between("find_objects#red", "find_objects#penalty", 2);
        let back = between("find_objects#penalty", "find_objects#red", 2);
        assert!(there.distance > 0.0);
        assert_eq!(there.distance, back.distance);
        assert_eq!(
            (there.regret_in_a, there.regret_in_b),
            (back.regret_in_b, back.regret_in_a)
        );
        assert_eq!(there.success_difference, back.success_difference);
    }

    #[test]
    fn regret_is_the_advantage_of_the_worlds_own_expert() {
        let expert_run = |earned, success| ExpertRun {
            earned,
            success,
            steps: 1,
        };
        let pair = ExpertPair {
            a_in_a: expert_run(50.0, true),
            b_in_a: expert_run(-10.0, false),
            b_in_b: expert_run(20.0, true),
            a_in_b: expert_run(40.0, true),
        };
        let found = outcome(vec![pair]);
        assert_eq!((found.regret_in_a, found.regret_in_b), (60.0, -20.0));
        assert_eq!((found.distance, found.success_difference), (0.2, 0.5));
    }

    #[test]
    fn world_counts_out_of_range_are_refused() {
        let red = tasks::variant("find_objects#red").expect("it is built in");
        for worlds in [0, MAX_BEHAVIOR_WORLDS + 1] {
            assert!(
                behavior(&red, &red, worlds, 0, &Catalogue::default()).is_err(),
                "{worlds}"
            );
        }
    }
}
