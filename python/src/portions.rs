//! Draws many worlds of a variant, in portions on several threads.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use driftworld_generator::{GeneratorError, Sampler};
use driftworld_spec::{Variant, World};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::errors::Result;
use crate::interruptible::run_cancellable;
use crate::rounding::detach;

/// Worlds per portion: Ctrl-C is checked between portions.
const PORTION: u64 = 256;

/// Maximum number of worlds per call, and maximum bytes of their texts.
const MOST_WORLDS: u64 = 10_000_000;
const MOST_BYTES: u128 = 16 << 30;
/// Above this number of worlds, their total size is estimated from the first one.
const ESTIMATED: u64 = 10_000;

/// Draws worlds in portions without the GIL, and passes each on as converted by `make`.
pub(crate) fn draw<T: Send>(
    py: Python<'_>,
    variant: &Variant,
    seed: u64,
    mut numbers: Range<u64>,
    threads: u64,
    make: impl Fn(World) -> T + Sync,
    mut take: impl FnMut(T) -> PyResult<()>,
) -> Result<()> {
    let pool = pool(threads)?;
    let sampler = detach(py, || Sampler::new(variant, seed));
    if numbers.end - numbers.start > ESTIMATED {
        expect_room(&numbers, sampler.world(numbers.start)?.to_json().len())?;
    }
    while !numbers.is_empty() {
        let portion = numbers.start..numbers.end.min(numbers.start + PORTION);
        numbers.start = portion.end;
        let draw = |stop: &AtomicBool| {
            let world = |index: u64| {
                let wanted = !stop.load(Ordering::Relaxed);
                wanted.then(|| sampler.world(index).map(&make)).transpose()
            };
            let all = || {
                portion
                    .into_par_iter()
                    .map(world)
                    .collect::<std::result::Result<Vec<_>, GeneratorError>>()
            };
            match &pool {
                Some(pool) => pool.install(all),
                None => all(),
            }
        };
        // A portion may finish before signals have been checked.
        py.check_signals()?;
        for made in run_cancellable(py, draw)??.into_iter().flatten() {
            take(made)?;
        }
    }
    Ok(())
}

/// Refuses requests that need an excessive amount of memory: all worlds are held at once.
fn expect_room(numbers: &Range<u64>, first_bytes: usize) -> PyResult<()> {
    let count = numbers.end - numbers.start;
    let bytes = u128::from(count) * first_bytes as u128;
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    let gib = bytes as f64 / f64::from(1 << 30);
    Err(PyValueError::new_err(format!(
        "count: found {count} worlds of about {first_bytes} bytes, {gib:.0} GiB as text, expected at most 16 GiB at once; ask for them \
         in portions, with start"
    )))
}

/// The indices of `count` worlds from `start` on.
pub(crate) fn numbers(start: u64, count: u64) -> PyResult<Range<u64>> {
    if count > MOST_WORLDS {
        return Err(PyValueError::new_err(format!(
            "count: found {count}, expected at most {MOST_WORLDS} worlds at once; ask for them in portions, with start"
        )));
    }
    let end = start.checked_add(count).ok_or_else(|| {
        PyValueError::new_err(format!(
            "start: found {start}, expected room for {count} worlds below 2^64"
        ))
    })?;
    Ok(start..end)
}

/// Maximum number of threads.
const MOST_THREADS: u64 = 1024;

/// A pool with this many threads; for 0 `None`, which means the pool shared by all long work.
fn pool(threads: u64) -> PyResult<Option<rayon::ThreadPool>> {
    if threads == 0 {
        return Ok(None);
    }
    if threads > MOST_THREADS {
        return Err(PyValueError::new_err(format!(
            "threads: found {threads}, expected at most {MOST_THREADS}; 0 for one on each processor"
        )));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build();
    pool.map(Some)
        .map_err(|error| PyValueError::new_err(format!("threads: found {threads}: {error}")))
}
