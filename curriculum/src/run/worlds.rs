//! [`Worlds`]: the worlds of a plan, drawn one after the other.

use driftworld_generator::Sampler;
use driftworld_spec::{Variant, World};

use super::{Plan, Undrawable};
use crate::CurriculumError;

/// Draws worlds, with one sampler per regime.
pub(super) struct Worlds<'a> {
    plan: &'a Plan,
    /// The regime of the last world, and its sampler.
    sampler: Option<(usize, Option<Sampler>)>,
}

/// A world, and its interpolated variant if the regime drifts; or the reason why it cannot be drawn, if the plan skips such
/// experiences.
pub(super) type Drawn = Result<(World, Option<Variant>), String>;

impl<'a> Worlds<'a> {
    pub(super) fn new(plan: &'a Plan) -> Self {
        Self { plan, sampler: None }
    }

    /// The world of an experience, by its number.
    pub(super) fn draw(&mut self, number: u64) -> Result<Drawn, CurriculumError> {
        let index = self.plan.regime_of(number);
        let planned = &self.plan.regimes[index];
        let sampler = match &mut self.sampler {
            Some((regime, sampler)) if *regime == index => sampler,
            old => &mut old.insert((index, planned.sampler())).1,
        };
        match planned.draw(number, sampler.as_ref()) {
            Ok(drawn) => Ok(Ok(drawn)),
            Err(source) if self.plan.undrawable == Undrawable::Skipped => Ok(Err(source.to_string())),
            Err(source) => Err(planned.world_error(number, source)),
        }
    }
}
