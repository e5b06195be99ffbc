//! Runs long work on a separate thread while polling Python for signals, so that Ctrl-C can stop it. The worker pool is
//! recreated after a fork.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use std::{mem, process, thread};

use driftworld_env::{EnvError, GoOn};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::Result;
use crate::rounding::{detach, usually_rounded};

/// How often to check for signals.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// Minimum number of environments for which Ctrl-C can interrupt creation and resets; fewer finish almost at once.
const MANY_ENVS: usize = 32;

/// This process's worker pool, one thread per processor. Rayon's global pool does not survive a fork: its threads stay in the
/// parent, and work in the child would wait forever.
pub(crate) fn workers(_held: Python<'_>) -> PyResult<Arc<ThreadPool>> {
    static WORKERS: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    // Locked only while holding the GIL. A forking thread also holds the GIL, so a child never inherits a locked mutex.
    let mut workers = WORKERS.lock().unwrap_or_else(PoisonError::into_inner);
    let here = process::id();
    if let Some((process, pool)) = &*workers
        && *process == here
    {
        return Ok(Arc::clone(pool));
    }
    let pool = usually_rounded(|| ThreadPoolBuilder::new().build())
        .map_err(|error| PyRuntimeError::new_err(format!("threads: could not start any: {error}")))?;
    let pool = Arc::new(pool);
    // The parent's threads do not exist in this process, so the old pool must be leaked, not dropped.
    mem::forget(workers.replace((here, Arc::clone(&pool))));
    Ok(pool)
}

/// Runs work without the GIL. Ctrl-C sets the flag that the work gets, and the interrupt is raised once the work has returned.
pub(crate) fn run_cancellable<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    let (stop, pool) = (AtomicBool::new(false), workers(py)?);
    let (done, ended) = mpsc::channel();
    thread::scope(|scope| {
        let stop = &stop;
        let worker = scope.spawn(move || {
            // Dropped with the thread, however it ends.
            let _done: mpsc::Sender<()> = done;
            pool.install(|| work(stop))
        });
        let interrupt = wait(py, &Mutex::new(ended));
        if interrupt.is_err() {
            stop.store(true, Ordering::Relaxed);
        }
        let result = py.detach(|| worker.join());
        interrupt?;
        result.map_or_else(|panic| std::panic::resume_unwind(panic), Ok)
    })
}

/// Runs work that Ctrl-C can stop between environments; for fewer than [`MANY_ENVS`] it always runs to the end.
pub(crate) fn run_between_envs<T: Send>(
    py: Python<'_>,
    num_envs: usize,
    work: impl FnOnce(GoOn<'_>) -> std::result::Result<T, EnvError> + Send,
) -> Result<T> {
    if num_envs < MANY_ENVS {
        return Ok(detach(py, || work(&|| true))?);
    }
    Ok(run_cancellable(py, |stop| work(&|| !stop.load(Ordering::Relaxed)))??)
}

/// Runs work that cannot be cancelled: after Ctrl-C it continues in the background and its result is dropped.
pub(crate) fn run_detached<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let pool = workers(py)?;
    let (done, ended) = mpsc::channel();
    let worker = thread::spawn(move || {
        let _done: mpsc::Sender<()> = done;
        usually_rounded(|| pool.install(work))
    });
    wait(py, &Mutex::new(ended))?;
    let result = py.detach(|| worker.join());
    result.map_or_else(|panic| std::panic::resume_unwind(panic), Ok)
}

/// Waits until the sender is dropped; fails if a signal handler raises first.
fn wait(py: Python<'_>, ended: &Mutex<Receiver<()>>) -> PyResult<()> {
    loop {
        let look = py.detach(|| {
            let ended = ended.lock().unwrap_or_else(PoisonError::into_inner);
            ended.recv_timeout(SIGNAL_INTERVAL)
        });
        match look {
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            _ => return Ok(()),
        }
    }
}
