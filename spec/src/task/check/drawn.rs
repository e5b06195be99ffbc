//! Parameters that only draws read: what of their declarations would not be used.

use super::super::TaskSpec;
use super::super::parameter::Role;
use crate::describe::escape;
use crate::error::Problem;

/// Parameters that only draws read are compared by what is drawn: a measure of their own would not be used.
pub(super) fn compared_by_draws(task: &TaskSpec) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (name, parameter) in task
        .parameters()
        .iter()
        .filter(|(_, parameter)| parameter.compare.is_some())
    {
        let readers = task.readers(name);
        if parameter.role == Role::Variant && readers.are_draws_alone() {
            let found = format!(
                "a measure of a parameter that only the draw of {} reads",
                readers.draws.join(", ")
            );
            let expected = "\"compare\" at the drawn parameter, by whose distribution variants are compared";
            problems.push(Problem::new(
                "spec/compare",
                format!("/parameters/{}/compare", escape(name)),
                found,
                expected,
            ));
        }
    }
    problems
}
