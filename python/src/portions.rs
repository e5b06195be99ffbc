//! Many worlds of a variant, drawn a portion at a time by several threads. Drawing one is `generator`'s.

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

/// Worlds that are drawn at once: between two such portions Ctrl-C is looked for.
const PORTION: u64 = 256;

/// The most worlds that may be asked for at once, and the most bytes of their texts.
const MOST_WORLDS: u64 = 10_000_000;
const MOST_BYTES: u128 = 16 << 30;
/// From so many worlds on, the first says how large all are.
const ESTIMATED: u64 = 10_000;

/// Draws worlds a portion at a time without the interpreter's lock, and hands each over as `make` makes it.
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
        // Before a portion that is quickly drawn ends, nobody has looked.
        py.check_signals()?;
        for made in run_cancellable(py, draw)??.into_iter().flatten() {
            take(made)?;
        }
    }
    Ok(())
}

/// Refuses what would take more memory than it is likely meant to: all worlds are held at once.
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

/// The numbers of `count` worlds from `start` on.
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

/// The most threads that may be asked for.
const MOST_THREADS: u64 = 1024;

/// Threads to draw by; none where those of all long work are meant.
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
