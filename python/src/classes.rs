//! The numbers of classes in class segmentation. Which number a class has is said in `env`.

use driftworld_env::{Catalogue, EnvError, Library};
use pyo3::prelude::*;

use crate::errors::Result;

/// The classes that are known, with their numbers in class segmentation, in rising order: the built-in ones and those of
/// libraries, given as their bytes.
#[pyfunction]
pub(crate) fn class_numbers(libraries: Vec<Vec<u8>>) -> Result<Vec<(String, u16)>> {
    let catalogue = catalogue(&libraries)?;
    let numbers = catalogue.class_numbers();
    Ok(numbers.map(|(class, number)| (class.to_owned(), number)).collect())
}

/// The built-in models with those of libraries in front, given as their bytes.
pub(crate) fn catalogue(libraries: &[Vec<u8>]) -> std::result::Result<Catalogue, EnvError> {
    let built_in = Catalogue::default();
    libraries.iter().try_fold(built_in, |catalogue, bytes| {
        Ok(catalogue.with_library(&Library::from_bytes(bytes)?))
    })
}
