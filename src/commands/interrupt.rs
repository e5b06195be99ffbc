//! Signal handling: long work polls for a signal and stops by itself; work that cannot poll, or does not stop in time, is
//! terminated. Either way no partial files remain, and the exit code is 128 plus the signal's number: 130 for an interrupt.
//!
//! Signals are handled only after [`watch`].

use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};

use crate::Failure;
use system::follow_signals;

/// Set by the first signal while a command listens.
static CANCELLED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// The number of the first signal that arrived while a command listened; SIGINT's number if unknown.
static SIGNAL: AtomicU8 = AtomicU8::new(INTERRUPT);

/// The number of SIGINT.
const INTERRUPT: u8 = 2;

/// Whether a command gave up because of a signal.
static GAVE_UP: AtomicBool = AtomicBool::new(false);

/// The message printed if a listening command does not stop by itself; `None` while no command listens.
static EXIT_MESSAGE: Mutex<Option<String>> = Mutex::new(None);

/// Whether no command listens.
#[cfg(not(unix))]
static IDLE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(true)));

fn exit_message() -> MutexGuard<'static, Option<String>> {
    EXIT_MESSAGE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tells long work whether a signal has arrived, so that it can stop. Dropping it stops listening.
pub(crate) struct Interrupt(());

impl Interrupt {
    /// Turns the first interrupt, termination or hang-up into a cancellation request; after 1.5 seconds, or at the next signal,
    /// the process exits with this message and the signal's exit code.
    pub(crate) fn listen(words: impl Into<String>) -> Self {
        *exit_message() = Some(words.into());
        #[cfg(not(unix))]
        IDLE.store(false, Ordering::SeqCst);
        Self(())
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        self.flag().load(Ordering::Relaxed)
    }

    /// The failure of a command that was cancelled: its exit code is the signal's.
    #[expect(clippy::unused_self, reason = "only a listening command can be cancelled")]
    pub(crate) fn failure(&self, text: impl Into<String>) -> Failure {
        GAVE_UP.store(true, Ordering::SeqCst);
        Failure::input(text)
    }

    /// The same flag, for other threads.
    #[expect(clippy::unused_self, reason = "only a listening command may read the flag")]
    pub(crate) fn flag(&self) -> &'static AtomicBool {
        &CANCELLED
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        // After a signal, the message is kept until the work has ended.
        if !self.is_cancelled() {
            silence();
        }
    }
}

/// Takes the exit code of a command that gave up because of a signal; `None` otherwise.
pub(super) fn exit_code() -> Option<u8> {
    let signal = SIGNAL.swap(INTERRUPT, Ordering::SeqCst);
    GAVE_UP.swap(false, Ordering::SeqCst).then_some(128 + signal)
}

/// Stops listening.
fn silence() {
    exit_message().take();
    #[cfg(not(unix))]
    IDLE.store(true, Ordering::SeqCst);
}

/// Handles signals while a command runs. Dropping it cancels a pending exit; later signals have their default action.
pub(super) struct Watch(());

/// Starts signal handling.
pub(super) fn watch() -> Result<Watch, Failure> {
    static WATCHED: OnceLock<Result<(), String>> = OnceLock::new();
    let watched = WATCHED.get_or_init(|| follow_signals().map_err(|error| error.to_string()));
    match watched {
        Ok(()) => Ok(Watch(())),
        Err(error) => Err(Failure::input(format!("cannot watch for signals: {error}"))),
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        silence();
        CANCELLED.store(false, Ordering::SeqCst);
    }
}

/// Waits for signals in a thread.
#[cfg(unix)]
mod system {
    use std::io;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Arc, mpsc};
    use std::thread;
    use std::time::Duration;

    use driftworld_atomic_files::remove_unfinished;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level;

    use super::super::output;
    use super::{CANCELLED, INTERRUPT, SIGNAL, exit_message};

    /// Time that work gets to stop by itself.
    const GRACE: Duration = Duration::from_millis(1500);

    /// Time limit for removing partial files and printing the message: the disk or the terminal may be blocked.
    const CLEAN_UP_TIME: Duration = Duration::from_millis(300);

    pub(super) fn follow_signals() -> io::Result<()> {
        // Writing beyond the file size limit then becomes an error, reported and cleaned up like a full disk.
        signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
        let signals = Signals::new(signals())?;
        let thread = thread::Builder::new().name("signals".to_owned());
        thread.spawn(move || follow(signals)).map(drop)
    }

    /// The signals to handle; not SIGHUP if the parent process ignored it, as with `nohup`.
    fn signals() -> Vec<i32> {
        let mut signals = vec![SIGINT, SIGTERM];
        // Read directly, not through driftworld-files: it is a system file, not one that a user names.
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        if ignored.is_some_and(|mask| mask & (1 << (SIGHUP - 1)) == 0) {
            signals.push(SIGHUP);
        }
        signals
    }

    fn follow(mut signals: Signals) {
        for signal in signals.forever() {
            let words = exit_message().clone();
            match words {
                // No command listens: the process ends as if signals had their default action.
                None => {
                    clean_up(None);
                    let _ = low_level::emulate_default_handler(signal);
                    low_level::exit(128 + signal);
                }
                Some(words) if CANCELLED.load(Ordering::SeqCst) => end(&words, signal),
                Some(_) => {
                    // Stored before cancelling: the command reads the number when it gives up.
                    SIGNAL.store(u8::try_from(signal).unwrap_or(INTERRUPT), Ordering::SeqCst);
                    CANCELLED.store(true, Ordering::SeqCst);
                    let waits = thread::Builder::new().spawn(move || {
                        thread::sleep(GRACE);
                        // By then the command may be finished, in a program that continues.
                        if let Some(words) = exit_message().clone() {
                            end(&words, signal);
                        }
                    });
                    if waits.is_err() {
                        end(&exit_message().clone().unwrap_or_default(), signal);
                    }
                }
            }
        }
    }

    fn end(words: &str, signal: i32) -> ! {
        clean_up(Some(format!("error: {words}")));
        low_level::exit(128 + signal)
    }

    /// Removes partial files and prints the message, as far as time allows.
    fn clean_up(words: Option<String>) {
        let (done, wait) = mpsc::channel();
        let cleaning = thread::Builder::new().spawn(move || {
            remove_unfinished();
            if let Some(words) = words {
                output::note(words);
            }
            let _ = done.send(());
        });
        if cleaning.is_ok() {
            let _ = wait.recv_timeout(CLEAN_UP_TIME);
        }
    }
}

/// Without a signal thread: the first signal cancels a listening command, the second exits at once.
#[cfg(not(unix))]
mod system {
    use std::io;
    use std::sync::Arc;

    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::flag::{register, register_conditional_default, register_conditional_shutdown};

    use super::{CANCELLED, IDLE};

    pub(super) fn follow_signals() -> io::Result<()> {
        for signal in [SIGINT, SIGTERM] {
            // Order matters: the exit handler must check the flag before the first signal sets it.
            register_conditional_shutdown(signal, 128 + signal, Arc::clone(&CANCELLED))?;
            register_conditional_default(signal, Arc::clone(&IDLE))?;
            register(signal, Arc::clone(&CANCELLED))?;
        }
        Ok(())
    }
}
