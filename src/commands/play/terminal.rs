//! [`RawTerminal`]: a terminal in raw mode on an alternate screen. The terminal is restored however the command ends: on drop,
//! and before a panic message.

use std::io::{self, IsTerminal, Write};
#[cfg(unix)]
use std::sync::{Mutex, Once, PoisonError};

#[cfg(unix)]
use rustix::termios::{OptionalActions, SpecialCodeIndex, Termios, tcgetattr, tcsetattr};

use crate::Failure;

/// The saved terminal settings; `None` unless in raw mode.
#[cfg(unix)]
static BEFORE: Mutex<Option<Termios>> = Mutex::new(None);

/// Switches to the alternate screen without a cursor, and back.
const ENTER: &str = "\x1b[?1049h\x1b[?25l\x1b[2J";
const LEAVE: &str = "\x1b[0m\x1b[?25h\x1b[?1049l";

/// A terminal whose keys are read one by one.
pub(super) struct RawTerminal(());

impl RawTerminal {
    /// Switches the terminal to raw mode.
    pub(super) fn open() -> Result<Self, Failure> {
        let refused = |stream: &str| {
            Failure::input(format!(
                "{stream}: found no terminal, expected one with true colour to play in; to film an agent instead: driftworld film"
            ))
        };
        if !io::stdout().is_terminal() {
            return Err(refused("standard output"));
        }
        if !io::stdin().is_terminal() {
            return Err(refused("standard input"));
        }
        Self::take()
    }

    #[cfg(unix)]
    fn take() -> Result<Self, Failure> {
        static HOOK: Once = Once::new();
        let failed =
            |error: rustix::io::Errno| Failure::input(format!("terminal: cannot be switched to single keys: {error}"));
        let before = tcgetattr(io::stdin()).map_err(failed)?;
        let mut raw = before.clone();
        raw.make_raw();
        // Reads return what is available without waiting.
        raw.special_codes[SpecialCodeIndex::VMIN] = 0;
        raw.special_codes[SpecialCodeIndex::VTIME] = 0;
        *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = Some(before);
        HOOK.call_once(|| {
            let default_hook = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |info| {
                restore();
                default_hook(info);
            }));
        });
        let terminal = Self(());
        tcsetattr(io::stdin(), OptionalActions::Now, &raw).map_err(failed)?;
        terminal.show(ENTER)?;
        Ok(terminal)
    }

    #[cfg(not(unix))]
    fn take() -> Result<Self, Failure> {
        Err(Failure::input(
            "terminal: found a system whose terminals only deliver whole lines, expected Linux or macOS; to film an agent \
             instead: driftworld film",
        ))
    }

    /// The bytes typed since the last call; `None` if the terminal is gone.
    #[expect(clippy::unused_self, reason = "requires a terminal in raw mode")]
    pub(super) fn typed(&self) -> Option<Vec<u8>> {
        let mut bytes = [0; 256];
        match io::Read::read(&mut io::stdin().lock(), &mut bytes) {
            Ok(count) => Some(bytes[..count].to_vec()),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Some(Vec::new()),
            Err(_) => None,
        }
    }

    /// Prints text and codes.
    #[expect(clippy::unused_self, reason = "requires a terminal in raw mode")]
    pub(super) fn show(&self, text: &str) -> Result<(), Failure> {
        let mut out = io::stdout().lock();
        let shown = out.write_all(text.as_bytes()).and_then(|()| out.flush());
        shown.map_err(|error| Failure::input(format!("terminal: {error}")))
    }
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        restore();
    }
}

/// Restores the terminal's settings; does nothing when called again.
fn restore() {
    #[cfg(unix)]
    {
        let before = BEFORE.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(before) = before {
            // If the terminal is gone, there is nothing to restore.
            let _ = tcsetattr(io::stdin(), OptionalActions::Now, &before);
            let _ = io::stdout().lock().write_all(LEAVE.as_bytes());
            let _ = io::stdout().lock().flush();
        }
    }
}
