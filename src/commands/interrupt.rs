//! Signals: what the signals of a terminal and of a job scheduler do to a command. Long work asks whether one came and
//! ends by itself; what cannot ask, or does not come to it in time, is ended. Either way nothing half written stays, and the
//! exit code is that of a program that the signal ended: 130 for an interrupt.
//!
//! Only in a program of its own ([`watch`]): where the command is asked by another program, signals are that one's.

use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};

use super::Failure;
use system::follow_signals;

/// Set by the first signal while somebody listens.
static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// The number of the first signal while somebody listened; an interrupt's where that cannot be known.
static SIGNAL: AtomicU8 = AtomicU8::new(INTERRUPT);

/// The number of an interrupt.
const INTERRUPT: u8 = 2;

/// Whether a command gave up because of a signal.
static GAVE_UP: AtomicBool = AtomicBool::new(false);

/// What to say if whoever listens does not end by itself; nothing while nobody does.
static PARTING: Mutex<Option<String>> = Mutex::new(None);

/// Whether nobody listens.
#[cfg(not(unix))]
static IDLE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(true)));

fn parting() -> MutexGuard<'static, Option<String>> {
    PARTING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether a signal came, for work that then ends by itself. Dropped, it listens no more.
pub(crate) struct Interrupt(());

impl Interrupt {
    /// From now on the first interrupt, termination or hang-up is a question. Whoever has not ended by itself 1.5
    /// seconds later, or when the next signal comes, is ended with these words and the exit code of the signal.
    pub(crate) fn listen(words: impl Into<String>) -> Self {
        *parting() = Some(words.into());
        #[cfg(not(unix))]
        IDLE.store(false, Ordering::SeqCst);
        Self(())
    }

    pub(crate) fn is_asked(&self) -> bool {
        self.flag().load(Ordering::Relaxed)
    }

    /// Why a command that was asked to stop has no result: its exit code is the signal's.
    #[expect(clippy::unused_self, reason = "only who listens was asked")]
    pub(crate) fn failure(&self, text: impl Into<String>) -> Failure {
        GAVE_UP.store(true, Ordering::SeqCst);
        Failure::input(text)
    }

    /// The answer to the same question, for other threads.
    #[expect(clippy::unused_self, reason = "only who listens may ask")]
    pub(crate) fn flag(&self) -> &'static AtomicBool {
        &ASKED
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        // After a signal the words stay until the work has ended.
        if !self.is_asked() {
            silence();
        }
    }
}

/// The exit code of a command that gave up because of a signal, which is then forgotten; none of another.
pub(super) fn exit_code() -> Option<u8> {
    let signal = SIGNAL.swap(INTERRUPT, Ordering::SeqCst);
    GAVE_UP.swap(false, Ordering::SeqCst).then_some(128 + signal)
}

/// From now on nobody listens.
fn silence() {
    parting().take();
    #[cfg(not(unix))]
    IDLE.store(true, Ordering::SeqCst);
}

/// A command that runs as a program. Dropped, it is over, and nobody ends the process any more.
pub(super) struct Watch(());

/// Looks for signals from now on.
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
        ASKED.store(false, Ordering::SeqCst);
    }
}

/// A thread that waits for signals.
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
    use super::{ASKED, INTERRUPT, SIGNAL, parting};

    /// How long work has to end by itself.
    const GRACE: Duration = Duration::from_millis(1500);

    /// How long it may take to remove what is half written and to say so: a disk or a terminal may be what all waits
    /// for.
    const LAST: Duration = Duration::from_millis(300);

    pub(super) fn follow_signals() -> io::Result<()> {
        // A write beyond the limit of a file's size is an error then, said and cleaned up after as a full disk is.
        signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
        let signals = Signals::new(signals())?;
        let thread = thread::Builder::new().name("signals".to_owned());
        thread.spawn(move || follow(signals)).map(drop)
    }

    /// Hanging up is passed over where whoever started the command had it so, as `nohup` does.
    fn signals() -> Vec<i32> {
        let mut signals = vec![SIGINT, SIGTERM];
        // A file of the system's, not by driftworld-files: nobody names it.
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
            let words = parting().clone();
            match words {
                // Nobody can end by itself: the process ends as if it had not looked for signals.
                None => {
                    leave(None);
                    let _ = low_level::emulate_default_handler(signal);
                    low_level::exit(128 + signal);
                }
                Some(words) if ASKED.load(Ordering::SeqCst) => end(&words, signal),
                Some(_) => {
                    // Before it is asked: whoever gives up reads the number.
                    SIGNAL.store(u8::try_from(signal).unwrap_or(INTERRUPT), Ordering::SeqCst);
                    ASKED.store(true, Ordering::SeqCst);
                    let waits = thread::Builder::new().spawn(move || {
                        thread::sleep(GRACE);
                        // By then the command may be over, in a program that goes on.
                        if let Some(words) = parting().clone() {
                            end(&words, signal);
                        }
                    });
                    if waits.is_err() {
                        end(&parting().clone().unwrap_or_default(), signal);
                    }
                }
            }
        }
    }

    fn end(words: &str, signal: i32) -> ! {
        leave(Some(format!("error: {words}")));
        low_level::exit(128 + signal)
    }

    /// Removes what is half written, and says the words, as far as there is time.
    fn leave(words: Option<String>) {
        let (done, wait) = mpsc::channel();
        let leaving = thread::Builder::new().spawn(move || {
            remove_unfinished();
            if let Some(words) = words {
                output::note(words);
            }
            let _ = done.send(());
        });
        if leaving.is_ok() {
            let _ = wait.recv_timeout(LAST);
        }
    }
}

/// Where signals reach no thread, whoever listens is asked, and who is asked twice ends at once.
#[cfg(not(unix))]
mod system {
    use std::io;
    use std::sync::Arc;

    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::flag::{register, register_conditional_default, register_conditional_shutdown};

    use super::{ASKED, IDLE};

    pub(super) fn follow_signals() -> io::Result<()> {
        for signal in [SIGINT, SIGTERM] {
            // In this order: what ends the process looks before the first signal has been taken down.
            register_conditional_shutdown(signal, 128 + signal, Arc::clone(&ASKED))?;
            register_conditional_default(signal, Arc::clone(&IDLE))?;
            register(signal, Arc::clone(&ASKED))?;
        }
        Ok(())
    }
}
