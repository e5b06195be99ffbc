//! Long work that Ctrl-C ends: done on a thread of its own while the interpreter is asked for signals.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(50);

/// Does work without the interpreter's lock. On Ctrl-C the flag that the work is handed becomes true, and the interrupt is raised
/// once the work has ended.
pub(crate) fn patiently<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let (done, ended) = mpsc::channel();
    thread::scope(|scope| {
        let stop = &stop;
        let worker = scope.spawn(move || {
            // Dropped with the thread, however it ends.
            let _done: mpsc::Sender<()> = done;
            work(stop)
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

/// Does work that cannot be ended from outside: after Ctrl-C it is left to itself, and what it comes to is dropped.
pub(crate) fn impatiently<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    let (done, ended) = mpsc::channel();
    let worker = thread::spawn(move || {
        let _done: mpsc::Sender<()> = done;
        work()
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
