//! Notes on surprising properties of a design: named variants that are not learned, unbalanced orders, experts of mixtures.

use driftworld_spec::ScenarioForm;

use super::choose::is_among;
use super::{Chosen, DesignRequest};
use crate::{Failure, argument, tasks};

impl DesignRequest {
    pub(super) fn notes(&self, chosen: &Chosen) -> Result<Vec<String>, Failure> {
        let held_out = self.held_out()?;
        let mut notes = Vec::new();
        for name in &self.tasks {
            let (task, variant) = tasks::split(name);
            if variant.is_some_and(|variant| is_among(&held_out, task, variant)) {
                notes.push(format!("{name} is named and held out: it is evaluated but not learned"));
            }
        }
        let num = chosen.order.len() as u64;
        let rows = if num.is_multiple_of(2) { num } else { 2 * num };
        if let (Some(ScenarioForm::Permuted), Some(lifetimes)) = (self.form(), self.lifetimes)
            && rows > 0
            && !lifetimes.is_multiple_of(rows)
        {
            notes.push(format!(
                "{lifetimes} lifetimes of {num} variants are not balanced: some variants come earlier, or after others, \
                 more often; {rows} lifetimes, or a multiple of it, are balanced"
            ));
        }
        if self.experts && self.mix.is_some() {
            notes.push(
                "experts of a mixture learn a variant while the drift is nearer to it, not in the worlds in which the \
                 mixture draws it: about the same number of worlds, but different ones"
                    .to_owned(),
            );
        }
        Ok(notes)
    }

    /// The held-out variants. Their names may omit the task if it is one of the learned tasks.
    pub(super) fn held_out(&self) -> Result<Vec<(String, driftworld_spec::Variant)>, Failure> {
        let all = tasks::with_tasks(&[self.tasks.as_slice(), &self.hold_out].concat());
        let found = tasks::variants_of(&all[self.tasks.len()..]);
        found.map_err(|error| Failure::because(format!("{}: {error}", argument("hold_out")), error))
    }
}
