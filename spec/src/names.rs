//! Reports invalid names as problems of a document. The grammar is in `driftworld-text`; the schemas repeat as much of
//! it as they can.

use driftworld_text::{check_name, quoted};

use crate::error::Problem;

/// The problem with the name of a task, a variant, a group, a regime or a scenario; `None` if it is valid.
pub(crate) fn problem(pointer: impl Into<String>, name: &str) -> Option<Problem> {
    let fault = check_name(name).err()?;
    let found = format!("the name {} with {fault}", quoted(name));
    Some(Problem::new("spec/name", pointer, found, fault.expected()))
}

/// Checks a name chosen by a user, like [`driftworld_text::check_name`], and describes the fault in words.
///
/// # Errors
/// A sentence that says what was found and what was expected, if the name is invalid.
///
/// # Example
/// ```
/// assert!(driftworld_spec::sound_name("dusk-2").is_ok());
/// let error = driftworld_spec::sound_name("a/b").unwrap_err();
/// assert_eq!(error, "found the name \"a/b\" with the character \"/\", expected letters and digits of any script, _, -, + and . in a name");
/// ```
pub fn sound_name(name: &str) -> Result<(), String> {
    problem("", name).map_or(Ok(()), |problem| {
        Err(format!("found {}, expected {}", problem.found, problem.expected))
    })
}
