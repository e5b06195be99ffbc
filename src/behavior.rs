//! [`behavior`]: what the experts of two variants earn in each other's worlds. How an expert lives in a world that is not its own is
//! `env`'s.

use std::path::PathBuf;

use driftworld_env::{Catalogue, ExpertRun, Expertise, MAX_EXPERT_STEPS};
use driftworld_generator::Sampler;
use driftworld_spec::{Variant, World};
use rayon::prelude::*;

use crate::{Failure, libraries, tasks, within};

/// How many pairs of worlds experts live in where nobody says.
pub const DEFAULT_BEHAVIOR_WORLDS: u64 = 16;

/// The most pairs of worlds.
pub const MAX_BEHAVIOR_WORLDS: u64 = 1_000;

/// Points of regret that count 1.
pub(crate) const POINTS: f64 = 100.0;

/// Whose experts are exchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct BehaviorRequest {
    /// One variant, as `task#variant`.
    pub a: String,
    /// The other.
    pub b: String,
    /// How many pairs of worlds, 1 to [`MAX_BEHAVIOR_WORLDS`]; default [`DEFAULT_BEHAVIOR_WORLDS`].
    pub worlds: u64,
    /// The seed that worlds are drawn under; default 0.
    pub seed: u64,
    /// Steps after which an episode ends that no rule ends before, 1 to [`MAX_EXPERT_STEPS`]; default 500.
    pub steps: u32,
    /// Asset libraries whose classes the tasks use, in front of the built-in assets, the last one first.
    pub libraries: Vec<PathBuf>,
}

impl BehaviorRequest {
    /// Two variants; all else is at its default.
    pub fn between(a: impl Into<String>, b: impl Into<String>) -> Self {
        Self {
            a: a.into(),
            b: b.into(),
            worlds: DEFAULT_BEHAVIOR_WORLDS,
            seed: 0,
            steps: Expertise::default().steps,
            libraries: Vec::new(),
        }
    }

    fn check(&self) -> Result<(), Failure> {
        within("worlds", self.worlds, 1..=MAX_BEHAVIOR_WORLDS)?;
        within("steps", self.steps.into(), 1..=MAX_EXPERT_STEPS.into())
    }
}

/// What experts did in one pair of worlds.
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
    /// How much less the expert of `b` earns in the world of `a` than that world's own, in points; below 0 where it earns more.
    pub fn regret_in_a(&self) -> f64 {
        self.a_in_a.earned - self.b_in_a.earned
    }

    /// The same of the expert of `a` in the world of `b`.
    pub fn regret_in_b(&self) -> f64 {
        self.b_in_b.earned - self.a_in_b.earned
    }

    /// How much more often the own experts succeed than the others, −1 to 1.
    pub fn success_difference(&self) -> f64 {
        let count = |run: ExpertRun| f64::from(u8::from(run.success));
        (count(self.a_in_a) - count(self.b_in_a) + count(self.b_in_b) - count(self.a_in_b)) / 2.0
    }
}

/// What experts earn in each other's worlds.
#[derive(Clone, Debug, PartialEq)]
pub struct BehaviorOutcome {
    /// `(regret_in_a + regret_in_b) / 2` in shares of 100 points, at least 0.
    pub distance: f64,
    /// What the expert of `b` earns less in worlds of `a` than their own expert, in points, on average.
    pub regret_in_a: f64,
    /// What the expert of `a` earns less in worlds of `b`.
    pub regret_in_b: f64,
    /// How much more often own experts succeed than the others, on average: −1 to 1.
    pub success_difference: f64,
    /// `(worlds,)`: pair by pair.
    pub pairs: Vec<ExpertPair>,
}

/// Lets the experts of two variants live in each other's worlds.
///
/// World number `i` of one variant is paired with number `i` of the other, under one seed. [`Expertise::abroad`] says what an expert
/// knows in a world that is not its own: where everything is, and of what it pays only what it would pay at home.
///
/// The distance is symmetric, and 0 of a variant to itself. It may be 0 between different variants, and does not obey the triangle
/// inequality. An expert tours what pays, nearest first: it is no optimum, and where another's tour happens to be better the regret is
/// below 0.
///
/// # Errors
/// [`Failure`] where a variant is nowhere or wrong, a world cannot be drawn, or a number is out of its range.
///
/// # Example
/// ```
/// use driftworld::behavior::{BehaviorRequest, behavior};
/// let request = BehaviorRequest { worlds: 2, ..BehaviorRequest::between("find_objects#red", "find_objects#penalty") };
/// let found = behavior(&request).unwrap();
/// assert!(found.distance > 0.0);
/// ```
pub fn behavior(request: &BehaviorRequest) -> Result<BehaviorOutcome, Failure> {
    behavior_between(&tasks::variant(&request.a)?, &tasks::variant(&request.b)?, request)
}

/// The same for variants that have been read; the names in the request are not looked at.
///
/// # Errors
/// As [`behavior`].
pub fn behavior_between(a: &Variant, b: &Variant, request: &BehaviorRequest) -> Result<BehaviorOutcome, Failure> {
    behavior_with(a, b, request, libraries::catalogue(&request.libraries)?)
}

/// The same with assets out of a catalogue; the libraries in the request are not looked at.
///
/// # Errors
/// As [`behavior`].
pub(crate) fn behavior_with(
    a: &Variant,
    b: &Variant,
    request: &BehaviorRequest,
    catalogue: Catalogue,
) -> Result<BehaviorOutcome, Failure> {
    request.check()?;
    let expertise = Expertise {
        steps: request.steps,
        catalogue,
    };
    let (of_a, of_b) = (Sampler::new(a, request.seed), Sampler::new(b, request.seed));
    let pairs: Vec<ExpertPair> = (0..request.worlds)
        .into_par_iter()
        .map(|index| exchange(&expertise, &of_a.world(index)?, &of_b.world(index)?))
        .collect::<Result<_, Failure>>()?;
    Ok(outcome(pairs))
}

/// Lets the experts of two worlds live in each other's.
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

    fn between(a: &str, b: &str, worlds: u64) -> BehaviorOutcome {
        behavior(&BehaviorRequest {
            worlds,
            ..BehaviorRequest::between(a, b)
        })
        .expect("both variants are built in")
    }

    #[test]
    fn a_variant_is_nothing_apart_from_itself() {
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
    fn it_makes_no_difference_who_comes_first() {
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
    fn regret_is_what_the_own_expert_earns_more() {
        let lived = |earned, success| ExpertRun {
            earned,
            success,
            steps: 1,
        };
        let pair = ExpertPair {
            a_in_a: lived(50.0, true),
            b_in_a: lived(-10.0, false),
            b_in_b: lived(20.0, true),
            a_in_b: lived(40.0, true),
        };
        let found = outcome(vec![pair]);
        assert_eq!((found.regret_in_a, found.regret_in_b), (60.0, -20.0));
        assert_eq!((found.distance, found.success_difference), (0.2, 0.5));
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let request = BehaviorRequest::between("find_objects#red", "find_objects#blue");
        assert!(
            behavior(&BehaviorRequest {
                worlds: 0,
                ..request.clone()
            })
            .is_err()
        );
        assert!(
            behavior(&BehaviorRequest {
                steps: 100_001,
                ..request
            })
            .is_err()
        );
    }
}
