//! Actions as Python hands them over: numbers, or rows of a world's table. Spaces and their names are in
//! `package/driftworld/envs/spaces.py`.

use driftworld_env::{Action, EnvError};
use pyo3::exceptions::PyValueError;

use crate::errors::Error;

/// The row that stands for every number that is none: no table is as long.
const NO_ROW: usize = usize::MAX;

/// The action of up to three numbers; those that are missing are 0.
pub(crate) fn number_action(number: impl Fn(usize) -> Option<f64>) -> Action {
    Action::Continuous([0, 1, 2].map(|column| number(column).unwrap_or(0.0)))
}

/// The action of a row. What is no row is an error where the action counts, which the batch knows.
pub(crate) fn row_action(row: i64) -> Action {
    Action::Discrete(usize::try_from(row).unwrap_or(NO_ROW))
}

/// The error of an action that is no row's number, with the number that was found.
pub(crate) fn no_row(error: &EnvError, row: Option<&i64>) -> Option<Error> {
    let (EnvError::NoSuchAction { found: NO_ROW, last }, Some(row)) = (error, row) else {
        return None;
    };
    let message =
        format!("action: found row {row}, expected 0 to {last} of the world's action table; nothing was changed");
    Some(PyValueError::new_err(message).into())
}
