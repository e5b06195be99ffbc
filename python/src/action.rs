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

/// An error, as that of an action that is no row's number with the number that was found, where it is one.
pub(crate) fn no_row(error: Error, row: impl Fn(usize) -> Option<i64>) -> Error {
    let (inner, env) = match &error {
        Error::Env(EnvError::BatchAction { env, error }) => (&**error, *env),
        Error::Env(inner) => (inner, 0),
        _ => return error,
    };
    let (EnvError::NoSuchAction { found: NO_ROW, last }, Some(row)) = (inner, row(env)) else {
        return error;
    };
    let message =
        format!("action: found row {row}, expected 0 to {last} of the world's action table; nothing was changed");
    PyValueError::new_err(message).into()
}
