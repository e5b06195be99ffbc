//! Reads lines from a terminal without history or completion, in builds without the feature `line-editor`.

use std::io::{self, BufRead, Write};

use super::session::Names;
use crate::Failure;

/// Reads lines from a terminal.
pub(crate) struct Editor(());

impl Editor {
    #[expect(clippy::unnecessary_wraps, reason = "same signature as with the feature")]
    pub(crate) fn new() -> Result<Self, Failure> {
        Ok(Self(()))
    }

    /// Reads the next line that is neither empty nor a comment; `None` if the user quits.
    #[expect(clippy::unused_self, reason = "same signature as with the feature")]
    pub(crate) fn read(&mut self, _: Names) -> Result<Option<String>, Failure> {
        let failed = |error: io::Error| Failure::input(format!("terminal: {error}"));
        loop {
            let mut stdout = io::stdout().lock();
            write!(stdout, "driftworld> ")
                .and_then(|()| stdout.flush())
                .map_err(failed)?;
            let mut line = String::new();
            if io::stdin().lock().read_line(&mut line).map_err(failed)? == 0 {
                return Ok(None);
            }
            let line = line.trim_end_matches(['\n', '\r']);
            if !line.trim().is_empty() && !line.trim_start().starts_with('#') {
                return Ok(Some(line.to_owned()));
            }
        }
    }
}
