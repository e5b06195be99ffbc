//! Being asked to stop: the signals that a terminal and a job scheduler send, turned into a question that long work asks.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::SigId;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown};
use signal_hook::low_level::unregister;

use super::Failure;

/// Whether the process was asked to stop. Dropped, it listens no more.
pub(crate) struct Interrupt {
    asked: Arc<AtomicBool>,
    listeners: Vec<SigId>,
}

impl Interrupt {
    /// From now on the first interrupt or termination signal is a question; a second one ends the process at once.
    pub(crate) fn listen() -> Result<Self, Failure> {
        let asked = Arc::new(AtomicBool::new(false));
        let mut interrupt = Self {
            asked,
            listeners: Vec::new(),
        };
        for signal in [SIGINT, SIGTERM] {
            // In this order: what ends the process looks before the first signal has been taken down.
            let ends = register_conditional_shutdown(signal, 1, Arc::clone(&interrupt.asked))?;
            interrupt.listeners.push(ends);
            interrupt
                .listeners
                .push(register(signal, Arc::clone(&interrupt.asked))?);
        }
        Ok(interrupt)
    }

    pub(crate) fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed)
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        // In a program that goes on, as Python's, a later signal must not end what this one knows nothing of.
        for listener in self.listeners.drain(..) {
            unregister(listener);
        }
    }
}
