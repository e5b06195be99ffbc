//! Long work that Ctrl-C ends: done on a thread of its own while the interpreter is asked for signals, with threads beside it that
//! are this process's own.

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

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(50);

/// From so many environments on, Ctrl-C ends making and resetting them: fewer are done before anybody waits.
const MANY_ENVS: usize = 32;

/// The threads that work is shared among, one for each processor. Not rayon's common ones: those are made once, and in a process that
/// was forked after that there are none of them, so that all work waits for ever.
pub(crate) fn workers(_held: Python<'_>) -> PyResult<Arc<ThreadPool>> {
    static WORKERS: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    // Only ever locked with the interpreter's lock held, as whoever forks holds it: never locked in the middle of a fork.
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
    // The parent's threads are not in this process: nothing that is left of them may be touched.
    mem::forget(workers.replace((here, Arc::clone(&pool))));
    Ok(pool)
}

/// Does work without the interpreter's lock. On Ctrl-C the flag that the work is handed becomes true, and the interrupt is raised
/// once the work has ended.
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

/// Does what Ctrl-C may end between environments, where there are enough of them that somebody waits.
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

/// Does work that cannot be ended from outside: after Ctrl-C it is left to itself, and what it comes to is dropped.
pub(crate) fn run_detached<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let pool = workers(py)?;
    spawn(py, move || pool.install(work))
}

/// The same on one thread, which is not among the workers.
pub(crate) fn spawn<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    let (done, ended) = mpsc::channel();
    let worker = thread::spawn(move || {
        let _done: mpsc::Sender<()> = done;
        usually_rounded(work)
    });
    wait(py, &Mutex::new(ended))?;
    let result = py.detach(|| worker.join());
    result.map_or_else(|panic| std::panic::resume_unwind(panic), Ok)
}

/// Waits until the other end is gone, or for a signal.
fn wait(py: Python<'_>, ended: &Mutex<Receiver<()>>) -> PyResult<()> {
    loop {
        let look = py.detach(|| {
            let ended = ended.lock().unwrap_or_else(PoisonError::into_inner);
            ended.recv_timeout(LOOK)
        });
        match look {
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            _ => return Ok(()),
        }
    }
}
