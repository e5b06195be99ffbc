//! The numbers of classes in class segmentation. Which number a class has is said in `env`.

use driftworld_env::{Catalogue, Library};
use pyo3::prelude::*;

use crate::errors::Result;

/// The classes that are known, with their numbers in class segmentation, in rising order: the built-in ones and those of
/// libraries, given as their bytes.
#[pyfunction]
pub(crate) fn class_numbers(libraries: Vec<Vec<u8>>) -> Result<Vec<(String, u16)>> {
    let mut catalogue = Catalogue::default();
    for bytes in &libraries {
        catalogue = catalogue.with_library(&Library::from_bytes(bytes)?);
    }
    let numbers = catalogue.class_numbers();
    Ok(numbers.map(|(class, number)| (class.to_owned(), number)).collect())
}
