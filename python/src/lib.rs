//! The native module `driftworld._native`: what Python calls. How it is shown to users is in `package/driftworld/`.
//!
//! Values cross the border as JSON text, as arrays, or as handles; nothing here is an idea of its own.

mod batch;
mod dress;
mod errors;
mod supply;
mod task;

use pyo3::prelude::*;

#[pymodule(name = "_native")]
mod native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::batch::PyBatch;
    #[pymodule_export]
    use super::supply::PyStream;
    #[pymodule_export]
    use super::task::{PyTask, PyVariant};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
