//! The numbers of classes in class segmentation.

use driftworld_env::{Catalogue, EnvError, Library};
use pyo3::prelude::*;

use crate::errors::Result;

/// All known classes with their numbers in class segmentation, ordered by number: the built-in ones and those of libraries,
/// given as bytes.
#[pyfunction]
pub(crate) fn class_numbers(libraries: Vec<Vec<u8>>) -> Result<Vec<(String, u16)>> {
    let catalogue = catalogue(&libraries)?;
    let numbers = catalogue.class_numbers();
    Ok(numbers.map(|(class, number)| (class.to_owned(), number)).collect())
}

/// The built-in models, overridden by those of libraries, given as bytes.
pub(crate) fn catalogue(libraries: &[Vec<u8>]) -> std::result::Result<Catalogue, EnvError> {
    let built_in = Catalogue::default();
    libraries.iter().try_fold(built_in, |catalogue, bytes| {
        Ok(catalogue.with_library(&Library::from_bytes(bytes)?))
    })
}
