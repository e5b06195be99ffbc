//! [`RawTerminal`]: a terminal that hands over keys as they are pressed, on a screen of its own. However the command ends, the terminal is
//! as it was before: when it is dropped, and before a panic is told.

use std::io::{self, IsTerminal, Write};
#[cfg(unix)]
use std::sync::{Mutex, Once, PoisonError};

#[cfg(unix)]
use rustix::termios::{OptionalActions, SpecialCodeIndex, Termios, tcgetattr, tcsetattr};

use crate::Failure;

/// How the terminal was before; nothing while it is so.
#[cfg(unix)]
static BEFORE: Mutex<Option<Termios>> = Mutex::new(None);

/// A screen of its own without a cursor; back to the one before.
const ENTER: &str = "\x1b[?1049h\x1b[?25l\x1b[2J";
const LEAVE: &str = "\x1b[0m\x1b[?25h\x1b[?1049l";

/// A terminal whose keys are read one by one.
pub(super) struct RawTerminal(());

impl RawTerminal {
    /// Takes the terminal.
    pub(super) fn open() -> Result<Self, Failure> {
        let refused = |stream: &str| {
            Failure::input(format!(
                "{stream}: found no terminal, expected one of true colour to play in; to film an agent in its place: driftworld film"
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
            |error: rustix::io::Errno| Failure::input(format!("terminal: cannot be asked for single keys: {error}"));
        let before = tcgetattr(io::stdin()).map_err(failed)?;
        let mut raw = before.clone();
        raw.make_raw();
        // Reading hands over what there is, and does not wait.
        raw.special_codes[SpecialCodeIndex::VMIN] = 0;
        raw.special_codes[SpecialCodeIndex::VTIME] = 0;
        *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = Some(before);
        HOOK.call_once(|| {
            let answer = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |info| {
                restore();
                answer(info);
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
            "terminal: found a system whose terminals hand over whole lines only, expected Linux or macOS; to film an agent in its \
             place: driftworld film",
        ))
    }

    /// What was typed since the last time; nothing at all where the terminal is gone.
    #[expect(clippy::unused_self, reason = "only who holds the terminal may")]
    pub(super) fn typed(&self) -> Option<Vec<u8>> {
        let mut bytes = [0; 256];
        match io::Read::read(&mut io::stdin().lock(), &mut bytes) {
            Ok(count) => Some(bytes[..count].to_vec()),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Some(Vec::new()),
            Err(_) => None,
        }
    }

    /// Sends text and codes.
    #[expect(clippy::unused_self, reason = "only who holds the terminal may")]
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

/// Makes the terminal what it was; does nothing a second time.
fn restore() {
    #[cfg(unix)]
    {
        let before = BEFORE.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(before) = before {
            // Whoever has gone needs nothing.
            let _ = tcsetattr(io::stdin(), OptionalActions::Now, &before);
            let _ = io::stdout().lock().write_all(LEAVE.as_bytes());
            let _ = io::stdout().lock().flush();
        }
    }
}
