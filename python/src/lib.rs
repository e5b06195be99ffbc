//! The native module `driftworld._native`, which `package/driftworld/` wraps for users.
//!
//! Values are passed as JSON text, as arrays, or as handles; this crate adds no functionality of its own.
#![expect(clippy::needless_pass_by_value, reason = "PyO3 hands arguments over by value")]

mod batch;
mod classes;
mod command;
mod covered;
mod curriculum;
mod design;
mod distances;
mod document;
mod drift;
mod elements;
mod errors;
mod files;
mod interruptible;
mod json;
mod logs;
mod options;
mod overrides;
mod portions;
mod recordings;
mod rounding;
mod scores;
mod supply;
mod task;
mod variant;
mod views;

use pyo3::prelude::*;

#[pymodule(name = "_native")]
mod native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        batch::PyBatch,
        classes::class_numbers,
        command::main,
        covered::covered,
        curriculum::{PyJournal, PyPlan},
        design::design_curriculum,
        distances::{PyMatrix, compared_by, distance, order_methods, removed_format},
        document::check,
        drift::PyDrift,
        elements::elements,
        files::{read_file, write_file},
        json::parsed,
        logs::{PyLogFile, read_log, validate_log},
        options::requests,
        recordings::{PyRecording, png, read_recording},
        scores::{PyScores, report},
        supply::PyStream,
        task::{PyTask, built_in_names, task_groups},
        variant::{PyVariant, load_variant, load_variants},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
